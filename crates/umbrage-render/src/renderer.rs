//! The demonstration renderer: a scene, a view and a sun in; a picture, a mask, maps and numbers out.

use glam::DVec3;
use image::{GrayAlphaImage, GrayImage, RgbaImage};
use umbrage::{Aabb, DirectionalLight, Planner, ShadowPlan, ShadowSettings, View};
use umbrage_scene::{AlphaMode, Pose, Scene};
use umbrage_wgpu::{
    DepthFormat, Filter, FrameOptions, Generation, ShadowMaps, ShadowMapsOptions, Softness, Storage, Transition,
};
use web_time::Instant;

use crate::capture::Capture;
use crate::casters::Casters;
use crate::contact::Contact;
use crate::draw_list::{Drawable, Drawn, Instances, Run};
use crate::forward::{Forward, FrameUniform, MaskTarget, PictureTarget, Samples};
use crate::geometry::{Geometry, SceneMeshes, SkinnedGeometry, check_object};
use crate::look::Look;
use crate::materials::Materials;
use crate::probe::{self, Probe, ProbeAnswer, ProbePoint, Responder};
use crate::stats::{FrameStats, SplitStats};
use crate::timing::{PassCounts, Slot, Timer};
use crate::{Error, Gpu, Result, cull, maps};

/// The frame's origin moves in steps of this many metres, so that positions near the eye are exact to a tenth of a
/// millimetre in `f32` and yet stay the same from frame to frame, which is what keeps stabilised maps still.
const ORIGIN_STEP: f64 = 1024.0;

/// What is settled before the first frame.
#[derive(Clone, Debug)]
pub struct RenderSettings {
    /// Pixels across and down.
    pub size: [u32; 2],
    /// How shadows are planned. `filter_radius`, `depth_clamp` and `image_size` are taken from the filter, the device with its
    /// depth format, and `size` instead.
    pub shadows: ShadowSettings,
    /// How maps are looked up.
    pub filter: Filter,
    /// What maps store.
    pub depth_format: DepthFormat,
    /// Samples per pixel of the picture; masks have one always.
    pub samples: Samples,
    /// How soft edges are.
    pub softness: Softness,
    /// How splits meet.
    pub transition: Transition,
    /// How shadows look.
    pub look: Look,
    /// Where maps are kept.
    pub storage: Storage,
    /// How maps are drawn.
    pub generation: Generation,
}

/// What varies from frame to frame.
#[derive(Clone, Copy, Debug)]
pub struct Frame<'a> {
    /// The scene at this moment; a pose of the scene that the renderer was made with.
    pub pose: &'a Pose,
    /// The eye.
    pub view: &'a View,
    /// The light.
    pub sun: DirectionalLight,
    /// Whether anything throws shadows; if not, whatever faces the light is lit.
    pub shadows_on: bool,
    /// Whether the picture shows each split in its own colour.
    pub tint: bool,
}

/// What is wanted of a frame.
#[derive(Clone, Copy, Debug, Default)]
pub struct Outputs {
    /// The shaded picture.
    pub picture: bool,
    /// The visibility mask.
    pub mask: bool,
    /// Each split's depth map.
    pub maps: bool,
}

/// What came out of a frame.
#[derive(Clone, Debug)]
pub struct Rendered {
    /// sRGB, opaque.
    pub picture: Option<RgbaImage>,
    /// Grey: visibility at the pixel's centre, 255 lit to 0 in shadow or turned away. Alpha: 255 where a surface is.
    pub mask: Option<GrayAlphaImage>,
    /// Each split's depths, stretched: black is nearest to the light, white is empty.
    pub maps: Vec<GrayImage>,
    /// Numbers.
    pub stats: FrameStats,
}

/// Draws one scene at one size. Everything that does not change from frame to frame is on the GPU already.
pub struct Renderer {
    gpu: Gpu,
    size: [u32; 2],
    depth_format: DepthFormat,
    samples: Samples,
    softness: Softness,
    transition: Transition,
    look: Look,
    planner: Planner,
    maps: ShadowMaps,
    scene: Geometry,
    scene_meshes: SceneMeshes,
    skinned: SkinnedGeometry,
    materials: Materials,
    instances: Instances,
    casters: Casters,
    forward: Forward,
    contact: Option<Contact>,
    probe: Probe,
    timer: Timer,
    picture: Option<PictureTarget>,
    mask: Option<MaskTarget>,
    notes: Vec<String>,
}

