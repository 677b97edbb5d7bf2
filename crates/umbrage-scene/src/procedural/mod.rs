//! The four worlds of the paper on parallel-split shadow maps (Zhang, Sun, Xu, Lun 2006, section 5 and table 1), built
//! from nothing: the same triangles on every machine.

mod chessmen;
mod maths;
mod noise;
mod robot;
mod sculpt;
mod shapes;
mod stage;
mod terrain;
mod worlds;

use crate::Scene;

/// A world of the paper.
///
/// Metres, +Y up. Every world has the cameras `near`, `middle`, `far`, `dueling` (looks nearly into the light at time
/// 0) and `aerial`, and a directional light `sun` that moves slowly.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum World {
    /// 160 robots on a plain of 1.44 km²; 240 thousand triangles.
    RobotWar,
    /// 32 chessmen on a board of 0.49 km²; 51 thousand triangles.
    Chessboard,
}

impl World {
    /// All of them, in the paper's order.
    pub const ALL: [Self; 2] = [Self::RobotWar, Self::Chessboard];

    /// As it is called on the command line.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::RobotWar => "robot-war",
            Self::Chessboard => "chessboard",
        }
    }

    /// The world of that [`World::name`].
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|world| world.name() == name)
    }

    /// As the paper calls it.
    #[must_use]
    pub const fn title(self) -> &'static str {
        match self {
            Self::RobotWar => "Robot War",
            Self::Chessboard => "Huge Chessboard",
        }
    }

    /// The camera's near and far distance in metres.
    #[must_use]
    pub const fn near_far(self) -> (f64, f64) {
        (1.0, 800.0)
    }

    /// Builds the world.
    #[must_use]
    pub fn build(self) -> Scene {
        match self {
            Self::RobotWar => worlds::robot_war(),
            Self::Chessboard => worlds::chessboard(),
        }
    }
}
