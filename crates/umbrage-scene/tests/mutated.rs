//! Files mutated by the thousand: the loader neither panics nor takes more memory than a small file
//! may cost.
//!
//! Every mutation follows from a seed and a number, which a failure names. `cargo xtask fuzz` runs
//! 10^5 of them; `UMBRAGE_FUZZ_FILES` and `UMBRAGE_FUZZ_SEED` choose others.

mod common;

use common::Glb;
use common::exercise::exercise;
use common::rich::rich;
use serde_json::Value;

/// Files of a run in CI.
const FILES: u64 = 2000;

/// Bytes that a file under 1 MB may take while it is loaded, posed and written, at the default
/// budget.
const MOST_BYTES: u64 = 512 << 20;

/// Vigna's SplitMix64 (2015): numbers that follow from a seed alone, on every machine.
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    fn below(&mut self, end: usize) -> usize {
        if end == 0 { 0 } else { (self.next() % end as u64) as usize }
    }

    fn pick<'a, T>(&mut self, list: &'a [T]) -> &'a T {
        &list[self.below(list.len())]
    }
}

/// Numbers that lie about lengths, indices, types and quantities.
const LIES: [&str; 16] = [
    "0",
    "1",
    "-1",
    "2",
    "3",
    "255",
    "65535",
    "65536",
    "2147483647",
    "4294967295",
    "4294967296",
    "1e9",
    "1e39",
    "0.5",
    "5121",
    "5126",
];

/// Changes one value somewhere in a JSON: lies, leaves out, doubles, or puts what belongs
/// elsewhere.
fn bend(json: &mut Value, numbers: &mut Numbers) {
    let mut at = json;
    // The document itself stays an object: what else it could be is tested without a fuzzer.
    let mut depth = 0;
    loop {
        let children = match at {
            Value::Array(list) => list.len(),
            Value::Object(map) => map.len(),
            _ => 0,
        };
        if children == 0 || (depth > 0 && numbers.below(6) == 0) {
            break;
        }
        depth += 1;
        let child = numbers.below(children);
        at = match at {
            Value::Array(list) => &mut list[child],
            Value::Object(map) => map.values_mut().nth(child).expect("counted above"),
            _ => return,
        };
    }
    let lie = || serde_json::from_str::<Value>("0").expect("a number");
    match (numbers.below(5), &mut *at) {
        (0, Value::Array(list)) => {
            let doubled = list.first().cloned().unwrap_or_else(lie);
            // As many as a list of a small file could have.
            for _ in 0..1 << numbers.below(12) {
                list.push(doubled.clone());
            }
        }
        (1, Value::Array(list)) if !list.is_empty() => drop(list.remove(numbers.below(list.len()))),
        (0 | 1, Value::Object(map)) if !map.is_empty() => {
            let key = map.keys().nth(numbers.below(map.len())).expect("counted above").clone();
            map.remove(&key);
        }
        (2, other) => {
            *other =
                Value::String(numbers.pick(&["", "MAT4", "SCALAR", "BLEND", "data:,", "../x", "\u{0}"]).to_string())
        }
        (_, other) => *other = serde_json::from_str(numbers.pick::<&str>(&LIES)).unwrap_or(Value::Null),
    }
}

/// The bytes of one mutated file.
fn mutated(glb: &Glb, numbers: &mut Numbers) -> Vec<u8> {
    let mut glb = glb.clone();
    for _ in 0..numbers.below(4) {
        bend(&mut glb.json, numbers);
    }
    for _ in 0..numbers.below(8) {
        let at = numbers.below(glb.binary.len());
        if let Some(byte) = glb.binary.get_mut(at) {
            *byte = numbers.next() as u8;
        }
    }
    let mut bytes = glb.bytes();
    // Then the container itself.
    match numbers.below(24) {
        0 => bytes.truncate(numbers.below(bytes.len())),
        1 => (0..4).for_each(|i| bytes[8 + i] = numbers.next() as u8),
        2 => (0..4).for_each(|i| bytes[12 + i] = numbers.next() as u8),
        3 => {
            let (from, to) = (numbers.below(bytes.len()), numbers.below(bytes.len()));
            let length = numbers.below(64).min(bytes.len() - from.max(to));
            bytes.copy_within(from..from + length, to);
        }
        4 => (0..numbers.below(6)).for_each(|_| {
            let at = numbers.below(bytes.len());
            bytes[at] ^= 1 << numbers.below(8);
        }),
        _ => {}
    }
    bytes
}

fn from_environment(variable: &str, otherwise: u64) -> u64 {
    std::env::var(variable).ok().map_or(otherwise, |text| text.parse().expect("a whole number"))
}

#[test]
fn mutated_files_cost_no_panic_and_little_memory() {
    let seed = from_environment("UMBRAGE_FUZZ_SEED", 1);
    let bases = [rich(), Glb::triangle()];
    let mut loaded = 0_u64;
    let mut most = 0;
    for number in 0..from_environment("UMBRAGE_FUZZ_FILES", FILES) {
        let mut numbers = Numbers(seed.wrapping_mul(0x2545_f491_4f6c_dd1d) ^ number);
        let glb = numbers.pick(&bases).clone();
        let bytes = mutated(&glb, &mut numbers);
        let outcome = std::panic::catch_unwind(|| allocation_counter::measure(|| exercise(&bytes)).bytes_max);
        let Ok(held) = outcome else { panic!("seed {seed}, file {number}: the loader panicked") };
        assert!(held < MOST_BYTES, "seed {seed}, file {number}: {held} bytes for a file of {}", bytes.len());
        most = most.max(held);
        loaded += u64::from(
            umbrage_scene::load_gltf_slice("mutated.glb", &bytes, &umbrage_scene::GltfOptions::default()).is_ok(),
        );
    }
    eprintln!("{loaded} files loaded, {} MiB at most", most >> 20);
    assert!(loaded > 0, "mutations leave some files whole");
}
