//! Choice of the best candidate, and of the Pareto front.

use super::{
    Error,
    record::{Outcome, Run},
};
use umbrage::config::Budget;

/// Chosen outcomes, as indices into the list of outcomes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Choice {
    /// Index of the best outcome.
    pub best: usize,
    /// Indices of the Pareto front, by bytes: outcomes that no other beats in both error and bytes,
    /// among those that flicker little and fit the budget.
    pub front: Vec<usize>,
}

/// Returns whether a candidate flickers no more than the share `most`. One whose camera never moves
/// does not flicker.
#[must_use]
pub fn is_still(outcome: &Outcome, most: f64) -> bool {
    outcome.flicker.is_none_or(|flicker| flicker <= most)
}

/// Chooses the candidate of least mean E, among those that flicker no more than the share `most`
/// and fit the budget. Of equals it takes the one with fewer bytes, then the first.
///
/// # Errors
/// [`Error::NoView`], [`Error::Flicker`] and [`Error::OverBudget`] if there is none.
pub fn choose(run: &Run, outcomes: &[Outcome], most: f64) -> Result<Choice, Error> {
    let scored: Vec<usize> = (0..outcomes.len()).filter(|&index| outcomes[index].e.is_some()).collect();
    if scored.is_empty() {
        return Err(Error::NoView { least_edges: run.least_edges });
    }
    let fits = |index: &usize| fits(run, &outcomes[*index]);
    let fitting: Vec<usize> = scored.into_iter().filter(fits).collect();
    if fitting.is_empty() {
        let least = outcomes.iter().map(|outcome| outcome.bytes).min().unwrap_or_default();
        return Err(Error::OverBudget { budget: run.budget.clone(), least });
    }
    let still: Vec<usize> = fitting.iter().copied().filter(|&index| is_still(&outcomes[index], most)).collect();
    let error = |index: usize| outcomes[index].e.unwrap_or(f64::INFINITY);
    let by_error = |a: &usize, b: &usize| {
        error(*a).total_cmp(&error(*b)).then(outcomes[*a].bytes.cmp(&outcomes[*b].bytes)).then(a.cmp(b))
    };
    let Some(best) = still.iter().copied().min_by(by_error) else {
        let flicker = |index: usize| outcomes[index].flicker.unwrap_or_default();
        let least = fitting.into_iter().min_by(|a, b| flicker(*a).total_cmp(&flicker(*b))).unwrap_or_default();
        let label = run.candidates[outcomes[least].candidate].label.clone();
        return Err(Error::Flicker { most: 100.0 * most, least: 100.0 * flicker(least), label });
    };
    Ok(Choice { best, front: front(outcomes, still) })
}

/// Returns whether the measured size is no more than the budget.
fn fits(run: &Run, outcome: &Outcome) -> bool {
    match run.budget.parse() {
        Ok(Budget::Bytes(bytes)) => outcome.bytes <= bytes,
        Ok(Budget::Texels(texels)) => run.candidates[outcome.candidate].config.texels() <= texels,
        Err(_) => false,
    }
}

/// Returns the outcomes that no other beats in error with as few bytes.
fn front(outcomes: &[Outcome], mut of: Vec<usize>) -> Vec<usize> {
    let error = |index: usize| outcomes[index].e.unwrap_or(f64::INFINITY);
    of.sort_by(|a, b| outcomes[*a].bytes.cmp(&outcomes[*b].bytes).then(error(*a).total_cmp(&error(*b))));
    let mut least = f64::INFINITY;
    of.retain(|&index| {
        let is_better = error(index) < least;
        least = least.min(error(index));
        is_better
    });
    of
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use umbrage::ShadowConfig;

    use super::super::{candidates::Candidate, record::Shard};
    use super::*;

    fn run(count: usize) -> Run {
        let candidate =
            |number| Candidate { label: format!("c{number}"), config: ShadowConfig::default(), preset: None };
        Run {
            version: String::new(),
            adapter: String::new(),
            budget: "100 B".into(),
            axes: Vec::new(),
            with: Vec::new(),
            size: [8, 6],
            shadow_range: None,
            sun_angle: None,
            least_edges: 300,
            views: Vec::new(),
            candidates: (0..count).map(candidate).collect(),
            skipped: BTreeMap::new(),
            shard: Shard::WHOLE,
        }
    }

    fn outcomes(of: &[(u64, f64, f64)]) -> Vec<Outcome> {
        let outcome = |(candidate, &(bytes, e, flicker))| Outcome {
            candidate,
            bytes,
            e: Some(e),
            flicker: Some(flicker),
            ..Outcome::default()
        };
        of.iter().enumerate().map(outcome).collect()
    }

    #[test]
    fn the_best_is_still_and_within_the_budget() {
        let found = outcomes(&[
            (100, 0.2, 0.0),
            (101, 0.1, 0.0),
            (100, 0.1, 0.5),
            (90, 0.2, 0.0),
            (50, 0.3, 0.01),
            (60, 0.4, 0.0),
        ]);
        let choice = choose(&run(6), &found, 0.01).expect("a best");
        assert_eq!(choice.best, 3, "of equals the one with fewer bytes");
        assert_eq!(choice.front, [4, 3], "the front ends with the budget, and nothing on it flickers");
    }

    #[test]
    fn without_a_best_the_reason_is_named() {
        let restless = outcomes(&[(100, 0.2, 0.07), (100, 0.1, 0.05)]);
        let Err(Error::Flicker { most, least, label }) = choose(&run(2), &restless, 0.01) else {
            panic!("one was chosen")
        };
        assert_eq!((most, least, label.as_str()), (1.0, 5.0, "c1"));
        let large = outcomes(&[(200, 0.2, 0.0), (300, 0.1, 0.0)]);
        assert_eq!(choose(&run(2), &large, 0.01), Err(Error::OverBudget { budget: "100 B".into(), least: 200 }));
        assert_eq!(choose(&run(1), &[Outcome::default()], 0.01), Err(Error::NoView { least_edges: 300 }));
    }
}
