//! The main API: what it costs to change something, what a refused frame leaves behind, several
//! lights and views.

mod common;

use common::{Gpu, PCF3, config, with};
use glam::DVec3;
use umbrage::config::{Kind, LightKind, Rebuilds, SETTINGS, Setting};
use umbrage::{Aabb, Caster, CasterSet, DirectionalLight, Frustum, Layers, Light, PointLight, Split, View};
use umbrage_wgpu::{CasterPipeline, Error, Inputs, LightMaps, ShadowFrame, Shadows};

fn sun() -> Light {
    DirectionalLight::new(DVec3::new(0.4, -1.0, 0.3)).expect("a direction").into()
}

fn lamp() -> Light {
    PointLight::new(DVec3::new(0.0, 5.0, 0.0), 12.0).expect("a lamp").into()
}

/// A camera that turns and walks a little with every frame.
fn view(frame: u32) -> View {
    let lens = Frustum::perspective(1.1, 4.0 / 3.0, 0.3, 120.0).expect("a lens");
    let t = f64::from(frame);
    let eye = DVec3::new(-9.0 + 0.31 * t, 4.0, 11.0 - 0.17 * t);
    View::look_at_upright(eye, DVec3::new((0.21 * t).sin(), 0.5, -0.4 * t), lens).expect("a view")
}

fn casters() -> Vec<Aabb> {
    (0..24)
        .map(|i| {
            let at = DVec3::new(f64::from(i % 6) * 4.0 - 10.0, 0.0, f64::from(i / 6) * 5.0 - 12.0);
            Aabb::new(at, at + DVec3::new(1.0, 1.0 + f64::from(i % 4), 1.0))
        })
        .collect()
}

fn receivers() -> Vec<Aabb> {
    let ground = Aabb::new(DVec3::new(-60.0, -0.1, -60.0), DVec3::new(60.0, 0.0, 60.0));
    casters().into_iter().chain([ground]).collect()
}

fn prepared(gpu: &Gpu, shadows: &mut Shadows, frame: u32, view_slot: u32) -> Vec<Split> {
    let (casters, receivers, view, lights) = (casters(), receivers(), view(frame), [sun()]);
    let inputs = Inputs { casters: &casters, receivers: &receivers, view_slot, ..Inputs::new(&view, &lights) };
    shadows.prepare(&gpu.queue, &inputs).expect("a frame").plan(0).splits.clone()
}

/// Values of a setting that are worth changing to.
fn values(setting: &Setting) -> Vec<String> {
    let texts = |texts: &[&str]| texts.iter().map(|text| (*text).to_owned()).collect();
    match setting.kind {
        Kind::Words(words) | Kind::WordList(words) => words.iter().map(|word| word.word.to_owned()).collect(),
        Kind::Share(most) => vec![(0.3 * most).to_string()],
        Kind::Metres => texts(&["0.4"]),
        Kind::MetresList => texts(&["12"]),
        Kind::Range => texts(&["0.5..60"]),
        Kind::Degrees(most) => vec![(0.1 * most).to_string()],
        Kind::Count(least, most) => vec![least.to_string(), most.to_string()],
        Kind::CountOf(counts) => counts.iter().map(u32::to_string).collect(),
        Kind::Texels => texts(&["128", "80"]),
        Kind::Colour => texts(&["0.1,0.2,0.3"]),
        Kind::Switch => texts(&["on", "off"]),
    }
}

/// Pipelines of an application, made once.
struct Pipelines {
    casters: wgpu::RenderPipeline,
    receivers: wgpu::ComputePipeline,
}

impl Pipelines {
    fn new(gpu: &Gpu, shadows: &Shadows) -> Self {
        let text = shadows.receiver_wgsl(0)
            + "@compute @workgroup_size(1) fn main() { _ = umbrage_visibility(vec3f(0.0), vec3f(0.0, 1.0, 0.0)); }";
        let module = gpu.device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: None,
            source: wgpu::ShaderSource::Wgsl(text.into()),
        });
        let layout = gpu.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            bind_group_layouts: &[Some(shadows.bind_group_layout())],
            ..Default::default()
        });
        let receivers = gpu.device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: None,
            layout: Some(&layout),
            module: &module,
            entry_point: None,
            compilation_options: Default::default(),
            cache: None,
        });
        let casters = shadows.caster_pipeline(&CasterPipeline::default()).expect("a pipeline");
        Self { casters, receivers }
    }

    /// A frame with one triangle for each caster.
    fn draw(&self, gpu: &Gpu, shadows: &mut Shadows) {
        prepared(gpu, shadows, 0, 0);
        let vertices = gpu.buffer_with(&[0; 36], wgpu::BufferUsages::VERTEX);
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        for map in shadows.frame().maps() {
            let mut pass = map.begin(&mut encoder);
            pass.set_pipeline(&self.casters);
            pass.set_bind_group(0, map.bind_group(), &[]);
            pass.set_vertex_buffer(0, vertices.slice(..));
            map.casters().for_each(|(_, instances)| pass.draw(0..3, instances));
        }
        shadows.prefilter(&mut encoder);
        {
            let mut pass = encoder.begin_compute_pass(&Default::default());
            pass.set_pipeline(&self.receivers);
            pass.set_bind_group(0, shadows.bind_group(), &[]);
            pass.dispatch_workgroups(1, 1, 1);
        }
        gpu.queue.submit([encoder.finish()]);
    }
}

