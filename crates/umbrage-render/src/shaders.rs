//! WGSL of every pass: the library's text, the code that all passes share, and the pass's own.

use umbrage::config::Coordinates;

const SCENE: &str = include_str!("shaders/scene.wgsl");
const VIEW: &str = include_str!("shaders/view.wgsl");
const NORMALS: &str = include_str!("shaders/normals.wgsl");
const TONE: &str = include_str!("shaders/tone.wgsl");

/// WGSL of casters. Bind group 0 is what [`umbrage_wgpu::ShadowMaps::caster_wgsl`] declares, 1 the
/// material.
pub(crate) fn casters(library: &str) -> String {
    [library, SCENE, include_str!("shaders/caster.wgsl")].join("\n")
}

/// WGSL of casters whose triangles maps name.
pub(crate) fn named_casters(library: &str) -> String {
    [library, SCENE, include_str!("shaders/caster_named.wgsl")].join("\n")
}

/// WGSL of casters with holes; the library's text has [`MASKED_MEMBERS`].
pub(crate) fn masked_casters(library: &str) -> String {
    [library, SCENE, include_str!("shaders/caster_masked.wgsl")].join("\n")
}

/// Members that a caster with holes passes to its fragment shader.
pub(crate) const MASKED_MEMBERS: &str = "@location(0) uv: vec2f, @location(1) alpha: f32,";

/// WGSL of casters that let some light through; the library's text has [`DITHERED_MEMBERS`].
pub(crate) fn dithered_casters(library: &str) -> String {
    [library, SCENE, include_str!("shaders/caster_dithered.wgsl")].join("\n")
}

/// Members that a caster that lets some light through passes to its fragment shader.
pub(crate) const DITHERED_MEMBERS: &str =
    "@location(0) uv: vec2f, @location(1) alpha: f32, @location(2) @interpolate(flat) offset: vec2f,";

/// WGSL of the view. Bind group 0 is the frame, 1 the material, 2 what
/// [`umbrage_wgpu::ShadowMaps::receiver_wgsl`] declares, 3 with contact shadows what
/// [`umbrage_wgpu::contact_wgsl`] declares.
pub(crate) fn forward(library: &str, coordinates: Coordinates, contact: bool) -> String {
    const WITHOUT: &str =
        "fn with_contact(visibility: f32, position: vec3f, normal: vec3f) -> f32 { return min(visibility, 1.0); }";
    let contact = match contact {
        true => umbrage_wgpu::contact_wgsl(3) + include_str!("shaders/contact.wgsl"),
        false => WITHOUT.to_owned(),
    };
    let surface = match coordinates {
        Coordinates::World | Coordinates::Deferred => include_str!("shaders/surface.wgsl"),
        Coordinates::Vertex => include_str!("shaders/surface_with_coordinates.wgsl"),
    };
    [library, &contact, SCENE, VIEW, NORMALS, TONE, include_str!("shaders/forward.wgsl"), surface].join("\n")
}

/// WGSL of the view with counts of exact edges. The library's text is one that counts.
pub(crate) fn edge_counts(library: &str, coordinates: Coordinates) -> String {
    forward(library, coordinates, false) + include_str!("shaders/edge_counts.wgsl")
}

/// Text in place of the library's for pictures without shadow code.
pub(crate) const WITHOUT_SHADOWS: &str = include_str!("shaders/without_shadows.wgsl");

/// Text in place of the library's for pictures that take the first light's shadows from a mask, the
/// texture of bind group 2.
pub(crate) const LIT: &str = include_str!("shaders/lit.wgsl");

/// WGSL of the sky. Bind group 0 is the frame. Its own text, because drivers read all of a text for
/// each pipeline.
pub(crate) fn sky() -> String {
    [SCENE, VIEW, TONE, include_str!("shaders/sky.wgsl")].join("\n")
}

/// WGSL of depth passes. Bind group 0 is the frame, 1 the material. No shadow is looked up.
pub(crate) fn depth() -> String {
    [SCENE, VIEW, include_str!("shaders/depth.wgsl")].join("\n")
}

/// WGSL of passes that draw depth and normals for a mask. Bind group 0 is the frame, 1 the
/// material.
pub(crate) fn facing() -> String {
    [SCENE, VIEW, NORMALS, include_str!("shaders/facing.wgsl")].join("\n")
}

/// WGSL of pictures whose shadows come from masks of a G-buffer. Bind group 0 is the frame, 1 the
/// material of surfaces, 2 what has been drawn.
pub(crate) fn g_buffer() -> String {
    forward(WITHOUT_SHADOWS, Coordinates::World, false) + include_str!("shaders/g_buffer.wgsl")
}

/// WGSL of probes. Bind group 0 is the points, 1 what [`umbrage_wgpu::ShadowMaps::receiver_wgsl`]
/// declares.
pub(crate) fn probe(library: &str) -> String {
    [library, include_str!("shaders/probe.wgsl")].join("\n")
}