/// A frame that is planned and uploaded, ready to be recorded.
struct Prepared {
    origin: DVec3,
    plan: ShadowPlan,
    plan_ms: f64,
    /// Per split.
    caster_runs: Vec<Vec<Run>>,
    solid: Vec<Run>,
    translucent: Vec<Run>,
    objects_in_view: usize,
}

impl Renderer {
    /// Uploads a scene and makes everything that a frame needs.
    ///
    /// # Errors
    /// [`Error::ImageSize`], [`Error::MapSize`], [`Error::TextureSize`], [`Error::BufferSize`] or [`Error::OutOfMemory`] if the
    /// device cannot hold it, [`Error::Scene`] if the scene contradicts itself, [`Error::Plan`] and [`Error::Shadows`] if the
    /// settings are wrong.
    pub fn new(gpu: &Gpu, scene: &Scene, settings: &RenderSettings) -> Result<Self> {
        let limit = gpu.max_texture_edge();
        let [width, height] = settings.size;
        if width == 0 || height == 0 || width > limit || height > limit {
            return Err(Error::ImageSize { width, height, limit });
        }
        // The planner's own checks come first: they name a setting where the maps could only name a texture.
        let mut shadows = settings.shadows.clone();
        shadows.filter_radius = settings.filter.radius_texels();
        shadows.image_size = settings.size;
        shadows.validate()?;
        settings.softness.validate()?;
        settings.look.contact.iter().try_for_each(umbrage_wgpu::ContactOptions::validate)?;
        if let Some((split, &size)) = shadows.map_sizes.iter().enumerate().find(|&(_, &size)| size > limit) {
            return Err(Error::MapSize { split, size, limit });
        }
        gpu.guarded("uploading the scene", || {
            let maps = ShadowMaps::new(
                &gpu.device,
                &ShadowMapsOptions {
                    map_sizes: shadows.map_sizes.clone(),
                    depth_format: settings.depth_format,
                    filter: settings.filter,
                    storage: settings.storage,
                    generation: settings.generation,
                    ..ShadowMapsOptions::default()
                },
            )?;
            // Floats hold the depth of a whole world; 16 bits want the shorter range that casters flattened onto the near plane
            // allow, and pay for it with maps that step along the light.
            shadows.depth_clamp = maps.depth_clamp() && settings.depth_format == DepthFormat::D16Unorm;
            let materials = Materials::new(gpu, scene)?;
            let timer = Timer::new(gpu);
            let mut notes = Vec::new();
            if settings.depth_format == DepthFormat::D16Unorm && !maps.depth_clamp() {
                notes.push(
                    "no depth clip control: near planes of 16-bit maps stand before their first caster".to_owned(),
                );
            }
            if settings.filter == Filter::Pcss && !gpu.depth_loads() {
                notes.push("no loads from depth textures on GL: pcss is a disc of fixed width".to_owned());
            }
            let contact = settings.look.contact.filter(|_| gpu.depth_loads());
            if settings.look.contact.is_some() && contact.is_none() {
                notes.push("no loads from depth textures on GL: no contact shadows".to_owned());
            }
            let contact = contact.map(|options| Contact::new(gpu, settings.size, options));
            if !timer.has_timestamps() {
                notes.push("no timestamp queries: times of the GPU are measured by the CPU's clock".to_owned());
            }
            Ok(Self {
                size: settings.size,
                depth_format: settings.depth_format,
                planner: Planner::new(shadows)?,
                scene: Geometry::of_scene(gpu, scene)?,
                scene_meshes: SceneMeshes::of_scene(scene),
                skinned: SkinnedGeometry::empty(gpu)?,
                instances: Instances::new(gpu),
                casters: Casters::new(gpu, &maps, &materials),
                forward: Forward::new(gpu, &maps, &materials, settings.samples, contact.as_ref()),
                contact,
                samples: settings.samples,
                softness: settings.softness,
                transition: settings.transition,
                look: settings.look,
                probe: Probe::new(gpu, &maps),
                timer,
                picture: None,
                mask: None,
                notes,
                materials,
                maps,
                gpu: gpu.clone(),
            })
        })
    }

