//! The demonstration renderer. It takes a scene, a view and lights, and returns a picture, a mask,
//! maps and numbers.

mod answers;
#[cfg(not(target_arch = "wasm32"))]
mod blocking;
mod caster_runs;
mod gathered;
mod lit;
mod live;
mod prepare;
mod record;
mod report;
mod sight;
#[cfg(not(target_arch = "wasm32"))]
mod views;
mod world;

use std::sync::OnceLock;

use glam::DVec3;
use image::{GrayAlphaImage, GrayImage, RgbaImage};
use umbrage::View;
use umbrage::config::{Coordinates, FitTo, Layout, LightKind, ShadowConfig, Translucent};
use umbrage_scene::{Pose, Scene};
use umbrage_wgpu::{LightMaps, MaskNormals, MaskRuns, ShadowMask, Shadows};

use self::gathered::Gathered;
use self::prepare::Prepared;
use self::record::{Clock, MapCapture, new_encoder};
use self::sight::{Sight, camera_of};
pub use self::world::KeptMaps;
use self::world::WorldSet;
use crate::capture::Capture;
use crate::casters::Casters;
use crate::coarser::Coarser;
use crate::contact::Contact;
use crate::draw_list::{Drawable, Instances};
use crate::edge_counts::{COUNTS_FORMAT, EdgeCounts};
use crate::formats::MASK_FORMAT;
use crate::forward::{Forward, Samples, Shading};
use crate::geometry::{Geometry, SceneMeshes, SkinnedGeometry};
use crate::lamps::Lamp;
use crate::materials::Materials;
use crate::names::Names;
use crate::probe::{self, Probe, ProbeAnswer, ProbePoint};
use crate::stats::FrameStats;
use crate::targets::{MaskTarget, PictureTarget};
use crate::through_mask::ThroughMask;
use crate::timing::Timer;
use crate::{Error, Gpu, Result, maps, waiting};

/// Settings that are fixed before the first frame.
#[derive(Clone, Debug)]
pub struct RenderSettings {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Samples per pixel of the picture. Masks always have one.
    pub samples: Samples,
    /// Technique of the shadows. With [`Coordinates::Deferred`] masks are made from the picture's
    /// depth ([`umbrage_wgpu::ShadowMask`]).
    pub config: ShadowConfig,
    /// Lights of a frame, in order; one sun by default.
    pub lights: Vec<LightMaps>,
    /// Pictures may take the first light's shadows from a mask that is made of their depth and
    /// normals, which asks once per pixel however small triangles are. It is done where nothing is
    /// lost by it: one light, and one sample per pixel or a software driver, where each surface of
    /// a pixel is asked for. `false`: every fragment asks for itself.
    pub through_mask: bool,
}

impl Default for RenderSettings {
    fn default() -> Self {
        Self {
            size: [800, 600],
            samples: Samples::default(),
            config: ShadowConfig::default(),
            lights: vec![LightKind::Directional.into()],
            through_mask: true,
        }
    }
}

/// Inputs that vary from frame to frame.
#[derive(Clone, Copy, Debug)]
pub struct Frame<'a> {
    /// Pose of the scene that the renderer was made with.
    pub pose: &'a Pose,
    /// Objects of the pose that differ from those of the last frame, by index; an empty list for an
    /// equal pose. `None` means that any may differ. Given a list, objects that do not move cost
    /// nothing, which matters with thousands.
    pub moved: Option<&'a [u32]>,
    /// View that is drawn.
    pub view: &'a View,
    /// The first light. Masks and probes are computed for this light.
    pub light: Lamp,
    /// Further lights of the picture.
    pub more_lights: &'a [Lamp],
    /// False if nothing casts shadows. Every surface that faces the light is then lit, and the
    /// state of stabilised maps stays unchanged.
    pub shadows_on: bool,
    /// True if the picture shows each split in its own colour.
    pub tint: bool,
}

/// Choice of a frame's outputs.
#[derive(Clone, Copy, Debug, Default)]
pub struct Outputs {
    /// True if the shaded picture is wanted.
    pub picture: bool,
    /// True if the visibility mask is wanted.
    pub mask: bool,
    /// True if each split's depth map is wanted.
    pub maps: bool,
    /// True if counts of exact edges are wanted for each pixel. A pass of its own draws them, with
    /// a shader that counts.
    pub edges: bool,
}

