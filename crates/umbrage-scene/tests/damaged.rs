//! Files damaged at random never bring the loader down, and what still loads can be posed and
//! written.

mod common;

use common::exercise::exercise;
use common::rich::rich;
use common::*;
use proptest::prelude::*;
use serde_json::json;

#[test]
fn the_rich_file_is_whole() {
    let scene = rich().scene();
    assert_eq!((scene.cameras.len(), scene.lights.len(), scene.skins.len(), scene.animations.len()), (1, 1, 1, 1));
    assert_eq!(scene.pose(0.25).unwrap_or_else(|e| panic!("{e}")).objects.len(), 3);
    exercise(&rich().bytes());
}

#[test]
fn no_truncation_panics() {
    let bytes = rich().bytes();
    (0..bytes.len()).step_by(7).for_each(|length| exercise(&bytes[..length]));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn flipped_bytes_never_panic(flips in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..6)) {
        let mut bytes = rich().bytes();
        for (at, with) in flips {
            let at = at.index(bytes.len());
            bytes[at] ^= with;
        }
        exercise(&bytes);
    }

    /// Damage that keeps the JSON a JSON: any number in it becomes another one.
    #[test]
    fn changed_numbers_never_panic(
        changes in prop::collection::vec((any::<prop::sample::Index>(), prop_oneof![
            Just("0".to_owned()), Just("1".to_owned()), Just("3".to_owned()), Just("-1".to_owned()), Just("1e39".to_owned()),
            Just("18446744073709551615".to_owned()), Just("4294967296".to_owned()), Just("null".to_owned()),
            (0_u32..200).prop_map(|n| n.to_string()), Just("5126".to_owned()), Just("5123".to_owned()),
        ]), 1..4),
    ) {
        let glb = rich();
        let mut json = glb.json.clone();
        json["buffers"] = json!([{ "byteLength": glb.binary.len() }]);
        let mut text = json.to_string();
        for (at, with) in changes {
            let starts: Vec<usize> = text
                .char_indices()
                .filter(|&(i, c)| c.is_ascii_digit() && matches!(text.as_bytes()[i - 1], b':' | b',' | b'[' | b'-'))
                .map(|(i, _)| i)
                .collect();
            let start = starts[at.index(starts.len())];
            let length = text[start..].find(|c: char| !c.is_ascii_digit() && c != '.').unwrap_or(1);
            text.replace_range(start..start + length, &with);
        }
        exercise(&container(text.as_bytes(), Some(&glb.binary)));
    }

    #[test]
    fn noise_never_panics(bytes in prop::collection::vec(any::<u8>(), 0..64)) {
        exercise(&bytes);
        let mut glb = b"glTF\x02\0\0\0".to_vec();
        glb.extend_from_slice(&bytes);
        exercise(&glb);
    }
}
