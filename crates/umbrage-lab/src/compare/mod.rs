//! Any techniques on any shots, judged by rays.
//!
//! [`job`] describes a comparison, [`shots`] its views; [`run()`] draws every mask by the same path
//! as `umbrage render --visibility`, scores it ([`judge`], and along walks [`stillness`]) and keeps
//! the numbers ([`report`]) and the pictures (`sheet_shots`, [`sheet`]); `page` makes one HTML page
//! of both. All results are files; standard error gets progress and notes.

mod inset;
pub mod job;
pub mod journal;
pub mod judge;
mod page;
mod pen;
pub mod preset;
pub mod report;
mod run;
pub mod sheet;
mod sheet_shots;
pub mod shots;
pub mod stillness;

pub use job::{Job, Outputs, Settings};
pub use preset::Preset;
pub(crate) use run::points_shared_with;
pub use run::run;

#[cfg(test)]
mod tests {
    use umbrage::DirectionalLight;
    use umbrage_scene::procedural::World;
    use umbrage_truth::Truth;

    use super::judge::ViewTruth;

    /// Makes the first camera of the Huge Chessboard under its own sun.
    pub fn chessboard_shot(size: [u32; 2]) -> ViewTruth {
        let scene = World::Chessboard.build();
        let pose = scene.pose(0.0).expect("a pose");
        let aspect = f64::from(size[0]) / f64::from(size[1]);
        let view = umbrage_scene::camera_view(&scene, &pose, 0, aspect, None, None).expect("a camera");
        let travel = umbrage_scene::light_direction(&scene, &pose, 0).expect("a sun");
        let truth = Truth::build(&scene, &pose, view.eye()).expect("the truth");
        let sun = DirectionalLight::new(travel).expect("a sun");
        ViewTruth::new(&truth, &pose, &view, &sun.into(), size, None).expect("judged")
    }
}