/// Outputs of a frame.
#[derive(Clone, Debug)]
pub struct Rendered {
    /// The shaded picture: sRGB, opaque.
    pub picture: Option<RgbaImage>,
    /// The visibility mask. Grey is visibility at the pixel's centre, from 255 (lit) to 0 (in
    /// shadow or turned away). Alpha is 255 where a surface is.
    pub mask: Option<GrayAlphaImage>,
    /// Depths of each split's map, stretched: black is nearest to the light, white is empty.
    pub maps: Vec<GrayImage>,
    /// Counts of exact edges of the first light; `None` with sampled edges.
    pub edges: Option<EdgeCounts>,
    /// Numbers of the frame.
    pub stats: FrameStats,
}

/// Renderer of one scene at one size. All data that does not change from frame to frame is on the
/// GPU.
pub struct Renderer {
    pub(crate) gpu: Gpu,
    pub(crate) size: [u32; 2],
    pub(crate) samples: Samples,
    pub(crate) shadows: Shadows,
    /// Slot of the shadows of the view that is drawn: see [`Renderer::render_views`].
    pub(crate) view_slot: u32,
    /// View that maps are planned for, if it is not the view that is drawn.
    pub(crate) planned_for: Option<View>,
    pub(crate) scene: Geometry,
    scene_meshes: SceneMeshes,
    pub(crate) skinned: SkinnedGeometry,
    pub(crate) materials: Materials,
    pub(crate) instances: Instances,
    /// Ids of the objects, with exact edges.
    pub(crate) names: Names,
    pub(crate) casters: Casters,
    pub(crate) forward: Forward,
    /// True if the pipelines of pictures serve every filter that compares depth.
    has_any_filter: bool,
    pub(crate) contact: Option<Contact>,
    /// True for each node of the scene whose translucent surfaces cast shadows; empty if none do.
    pub(crate) dithered_nodes: Vec<bool>,
    /// The probe pass, made when it is first used.
    pub(crate) probe: OnceLock<Probe>,
    pub(crate) shading: Shading,
    pub(crate) timer: Timer,
    pub(crate) picture: Option<PictureTarget>,
    pub(crate) mask: Option<MaskTarget>,
    pub(crate) shadow_mask: Option<ShadowMask>,
    /// Whether pictures may go through a mask, and what that takes, made when first needed.
    may_mask: bool,
    through_mask: Option<ThroughMask>,
    pub(crate) counts: Option<MaskTarget>,
    pub(crate) notes: Vec<String>,
    /// Set of the objects that maps are planned for, if maps are kept or the objects are thousands.
    world: WorldSet,
    kept: KeptMaps,
    gathered: Gathered,
    pub(crate) coarser: Coarser,
    sight: Sight,
}

impl Renderer {
    /// Uploads a scene and makes all pipelines and textures of a frame.
    ///
    /// # Errors
    /// [`Error::ImageSize`], [`Error::TextureSize`], [`Error::BufferSize`] or
    /// [`Error::OutOfMemory`] if the device cannot hold it, [`Error::Scene`] if the scene
    /// contradicts itself, [`Error::Plan`] and [`Error::Shadows`] if the settings are wrong.
    pub fn new(gpu: &Gpu, scene: &Scene, settings: &RenderSettings) -> Result<Self> {
        Self::with_shading(gpu, scene, settings, Shading::WithShadows)
    }

