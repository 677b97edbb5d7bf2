//! The demonstration renderer: a scene, a view and lights in; a picture, a mask, maps and numbers
//! out.

use std::sync::OnceLock;

use glam::DVec3;
use image::{GrayAlphaImage, GrayImage, RgbaImage};
use umbrage::config::{Coordinates, Layout, LightKind, ShadowConfig, Translucent};
use umbrage::{Aabb, Light, ShadowPlan, View};
use umbrage_scene::{AlphaMode, Pose, Scene};
use umbrage_wgpu::{Inputs, LightMaps, MaskFrame, MaskNormals, ShadowMask, Shadows};
use web_time::Instant;

use crate::capture::Capture;
use crate::casters::Casters;
use crate::contact::Contact;
use crate::draw_list::{Drawable, Instances, once};
use crate::forward::{Forward, FrameUniform, MASK_FORMAT, Samples, Shading};
use crate::geometry::{Geometry, SceneMeshes, SkinnedGeometry, check_object};
use crate::lamps::Lamp;
use crate::materials::{GpuMaterial, Materials};
use crate::probe::{self, Probe, ProbeAnswer, ProbePoint};
use crate::record::{Clock, MapCapture, Prepared, Recorded, SliceRuns, new_encoder};
use crate::stats::{FrameStats, LightStats, SplitStats};
use crate::targets::{MaskTarget, PictureTarget};
use crate::timing::{PassCounts, Timer};
use crate::view_list::ViewList;
use crate::{Error, Gpu, Result, cull, maps};

/// The frame's origin moves in steps of this many metres, so that positions near the eye are exact
/// to a tenth of a millimetre in `f32` and yet stay the same from frame to frame, which is what
/// keeps stabilised maps still.
const ORIGIN_STEP: f64 = 1024.0;

/// What is settled before the first frame.
#[derive(Clone, Debug)]
pub struct RenderSettings {
    /// Pixels across and down.
    pub size: [u32; 2],
    /// Samples per pixel of the picture; masks have one always.
    pub samples: Samples,
    /// Shadows. With [`Coordinates::Deferred`] masks are made from the picture's depth
    /// ([`umbrage_wgpu::ShadowMask`]).
    pub config: ShadowConfig,
    /// The lights of a frame, the first one first: one sun by default.
    pub lights: Vec<LightMaps>,
}

impl Default for RenderSettings {
    fn default() -> Self {
        Self {
            size: [800, 600],
            samples: Samples::default(),
            config: ShadowConfig::default(),
            lights: vec![LightKind::Directional.into()],
        }
    }
}

/// What varies from frame to frame.
#[derive(Clone, Copy, Debug)]
pub struct Frame<'a> {
    /// The scene at this moment; a pose of the scene that the renderer was made with.
    pub pose: &'a Pose,
    /// The eye.
    pub view: &'a View,
    /// The first light: the one that masks and probes are of.
    pub light: Lamp,
    /// More lights, for the picture.
    pub more_lights: &'a [Lamp],
    /// Whether anything throws shadows; if not, whatever faces the light is lit, and what
    /// stabilised maps hold on to stays as it was.
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
    /// Grey: visibility at the pixel's centre, 255 lit to 0 in shadow or turned away. Alpha: 255
    /// where a surface is.
    pub mask: Option<GrayAlphaImage>,
    /// Each split's depths, stretched: black is nearest to the light, white is empty.
    pub maps: Vec<GrayImage>,
    /// Numbers.
    pub stats: FrameStats,
}