/// The table of `Setting::rebuilds`, walked: every setting of every config below is changed, and
/// pipelines that were made before go on drawing wherever the table says that they do.
#[test]
fn the_table_says_what_keeps_pipelines_valid() {
    let Some(gpu) = Gpu::new() else { return };
    let (mut walked, mut kept) = (0, 0);
    for base in ["", "stabilize=none", "stabilize=approximate filter=pcss", "filter=evsm4", "filter=disc blend=0"] {
        let base = config(&[96; 3], PCF3, base);
        let mut shadows = Shadows::new(&gpu.device, &base).expect("valid");
        let pipelines = gpu.checked(|| Pipelines::new(&gpu, &shadows));
        for setting in SETTINGS {
            for value in values(setting) {
                let mut changed = base.clone();
                let given = [(setting.key.to_owned(), value.clone())];
                if changed.apply(&given).is_err() || changed == base {
                    continue;
                }
                let promised = base.rebuilds(&changed).expect("something has changed").0;
                let answer = match shadows.set_config(&changed) {
                    Ok(answer) => answer,
                    Err(Error::MissingFeature { .. } | Error::NoFilterableFloats { .. }) => continue,
                    Err(error) => panic!("{}={value}: {error}", setting.key),
                };
                assert!(answer <= promised, "{}={value}: {answer:?}, but {promised:?} at most", setting.key);
                // A setting may take others along; alone it costs no more than the table says.
                let alone = SETTINGS.iter().filter(|other| other.get(&base) != other.get(&changed)).count() == 1;
                assert!(!alone || promised == setting.rebuilds, "{}={value}", setting.key);
                if answer < Rebuilds::Pipelines {
                    gpu.checked(|| pipelines.draw(&gpu, &mut shadows));
                    kept += 1;
                }
                walked += 1;
                shadows.set_config(&base).expect("valid");
            }
        }
        gpu.checked(|| pipelines.draw(&gpu, &mut shadows));
    }
    eprintln!("{walked} changes, {kept} of them keep all pipelines");
    assert!(walked > 150 && kept > 80, "{walked} changes, {kept} kept");
}

/// What cannot change a shadow's place leaves it there, and other lights' maps too.
#[test]
fn shadows_stand_still_through_changes_that_do_not_concern_them() {
    let Some(gpu) = Gpu::new() else { return };
    let base = config(&[128; 3], PCF3, "stabilize=approximate");
    let mut undisturbed = Shadows::new(&gpu.device, &base).expect("valid");
    let mut changed = Shadows::new(&gpu.device, &base).expect("valid");
    let looks = ["shadow-strength=0.5", "shadow-colour=0.1,0.1,0.2", "bias=slope", "filter-width=0.4", "storage=atlas"];
    for frame in 0..10 {
        let settings = looks.get(frame as usize / 2).copied().unwrap_or_default();
        changed.set_config(&with(base.clone(), settings)).expect("valid");
        let found = prepared(&gpu, &mut changed, frame, 0);
        for (found, expected) in found.iter().zip(&prepared(&gpu, &mut undisturbed, frame, 0)) {
            assert_eq!(found.texel_m, expected.texel_m, "frame {frame}, {settings}");
        }
    }
    // The comparison can say no: of a planner that remembers nothing.
    undisturbed.restart();
    let fresh = prepared(&gpu, &mut undisturbed, 10, 0);
    let held = prepared(&gpu, &mut changed, 10, 0);
    assert!(fresh.iter().zip(&held).any(|(fresh, held)| fresh.texel_m != held.texel_m));
}

