//! The report: what was drawn, with what, and what it cost. Field names are the contract of the
//! command line.

use serde::{Deserialize, Serialize};

/// The report of one frame of `render` or `probe`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Report {
    /// Scene, camera and sun.
    #[serde(flatten)]
    pub shot: ShotReport,
    /// The graphics adapter.
    pub adapter: String,
    /// `pssm`, or a single map: `ssm`, `psm`, `lispsm` or `tsm`.
    pub technique: String,
    /// How the maps were drawn: `multipass`, `per-split`, `layered`, `instanced` or `mixed`.
    pub generation: String,
    /// How the maps are kept: `array`, `atlas`, `separate`, `cube` or `reused`.
    pub storage: String,
    /// As `--filter` names it.
    pub filter: String,
    /// Metres that the filter is wide in every split; none where its width is in texels.
    pub filter_width: Option<f64>,
    /// Angular diameter of the sun in degrees, of a filter that uses it.
    pub sun_angle: Option<f64>,
    /// `blend`, `dither` or `hard`: how neighbouring splits are joined.
    pub transition: String,
    /// `plane` or `slope`: how surfaces are kept from shading themselves.
    pub bias: String,
    /// `none` or `dithered`: whether translucent surfaces cast shadows.
    pub translucent: String,
    /// Whether contact shadows were asked for; a note says where there can be none.
    pub contact_shadows: bool,
    /// How dark shadows are, 0 to 1.
    pub shadow_strength: f64,
    /// What the sun's light is multiplied by in full shadow, linear red, green and blue.
    pub shadow_colour: [f64; 3],
    /// `dependent` or `independent`.
    pub fit: String,
    /// `none`, `exact` or `approximate`.
    pub stabilize: String,
    /// `planar` or `radial`: what `planes_m` and the splits' ends measure, view depth or distance
    /// to the eye.
    pub bands: String,
    /// Where planes stand: `uniform`, `log`, `practical`, `manual` or `optimal`.
    pub scheme: String,
    /// `none`, `psm`, `lispsm` or `tsm`: one for all splits, or one for each.
    pub warp: Vec<String>,
    /// Every setting, under its key: what `--config` reads back, beside the options.
    pub config: umbrage::ShadowConfig,
    /// `C_0 ..= C_m`: view depths in metres.
    pub planes_m: Vec<f64>,
    /// How long it took.
    pub times_ms: TimesMs,
    /// Bytes of all shadow maps.
    pub bytes: u64,
    /// Draw calls into all maps; a call may draw into several.
    pub draws: u64,
    /// Triangles submitted to all maps, every instance counted once.
    pub triangles: u64,
    /// Of the first light, for each split: how many casters its list leaves out because their
    /// shadows are small (`--drop-small-casters`).
    pub dropped_casters: Vec<u32>,
    /// The splits of the first light, nearest first; the others' are in `lights`.
    pub splits: Vec<SplitReport>,
    /// What exact edges did for the picture of the first light; none where edges are sampled.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub edges: Option<crate::edges::EdgesReport>,
    /// The views beside the first one, from left to right.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub beside: Vec<BesideReport>,
    /// The answers of `probe`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub probe: Option<ProbeReport>,
    /// Fallbacks taken, defaults invented.
    pub notes: Vec<String>,
}

/// A view beside the first one.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct BesideReport {
    /// The eye.
    pub camera: CameraReport,
    /// `C_0 ..= C_m` of the first light: view depths in metres.
    pub planes_m: Vec<f64>,
    /// How long it took.
    pub times_ms: TimesMs,
    /// All lights with their splits.
    pub lights: Vec<LightReport>,
}

/// The report of one frame of `truth`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TruthReport {
    /// Scene, camera and sun.
    #[serde(flatten)]
    pub shot: ShotReport,
    /// How long it took.
    pub times_ms: TruthTimesMs,
    /// Defaults invented, parts of the scene left out.
    pub notes: Vec<String>,
}

/// What was looked at, from where, under which sun.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ShotReport {
    /// As typed.
    pub scene: String,
    /// Scene, camera, light and time as options of `umbrage render`: what `--config` draws again.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub options: Vec<String>,
    /// Seconds into the animations.
    pub time_s: f64,
    /// Along a path: which frame.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub frame: Option<u32>,
    /// Pixels across and down.
    pub size: [u32; 2],
    /// The eye.
    pub camera: CameraReport,
    /// The way the first light travels, a unit vector, if it is a sun.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sun: Option<[f64; 3]>,
    /// All lights, the first one first, with the splits of each where maps were made.
    pub lights: Vec<LightReport>,
    /// With --sun-to: the suns whose shadows are shown.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sun_shown: Option<SunShown>,
}

/// The suns whose shadows are shown, unit vectors along the light, and the share of the second.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct SunShown {
    /// The sun that is left.
    pub from: [f64; 3],
    /// The sun that is faded to.
    pub to: [f64; 3],
    /// Its share, 0 to 1.
    pub weight: f64,
}

/// The eye: metres and degrees.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
pub struct CameraReport {
    /// Where the camera comes from: its name, or how it was chosen.
    pub name: String,
    /// Position.
    pub eye: [f64; 3],
    /// The way it looks, a unit vector.
    pub forward: [f64; 3],
    /// Its up, a unit vector.
    pub up: [f64; 3],
    /// Vertical field of view; none for an orthographic camera.
    pub fov: Option<f64>,
    /// Near plane.
    pub near: f64,
    /// Far plane; none if there is none.
    pub far: Option<f64>,
}

/// Milliseconds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct TimesMs {
    /// The planner.
    pub plan: f64,
    /// Drawing the maps.
    pub shadow: f64,
    /// The whole frame.
    pub frame: f64,
}

/// Milliseconds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct TruthTimesMs {
    /// Building the acceleration structure.
    pub build: f64,
    /// Casting the rays.
    pub rays: f64,
}

/// One split.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct SplitReport {
    /// View depth where it begins, metres.
    pub near: f64,
    /// View depth where it ends, metres.
    pub far: f64,
    /// The larger edge of a texel on the light's plane, metres; of a warped map in the middle of
    /// its receivers.
    pub texel_m: f64,
    /// Whether its map is warped; a warp that has nothing to gain leaves it plain.
    pub warped: bool,
    /// glTF mesh nodes, or instances of them, in the split's list.
    pub casters: u64,
    /// Draw calls that draw into its map.
    pub draws: u64,
    /// Triangles of its casters.
    pub triangles: u64,
    /// Bytes of its map.
    pub bytes: u64,
}

/// One light of a frame.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LightReport {
    /// The scene's name for it, its number, or how it was given.
    pub name: String,
    /// `directional`, `spot` or `point`.
    pub kind: &'static str,
    /// The way a sun's light travels, or a spot light's axis: a unit vector.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub direction: Option<[f64; 3]>,
    /// Where a spot or point light stands, metres.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub position: Option<[f64; 3]>,
    /// How far a spot or point light shines, metres.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub range_m: Option<f64>,
    /// Degrees between a spot light's axis and its rim.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub outer_angle: Option<f64>,
    /// `C_0 ..= C_m` of its plan: view depths in metres.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub planes_m: Vec<f64>,
    /// Its splits, nearest first; of a point light those of its face +X, then those of −X, +Y, −Y,
    /// +Z and −Z.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub splits: Vec<SplitReport>,
}

/// What `probe` adds.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ProbeReport {
    /// For each point the split that answered, −1 if none did.
    pub split: Vec<i32>,
}

/// JSON, indented, with a newline at its end.
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
