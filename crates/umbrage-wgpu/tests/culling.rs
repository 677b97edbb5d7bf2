//! Culling on the GPU: what passes is what the planner lists, maps and masks are those of its
//! lists, and the same lists are made on the CPU.

mod common;

use common::{Gpu, PCF3, config};
use glam::{DVec3, Vec3};
use umbrage::{Aabb, DirectionalLight, Frustum, Light, ShadowPlan, View};
use umbrage_wgpu::{CullBox, CullDraw};
use umbrage_wgpu::{CullInputs, CullMesh, Error, Inputs, InstanceCulling, ShadowConfig, Shadows};

const SPLITS: usize = 3;
const SIZE: u32 = 256;

/// Meshes: boxes and wedges that fill their boxes, of which two share vertices by an offset.
const MESHES: usize = 3;

/// A town of boxes around the origin of the world or of the application.
struct Town {
    boxes: Vec<CullBox>,
    origin: DVec3,
}

impl Town {
    fn new(count: u32, origin: DVec3) -> Self {
        let share = |i: u32, step: u32| (i.wrapping_mul(step) % 9973) as f32 / 9972.0;
        let boxes = (0..count).map(|i| {
            let half = Vec3::new(0.2 + share(i, 313), 0.3 + 2.5 * share(i, 771), 0.2 + share(i, 997));
            let at = Vec3::new(300.0 * share(i + 1, 5171) - 150.0, half.y, 300.0 * share(i + 1, 7919) - 150.0);
            CullBox {
                center: at.to_array(),
                mesh: i % MESHES as u32,
                half: half.to_array(),
                skip: u32::from(i % 31 == 0),
            }
        });
        Self { boxes: boxes.collect(), origin }
    }

    fn bounds(&self, own: &CullBox) -> Aabb {
        let (center, half) = (self.origin + Vec3::from(own.center).as_dvec3(), Vec3::from(own.half).as_dvec3());
        Aabb::new(center - half, center + half)
    }

    /// Boxes that hold everything, as an application knows them: tiles of 50 m.
    fn tiles(&self) -> Vec<Aabb> {
        let tile = |x: i32, z: i32| {
            let at = self.origin + DVec3::new(f64::from(x) * 50.0, 0.0, f64::from(z) * 50.0);
            Aabb::new(at - DVec3::new(2.0, 0.0, 2.0), at + DVec3::new(52.0, 6.0, 52.0))
        };
        (-3..3).flat_map(|x| (-3..3).map(move |z| tile(x, z))).collect()
    }

    fn view(&self, heading: f64) -> View {
        let frustum = Frustum::perspective(1.0, 1.5, 0.5, 160.0).expect("a lens");
        let eye = self.origin + DVec3::new(12.0, 9.0, -7.0);
        let target = eye + DVec3::new(heading.cos(), -0.12, heading.sin());
        View::look_at_upright(eye, target, frustum).expect("a view")
    }
}

fn sun() -> [Light; 1] {
    [DirectionalLight::new(DVec3::new(0.45, -0.8, 0.35)).expect("a sun").into()]
}

fn settings(extra: &str) -> ShadowConfig {
    config(&[SIZE; SPLITS], PCF3, extra)
}

/// Two boxes of 36 indices each, the second drawn by an offset of vertices, and a wedge.
fn meshes(instances: u32) -> (Vec<CullMesh>, Vec<[f32; 3]>, Vec<u32>) {
    let corner = |i: u32| [0, 1, 2].map(|axis| if i >> axis & 1 == 1 { 1.0 } else { -1.0 });
    let positions: Vec<[f32; 3]> = (0..8).chain(0..8).map(corner).collect();
    let faces: [[u32; 4]; 6] = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]];
    let mut indices: Vec<u32> = faces.iter().flat_map(|[a, b, c, d]| [*a, *b, *c, *a, *c, *d]).collect();
    indices.extend([0, 1, 5, 0, 5, 4, 0, 4, 2, 1, 3, 5, 2, 4, 5, 2, 5, 3, 0, 2, 3, 0, 3, 1]);
    let mesh = |indices, base_vertex| CullMesh { indices, base_vertex, instances };
    (vec![mesh(0..36, 0), mesh(0..36, 8), mesh(36..60, 0)], positions, indices)
}

/// What draws the town's boxes by their numbers.
struct Drawer {
    pipeline: wgpu::RenderPipeline,
    group: wgpu::BindGroup,
    boxes: wgpu::Buffer,
    vertices: wgpu::Buffer,
    indices: wgpu::Buffer,
}

