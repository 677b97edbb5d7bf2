//! The search for the best config: in one run, in shards, cut off and gone on; and what it refuses.

mod common;

use std::fs;

use common::{Folder, has_adapter, stderr};
use serde_json::Value;

/// Four candidates on two frames of a small picture.
const TUNE: &str = "tune tiny.glb --budget 64KiB --try splits=1/2 --try preset=balanced/papers --presets off --size 64x48 --least-edges 1";
const OUTPUTS: &str = "-o best.toml --plot plot.svg --page page.html --json all.json";

fn outputs(folder: &Folder) -> Vec<Vec<u8>> {
    ["best.toml", "plot.svg", "page.html", "all.json"].map(|name| fs::read(folder.at(name)).expect(name)).to_vec()
}

/// What the command says when it refuses merging files of these texts.
fn refuse_merge(files: &[(&str, &str)], options: &str, culprits: &[&str]) {
    let folder = Folder::new();
    for (name, text) in files {
        fs::write(folder.at(name), text).expect("writable");
    }
    let before = folder.names();
    let names: Vec<&str> = files.iter().map(|(name, _)| *name).collect();
    let words = format!("tune --merge {} -o best.toml --page page.html {options}", names.join(","));
    let output = folder.run(&words);
    let message = stderr(&output);
    assert_eq!(output.status.code(), Some(2), "{words}: {message}");
    for culprit in culprits {
        assert!(message.contains(culprit), "{words}: the message does not name {culprit:?}\n{message}");
    }
    assert_eq!(folder.names(), before, "{words}: files are left");
}

#[test]
fn shards_and_runs_that_were_cut_off_come_to_the_same() {
    if !has_adapter() {
        return;
    }
    let whole = Folder::new();
    whole.succeed(&format!("{TUNE} {OUTPUTS} --results whole.jsonl"));
    let lines = fs::read_to_string(whole.at("whole.jsonl")).expect("results");
    assert_eq!(lines.lines().count(), 5, "what run it is, and four candidates");

    let shards = Folder::new();
    for number in [2, 1] {
        shards.succeed(&format!("{TUNE} --shard {number}/2 --results {number}.jsonl"));
    }
    shards.succeed(&format!("tune --merge 2.jsonl,1.jsonl {OUTPUTS}"));
    assert!(outputs(&whole) == outputs(&shards), "the merge differs from the whole");

    // Two candidates are whole, the third one's line was cut off.
    let cut: String = lines.split_inclusive('\n').take(3).collect();
    let rest = &lines[cut.len()..][..20];
    let again = Folder::with("cut.jsonl", format!("{cut}{rest}"));
    again.succeed(&format!("{TUNE} {OUTPUTS} --results cut.jsonl"));
    assert!(outputs(&whole) == outputs(&again), "what went on differs from the whole");
    assert_eq!(fs::read_to_string(again.at("cut.jsonl")).expect("results"), lines);

    another_run_is_refused(&lines);
    bad_merges(&lines, &shards);
}

/// A file of another run, or a damaged one, is refused and stays.
fn another_run_is_refused(lines: &str) {
    let folder = Folder::with("results.jsonl", lines);
    let damaged = lines.replacen("\"bytes\":", "\"bites\":", 1);
    let line = fs::write(folder.at("damaged.jsonl"), &damaged);
    line.expect("writable");
    for (words, culprits) in [
        (
            format!("{TUNE} --results results.jsonl --fov 50"),
            &["--results results.jsonl", "another tune run (views)"][..],
        ),
        (TUNE.replace("64KiB", "32KiB") + " --results results.jsonl", &["another tune run (budget)"]),
        (format!("{TUNE} --results results.jsonl --shard 1/2"), &["another tune run (shard)"]),
        (format!("{TUNE} --results damaged.jsonl"), &["--results damaged.jsonl", "line 2 is damaged", "bytes"]),
        (format!("{TUNE} --results tiny.glb"), &["tiny.glb"]),
    ] {
        let output = folder.run(&words);
        let message = stderr(&output);
        assert_eq!(output.status.code(), Some(2), "{words}: {message}");
        assert!(culprits.iter().all(|culprit| message.contains(culprit)), "{words}: {message}");
    }
    assert_eq!(fs::read_to_string(folder.at("results.jsonl")).expect("still there"), lines);
}

fn bad_merges(lines: &str, shards: &Folder) {
    let [first, second] = [1, 2].map(|n| fs::read_to_string(shards.at(&format!("{n}.jsonl"))).expect("a shard"));
    refuse_merge(&[("1.jsonl", &first)], "", &["2 of 4 candidates are missing", "2 of shard 2/2"]);
    let cut = &second[..second.len() - 5];
    let missing = ["1 of 4 candidates are missing", "1 of shard 2/2 (its last line was cut off)"];
    refuse_merge(&[("1.jsonl", &first), ("2.jsonl", cut)], "", &missing);
    let other = second.replacen("\"size\":[64,48]", "\"size\":[64,50]", 1);
    refuse_merge(
        &[("1.jsonl", &first), ("2.jsonl", &other)],
        "",
        &["1.jsonl and 2.jsonl are of different runs", "size"],
    );
    refuse_merge(&[("1.jsonl", &first), ("whole.jsonl", lines)], "", &["different runs", "shard"]);
    let damaged = second.replacen("\"candidate\":1", "\"candidate\":77", 1);
    refuse_merge(&[("1.jsonl", &first), ("2.jsonl", &damaged)], "", &["--results 2.jsonl", "line 2 is damaged", "77"]);
    refuse_merge(&[("1.jsonl", &first), ("2.jsonl", "")], "", &["2.jsonl is empty"]);
    refuse_merge(&[("1.jsonl", &first), ("2.jsonl", "{\"a\":1}\n")], "", &["2.jsonl", "line 1 is damaged"]);
    refuse_merge(&[("1.jsonl", &first), ("2.jsonl", "no JSON\n")], "", &["2.jsonl", "not a journal of a tune run"]);
    let changed = |line: &str, change: &dyn Fn(&mut Value)| -> String {
        let mut value: Value = serde_json::from_str(line).expect("a line");
        change(&mut value);
        value.to_string()
    };
    let all: Vec<&str> = lines.lines().collect();
    let bytes = changed(all[1], &|line| line["bytes"] = 7.into());
    let twice = format!("{lines}{bytes}\n");
    refuse_merge(&[("twice.jsonl", &twice)], "", &["twice.jsonl", "other figures for candidate 0"]);
    let restless: Vec<String> = all[1..]
        .iter()
        .enumerate()
        .map(|(number, line)| changed(line, &|line| line["flicker"] = (0.05 + 0.01 * number as f64).into()))
        .collect();
    let restless = format!("{}\n{}\n", all[0], restless.join("\n"));
    let least = ["--most-flicker 1", "the least found is 5.000 %", "splits=1:preset=balanced"];
    refuse_merge(&[("restless.jsonl", &restless)], "", &least);
}

