//! `umbrage render`: the picture, its mask, its maps, its report.

use std::{io::Cursor, path::Path};

use image::{DynamicImage, ImageBuffer, ImageFormat, Pixel};
use umbrage::{ShadowPlan, View};
use umbrage_render::{Frame, FrameStats, Gpu, GpuOptions, Outputs, RenderSettings, Renderer, SplitStats};

use crate::{
    adapter,
    args::{Filter, RenderArgs},
    failure::{Failure, Result},
    lights::{self, LightReport, NamedLight},
    notes,
    output::{self, Staged, numbered_file, numbered_folder},
    progress,
    report::{BesideReport, Report, SplitReport, TimesMs, to_json},
    scene_job::SceneJob,
    shadow_job::{ShadowJob, typed_name, wgpu_depth_format, wgpu_filter},
    split_views,
    stage::{Shot, Stage, camera_report},
};

/// Runs the subcommand.
pub fn run(args: &RenderArgs) -> Result<()> {
    let job = SceneJob::new(&args.scene)?;
    let shadows = ShadowJob::new(&args.shadows, job.size)?;
    let files: Vec<&Path> =
        [&args.picture, &args.visibility, &args.report].into_iter().flatten().map(AsRef::as_ref).collect();
    let folders: Vec<&Path> = args.maps.iter().chain(&args.split_views).map(AsRef::as_ref).collect();
    if files.is_empty() && folders.is_empty() {
        return Err(Failure::input(
            "nothing to write: give -o PICTURE, --visibility MASK, --maps DIR, --split-views DIR or --report JSON",
        ));
    }
    output::check(&files, &folders, &job.inputs())?;

    let stage = Stage::open_views(&job)?;
    if args.maps.is_some() && stage.shots.iter().any(|shot| !shot.beside.is_empty()) {
        return Err(Failure::input("--maps and several cameras: maps are of one view; name one --camera"));
    }
    if args.split_views.is_some() && shadows.settings.bands == umbrage::Bands::Radial {
        return Err(Failure::input(
            "--split-views and --bands radial exclude each other: each picture lies between two planes; leave one of them away",
        ));
    }
    if args.split_views.is_some() && stage.shots.iter().any(|shot| !shot.beside.is_empty()) {
        return Err(Failure::input("--split-views and several cameras: splits are of one view; name one --camera"));
    }
    let mut studio = Studio::open(&job, &shadows, &stage)?;
    // Views of splits are planned one by one and must not disturb what the frames' own maps hold on to.
    let mut beside = args.split_views.as_ref().map(|_| Studio::open(&job, &shadows, &stage)).transpose()?;
    let outputs = Outputs {
        picture: args.picture.is_some(),
        mask: args.visibility.is_some(),
        maps: args.maps.is_some(),
        deferred: shadows.deferred,
    };
    let mut staged = Staged::default();
    let bar = progress::steps(stage.shots.len() as u64, "frames");
    for shot in &stage.shots {
        let frames: Vec<Frame<'_>> = shot.views().map(|(_, view)| studio.frame(&stage, shot, view)).collect();
        let mut views = studio.renderer.render_views(&frames, shot.shown.as_ref(), outputs)?;
        notes::say(shadows.notes.iter().chain(&views[0].stats.notes));
        let pictures: Vec<_> = views.iter_mut().filter_map(|view| view.picture.take()).collect();
        if let (Some(path), false) = (&args.picture, pictures.is_empty()) {
            staged.file(&numbered_file(path, shot.frame), png(&side_by_side(pictures))?)?;
        }
        let masks: Vec<_> = views.iter_mut().filter_map(|view| view.mask.take()).collect();
        if let (Some(path), false) = (&args.visibility, masks.is_empty()) {
            staged.file(&numbered_file(path, shot.frame), png(&side_by_side(masks))?)?;
        }
        if let Some(path) = &args.maps {
            let maps = views[0].maps.iter().enumerate();
            let files = maps.map(|(split, map)| Ok((format!("split{split}.png"), png(map)?))).collect::<Result<_>>()?;
            staged.folder(&numbered_folder(path, shot.frame), files)?;
        }
        if let (Some(path), Some(beside)) = (&args.split_views, &mut beside) {
            let files = split_views::pictures(&mut beside.renderer, &frames[0], &views[0].stats.plan.splits)?;
            staged.folder(&numbered_folder(path, shot.frame), files)?;
        }
        if let Some(path) = &args.report {
            let mut report = studio.report(&job, &stage, shot, &views[0].stats);
            let beside = shot.beside.iter().zip(&views[1..]);
            report.beside = beside.map(|((camera, view), of)| beside_report(&stage, camera, view, &of.stats)).collect();
            staged.file(&numbered_file(path, shot.frame), to_json(&report)?)?;
        }
        bar.inc(1);
    }
    bar.finish_and_clear();
    staged.commit()
}