const SHADER: &str = "
struct Box { center: vec3f, mesh: u32, half: vec3f, skip: u32 }
@group(1) @binding(0) var<storage, read> boxes: array<Box>;
@group(1) @binding(1) var<uniform> origin_from_boxes: vec4f;
@vertex fn vs_main(@location(0) corner: vec3f, @location(1) id: u32, own: UmbrageInstance) -> UmbrageCast {
    return umbrage_cast(origin_from_boxes.xyz + boxes[id].center + corner * boxes[id].half, own);
}";

impl Drawer {
    fn new(gpu: &Gpu, shadows: &Shadows, town: &Town, origin: DVec3) -> Self {
        let device = &gpu.device;
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some("Test::casters"),
            source: wgpu::ShaderSource::Wgsl((shadows.caster_wgsl(0) + SHADER).into()),
        });
        let entry = |binding, ty| wgpu::BindGroupLayoutEntry {
            binding,
            visibility: wgpu::ShaderStages::VERTEX,
            ty: wgpu::BindingType::Buffer { ty, has_dynamic_offset: false, min_binding_size: None },
            count: None,
        };
        let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("Test::boxes"),
            entries: &[
                entry(0, wgpu::BufferBindingType::Storage { read_only: true }),
                entry(1, wgpu::BufferBindingType::Uniform),
            ],
        });
        let boxes = gpu.buffer_with(bytemuck::cast_slice(&town.boxes), wgpu::BufferUsages::STORAGE);
        let by = (town.origin - origin).as_vec3().extend(0.0).to_array();
        let by = gpu.buffer_with(bytemuck::cast_slice(&by), wgpu::BufferUsages::UNIFORM);
        let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("Test::boxes"),
            layout: &layout,
            entries: &[
                wgpu::BindGroupEntry { binding: 0, resource: boxes.as_entire_binding() },
                wgpu::BindGroupEntry { binding: 1, resource: by.as_entire_binding() },
            ],
        });
        let maps = shadows.maps();
        let pipeline_layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some("Test::casters"),
            bind_group_layouts: &[Some(maps.caster_layout()), Some(&layout)],
            immediate_size: 0,
        });
        let attribute = |shader_location, format| wgpu::VertexAttribute { format, offset: 0, shader_location };
        let pipeline = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some("Test::casters"),
            layout: Some(&pipeline_layout),
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some("vs_main"),
                compilation_options: Default::default(),
                buffers: &[
                    Some(wgpu::VertexBufferLayout {
                        array_stride: 12,
                        step_mode: wgpu::VertexStepMode::Vertex,
                        attributes: &[attribute(0, wgpu::VertexFormat::Float32x3)],
                    }),
                    Some(wgpu::VertexBufferLayout {
                        array_stride: 4,
                        step_mode: wgpu::VertexStepMode::Instance,
                        attributes: &[attribute(1, wgpu::VertexFormat::Uint32)],
                    }),
                ],
            },
            primitive: maps.caster_primitive(),
            depth_stencil: Some(maps.caster_depth_stencil()),
            multisample: maps.caster_multisample(),
            fragment: None,
            multiview_mask: None,
            cache: None,
        });
        let (_, positions, indices) = meshes(1);
        let vertices = gpu.buffer_with(bytemuck::cast_slice(&positions), wgpu::BufferUsages::VERTEX);
        let indices = gpu.buffer_with(bytemuck::cast_slice(&indices), wgpu::BufferUsages::INDEX);
        Self { pipeline, group, boxes, vertices, indices }
    }

    fn set(&self, pass: &mut wgpu::RenderPass<'_>, map: &wgpu::BindGroup) {
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, map, &[]);
        pass.set_bind_group(1, &self.group, &[]);
        pass.set_vertex_buffer(0, self.vertices.slice(..));
        pass.set_index_buffer(self.indices.slice(..), wgpu::IndexFormat::Uint32);
    }
}

/// Who culls.
#[derive(Clone, Copy, Debug, PartialEq)]
enum By {
    /// The planner's test, box by box.
    Plan,
    Gpu,
    Cpu,
}

/// What a frame came to: numbers of instances by split and mesh, rising, and the texels of the
/// maps.
#[derive(Clone, Debug, PartialEq)]
struct Culled {
    lists: Vec<Vec<u32>>,
    maps: Vec<Vec<f32>>,
}

struct Stage {
    gpu: Gpu,
    shadows: Shadows,
    town: Town,
    drawer: Drawer,
    culling: InstanceCulling,
}

