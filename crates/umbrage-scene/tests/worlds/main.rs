//! The four worlds of the paper, the wood and the large ones: what they hold, that their surfaces
//! are sound, that things stand where they should.

mod census;
mod ground;
mod large;
mod staging;
mod surfaces;
mod thicket;

use std::sync::OnceLock;

use umbrage_scene::Scene;
use umbrage_scene::procedural::World;

/// Every world of the paper, built once for all tests.
fn worlds() -> &'static [(World, Scene)] {
    static BUILT: OnceLock<Vec<(World, Scene)>> = OnceLock::new();
    BUILT.get_or_init(|| World::PAPER.map(|world| (world, world.build())).into())
}

/// Whether a node is part of the ground on which the world stands.
fn is_ground(name: &str) -> bool {
    name.starts_with("ground ") || name.starts_with("board ")
}
