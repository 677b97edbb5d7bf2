//! The numbers of nodes in the file's precision. The `gltf` crate keeps them in `f32`, which moves
//! nodes far from the origin: by 4 m at 100,000 km. A camera beside such a node moves by another
//! amount.

use serde::Deserialize;

/// Transform of a node in `f64`; `None` for each part that the file does not give.
#[derive(Clone, Copy, Debug, Default, Deserialize)]
#[serde(default)]
pub(super) struct ExactNode {
    pub matrix: Option<[f64; 16]>,
    pub translation: Option<[f64; 3]>,
    pub rotation: Option<[f64; 4]>,
    pub scale: Option<[f64; 3]>,
}

/// Exact nodes of a file, in its order.
#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(super) struct Exact {
    nodes: Vec<ExactNode>,
}

impl Exact {
    /// Reads the nodes again from a JSON that was parsed before. If that JSON is malformed no exact
    /// numbers are known, and the parsed ones are used.
    pub(super) fn of(json: &[u8]) -> Self {
        serde_json::from_slice(json).unwrap_or_default()
    }

    pub(super) fn node(&self, index: usize) -> ExactNode {
        self.nodes.get(index).copied().unwrap_or_default()
    }
}

/// Returns the numbers in `f64`, or those in `f32` where the exact ones are missing or round to
/// other numbers.
pub(super) fn or_rounded<const N: usize>(exact: Option<[f64; N]>, rounded: [f32; N]) -> [f64; N] {
    let agrees = |(exact, rounded): (&f64, &f32)| *exact as f32 == *rounded;
    exact.filter(|exact| exact.iter().zip(&rounded).all(agrees)).unwrap_or(rounded.map(f64::from))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_keep_their_digits_and_broken_files_their_numbers() {
        let exact = Exact::of(br#"{ "nodes": [{}, { "translation": [100000000.125, 0.1, -3] }] }"#);
        let read = exact.node(1).translation;
        assert_eq!(or_rounded(read, [1e8, 0.1, -3.0]), [100_000_000.125, 0.1, -3.0]);
        assert_eq!(or_rounded(read, [7.0, 0.5, -3.0]), [7.0, 0.5, -3.0], "another number altogether");
        assert!(exact.node(0).translation.is_none() && exact.node(9).matrix.is_none());
        assert!(Exact::of(br#"{ "nodes": [{ "translation": "far" }] }"#).node(0).translation.is_none());
    }
}
