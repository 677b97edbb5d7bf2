//! Kept results of a run: the numbers that docs/results.md shows, with the build that they were
//! measured on.
//!
//! The structs read the report of `umbrage compare` or `umbrage bench`, leaving out unnamed keys,
//! and write the kept file. A named key that is missing is an error, because a page without a
//! number would look as if there were none.

use serde::{Deserialize, Deserializer, Serialize, Serializer, de::DeserializeOwned};

/// A kept file: the results of one job, with their origin.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Kept<T> {
    /// Build that was measured.
    pub build: Build,
    /// The command line.
    pub command: String,
    /// Seconds that the job took.
    pub seconds: u64,
    /// Results of the job.
    pub figures: T,
}

/// A build, which is the same for all kept files of one page.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Build {
    /// Git's name of the commit, with `+` if tracked files differed from it.
    pub commit: String,
    /// Day of the commit, YYYY-MM-DD.
    pub day: String,
    /// Graphics adapter and its driver.
    pub adapter: String,
}

/// Results of `umbrage compare`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Comparison {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Results of each technique.
    pub techniques: Vec<Technique>,
    /// Results of each shot.
    pub views: Vec<View>,
    /// Results of cameras that moved.
    pub walks: Vec<Walk>,
}

/// Mean results of a technique over the views that count.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Technique {
    /// Label of the technique in tables.
    pub label: String,
    /// Bytes of all maps.
    pub bytes: u64,
    /// Means over the views that count.
    pub mean: Means,
}

/// Means over the views that count; `None` if none does.
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
    /// E_soft, with `--sun-angle` only.
    #[serde(default, skip_serializing_if = "Option::is_none", serialize_with = "rounded")]
    pub e_soft: Option<f64>,
    /// E_pen, with `--sun-angle` only.
    #[serde(default, skip_serializing_if = "Option::is_none", serialize_with = "rounded")]
    pub e_pen: Option<f64>,
}

/// Results of a shot.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct View {
    pub scene: String,
    pub camera: Camera,
    pub sun_name: String,
    pub counts: bool,
    /// Scores of each technique, in order.
    pub scores: Vec<Scores>,
}

/// Camera of a shot.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Camera {
    pub name: String,
}

/// Scores of one technique in one shot; `None` where nothing could be counted.
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

/// Results of a camera that moved.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Walk {
    pub scene: String,
    pub frames: usize,
    pub counts: bool,
    /// Flicker of each technique, in order.
    pub flicker: Vec<Flicker>,
}

/// Flicker of one technique along one walk.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Flicker {
    pub steps: usize,
}

/// Results of `umbrage bench`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Bench {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Number of rounds that count.
    pub rounds: u32,
    /// Results of each scene.
    pub scenes: Vec<Scene>,
}

/// Results of a scene.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Scene {
    /// Name or file of the scene.
    pub scene: String,
    /// Results of each technique; the first is the baseline.
    pub rows: Vec<Row>,
}

/// Results of a technique on a scene.
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

/// Statistics of repeated measurements.
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

/// Reads `null` as `None` and refuses a missing key, which serde's own reading of an [`Option`]
/// does not.
fn present<'de, D: Deserializer<'de>, T: DeserializeOwned>(deserializer: D) -> Result<Option<T>, D::Error> {
    Option::deserialize(deserializer)
}

/// Writes four significant digits: one more than a table shows.
fn rounded<S: Serializer>(value: &Option<f64>, serializer: S) -> Result<S::Ok, S::Error> {
    value.map(significant).serialize(serializer)
}

fn rounded_number<S: Serializer>(value: &f64, serializer: S) -> Result<S::Ok, S::Error> {
    significant(*value).serialize(serializer)
}

/// Rounds to four significant digits.
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
