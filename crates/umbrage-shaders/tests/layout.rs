//! Name, offset and size of every member that Rust and WGSL share.

use std::mem::offset_of;

use naga::proc::Layouter;
use umbrage_shaders::layout::FilterKind;
use umbrage_shaders::layout::{
    CasterPass, CullBox, CullDraw, CullFrame, CullMesh, CullSplit, Frame, KeptWindow, MomentPass, MomentSplit, Moments,
    Split, StoredRun, StoredSlot,
};
use umbrage_shaders::{Casters, Maps, MomentMaps, ReceiverText};

/// A member as one side sees it: name, offset and size in bytes.
type Member = (String, usize, usize);

/// A struct as the WGSL has it: size in bytes and members.
fn in_wgsl(source: &str, name: &str) -> (usize, Vec<Member>) {
    let module = naga::front::wgsl::parse_str(source).expect("a valid root");
    let mut layouter = Layouter::default();
    layouter.update(module.to_ctx()).expect("every type has a layout");
    let (handle, ty) =
        module.types.iter().find(|(_, ty)| ty.name.as_deref() == Some(name)).expect("the root uses the struct");
    let naga::TypeInner::Struct { members, .. } = &ty.inner else { panic!("{name} is no struct") };
    let members = members
        .iter()
        .map(|m| (m.name.clone().unwrap_or_default(), m.offset as usize, layouter[m.ty].size as usize))
        .collect();
    (layouter[handle].size as usize, members)
}

/// Every member of a Rust struct, named here one by one; the count of bytes shows if one was
/// forgotten.
macro_rules! in_rust {
    ($name:ident: $($member:ident),*) => {{
        fn size_of_member<T, M>(_: fn(&T) -> &M) -> usize {
            size_of::<M>()
        }
        (size_of::<$name>(), vec![$((
            stringify!($member).to_owned(),
            offset_of!($name, $member),
            size_of_member::<$name, _>(|it| &it.$member),
        )),*])
    }};
}

fn split_in_rust() -> (usize, Vec<Member>) {
    in_rust!(Split: u_row, v_row, depth_row, w_row, texel_offset, texel_m, size, far, blend_begin, depth_range_m, depth_step_m,
        is_empty, viewport_texels, guard_texels, corner, layer_texels, layer, depth_offset, is_linear, filter_radius_texels)
}

fn frame_in_rust() -> (usize, Vec<Member>) {
    in_rust!(Frame: view_depth_plane, to_light, strength, light_position, light_range_m, fade_begin, split_count, filter_kind, enabled, tint,
        filter_width_m, sun_tangent, turn_per_pixel, transition, cone_cosine, first_frame, face_count,
        shadow_colour, bias_kind, eye, is_radial, selection, map_blend, slice, splits)
}

fn pass_in_rust() -> (usize, Vec<Member>) {
    in_rust!(CasterPass: first, end, views, splits)
}

#[test]
fn no_member_is_forgotten() {
    let named = |(_, members): (usize, Vec<Member>)| members.iter().map(|(_, _, size)| size).sum::<usize>();
    assert_eq!(named(split_in_rust()), size_of::<Split>());
    assert_eq!(named(frame_in_rust()) + size_of_val(&Frame::default()._padding), size_of::<Frame>());
}

#[test]
fn members_agree() {
    let (caster, receiver) =
        (umbrage_shaders::caster(0, Casters::default(), ""), umbrage_shaders::receiver(0, Maps::default()));
    assert_eq!(split_in_rust(), in_wgsl(&caster, "UmbrageSplit"));
    assert_eq!(split_in_rust(), in_wgsl(&receiver, "UmbrageSplit"));
    assert_eq!(frame_in_rust(), in_wgsl(&receiver, "UmbrageFrame"));
    let casters = umbrage_shaders::caster(0, Casters { views: true, tiles: true, ids: false }, "");
    assert_eq!(pass_in_rust(), in_wgsl(&casters, "UmbrageCasterPass"));
}

#[test]
fn members_of_stored_runs_agree() {
    let exact =
        ReceiverText { exact: Some(Default::default()), filter: Some(FilterKind::Pcf3), ..ReceiverText::default() };
    let text = umbrage_shaders::receiver(0, exact) + &umbrage_shaders::stored_runs(1, 2);
    let (size, members) = in_rust!(StoredSlot: row_x, row_y, row_z, first_run);
    assert_eq!((size, members), in_wgsl(&text, "UmbrageStoredSlot"));
    assert_eq!(in_rust!(StoredRun: min, triangles, max, first_index), in_wgsl(&text, "UmbrageStoredRun"));
}

#[test]
fn members_of_moments_agree() {
    let maps = Maps { moments: Some(MomentMaps::Sampled), ..Maps::default() };
    let (receiver, passes) = (umbrage_shaders::receiver(0, maps), umbrage_shaders::MOMENT_PASSES);
    assert_eq!(in_rust!(MomentSplit: depth, radius, quads), in_wgsl(passes, "UmbrageMomentSplit"));
    let cull = |name: &str| in_wgsl(umbrage_shaders::CULL_PASS, name);
    assert_eq!(in_rust!(CullFrame: instances, splits, meshes, room), cull("UmbrageCullFrame"));
    assert_eq!(in_rust!(CullBox: center, mesh, half, skip), cull("UmbrageCullBox"));
    assert_eq!(in_rust!(CullMesh: first, room), cull("UmbrageCullMesh"));
    let draw = in_rust!(CullDraw: index_count, instance_count, first_index, base_vertex, first_instance);
    assert_eq!(draw, cull("UmbrageCullDraw"));
    let split = in_rust!(CullSplit: direction, first_plane, receivers_min, plane_count, receivers_max, has_receivers,
        slack, margin, mask_axis, mask_sign, mask_begin, mask_cell, mask_slope);
    assert_eq!(split, cull("UmbrageCullSplit"));
    let kept = in_wgsl(umbrage_shaders::KEPT_PASS, "UmbrageKeptWindow");
    assert_eq!(in_rust!(KeptWindow: begin, corner, edge), kept);
    assert_eq!(in_rust!(MomentPass: split, size), in_wgsl(passes, "UmbrageMomentPass"));
    assert_eq!(in_rust!(Moments: exponents, bleeding, splits), in_wgsl(&receiver, "UmbrageMoments"));
}

/// The comparison above must be able to say no: one member moved, one renamed, one resized.
#[test]
fn disagreement_is_seen() {
    let source = umbrage_shaders::caster(0, Casters::default(), "");
    for (from, to) in [
        ("size: f32,\n    far: f32,", "far: f32,\n    size: f32,"),
        ("blend_begin: f32,", "blend_start: f32,"),
        ("texel_offset: vec2f,", "texel_offset: vec4f,"),
    ] {
        let changed = source.replace(from, to).replace(" + split.texel_offset", "");
        assert!(changed.contains(to), "{from} is not in the text any more");
        assert_ne!(split_in_rust(), in_wgsl(&changed, "UmbrageSplit"), "{from} became {to}");
    }
}