impl Stage {
    fn new(config: &ShadowConfig, origin: DVec3) -> Option<Self> {
        let gpu = Gpu::new()?;
        let town = Town::new(3000, origin);
        let shadows = Shadows::new(&gpu.device, config).expect("a config");
        let drawer = Drawer::new(&gpu, &shadows, &town, origin.round());
        let mut culling = InstanceCulling::new(&gpu.device, SPLITS, &meshes(1200).0).expect("culling");
        assert!(culling.can_compute(), "this device runs compute shaders");
        culling.bind(&drawer.boxes).expect("boxes");
        Some(Self { gpu, shadows, town, drawer, culling })
    }

    fn plan(&mut self, view: &View, clusters: Option<&[Aabb]>) -> ShadowPlan {
        let (tiles, lights, origin) = (self.town.tiles(), sun(), self.town.origin.round());
        let inputs = Inputs {
            casters: &tiles,
            receivers: &tiles,
            receiver_clusters: clusters,
            origin,
            ..Inputs::new(view, &lights)
        };
        self.shadows.prepare(&self.gpu.queue, &inputs).expect("a frame").plan(0).clone()
    }

    /// What the planner's test says of every instance.
    fn by_plan(&self, plan: &ShadowPlan) -> Vec<Vec<u32>> {
        let mut lists = vec![Vec::new(); SPLITS * MESHES];
        for (i, own) in self.town.boxes.iter().enumerate().filter(|(_, own)| own.skip == 0) {
            for split in (0..SPLITS).filter(|&split| plan.casts_into(split, &self.town.bounds(own))) {
                lists[split * MESHES + own.mesh as usize].push(i as u32);
            }
        }
        lists
    }

    /// Culls and draws the frame that was planned, and reads everything back.
    fn draw(&mut self, plan: &ShadowPlan, by: By) -> Culled {
        let (gpu, frame) = (&self.gpu, self.shadows.frame());
        let inputs = CullInputs { instances: self.town.boxes.len() as u32, origin: self.town.origin };
        self.culling.prepare(&gpu.queue, &frame, &inputs).expect("a plan of a sun");
        let listed = self.by_plan(plan);
        if by == By::Cpu {
            self.culling.cull_on_cpu(&gpu.queue, &self.town.boxes).expect("boxes");
        }
        gpu.checked(|| {
            let mut encoder = gpu.device.create_command_encoder(&Default::default());
            if by == By::Gpu {
                self.culling.cull(&mut encoder).expect("it is bound");
            }
            for map in frame.maps() {
                let mut pass = map.begin(&mut encoder);
                self.drawer.set(&mut pass, map.bind_group());
                for draw in self.culling.draws(&map) {
                    if by == By::Plan {
                        let ids = &listed[map.splits().start * MESHES + draw.mesh()];
                        let buffer = gpu.buffer_with(bytemuck::cast_slice(ids), wgpu::BufferUsages::VERTEX);
                        let mesh = &meshes(1).0[draw.mesh()];
                        pass.set_vertex_buffer(1, buffer.slice(..));
                        pass.draw_indexed(mesh.indices.clone(), mesh.base_vertex, 0..ids.len() as u32);
                    } else {
                        draw.draw(&mut pass, 1);
                    }
                }
            }
            gpu.queue.submit([encoder.finish()]);
        });
        let maps = (0..SPLITS).map(|split| common::painter::texels(gpu, &self.shadows, split)).collect();
        let lists = if by == By::Plan { listed } else { self.lists() };
        Culled { lists, maps }
    }

    /// The numbers that were written, rising.
    fn lists(&self) -> Vec<Vec<u32>> {
        let ids: Vec<u32> = bytemuck::pod_collect_to_vec(&self.gpu.copied(self.culling.ids()));
        let draws: Vec<CullDraw> = bytemuck::pod_collect_to_vec(&self.gpu.copied(self.culling.arguments()));
        let frame = self.shadows.frame();
        let mut lists = vec![Vec::new(); SPLITS * MESHES];
        for split in 0..SPLITS {
            for draw in self.culling.draws(&frame.map(split)) {
                let index = split * MESHES + draw.mesh();
                let count = draws[index].instance_count as usize;
                let first = draw.places().start as usize;
                let mut list = ids[first..first + count].to_vec();
                list.sort_unstable();
                lists[index] = list;
            }
        }
        lists
    }
}

/// Whether lists hold all that others do, and how much more.
fn holds_more(lists: &[Vec<u32>], wanted: &[Vec<u32>]) -> Option<usize> {
    let all = lists.iter().zip(wanted).all(|(list, wanted)| wanted.iter().all(|id| list.binary_search(id).is_ok()));
    let count = |lists: &[Vec<u32>]| lists.iter().map(Vec::len).sum::<usize>();
    all.then(|| count(lists) - count(wanted))
}

