//! From an empty wgpu program to good shadows: boxes on a plain, in the app's own vertex format, written as a picture.
//! The lines marked ◐ are all that shadows add. `cargo run -p umbrage-wgpu --example empty_app -- picture.png`
use glam::{DVec3, Vec3};
use umbrage::{Aabb, DirectionalLight, Frustum, Planner, View};
use umbrage_wgpu::{FrameOptions, LightKind, ShadowConfig, ShadowMaps, optional_features};
use wgpu::util::{BufferInitDescriptor, DeviceExt};

const SIZE: u32 = 768;
const COLOUR: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8UnormSrgb;
const SKY: wgpu::Color = wgpu::Color { r: 0.3, g: 0.45, b: 0.7, a: 1.0 };
const SHADER: &str = "
struct Varying { @builtin(position) clip: vec4f, @location(0) position: vec3f, @location(1) normal: vec3f }
@vertex fn vertex(@location(0) position: vec3f, @location(1) normal: vec3f) -> Varying {
    return Varying(clip_from_world * vec4f(position, 1.0), position, normal);
}
@fragment fn fragment(in: Varying) -> @location(0) vec4f {
    let sun = max(dot(in.normal, normalize(vec3f(0.6, 0.5, 0.3))), 0.0);
    let light = sun * umbrage_visibility(in.position, in.normal); // ◐ the one call
    return vec4f(vec3f(0.10, 0.13, 0.2) + light * vec3f(0.8, 0.72, 0.6), 1.0);
}";
const CASTER: &str = "@vertex fn vertex(@location(0) position: vec3f, instance: UmbrageInstance) -> UmbrageCast {
    return umbrage_cast(position, instance); // ◐ all that a caster's shader does
}";