#[test]
fn the_winner_is_no_worse_than_balanced_and_is_read_back() {
    if !has_adapter() {
        return;
    }
    let folder = Folder::new();
    folder.succeed(&format!(
        "tune tiny.glb --budget 16Ktexel --try filter=pcf2 --size 64x48 --least-edges 1 --most-flicker 100 {OUTPUTS}"
    ));
    let all = folder.json("all.json");
    let candidates = all["candidates"].as_array().expect("candidates");
    let best = &candidates[all["best"].as_u64().expect("a number") as usize];
    let balanced = candidates.iter().find(|candidate| candidate["preset"] == "balanced").expect("balanced is there");
    assert_eq!(balanced["bytes"], 4 * 4 * 64 * 64, "the whole budget");
    assert!(best["e"].as_f64() <= balanced["e"].as_f64() && best["bytes"].as_u64() <= balanced["bytes"].as_u64());
    assert!(candidates.iter().all(|candidate| candidate["flicker"].is_number()), "cameras move");

    let toml = fs::read_to_string(folder.at("best.toml")).expect("the best");
    assert!(
        toml.starts_with("# Tuned by umbrage") && toml.contains("tiny.glb") && toml.contains("16 Ktexel"),
        "{toml}"
    );
    folder.succeed("render tiny.glb --size 64x48 --config best.toml -o picture.png --report report.json");
    assert_eq!(folder.json("report.json")["config"], best["config"], "{toml}");
    let svg = fs::read_to_string(folder.at("plot.svg")).expect("the plot");
    for word in ["Pareto front", "preset balanced", "preset papers", "the best"] {
        assert!(svg.contains(word), "{word} is missing");
    }
}

#[test]
fn bad_searches_are_refused() {
    let folder = Folder::new();
    let small = "--size 64x48 --presets off -o best.toml";
    for (words, culprits) in [
        ("tune", &["SCENE"][..]),
        ("tune tiny.glb -o best.toml", &["--budget"]),
        ("tune tiny.glb --budget 8 -o best.toml", &["--budget", "no unit"]),
        ("tune tiny.glb --budget -8MB -o best.toml", &["--budget", "-8"]),
        ("tune tiny.glb --budget 8MB", &["nothing to write"]),
        ("tune tiny.glb --budget 8MB --results both --json both", &["both", "two outputs"]),
        (&format!("tune tiny.glb --budget 100B {small}"), &["--budget 100 B", "too small", "512 B"]),
        (&format!("tune tiny.glb --budget 100B --try splits=1 {small}"), &["--budget 100 B", "too small", "256 B"]),
        (&format!("tune tiny.glb --budget 8MB --try map-size=512 {small}"), &["--try", "follows from the budget"]),
        (&format!("tune tiny.glb --budget 8MB --try splits=2 --try splits=3 {small}"), &["splits is tried twice"]),
        (&format!("tune tiny.glb --budget 8MB --try warp=tsm --try filter=vsm {small}"), &["no combination is left"]),
        (&format!("tune tiny.glb --budget 8MB --with colour=3 {small}"), &["colour"]),
        (&format!("tune tiny.glb --budget 8MB --with sun-angle=3 {small}"), &["--with sun-angle"]),
        (&format!("tune tiny.glb --budget 8MB --most-flicker -1 {small}"), &["--most-flicker"]),
        (&format!("tune tiny.glb --budget 8MB --shard 1/2 {small}"), &["--results"]),
        (&format!("tune tiny.glb --budget 8MB --shard 3/2 --results r {small}"), &["--shard", "3"]),
        (&format!("tune tiny.glb --budget 8MB --shard 0/2 --results r {small}"), &["--shard", "0"]),
        (&format!("tune tiny.glb --budget 8MB --shard 1/2 --results r {small}"), &["best.toml", "--merge"]),
        (&format!("tune none.glb --budget 8MB {small}"), &["none.glb"]),
        (&format!("tune tiny.glb --budget 8MB --camera nobody {small}"), &["nobody"]),
        ("tune tiny.glb --merge a -o best.toml", &["--merge"]),
        ("tune --merge none.jsonl -o best.toml", &["none.jsonl"]),
        ("tune --merge tiny.glb -o best.toml", &["tiny.glb"]),
        ("tune --merge tiny.glb -o tiny.glb", &["tiny.glb is an input"]),
    ] {
        folder.refuse(words, culprits);
    }
    if has_adapter() {
        folder.refuse(
            &format!("tune tiny.glb --budget 8MB {small} --try splits=1 --least-edges 100000"),
            &["no view counts"],
        );
    }
}
