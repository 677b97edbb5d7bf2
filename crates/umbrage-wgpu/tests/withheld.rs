//! Devices with the limits that weak hardware guarantees, and without each optional feature: every
//! preset, and what the features are for, draws its shadows there, and wgpu finds nothing wrong.

mod common;

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, OnceLock};

use common::{EVSM4, Gpu, PCF3, config, cuboid};
use glam::{DVec3, Vec3};
use umbrage::config::{Fallbacks, Generation, Preset, ShadowConfig, Storage};
use umbrage::{Aabb, DirectionalLight, Frustum, Light, PointLight, SpotLight, View};
use umbrage_wgpu::{CasterPipeline, Error, Inputs, LightKind, Shadows, optional_features};

/// Edge of the picture in pixels.
const SIZE: u32 = 64;

/// A picture of the ground from above: visibility of up to three lights in red, green and blue.
type Picture = Vec<[u8; 4]>;

const PICTURE: &str = "
@vertex fn vs(@builtin(vertex_index) corner: u32) -> @builtin(position) vec4f {
    return vec4f(4.0 * f32(corner & 1u) - 1.0, 4.0 * f32(corner >> 1u) - 1.0, 0.0, 1.0);
}
@fragment fn fs(@builtin(position) at: vec4f) -> @location(0) vec4f {
    let position = vec3f(0.5 * (at.x - 32.0), 0.0, 0.5 * (at.y - 32.0));
    var query = umbrage_fragment_query(position, vec3f(0.0, 1.0, 0.0), dpdx(position), dpdy(position), at.xy);
    var lit = vec4f(1.0);
    for (var light = 0u; light < LIGHTS; light++) {
        query.light = light;
        lit[light] = umbrage_shadow(query).visibility;
    }
    return lit;
}";

/// Casters have no ids here, so nothing asks for their triangles; weak devices have no storage
/// buffers to keep them in.
const NO_RUNS: &str = "
fn umbrage_run(id: u32) -> UmbrageRun { return UmbrageRun(); }
fn umbrage_corner(run: UmbrageRun, corner: u32) -> vec3f { return vec3f(); }";

/// What is drawn: a name, a config, and lights.
struct Asked {
    name: String,
    config: ShadowConfig,
    lights: Vec<Light>,
}

fn asked() -> Vec<Asked> {
    let sun = Light::from(DirectionalLight::new(DVec3::new(0.5, -1.0, 0.3)).expect("a direction"));
    let spot = SpotLight::new(DVec3::new(3.0, 9.0, 2.0), DVec3::NEG_Y, 1.0, 30.0).expect("a spot light").into();
    let lamp = PointLight::new(DVec3::new(-4.0, 6.0, -3.0), 30.0).expect("a lamp").into();
    let mut all: Vec<Asked> = Preset::ALL
        .iter()
        .map(|preset| Asked { name: preset.to_string(), config: preset.config(), lights: vec![sun] })
        .collect();
    // Each optional feature serves one of these.
    for settings in [
        "filter=evsm4",
        "depth-format=d16",
        "depth-format=r32f",
        "generation=layered",
        "generation=instanced storage=atlas",
        "generation=mixed",
        "storage=separate",
        "storage=cube",
        "cache=kept",
    ] {
        let config = config(&[256; 4], PCF3, settings);
        all.push(Asked { name: settings.to_owned(), config, lights: vec![sun] });
    }
    let config = Preset::Balanced.config();
    all.push(Asked { name: "three lights".to_owned(), config, lights: vec![sun, spot, lamp] });
    all
}

fn boxes() -> Vec<Aabb> {
    let of = |i: u32| {
        let at = DVec3::new(f64::from(i % 5) * 6.0 - 13.0, 0.0, f64::from(i / 5) * 6.0 - 13.0);
        Aabb::new(at, at + DVec3::new(1.5, 1.0 + f64::from(i % 3), 1.5))
    };
    (0..25).map(of).collect()
}