#[cfg(test)]
mod tests {
    use std::mem::offset_of;

    use naga::valid::Capabilities;
    use umbrage_shaders::layout::FilterKind;
    use umbrage_shaders::{Casters, ExactEdges, Maps, ReceiverText, receiver};

    use super::*;
    use crate::forward::FrameUniform;
    use crate::lamps::LampUniform;
    use crate::materials::MaterialUniform;

    fn parsed(source: &str) -> naga::Module {
        let module = naga::front::wgsl::parse_str(source).unwrap_or_else(|e| panic!("{}", e.emit_to_string(source)));
        let mut validator = naga::valid::Validator::new(
            naga::valid::ValidationFlags::all(),
            Capabilities::MULTIVIEW | Capabilities::CLIP_DISTANCES,
        );
        validator.validate(&module).unwrap_or_else(|e| panic!("{}", e.emit_to_string(source)));
        module
    }

    /// Returns the members of a struct with their offsets, and its size.
    fn layout(module: &naga::Module, name: &str) -> (Vec<(String, usize)>, usize) {
        let (_, ty) =
            module.types.iter().find(|(_, ty)| ty.name.as_deref() == Some(name)).expect("the struct is there");
        let naga::TypeInner::Struct { members, span } = &ty.inner else { panic!("{name} is no struct") };
        let member = |m: &naga::StructMember| (m.name.clone().unwrap_or_default(), m.offset as usize);
        (members.iter().map(member).collect(), *span as usize)
    }

    macro_rules! offsets {
        ($ty:ty: $($field:ident),+) => {
            (vec![$((stringify!($field).to_owned(), offset_of!($ty, $field))),+], size_of::<$ty>())
        };
    }

    #[test]
    fn every_pass_is_valid_wgsl() {
        for (views, tiles) in [(false, false), (true, false), (false, true), (true, true)] {
            for ids in [false, true] {
                let library = |members| umbrage_shaders::caster(0, Casters { views, tiles, ids }, members);
                assert_eq!(parsed(&masked_casters(&library(MASKED_MEMBERS))).entry_points.len(), 2);
                assert_eq!(parsed(&dithered_casters(&library(DITHERED_MEMBERS))).entry_points.len(), 2);
            }
            let named = umbrage_shaders::caster(0, Casters { views, tiles, ids: true }, "");
            assert_eq!(parsed(&named_casters(&named)).entry_points.len(), 2);
            let library = |members| umbrage_shaders::caster(0, Casters { views, tiles, ids: false }, members);
            assert_eq!(parsed(&casters(&library(""))).entry_points.len(), 2);
        }
        let exact = Some(ExactEdges { positions: 4, counted: true });
        let counting = ReceiverText { exact, filter: Some(FilterKind::Pcf3), ..ReceiverText::default() };
        let library = receiver(2, counting) + &umbrage_shaders::stored_runs(0, 1);
        assert!(!parsed(&edge_counts(&library, Coordinates::World)).entry_points.is_empty());
        for maps in [Maps::default(), Maps { without_loads: true, ..Maps::default() }] {
            let with_coordinates = receiver(2, Maps { coordinates: true, ..maps });
            for source in [
                forward(&receiver(2, maps), Coordinates::World, true),
                forward(&with_coordinates, Coordinates::Vertex, true),
                forward(WITHOUT_SHADOWS, Coordinates::World, false),
                forward(LIT, Coordinates::World, false),
                sky(),
                depth(),
                facing(),
                g_buffer(),
                probe(&receiver(1, maps)),
                probe(&receiver(1, Maps { coordinates: true, ..maps })),
            ] {
                assert!(!parsed(&source).entry_points.is_empty());
            }
        }
    }

    #[test]
    fn both_sides_lay_out_their_structs_alike() {
        let module = parsed(&forward(&receiver(2, Maps::default()), Coordinates::World, true));
        let frame = offsets!(
            FrameUniform: clip_from_eye, eye, is_orthographic, forward, lamp_count, to_sun, daylight, ray_center, near,
            ray_right, far, ray_up, shadow_colour, lamps
        );
        assert_eq!(layout(&module, "Frame"), frame);
        let lamp = offsets!(LampUniform: position, range, to_light, outer_cosine, color, inner_cosine);
        assert_eq!(layout(&module, "Lamp"), lamp);
        assert_eq!(layout(&module, "Material"), offsets!(MaterialUniform: base_color, emissive, alpha_cutoff));
    }

    #[test]
    fn a_moved_member_is_noticed() {
        let module = parsed(
            &forward(&receiver(2, Maps::default()), Coordinates::World, true)
                .replace("base_color: vec4f,", "base_color: vec4f, more: f32,"),
        );
        assert_ne!(layout(&module, "Material"), offsets!(MaterialUniform: base_color, emissive, alpha_cutoff));
    }
}
