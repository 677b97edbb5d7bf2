//! What is measured is what an adopter gets: an application of its own around
//! `umbrage_wgpu::Shadows` draws the masks that the renderer draws, pixel for pixel.

mod common;

use common::{SIZE, Stage, config, configured, cuboid, gpu, ground, look, scene, sphere, sun};
use glam::{DVec3, Mat4, Vec3};
use umbrage::config::{
    DepthFormat, ExtentSteps, Filter, Layout, MomentKind, Moments, Preset, Range, SUN_DEGREES, Selection, ShadowConfig,
    Stability,
};
use umbrage::{Aabb, Light, View};
use umbrage_render::{Gpu, RenderSettings};
use umbrage_scene::{Pose, Scene};
use umbrage_shaders::layout::RUN_TRIANGLES;
use umbrage_wgpu::{CasterPipeline, Inputs, Shadows, StoredSlot, stored_runs, stored_runs_layout, stored_runs_wgsl};
use wgpu::util::{BufferInitDescriptor, DeviceExt};

const SHADER: &str = "
struct Camera { clip_from_eye: mat4x4f, eye: vec3f }
@group(0) @binding(0) var<uniform> camera: Camera;

struct Surface {
    @builtin(position) clip: vec4f,
    @location(0) position: vec3f,
    @location(1) from_eye: vec3f,
}

@vertex fn vertex(@location(0) position: vec3f) -> Surface {
    let from_eye = position - camera.eye;
    return Surface(camera.clip_from_eye * vec4f(from_eye, 1.0), position, from_eye);
}

@fragment fn fragment(in: Surface) -> @location(0) vec2f {
    let across = cross(dpdx(in.from_eye), dpdy(in.from_eye));
    let turned = select(across, -across, dot(across, in.from_eye) > 0.0);
    let normal = normalize(turned / max(max(abs(turned.x), abs(turned.y)), abs(turned.z)));
    let query = umbrage_fragment_query(in.position, normal, dpdx(in.from_eye), dpdy(in.from_eye), in.clip.xy);
    return vec2f(umbrage_shadow(query).visibility, 1.0);
}";

/// A small application: vertices of its own, positions alone.
struct App<'a> {
    gpu: &'a Gpu,
    shadows: Shadows,
    casters: wgpu::RenderPipeline,
    surfaces: wgpu::RenderPipeline,
    camera: wgpu::Buffer,
    camera_group: wgpu::BindGroup,
    vertices: wgpu::Buffer,
    /// Where each object's vertices begin, and where the last one's end.
    begins: Vec<u32>,
    bounds: Vec<Aabb>,
    /// For exact edges.
    named: Option<Named>,
}

/// What exact edges ask of an application: which run of triangles a texel shows, and where its
/// corners are.
struct Named {
    /// The id of each vertex's run. Vertices belong to one triangle each.
    ids: wgpu::Buffer,
    layout: wgpu::BindGroupLayout,
    group: wgpu::BindGroup,
}

const NAMED_CASTER: &str = "
@vertex fn vertex(@location(0) position: vec3f, @location(1) id: u32, instance: UmbrageInstance) -> UmbrageCast {
    return umbrage_named(umbrage_cast(position, instance), id);
}";