#[test]
fn maps_are_those_of_the_planners_lists() {
    for (settings_text, origin) in [
        ("shadow-range=0.5..150", DVec3::ZERO),
        ("shadow-range=0.5..150 stabilize=none", DVec3::new(1e5, 0.0, -3e4)),
        ("shadow-range=0.5..150 storage=separate", DVec3::new(-700.0, 0.0, 20.0)),
    ] {
        let Some(mut stage) = Stage::new(&settings(settings_text), origin) else { return };
        let mut drawn = 0;
        for heading in [0.0, 1.1, 2.9, 4.4] {
            let view = stage.town.view(heading);
            let plan = stage.plan(&view, None);
            let wanted = stage.draw(&plan, By::Plan);
            let (by_gpu, by_cpu) = (stage.draw(&plan, By::Gpu), stage.draw(&plan, By::Cpu));
            let more = holds_more(&by_gpu.lists, &wanted.lists).expect("everything that the planner lists");
            drawn += wanted.lists.iter().map(Vec::len).sum::<usize>();
            assert!(more <= 3, "{settings_text}: {more} more than the planner lists");
            assert!(holds_more(&by_cpu.lists, &wanted.lists).is_some_and(|more| more <= 3));
            // One instance more may have drawn a few texels that nobody asks.
            let differ = |a: &[f32], b: &[f32]| a.iter().zip(b).filter(|(a, b)| a != b).count();
            let differing: usize = by_gpu.maps.iter().zip(&wanted.maps).map(|(a, b)| differ(a, b)).sum();
            assert!(differing <= 500 * more, "{settings_text}, {heading}: {differing} texels by {more} more");
            assert_eq!(holds_more(&by_gpu.lists, &by_cpu.lists), Some(0), "the GPU and its twin on the CPU agree");
            assert!(by_cpu.maps == by_gpu.maps, "{settings_text}, {heading}");
            assert!(by_gpu.maps.iter().flatten().any(|&depth| depth < 1.0));
        }
        assert!(drawn > 1000, "{drawn} instances were drawn");
    }
}

#[test]
fn maps_chosen_by_what_they_contain_hold_everything_over_them() {
    let Some(mut stage) = Stage::new(&settings("shadow-range=0.5..150 selection=map stabilize=none"), DVec3::ZERO)
    else {
        return;
    };
    let view = stage.town.view(4.4);
    let plan = stage.plan(&view, None);
    // The planner's own test knows no such maps and says yes to all.
    let (all, culled) = (stage.draw(&plan, By::Plan), stage.draw(&plan, By::Gpu));
    let count = |culled: &Culled| culled.lists.iter().map(Vec::len).sum::<usize>();
    assert!(2 * count(&culled) < count(&all), "{} of {}", count(&culled), count(&all));
    assert!(culled.maps == all.maps, "what is left out draws nothing");
}

#[test]
fn the_receivers_mask_leaves_out_more_and_changes_nothing_that_is_seen() {
    let text = "shadow-range=0.5..150 fit=dependent stabilize=none";
    let Some(mut stage) = Stage::new(&settings(text), DVec3::ZERO) else { return };
    let view = stage.town.view(1.1);
    let plain = stage.plan(&view, None);
    let without = stage.draw(&plain, By::Gpu);
    // The ground alone receives, behind a wall of nothing: a strip of it.
    let strip: Vec<Aabb> = stage.town.tiles().into_iter().filter(|tile| tile.min.x < 0.0).collect();
    let plan = stage.plan(&view, Some(&strip));
    let (wanted, masked, on_cpu) =
        (stage.draw(&plan, By::Plan), stage.draw(&plan, By::Gpu), stage.draw(&plan, By::Cpu));
    let count = |culled: &Culled| culled.lists.iter().map(Vec::len).sum::<usize>();
    assert!(count(&masked) < count(&without), "{} of {}", count(&masked), count(&without));
    assert!(
        holds_more(&masked.lists, &wanted.lists).is_some(),
        "the mask on the GPU leaves out what the planner draws"
    );
    assert!(holds_more(&on_cpu.lists, &wanted.lists).is_some());
}