/// Draws casters into all maps and a picture of the ground.
fn drawn(gpu: &Gpu, asked: &Asked) -> Result<Picture, Error> {
    let kinds: Vec<LightKind> = asked.lights.iter().map(|&light| LightKind::from(light)).collect();
    let mut shadows = Shadows::with_lights(&gpu.device, &asked.config, &kinds)?;
    let casters = shadows.caster_pipeline(&CasterPipeline::default())?;
    let text = shadows.receiver_wgsl(0)
        + &PICTURE.replace("LIGHTS", &format!("{}u", kinds.len()))
        + if shadows.maps().edges().is_exact() { NO_RUNS } else { "" };
    let format = wgpu::TextureFormat::Rgba8Unorm;
    let module = gpu.device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some("Test::picture"),
        source: wgpu::ShaderSource::Wgsl(text.into()),
    });
    let layout = gpu.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        bind_group_layouts: &[Some(shadows.bind_group_layout())],
        ..Default::default()
    });
    let picture = gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("Test::picture"),
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some("vs"),
            compilation_options: Default::default(),
            buffers: &[],
        },
        primitive: Default::default(),
        depth_stencil: None,
        multisample: Default::default(),
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: Some("fs"),
            compilation_options: Default::default(),
            targets: &[Some(format.into())],
        }),
        multiview_mask: None,
        cache: None,
    });

    let lens = Frustum::perspective(1.2, 1.0, 0.5, 100.0).expect("a lens");
    let view = View::look_at_upright(DVec3::new(0.0, 14.0, 24.0), DVec3::ZERO, lens).expect("a view");
    let boxes = boxes();
    let mut receivers = boxes.clone();
    receivers.push(Aabb::new(DVec3::new(-20.0, -0.1, -20.0), DVec3::new(20.0, 0.0, 20.0)));
    let image_size = [SIZE; 2];
    let inputs = Inputs { casters: &boxes, receivers: &receivers, image_size, ..Inputs::new(&view, &asked.lights) };
    shadows.prepare(&gpu.queue, &inputs)?;

    let corners: Vec<Vec3> = boxes.iter().flat_map(|it| cuboid(it.min.as_vec3(), it.max.as_vec3())).collect();
    let vertices = gpu.buffer_with(bytemuck::cast_slice(&corners), wgpu::BufferUsages::VERTEX);
    let target = gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: Some("Test::target"),
        size: wgpu::Extent3d { width: SIZE, height: SIZE, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
        view_formats: &[],
    });
    let back = gpu.buffer_with(&vec![0; (4 * SIZE * SIZE) as usize], wgpu::BufferUsages::COPY_SRC);
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    for map in shadows.frame().maps() {
        let mut pass = map.begin(&mut encoder);
        pass.set_pipeline(&casters);
        pass.set_bind_group(0, map.bind_group(), &[]);
        pass.set_vertex_buffer(0, vertices.slice(..));
        for (caster, instances) in map.casters() {
            pass.draw(36 * caster..36 * (caster + 1), instances);
        }
    }
    shadows.prefilter(&mut encoder);
    {
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("Test::picture"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &target.create_view(&Default::default()),
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations { load: wgpu::LoadOp::Clear(wgpu::Color::BLACK), store: wgpu::StoreOp::Store },
            })],
            ..Default::default()
        });
        pass.set_pipeline(&picture);
        pass.set_bind_group(0, shadows.bind_group(), &[]);
        pass.draw(0..3, 0..1);
    }
    encoder.copy_texture_to_buffer(
        target.as_image_copy(),
        wgpu::TexelCopyBufferInfo {
            buffer: &back,
            layout: wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(4 * SIZE), rows_per_image: None },
        },
        target.size(),
    );
    gpu.queue.submit([encoder.finish()]);
    Ok(gpu.copied(&back).as_chunks::<4>().0.to_vec())
}

/// Mean difference of two pictures, 0 to 1.
fn difference(a: &Picture, b: &Picture) -> f64 {
    let steps = a.as_flattened().iter().zip(b.as_flattened()).map(|(a, b)| f64::from(a.abs_diff(*b)));
    steps.sum::<f64>() / (255.0 * 4.0 * f64::from(SIZE * SIZE))
}

/// Most that a picture may differ from that of a device with everything: moments of half precision
/// and depths of 16 bits.
const MOST: f64 = 0.01;

/// The pictures of a device with everything.
fn references() -> Option<&'static [Picture]> {
    static PICTURES: OnceLock<Option<Vec<Picture>>> = OnceLock::new();
    let pictures = PICTURES.get_or_init(|| {
        let gpu = Gpu::new()?;
        let of = |asked: &Asked| {
            let picture = gpu.checked(|| drawn(&gpu, asked)).unwrap_or_else(|error| panic!("{}: {error}", asked.name));
            for light in 0..asked.lights.len() {
                let dark = picture.iter().filter(|pixel| pixel[light] < 64).count();
                let bright = picture.iter().filter(|pixel| pixel[light] > 192).count();
                assert!(dark > 40 && bright > 400, "{}: {dark} dark and {bright} bright pixels", asked.name);
            }
            picture
        };
        Some(asked().iter().map(of).collect())
    });
    pictures.as_deref()
}