impl Named {
    /// Triangles whose corners are the positions in their order.
    fn new(device: &wgpu::Device, shadows: &mut Shadows, positions: &[[f32; 3]], begins: &[u32]) -> Self {
        let indices: Vec<u32> = (0..positions.len() as u32).collect();
        let (mut ids, mut runs, mut slots) = (Vec::new(), Vec::new(), Vec::new());
        for range in begins.windows(2).map(|pair| pair[0]..pair[1]) {
            let own = &indices[range.start as usize..range.end as usize];
            let of_object = stored_runs(positions, own, range.start);
            let occluder = shadows.occluders().insert(of_object.len() as u32).expect("there are ids");
            ids.extend((0..own.len() as u32).map(|corner| occluder.first_id() + corner / (3 * RUN_TRIANGLES)));
            for (slot, run) in occluder.runs_of_slots() {
                slots.resize(slots.len().max(slot as usize + 1), StoredSlot::default());
                let row = |axis: usize| std::array::from_fn(|i| f32::from(i == axis));
                slots[slot as usize] = StoredSlot {
                    row_x: row(0),
                    row_y: row(1),
                    row_z: row(2),
                    first_run: runs.len() as u32 + run,
                    ..StoredSlot::default()
                };
            }
            runs.extend(of_object);
        }
        let buffer =
            |contents, usage| device.create_buffer_init(&BufferInitDescriptor { label: None, contents, usage });
        let stored = |contents| buffer(contents, wgpu::BufferUsages::STORAGE);
        let buffers = [
            stored(bytemuck::cast_slice(&slots)),
            stored(bytemuck::cast_slice(&runs)),
            stored(bytemuck::cast_slice(&indices)),
            stored(bytemuck::cast_slice(positions)),
        ];
        let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: None,
            entries: &stored_runs_layout(0, wgpu::ShaderStages::FRAGMENT),
        });
        let entries =
            [0, 1, 2, 3].map(|i| wgpu::BindGroupEntry { binding: i as u32, resource: buffers[i].as_entire_binding() });
        let group =
            device.create_bind_group(&wgpu::BindGroupDescriptor { label: None, layout: &layout, entries: &entries });
        Self { ids: buffer(bytemuck::cast_slice(&ids), wgpu::BufferUsages::VERTEX), layout, group }
    }
}