/// A renderer set up as the options say; `render` and `probe` share it.
pub struct Studio<'a> {
    /// Draws and probes.
    pub renderer: Renderer,
    shadows: &'a ShadowJob,
    adapter: String,
}

impl<'a> Studio<'a> {
    /// Opens the device and loads the scene onto it.
    pub fn open(job: &SceneJob, shadows: &'a ShadowJob, stage: &Stage) -> Result<Self> {
        lights::check_filter(&stage.lights, shadows.filter)?;
        lights::check_coordinates(&stage.lights, shadows.coordinates)?;
        let gpu = Gpu::new(&GpuOptions::default())?;
        let settings = RenderSettings {
            size: job.size,
            shadows: shadows.settings.clone(),
            filter: wgpu_filter(shadows.filter),
            depth_format: wgpu_depth_format(shadows.depth_format),
            samples: umbrage_render::Samples::default(),
            softness: shadows.softness(job.sun_angle),
            transition: shadows.transition(),
            moments: shadows.moments(),
            look: shadows.look(),
            coordinates: shadows.coordinates,
            storage: shadows.storage,
            generation: shadows.generation,
            lights: lights::slots(&stage.lights),
        };
        let renderer = Renderer::new(&gpu, &stage.scene, &settings)?;
        Ok(Self { renderer, shadows, adapter: adapter::description(&gpu) })
    }

    /// What the renderer is told about one view of a shot.
    pub fn frame<'s>(&self, stage: &'s Stage, shot: &Shot, view: &'s View) -> Frame<'s> {
        stage.frame(shot, view, self.shadows.shadows_on, self.shadows.tint)
    }

    /// What was done and what it cost.
    pub fn report(&self, job: &SceneJob, stage: &Stage, shot: &Shot, stats: &FrameStats) -> Report {
        let mut shot = stage.report(job, shot);
        shot.lights = light_reports(stage, stats);
        Report {
            shot,
            adapter: self.adapter.clone(),
            technique: typed_name(self.shadows.technique),
            generation: stats.generation.to_string(),
            storage: stats.storage.to_string(),
            filter: typed_name(self.shadows.filter),
            filter_width: self.shadows.filter_width,
            sun_angle: (self.shadows.filter == Filter::Pcss)
                .then(|| f64::from(self.shadows.softness(job.sun_angle).sun_angle).to_degrees()),
            transition: typed_name(self.shadows.transition),
            bias: typed_name(self.shadows.bias),
            translucent: typed_name(self.shadows.translucent),
            contact_shadows: self.shadows.contact_shadows,
            shadow_strength: self.shadows.shadow_strength,
            shadow_colour: self.shadows.shadow_colour.to_array(),
            fit: typed_name(self.shadows.fit),
            bands: typed_name(self.shadows.bands),
            scheme: typed_name(self.shadows.scheme),
            stabilize: typed_name(self.shadows.stabilize),
            warp: self.shadows.warps.iter().map(|&warp| typed_name(warp)).collect(),
            planes_m: stats.plan.planes.clone(),
            times_ms: TimesMs { plan: stats.plan_ms, shadow: stats.shadow_ms, frame: stats.frame_ms },
            bytes: stats.bytes,
            draws: u64::from(stats.shadow_draws),
            triangles: stats.shadow_triangles,
            splits: stats.splits.iter().map(split_report).collect(),
            beside: Vec::new(),
            probe: None,
            notes: stage.notes.iter().chain(&self.shadows.notes).chain(&stats.notes).cloned().collect(),
        }
    }
}

