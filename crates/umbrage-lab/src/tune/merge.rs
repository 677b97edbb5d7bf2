//! Merging of the shards of one run.

use std::path::PathBuf;

use serde_json::Value;

use super::{
    Error, Outputs, RESULTS, output,
    record::{Outcome, Run, Shard},
    run::read_outcome,
};
use crate::{
    failure::{Failure, Result},
    journal,
};

/// Merges the result files of a run's shards and writes the outputs, which are those of an
/// undivided run.
///
/// # Errors
/// [`Error`] with the files of different runs, or with the missing candidates; [`Failure::Input`]
/// with a file that cannot be read or a line that is damaged.
pub fn merge(files: &[PathBuf], most_flicker: f64, outputs: &Outputs) -> Result<()> {
    let (run, outcomes) = read(files)?;
    output::write(&run, outcomes, most_flicker, outputs)
}

fn read(files: &[PathBuf]) -> Result<(Run, Vec<Outcome>)> {
    let mut first: Option<(Value, Run)> = None;
    let mut outcomes: Vec<Outcome> = Vec::new();
    let mut dropped = Vec::new();
    for path in files {
        let header = journal::read(path, RESULTS, None, |_| Ok(()))?.of;
        let header = header.ok_or_else(|| Error::Empty { file: path.clone() })?;
        let run: Run = serde_json::from_value(header.clone())
            .map_err(|error| RESULTS.refuse(path, format_args!("line 1 is damaged: {error}; run that shard again")))?;
        let shared = without_shard_number(&header);
        match &first {
            None => first = Some((shared, run.clone())),
            Some((other, _)) => {
                if let Some(difference) = journal::difference(other, &shared) {
                    return Err(Error::OtherRun { first: files[0].clone(), other: path.clone(), difference }.into());
                }
            }
        }
        let kept = journal::read(path, RESULTS, None, |line| read_outcome(line, run.candidates.len()))?;
        if kept.dropped > 0 {
            dropped.push(run.shard);
        }
        for outcome in kept.finished {
            match outcomes.iter().find(|other| other.candidate == outcome.candidate) {
                None => outcomes.push(outcome),
                Some(same) if *same == outcome => {}
                Some(_) => {
                    let (candidate, label) = (outcome.candidate, run.candidates[outcome.candidate].label.clone());
                    return Err(Error::Contradiction { file: path.clone(), candidate, label }.into());
                }
            }
        }
    }
    let (_, run) = first.ok_or_else(|| Failure::input("--merge: no file; give the files of a run's shards"))?;
    complete(&run, &outcomes, &dropped)?;
    Ok((Run { shard: Shard::WHOLE, ..run }, outcomes))
}

/// Returns a description that is equal for all shards of one run.
fn without_shard_number(header: &Value) -> Value {
    let mut header = header.clone();
    if let Some(shard) = header.get_mut("shard").and_then(Value::as_object_mut) {
        shard.remove("number");
    }
    header
}

/// Checks that every candidate is there.
fn complete(run: &Run, outcomes: &[Outcome], dropped: &[Shard]) -> Result<(), Error> {
    let all = run.candidates.len();
    let missing: Vec<usize> =
        (0..all).filter(|number| outcomes.iter().all(|outcome| outcome.candidate != *number)).collect();
    if missing.is_empty() {
        return Ok(());
    }
    let shards = (1..=run.shard.of).map(|number| Shard { number, ..run.shard }).filter_map(|shard| {
        let count = missing.iter().filter(|&&number| shard.has(number)).count();
        let cut = if dropped.contains(&shard) { " (its last line was cut off)" } else { "" };
        (count > 0).then(|| format!("{count} of shard {shard}{cut}"))
    });
    Err(Error::Missing { missing: missing.len(), all, shards: shards.collect::<Vec<_>>().join(", ") })
}
