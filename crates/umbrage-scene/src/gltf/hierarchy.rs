//! The hierarchy of nodes, and the nodes that the scene shows.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use super::Document;
use crate::Result;
use crate::error::element;

/// Nodes of a file, in order.
pub(super) struct Hierarchy {
    /// All nodes of the file, parents before children, otherwise as the file has them.
    pub(super) order: Vec<usize>,
    /// Parent of each node of the file; `None` for roots of the scene.
    pub(super) parent: Vec<Option<usize>>,
    /// True for each node of the file that belongs to the scene that is shown.
    pub(super) shown: Vec<bool>,
    /// True for each node of the file that is visible (KHR_node_visibility); all its ancestors have
    /// to be visible too.
    pub(super) visible: Vec<bool>,
}

/// Name of a node for messages.
pub(super) fn node_name(document: &Document<'_>, index: usize) -> String {
    let name = document.root.nodes.get(index).and_then(|node| node.name.as_deref());
    element("nodes", index, name.unwrap_or_default())
}

pub(super) fn sort(document: &Document<'_>) -> Result<Hierarchy> {
    let nodes = &document.root.nodes;
    let mut parent = vec![None; nodes.len()];
    for (index, node) in nodes.iter().enumerate() {
        for child in node.children.iter().flatten() {
            let child = child.value();
            document.get(nodes, child, "nodes", &node_name(document, index))?;
            match parent[child].replace(index) {
                None => {}
                Some(other) if other == index => {
                    document
                        .notes
                        .add(node_name(document, child), "listed twice among its parent's children; shown once");
                }
                Some(other) => {
                    let reason = format!("is a child of nodes[{other}] and of nodes[{index}]; it may have one parent");
                    return Err(document.invalid(node_name(document, child), reason));
                }
            }
        }
    }

    // Kahn's algorithm; the heap keeps the file's order wherever it is a possible one.
    let mut children = vec![Vec::new(); nodes.len()];
    (0..nodes.len()).for_each(|i| parent[i].into_iter().for_each(|parent: usize| children[parent].push(i)));
    let mut ready: BinaryHeap<Reverse<usize>> =
        (0..nodes.len()).filter(|&i| parent[i].is_none()).map(Reverse).collect();
    let mut order = Vec::with_capacity(nodes.len());
    while let Some(Reverse(index)) = ready.pop() {
        order.push(index);
        ready.extend(children[index].iter().copied().map(Reverse));
    }
    if order.len() < nodes.len() {
        let mut is_placed = vec![false; nodes.len()];
        order.iter().for_each(|&i| is_placed[i] = true);
        let in_cycle = is_placed.iter().position(|placed| !placed).unwrap_or_default();
        return Err(
            document.invalid(node_name(document, in_cycle), "is its own ancestor, or a descendant of such a node")
        );
    }

    let shown = shown(document, &order, &mut parent)?;
    let hidden = |shown: &[bool]| shown.iter().position(|shown| !shown);
    if let Some(first) = hidden(&shown) {
        let count = shown.iter().filter(|shown| !**shown).count();
        document
            .notes
            .add(node_name(document, first), format!("{count} nodes do not belong to the scene that is shown"));
    }
    let visible = visible(document, &order, &parent);
    if let Some(first) = visible.iter().zip(&shown).position(|(visible, shown)| *shown && !visible) {
        let count = visible.iter().zip(&shown).filter(|(visible, shown)| **shown && !**visible).count();
        document.notes.add(node_name(document, first), format!("{count} nodes are invisible (KHR_node_visibility)"));
    }
    Ok(Hierarchy { order, parent, shown, visible })
}

/// Marks the nodes of the default scene, or of the first one; all nodes if the file has no scenes.
/// A node that the scene lists besides its parent is shown once, under its parent. One whose parent
/// is not in the scene becomes a root.
fn shown(document: &Document<'_>, order: &[usize], parent: &mut [Option<usize>]) -> Result<Vec<bool>> {
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
        if std::mem::replace(&mut shown[node.value()], true) {
            document.notes.add(node_name(document, node.value()), format!("listed twice in {user}; shown once"));
        }
    }
    for &node in order {
        match parent[node] {
            Some(above) if shown[above] => {
                if shown[node] {
                    let remark = format!("listed in {user} besides its parent; shown once, under its parent");
                    document.notes.add(node_name(document, node), remark);
                }
                shown[node] = true;
            }
            Some(_) if shown[node] => {
                let remark = format!("listed in {user} without its parent; the parent's transform is not applied");
                document.notes.add(node_name(document, node), remark);
                parent[node] = None;
            }
            _ => {}
        }
    }
    Ok(shown)
}

/// Marks visible nodes by KHR_node_visibility: a node is visible if it and all its ancestors are
/// marked so.
fn visible(document: &Document<'_>, order: &[usize], parent: &[Option<usize>]) -> Vec<bool> {
    let mut visible = vec![true; order.len()];
    for &node in order {
        let extensions = document.root.nodes[node].extensions.as_ref();
        let own =
            extensions.and_then(|extensions| extensions.others.get("KHR_node_visibility")?.get("visible")?.as_bool());
        visible[node] = own != Some(false) && parent[node].is_none_or(|parent| visible[parent]);
    }
    visible
}
