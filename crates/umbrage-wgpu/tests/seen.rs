//! What is read from a picture's depth holds all that the picture shows, and not much more.

mod common;

use common::Gpu;
use glam::{DVec3, DVec4};
use umbrage::{Aabb, Frustum, View};
use umbrage_wgpu::{Error, MaskFrame, SeenDepth, wgpu};

const SIZE: [u32; 2] = [200, 130];

fn view(eye: DVec3, ahead: DVec3) -> View {
    let frustum = Frustum::perspective(1.0, 200.0 / 130.0, 0.1, 500.0).expect("a frustum");
    View::look_at_upright(eye, eye + ahead, frustum).expect("a view")
}

fn camera(view: &View) -> MaskFrame {
    MaskFrame {
        clip_from_eye: view.clip_from_relative(view.eye()),
        eye: view.eye(),
        forward: view.forward(),
        origin: DVec3::ZERO,
        empty_depth: 0.0,
    }
}

/// A depth texture that is cleared to one depth.
fn depth(gpu: &Gpu, encoder: &mut wgpu::CommandEncoder, value: f32, samples: u32) -> wgpu::TextureView {
    let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d { width: SIZE[0], height: SIZE[1], depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: samples,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::Depth32Float,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING,
        view_formats: &[],
    });
    let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
    let depth_ops = Some(wgpu::Operations { load: wgpu::LoadOp::Clear(value), store: wgpu::StoreOp::Store });
    drop(encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
            view: &view,
            depth_ops,
            stencil_ops: None,
        }),
        ..wgpu::RenderPassDescriptor::default()
    }));
    view
}

/// What is seen of a picture of one depth.
fn seen(gpu: &Gpu, seen: &mut SeenDepth, view: &View, value: f32, samples: u32) -> Option<Vec<Aabb>> {
    gpu.checked(|| {
        let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        let depth = depth(gpu, &mut encoder, value, samples);
        seen.reduce(&gpu.queue, &mut encoder, &depth, &camera(view)).expect("it can be read");
        gpu.queue.submit([encoder.finish()]);
        seen.boxes(view).expect("a device");
        gpu.device.poll(wgpu::PollType::wait_indefinitely()).expect("it comes back");
        seen.boxes(view).expect("a device").map(<[Aabb]>::to_vec)
    })
}

/// Where the middle of a pixel lies that has this depth.
fn shown(view: &View, [x, y]: [u32; 2], value: f64) -> DVec3 {
    let ndc = [(f64::from(x) + 0.5) / 200.0 * 2.0 - 1.0, 1.0 - (f64::from(y) + 0.5) / 130.0 * 2.0];
    let at = view.clip_from_relative(view.eye()).inverse() * DVec4::new(ndc[0], ndc[1], value, 1.0);
    view.eye() + at.truncate() / at.w
}

#[test]
fn boxes_hold_every_pixel_and_little_more() {
    let Some(gpu) = Gpu::new() else { return };
    // Far from the origin, where f32 positions of the world would be off by a centimetre.
    let view = view(DVec3::new(100_000.0, 2.0, -50_000.0), DVec3::new(1.0, -0.2, 0.3));
    for (samples, metres) in [(1, 3.0), (4, 40.0)] {
        let ahead = view.eye() + view.forward() * metres;
        let clip = view.clip_from_relative(view.eye()) * (ahead - view.eye()).extend(1.0);
        let value = clip.z / clip.w;
        let mut reader = SeenDepth::new(&gpu.device, samples).expect("the device computes");
        let boxes = seen(&gpu, &mut reader, &view, value as f32, samples).expect("a picture");
        assert_eq!(boxes.len(), 32 * 24);
        for x in 0..SIZE[0] {
            for y in 0..SIZE[1] {
                let point = shown(&view, [x, y], f64::from(value as f32));
                let holds = |bounds: &&Aabb| point.clamp(bounds.min, bounds.max).distance(point) < 1e-6 * metres;
                assert!(boxes.iter().any(|bounds| holds(&bounds)), "pixel {x}, {y} at {point}");
            }
        }
        // A tile, and a pixel of each neighbour: at most 9 of 200 pixels, and 8 of 130.
        let pixel = shown(&view, [100, 65], value).distance(shown(&view, [101, 65], value));
        let longest = boxes.iter().map(|bounds| bounds.half_extent().length() * 2.0).fold(0.0, f64::max);
        assert!(longest < 14.0 * pixel, "{longest} m with pixels of {pixel} m");
    }
}

