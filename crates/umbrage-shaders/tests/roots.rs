//! Every root is parsed and validated without a GPU, and survives export to WebGL2.

use naga::back::glsl;
use naga::valid::{Capabilities, ModuleInfo, ValidationFlags, Validator};
use umbrage_shaders::layout::{BiasKind, FilterKind, MetricKind, SelectionKind, TransitionKind};
use umbrage_shaders::{Bound, Casters, ExactEdges, Lights, Maps, MaskText, MomentMaps, Projection, ReceiverText};

const WITHOUT_LOADS: Maps = Maps {
    bound: Bound::Array,
    r32f: false,
    without_loads: true,
    frames: 7,
    splits: 8,
    moments: None,
    coordinates: false,
};

/// Every way to bind maps and to read them.
fn all_maps() -> Vec<Maps> {
    let bounds = [Bound::Array, Bound::Cube].into_iter().chain((1..=8).map(Bound::Separate));
    bounds
        .flat_map(|bound| {
            [(false, false), (false, true), (true, false)].map(|(r32f, without_loads)| Maps {
                bound,
                r32f,
                without_loads,
                ..Maps::default()
            })
        })
        .chain(
            [MomentMaps::Sampled, MomentMaps::Taps, MomentMaps::Manual]
                .map(|moments| Maps { moments: Some(moments), ..Maps::default() }),
        )
        .collect()
}
const MOMENTS: Maps = Maps {
    bound: Bound::Array,
    r32f: false,
    without_loads: false,
    frames: 1,
    splits: 4,
    moments: Some(MomentMaps::Sampled),
    coordinates: false,
};
const MOMENTS_BY_TAPS: Maps = Maps { moments: Some(MomentMaps::Taps), ..MOMENTS };
const MOMENTS_MANUAL: Maps = Maps { moments: Some(MomentMaps::Manual), ..MOMENTS };

fn validated(source: &str) -> (naga::Module, ModuleInfo) {
    let module = naga::front::wgsl::parse_str(source).unwrap_or_else(|e| panic!("{}", e.emit_to_string(source)));
    let info = Validator::new(ValidationFlags::all(), Capabilities::MULTIVIEW | Capabilities::CLIP_DISTANCES)
        .validate(&module)
        .unwrap_or_else(|e| panic!("{}", e.emit_to_string(source)));
    (module, info)
}

fn to_webgl2(source: &str, stage: naga::ShaderStage, entry_point: &str) -> String {
    let (module, info) = validated(source);
    let options = glsl::Options { version: glsl::Version::new_gles(300), ..glsl::Options::default() };
    let pipeline = glsl::PipelineOptions { shader_stage: stage, entry_point: entry_point.to_owned(), multiview: None };
    let mut text = String::new();
    glsl::Writer::new(&mut text, &module, &info, &options, &pipeline, naga::proc::BoundsCheckPolicies::default())
        .expect("the writer takes the module")
        .write()
        .expect("GLSL ES 3.00 can say it");
    text
}

fn vertex_shader(group: u32) -> String {
    umbrage_shaders::caster(group, Casters::default(), "")
        + "@vertex fn vertex(@location(0) position: vec3f) -> @builtin(position) vec4f {
               return umbrage_cast_at(position, 0u).position;
           }"
}

/// A vertex shader that is the same for every way to draw casters.
fn copying_shader(casters: Casters) -> String {
    umbrage_shaders::caster(0, casters, "@location(0) uv: vec2f,")
        + "@vertex fn vertex(@location(0) position: vec3f, instance: UmbrageInstance) -> UmbrageCast {
               var result = umbrage_cast(position, instance);
               result.uv = position.xy;
               return umbrage_named(result, umbrage_caster_id(1u, 2u));
           }
           @fragment fn fragment(@builtin(position) at: vec4f, @location(0) uv: vec2f) -> @location(0) UmbrageTexel {
               if uv.x > 0.5 { discard; }
               return umbrage_caster_texel(at, 0u);
           }"
}

fn fragment_shader(group: u32) -> String {
    umbrage_shaders::receiver(group, Maps::default()) + FRAGMENT
}

fn fragment_shader_without_loads(group: u32) -> String {
    umbrage_shaders::receiver(group, WITHOUT_LOADS) + FRAGMENT
}

fn fragment_shader_of_moments(group: u32, maps: Maps) -> String {
    umbrage_shaders::receiver(group, maps) + FRAGMENT
}

/// A compute shader knows no derivatives and compiles all the same.
fn compute_shader_of_moments(group: u32) -> String {
    umbrage_shaders::receiver(group, MOMENTS)
        + "@compute @workgroup_size(1) fn compute() { _ = umbrage_visibility(vec3f(0.0), vec3f(0.0, 1.0, 0.0)); }"
}