impl<'a> App<'a> {
    fn new(gpu: &'a Gpu, scene: &Scene, pose: &Pose, config: &ShadowConfig) -> Self {
        let device = &gpu.device;
        let (mut positions, mut begins): (Vec<[f32; 3]>, Vec<u32>) = (Vec::new(), vec![0]);
        for object in &pose.objects {
            for primitive in &scene.meshes[object.mesh].primitives {
                positions.extend(primitive.indices.iter().map(|&index| primitive.positions[index as usize]));
            }
            begins.push(positions.len() as u32);
        }
        let mut shadows = Shadows::new(device, config).expect("valid");
        let is_exact = config.edges.is_exact();
        let named = is_exact.then(|| Named::new(device, &mut shadows, &positions, &begins));
        let id = wgpu::vertex_attr_array![1 => Uint32];
        let buffers = [CasterPipeline::default().buffers[0].clone(), Some(CasterPipeline::positions(4, &id))];
        let casters = shadows.caster_pipeline(&match named {
            Some(_) => CasterPipeline { wgsl: NAMED_CASTER, buffers: &buffers, ..CasterPipeline::default() },
            None => CasterPipeline::default(),
        });
        let casters = casters.expect("a pipeline");
        let camera = device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: 80,
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let ty = wgpu::BindingType::Buffer {
            ty: wgpu::BufferBindingType::Uniform,
            has_dynamic_offset: false,
            min_binding_size: None,
        };
        let visibility = wgpu::ShaderStages::VERTEX;
        let camera_layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: None,
            entries: &[wgpu::BindGroupLayoutEntry { binding: 0, visibility, ty, count: None }],
        });
        let camera_group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &camera_layout,
            entries: &[wgpu::BindGroupEntry { binding: 0, resource: camera.as_entire_binding() }],
        });
        let runs = if is_exact { stored_runs_wgsl(2, 0) } else { String::new() };
        let receiver = shadows.receiver_wgsl(1) + &runs;
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: None,
            source: wgpu::ShaderSource::Wgsl((receiver + SHADER).into()),
        });
        let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            bind_group_layouts: &[
                Some(&camera_layout),
                Some(shadows.bind_group_layout()),
                named.as_ref().map(|named| &named.layout),
            ],
            ..Default::default()
        });
        let surfaces = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: None,
            layout: Some(&layout),
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: None,
                compilation_options: Default::default(),
                buffers: &[Some(CasterPipeline::positions(12, &wgpu::vertex_attr_array![0 => Float32x3]))],
            },
            primitive: wgpu::PrimitiveState { cull_mode: Some(wgpu::Face::Back), ..Default::default() },
            depth_stencil: Some(wgpu::DepthStencilState {
                format: wgpu::TextureFormat::Depth32Float,
                depth_write_enabled: Some(true),
                depth_compare: Some(wgpu::CompareFunction::Greater),
                stencil: Default::default(),
                bias: Default::default(),
            }),
            multisample: Default::default(),
            fragment: Some(wgpu::FragmentState {
                module: &module,
                entry_point: None,
                compilation_options: Default::default(),
                targets: &[Some(wgpu::TextureFormat::Rg8Unorm.into())],
            }),
            multiview_mask: None,
            cache: None,
        });
        let vertices = device.create_buffer_init(&BufferInitDescriptor {
            label: None,
            contents: bytemuck::cast_slice(&positions),
            usage: wgpu::BufferUsages::VERTEX,
        });
        let bounds = pose.objects.iter().map(|object| object.bounds).collect();
        Self { gpu, shadows, casters, surfaces, camera, camera_group, vertices, begins, bounds, named }
    }

    /// Visibility and hit of each pixel.
    fn mask(&mut self, view: &View, light: Light) -> Vec<[u8; 2]> {
        let Gpu { device, queue, .. } = self.gpu;
        let lights = [light];
        let inputs =
            Inputs { casters: &self.bounds, receivers: &self.bounds, image_size: SIZE, ..Inputs::new(view, &lights) };
        let frame = self.shadows.prepare(queue, &inputs).expect("a frame");
        let mut encoder = device.create_command_encoder(&Default::default());
        for map in frame.maps() {
            let mut pass = map.begin(&mut encoder);
            pass.set_pipeline(&self.casters);
            pass.set_bind_group(0, map.bind_group(), &[]);
            pass.set_vertex_buffer(0, self.vertices.slice(..));
            if let Some(named) = &self.named {
                pass.set_vertex_buffer(1, named.ids.slice(..));
            }
            for (caster, instances) in map.casters() {
                let caster = caster as usize;
                pass.draw(self.begins[caster]..self.begins[caster + 1], instances);
            }
        }
        self.shadows.prefilter(&mut encoder);

        let clip_from_eye: Mat4 = view.clip_from_relative(view.eye()).as_mat4();
        let eye: Vec3 = view.eye().as_vec3();
        queue.write_buffer(&self.camera, 0, bytemuck::bytes_of(&clip_from_eye));
        queue.write_buffer(&self.camera, 64, bytemuck::bytes_of(&eye));
        let [width, height] = SIZE;
        let target = |format, usage| {
            device.create_texture(&wgpu::TextureDescriptor {
                label: None,
                size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage: usage | wgpu::TextureUsages::RENDER_ATTACHMENT,
                view_formats: &[],
            })
        };
        let mask = target(wgpu::TextureFormat::Rg8Unorm, wgpu::TextureUsages::COPY_SRC);
        let depth = target(wgpu::TextureFormat::Depth32Float, wgpu::TextureUsages::empty());
        {
            let ops =
                wgpu::Operations { load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT), store: wgpu::StoreOp::Store };
            let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                    view: &mask.create_view(&Default::default()),
                    depth_slice: None,
                    resolve_target: None,
                    ops,
                })],
                depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                    view: &depth.create_view(&Default::default()),
                    depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(0.0), store: wgpu::StoreOp::Discard }),
                    stencil_ops: None,
                }),
                ..Default::default()
            });
            pass.set_pipeline(&self.surfaces);
            pass.set_bind_group(0, &self.camera_group, &[]);
            pass.set_bind_group(1, self.shadows.bind_group(), &[]);
            if let Some(named) = &self.named {
                pass.set_bind_group(2, &named.group, &[]);
            }
            pass.set_vertex_buffer(0, self.vertices.slice(..));
            pass.draw(0..self.begins[self.begins.len() - 1], 0..1);
        }
        let row = (2 * width).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
        let back = device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: u64::from(row * height),
            usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
            mapped_at_creation: false,
        });
        let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(row), rows_per_image: None };
        let to = wgpu::TexelCopyBufferInfo { buffer: &back, layout };
        encoder.copy_texture_to_buffer(mask.as_image_copy(), to, mask.size());
        queue.submit([encoder.finish()]);
        back.map_async(wgpu::MapMode::Read, .., |result| result.expect("a mappable buffer maps"));
        device.poll(wgpu::PollType::wait_indefinitely()).expect("the device answers");
        let bytes = back.get_mapped_range(..).expect("mapped above").to_vec();
        let rows = bytes.chunks(row as usize).flat_map(|row| row[..2 * width as usize].chunks(2));
        rows.map(|pixel| [pixel[0], pixel[1]]).collect()
    }
}

