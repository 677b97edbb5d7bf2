//! Which node is whose child, and which nodes the scene shows.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use super::Document;
use crate::Result;
use crate::error::element;

/// The nodes of a file, put in order.
pub(super) struct Hierarchy {
    /// All nodes of the file, parents before children, otherwise as the file has them.
    pub(super) order: Vec<usize>,
    /// The parent of each node of the file.
    pub(super) parent: Vec<Option<usize>>,
    /// Whether each node of the file belongs to the scene that is shown.
    pub(super) shown: Vec<bool>,
}

/// Name of a node for messages.
pub(super) fn node_name(document: &Document<'_>, index: usize) -> String {
    let name = document.root.nodes.get(index).and_then(|node| node.name.as_deref());
    element("nodes", index, name.unwrap_or_default())
}

pub(super) fn sort(document: &mut Document<'_>) -> Result<Hierarchy> {
    let nodes = &document.root.nodes;
    let mut parent = vec![None; nodes.len()];
    for (index, node) in nodes.iter().enumerate() {
        for child in node.children.iter().flatten() {
            let child = child.value();
            document.get(nodes, child, "nodes", &node_name(document, index))?;
            if let Some(other) = parent[child].replace(index) {
                let reason = format!("is a child of nodes[{other}] and of nodes[{index}]; it may have one parent");
                return Err(document.invalid(node_name(document, child), reason));
            }
        }
    }

    // Kahn's algorithm; the heap keeps the file's order wherever it is a possible one.
    let mut ready: BinaryHeap<Reverse<usize>> =
        (0..nodes.len()).filter(|&i| parent[i].is_none()).map(Reverse).collect();
    let mut order = Vec::with_capacity(nodes.len());
    while let Some(Reverse(index)) = ready.pop() {
        order.push(index);
        ready.extend(nodes[index].children.iter().flatten().map(|child| Reverse(child.value())));
    }
    if order.len() < nodes.len() {
        let mut is_placed = vec![false; nodes.len()];
        order.iter().for_each(|&i| is_placed[i] = true);
        let in_cycle = is_placed.iter().position(|placed| !placed).unwrap_or_default();
        return Err(
            document.invalid(node_name(document, in_cycle), "is its own ancestor, or a descendant of such a node")
        );
    }

    let shown = shown(document, &order, &parent)?;
    let hidden = shown.iter().filter(|shown| !**shown).count();
    if hidden > 0 {
        document.notes.add(format!("{hidden} nodes do not belong to the scene that is shown"));
    }
    Ok(Hierarchy { order, parent, shown })
}

/// The nodes of the default scene, or of the first one; all of them if the file has no scenes.
fn shown(document: &Document<'_>, order: &[usize], parent: &[Option<usize>]) -> Result<Vec<bool>> {
    let root = &document.root;
    if root.scenes.is_empty() && root.scene.is_none() {
        return Ok(vec![true; root.nodes.len()]);
    }
    let index = root.scene.map_or(0, |scene| scene.value());
    let scene = document.get(&root.scenes, index, "scenes", "scene")?;
    let user = element("scenes", index, scene.name.as_deref().unwrap_or_default());
    let mut shown = vec![false; root.nodes.len()];
    for node in &scene.nodes {
        document.get(&root.nodes, node.value(), "nodes", &user)?;
        if let Some(parent) = parent[node.value()] {
            let reason = format!("is a root of {user}, but also a child of nodes[{parent}]");
            return Err(document.invalid(node_name(document, node.value()), reason));
        }
        shown[node.value()] = true;
    }
    for &node in order {
        if let Some(parent) = parent[node] {
            shown[node] = shown[parent];
        }
    }
    Ok(shown)
}