    /// The settings that shadows are planned with, including what the filter, the device and the size have decided.
    #[must_use]
    pub fn shadow_settings(&self) -> &ShadowSettings {
        self.planner.settings()
    }

    /// Forgets what earlier frames have left behind in the planner (sizes that stabilisation holds), as if nothing had been
    /// drawn yet: for views that do not follow each other.
    ///
    /// # Errors
    /// Never in practice: the settings were accepted before.
    pub fn restart(&mut self) -> Result<()> {
        self.planner = Planner::new(self.planner.settings().clone())?;
        Ok(())
    }

    /// Bytes of vertices, indices and textures on the GPU.
    #[must_use]
    pub fn scene_bytes(&self) -> u64 {
        self.scene.bytes + self.skinned.geometry.bytes + self.materials.bytes
    }

    /// Draws a frame and waits for what was asked for.
    ///
    /// # Errors
    /// [`Error::Plan`] if camera, range or bounds are wrong, [`Error::Scene`] if the pose is not one of this scene,
    /// [`Error::OutOfMemory`] or [`Error::Device`] if the device fails.
    pub fn render(&mut self, frame: &Frame<'_>, outputs: Outputs) -> Result<Rendered> {
        let gpu = self.gpu.clone();
        gpu.guarded("drawing a frame", || self.render_unguarded(frame, outputs))
    }

    /// Visibility at given points. A point that the view shows within the shadowed range gets what a pixel there would
    /// get; any other is answered by the first split whose map covers it, or is lit where none does.
    ///
    /// # Errors
    /// [`Error::Probe`] naming a point that is not finite or has no normal, and those of [`Renderer::render`].
    pub fn probe(&mut self, frame: &Frame<'_>, points: &[ProbePoint]) -> Result<Vec<ProbeAnswer>> {
        probe::check(points)?;
        let gpu = self.gpu.clone();
        gpu.guarded("answering probes", || self.probe_unguarded(frame, points))
    }

