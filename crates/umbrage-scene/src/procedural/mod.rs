//! The four worlds of the paper on parallel-split shadow maps (Zhang, Sun, Xu, Lun 2006, section 5
//! and table 1), a dense wood, and worlds of up to millions of objects, built from nothing: the
//! same triangles on every machine.

mod chessmen;
mod desert;
mod figures;
mod large;
mod leaves;
mod maths;
mod mine;
mod mining;
mod noise;
mod plants;
mod robot;
mod sculpt;
mod shapes;
mod stage;
mod terrain;
mod thicket;
mod worlds;

use crate::{Result, Scene};

pub use large::{Watch, WorldOptions};

/// A procedural world.
///
/// Metres, +Y up. Every world has the cameras `near`, `middle`, `far`, `dueling` (looks nearly into
/// the light at time 0) and `aerial`, and a directional light `sun` that moves slowly.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum World {
    /// 160 robots on a plain of 1.44 km²; 240 thousand triangles.
    RobotWar,
    /// 32 chessmen on a board of 0.49 km²; 51 thousand triangles.
    Chessboard,
    /// 15 dwarfs and 15 knights that walk, 15 palms and 15 cactuses on a desert of 1.6 km²; 1
    /// million triangles.
    Knights,
    /// 10 clawbots and 15 windmills that move, 20 rocks and 10 pines on an open-cast mine of 2.56
    /// km²; 1.3 million triangles.
    MiningTerrain,
    /// A wood of 1.44 hectares whose foliage is alpha-tested cards, 152 materials, each merged into
    /// one mesh; 1.1 million triangles. It is not from the paper; it measures the cost of hidden
    /// leaves.
    Thicket,
    /// A million trees on 100 km² of mountains, or [`WorldOptions::trees`] of them; four levels of
    /// detail of each kind.
    Forest,
    /// 100,000 buildings on a grid of streets, or [`WorldOptions::buildings`] of them.
    CityBlocks,
}

impl World {
    /// The paper's worlds, in its order.
    pub const PAPER: [Self; 4] = [Self::RobotWar, Self::Chessboard, Self::Knights, Self::MiningTerrain];
    /// All worlds.
    pub const ALL: [Self; 7] = [
        Self::RobotWar,
        Self::Chessboard,
        Self::Knights,
        Self::MiningTerrain,
        Self::Thicket,
        Self::Forest,
        Self::CityBlocks,
    ];
    /// Worlds that are made for any number of objects. They take seconds and hundreds of megabytes
    /// to build.
    pub const LARGE: [Self; 2] = [Self::Forest, Self::CityBlocks];

    /// Returns the world's name on the command line.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::RobotWar => "robot-war",
            Self::Chessboard => "chessboard",
            Self::Knights => "knights",
            Self::MiningTerrain => "mining-terrain",
            Self::Thicket => "thicket",
            Self::Forest => "forest",
            Self::CityBlocks => "city-blocks",
        }
    }

    /// Returns the world with this [`World::name`].
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|world| world.name() == name)
    }

    /// Returns the world's name as a heading, which is the paper's name for the paper's worlds.
    #[must_use]
    pub const fn title(self) -> &'static str {
        match self {
            Self::RobotWar => "Robot War",
            Self::Chessboard => "Huge Chessboard",
            Self::Knights => "Knights",
            Self::MiningTerrain => "Mining Terrain",
            Self::Thicket => "Thicket",
            Self::Forest => "Forest",
            Self::CityBlocks => "City Blocks",
        }
    }

    /// Returns the camera's near and far distance in metres.
    #[must_use]
    pub const fn near_far(self) -> (f64, f64) {
        match self {
            Self::RobotWar | Self::Chessboard | Self::Knights => (1.0, 800.0),
            Self::MiningTerrain => (1.0, 1000.0),
            Self::Thicket => (0.1, 200.0),
            Self::Forest => (0.5, 4000.0),
            Self::CityBlocks => (0.5, 3000.0),
        }
    }

    /// Builds the world with its default number of objects.
    #[must_use]
    pub fn build(self) -> Scene {
        self.build_counted(&WorldOptions::default(), &|_| ())
    }

    /// Builds the world with the number of objects that `options` may give, and reports progress to
    /// `watch`.
    ///
    /// # Errors
    /// [`crate::Error::WorldOption`] for a number that is not of this world, or out of its limits.
    pub fn build_with(self, options: &WorldOptions, watch: Watch<'_>) -> Result<Scene> {
        options.check(self.name())?;
        Ok(self.build_counted(options, watch))
    }

    fn build_counted(self, options: &WorldOptions, watch: Watch<'_>) -> Scene {
        match self {
            Self::RobotWar => match options.robots {
                None => worlds::robot_war(),
                Some(robots) => large::robots::robot_war(robots, watch),
            },
            Self::Chessboard => worlds::chessboard(),
            Self::Knights => desert::knights(),
            Self::MiningTerrain => mine::mining_terrain(),
            Self::Thicket => thicket::thicket(),
            Self::Forest => large::forest::forest(options.trees.unwrap_or(large::forest::TREES), watch),
            Self::CityBlocks => large::city::city_blocks(options.buildings.unwrap_or(large::city::BUILDINGS), watch),
        }
    }
}
