//! The controls around the picture and over it.

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

/// State of the controls: texts of fields, and choices that are not yet values.
#[derive(Clone, Debug, Default)]
pub struct Fields {
    /// Path of a file to open.
    pub file: String,
    /// Words to search settings for.
    pub search: String,
    /// Values that are being typed, by the key of their setting, each with its error.
    pub typed: BTreeMap<&'static str, (String, Option<String>)>,
    /// Text to paste.
    pub pasted: String,
    /// Caster under the pointer, for one frame: an index into the pose's objects.
    pub hovered_caster: Option<usize>,
    /// Position at which the card of a pixel opens.
    pub card_at: egui::Pos2,
    /// Settings that the last choice changed to make room.
    pub gave_way: Vec<String>,
}

/// Limits the width of a panel beside the picture. In a small window, or with large text, the panel
/// leaves the picture a third.
fn side(panel: egui::Panel, width: f32, ui: &egui::Ui) -> egui::Panel {
    let third = ui.ctx().content_rect().width() / 3.0;
    let least = third.min(180.0);
    panel.default_size(width.min(third)).size_range(least..=third.max(least))
}

/// Returns the colour of a split for the controls.
fn split_colour(split: usize) -> egui::Color32 {
    let [r, g, b] = crate::lines::split_colour(split);
    egui::Color32::from_rgb(r, g, b)
}

/// Formats a number of bytes.
fn bytes(bytes: u64) -> String {
    let mib = bytes as f64 / f64::from(1 << 20);
    if mib >= 10.0 { format!("{mib:.0} MiB") } else { format!("{mib:.1} MiB") }
}

/// Formats a length in metres.
fn metres(m: f64) -> String {
    match m.abs() {
        small if small < 0.01 => format!("{:.2} mm", m * 1e3),
        small if small < 1.0 => format!("{:.1} cm", m * 1e2),
        middle if middle < 100.0 => format!("{m:.2} m"),
        large if large < 10_000.0 => format!("{m:.0} m"),
        _ => format!("{:.1} km", m * 1e-3),
    }
}

/// Returns the name of an object of a pose.
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