    fn render_unguarded(&mut self, frame: &Frame<'_>, outputs: Outputs) -> Result<Rendered> {
        let gpu = self.gpu.clone();
        if outputs.picture && self.picture.is_none() {
            self.picture = Some(PictureTarget::new(&gpu, self.size, self.samples));
        }
        if outputs.mask && self.mask.is_none() {
            self.mask = Some(MaskTarget::new(&gpu, self.size));
        }
        let prepared = self.prepare(frame)?;
        let mut clock = Clock::start(&gpu, &self.timer);
        let mut encoder = new_encoder(&gpu);
        let split_drawn = self.record_maps(&mut encoder, frame, &prepared);
        let map_passes = split_drawn.len();
        let mut encoder = clock.after_maps(encoder)?;
        let mut view_drawn = Drawn::default();
        if let Some(contact) = &self.contact {
            let slot = self.timer.next();
            let mut pass = contact.begin(&mut encoder, self.timer.timestamp_writes(slot));
            view_drawn += self
                .timer
                .counted(&mut pass, slot, |pass| self.forward.draw_depth(pass, &self.drawable(), &prepared.solid));
        }
        let mask = match &self.mask {
            Some(target) if outputs.mask => {
                let slot = self.timer.next();
                view_drawn += self.record_mask(&mut encoder, target, slot, &prepared);
                Some(Capture::record(&gpu, &mut encoder, &target.texture, 0, self.size)?)
            }
            _ => None,
        };
        let picture = match &self.picture {
            Some(target) if outputs.picture => {
                let slot = self.timer.next();
                view_drawn += self.record_picture(&mut encoder, target, slot, &prepared);
                Some(Capture::record(&gpu, &mut encoder, &target.texture, 0, self.size)?)
            }
            _ => None,
        };
        let depth_maps = if outputs.maps && frame.shadows_on {
            let splits = prepared.plan.splits.iter().enumerate();
            splits
                .map(|(i, split)| {
                    let texture = self.maps.depth_texture();
                    // Depth is copied in whole layers only; a smaller map is cut out of its layer afterwards.
                    let texels = [texture.width(), texture.height()];
                    let (layer, corner) = self.maps.map_place(i);
                    let capture = Capture::record(&gpu, &mut encoder, texture, layer, texels)?;
                    Ok((texels[0], corner, split.size, capture))
                })
                .collect::<Result<Vec<_>>>()?
        } else {
            Vec::new()
        };
        self.timer.record(&mut encoder);
        let wall = clock.after_all(encoder)?;

        let measured = self.timer.read(&gpu)?;
        let counts = |passes: std::ops::Range<usize>| {
            measured.counts.as_ref().map(|counts| {
                let mut sum = PassCounts::default();
                counts[passes].iter().for_each(|&count| sum += count);
                sum
            })
        };
        let (shadow_ms, frame_ms) = match (&measured.spans_ms, wall) {
            (Some(spans), _) if !spans.is_empty() => (
                spans[..map_passes].last().map_or(0.0, |span| span[1]),
                spans.iter().map(|span| span[1]).fold(0.0, f64::max),
            ),
            (_, Some(wall)) => wall,
            _ => (0.0, 0.0),
        };
        let passes = measured.counts.as_ref().map_or(0, Vec::len);
        let stats = FrameStats {
            plan_ms: prepared.plan_ms,
            shadow_ms,
            frame_ms,
            splits: self.split_stats(&prepared.plan, &split_drawn),
            objects_in_view: prepared.objects_in_view,
            view_draws: view_drawn.draws,
            view_triangles: view_drawn.triangles,
            shadow_counts: counts(0..map_passes.min(passes)),
            view_counts: counts(map_passes.min(passes)..passes),
            bytes: self.maps.bytes(),
            generation: self.maps.options().generation.name(),
            storage: self.maps.options().storage.name(),
            notes: self.notes.clone(),
            plan: prepared.plan,
        };
        let [width, height] = self.size;
        const SIZED: &str = "a capture has as many bytes as its picture";
        Ok(Rendered {
            picture: picture
                .map(|capture| Ok::<_, Error>(RgbaImage::from_raw(width, height, capture.read(&gpu)?).expect(SIZED)))
                .transpose()?,
            mask: mask
                .map(|capture| {
                    // Visibility and hit are grey and alpha already.
                    Ok::<_, Error>(GrayAlphaImage::from_raw(width, height, capture.read(&gpu)?).expect(SIZED))
                })
                .transpose()?,
            maps: depth_maps
                .into_iter()
                .map(|(row, corner, size, capture)| {
                    Ok(maps::picture_of(&maps::depths_of(&capture.read(&gpu)?, self.depth_format), row, corner, size))
                })
                .collect::<Result<_>>()?,
            stats,
        })
    }

    fn probe_unguarded(&mut self, frame: &Frame<'_>, points: &[ProbePoint]) -> Result<Vec<ProbeAnswer>> {
        let gpu = self.gpu.clone();
        let prepared = self.prepare(frame)?;
        let mut encoder = new_encoder(&gpu);
        self.record_maps(&mut encoder, frame, &prepared);
        gpu.queue.submit([encoder.finish()]);
        let mut answers = Vec::with_capacity(points.len());
        for batch in points.chunks(probe::BATCH) {
            let asked: Vec<(ProbePoint, Responder)> =
                batch.iter().map(|&point| (point, self.responder(frame, &prepared.plan, point.position))).collect();
            let mut encoder = new_encoder(&gpu);
            let pending = self.probe.record(&gpu, &mut encoder, &self.maps, prepared.origin, &asked)?;
            gpu.queue.submit([encoder.finish()]);
            let mut replies = pending.read(&gpu)?;
            for (reply, (point, responder)) in replies.iter_mut().zip(&asked) {
                let faces_light = point.normal.dot(frame.sun.direction()) < 0.0;
                let unshaded = f32::from(u8::from(faces_light));
                match *responder {
                    Responder::Nobody => *reply = ProbeAnswer { visibility: unshaded, split: -1 },
                    // No caster reaches this split: whatever its map looks like, it is lit.
                    Responder::Split(split) if prepared.plan.casters(split).is_empty() || !frame.shadows_on => {
                        *reply = ProbeAnswer { visibility: unshaded, split: split as i32 };
                    }
                    Responder::Split(_) | Responder::View => {}
                }
            }
            answers.extend(replies);
        }
        Ok(answers)
    }

