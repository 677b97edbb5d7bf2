//! Consistency checks of a scene, whoever made it.

use crate::error::element;
use crate::{Error, Interpolation, Keys, Mesh, Primitive, Result, Scene};

impl Scene {
    /// Checks every index, length and number of the scene, so that later code can rely on them.
    ///
    /// The loaders call this function; call it yourself on scenes made by hand. It reads every
    /// vertex once.
    ///
    /// # Errors
    /// [`Error::InvalidScene`] with the first element that is wrong.
    pub fn validate(&self) -> Result<()> {
        for (i, mesh) in self.meshes.iter().enumerate() {
            self.validate_mesh(i, mesh)?;
        }
        for (i, material) in self.materials.iter().enumerate() {
            let at = || element("materials", i, &material.name);
            let textures = self.textures.len();
            self.check(material.base_color_texture.is_none_or(|t| t < textures), at, || {
                format!("refers to texture {:?}, but there are {textures}", material.base_color_texture)
            })?;
        }
        for (i, texture) in self.textures.iter().enumerate() {
            let (width, height) = (texture.width, texture.height);
            let bytes = u64::from(width) * u64::from(height) * 4;
            self.check(
                bytes > 0 && bytes == texture.rgba.len() as u64,
                || format!("textures[{i}]"),
                || format!("is {width}×{height} pixels, but has {} bytes", texture.rgba.len()),
            )?;
        }
        self.validate_levels()?;
        self.validate_nodes()?;
        for (i, skin) in self.skins.iter().enumerate() {
            let at = || format!("skins[{i}]");
            self.check(skin.joints.len() == skin.inverse_bind.len(), at, || {
                format!("has {} joints, but {} inverse bind matrices", skin.joints.len(), skin.inverse_bind.len())
            })?;
            self.check(skin.joints.iter().all(|&j| j < self.nodes.len()), at, || {
                "has a joint beyond the nodes".into()
            })?;
            self.check(skin.inverse_bind.iter().all(glam::Mat4::is_finite), at, || {
                "has an inverse bind matrix that is not finite".into()
            })?;
        }
        let nodes = self.nodes.len();
        let placed = self.cameras.iter().map(|c| ("cameras", c.node, &c.name));
        for (kind, node, name) in placed.chain(self.lights.iter().map(|l| ("lights", l.node, &l.name))) {
            self.check(node < nodes, || format!("{kind} ({name})"), || format!("is on node {node} of {nodes}"))?;
        }
        self.validate_animations()
    }

    /// Returns the index and the name of a node, for messages.
    pub(crate) fn node_element(&self, index: usize) -> String {
        element("nodes", index, self.nodes.get(index).map_or("", |node| node.name.as_str()))
    }

    fn check(&self, is_true: bool, at: impl Fn() -> String, reason: impl Fn() -> String) -> Result<()> {
        if is_true {
            return Ok(());
        }
        Err(Error::InvalidScene { scene: self.name.clone(), element: at(), reason: reason() })
    }

    fn validate_mesh(&self, index: usize, mesh: &Mesh) -> Result<()> {
        for (i, primitive) in mesh.primitives.iter().enumerate() {
            let at = || format!("{}.primitives[{i}]", element("meshes", index, &mesh.name));
            if let Some(reason) = fault(primitive, self.materials.len()) {
                return self.check(false, at, || reason.clone());
            }
        }
        self.check(
            mesh.weights.iter().all(|w| w.is_finite()),
            || element("meshes", index, &mesh.name),
            || "has a weight of a morph target that is not finite".into(),
        )?;
        Ok(())
    }

    fn validate_levels(&self) -> Result<()> {
        let meshes = self.meshes.len();
        for (&mesh, levels) in &self.levels {
            let at = || format!("levels of mesh {mesh}");
            self.check(mesh < meshes, at, || format!("there are {meshes} meshes"))?;
            let mut before = 0.0;
            for level in levels {
                self.check(level.mesh < meshes, at, || format!("show mesh {}, but there are {meshes}", level.mesh))?;
                self.check(!self.meshes[level.mesh].is_morphed(), at, || "have morph targets".into())?;
                self.check(level.detail_m.is_finite() && level.detail_m > before, at, || {
                    format!("are not ordered by growing detail_m: {} follows {before}", level.detail_m)
                })?;
                before = level.detail_m;
            }
        }
        Ok(())
    }

