//! The options for numbers of objects of the worlds.

use umbrage_scene::procedural::WorldOptions;

/// Numbers of objects of the worlds, as typed.
#[derive(Clone, Copy, Debug, Default, clap::Args)]
pub struct WorldArgs {
    /// robot-war: so many robots, in ranks and files [default: the paper's 160]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=i64::from(WorldOptions::MOST_ROBOTS)), help_heading = "Scene")]
    pub robots: Option<u32>,
    /// forest: so many trees, with as much ground as they need [default: a million on 100 km²]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=i64::from(WorldOptions::MOST_TREES)), help_heading = "Scene")]
    pub trees: Option<u32>,
    /// city-blocks: so many buildings [default: 100000]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=i64::from(WorldOptions::MOST_BUILDINGS)), help_heading = "Scene")]
    pub buildings: Option<u32>,
}

impl From<WorldArgs> for WorldOptions {
    fn from(args: WorldArgs) -> Self {
        Self { robots: args.robots, trees: args.trees, buildings: args.buildings }
    }
}
