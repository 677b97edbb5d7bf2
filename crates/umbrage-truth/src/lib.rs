//! The judge: exact visibility by rays, and scores of how wrong a shadow technique is.
//!
//! It shares the camera ([`umbrage::View`]) and the scene ([`umbrage_scene`]) with the renderer it
//! judges, and nothing else: no fit, no selection, no filter, no shader. Positions are world metres
//! in `f64`.
//!
//! ```
//! use glam::DVec3;
//! use umbrage::{Frustum, View};
//! use umbrage_scene::Scene;
//! use umbrage_truth::Truth;
//! use umbrage_truth::scores::{Answers, Domain, mis_shadowed};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let scene = Scene::default(); // or umbrage_scene::open("city.glb", …)
//! let pose = scene.pose(0.0)?;
//! let frustum = Frustum::perspective(1.0, 4.0 / 3.0, 0.5, 500.0)?;
//! let view = View::look_at_upright(DVec3::new(0.0, 2.0, 9.0), DVec3::ZERO, frustum)?;
//!
//! let truth = Truth::build(&scene, &pose, view.eye())?;
//! let mask = truth.mask(&view, DVec3::new(1.0, -1.0, 0.5), [64, 48], &|_share_done| {})?;
//! let image = mask.to_image();
//! # assert_eq!(image.dimensions(), (64, 48));
//!
//! let domain = Domain::new(&mask, (0.5, 500.0))?;
//! let answers = Answers::from_mask(&image); // or what a technique drew
//! match mis_shadowed(&domain, &answers) {
//!     Ok(score) => assert_eq!(score.rate(), 0.0),
//!     Err(nothing_faces_the_light) => println!("{nothing_faces_the_light}"),
//! }
//! # Ok(())
//! # }
//! ```
//!
//! # What is true
//!
//! One ray goes through each pixel's centre, from the near plane to the far plane. It passes
//! through back faces of single-sided materials (a transform that mirrors swaps front and back),
//! through alpha-tested surfaces where alpha is below the cutoff, and through everything
//! translucent. What it meets first is `p`, with the geometric normal `n_g` turned towards the eye.
//!
//! **V\*(p)** = 1 if no triangle other than p's own surface is hit by `(p, l)`, `l` pointing to the
//! light. Shadow rays meet both sides of every triangle; alpha-tested triangles count where alpha ≥
//! cutoff (level 0, bilinear on 8-bit alpha, times base colour and vertex alpha); translucent ones
//! never; objects that do not cast are seen but stop no light. A surface with `n_g·l ≤ 0` is dark.
//!
//! p's own surface is its triangle, skipped by its number, and every triangle parallel to it in
//! whose plane p lies within **τ**: surfaces that lie on each other count as one. τ is a bound on
//! the rounding of both surfaces along the plane's normal: a few ulp, in the `f32` of the file, of
//! the vertices' local coordinates and of the transforms below the node that both hang from, and a
//! few in `f64` of the rest. A scene that is scaled or moved with its camera keeps its decisions,
//! and one box of 1 mm its shadow. The wall beside a crease is no part of the surface, however near
//! the crease p is.
//!
//! Under a light that stands somewhere `l` points to it, rays end at it, and what its range and
//! cone do not reach is not shadowed.
//!
//! Shadow rays start 2⁻⁴⁰ of p's coordinates towards the eye, so that they start in the part of
//! space that the eye is in. A normal offset of a thousandth already moves 1 to 4 % of all
//! decisions. Every triangle test is in `f64` and closed along shared edges; the tree's `f32` boxes
//! err to the safe side.
//!
//! **V\*_A(p)** for a sun with an angular size is the mean of N such decisions over its disc
//! ([`SunDisc`]), the same directions for every point; those below the surface's own horizon are
//! dark.
//!
//! How techniques are scored against this is said in [`scores`].

mod alpha;
mod bvh;
mod contact;
mod error;
mod mask;
pub mod scores;
mod soft;
mod trace;
mod triangles;
mod truth;

pub use error::{Error, Result};
pub use mask::{Tracing, TruthMask, read_mask};
pub use soft::{SoftTruth, SunDisc};
pub use truth::{Hit, Truth};

#[cfg(test)]
mod tests;
