//! Mutations of files for compilers without libFuzzer.

/// Vigna's SplitMix64 (2015): numbers that follow from a seed alone, on every machine.
#[derive(Clone, Debug)]
pub struct Numbers(u64);

impl Numbers {
    /// The numbers of a seed.
    #[must_use]
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// The next number.
    pub fn number(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// A number below `end`; 0 if that is 0.
    pub fn below(&mut self, end: usize) -> usize {
        if end == 0 { 0 } else { (self.number() % end as u64) as usize }
    }
}

/// Words that lie about numbers in texts.
const LIES: [&str; 12] =
    ["0", "-1", "1e308", "-1e308", "1e-320", "nan", "inf", "18446744073709551616", "", "[]", "{}", "\u{0}"];

/// Changes a file of a corpus in a few places. `other` is another file of it, of which parts are
/// taken.
#[must_use]
pub fn mutated(file: &[u8], other: &[u8], numbers: &mut Numbers) -> Vec<u8> {
    let mut bytes = file.to_vec();
    for _ in 0..=numbers.below(5) {
        let at = numbers.below(bytes.len());
        match numbers.below(6) {
            0 => bytes.truncate(at),
            1 => {
                let begin = numbers.below(other.len());
                let part = &other[begin..(begin + numbers.below(64)).min(other.len())];
                bytes.splice(at..at, part.iter().copied());
            }
            2 => {
                // A number or a word of a text becomes a lie.
                let ends = |byte: &u8| !(byte.is_ascii_alphanumeric() || *byte == b'.' || *byte == b'-');
                let end = bytes[at..].iter().position(ends).map_or(bytes.len(), |length| at + length);
                bytes.splice(at..end, LIES[numbers.below(LIES.len())].bytes());
            }
            3 => {
                let end = (at + numbers.below(16)).min(bytes.len());
                bytes.drain(at..end);
            }
            _ => {
                if let Some(byte) = bytes.get_mut(at) {
                    *byte = if numbers.below(2) == 0 { numbers.number() as u8 } else { *byte ^ 1 << numbers.below(8) };
                }
            }
        }
    }
    bytes
}