const FRAGMENT: &str =
    "@fragment fn fragment(@location(0) position: vec3f, @builtin(position) pixel: vec4f) -> @location(0) vec4f {
               let up = vec3f(0.0, 1.0, 0.0);
               var query = umbrage_fragment_query(position, up, dpdx(position), dpdy(position), pixel.xy);
               if pixel.x > 100.0 {
                   return vec4f(umbrage_shadow(query).visibility);
               }
               let shadow = umbrage_shadow(umbrage_query(position, up));
               query.split = 1;
               let one = umbrage_shadow(query).visibility;
               query.split = -1;
               query.light = u32(position.x);
               let other = umbrage_shadow(query).visibility;
               return vec4f(shadow.tint * shadow.visibility, one * other * f32(shadow.split));
           }";

fn contact_shader(group: u32) -> String {
    umbrage_shaders::contact(group)
        + "@fragment fn fragment(@location(0) position: vec3f) -> @location(0) vec4f {
               return vec4f(umbrage_contact_visibility(position, vec3f(0.0, 1.0, 0.0), vec3f(0.0, 1.0, 0.0), 0.5));
           }"
}

#[test]
fn contact_shadows_stand_beside_receivers() {
    validated(&(umbrage_shaders::receiver(1, Maps::default()) + &contact_shader(2)));
}

#[test]
fn roots_are_valid_wgsl_in_any_bind_group() {
    for group in [0, 1, 3] {
        let texts = [
            vertex_shader(group),
            fragment_shader(group),
            fragment_shader_without_loads(group),
            fragment_shader_of_moments(group, MOMENTS),
            fragment_shader_of_moments(group, MOMENTS_BY_TAPS),
            fragment_shader_of_moments(group, MOMENTS_MANUAL),
            compute_shader_of_moments(group),
            contact_shader(group),
        ];
        for source in texts {
            let (module, _) = validated(&source);
            let groups: Vec<u32> =
                module.global_variables.iter().filter_map(|(_, v)| v.binding.map(|b| b.group)).collect();
            assert!(!groups.is_empty() && groups.iter().all(|&g| g == group), "bindings lie in {groups:?}");
        }
    }
}

#[test]
fn every_way_to_read_and_to_draw_maps_is_valid_wgsl() {
    for maps in all_maps() {
        validated(&(umbrage_shaders::receiver(2, maps) + FRAGMENT));
    }
    for (views, tiles) in [(false, false), (true, false), (false, true), (true, true)] {
        for ids in [false, true] {
            validated(&copying_shader(Casters { views, tiles, ids }));
        }
    }
}

/// Every receiver that may have exact edges, with the stored runs beside it.
#[test]
fn exact_edges_are_valid_wgsl() {
    let suns = [Lights::Suns, Lights::Single, Lights::Any];
    let projections = [Projection::Plain, Projection::Warped, Projection::Any];
    let filter = Some(FilterKind::Pcf3);
    for (coordinates, lights, projection) in
        [false, true].into_iter().flat_map(|c| suns.into_iter().flat_map(move |l| projections.map(|p| (c, l, p))))
    {
        let maps = Maps { coordinates, ..Maps::default() };
        let exact = Some(ExactEdges { positions: if coordinates { 1 } else { 4 }, counted: lights == Lights::Suns });
        let text = ReceiverText { exact, filter, lights, projection, ..maps.into() };
        let (module, _) =
            validated(&(umbrage_shaders::receiver(1, text) + &umbrage_shaders::stored_runs(0, 3) + FRAGMENT));
        let bound = |name: &str| {
            let found = module.global_variables.iter().find(|(_, v)| v.name.as_deref() == Some(name));
            found.and_then(|(_, v)| v.binding.map(|it| (it.group, it.binding)))
        };
        assert_eq!([bound("umbrage_ids"), bound("umbrage_slots")], [Some((1, 3)), Some((0, 3))]);
        assert_eq!(bound("umbrage_run_positions"), Some((0, 6)));
    }
    for (bound, ids) in [(Bound::Cube, [4, 4]), (Bound::Separate(1), [4, 4]), (Bound::Separate(8), [11, 18])] {
        let maps = Maps { bound, ..Maps::default() };
        let text = ReceiverText { exact: Some(ExactEdges::default()), filter, ..maps.into() };
        let (module, _) =
            validated(&(umbrage_shaders::receiver(1, text) + &umbrage_shaders::stored_runs(0, 3) + FRAGMENT));
        let named = module
            .global_variables
            .iter()
            .filter(|(_, v)| v.name.as_deref().is_some_and(|n| n.starts_with("umbrage_ids")));
        let bound: Vec<u32> = named.filter_map(|(_, v)| v.binding.map(|it| it.binding)).collect();
        assert_eq!([bound.iter().min(), bound.iter().max()], [ids.first(), ids.last()]);
    }
    // Without the choice nobody has them, and nobody has to declare what they ask.
    let sampled = umbrage_shaders::receiver(0, ReceiverText::default());
    assert!(!sampled.contains("umbrage_run") && !sampled.contains("UmbrageRun") && !sampled.contains("umbrage_map_id"));
}

