//! Set-up of the tests: a device, the four worlds, and techniques by name.

use std::io::Write;
use std::sync::OnceLock;

use image::GrayAlphaImage;
use umbrage::config::{Crop, DepthFormat, Filter, Preset, Range, ShadowConfig, Stability, Transition};
use umbrage::{DirectionalLight, View, Warp};
use umbrage_render::{Frame, Gpu, GpuOptions, Outputs, RenderSettings, Rendered, Renderer};
use umbrage_scene::procedural::World;
use umbrage_scene::{Pose, Scene, camera_view, light_direction};

/// Returns the device that all tests of a binary share, or `None` with a warning if there is no
/// adapter.
///
/// # Panics
/// If there is no adapter and the environment variable `UMBRAGE_REQUIRE_GPU` is 1.
pub fn gpu() -> Option<&'static Gpu> {
    static GPU: OnceLock<Option<Gpu>> = OnceLock::new();
    GPU.get_or_init(|| match Gpu::new(&GpuOptions::default()) {
        Ok(gpu) => Some(gpu),
        Err(error) if std::env::var("UMBRAGE_REQUIRE_GPU").is_ok_and(|value| value == "1") => {
            panic!("UMBRAGE_REQUIRE_GPU is 1, but {error}")
        }
        Err(error) => {
            // Not eprintln: the test harness would keep it to itself, as the tests pass.
            writeln!(std::io::stderr(), "SKIPPED: no adapter: {error}").expect("standard error can be written to");
            None
        }
    })
    .as_ref()
}

/// A world at time 0 under its own sun.
#[derive(Debug)]
pub struct Stage {
    /// Name of the world.
    pub world: World,
    /// Scene of the world.
    pub scene: Scene,
    /// Pose of the scene at time 0.
    pub pose: Pose,
    /// Sun of the world at time 0.
    pub sun: DirectionalLight,
}

impl Stage {
    /// Returns a world, which is built when it is first asked for.
    ///
    /// # Panics
    /// If the world has no pose or no sun, which would be a mistake in the world.
    pub fn of(world: World) -> &'static Self {
        static STAGES: [OnceLock<Stage>; 4] = [const { OnceLock::new() }; 4];
        let index = World::PAPER.iter().position(|&other| other == world).expect("all worlds are in the list");
        STAGES[index].get_or_init(|| {
            let scene = world.build();
            let pose = scene.pose(0.0).expect("a world has a pose");
            let travel = light_direction(&scene, &pose, 0).expect("a world has a sun");
            Self { world, sun: DirectionalLight::new(travel).expect("a direction"), pose, scene }
        })
    }

    /// Returns the view of one of the world's cameras.
    ///
    /// # Panics
    /// If the world has no camera of that name.
    #[must_use]
    pub fn view(&self, camera: &str, size: [u32; 2]) -> View {
        let index = self.scene.cameras.iter().position(|other| other.name == camera);
        let index = index.unwrap_or_else(|| panic!("{} has no camera {camera}", self.world.name()));
        let aspect = f64::from(size[0]) / f64::from(size[1]);
        camera_view(&self.scene, &self.pose, index, aspect, None, None).expect("a world's camera is usable")
    }

    /// Makes a renderer's frame of a view.
    #[must_use]
    pub fn frame<'a>(&'a self, view: &'a View, tint: bool) -> Frame<'a> {
        Frame { pose: &self.pose, moved: None, view, light: self.sun.into(), more_lights: &[], shadows_on: true, tint }
    }

    /// Returns the view depths that the world's cameras show, in metres.
    #[must_use]
    pub fn range(&self) -> Range {
        let (near, far) = self.world.near_far();
        Range::Metres { near, far }
    }

    /// Makes a renderer of this world by a technique, at a size in pixels.
    ///
    /// # Panics
    /// If the device cannot hold it.
    #[must_use]
    pub fn drawer<'a>(&'a self, gpu: &Gpu, technique: &Technique, size: [u32; 2]) -> Drawer<'a> {
        let mut settings = technique.settings.clone();
        settings.size = size;
        settings.config.range = self.range();
        let renderer = Renderer::new(gpu, &self.scene, &settings).expect("the device holds a world");
        Drawer { stage: self, renderer }
    }
}

