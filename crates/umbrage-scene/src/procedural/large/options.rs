//! How many objects a world has.

use super::super::World;
use crate::{Error, Result};

/// Numbers of objects of the worlds that may have any; `None`: the world's own number.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct WorldOptions {
    /// Robots of [`World::RobotWar`]: the paper's 160.
    pub robots: Option<u32>,
    /// Trees of [`World::Forest`]: a million, on 100 km². Fewer trees stand on less ground.
    pub trees: Option<u32>,
    /// Buildings of [`World::CityBlocks`]: 100,000.
    pub buildings: Option<u32>,
}

impl WorldOptions {
    /// Most robots.
    pub const MOST_ROBOTS: u32 = 100_000;
    /// Most trees.
    pub const MOST_TREES: u32 = 4_000_000;
    /// Most buildings.
    pub const MOST_BUILDINGS: u32 = 1_000_000;

    /// Each number with its option, its world and its limit.
    fn rows(&self) -> [(Option<u32>, &'static str, World, u32); 3] {
        [
            (self.robots, "robots", World::RobotWar, Self::MOST_ROBOTS),
            (self.trees, "trees", World::Forest, Self::MOST_TREES),
            (self.buildings, "buildings", World::CityBlocks, Self::MOST_BUILDINGS),
        ]
    }

    /// Checks the numbers for a scene of that name.
    ///
    /// # Errors
    /// [`Error::WorldOption`] naming a number that is 0, above its limit, or not of that scene.
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