    /// Who answers for a point.
    fn responder(&self, frame: &Frame<'_>, plan: &ShadowPlan, point: DVec3) -> Responder {
        let depth = frame.view.view_depth(point);
        let in_range = plan.planes.last().is_some_and(|&far| depth < far);
        if in_range && cull::may_be_seen(frame.view, &Aabb::new(point, point)) {
            return Responder::View;
        }
        self.planner.covering_split(point).map_or(Responder::Nobody, Responder::Split)
    }

    /// Plans, uploads what moves, and sorts what is to be drawn.
    fn prepare(&mut self, frame: &Frame<'_>) -> Result<Prepared> {
        let pose = frame.pose;
        for (index, object) in pose.objects.iter().enumerate() {
            check_object(index, object, self.scene.meshes.len())?;
        }
        let view = frame.view;
        let origin = (view.eye() / ORIGIN_STEP).round() * ORIGIN_STEP;

        let caster_objects: Vec<usize> = (0..pose.objects.len()).filter(|&i| pose.objects[i].casts).collect();
        let casters: Vec<Aabb> = caster_objects.iter().map(|&i| pose.objects[i].bounds).collect();
        let receivers: Vec<Aabb> = pose.objects.iter().map(|object| object.bounds).collect();
        let begun = Instant::now();
        let plan = self.planner.plan(view, &frame.sun, &casters, &receivers)?;
        let plan_ms = begun.elapsed().as_secs_f64() * 1e3;
        let plan = plan.clone();
        let options = FrameOptions {
            origin,
            enabled: frame.shadows_on,
            tint: frame.tint,
            strength: self.look.strength,
            shadow_colour: self.look.colour,
            bias: self.look.bias,
            softness: self.softness,
            transition: self.transition,
        };
        self.maps.prepare(&self.gpu.queue, &plan, &options)?;
        self.skinned.update(&self.gpu, &self.scene_meshes, pose)?;
        self.forward.prepare(&self.gpu, &FrameUniform::new(view, &frame.sun, origin));
        if let Some(contact) = &self.contact {
            contact.prepare(&self.gpu, view, &frame.sun, origin)?;
        }
        self.timer.restart();

        let mut near_to_far: Vec<(f64, usize)> = (0..pose.objects.len())
            .filter(|&i| cull::may_be_seen(view, &pose.objects[i].bounds))
            .map(|i| (view.view_depth(pose.objects[i].bounds.center()), i))
            .collect();
        near_to_far.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let visible: Vec<usize> = near_to_far.into_iter().map(|(_, i)| i).collect();

        self.instances.clear();
        let caster_runs = (0..plan.splits.len())
            .map(|i| {
                let objects = plan.casters(i).iter().map(|&caster| caster_objects[caster as usize]);
                self.instances.grouped(pose, origin, objects)
            })
            .collect();
        let solid = self.instances.grouped(pose, origin, visible.iter().copied());
        let far_to_near = self.with_translucent_parts(pose, visible.iter().rev().copied());
        let translucent = self.instances.ordered(pose, origin, far_to_near.into_iter());
        self.instances.upload(&self.gpu)?;
        Ok(Prepared { origin, plan, plan_ms, caster_runs, solid, translucent, objects_in_view: visible.len() })
    }

    fn with_translucent_parts(&self, pose: &Pose, objects: impl Iterator<Item = usize>) -> Vec<usize> {
        let drawable = self.drawable();
        let translucent = |i: &usize| drawable.has(&pose.objects[*i], |material| material.alpha == AlphaMode::Blend);
        objects.filter(translucent).collect()
    }