/// A renderer of a world by one technique.
pub struct Drawer<'a> {
    /// The world.
    pub stage: &'a Stage,
    /// Renderer that uses the technique.
    pub renderer: Renderer,
}

impl Drawer<'_> {
    /// Draws a view without any state of earlier frames.
    ///
    /// # Panics
    /// If it cannot be drawn.
    pub fn draw(&mut self, view: &View, outputs: Outputs, tint: bool) -> Rendered {
        self.renderer.restart();
        self.renderer.render(&self.stage.frame(view, tint), outputs).expect("a frame")
    }

    /// Draws the mask of a view.
    ///
    /// # Panics
    /// If it cannot be drawn.
    pub fn mask(&mut self, view: &View) -> GrayAlphaImage {
        let outputs = Outputs { mask: true, ..Outputs::default() };
        self.draw(view, outputs, false).mask.expect("a mask was asked for")
    }
}

/// Render settings with a name.
#[derive(Clone, Debug)]
pub struct Technique {
    /// Name for tables and file names.
    pub name: String,
    /// Settings of the renderer.
    pub settings: RenderSettings,
}

impl Default for Technique {
    /// Makes the technique of a user who chooses nothing.
    fn default() -> Self {
        Self::configured("default", ShadowConfig::default())
    }
}

impl Technique {
    /// Makes PSSM with maps of one size: practical scheme with λ = 0.5, fitted to the scene, not
    /// stabilised, one nearest texel, no blend, no fade, 32-bit depth. It is the tightest, hardest
    /// and most exact technique, so that nothing hides an error.
    #[must_use]
    pub fn pssm(splits: usize, map_size: u32) -> Self {
        let config = ShadowConfig {
            map_sizes: vec![map_size; splits],
            crop: Crop::SceneDependent,
            stability: Stability::tight(),
            transition: Transition::Hard,
            far_fade: 0.0,
            filter: Filter::Hard,
            ..Preset::Papers.config()
        };
        let settings = RenderSettings { size: [1, 1], config, ..RenderSettings::default() };
        Self { name: format!("pssm{splits}"), settings }
    }

    /// Makes one map over the whole range, otherwise as [`Technique::pssm`].
    #[must_use]
    pub fn ssm(map_size: u32) -> Self {
        Self { name: "ssm".to_owned(), ..Self::pssm(1, map_size) }
    }

    /// Makes the preset `papers`: four maps, exact stillness, 3 × 3 filter, blend and fade.
    #[must_use]
    pub fn papers() -> Self {
        Self::configured("papers", Preset::Papers.config())
    }

    fn configured(name: &str, config: ShadowConfig) -> Self {
        Self { name: name.to_owned(), settings: RenderSettings { config, ..Self::pssm(4, 1024).settings } }
    }

    /// Replaces the filter.
    #[must_use]
    pub fn filter(mut self, filter: Filter) -> Self {
        self.settings.config.filter = filter;
        self.named(filter.word())
    }

    /// Warps all maps.
    #[must_use]
    pub fn warped(mut self, warp: Warp) -> Self {
        self.settings.config.stability = Stability::Tight { warps: vec![warp] };
        self.named(match warp {
            Warp::None => "plain",
            Warp::Psm => "psm",
            Warp::Lispsm => "lispsm",
            Warp::Tsm { .. } => "tsm",
        })
    }

    /// Stabilises the maps exactly.
    #[must_use]
    pub fn exact(mut self) -> Self {
        self.settings.config.stability = Stability::Exact;
        self.named("exact")
    }

    /// Fits maps to the slices alone.
    #[must_use]
    pub fn independent(mut self) -> Self {
        self.settings.config.crop = Crop::SceneIndependent;
        self.named("independent")
    }

    /// Stores depth in 16 bits.
    #[must_use]
    pub fn d16(mut self) -> Self {
        self.settings.config.depth_format = DepthFormat::D16Unorm;
        self.named("d16")
    }

    /// Blends splits into each other and fades shadows at the far end.
    #[must_use]
    pub fn blended(mut self, blend: f64, far_fade: f64) -> Self {
        self.settings.config.transition = Transition::Blend { share: blend };
        self.settings.config.far_fade = far_fade;
        self.named("blend")
    }

    fn named(mut self, part: &str) -> Self {
        self.name = format!("{}-{part}", self.name);
        self
    }
}