/// Appends a box of 36 vertices, a position and a normal each, and returns its bounds.
fn cuboid(vertices: &mut Vec<[Vec3; 2]>, min: DVec3, size: DVec3) -> Aabb {
    for (axis, side) in (0..3).flat_map(|axis| [(axis, 0.0), (axis, 1.0)]) {
        for (b, c) in [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 0.0), (1.0, 1.0), (0.0, 1.0)] {
            let (mut corner, mut normal) = ([0.0; 3], [0.0; 3]);
            (corner[axis], corner[(axis + 1) % 3], corner[(axis + 2) % 3]) = (side, b, c);
            normal[axis] = 2.0 * side as f32 - 1.0;
            vertices.push([(min + DVec3::from(corner) * size).as_vec3(), Vec3::from(normal)]);
        }
    }
    Aabb::new(min, min + size)
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle_from_env());
    let adapter = pollster::block_on(instance.request_adapter(&Default::default()))?;
    let required_features = adapter.features() & optional_features(); // ◐
    let request = wgpu::DeviceDescriptor { required_features, ..Default::default() };
    let (device, queue) = pollster::block_on(adapter.request_device(&request))?;

    // The app's world, camera and picture.
    let mut vertices = Vec::new();
    let mut bounds = vec![cuboid(&mut vertices, DVec3::new(-400.0, -1.0, -400.0), DVec3::new(800.0, 1.0, 800.0))];
    for (i, k) in (-8..8).flat_map(|i| (-20..2).map(move |k| (f64::from(i), f64::from(k)))) {
        let at = DVec3::new(9.0 * i + 3.0 * (k * 1.7).sin(), 0.0, 11.0 * k + 3.0 * (i * 2.3).sin());
        let size = DVec3::new(1.5 + (i + k).cos().abs(), 1.0 + 5.0 * (i * 3.1 + k).sin().powi(2), 2.0);
        bounds.push(cuboid(&mut vertices, at, size));
    }
    let (contents, usage) = (bytemuck::cast_slice(vertices.as_flattened()), wgpu::BufferUsages::VERTEX);
    let vertex_buffer = device.create_buffer_init(&BufferInitDescriptor { label: None, contents, usage });
    let frustum = Frustum::perspective(60f64.to_radians(), 1.0, 0.1, 500.0)?;
    let view = View::look_at(DVec3::new(6.0, 7.0, 24.0), DVec3::new(0.0, 0.0, -10.0), DVec3::Y, frustum)?;
    let matrix = view.clip_from_relative(DVec3::ZERO).as_mat4().to_cols_array().map(|m| format!("{m:?}")).join(",");
    let camera = format!("const clip_from_world = mat4x4f({matrix});");
    let mut target = wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d { width: SIZE, height: SIZE, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: COLOUR,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
        view_formats: &[],
    };
    let colour = device.create_texture(&target);
    target.format = wgpu::TextureFormat::Depth32Float;
    let depth = device.create_texture(&target);

    // A pipeline for the vertices above; without a colour format it has no fragment shader.
    let pipeline = |source: String, group, primitive, depth, colour: Option<wgpu::TextureFormat>, views| {
        let source = wgpu::ShaderSource::Wgsl(source.into());
        let module = &device.create_shader_module(wgpu::ShaderModuleDescriptor { label: None, source });
        let layout = wgpu::PipelineLayoutDescriptor { bind_group_layouts: &[Some(group)], ..Default::default() };
        let attributes = &wgpu::vertex_attr_array![0 => Float32x3, 1 => Float32x3];
        let buffer = [Some(wgpu::VertexBufferLayout { array_stride: 24, step_mode: Default::default(), attributes })];
        let targets = [colour.map(Into::into)];
        let (entry_point, compilation_options) = (None, wgpu::PipelineCompilationOptions::default());
        let options = compilation_options.clone();
        let fragment = wgpu::FragmentState { module, entry_point, compilation_options, targets: &targets };
        device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: None,
            layout: Some(&device.create_pipeline_layout(&layout)),
            vertex: wgpu::VertexState { module, entry_point, compilation_options: options, buffers: &buffer },
            primitive,
            depth_stencil: Some(depth),
            multisample: Default::default(),
            fragment: colour.map(|_| fragment),
            multiview_mask: views,
            cache: None,
        })
    };

    // ◐ Maps, a planner that knows them, and the casters' pipeline.
    let config = ShadowConfig::default();
    let mut maps = ShadowMaps::new(&device, &config, &[LightKind::Directional])?;
    let mut planner = Planner::new(config.planner_settings(maps.depth_clamp(), [SIZE, SIZE]))?;
    let (layout, primitive, depth_state) = (maps.caster_layout(), maps.caster_primitive(), maps.caster_depth_stencil());
    let (source, views) = (maps.caster_wgsl(0) + CASTER, maps.caster_multiview_mask());
    let casters = pipeline(source, layout, primitive, depth_state.clone(), None, views);

    // The app's pipeline, with the shadows' text before its own and their layout in group 0.
    let depth_state = wgpu::DepthStencilState { depth_compare: Some(wgpu::CompareFunction::Greater), ..depth_state };
    let source = maps.receiver_wgsl(0) + &camera + SHADER;
    let boxes = pipeline(source, maps.receiver_layout(), Default::default(), depth_state, Some(COLOUR), None);

    // ◐ A frame: plan, prepare, draw each split's casters.
    let sun = DirectionalLight::new(-DVec3::new(0.6, 0.5, 0.3))?;
    let plan = planner.plan(&view, &sun, &bounds, &bounds)?;
    maps.prepare(&queue, plan, &FrameOptions::default())?;
    let mut encoder = device.create_command_encoder(&Default::default());
    for (index, maps_of) in maps.passes().iter().enumerate() {
        let mut pass = maps.begin_pass(&mut encoder, index, None);
        pass.set_pipeline(&casters);
        pass.set_bind_group(0, maps.caster_bind_group(index), &[]);
        pass.set_vertex_buffer(0, vertex_buffer.slice(..));
        maps_of.casters(plan).for_each(|(caster, instances)| pass.draw(36 * caster..36 * (caster + 1), instances));
    }

    // The app's own pass, with the maps bound.
    let ops = wgpu::Operations { load: wgpu::LoadOp::Clear(SKY), store: wgpu::StoreOp::Store };
    let view = &colour.create_view(&Default::default());
    let colour_target = wgpu::RenderPassColorAttachment { view, depth_slice: None, resolve_target: None, ops };
    let (view, depth_ops) = (&depth.create_view(&Default::default()), Some(wgpu::Operations::default()));
    let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        color_attachments: &[Some(colour_target)],
        depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment { view, depth_ops, stencil_ops: None }),
        ..Default::default()
    });
    pass.set_pipeline(&boxes);
    pass.set_bind_group(0, maps.receiver_bind_group(), &[]); // ◐
    pass.set_vertex_buffer(0, vertex_buffer.slice(..));
    pass.draw(0..vertices.len() as u32, 0..1);
    drop(pass);

    // The picture, read back and written.
    let (size, usage) = (u64::from(4 * SIZE * SIZE), wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ);
    let back = device.create_buffer(&wgpu::BufferDescriptor { label: None, size, usage, mapped_at_creation: false });
    let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(4 * SIZE), rows_per_image: None };
    let to = wgpu::TexelCopyBufferInfo { buffer: &back, layout };
    encoder.copy_texture_to_buffer(colour.as_image_copy(), to, colour.size());
    queue.submit([encoder.finish()]);
    back.map_async(wgpu::MapMode::Read, .., |result| result.expect("a buffer that maps"));
    device.poll(wgpu::PollType::wait_indefinitely())?;
    let path = std::env::args().nth(1).unwrap_or_else(|| "empty_app.png".to_owned());
    image::save_buffer(path, &back.get_mapped_range(..)?, SIZE, SIZE, image::ColorType::Rgba8)?;
    Ok(())
}