/// Draws one scene at one size. Everything that does not change from frame to frame is on the GPU
/// already.
pub struct Renderer {
    pub(crate) gpu: Gpu,
    pub(crate) size: [u32; 2],
    pub(crate) samples: Samples,
    pub(crate) shadows: Shadows,
    /// Where the shadows of the view that is drawn are held: see [`Renderer::render_views`].
    pub(crate) view_slot: u32,
    /// The view that maps are planned for, if it is not the one that is drawn.
    pub(crate) planned_for: Option<View>,
    pub(crate) scene: Geometry,
    scene_meshes: SceneMeshes,
    skinned: SkinnedGeometry,
    pub(crate) materials: Materials,
    pub(crate) instances: Instances,
    pub(crate) casters: Casters,
    pub(crate) forward: Forward,
    pub(crate) contact: Option<Contact>,
    /// Per node of the scene, whether its translucent surfaces throw shadows; empty where none do.
    pub(crate) dithered_nodes: Vec<bool>,
    /// Made when something is asked.
    pub(crate) probe: OnceLock<Probe>,
    pub(crate) shading: Shading,
    pub(crate) timer: Timer,
    pub(crate) picture: Option<PictureTarget>,
    pub(crate) mask: Option<MaskTarget>,
    pub(crate) shadow_mask: Option<ShadowMask>,
    pub(crate) notes: Vec<String>,
}

impl Renderer {
    /// Uploads a scene and makes everything that a frame needs.
    ///
    /// # Errors
    /// [`Error::ImageSize`], [`Error::TextureSize`], [`Error::BufferSize`] or
    /// [`Error::OutOfMemory`] if the device cannot hold it, [`Error::Scene`] if the scene
    /// contradicts itself, [`Error::Plan`] and [`Error::Shadows`] if the settings are wrong.
    pub fn new(gpu: &Gpu, scene: &Scene, settings: &RenderSettings) -> Result<Self> {
        Self::with_shading(gpu, scene, settings, Shading::WithShadows)
    }

    /// Draws a scene by shaders that never heard of shadows: what a picture costs without them,
    /// which a renderer whose shadows are switched off does not tell. [`Frame::shadows_on`] is not
    /// looked at, and of [`RenderSettings::config`] nothing is.
    ///
    /// # Errors
    /// As [`Renderer::new`].
    pub fn without_shadows(gpu: &Gpu, scene: &Scene, settings: &RenderSettings) -> Result<Self> {
        let mut config = ShadowConfig::default();
        config.look.contact = false;
        let settings = RenderSettings { config, ..settings.clone() };
        Self::with_shading(gpu, scene, &settings, Shading::WithoutShadows)
    }

    fn with_shading(gpu: &Gpu, scene: &Scene, settings: &RenderSettings, shading: Shading) -> Result<Self> {
        let limit = gpu.max_texture_edge();
        let [width, height] = settings.size;
        if width == 0 || height == 0 || width > limit || height > limit {
            return Err(Error::ImageSize { width, height, limit });
        }
        let config = &settings.config;
        gpu.guarded("uploading the scene", || {
            let shadows = Shadows::with_lights(&gpu.device, config, &settings.lights)?;
            let maps = shadows.maps();
            let materials = Materials::new(gpu, scene)?;
            let timer = Timer::new(gpu, maps.map_count());
            let contact = Contact::wanted(gpu, config, settings.size);
            let notes = notes_of(&shadows, contact.as_ref(), &timer);
            Ok(Self {
                size: settings.size,
                view_slot: 0,
                planned_for: None,
                scene: Geometry::of_scene(gpu, scene)?,
                scene_meshes: SceneMeshes::of_scene(scene),
                skinned: SkinnedGeometry::empty(gpu)?,
                instances: Instances::new(gpu),
                casters: Casters::new(gpu, maps, &materials, config.look.translucent),
                forward: Forward::new(gpu, maps, &materials, settings.samples, contact.as_ref(), shading),
                contact,
                dithered_nodes: dithered_nodes(scene, config),
                samples: settings.samples,
                probe: OnceLock::new(),
                shading,
                timer,
                picture: None,
                mask: None,
                shadow_mask: None,
                notes,
                materials,
                shadows,
                gpu: gpu.clone(),
            })
        })
    }

    /// Forgets what stabilised maps hold on to, as if nothing had been drawn yet: for views that do
    /// not follow each other.
    pub fn restart(&mut self) {
        self.shadows.restart();
    }

    /// Bytes of vertices, indices and textures on the GPU.
    #[must_use]
    pub fn scene_bytes(&self) -> u64 {
        self.scene.bytes + self.skinned.geometry.bytes + self.materials.bytes
    }

