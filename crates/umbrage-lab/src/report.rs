//! Reports of pictures: the scene, the settings, and the cost. Field names are the contract of the
//! command line.

use serde::{Deserialize, Serialize};

/// Report of one frame of `render` or `probe`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Report {
    /// Scene, camera and sun.
    #[serde(flatten)]
    pub shot: ShotReport,
    /// Name of the graphics adapter.
    pub adapter: String,
    /// Technique: `pssm`, or a single map: `ssm`, `psm`, `lispsm` or `tsm`.
    pub technique: String,
    /// Way in which the maps were drawn: `multipass`, `per-split`, `layered`, `instanced` or
    /// `mixed`.
    pub generation: String,
    /// Storage of the maps: `array`, `atlas`, `separate`, `cube` or `reused`.
    pub storage: String,
    /// Filter, as `--filter` names it.
    pub filter: String,
    /// Width of the filter in metres in every split; `None` if its width is in texels.
    pub filter_width: Option<f64>,
    /// Angular diameter of the sun in degrees, for a filter that uses it.
    pub sun_angle: Option<f64>,
    /// Transition between neighbouring splits: `blend`, `dither` or `hard`.
    pub transition: String,
    /// Bias that keeps surfaces from shading themselves: `plane` or `slope`.
    pub bias: String,
    /// Shadows of translucent surfaces: `none` or `dithered`.
    pub translucent: String,
    /// True if contact shadows were asked for. A note says if there can be none.
    pub contact_shadows: bool,
    /// Darkness of shadows, 0 to 1.
    pub shadow_strength: f64,
    /// Factor of the sun's light in full shadow, in linear red, green and blue.
    pub shadow_colour: [f64; 3],
    /// Fit of the maps: `dependent` or `independent`.
    pub fit: String,
    /// Stabilisation of the maps: `none`, `exact` or `approximate`.
    pub stabilize: String,
    /// Metric of `planes_m` and of the splits' ends: `planar` for view depth, `radial` for distance
    /// to the eye.
    pub bands: String,
    /// Split scheme: `uniform`, `log`, `practical`, `manual` or `optimal`.
    pub scheme: String,
    /// Warp of all splits or of each: `none`, `psm`, `lispsm` or `tsm`.
    pub warp: Vec<String>,
    /// All settings by key. `--config` reads them back, together with the options.
    pub config: umbrage::ShadowConfig,
    /// Split planes `C_0 ..= C_m`: view depths in metres.
    pub planes_m: Vec<f64>,
    /// Times of the frame.
    pub times_ms: TimesMs,
    /// Bytes of all shadow maps.
    pub bytes: u64,
    /// Number of draw calls into all maps. A call may draw into several maps.
    pub draws: u64,
    /// Number of triangles submitted to all maps, counting every instance.
    pub triangles: u64,
    /// Number of casters that each split's list of the first light leaves out because their shadows
    /// are small (`--drop-small-casters`).
    pub dropped_casters: Vec<u32>,
    /// Splits of the first light, nearest first. Those of other lights are in `lights`.
    pub splits: Vec<SplitReport>,
    /// Counts of exact edges for the picture of the first light; `None` with sampled edges.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub edges: Option<crate::edges::EdgesReport>,
    /// Views beside the first one, from left to right.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub beside: Vec<BesideReport>,
    /// Answers of `probe`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub probe: Option<ProbeReport>,
    /// Fallbacks in use, and invented defaults.
    pub notes: Vec<String>,
}

/// Report of a view beside the first one.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct BesideReport {
    /// Camera of the view.
    pub camera: CameraReport,
    /// Split planes `C_0 ..= C_m` of the first light: view depths in metres.
    pub planes_m: Vec<f64>,
    /// Times of the view.
    pub times_ms: TimesMs,
    /// All lights with their splits.
    pub lights: Vec<LightReport>,
}

/// Report of one frame of `truth`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TruthReport {
    /// Scene, camera and sun.
    #[serde(flatten)]
    pub shot: ShotReport,
    /// Times of the frame.
    pub times_ms: TruthTimesMs,
    /// Invented defaults, and parts of the scene that were left out.
    pub notes: Vec<String>,
}