fn world() -> Scene {
    let boxes = (0..30).map(|i| {
        let at = DVec3::new(2.5 * f64::from(i % 6) - 7.0, 0.0, 3.0 - 4.0 * f64::from(i / 6));
        cuboid(at, at + DVec3::new(0.7, 1.2, 0.7))
    });
    scene(boxes.chain([ground(0.0, 60.0), sphere(DVec3::new(3.0, 1.0, -9.0), 1.0)]).collect())
}

/// Pixels that both decide differently, after some frames of walking; and those that are in shadow.
fn different(gpu: &Gpu, config: &ShadowConfig, apps: &ShadowConfig) -> (usize, usize) {
    let world = world();
    let mut stage = Stage::new(gpu, &world, &configured(config.clone()));
    let mut app = App::new(gpu, &world, &stage.pose, apps);
    let light = sun(DVec3::new(0.6, -0.7, -0.4));
    let (mut different, mut dark) = (0, 0);
    for step in 0..4 {
        let aside = f64::from(step);
        let view = look(DVec3::new(-2.0 + aside, 4.0, 9.0 - 0.5 * aside), DVec3::new(1.0 - aside, 0.0, -6.0));
        let own = app.mask(&view, light.into());
        let renderers = stage.mask(&view, light);
        assert_eq!(own.len(), renderers.pixels().len());
        different += own.iter().zip(renderers.pixels()).filter(|(own, theirs)| **own != theirs.0).count();
        dark += own.iter().filter(|pixel| **pixel == [0, 255]).count();
    }
    (different, dark)
}

#[test]
fn an_adopter_gets_what_the_renderer_draws() {
    let Some(gpu) = gpu() else { return };
    let papers = ShadowConfig { map_sizes: vec![512; 3], ..Preset::Papers.config() };
    let moments = Filter::Moments(Moments::new(MomentKind::Evsm4));
    let steps = Stability::Approximate { steps: ExtentSteps::default() };
    for (what, config) in [
        ("the papers' settings", papers.clone()),
        ("16 bits, whose near planes move", ShadowConfig { depth_format: DepthFormat::D16Unorm, ..papers.clone() }),
        // What reaches less than 16 texels keeps less of a map free.
        ("pcss", ShadowConfig { filter: Filter::Pcss { sun_degrees: SUN_DEGREES, rotated: false }, ..papers.clone() }),
        ("a disc", ShadowConfig { filter: Filter::Disc { width_m: Some(0.3), rotated: false }, ..papers.clone() }),
        ("moments", ShadowConfig { filter: moments, ..papers.clone() }),
        ("all maps at once", ShadowConfig { layout: Layout::LayeredArray, ..papers.clone() }),
        ("an atlas", ShadowConfig { layout: Layout::Atlas, ..papers.clone() }),
        (
            "tight maps of what is visible",
            ShadowConfig {
                stability: Stability::tight(),
                range: Range::Visible,
                selection: Selection::Map,
                ..papers.clone()
            },
        ),
        ("nearly tight maps", ShadowConfig { stability: steps, ..papers.clone() }),
    ] {
        let (different, dark) = different(&gpu, &config, &config);
        assert!(dark > 1000, "{what}: {dark} pixels are in shadow");
        assert_eq!(different, 0, "{what}: pixels differ");
    }
    // The comparison can say no: of an adopter with somewhat smaller maps.
    let smaller = ShadowConfig { map_sizes: vec![500; 3], ..papers.clone() };
    assert!(different(&gpu, &papers, &smaller).0 > 50);
}

/// What the presets choose beside the papers' settings, and exact edges as an application has them.
#[test]
fn an_adopter_gets_what_the_renderer_draws_by_every_preset() {
    let Some(gpu) = gpu() else { return };
    for preset in Preset::ALL {
        let config = preset.config();
        let (different, dark) = different(&gpu, &config, &config);
        assert!(dark > 1000, "{preset}: {dark} pixels are in shadow");
        assert_eq!(different, 0, "{preset}: pixels differ");
    }
    let [exact, sampled] = [Preset::Exact.config(), Preset::Balanced.config()];
    let sampled = ShadowConfig { map_sizes: exact.map_sizes.clone(), ..sampled };
    assert!(different(&gpu, &exact, &sampled).0 > 50, "edges are not asked for");
}

/// The defaults of both are one value.
#[test]
fn defaults_agree() {
    assert_eq!(RenderSettings::default().config, ShadowConfig::default());
    assert_eq!(config().filter, Filter::Hard);
}