    /// How maps are kept and drawn: the config's layout, or what the device can do instead.
    #[must_use]
    pub fn layout(&self) -> Layout {
        self.shadows.maps().layout()
    }

    /// Draws a frame and waits for what was asked for.
    ///
    /// # Errors
    /// [`Error::Plan`] if camera, range or bounds are wrong, [`Error::Scene`] if the pose is not
    /// one of this scene, [`Error::LampSlots`], [`Error::LampCount`] or [`Error::Shadows`] if the
    /// lights are not those that the renderer was made for, [`Error::OutOfMemory`] or
    /// [`Error::Device`] if the device fails.
    pub fn render(&mut self, frame: &Frame<'_>, outputs: Outputs) -> Result<Rendered> {
        let gpu = self.gpu.clone();
        let frame = Frame { shadows_on: frame.shadows_on && self.shading == Shading::WithShadows, ..*frame };
        gpu.guarded("drawing a frame", || self.render_unguarded(&frame, outputs))
    }

    /// Visibility of the first light at given points. A point that the view shows within the
    /// shadowed range gets what a pixel there would get; any other is answered by the first split
    /// whose map covers it, or is lit where none does.
    ///
    /// # Errors
    /// [`Error::Probe`] naming a point that is not finite or has no normal, and those of
    /// [`Renderer::render`].
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
        if outputs.mask && self.is_deferred() && self.shadow_mask.is_none() {
            self.shadow_mask =
                Some(ShadowMask::new(&gpu.device, self.shadows.maps(), MASK_FORMAT, MaskNormals::FromDepth)?);
        }
        let prepared = Prepared { every_map: outputs.maps, ..self.prepare(frame, true)? };
        let mut clock = Clock::start(&gpu, &self.timer);
        let samples = self.shadows.maps().config().filter.samples();
        if outputs.maps && samples > 1 {
            return Err(Error::MapsOfSamples { samples });
        }
        let (recorded, mut encoder) = self.record(new_encoder(&gpu), &mut clock, &prepared, outputs)?;
        let mask = match &self.mask {
            Some(target) if outputs.mask => {
                if let Some(shadow_mask) = self.shadow_mask.as_ref() {
                    self.record_deferred_mask(&mut encoder, target, shadow_mask, frame, prepared.origin)?;
                }
                Some(Capture::record(&gpu, &mut encoder, &target.texture, 0, self.size)?)
            }
            _ => None,
        };
        let picture = match &self.picture {
            Some(target) if outputs.picture => {
                Some(Capture::record(&gpu, &mut encoder, &target.texture, 0, self.size)?)
            }
            _ => None,
        };
        self.timer.record(&mut encoder);
        let wall = clock.after_all(encoder)?;

