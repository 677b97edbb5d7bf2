//! Parallel-split (cascaded) shadow maps: the planner. No GPU, no I/O; values in, values out.
//!
//! # Conventions
//!
//! | space | axes | range |
//! |---|---|---|
//! | world | right-handed, +Y up, metres, `f64` | unbounded; 100 km from the origin is as good as 0 |
//! | view | right-handed, +X right, +Y up, looks down −Z | *view depth* `d = −z`, positive in front |
//! | camera clip, NDC | x, y in [−1,1], y up | z in [0,1], reversed (1 at near), infinite far allowed |
//! | light | u right, v down, depth along the light's travel; fixed to the light, never to the camera | metres |
//! | local light | the same around a spot light's axis or a face of a point light, in the light's post-perspective space: `u/w`, `v/w`, depth `A − B/w` | tangents |
//! | shadow NDC | x, y in [−1,1], y up | z in [0,1], 0 nearest to the light |
//! | shadow texture | u right, v **down** | texels, [0, size]² per split |
//!
//! Column vectors, column-major matrices, radians. A transform is named `target_from_source`. Splits count from 0;
//! `C_0 = n` and `C_m = f` are the ends of the shadowed range.
//!
//! # Speed in a development build
//!
//! Planning is some fifty times slower without optimisation. Let Cargo optimise the planner in an application's `dev`
//! profile, too:
//!
//! ```toml
//! [profile.dev.package.umbrage]
//! opt-level = 3
//! [profile.dev.package.glam]
//! opt-level = 3
//! ```

mod alias;
mod bands;
mod bias;
mod bounds;
mod camera;
mod cells;
pub mod config;
mod covered;
mod error;
mod fit;
mod light;
mod local;
mod margin;
mod placement;
mod plan;
mod planner;
mod range;
mod reach;
mod receiver_mask;
mod rectangle;
mod region;
mod settings;
mod split;
mod stable;
mod stepped;
mod volume;
mod warp;
mod warped;

pub use bands::Bands;
pub use bias::{Bias, STEEPEST};
pub use bounds::Aabb;
pub use camera::{DepthConvention, Frustum, Projection, View};
pub use config::ShadowConfig;
pub use error::{Error, Result};
pub use light::{DirectionalLight, Light, PointLight, SpotLight};
pub use plan::{ShadowPlan, Split};
pub use planner::Planner;
pub use settings::{ExtentSteps, Fit, MAX_SPLITS, RangeFit, Selection, ShadowSettings, SplitScheme, Stabilize};
pub use split::split_planes;
pub use stable::{Sphere, slice_sphere, stable_texel};
pub use stepped::{SteppedSun, SunFade};
pub use warp::{Warp, WarpTarget, texels_along};
