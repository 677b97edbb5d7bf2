//! The controls around the picture, and over it.

mod below;
mod help;
mod look;
mod picked;
mod plots;
mod scene;
mod settings;
mod status;
mod sun;
mod viewport;

pub use below::below;
pub use help::help;
pub use scene::scene;
pub use settings::settings;
pub use status::status;
pub use viewport::viewport;

use std::collections::BTreeMap;

/// What stands in text fields until it is a value.
#[derive(Clone, Debug, Default)]
pub struct Fields {
    /// A file to open.
    pub file: String,
    /// Words that settings are searched for.
    pub search: String,
    /// Settings as they are being typed, by key, each with what is wrong with it.
    pub typed: BTreeMap<&'static str, (String, Option<String>)>,
    /// Text to paste.
    pub pasted: String,
    /// The caster under the pointer, for one frame: an index into the pose's objects.
    pub hovered_caster: Option<usize>,
    /// Where the card of a pixel opens.
    pub card_at: egui::Pos2,
    /// What gave way to the last choice.
    pub gave_way: Vec<String>,
}

/// A panel beside the picture. In a small window, or with large text, it leaves the picture its
/// third.
fn side(panel: egui::Panel, width: f32, ui: &egui::Ui) -> egui::Panel {
    let third = ui.ctx().content_rect().width() / 3.0;
    let least = third.min(180.0);
    panel.default_size(width.min(third)).size_range(least..=third.max(least))
}

/// Colour of a split for the controls.
fn split_colour(split: usize) -> egui::Color32 {
    let [r, g, b] = crate::lines::split_colour(split);
    egui::Color32::from_rgb(r, g, b)
}

/// A number of bytes for people.
fn bytes(bytes: u64) -> String {
    let mib = bytes as f64 / f64::from(1 << 20);
    if mib >= 10.0 { format!("{mib:.0} MiB") } else { format!("{mib:.1} MiB") }
}

/// A length for people.
fn metres(m: f64) -> String {
    match m.abs() {
        small if small < 0.01 => format!("{:.2} mm", m * 1e3),
        small if small < 1.0 => format!("{:.1} cm", m * 1e2),
        middle if middle < 100.0 => format!("{m:.2} m"),
        large if large < 10_000.0 => format!("{m:.0} m"),
        _ => format!("{:.1} km", m * 1e-3),
    }
}

/// The name of an object of a pose.
fn object_name(stage: &crate::stage::Stage, pose: &umbrage_scene::Pose, object: usize) -> String {
    let Some(object) = pose.objects.get(object) else { return format!("object {object}") };
    let node = stage.scene.nodes.get(object.node).map_or("", |node| node.name.as_str());
    let mesh = stage.scene.meshes.get(object.mesh).map_or("", |mesh| mesh.name.as_str());
    let name = [node, mesh].into_iter().find(|name| !name.is_empty());
    let name = name.map_or_else(|| format!("node {}", object.node), str::to_owned);
    object.instance.map_or(name.clone(), |instance| format!("{name} ({instance})"))
}

#[cfg(test)]
mod tests {
    #[test]
    fn lengths_and_bytes_are_short() {
        assert_eq!(super::metres(0.001_234), "1.23 mm");
        assert_eq!(super::metres(0.25), "25.0 cm");
        assert_eq!(super::metres(12.345), "12.35 m");
        assert_eq!(super::metres(1234.5), "1234 m");
        assert_eq!(super::metres(52_000.0), "52.0 km");
        assert_eq!(super::bytes(16 << 20), "16 MiB");
        assert_eq!(super::bytes(3 << 19), "1.5 MiB");
    }
}
