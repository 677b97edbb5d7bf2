//! Morph targets of primitives.

use gltf::json::mesh::MorphTarget as JsonTarget;

use super::Document;
use super::accessors::{self, Integers, Wanted};
use super::budget::Part;
use crate::{MorphTarget, Result};

/// Number of bytes of the differences of one vertex.
const VERTEX_BYTES: u64 = size_of::<[f32; 3]>() as u64;

/// Loads the morph targets of a primitive with `vertices` vertices in the file, of which the
/// `wanted` are kept.
pub(super) fn load(
    document: &Document<'_>,
    json: &[JsonTarget],
    user: &str,
    vertices: usize,
    wanted: Wanted<'_>,
) -> Result<Vec<MorphTarget>> {
    let mut targets = Vec::with_capacity(json.len());
    for (index, target) in json.iter().enumerate() {
        let differences = |accessor: Option<usize>, name: &str| match accessor {
            Some(accessor) => {
                load_differences(document, accessor, &format!("{user}.targets[{index}].{name}"), vertices, wanted)
            }
            None => Ok(Vec::new()),
        };
        targets.push(MorphTarget {
            positions: differences(target.positions.map(|index| index.value()), "POSITION")?,
            normals: differences(target.normals.map(|index| index.value()), "NORMAL")?,
        });
    }
    Ok(targets)
}

/// Loads the differences, one per kept vertex; empty if all of them are zero.
fn load_differences(
    document: &Document<'_>,
    accessor: usize,
    user: &str,
    vertices: usize,
    wanted: Wanted<'_>,
) -> Result<Vec<[f32; 3]>> {
    let count = accessors::count(document, accessor, user)?;
    if count != vertices as u64 {
        return Err(document.invalid(user, format!("has {count} differences for {vertices} vertices")));
    }
    if accessors::is_all_zero(document, accessor, user)? {
        return Ok(Vec::new());
    }
    let packed = accessors::packed(document, accessor, user, &[accessors::type_of::<3>()], wanted)?;
    let list = packed.floats::<3>(document, user, Integers::AsMarked)?;
    if list.iter().flatten().all(|&x| x == 0.0) {
        return Ok(Vec::new());
    }
    document.count(Part::Geometry, VERTEX_BYTES * list.len() as u64, user)?;
    Ok(list)
}