/// Draws everything on a device. Requests that are refused are returned with the error.
fn refused(device: &str, gpu: &Gpu) -> Vec<(String, Error)> {
    let complaints = Arc::new(AtomicUsize::new(0));
    let counted = complaints.clone();
    gpu.device.on_uncaptured_error(Arc::new(move |error| {
        eprintln!("{error}");
        counted.fetch_add(1, Ordering::Relaxed);
    }));
    let mut refused = Vec::new();
    for (asked, expected) in asked().into_iter().zip(references().into_iter().flatten()) {
        match gpu.checked(|| drawn(gpu, &asked)) {
            Ok(picture) => {
                let found = difference(&picture, expected);
                assert!(found <= MOST, "{device}, {}: {found:.4}", asked.name);
            }
            Err(error) => {
                assert!(!matches!(error, Error::Device { .. } | Error::Config(_)), "{device}, {}: {error}", asked.name);
                refused.push((asked.name, error));
            }
        }
    }
    assert_eq!(complaints.load(Ordering::Relaxed), 0, "{device}: wgpu found errors");
    refused
}

#[test]
fn each_feature_may_be_missing() {
    let each = optional_features().iter().map(|feature| (format!("without {feature:?}"), feature));
    for (name, withheld) in each.chain([("without all".to_owned(), optional_features())]) {
        let Some(gpu) = Gpu::without(withheld) else { return };
        assert!(!gpu.device.features().intersects(withheld));
        let refused = refused(&name, &gpu);
        assert!(refused.is_empty(), "{name}: {refused:?}");
    }
}

fn weak() -> [(&'static str, wgpu::Limits); 3] {
    [
        ("default limits", wgpu::Limits::default()),
        ("downlevel limits", wgpu::Limits::downlevel_defaults()),
        ("WebGL2's limits", wgpu::Limits::downlevel_webgl2_defaults()),
    ]
}

#[test]
fn limits_may_be_those_of_weak_devices() {
    for (name, limits) in weak() {
        for withheld in [wgpu::Features::empty(), optional_features()] {
            let Some(gpu) = Gpu::limited(withheld, Some(limits.clone())) else { return };
            assert_eq!(gpu.device.limits().max_texture_dimension_2d, limits.max_texture_dimension_2d);
            let refused = refused(name, &gpu);
            assert!(refused.is_empty(), "{name}: {refused:?}");
        }
    }
}

/// Without fallbacks the error names what is missing.
#[test]
fn without_fallbacks_what_is_missing_is_named() {
    let Some(gpu) = Gpu::without(optional_features()) else { return };
    for (settings, layout) in [
        ("generation=layered", Some((Generation::Layered, Storage::Array))),
        ("generation=instanced storage=atlas", Some((Generation::Instanced, Storage::Atlas))),
        ("generation=mixed", Some((Generation::Mixed, Storage::Array))),
    ] {
        let strict = ShadowConfig { fallbacks: Fallbacks::Forbid, ..config(&[64; 2], PCF3, settings) };
        assert_eq!(Some((strict.layout.generation(), strict.layout.storage())), layout);
        let error = gpu.checked(|| Shadows::new(&gpu.device, &strict)).expect_err(settings);
        assert!(matches!(error, Error::MissingFeature { .. }), "{settings}: {error}");
    }
    let strict = ShadowConfig { fallbacks: Fallbacks::Forbid, ..config(&[64; 2], EVSM4, "") };
    let error = gpu.checked(|| Shadows::new(&gpu.device, &strict)).expect_err("moments");
    assert!(matches!(error, Error::NoFilterableFloats { .. }), "{error}");
    let limits = wgpu::Limits::downlevel_webgl2_defaults();
    let Some(gpu) = Gpu::limited(wgpu::Features::empty(), Some(limits.clone())) else { return };
    let large = limits.max_texture_dimension_2d + 1;
    let error = gpu.checked(|| Shadows::new(&gpu.device, &config(&[large], PCF3, ""))).expect_err("a large map");
    assert_eq!(error, Error::MapTooLarge { split: 0, size: large, limit: limits.max_texture_dimension_2d });
}

/// The check must be able to say no: a device's limits are in force, and wgpu's errors are seen.
#[test]
#[should_panic(expected = "Dimension X")]
fn errors_of_wgpu_are_seen() {
    let limits = wgpu::Limits::downlevel_webgl2_defaults();
    let size = limits.max_texture_dimension_2d + 1;
    // Without an adapter there is nothing to check.
    let Some(gpu) = Gpu::limited(wgpu::Features::empty(), Some(limits)) else { panic!("Dimension X") };
    gpu.checked(|| {
        gpu.device.create_texture(&wgpu::TextureDescriptor {
            label: Some("Test::too large"),
            size: wgpu::Extent3d { width: size, height: 1, depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: wgpu::TextureFormat::Rgba8Unorm,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT,
            view_formats: &[],
        })
    });
}