        let measured = self.timer.read(&gpu)?;
        let over_maps = |pass: usize| recorded.map_passes.iter().any(|&(_, _, slot)| slot == pass);
        let counts = |maps: bool| {
            measured.counts.as_ref().map(|counts| {
                let mut sum = PassCounts::default();
                counts.iter().enumerate().filter(|&(i, _)| over_maps(i) == maps).for_each(|(_, &count)| sum += count);
                sum
            })
        };
        let is_prefiltered = self.shadows.maps().config().filter.is_prefiltered();
        let (shadow_ms, frame_ms) = match (&measured.spans_ms, wall) {
            (Some(spans), _) if !spans.is_empty() => {
                let maps = || spans.iter().enumerate().filter(|&(i, _)| over_maps(i)).map(|(_, span)| span);
                let last = recorded.map_passes.last().map_or(0, |&(_, _, slot)| slot);
                let shadow_ms = match prepared.slices.is_empty() {
                    // What turns depths into moments is no pass of ours; it is over when the next
                    // one begins.
                    true if is_prefiltered && maps().next().is_some() && last + 1 < spans.len() => spans[last + 1][0],
                    true => maps().map(|span| span[1]).fold(0.0, f64::max),
                    // Between the maps there is the view.
                    false => maps().map(|span| span[1] - span[0]).sum(),
                };
                (shadow_ms, spans.iter().map(|span| span[1]).fold(0.0, f64::max))
            }
            (_, Some(wall)) => wall,
            _ => (0.0, 0.0),
        };
        let shown = self.shadows.frame();
        let stats = FrameStats {
            plan_ms: prepared.plan_ms,
            shadow_ms,
            frame_ms,
            splits: self.split_stats(0, frame, &recorded, measured.spans_ms.as_deref()),
            shadow_draws: recorded.map_passes.iter().map(|(_, drawn, _)| drawn.draws).sum(),
            shadow_triangles: recorded.map_passes.iter().map(|(_, drawn, _)| drawn.triangles).sum(),
            more_lights: (1..self.shadows.lights().len())
                .map(|light| LightStats {
                    splits: self.split_stats(light, frame, &recorded, measured.spans_ms.as_deref()),
                    plan: shown.shared_plan(light),
                })
                .collect(),
            objects_in_view: prepared.objects_in_view,
            view_draws: recorded.view.draws,
            view_triangles: recorded.view.triangles,
            shadow_counts: counts(true),
            view_counts: counts(false),
            bytes: self.shadows.maps().bytes(),
            generation: self.shadows.maps().layout().generation().word(),
            storage: self.shadows.maps().layout().storage().word(),
            notes: self.notes.clone(),
            plan: shown.shared_plan(0),
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
            maps: self.map_pictures(recorded.maps)?,
            stats,
        })
    }

    /// Plans, uploads what moves, and sorts what is to be drawn. With `surfaces_alone` nothing but
    /// what is drawn asks the maps.
    pub(crate) fn prepare(&mut self, frame: &Frame<'_>, surfaces_alone: bool) -> Result<Prepared> {
        let pose = frame.pose;
        for (index, object) in pose.objects.iter().enumerate() {
            check_object(index, object, self.scene.meshes.len())?;
        }
        let view = frame.view;
        let origin = (view.eye() / ORIGIN_STEP).round() * ORIGIN_STEP;

        let caster_objects = self.casters_of(pose);
        let casters: Vec<Aabb> = caster_objects.iter().map(|&i| pose.objects[i].bounds).collect();
        let receivers: Vec<Aabb> = pose.objects.iter().map(|object| object.bounds).collect();
        let mut near_to_far: Vec<(f64, usize)> = (0..pose.objects.len())
            .filter(|&i| cull::may_be_seen(view, &pose.objects[i].bounds))
            .map(|i| (view.view_depth(pose.objects[i].bounds.center()), i))
            .collect();
        near_to_far.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let visible: Vec<usize> = near_to_far.into_iter().map(|(_, i)| i).collect();
        let planned_for = self.planned_for.unwrap_or(*view);
        let asks_surfaces =
            surfaces_alone && frame.shadows_on && frame.more_lights.is_empty() && self.planned_for.is_none();
        let clusters = if asks_surfaces { self.receiver_clusters(pose, &caster_objects, &visible) } else { None };

        let lamps: Vec<Lamp> = [frame.light].into_iter().chain(frame.more_lights.iter().copied()).collect();
        let made_for = self.shadows.lights().len();
        if lamps.len() != made_for {
            return Err(Error::LampSlots { frame: lamps.len(), renderer: made_for });
        }
        let lights: Vec<Light> = lamps.iter().map(|lamp| lamp.light).collect();
        let begun = Instant::now();
        let inputs = Inputs {
            casters: &casters,
            receivers: &receivers,
            receiver_clusters: clusters.as_deref(),
            origin,
            image_size: self.size,
            view_slot: self.view_slot,
            enabled: frame.shadows_on,
            tint: frame.tint,
            ..Inputs::new(&planned_for, &lights)
        };
        self.shadows.prepare(&self.gpu.queue, &inputs)?;
        let plan_ms = begun.elapsed().as_secs_f64() * 1e3;
        self.skinned.update(&self.gpu, &self.scene_meshes, pose)?;
        self.forward.prepare(&self.gpu, 0, &FrameUniform::new(view, &lamps, origin, None)?);
        if let Some(contact) = &self.contact {
            contact.prepare(&self.gpu, view, origin)?;
        }
        let slices = self.shadows.frame().slices(view);
        for slice in &slices {
            let uniform = FrameUniform::new(view, &lamps, origin, Some(slice))?;
            self.forward.prepare(&self.gpu, 1 + slice.split, &uniform);
        }
        self.timer.restart();

        self.instances.clear();
        let caster_runs = self.caster_runs(frame, origin, &caster_objects);
        let grouped = self.instances.grouped(pose, origin, false, visible.iter().copied().map(once));
        let solid = ViewList::new(&self.drawable(), pose, view, &grouped);
        let far_to_near = self.with_translucent_parts(pose, visible.iter().rev().copied());
        let translucent = self.instances.ordered(pose, origin, far_to_near.iter().copied());
        let plan = self.shadows.frame().plan(0);
        let last = plan.splits.len() - 1;
        let slices = slices
            .into_iter()
            .map(|slice| {
                let split = &plan.splits[slice.split];
                // What is nearer than the first split or farther than the last one is drawn with
                // them.
                let near = if slice.split == 0 { f64::NEG_INFINITY } else { split.near };
                let far = if slice.split == last { f64::INFINITY } else { split.far };
                let lies_in = |object: &usize| {
                    let depths = pose.objects[*object].bounds.corners().map(|corner| view.view_depth(corner));
                    depths.iter().any(|&depth| depth >= near) && depths.iter().any(|&depth| depth <= far)
                };
                let solid = visible.iter().copied().filter(lies_in).map(once);
                let grouped = self.instances.grouped(pose, origin, false, solid);
                SliceRuns {
                    slice,
                    solid: ViewList::new(
                        &Drawable {
                            scene: &self.scene,
                            skinned: &self.skinned.geometry,
                            materials: &self.materials,
                            instances: &self.instances,
                        },
                        pose,
                        view,
                        &grouped,
                    ),
                    translucent: self.instances.ordered(pose, origin, far_to_near.iter().copied().filter(lies_in)),
                }
            })
            .collect();
        self.instances.upload(&self.gpu)?;
        Ok(Prepared {
            origin,
            plan_ms,
            caster_runs,
            solid,
            translucent,
            slices,
            objects_in_view: visible.len(),
            every_map: false,
        })
    }

    fn with_translucent_parts(&self, pose: &Pose, objects: impl Iterator<Item = usize>) -> Vec<usize> {
        let drawable = self.drawable();
        let translucent = |i: &usize| drawable.has(&pose.objects[*i], |material| material.alpha == AlphaMode::Blend);
        objects.filter(translucent).collect()
    }

    pub(crate) fn probe_pass(&self) -> &Probe {
        self.probe.get_or_init(|| Probe::new(&self.gpu, self.shadows.maps()))
    }

    pub(crate) fn drawable(&self) -> Drawable<'_> {
        Drawable {
            scene: &self.scene,
            skinned: &self.skinned.geometry,
            materials: &self.materials,
            instances: &self.instances,
        }
    }

    /// Replaces the mask by what its depth alone says.
    fn record_deferred_mask(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        target: &MaskTarget,
        shadow_mask: &ShadowMask,
        frame: &Frame<'_>,
        origin: DVec3,
    ) -> Result<()> {
        let view = frame.view;
        let camera = MaskFrame {
            clip_from_eye: view.clip_from_relative(view.eye()),
            eye: view.eye(),
            forward: view.forward(),
            origin,
            empty_depth: 0.0,
        };
        shadow_mask.prepare(&self.gpu.queue, &camera)?;
        let group = shadow_mask.bind_group(&self.gpu.device, &target.depth, None)?;
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("Renderer::deferred_mask"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &target.color,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations::default(),
            })],
            ..Default::default()
        });
        shadow_mask.draw(&mut pass, self.shadows.maps(), &group);
        Ok(())
    }

    /// The splits' maps as pictures, nearest first.
    fn map_pictures(&self, mut maps: Vec<MapCapture>) -> Result<Vec<GrayImage>> {
        maps.sort_by_key(|map| map.split);
        let format = self.shadows.maps().config().depth_format;
        let picture = |map: MapCapture| {
            let depths = maps::depths_of(&map.capture.read(&self.gpu)?, format);
            Ok(maps::picture_of(&depths, map.row, map.corner, self.shadows.maps().map_size(map.split)))
        };
        maps.into_iter().map(picture).collect()
    }

    /// Whether masks are made from the picture's depth.
    fn is_deferred(&self) -> bool {
        self.shadows.maps().config().coordinates == Coordinates::Deferred
    }

    /// Whether an object is drawn into maps.
    pub(crate) fn casts(&self, object: &umbrage_scene::Object) -> bool {
        object.casts || self.dithered_nodes.get(object.node) == Some(&true)
    }

    fn split_stats(
        &self,
        light: usize,
        frame: &Frame<'_>,
        recorded: &Recorded,
        spans_ms: Option<&[[f64; 2]]>,
    ) -> Vec<SplitStats> {
        let plan: &ShadowPlan = self.shadows.frame().plan(light);
        let first = self.shadows.maps().first_map(light);
        let objects: Vec<&umbrage_scene::Object> =
            frame.pose.objects.iter().filter(|object| self.casts(object)).collect();
        let drawable = self.drawable();
        let dithered = self.shadows.maps().config().look.translucent == Translucent::Dithered;
        let triangles = |caster: &u32| {
            let drawn = |material: &GpuMaterial| dithered || material.alpha != AlphaMode::Blend;
            drawable.triangles(objects[*caster as usize], drawn)
        };
        let stats = |(i, split): (usize, &umbrage::Split)| {
            let draws_it = |pass: usize| self.shadows.maps().passes()[pass].splits().contains(&(first + i));
            let draws = recorded.map_passes.iter().filter(|&&(pass, ..)| draws_it(pass));
            let took = |spans: &[[f64; 2]]| {
                draws.clone().filter_map(|&(_, _, slot)| spans.get(slot)).map(|span| span[1] - span[0]).sum()
            };
            // Of a map that has a pass of its own, what was drawn: maybe parts of casters.
            let alone = draws.clone().find(|&&(pass, ..)| self.shadows.maps().passes()[pass].splits().len() == 1);
            SplitStats {
                near: split.near,
                far: split.far,
                texel_m: split.texel_m.max_element(),
                warped: split.warp.is_some() && split.light_position.is_none(),
                casters: split.casters.len(),
                gpu_ms: spans_ms.map(took),
                draws: draws.map(|(_, drawn, _)| drawn.draws).sum(),
                triangles: match alone {
                    Some((_, drawn, _)) => drawn.triangles,
                    None if frame.shadows_on => plan.casters(i).iter().map(triangles).sum(),
                    None => 0,
                },
                bytes: u64::from(split.size)
                    * u64::from(split.size)
                    * self.shadows.maps().config().depth_format.texel_bytes(),
            }
        };
        plan.splits.iter().enumerate().map(stats).collect()
    }
}

/// Fallbacks that are taken.
pub(crate) fn notes_of(shadows: &Shadows, contact: Option<&Contact>, timer: &Timer) -> Vec<String> {
    let mut notes = shadows.notes().to_vec();
    if shadows.config().look.contact && contact.is_none() {
        notes.push("no loads from depth textures on GL: no contact shadows".to_owned());
    }
    if !timer.has_timestamps() {
        notes.push("no timestamp queries: times of the GPU are measured by the CPU's clock".to_owned());
    }
    notes
}

/// Per node of a scene, whether its translucent surfaces throw shadows; empty where none do.
pub(crate) fn dithered_nodes(scene: &Scene, config: &ShadowConfig) -> Vec<bool> {
    match config.look.translucent {
        Translucent::None => Vec::new(),
        Translucent::Dithered => scene.nodes.iter().map(|node| node.cast_shadow).collect(),
    }
}
