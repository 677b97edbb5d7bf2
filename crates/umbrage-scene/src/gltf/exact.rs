//! The numbers of nodes as the file has them. The `gltf` crate keeps them in `f32`, which moves
//! what stands far from the origin: 4 m at 100,000 km. A camera beside it moves otherwise.

use serde::Deserialize;

/// The transform of a node in `f64`; what the file does not give is `None`.
#[derive(Clone, Copy, Debug, Default, Deserialize)]
#[serde(default)]
pub(super) struct ExactNode {
    pub matrix: Option<[f64; 16]>,
    pub translation: Option<[f64; 3]>,
    pub rotation: Option<[f64; 4]>,
    pub scale: Option<[f64; 3]>,
}

/// The nodes of a file, in its order.
#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(super) struct Exact {
    nodes: Vec<ExactNode>,
}

impl Exact {
    /// Reads them once more from a JSON that has been read. Of a JSON that is not as it should be
    /// nothing is known here, and the numbers that have been read stand.
    pub(super) fn of(json: &[u8]) -> Self {
        serde_json::from_slice(json).unwrap_or_default()
    }

    pub(super) fn node(&self, index: usize) -> ExactNode {
        self.nodes.get(index).copied().unwrap_or_default()
    }
}

/// Numbers in `f64`, or those in `f32` where they are not known better: where both are not the same
/// number, rounded.
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