/// A window that is dragged larger pixel by pixel is planned for as it is, and still maps stay
/// where they are.
#[test]
fn a_resized_picture_moves_no_still_map() {
    let Some(gpu) = Gpu::new() else { return };
    let mut shadows = Shadows::new(&gpu.device, &config(&[128; 3], PCF3, "stabilize=exact")).expect("valid");
    let mut texels = Vec::new();
    for width in 1280..1300 {
        let (casters, receivers, view, lights) = (casters(), receivers(), view(0), [sun()]);
        let image_size = [width, 720];
        let inputs = Inputs { casters: &casters, receivers: &receivers, image_size, ..Inputs::new(&view, &lights) };
        let frame = shadows.prepare(&gpu.queue, &inputs).expect("a frame");
        texels.push(frame.plan(0).splits.iter().map(|split| (split.texel_m, split.min_texel)).collect::<Vec<_>>());
    }
    assert!(texels.iter().all(|of_frame| *of_frame == texels[0]), "{texels:?}");
}

#[test]
fn a_refused_frame_does_not_change_the_next() {
    let Some(gpu) = Gpu::new() else { return };
    let base = config(&[128; 3], PCF3, "stabilize=approximate");
    let mut undisturbed = Shadows::new(&gpu.device, &base).expect("valid");
    let mut disturbed = Shadows::new(&gpu.device, &base).expect("valid");
    let nan = Aabb::new(DVec3::NAN, DVec3::ONE);
    let inverted = Aabb::new(DVec3::ONE, DVec3::ZERO);
    for frame in 0..8 {
        let (casters, receivers, elsewhere) = (casters(), receivers(), view(frame * 7 + 40));
        let one = [sun()];
        let good = Inputs { casters: &casters, receivers: &receivers, ..Inputs::new(&elsewhere, &one) };
        let bad: [(&str, Inputs<'_>); 7] = [
            ("casters[0]", Inputs { casters: &[nan], ..good }),
            ("receivers[0]", Inputs { receivers: &[inverted], ..good }),
            ("origin", Inputs { origin: DVec3::new(f64::INFINITY, 0.0, 0.0), ..good }),
            ("image_size", Inputs { image_size: [0, 5], ..good }),
            ("0 lights", Inputs { lights: &[], ..good }),
            ("2 lights", Inputs { lights: &[sun(), sun()], ..good }),
            ("Point", Inputs { lights: &[lamp()], ..good }),
        ];
        for (culprit, inputs) in bad {
            let error = disturbed.prepare(&gpu.queue, &inputs).map(|_| ()).expect_err(culprit).to_string();
            assert!(error.contains(culprit), "{culprit}: {error}");
        }
        // Nor does one without shadows.
        let without = disturbed.prepare(&gpu.queue, &Inputs { enabled: false, ..good }).expect("a frame");
        assert_eq!(without.maps().count(), 0);
        assert_eq!(prepared(&gpu, &mut disturbed, frame, 0), prepared(&gpu, &mut undisturbed, frame, 0), "{frame}");
    }
}

#[test]
fn views_hold_their_maps_apart() {
    let Some(gpu) = Gpu::new() else { return };
    let base = config(&[128; 2], PCF3, "stabilize=approximate");
    let new = || Shadows::new(&gpu.device, &base).expect("valid");
    let (mut both, mut first, mut second) = (new(), new(), new());
    for frame in 0..12 {
        assert_eq!(prepared(&gpu, &mut both, frame, 0), prepared(&gpu, &mut first, frame, 0));
        assert_eq!(prepared(&gpu, &mut both, 100 - 3 * frame, 1), prepared(&gpu, &mut second, 100 - 3 * frame, 0));
    }
    // A view goes on under another number.
    both.move_view(1, 7);
    assert!(both.holds_view(7) && !both.holds_view(1));
    assert_eq!(prepared(&gpu, &mut both, 3, 7), prepared(&gpu, &mut second, 3, 0));
}

#[test]
fn a_lamp_beside_a_sun_has_maps_of_its_own() {
    let Some(gpu) = Gpu::new() else { return };
    // Bands by distance instead of depth are the sun's alone.
    let asked = config(&[128; 4], PCF3, "bands=radial range-fit=camera stabilize=exact");
    let lights = [LightMaps::from(LightKind::Directional), LightMaps::with_sizes(LightKind::Point, &[64])];
    let mut shadows = Shadows::with_lights(&gpu.device, &asked, &lights).expect("valid");
    assert_eq!(shadows.maps().map_count(), 4 + 6);
    assert!(shadows.notes().iter().any(|note| note.contains("bands radial")), "{:?}", shadows.notes());
    let (casters, receivers, view, both) = (casters(), receivers(), view(0), [sun(), lamp()]);
    let inputs = Inputs { casters: &casters, receivers: &receivers, ..Inputs::new(&view, &both) };
    let frame = shadows.prepare(&gpu.queue, &inputs).expect("a frame");
    assert_eq!((frame.plan(0).splits.len(), frame.plan(1).splits.len()), (4, 6));
    for map in frame.maps() {
        let plan = frame.plan(map.light());
        assert_eq!(map.splits().len(), 1);
        let listed: Vec<u32> = map.casters().map(|(caster, _)| caster).collect();
        assert_eq!(listed, plan.casters(map.splits().start), "light {}", map.light());
        assert!(!listed.is_empty(), "maps that nobody reads are not drawn");
        let rows: Vec<u32> = map.rows().expect("one map a pass").flatten().collect();
        assert_eq!(rows, listed);
    }
    // Switching the lamp off needs other texts: receivers have fewer frames to choose from.
    assert_eq!(shadows.set_lights(&[LightKind::Directional]), Ok(Rebuilds::Pipelines));
    assert_eq!(shadows.set_lights(&[LightMaps::with_sizes(LightKind::Directional, &[64; 2])]), Ok(Rebuilds::Maps));
    assert_eq!(shadows.maps().map_sizes(0), [64; 2]);
    let error = shadows.set_config(&config(&[128; 4], common::PCSS, "")).map(|_| ());
    assert_eq!(error, Ok(()));
    let error = shadows.set_lights(&[LightKind::Spot]).expect_err("no sun");
    assert!(error.to_string().contains("filter pcss"), "{error}");
    assert_eq!(shadows.lights().len(), 1, "what was refused changes nothing");
}

/// An application that gives no receivers, or none that is in view, still has shadows.
#[test]
fn casters_serve_as_receivers() {
    let Some(gpu) = Gpu::new() else { return };
    let mut shadows = Shadows::new(&gpu.device, &config(&[128; 3], PCF3, "")).expect("valid");
    let (casters, view, lights) = (casters(), view(0), [sun()]);
    let behind = [Aabb::new(DVec3::splat(900.0), DVec3::splat(901.0))];
    for receivers in [&[][..], &behind] {
        let inputs = Inputs { casters: &casters, receivers, ..Inputs::new(&view, &lights) };
        let frame = shadows.prepare(&gpu.queue, &inputs).expect("a frame");
        let drawn: usize = frame.maps().map(|map| map.casters().len()).sum();
        assert!(drawn > 10, "{drawn} casters drawn");
    }
    // Nothing at all is no error: there is nothing to shade.
    let empty = Inputs::new(&view, &lights);
    assert!(shadows.prepare(&gpu.queue, &empty).is_ok_and(|frame| frame.maps().all(|map| map.casters().len() == 0)));
}

/// The shaders that the documentation shows make pipelines, with every layout and format.
#[test]
fn documented_caster_shaders_make_pipelines() {
    let Some(gpu) = Gpu::new() else { return };
    let storage = gpu.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: None,
        entries: &[wgpu::BindGroupLayoutEntry {
            binding: 0,
            visibility: wgpu::ShaderStages::VERTEX,
            ty: wgpu::BindingType::Buffer {
                ty: wgpu::BufferBindingType::Storage { read_only: true },
                has_dynamic_offset: false,
                min_binding_size: None,
            },
            count: None,
        }],
    });
    let entry =
        |binding, ty| wgpu::BindGroupLayoutEntry { binding, visibility: wgpu::ShaderStages::FRAGMENT, ty, count: None };
    let sample_type = wgpu::TextureSampleType::Float { filterable: true };
    let view_dimension = wgpu::TextureViewDimension::D2;
    let texture = gpu.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: None,
        entries: &[
            entry(0, wgpu::BindingType::Texture { sample_type, view_dimension, multisampled: false }),
            entry(1, wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering)),
        ],
    });
    let plain = CasterPipeline::default();
    let skin = wgpu::vertex_attr_array![0 => Float32x3, 1 => Uint16x4, 2 => Float32x4];
    let leaf = wgpu::vertex_attr_array![0 => Float32x3, 1 => Float32x2];
    let instanced = CasterPipeline {
        wgsl: include_str!("../examples/casters/instanced.wgsl"),
        bind_group_layouts: &[Some(&storage)],
        ..plain
    };
    let columns = wgpu::vertex_attr_array![5 => Float32x4, 6 => Float32x4, 7 => Float32x4, 8 => Float32x4];
    let position = wgpu::vertex_attr_array![0 => Float32x3];
    // A stride of 0 stays with the row that is bound: what maps of several splits are drawn with.
    let [rows, one_row] = [64, 0].map(|array_stride| {
        let row =
            wgpu::VertexBufferLayout { array_stride, step_mode: wgpu::VertexStepMode::Instance, attributes: &columns };
        [Some(CasterPipeline::positions(12, &position)), Some(row)]
    });
    let [in_rows, in_one_row] = [&rows, &one_row].map(|buffers| CasterPipeline {
        wgsl: include_str!("../examples/casters/instance_buffer.wgsl"),
        buffers,
        ..plain
    });
    let skinned = CasterPipeline {
        wgsl: include_str!("../examples/casters/skinned.wgsl"),
        buffers: &[Some(CasterPipeline::positions(36, &skin))],
        ..instanced
    };
    let alpha_tested = CasterPipeline {
        wgsl: include_str!("../examples/casters/alpha_tested.wgsl"),
        members: "@location(0) uv: vec2f,",
        discards: true,
        buffers: &[Some(CasterPipeline::positions(20, &leaf))],
        bind_group_layouts: &[Some(&texture)],
        ..plain
    };
    for settings in ["", "generation=layered", "generation=instanced", "depth-format=r32f", "filter=vsm msaa=4"] {
        let shadows =
            Shadows::new(&gpu.device, &config(&[64; 3], PCF3, &format!("blend=0 {settings}"))).expect("valid");
        // Where instances say which splits are meant, the application has none of its own.
        let own_instances = !settings.starts_with("generation");
        let instanced = if own_instances { vec![instanced, in_rows] } else { vec![in_one_row] };
        for options in [plain, skinned, alpha_tested].into_iter().chain(instanced) {
            gpu.checked(|| shadows.caster_pipeline(&options).unwrap_or_else(|error| panic!("{settings}: {error}")));
        }
        // A shader that is none is an error of ours and not the device's.
        let bad = CasterPipeline { wgsl: "@vertex fn vertex() {}", ..plain };
        assert!(matches!(shadows.caster_pipeline(&bad).map(|_| ()), Err(Error::Device { .. })));
    }
}