    fn validate_nodes(&self) -> Result<()> {
        for (i, node) in self.nodes.iter().enumerate() {
            let at = || self.node_element(i);
            self.check(node.parent.is_none_or(|parent| parent < i), at, || {
                format!("has the parent {:?}, which does not come before it", node.parent)
            })?;
            self.check(node.mesh.is_none_or(|mesh| mesh < self.meshes.len()), at, || {
                format!("shows mesh {:?}, but there are {}", node.mesh, self.meshes.len())
            })?;
            self.check(node.skin.is_none_or(|skin| skin < self.skins.len()), at, || {
                format!("has the skin {:?}, but there are {}", node.skin, self.skins.len())
            })?;
            self.check(node.weights.iter().all(|w| w.is_finite()), at, || {
                "has a weight of a morph target that is not finite".into()
            })?;
            if let (Some(mesh), Some(skin)) = (node.mesh, node.skin) {
                let joints = self.skins[skin].joints.len();
                for primitive in &self.meshes[mesh].primitives {
                    self.check(primitive.joints.len() == primitive.positions.len(), at, || {
                        format!("has a skin, but not every vertex of mesh {mesh} has joints")
                    })?;
                    self.check(primitive.joints.iter().flatten().all(|&j| usize::from(j) < joints), at, || {
                        format!("has a skin of {joints} joints, but mesh {mesh} uses more")
                    })?;
                }
            }
        }
        Ok(())
    }

    fn validate_animations(&self) -> Result<()> {
        for (a, animation) in self.animations.iter().enumerate() {
            for (c, channel) in animation.channels.iter().enumerate() {
                let at = || format!("{}.channels[{c}]", element("animations", a, &animation.name));
                self.check(channel.node < self.nodes.len(), at, || format!("moves node {}", channel.node))?;
                let (count, finite) = (channel.values.count(), are_finite(&channel.values));
                let per_key = if channel.interpolation == Interpolation::CubicSpline { 3 } else { 1 };
                self.check(!channel.times.is_empty() && count == channel.times.len() * per_key, at, || {
                    format!("has {} keys and {count} values", channel.times.len())
                })?;
                if let Keys::Weights { per_key, values } = &channel.values {
                    self.check(values.len().is_multiple_of((*per_key).max(1)), at, || {
                        format!("has {} weights for keys of {per_key} each", values.len())
                    })?;
                }
                let rises = channel.times.windows(2).all(|t| t[0] <= t[1]);
                self.check(finite && rises && channel.times.iter().all(|t| t.is_finite()), at, || {
                    "has keys that are not finite or do not rise".into()
                })?;
            }
            let duration = animation.duration;
            self.check(
                duration >= 0.0 && duration.is_finite(),
                || element("animations", a, &animation.name),
                || format!("lasts {duration} s"),
            )?;
        }
        Ok(())
    }
}

fn are_finite(keys: &Keys) -> bool {
    match keys {
        Keys::Translation(keys) | Keys::Scale(keys) => keys.as_flattened().iter().all(|x| x.is_finite()),
        Keys::Rotation(keys) => keys.as_flattened().iter().all(|x| x.is_finite()),
        Keys::Weights { values, .. } => values.iter().all(|x| x.is_finite()),
    }
}

/// Returns the fault of a primitive, if there is one.
fn fault(primitive: &Primitive, materials: usize) -> Option<String> {
    let vertices = primitive.positions.len();
    if primitive.material >= materials {
        return Some(format!("has the material {}, but there are {materials}", primitive.material));
    }
    if primitive.normals.len() != vertices {
        return Some(format!("has {vertices} positions, but {} normals", primitive.normals.len()));
    }
    let optional = [
        ("texture coordinates", primitive.uvs.len()),
        ("colours", primitive.colors.len()),
        ("joints", primitive.joints.len()),
        ("weights", primitive.weights.len()),
    ];
    if let Some((name, count)) = optional.into_iter().find(|(_, count)| *count != 0 && *count != vertices) {
        return Some(format!("has {vertices} positions, but {count} {name}"));
    }
    if primitive.joints.len() != primitive.weights.len() {
        return Some("has only one of joints and weights".into());
    }
    if !primitive.indices.len().is_multiple_of(3) {
        return Some(format!("has {} indices, which is not a whole number of triangles", primitive.indices.len()));
    }
    if let Some(index) = primitive.indices.iter().find(|&&index| index as usize >= vertices) {
        return Some(format!("has the index {index}, but {vertices} vertices"));
    }
    let finite = |list: &[[f32; 3]]| list.iter().flatten().all(|x| x.is_finite());
    let finite_rest = primitive.uvs.iter().flatten().chain(primitive.colors.iter().flatten());
    if !(finite(&primitive.positions) && finite(&primitive.normals) && finite_rest.copied().all(f32::is_finite)) {
        return Some("has a position, normal, texture coordinate or colour that is not finite".into());
    }
    for (index, target) in primitive.targets.iter().enumerate() {
        for (name, list) in [("positions", &target.positions), ("normals", &target.normals)] {
            if !(list.is_empty() || list.len() == vertices) {
                return Some(format!("has {vertices} positions, but targets[{index}] has {} {name}", list.len()));
            }
            if !finite(list) {
                return Some(format!("has a difference that is not finite in the {name} of targets[{index}]"));
            }
        }
    }
    if !primitive.weights.iter().flatten().all(|w| w.is_finite() && *w >= 0.0) {
        return Some("has a weight that is negative or not finite".into());
    }
    None
}
