//! Options for the number of objects in a world.

use super::super::World;
use crate::{Error, Result};

/// Numbers of objects of the worlds that may have any number; `None` is the world's own number.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct WorldOptions {
    /// Number of robots of [`World::RobotWar`]; by default the paper's 160.
    pub robots: Option<u32>,
    /// Number of trees of [`World::Forest`]; by default a million, on 100 km². Fewer trees stand on
    /// less ground.
    pub trees: Option<u32>,
    /// Number of buildings of [`World::CityBlocks`]; by default 100,000.
    pub buildings: Option<u32>,
}

impl WorldOptions {
    /// Largest number of robots.
    pub const MOST_ROBOTS: u32 = 100_000;
    /// Largest number of trees.
    pub const MOST_TREES: u32 = 4_000_000;
    /// Largest number of buildings.
    pub const MOST_BUILDINGS: u32 = 1_000_000;

    /// Returns each number with its option, its world and its limit.
    fn rows(&self) -> [(Option<u32>, &'static str, World, u32); 3] {
        [
            (self.robots, "robots", World::RobotWar, Self::MOST_ROBOTS),
            (self.trees, "trees", World::Forest, Self::MOST_TREES),
            (self.buildings, "buildings", World::CityBlocks, Self::MOST_BUILDINGS),
        ]
    }

    /// Checks the numbers for the scene named `scene`.
    ///
    /// # Errors
    /// [`Error::WorldOption`] with a number that is 0, above its limit, or not of that scene.
    pub fn check(&self, scene: &str) -> Result<()> {
        for (number, option, world, most) in self.rows() {
            let Some(number) = number else { continue };
            let wrong = |reason: String| Err(Error::WorldOption { option, reason });
            if world.name() != scene {
                return wrong(format!("the scene {scene} has none; leave it out, or give the scene {}", world.name()));
            }
            if !(1..=most).contains(&number) {
                return wrong(format!("{number} is not possible; give 1 to {most}"));
            }
        }
        Ok(())
    }
}