/// A vertex shader that takes its built-ins itself, as skinned and indirect draws do.
#[test]
fn casters_may_take_their_built_ins_themselves() {
    for (views, tiles) in [(false, false), (true, false), (false, true), (true, true)] {
        let (builtin, view) = if views { ("@builtin(view_index) view: u32,", ", view") } else { ("", "") };
        let shader = format!(
            "@vertex fn vertex(
                @location(0) position: vec3f,
                @location(1) code: u32,
                @builtin(instance_index) own: u32,
                {builtin}
            ) -> UmbrageCast {{
                return umbrage_cast_at(position + vec3f(f32(own)), code{view});
            }}"
        );
        validated(&(umbrage_shaders::caster(0, Casters { views, tiles, ids: views }, "") + &shader));
    }
}

/// As many textures as there are maps, and no more: an app's own textures count against the same
/// limit.
#[test]
fn separate_maps_bind_no_texture_too_many() {
    for count in 1..=8 {
        let source = umbrage_shaders::receiver(0, Maps { bound: Bound::Separate(count), ..Maps::default() });
        assert_eq!(source.matches(": texture_depth_2d;").count(), count);
    }
}

#[test]
fn roots_export_to_webgl2() {
    assert!(to_webgl2(&vertex_shader(0), naga::ShaderStage::Vertex, "vertex").contains("void main"));
    for maps in all_maps().into_iter().filter(|maps| maps.without_loads || maps.r32f) {
        to_webgl2(&(umbrage_shaders::receiver(1, maps) + FRAGMENT), naga::ShaderStage::Fragment, "fragment");
    }
    let text = to_webgl2(&fragment_shader_without_loads(1), naga::ShaderStage::Fragment, "fragment");
    assert!(text.contains("sampler2DArrayShadow"), "depth maps become shadow samplers");
}

#[test]
fn moment_passes_are_valid_wgsl() {
    for source in [umbrage_shaders::MOMENT_PASSES, umbrage_shaders::MOMENT_PASSES_OF_SAMPLES] {
        let (module, _) = validated(source);
        let names: Vec<&str> = module.entry_points.iter().map(|entry| entry.name.as_str()).collect();
        assert_eq!(names, ["vs_all", "fs_convert", "fs_blur_u", "fs_blur_v", "fs_halve"]);
    }
}

#[test]
fn the_pass_of_kept_maps_is_valid_wgsl() {
    let (module, _) = validated(umbrage_shaders::KEPT_PASS);
    let names: Vec<&str> = module.entry_points.iter().map(|entry| entry.name.as_str()).collect();
    assert_eq!(names, ["vs_all", "fs_copy"]);
}

#[test]
fn every_name_is_in_our_namespace() {
    let casters = [(false, false), (true, false), (false, true), (true, true)]
        .map(|(views, tiles)| umbrage_shaders::caster(0, Casters { views, tiles, ids: tiles }, ""));
    let contact = umbrage_shaders::contact(0);
    for source in casters
        .into_iter()
        .chain([contact])
        .chain(all_maps().into_iter().map(|maps| umbrage_shaders::receiver(0, maps)))
    {
        let module = naga::front::wgsl::parse_str(&source).expect("a valid root");
        let names = (module.functions.iter().filter_map(|(_, f)| f.name.clone()))
            .chain(module.global_variables.iter().filter_map(|(_, v)| v.name.clone()))
            .chain(module.constants.iter().filter_map(|(_, c)| c.name.clone()))
            .chain(module.types.iter().filter_map(|(_, t)| t.name.clone()));
        let mut count = 0;
        for name in names {
            assert!(name.to_lowercase().starts_with("umbrage"), "{name} could clash with a name of the app");
            count += 1;
        }
        assert!(count > 3, "only {count} names were looked at");
        assert!(module.overrides.is_empty() && module.entry_points.is_empty(), "a root adds nothing to a pipeline");
    }
}

