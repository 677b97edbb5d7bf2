//! Parallel-split (cascaded) shadow maps: the planner. No GPU, no I/O; values in, values out.
//!
//! # Conventions
//!
//! | space | axes | range |
//! |---|---|---|
//! | world | right-handed, +Y up, metres, `f64` | unbounded; 100 km from the origin is as good as 0 |
//! | view | right-handed, +X right, +Y up, looks down −Z | *view depth* `d = −z`, positive in front |
//! | camera clip, NDC | x, y in [−1,1], y up | z in \[0,1\], reversed (1 at near), infinite far allowed |
//! | light | u right, v down, depth along the light's travel; fixed to the light, never to the camera | metres |
//! | local light | the same around a spot light's axis or a face of a point light, in the light's post-perspective space: `u/w`, `v/w`, depth `A − B/w` | tangents |
//! | shadow NDC | x, y in [−1,1], y up | z in \[0,1\], 0 nearest to the light |
//! | shadow texture | u right, v **down** | texels, [0, size]² per split |
//!
//! Column vectors, column-major matrices, radians. A transform is named `target_from_source`.
//! Splits count from 0; `C_0 = n` and `C_m = f` are the ends of the shadowed range.
//!
//! # Reproducible plans
//!
//! Equal inputs give equal plans, bit for bit, in every run, on any number of threads and with any
//! mathematical functions of the operating system. The planner calls only `libm`, which is compiled
//! in, and operations that IEEE 754 defines exactly. It reads no clock and no random numbers, and
//! iterates over no hash table. The test `reproducible` compares plans with recorded ones. The
//! inputs count: a camera built with the system's `sin` may differ in its last bits from machine to
//! machine.
//!
//! # Speed in a development build
//!
//! Planning is about fifty times slower without optimisation. Let Cargo optimise the planner in the
//! application's `dev` profile too:
//!
//! ```toml
//! [profile.dev.package.umbrage]
//! opt-level = 3
//! [profile.dev.package.glam]
//! opt-level = 3
//! [profile.dev.package.libm]
//! opt-level = 3
//! ```

#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

mod alias;
mod bias;
mod bounds;
mod camera;
mod caster_test;
mod casters;
pub mod config;
mod coverage;
mod error;
mod geometry;
mod held;
mod interop;
mod keeper;
mod light;
mod margin;
mod maths;
mod plan;
mod planes;
mod planner;
mod stepped;
mod warp;

pub use glam;

pub use bias::{Bias, STEEPEST};
pub use bounds::Aabb;
pub use camera::{DepthConvention, Frustum, Matrix, Projection, View};
pub use caster_test::{BelowTest, CasterTest};
pub use casters::{Caster, CasterHandle, CasterSet, Layers, Motion, Visited};
pub use config::ShadowConfig;
pub use coverage::PlanCoverage;
pub use error::{Error, Result};
pub use geometry::receiver_mask::CasterMask;
pub use geometry::sphere::{Sphere, slice_sphere, stable_texel};
pub use held::Held;
pub use keeper::{Area, Keeper, KeptFrame, KeptMap, KeptRegion};
pub use light::{DirectionalLight, Light, PointLight, SpotLight};
pub use margin::FilterReach;
pub use plan::{MAX_SPLITS, ShadowPlan, Split};
pub use planes::scheme::split_planes;
pub use planner::{Boxes, PlanInputs, Planner, PlannerOptions, plan};
pub use stepped::{SteppedSun, SunFade};
pub use warp::{Warp, WarpTarget, texels_along};