#[test]
fn an_empty_picture_and_another_place_show_nothing() {
    let Some(gpu) = Gpu::new() else { return };
    let here = view(DVec3::new(0.0, 2.0, 0.0), DVec3::NEG_Z);
    let mut reader = SeenDepth::new(&gpu.device, 1).expect("the device computes");
    assert_eq!(reader.boxes(&here).expect("a device"), None);
    assert_eq!(seen(&gpu, &mut reader, &here, 0.0, 1), None);
    assert!(seen(&gpu, &mut reader, &here, 0.01, 1).is_some());
    let walked = view(DVec3::new(0.0, 2.0, -0.1), DVec3::new(0.05, 0.0, -1.0));
    assert!(reader.boxes(&walked).expect("a device").is_some());
    for cut in [view(DVec3::new(0.0, 2.0, -90.0), DVec3::NEG_Z), view(here.eye(), DVec3::X)] {
        assert_eq!(reader.boxes(&cut).expect("a device"), None);
    }
    reader.forget();
    assert_eq!(reader.boxes(&here).expect("a device"), None);
}

#[test]
fn pictures_that_are_not_fetched_are_passed_over() {
    let Some(gpu) = Gpu::new() else { return };
    let here = view(DVec3::new(0.0, 2.0, 0.0), DVec3::NEG_Z);
    let mut reader = SeenDepth::new(&gpu.device, 1).expect("the device computes");
    for _ in 0..8 {
        let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        let depth = depth(&gpu, &mut encoder, 0.01, 1);
        reader.reduce(&gpu.queue, &mut encoder, &depth, &camera(&here)).expect("it can be read");
        gpu.queue.submit([encoder.finish()]);
    }
    reader.boxes(&here).expect("a device");
    gpu.device.poll(wgpu::PollType::wait_indefinitely()).expect("it comes back");
    assert!(reader.boxes(&here).expect("a device").is_some());
    assert!(seen(&gpu, &mut reader, &here, 0.02, 1).is_some(), "what came back is free again");
}

#[test]
fn depth_that_cannot_be_read_is_refused() {
    let Some(gpu) = Gpu::new() else { return };
    let here = view(DVec3::new(0.0, 2.0, 0.0), DVec3::NEG_Z);
    let mut reader = SeenDepth::new(&gpu.device, 1).expect("the device computes");
    let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    let good = depth(&gpu, &mut encoder, 0.5, 1);
    let samples = depth(&gpu, &mut encoder, 0.5, 4);
    let texture = |format, usage| {
        let size = wgpu::Extent3d { width: 8, height: 8, depth_or_array_layers: 1 };
        let dimension = wgpu::TextureDimension::D2;
        let descriptor = wgpu::TextureDescriptor {
            label: None,
            size,
            mip_level_count: 1,
            sample_count: 1,
            dimension,
            format,
            usage,
            view_formats: &[],
        };
        gpu.device.create_texture(&descriptor).create_view(&wgpu::TextureViewDescriptor::default())
    };
    let color = texture(wgpu::TextureFormat::R8Unorm, wgpu::TextureUsages::TEXTURE_BINDING);
    let unbound = texture(wgpu::TextureFormat::Depth32Float, wgpu::TextureUsages::RENDER_ATTACHMENT);
    for (view, says) in [(&samples, "4 samples"), (&color, "no depth"), (&unbound, "TEXTURE_BINDING")] {
        let error = reader.reduce(&gpu.queue, &mut encoder, view, &camera(&here)).expect_err(says);
        assert!(matches!(&error, Error::SeenDepth { reason } if reason.contains(says)), "{error}");
    }
    let flat = MaskFrame { clip_from_eye: glam::DMat4::ZERO, ..camera(&here) };
    let error = reader.reduce(&gpu.queue, &mut encoder, &good, &flat).expect_err("no inverse");
    assert!(matches!(error, Error::InvalidFrameOption { field: "clip_from_eye", .. }), "{error}");
}