    /// Makes a renderer whose shaders contain no shadow code, to measure the cost of a picture
    /// without shadows. A renderer whose shadows are switched off still pays for the code.
    /// [`Frame::shadows_on`] and [`RenderSettings::config`] are ignored.
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
            let (geometry, names) = (Geometry::of_scene(gpu, scene, maps.edges())?, Names::new(gpu));
            let named = names.entries(&geometry, Names::BINDING);
            let with = (contact.as_ref(), &named[..]);
            let forward = Forward::new(gpu, maps, &materials, settings.samples, with, shading, false);
            Ok(Self {
                size: settings.size,
                view_slot: 0,
                planned_for: None,
                scene_meshes: SceneMeshes::of_scene(scene),
                skinned: SkinnedGeometry::of(gpu, maps.edges())?,
                instances: Instances::new(gpu),
                casters: Casters::new(gpu, maps, &materials, config.look.translucent),
                forward,
                has_any_filter: false,
                scene: geometry,
                names,
                contact,
                dithered_nodes: dithered_nodes(scene, config),
                samples: settings.samples,
                probe: OnceLock::new(),
                shading,
                timer,
                picture: None,
                mask: None,
                shadow_mask: None,
                may_mask: settings.through_mask,
                through_mask: None,
                counts: None,
                notes,
                world: WorldSet::default(),
                kept: KeptMaps::default(),
                gathered: Gathered::default(),
                coarser: Coarser::of(scene),
                sight: Sight::default(),
                materials,
                shadows,
                gpu: gpu.clone(),
            })
        })
    }

    /// Forgets the state of stabilised maps, as if nothing had been drawn yet, for views that do
    /// not follow each other.
    pub fn restart(&mut self) {
        self.shadows.restart();
        self.sight.forget();
    }

    /// Returns the bytes of vertices, indices and textures on the GPU.
    #[must_use]
    pub fn scene_bytes(&self) -> u64 {
        self.scene.bytes + self.skinned.geometry.bytes + self.materials.bytes
    }

    /// Returns the layout of the maps: the config's, or the one that the device can do instead.
    #[must_use]
    pub fn layout(&self) -> Layout {
        self.shadows.maps().layout()
    }

    /// Draws a frame and waits for the requested outputs, without blocking in a browser. Elsewhere
    /// the future is ready when it is first polled, as in [`Renderer::render`].
    ///
    /// # Errors
    /// [`Error::Plan`] if camera, range or bounds are wrong, [`Error::Scene`] if the pose is not
    /// one of this scene, [`Error::LampSlots`], [`Error::LampCount`] or [`Error::Shadows`] if the
    /// lights are not those that the renderer was made for, [`Error::OutOfMemory`] or
    /// [`Error::Device`] if the device fails.
    pub async fn render_async(&mut self, frame: &Frame<'_>, outputs: Outputs) -> Result<Rendered> {
        let gpu = self.gpu.clone();
        let frame = Frame { shadows_on: frame.shadows_on && self.shading == Shading::WithShadows, ..*frame };
        let drawn = gpu
            .guarded_async("drawing a frame", async || {
                self.look_around(&frame, outputs).await?;
                self.render_unguarded(&frame, outputs).await
            })
            .await;
        self.or_forget(drawn)
    }

    /// Returns the visibility of the first light at given points. A point that the view shows
    /// within the shadowed range gets the visibility that a pixel there would get. Any other is
    /// answered by the first split whose map covers it, or is lit where none does.
    ///
    /// # Errors
    /// [`Error::Probe`] naming a point that is not finite or has no normal, and those of
    /// [`Renderer::render_async`].
    pub async fn probe_async(&mut self, frame: &Frame<'_>, points: &[ProbePoint]) -> Result<Vec<ProbeAnswer>> {
        probe::check(points)?;
        let gpu = self.gpu.clone();
        let answers = gpu.guarded_async("answering probes", async || self.probe_unguarded(frame, points).await).await;
        self.or_forget(answers)
    }

    async fn render_unguarded(&mut self, frame: &Frame<'_>, outputs: Outputs) -> Result<Rendered> {
        let gpu = self.gpu.clone();
        self.make_targets(outputs)?;
        let mut prepared = Prepared { every_map: outputs.maps, ..self.prepare(frame, true)? };
        prepared.is_through_mask = outputs.picture && self.prepare_lit(frame, prepared.origin)?;
        let mut clock = Clock::start(&gpu, &self.timer);
        let samples = self.shadows.maps().config().filter.samples();
        if outputs.maps && samples > 1 {
            return Err(Error::MapsOfSamples { samples });
        }
        let (recorded, mut encoder) = self.record(new_encoder(&gpu), &mut clock, &prepared, outputs).await?;
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
        let edges = match &self.counts {
            Some(target) if outputs.edges => Some(Capture::record(&gpu, &mut encoder, &target.texture, 0, self.size)?),
            _ => None,
        };
        self.look(&mut encoder, frame.view, prepared.origin, outputs)?;
        self.timer.record(&mut encoder);
        let wall = clock.after_all(encoder).await?;

        let stats = self.stats(frame, &prepared, &recorded, &self.timer.read(&gpu).await?, wall);
        let [width, height] = self.size;
        const SIZED: &str = "a capture has as many bytes as its picture";
        let picture = read(&gpu, picture).await?;
        let mask = read(&gpu, mask).await?;
        let edges = read(&gpu, edges).await?;
        Ok(Rendered {
            picture: picture.map(|bytes| RgbaImage::from_raw(width, height, bytes).expect(SIZED)),
            // Visibility and hit are grey and alpha already.
            mask: mask.map(|bytes| GrayAlphaImage::from_raw(width, height, bytes).expect(SIZED)),
            maps: self.map_pictures(recorded.maps).await?,
            edges: edges
                .map(|bytes| EdgeCounts::read(self.size, &bytemuck::pod_collect_to_vec::<u8, [u16; 4]>(&bytes))),
            stats,
        })
    }

    /// Makes the textures that are drawn to, when they are first needed.
    fn make_targets(&mut self, outputs: Outputs) -> Result<()> {
        if outputs.picture {
            let target = self.picture.get_or_insert_with(|| PictureTarget::new(&self.gpu, self.size, self.samples));
            target.keeps_depth = self.shadows.config().fit_to == FitTo::Depth;
        }
        if outputs.mask && self.mask.is_none() {
            self.mask = Some(MaskTarget::new(&self.gpu, self.size, MASK_FORMAT));
        }
        if outputs.mask && self.is_deferred() && self.shadow_mask.is_none() {
            self.shadow_mask = Some(self.new_shadow_mask()?);
        }
        match outputs.edges && self.shadows.maps().edges().is_exact() {
            true if self.counts.is_none() => self.counts = Some(MaskTarget::new(&self.gpu, self.size, COUNTS_FORMAT)),
            true => {}
            false => self.counts = None,
        }
        Ok(())
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

    fn new_shadow_mask(&self) -> Result<ShadowMask> {
        let (device, maps) = (&self.gpu.device, self.shadows.maps());
        let layout = Names::layout_of_mask(&self.gpu);
        let runs = MaskRuns { wgsl: &umbrage_wgpu::stored_runs_wgsl(2, 0), layout: &layout };
        Ok(ShadowMask::with_runs(device, maps, MASK_FORMAT, MaskNormals::FromDepth, runs)?)
    }

    /// Replaces the mask by one computed from its depth alone.
    fn record_deferred_mask(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        target: &MaskTarget,
        shadow_mask: &ShadowMask,
        frame: &Frame<'_>,
        origin: DVec3,
    ) -> Result<()> {
        shadow_mask.prepare(&self.gpu.queue, &camera_of(frame.view, origin))?;
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
        let runs = self.names.group_of_mask(&self.gpu, &self.scene);
        if let Some(runs) = &runs {
            pass.set_bind_group(2, runs, &[]);
        }
        shadow_mask.draw(&mut pass, self.shadows.maps(), &group);
        Ok(())
    }

    /// Returns the splits' maps as pictures, nearest first.
    async fn map_pictures(&self, mut maps: Vec<MapCapture>) -> Result<Vec<GrayImage>> {
        maps.sort_by_key(|map| map.split);
        let format = self.shadows.maps().config().depth_format;
        let mut pictures = Vec::with_capacity(maps.len());
        for map in maps {
            let depths = maps::depths_of(&map.capture.read(&self.gpu).await?, format);
            let size = self.shadows.maps().map_size(map.split);
            pictures.push(maps::picture_of(&depths, map.row, map.corner, size));
        }
        Ok(pictures)
    }

    /// Returns whether masks are made from the picture's depth.
    fn is_deferred(&self) -> bool {
        self.shadows.maps().config().coordinates == Coordinates::Deferred
    }

    /// Returns whether an object is drawn into maps.
    pub(crate) fn casts(&self, object: &umbrage_scene::Object) -> bool {
        object.casts || self.dithered_nodes.get(object.node) == Some(&true)
    }
}

/// Returns the bytes of a capture, if there is one.
async fn read(gpu: &Gpu, capture: Option<Capture>) -> Result<Option<Vec<u8>>> {
    match capture {
        Some(capture) => capture.read(gpu).await.map(Some),
        None => Ok(None),
    }
}

/// Lists the fallbacks in use.
pub(crate) fn notes_of(shadows: &Shadows, contact: Option<&Contact>, timer: &Timer) -> Vec<String> {
    let mut notes = shadows.notes().to_vec();
    if shadows.config().look.contact && contact.is_none() {
        notes.push("no loads from depth textures on GL: no contact shadows".to_owned());
    }
    if !timer.has_timestamps() {
        let instead =
            if waiting::BLOCKS { "times of the GPU are measured by the CPU's clock" } else { "no times of passes" };
        notes.push(format!("no timestamp queries: {instead}"));
    }
    notes
}

/// Returns, for each node of a scene, whether its translucent surfaces cast shadows; empty if none
/// do.
pub(crate) fn dithered_nodes(scene: &Scene, config: &ShadowConfig) -> Vec<bool> {
    match config.look.translucent {
        Translucent::None => Vec::new(),
        Translucent::Dithered => scene.nodes.iter().map(|node| node.cast_shadow).collect(),
    }
}
