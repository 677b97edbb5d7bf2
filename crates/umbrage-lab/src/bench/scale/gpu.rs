//! Culling on the GPU at one number of objects. The plan is made from the ground's tiles; no list
//! of casters holds the instances.

use std::time::Instant;

use glam::DVec3;
use umbrage::config::Cache;
use umbrage::{Aabb, View};
use umbrage_render::Gpu;
use umbrage_scene::{Pose, Scene};
use umbrage_wgpu::{CullBox, CullDraw, CullInputs, CullMesh, Inputs, InstanceCulling, Shadows, wgpu};

use super::job::{STEP_M, ScaleJob, WARM_UP, ahead};
use super::report::GpuReport;
use crate::{
    bench::summary::Summary,
    failure::{Failure, Result},
    scene_setup::SceneSetup,
};

/// Edge in metres of the tiles that are given to the planner.
const TILE_M: f64 = 250.0;

/// Culls the objects of a setup for its first view, once per measured round.
pub fn measure(gpu: &Gpu, setup: &SceneSetup, job: &ScaleJob) -> Result<Option<GpuReport>> {
    let mut config = job.technique.shadows.for_lights(&setup.lights)?.config;
    config.cache = Cache::Off;
    let (pose, shot) = (&setup.pose, &setup.shots[0]);
    let mut shadows = Shadows::new(&gpu.device, &config).map_err(|error| Failure::other(error.to_string()))?;
    let origin = shot.view.eye().round();
    let (boxes, meshes) = (boxes(pose, origin), meshes(&setup.scene, pose));
    let splits = shadows.maps().splits();
    let refused = |error: umbrage_wgpu::Error| Failure::other(format!("culling on the GPU: {error}"));
    let mut culling = InstanceCulling::new(&gpu.device, splits, &meshes).map_err(refused)?;
    if !culling.can_compute() {
        return Ok(None);
    }
    let buffer = gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("bench: boxes"),
        size: size_of_val(boxes.as_slice()) as u64,
        usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    gpu.queue.write_buffer(&buffer, 0, bytemuck::cast_slice(&boxes));
    culling.bind(&buffer).map_err(refused)?;
    let tiles = tiles(pose);
    let (mut plan_us, mut cull_ms) = (Vec::new(), Vec::new());
    for round in 0..WARM_UP + job.rounds {
        let view = step(&shot.view, f64::from(round));
        let lights = [shot.shown_light()];
        let inputs =
            Inputs { casters: &tiles, receivers: &tiles, origin, image_size: job.size, ..Inputs::new(&view, &lights) };
        let begun = Instant::now();
        let frame = shadows.prepare(&gpu.queue, &inputs).map_err(refused)?;
        let inputs = CullInputs { instances: boxes.len() as u32, origin };
        culling.prepare(&gpu.queue, &frame, &inputs).map_err(refused)?;
        let planned = begun.elapsed();
        let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        culling.cull(&mut encoder).map_err(refused)?;
        // Uploads of the frame are no part of what the pass takes.
        gpu.queue.submit([]);
        wait(gpu)?;
        let begun = Instant::now();
        gpu.queue.submit([encoder.finish()]);
        wait(gpu)?;
        if round >= WARM_UP {
            plan_us.push(1e6 * planned.as_secs_f64());
            cull_ms.push(1e3 * begun.elapsed().as_secs_f64());
        }
    }
    let draws = arguments(gpu, culling.arguments())?;
    Ok(Some(GpuReport {
        plan_us: Summary::of(&plan_us),
        cull_ms: Summary::of(&cull_ms),
        pairs: draws.iter().map(|draw| u64::from(draw.instance_count)).sum(),
        triangles: draws.iter().map(|draw| u64::from(draw.instance_count) * u64::from(draw.index_count / 3)).sum(),
        bytes: culling.bytes() + buffer.size(),
    }))
}

/// Moves a view on by some steps of a walk.
fn step(view: &View, steps: f64) -> View {
    ahead(view, STEP_M * steps)
}

/// Returns the objects' boxes relative to an origin.
fn boxes(pose: &Pose, origin: DVec3) -> Vec<CullBox> {
    let own = |object: &umbrage_scene::Object| CullBox {
        center: (object.bounds.center() - origin).as_vec3().to_array(),
        mesh: object.mesh as u32,
        half: object.bounds.half_extent().as_vec3().to_array(),
        skip: u32::from(!object.casts),
    };
    pose.objects.iter().map(own).collect()
}

/// Returns each mesh with the number of objects that show it.
fn meshes(scene: &Scene, pose: &Pose) -> Vec<CullMesh> {
    let mesh = |mesh: &umbrage_scene::Mesh| CullMesh { indices: 0..3 * mesh.triangles() as u32, ..CullMesh::default() };
    let mut meshes: Vec<CullMesh> = scene.meshes.iter().map(mesh).collect();
    pose.objects.iter().for_each(|object| meshes[object.mesh].instances += 1);
    meshes
}

/// Returns boxes around the objects in each square of the ground, as an application knows them of a
/// level that it streams.
fn tiles(pose: &Pose) -> Vec<Aabb> {
    let mut tiles = std::collections::BTreeMap::new();
    for bounds in pose.objects.iter().map(|object| object.bounds) {
        let at = (bounds.center() / TILE_M).floor();
        let tile = tiles.entry((at.x as i64, at.z as i64)).or_insert(bounds);
        *tile = tile.union(bounds);
    }
    tiles.into_values().collect()
}

/// Waits for all submitted commands.
fn wait(gpu: &Gpu) -> Result<()> {
    gpu.device.poll(wgpu::PollType::wait_indefinitely()).map(|_| ()).map_err(|error| Failure::other(error.to_string()))
}

/// Reads back the arguments of all draws.
fn arguments(gpu: &Gpu, buffer: &wgpu::Buffer) -> Result<Vec<CullDraw>> {
    let back = gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("bench: arguments"),
        size: buffer.size(),
        usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    encoder.copy_buffer_to_buffer(buffer, 0, &back, 0, buffer.size());
    gpu.queue.submit([encoder.finish()]);
    back.map_async(wgpu::MapMode::Read, .., |_| ());
    wait(gpu)?;
    let bytes = back.get_mapped_range(..).map_err(|error| Failure::other(error.to_string()))?;
    Ok(bytemuck::pod_collect_to_vec(&bytes))
}