#[test]
fn another_view_is_told_apart() {
    let Some(mut stage) = Stage::new(&settings("shadow-range=0.5..150"), DVec3::ZERO) else { return };
    let [view, other] = [0.0, 2.9].map(|heading| stage.town.view(heading));
    let plan = stage.plan(&view, None);
    let wanted = stage.draw(&plan, By::Plan);
    let elsewhere = stage.plan(&other, None);
    let culled = stage.draw(&elsewhere, By::Gpu);
    assert!(holds_more(&culled.lists, &wanted.lists).is_none() && culled.maps != wanted.maps);
    // A list with one number too few is told apart as well.
    let mut short = stage.draw(&elsewhere, By::Plan).lists;
    let full = short.clone();
    short.iter_mut().find(|list| !list.is_empty()).expect("a caster").pop();
    assert!(holds_more(&short, &full).is_none() && holds_more(&full, &short) == Some(1));
}

#[test]
fn a_mesh_with_more_instances_than_were_said_draws_as_many_as_were() {
    let Some(mut stage) = Stage::new(&settings("shadow-range=0.5..150"), DVec3::ZERO) else { return };
    stage.culling = InstanceCulling::new(&stage.gpu.device, SPLITS, &meshes(40).0).expect("culling");
    stage.culling.bind(&stage.drawer.boxes).expect("boxes");
    let view = stage.town.view(0.3);
    let plan = stage.plan(&view, None);
    let (listed, culled) = (stage.by_plan(&plan), stage.draw(&plan, By::Gpu));
    assert!(listed.iter().any(|list| list.len() > 40), "some have more");
    for (listed, culled) in listed.iter().zip(&culled.lists) {
        assert!(culled.len() <= 40 && culled.len() >= listed.len().min(40), "{} of {}", culled.len(), listed.len());
    }
}

#[test]
fn bad_input_is_named() {
    let Some(mut stage) = Stage::new(&settings("shadow-range=0.5..150"), DVec3::ZERO) else { return };
    let device = stage.gpu.device.clone();
    let new = |splits, meshes: &[CullMesh]| InstanceCulling::new(&device, splits, meshes).expect_err("bad input");
    let field = |error: Error| match error {
        Error::Culling { field, .. } => field,
        other => panic!("{other}"),
    };
    let good = CullMesh { indices: 0..36, base_vertex: 0, instances: 10 };
    assert_eq!(field(new(0, std::slice::from_ref(&good))), "splits");
    assert_eq!(field(new(3, &[])), "meshes");
    #[expect(clippy::reversed_empty_ranges, reason = "it is what is refused")]
    let reversed = CullMesh { indices: 36..0, ..good.clone() };
    assert_eq!(field(new(3, &[reversed])), "meshes");
    assert_eq!(field(new(3, &[CullMesh { instances: 0, ..good.clone() }])), "meshes");
    assert_eq!(field(new(8, &[CullMesh { instances: u32::MAX / 4, ..good }])), "meshes");

    let view = stage.town.view(0.0);
    stage.plan(&view, None);
    let (gpu, frame, count) = (&stage.gpu, stage.shadows.frame(), stage.town.boxes.len() as u32);
    let mut refused =
        |inputs: &CullInputs| field(stage.culling.prepare(&gpu.queue, &frame, inputs).expect_err("bad input"));
    assert_eq!(refused(&CullInputs { instances: count + 1, origin: DVec3::ZERO }), "instances");
    assert_eq!(refused(&CullInputs { instances: 1, origin: DVec3::NAN }), "origin");
    let small = gpu.buffer_with(&[0; 16], wgpu::BufferUsages::STORAGE);
    assert_eq!(field(stage.culling.bind(&small).expect_err("too small")), "boxes");
    let other = gpu.buffer_with(&[0; 64], wgpu::BufferUsages::VERTEX);
    assert_eq!(field(stage.culling.bind(&other).expect_err("no storage")), "boxes");
    stage.culling.prepare(&gpu.queue, &frame, &CullInputs { instances: 9, origin: DVec3::ZERO }).expect("good input");
    assert_eq!(field(stage.culling.cull_on_cpu(&gpu.queue, &stage.town.boxes[..8]).expect_err("too few")), "boxes");

    for text in ["generation=layered", "cache=kept"] {
        let mut shadows = Shadows::new(&gpu.device, &settings(text)).expect("a config");
        let lights = sun();
        let tiles = stage.town.tiles();
        let mut set = umbrage::CasterSet::new();
        set.insert_all(tiles.iter().map(|&tile| umbrage::Caster::new(tile, 0))).expect("boxes");
        let inputs = Inputs { set: Some(&set), ..Inputs::new(&view, &lights) };
        let frame = shadows.prepare(&gpu.queue, &inputs).expect("a frame");
        let error = stage.culling.prepare(&gpu.queue, &frame, &CullInputs::default()).expect_err("no such plan");
        assert!(matches!(error, Error::CullingPlan { .. }), "{text}: {error}");
    }
}
