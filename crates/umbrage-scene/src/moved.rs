//! Translation of a whole scene in the world.

use glam::DVec3;

use crate::{Node, Scene, Trs};

impl Scene {
    /// Moves the scene by `by` metres, with its cameras and lights. All nodes become children of a
    /// new first node, so that animations go on as before and no stored number loses digits.
    #[must_use]
    pub fn moved(mut self, by: DVec3) -> Self {
        let root = Node { name: "moved".into(), local: Trs { translation: by, ..Trs::IDENTITY }, ..Node::default() };
        for node in &mut self.nodes {
            node.parent = Some(node.parent.map_or(0, |parent| parent + 1));
        }
        self.nodes.insert(0, root);
        let cameras = self.cameras.iter_mut().map(|camera| &mut camera.node);
        let lights = self.lights.iter_mut().map(|light| &mut light.node);
        let joints = self.skins.iter_mut().flat_map(|skin| &mut skin.joints);
        let channels = self.animations.iter_mut().flat_map(|clip| &mut clip.channels).map(|channel| &mut channel.node);
        cameras.chain(lights).chain(joints).chain(channels).for_each(|node| *node += 1);
        self
    }
}
