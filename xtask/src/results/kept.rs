//! What is kept of a run: the figures that docs/results.md shows and the build that they are of.
//!
//! The structs read the report of `umbrage compare` or `umbrage bench`, leaving out what they do
//! not name, and write the kept file. A key that they name and do not find is an error: a page
//! without a figure would look as if there were none.

use serde::{Deserialize, Deserializer, Serialize, Serializer, de::DeserializeOwned};

/// A kept file: one job's figures and where they come from.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Kept<T> {
    /// The build.
    pub build: Build,
    /// The command line.
    pub command: String,
    /// Seconds that the job took.
    pub seconds: u64,
    /// The figures.
    pub figures: T,
}

/// A build, as all kept files of one page have it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Build {
    /// Git's name of the commit, with `+` where tracked files differed from it.
    pub commit: String,
    /// The commit's day, YYYY-MM-DD.
    pub day: String,
    /// The graphics adapter and its driver.
    pub adapter: String,
}

/// Of `umbrage compare`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Comparison {
    /// Pixels across and down.
    pub size: [u32; 2],
    /// The rows.
    pub techniques: Vec<Technique>,
    /// The shots.
    pub views: Vec<View>,
    /// Cameras that went on.
    pub walks: Vec<Walk>,
}

/// A technique and its means over the views that count.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Technique {
    /// As in tables.
    pub label: String,
    /// Bytes of all maps.
    pub bytes: u64,
    /// The means.
    pub mean: Means,
}

/// Means over the views that count; nothing where none does.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Means {
    pub views: usize,
    #[serde(deserialize_with = "present", serialize_with = "rounded")]
    pub e: Option<f64>,
    #[serde(deserialize_with = "present", serialize_with = "rounded")]
    pub e_false_shadow: Option<f64>,
    #[serde(deserialize_with = "present", serialize_with = "rounded")]
    pub e_false_light: Option<f64>,
    #[serde(deserialize_with = "present", serialize_with = "rounded")]
    pub e_log: Option<f64>,
    #[serde(deserialize_with = "present", serialize_with = "rounded")]
    pub edge_distance_px: Option<f64>,
    #[serde(deserialize_with = "present", serialize_with = "rounded")]
    pub flicker_per_edge: Option<f64>,
    #[serde(deserialize_with = "present", serialize_with = "rounded")]
    pub kept_flicker_per_edge: Option<f64>,
    /// With `--sun-angle` alone.
    #[serde(default, skip_serializing_if = "Option::is_none", serialize_with = "rounded")]
    pub e_soft: Option<f64>,
    /// With `--sun-angle` alone.
    #[serde(default, skip_serializing_if = "Option::is_none", serialize_with = "rounded")]
    pub e_pen: Option<f64>,
}

/// A shot.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct View {
    pub scene: String,
    pub camera: Camera,
    pub sun_name: String,
    pub counts: bool,
    /// One per technique, in their order.
    pub scores: Vec<Scores>,
}

/// An eye.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Camera {
    pub name: String,
}

/// What one technique scores in one shot; nothing where nothing could be counted.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Scores {
    #[serde(deserialize_with = "present", serialize_with = "rounded")]
    pub e: Option<f64>,
    #[serde(deserialize_with = "present", serialize_with = "rounded")]
    pub acne: Option<f64>,
    #[serde(deserialize_with = "present", serialize_with = "rounded")]
    pub leak: Option<f64>,
    #[serde(deserialize_with = "present", serialize_with = "rounded")]
    pub beyond_edges: Option<f64>,
}

/// A camera that went on.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Walk {
    pub scene: String,
    pub frames: usize,
    pub counts: bool,
    /// One per technique, in their order.
    pub flicker: Vec<Flicker>,
}

/// Flicker of one technique along one walk.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Flicker {
    pub steps: usize,
}

/// Of `umbrage bench`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Bench {
    /// Pixels across and down.
    pub size: [u32; 2],
    /// Rounds that count.
    pub rounds: u32,
    /// One per scene.
    pub scenes: Vec<Scene>,
}

/// A scene's table.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Scene {
    /// Its name or file.
    pub scene: String,
    /// One per technique; the first is the baseline.
    pub rows: Vec<Row>,
}

/// A technique on a scene.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Row {
    pub technique: String,
    #[serde(deserialize_with = "present")]
    pub frame_ratio: Option<Spread>,
    #[serde(deserialize_with = "present", serialize_with = "rounded")]
    pub paper_ratio: Option<f64>,
    pub samples: u32,
    pub draws: u64,
    pub map_bytes: u64,
    #[serde(deserialize_with = "present")]
    pub shadow_counts: Option<Counts>,
}

/// Many measurements of one thing.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Spread {
    #[serde(serialize_with = "rounded_number")]
    pub median: f64,
    #[serde(serialize_with = "rounded_number")]
    pub deviation: f64,
}

/// Pipeline statistics of the maps.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Counts {
    pub vertices: u64,
}

/// Reads `null` as nothing and refuses a key that is not there, which serde's own reading of an
/// [`Option`] does not.
fn present<'de, D: Deserializer<'de>, T: DeserializeOwned>(deserializer: D) -> Result<Option<T>, D::Error> {
    Option::deserialize(deserializer)
}

/// Writes four significant digits: what a table shows and one to spare.
fn rounded<S: Serializer>(value: &Option<f64>, serializer: S) -> Result<S::Ok, S::Error> {
    value.map(significant).serialize(serializer)
}

fn rounded_number<S: Serializer>(value: &f64, serializer: S) -> Result<S::Ok, S::Error> {
    significant(*value).serialize(serializer)
}

/// Four significant digits.
fn significant(value: f64) -> f64 {
    format!("{value:.3e}").parse().unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn four_digits_are_kept() {
        assert_eq!(significant(0.012_345_678), 0.01235);
        assert_eq!(significant(-123_456.0), -123_500.0);
        assert_eq!(significant(0.0), 0.0);
    }

    #[test]
    fn a_missing_key_is_an_error_and_null_is_nothing() {
        let whole = r#"{"e": null, "acne": 0.1, "leak": 0.2, "beyond_edges": 0.9, "more": 1}"#;
        let scores: Scores = serde_json::from_str(whole).expect("null is allowed, and what is not named is left out");
        assert_eq!((scores.e, scores.acne), (None, Some(0.1)));
        let error =
            serde_json::from_str::<Scores>(r#"{"e": null, "acne": 0.1, "leak": 0.2}"#).expect_err("no beyond_edges");
        assert!(error.to_string().contains("missing field `beyond_edges`"), "{error}");
    }
}