/// A set is drawn as the lists of its boxes are, in every generation of passes.
#[test]
fn a_set_is_drawn_as_its_lists() {
    let Some(gpu) = Gpu::new() else { return };
    let mut set = CasterSet::new();
    for (key, bounds) in (0..).zip(casters()) {
        set.insert(Caster::new(bounds, key)).expect("valid");
    }
    let ground = receivers()[casters().len()];
    set.insert(Caster { casts: false, ..Caster::new(ground, 1000) }).expect("valid");
    // What the lists hold is what the set keeps.
    let of = |is_asked: fn(&Caster) -> bool| {
        let kept = set.iter().map(|(_, caster)| caster).filter(is_asked);
        kept.map(|caster| caster.bounds).collect::<Vec<Aabb>>()
    };
    let (casters, receivers) = (of(|caster| caster.casts), of(|caster| caster.receives));
    for generation in ["per-split", "layered", "instanced", "mixed"] {
        let config = config(&[128; 3], PCF3, &format!("stabilize=approximate generation={generation}"));
        let [mut by_set, mut by_list] = [(); 2].map(|()| Shadows::new(&gpu.device, &config).expect("valid"));
        for frame in 0..4 {
            let (view, lights) = (view(5 * frame), [sun()]);
            let of_set = Inputs { set: Some(&set), ..Inputs::new(&view, &lights) };
            let of_list = Inputs { casters: &casters, receivers: &receivers, ..Inputs::new(&view, &lights) };
            let of_set = by_set.prepare(&gpu.queue, &of_set).expect("a frame");
            let of_list = by_list.prepare(&gpu.queue, &of_list).expect("a frame");
            let draws =
                |frame: ShadowFrame<'_>| frame.maps().map(|map| map.casters().collect()).collect::<Vec<Vec<_>>>();
            assert_eq!(draws(of_set), draws(of_list), "{generation}, frame {frame}");
            assert!(draws(of_set).iter().any(|map| !map.is_empty()), "something is drawn");
            assert_eq!(of_set.plan(0).splits, of_list.plan(0).splits);
        }
        let (view, lights) = (view(0), [sun()]);
        let both = Inputs { set: Some(&set), casters: &casters, ..Inputs::new(&view, &lights) };
        let refused = by_set.prepare(&gpu.queue, &both).map(|_| ());
        assert!(matches!(refused, Err(Error::SetAndLists { listed }) if listed == casters.len()), "{refused:?}");
        let nobody = Inputs { set: Some(&set), layers: Layers::NONE, ..Inputs::new(&view, &lights) };
        let frame = by_set.prepare(&gpu.queue, &nobody).expect("a frame");
        assert!(frame.maps().all(|map| map.casters().len() == 0), "nobody is asked for");
    }
}