#[test]
fn deferred_masks_stand_behind_receivers() {
    for (normals, bounds) in [(false, false), (true, false), (false, true), (true, true)] {
        let text = ReceiverText { bounds, ..ReceiverText::default() };
        let own = umbrage_shaders::mask(0, MaskText { normals, turns: !bounds, footprint: normals, bounds });
        validated(&(umbrage_shaders::receiver(1, text) + &own));
    }
}

#[test]
fn vertices_make_the_coordinates_of_every_split() {
    const SHADER: &str = "
        struct Pixel {
            @builtin(position) clip: vec4f,
            @location(0) position: vec3f,
            @location(1) first: vec3f,
            @location(2) second: vec3f,
            @location(3) third: vec3f,
            @location(4) fourth: vec3f,
        }
        @vertex fn vertex(@location(0) position: vec3f) -> Pixel {
            let at = umbrage_shadow_coordinates(position);
            return Pixel(vec4f(position, 1.0), position, at.first, at.second, at.third, at.fourth);
        }
        @fragment fn fragment(in: Pixel) -> @location(0) vec4f {
            let coordinates = UmbrageShadowCoordinates(in.first, in.second, in.third, in.fourth);
            var query = umbrage_query(in.position, vec3f(0.0, 1.0, 0.0));
            query.pixel = in.clip.xy;
            let shadow = umbrage_shadow_from_coordinates(query, coordinates);
            return vec4f(shadow.visibility + umbrage_visibility(in.position, vec3f(0.0, 1.0, 0.0)));
        }";
    for maps in all_maps() {
        let source = umbrage_shaders::receiver(0, Maps { coordinates: true, ..maps }) + SHADER;
        validated(&source);
    }
    let source = umbrage_shaders::receiver(0, Maps { coordinates: true, frames: 1, ..WITHOUT_LOADS }) + SHADER;
    assert!(to_webgl2(&source, naga::ShaderStage::Vertex, "vertex").contains("umbrage_shadow_coordinates"));
    to_webgl2(&source, naga::ShaderStage::Fragment, "fragment");
    // Without the choice nobody has the functions, and nobody pays for them.
    assert!(!umbrage_shaders::receiver(0, Maps::default()).contains("UmbrageShadowCoordinates"));
}

/// The kinds of filters that read such maps.
fn kinds(maps: Maps) -> impl Iterator<Item = FilterKind> {
    FilterKind::ALL.into_iter().filter(move |kind| kind.is_of_moments() == maps.moments.is_some())
}

/// What `ReceiverText` leaves to choose, one after the other; each with the value at `pick`,
/// counted around.
fn chosen(pick: [usize; 8], maps: Maps) -> ReceiverText {
    fn of<T: Copy>(values: &[T], at: usize) -> T {
        values[at % values.len()]
    }
    let filters: Vec<Option<FilterKind>> = [None].into_iter().chain(kinds(maps).map(Some)).collect();
    ReceiverText {
        filter: of(&filters, pick[0]),
        selection: of(&[None, Some(SelectionKind::Depth), Some(SelectionKind::Map)], pick[1]),
        metric: of(&[None, Some(MetricKind::ViewDepth), Some(MetricKind::Distance)], pick[2]),
        transition: of(
            &[None, Some(TransitionKind::Blend), Some(TransitionKind::Dither), Some(TransitionKind::Hard)],
            pick[3],
        ),
        bias: of(&[None, Some(BiasKind::Plane), Some(BiasKind::Slope)], pick[4]),
        projection: of(&[Projection::Any, Projection::Plain, Projection::Warped], pick[5]),
        lights: of(&[Lights::Any, Lights::Single, Lights::Suns], pick[6]),
        sliced: pick[7].is_multiple_of(2),
        ..maps.into()
    }
}

/// Every pair of values of two choices stands in some text, whatever the maps.
#[test]
fn every_pair_of_choices_is_valid_wgsl() {
    for maps in [
        Maps::default(),
        Maps { r32f: true, ..Maps::default() },
        Maps { bound: Bound::Cube, ..WITHOUT_LOADS },
        Maps { coordinates: true, ..Maps::default() },
        MOMENTS,
    ] {
        for (first, second) in (0..8).flat_map(|first| (first + 1..8).map(move |second| (first, second))) {
            for (a, b) in (0..=kinds(maps).count()).flat_map(|a| (0..4).map(move |b| (a, b))) {
                // The others change along, so that no choice is looked at in one text alone.
                let mut pick = [a + b; 8];
                (pick[first], pick[second]) = (a, b);
                let source = umbrage_shaders::receiver(1, chosen(pick, maps)) + FRAGMENT;
                assert!(!source.contains("@if") && !source.contains("@else"), "{pick:?}");
                validated(&source);
            }
        }
    }
}
