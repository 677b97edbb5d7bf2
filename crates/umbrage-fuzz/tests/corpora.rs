//! The fuzzers over their corpora and mutations of them, on a stable compiler.
//!
//! Every mutation follows from a seed and a number, which a failure names. `cargo xtask fuzz` runs
//! 10^5 for each fuzzer; `UMBRAGE_FUZZ_RUNS` and `UMBRAGE_FUZZ_SEED` choose others.

use std::fs;
use std::panic::{AssertUnwindSafe, catch_unwind};

use umbrage_fuzz::{Body, Numbers, mutated};

/// Mutations for each fuzzer in a run of CI.
const RUNS: u64 = 300;

/// Bytes that a file of a corpus may take, mutated or not: a million posts of terrain, whose size
/// is independent of the file's.
const MOST_BYTES: u64 = 512 << 20;

/// Largest file of a corpus in bytes. Corpora stay small.
const LARGEST: usize = 16 << 10;

fn from_environment(variable: &str, otherwise: u64) -> u64 {
    std::env::var(variable).ok().map_or(otherwise, |text| text.parse().expect("a whole number"))
}

/// The files of a corpus, with their names.
fn corpus(body: Body) -> Vec<(String, Vec<u8>)> {
    let folder = body.corpus();
    let entries = fs::read_dir(&folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
    let mut files: Vec<(String, Vec<u8>)> = entries
        .map(|entry| entry.expect("an entry"))
        .map(|entry| (entry.file_name().to_string_lossy().into_owned(), fs::read(entry.path()).expect("a file")))
        .collect();
    files.sort();
    files
}

/// What is wrong with a run: a panic, or too much memory.
fn fault(run: impl FnOnce()) -> Option<String> {
    let most = catch_unwind(AssertUnwindSafe(|| allocation_counter::measure(run).bytes_max));
    match most {
        Err(panic) => {
            let message = panic.downcast_ref::<String>().cloned();
            Some(message.or(panic.downcast_ref::<&str>().map(ToString::to_string)).unwrap_or_default())
        }
        Ok(bytes) => (bytes > MOST_BYTES).then(|| format!("{bytes} bytes")),
    }
}

fn check(body: Body) {
    let files = corpus(body);
    assert!(files.len() >= 3, "{}: {} files are no corpus", body.name(), files.len());
    for (name, bytes) in &files {
        assert!(bytes.len() <= LARGEST, "{}/{name} has {} bytes", body.name(), bytes.len());
        if let Some(fault) = fault(|| body.run(bytes)) {
            panic!("{}/{name}: {fault}", body.name());
        }
    }
    let seed = from_environment("UMBRAGE_FUZZ_SEED", 1);
    for number in 0..from_environment("UMBRAGE_FUZZ_RUNS", RUNS) {
        let mut numbers = Numbers::new(seed.wrapping_mul(0x2545_f491_4f6c_dd1d) ^ number);
        let [first, second] = [(); 2].map(|()| &files[numbers.below(files.len())].1);
        let bytes = mutated(first, second, &mut numbers);
        if let Some(fault) = fault(|| body.run(&bytes)) {
            panic!("{}: seed {seed}, mutation {number}: {fault}\n{}", body.name(), String::from_utf8_lossy(&bytes));
        }
    }
}

#[test]
fn plans_keep_their_promises() {
    check(Body::Plan);
}

#[test]
fn gltf_files_cost_no_panic_and_little_memory() {
    check(Body::Gltf);
}

#[test]
fn height_maps_cost_no_panic_and_little_memory() {
    check(Body::HeightMap);
}

#[test]
fn camera_paths_are_walked_or_refused() {
    check(Body::Path);
}

#[test]
fn techniques_are_read_or_refused() {
    check(Body::Techniques);
}

#[test]
fn configs_are_read_or_refused() {
    check(Body::Config);
}

/// Each fuzzer has a libFuzzer target, and there is none without a fuzzer.
#[test]
fn targets_are_the_fuzzers() {
    let folder = Body::Plan.corpus().join("../../fuzz_targets");
    let mut targets: Vec<String> = fs::read_dir(folder)
        .expect("the targets")
        .map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned())
        .collect();
    targets.sort();
    let mut expected = Body::ALL.map(|body| format!("{}.rs", body.name()));
    expected.sort();
    assert_eq!(targets, expected);
}

/// A run must be able to fail: by a panic and by memory.
#[test]
fn faults_are_seen() {
    assert_eq!(fault(|| ()), None);
    assert_eq!(fault(|| panic!("a defect")), Some("a defect".to_owned()));
    let (limit, large) =
        (MOST_BYTES as usize, fault(|| drop(std::hint::black_box(vec![0_u8; MOST_BYTES as usize + 1]))));
    assert!(large.is_some_and(|fault| fault.ends_with("bytes")), "{limit}");
}

/// Mutations change files, and the same numbers change them alike.
#[test]
fn mutations_follow_from_their_numbers() {
    let file: Vec<u8> = (0..200).collect();
    let of = |seed| mutated(&file, b"another file", &mut Numbers::new(seed));
    assert!((0..100).filter(|&seed| of(seed) != file).count() > 90);
    assert!((0..100).all(|seed| of(seed) == of(seed)));
}