/// All lights with their splits.
fn light_reports(stage: &Stage, stats: &FrameStats) -> Vec<LightReport> {
    let others = stats.more_lights.iter().map(|light| (&light.plan, &light.splits));
    let all = [(&stats.plan, &stats.splits)].into_iter().chain(others);
    let report = |(light, (plan, splits)): (&NamedLight, (&ShadowPlan, &Vec<SplitStats>))| LightReport {
        planes_m: plan.planes.clone(),
        splits: splits.iter().map(split_report).collect(),
        ..light.report()
    };
    stage.lights.iter().zip(all).map(report).collect()
}

fn beside_report(stage: &Stage, camera: &str, view: &View, stats: &FrameStats) -> BesideReport {
    BesideReport {
        camera: camera_report(camera, view),
        planes_m: stats.plan.planes.clone(),
        times_ms: TimesMs { plan: stats.plan_ms, shadow: stats.shadow_ms, frame: stats.frame_ms },
        lights: light_reports(stage, stats),
    }
}

/// Pictures of one height beside each other; there is one at least.
#[must_use]
pub fn side_by_side<P: Pixel>(mut pictures: Vec<ImageBuffer<P, Vec<P::Subpixel>>>) -> ImageBuffer<P, Vec<P::Subpixel>> {
    if pictures.len() == 1 {
        return pictures.remove(0);
    }
    let width = pictures.iter().map(ImageBuffer::width).sum();
    let height = pictures.iter().map(ImageBuffer::height).max().unwrap_or(0);
    let mut all = ImageBuffer::new(width, height);
    let mut left = 0;
    for picture in &pictures {
        image::imageops::replace(&mut all, picture, left, 0);
        left += i64::from(picture.width());
    }
    all
}

fn split_report(split: &SplitStats) -> SplitReport {
    SplitReport {
        near: split.near,
        far: split.far,
        texel_m: split.texel_m,
        warped: split.warped,
        casters: split.casters as u64,
        draws: u64::from(split.draws),
        triangles: split.triangles,
        bytes: split.bytes,
    }
}

/// A picture as the bytes of a PNG.
pub fn png<I>(picture: &I) -> Result<Vec<u8>>
where
    I: Clone + Into<DynamicImage>,
{
    let mut bytes = Cursor::new(Vec::new());
    let picture: DynamicImage = picture.clone().into();
    picture
        .write_to(&mut bytes, ImageFormat::Png)
        .map_err(|error| Failure::other(format!("the picture cannot be written as PNG: {error}")))?;
    Ok(bytes.into_inner())
}

/// No adapter and a failing device are nobody's bad input; everything else names an option or the scene.
impl From<umbrage_render::Error> for Failure {
    fn from(error: umbrage_render::Error) -> Self {
        use umbrage_render::Error as E;
        match error {
            E::NoAdapter { .. } | E::NoDevice { .. } | E::Device { .. } | E::OutOfMemory { .. } => {
                Self::other(error.to_string())
            }
            E::Plan(error) => error.into(),
            E::ImageSize { .. } => Self::input(format!("--size: {error}")),
            E::MapSize { .. } => Self::input(format!("--map-size: {error}")),
            E::Shadows(error) => Self::input(crate::paths::in_options(&error)),
            E::Probe { .. } => Self::input(format!("--points: {error}")),
            _ => Self::input(error.to_string()),
        }
    }
}

/// What the loader refuses is a file or an option.
impl From<umbrage_scene::Error> for Failure {
    fn from(error: umbrage_scene::Error) -> Self {
        match error {
            umbrage_scene::Error::View(error) => error.into(),
            _ => Self::input(error.to_string()),
        }
    }
}