    fn drawable(&self) -> Drawable<'_> {
        Drawable {
            scene: &self.scene,
            skinned: &self.skinned.geometry,
            materials: &self.materials,
            instances: &self.instances,
        }
    }

    /// One pass per split; nothing where shadows are off.
    fn record_maps(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        frame: &Frame<'_>,
        prepared: &Prepared,
    ) -> Vec<Drawn> {
        if !frame.shadows_on {
            return Vec::new();
        }
        let mut drawn = Vec::with_capacity(prepared.caster_runs.len());
        for (split, runs) in prepared.caster_runs.iter().enumerate() {
            let slot = self.timer.next();
            let mut pass = self.maps.begin_split(encoder, split, self.timer.timestamp_writes(slot));
            drawn.push(
                self.timer.counted(&mut pass, slot, |pass| {
                    self.casters.draw(pass, &self.maps, split, &self.drawable(), runs)
                }),
            );
        }
        drawn
    }

    fn record_mask(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        target: &MaskTarget,
        slot: Slot,
        prepared: &Prepared,
    ) -> Drawn {
        let mut pass = target.begin(encoder, self.timer.timestamp_writes(slot));
        self.timer.counted(&mut pass, slot, |pass| {
            self.forward.draw_mask(pass, &self.maps, self.contact.as_ref(), &self.drawable(), &prepared.solid)
        })
    }

    fn record_picture(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        target: &PictureTarget,
        slot: Slot,
        prepared: &Prepared,
    ) -> Drawn {
        let mut pass = target.begin(encoder, self.timer.timestamp_writes(slot));
        self.timer.counted(&mut pass, slot, |pass| {
            let (solid, translucent) = (&prepared.solid, &prepared.translucent);
            let contact = self.contact.as_ref();
            self.forward.draw_picture(pass, &self.maps, contact, &self.drawable(), solid, translucent)
        })
    }

    fn split_stats(&self, plan: &ShadowPlan, drawn: &[Drawn]) -> Vec<SplitStats> {
        let texel_bytes = match self.depth_format {
            DepthFormat::D32Float => 4,
            DepthFormat::D16Unorm => 2,
        };
        let stats = |(i, split): (usize, &umbrage::Split)| {
            let Drawn { draws, triangles } = drawn.get(i).copied().unwrap_or_default();
            SplitStats {
                near: split.near,
                far: split.far,
                texel_m: split.texel_m.max_element(),
                warped: split.warp.is_some(),
                casters: split.casters.len(),
                draws,
                triangles,
                bytes: u64::from(split.size) * u64::from(split.size) * texel_bytes,
            }
        };
        plan.splits.iter().enumerate().map(stats).collect()
    }
}

fn new_encoder(gpu: &Gpu) -> wgpu::CommandEncoder {
    gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("Renderer::encoder") })
}

/// Submits a frame: at once where the GPU takes the time itself, else maps and view apart with a wait after each.
struct Clock<'a> {
    gpu: &'a Gpu,
    by_cpu: bool,
    begun: Instant,
    shadow_ms: f64,
}

impl<'a> Clock<'a> {
    fn start(gpu: &'a Gpu, timer: &Timer) -> Self {
        Self { gpu, by_cpu: !timer.has_timestamps(), begun: Instant::now(), shadow_ms: 0.0 }
    }

    fn submit_and_wait(&self, encoder: wgpu::CommandEncoder) -> Result<f64> {
        self.gpu.queue.submit([encoder.finish()]);
        self.gpu.wait()?;
        Ok(self.begun.elapsed().as_secs_f64() * 1e3)
    }

    fn after_maps(&mut self, encoder: wgpu::CommandEncoder) -> Result<wgpu::CommandEncoder> {
        if !self.by_cpu {
            return Ok(encoder);
        }
        self.shadow_ms = self.submit_and_wait(encoder)?;
        Ok(new_encoder(self.gpu))
    }

    /// Milliseconds of the maps and of the frame, if the CPU measures.
    fn after_all(self, encoder: wgpu::CommandEncoder) -> Result<Option<(f64, f64)>> {
        if self.by_cpu {
            let frame_ms = self.submit_and_wait(encoder)?;
            return Ok(Some((self.shadow_ms, frame_ms)));
        }
        self.gpu.queue.submit([encoder.finish()]);
        Ok(None)
    }
}