/// Scene, camera and sun of a picture.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ShotReport {
    /// Scene as it was typed.
    pub scene: String,
    /// Scene, camera, light and time as options of `umbrage render`, from which `--config` draws
    /// the picture again.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub options: Vec<String>,
    /// Time of the animations in seconds.
    pub time_s: f64,
    /// Number of the frame along a path.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub frame: Option<u32>,
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Camera of the picture.
    pub camera: CameraReport,
    /// Direction in which the first light travels, as a unit vector, if it is a sun.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sun: Option<[f64; 3]>,
    /// All lights, the first one first, with the splits of each for which maps were made.
    pub lights: Vec<LightReport>,
    /// Suns whose shadows are shown, with `--sun-to`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sun_shown: Option<SunShown>,
}

/// Suns whose shadows are shown, as unit vectors along the light, and the share of the second.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct SunShown {
    /// Sun that is faded from.
    pub from: [f64; 3],
    /// Sun that is faded to.
    pub to: [f64; 3],
    /// Share of the sun that is faded to, 0 to 1.
    pub weight: f64,
}

/// Camera of a picture; lengths in metres, angles in degrees.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
pub struct CameraReport {
    /// Name of the camera, or how it was chosen.
    pub name: String,
    /// Position of the eye.
    pub eye: [f64; 3],
    /// Viewing direction, a unit vector.
    pub forward: [f64; 3],
    /// Up direction, a unit vector.
    pub up: [f64; 3],
    /// Vertical field of view; `None` for an orthographic camera.
    pub fov: Option<f64>,
    /// Near distance.
    pub near: f64,
    /// Far distance; `None` if it is infinite.
    pub far: Option<f64>,
}

/// Times in milliseconds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct TimesMs {
    /// Time of the planner.
    pub plan: f64,
    /// Time of drawing the maps.
    pub shadow: f64,
    /// Time of the whole frame.
    pub frame: f64,
}

/// Times of the ground truth in milliseconds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct TruthTimesMs {
    /// Time of building the acceleration structure.
    pub build: f64,
    /// Time of tracing the rays.
    pub rays: f64,
}

/// Report of one split.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct SplitReport {
    /// View depth in metres at which the split begins.
    pub near: f64,
    /// View depth in metres at which the split ends.
    pub far: f64,
    /// Larger edge of a texel on the light's plane, in metres; for a warped map, in the middle of
    /// its receivers.
    pub texel_m: f64,
    /// True if the map is warped. A warp without a gain leaves the map unwarped.
    pub warped: bool,
    /// Number of casters in the split's list: glTF mesh nodes, or instances of them.
    pub casters: u64,
    /// Number of draw calls that draw into the map.
    pub draws: u64,
    /// Number of triangles of the casters.
    pub triangles: u64,
    /// Bytes of the map.
    pub bytes: u64,
}

/// Report of one light of a frame.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LightReport {
    /// Name of the light: the scene's, its number, or how it was given.
    pub name: String,
    /// Kind of the light: `directional`, `spot` or `point`.
    pub kind: &'static str,
    /// Direction in which a sun's light travels, or a spot light's axis: a unit vector.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub direction: Option<[f64; 3]>,
    /// Position of a spot or point light in metres.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub position: Option<[f64; 3]>,
    /// Range of a spot or point light in metres.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub range_m: Option<f64>,
    /// Angle in degrees between a spot light's axis and its rim.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub outer_angle: Option<f64>,
    /// Split planes `C_0 ..= C_m` of the light's plan: view depths in metres.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub planes_m: Vec<f64>,
    /// Splits of the light, nearest first. A point light has those of its face +X, then those of
    /// −X, +Y, −Y, +Z and −Z.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub splits: Vec<SplitReport>,
}

/// Part of a report that `probe` adds.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ProbeReport {
    /// Split that answered for each point; −1 if none did.
    pub split: Vec<i32>,
}

/// Writes a report as JSON, indented, with a newline at its end.
///
/// # Errors
/// [`crate::failure::Failure::Other`] if a value cannot be written as JSON, which would be a
/// mistake of ours.
pub fn to_json(report: &impl Serialize) -> crate::failure::Result<Vec<u8>> {
    let mut json = serde_json::to_vec_pretty(report)
        .map_err(|error| crate::failure::Failure::other(format!("the report cannot be written as JSON: {error}")))?;
    json.push(b'\n');
    Ok(json)
}
