//! The task that traces rays beside the window: true shadows, texel density, and the point that was
//! clicked.

use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::mpsc::{Receiver, channel};

use futures_channel::mpsc::{UnboundedReceiver, UnboundedSender, unbounded};
use glam::{DVec2, DVec3};
use image::{Rgba, RgbaImage};
use umbrage::config::Selection;
use umbrage::{Bias, Frustum, ShadowPlan, Split, View};
use umbrage_render::EdgeSums;
use umbrage_truth::scores::{Answers, Domain, TexelGradient, acne_and_leak};
use umbrage_truth::{Hit, Truth, TruthMask};

use crate::platform;
use crate::studio::{Drawn, Shot};

/// Overlay over the picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Overlay {
    /// Texel density: the number of texels of its map per pixel.
    Density,
    /// Errors of the shadows.
    Errors,
    /// Triangle tests of exact edges.
    Tests,
}

/// Question for the judge.
#[derive(Clone, Debug)]
pub enum Question {
    /// Request for an overlay of the first picture.
    Overlay(Arc<Drawn>, Overlay),
    /// Request for the surface at a point of the picture, in shares of its width and height.
    Pick(Arc<Drawn>, DVec2),
}

/// An overlay with its numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct Laid {
    /// Shot that the overlay belongs to.
    pub shot: Shot,
    /// Kind of the overlay.
    pub overlay: Overlay,
    /// Image of the picture's size, transparent where the overlay has no value.
    pub picture: RgbaImage,
    /// Numbers of the overlay.
    pub sums: Sums,
}

/// Numbers of an overlay.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Sums {
    /// Texels per pixel: the median and the lowest hundredth.
    Density {
        /// Median of texels per pixel.
        median: f64,
        /// First percentile of texels per pixel.
        lowest: f64,
    },
    /// Counts of exact edges.
    Tests(EdgeSums),
    /// Shares of the pixels that face the light within the shadowed range.
    Errors {
        /// Share of pixels that are dark though nothing blocks the light and no edge is near.
        acne: f64,
        /// Share of pixels that are lit though something blocks the light and no edge is near.
        leak: f64,
        /// Share of pixels that are wrong so near to a true edge that the map's resolution explains
        /// it.
        at_edges: f64,
        /// Number of pixels that are judged.
        pixels: usize,
    },
}

/// Surface at a clicked point of the picture.
#[derive(Clone, Debug)]
pub struct Picked {
    /// Picture that was clicked.
    pub drawn: Arc<Drawn>,
    /// Position of the click, in shares of the picture.
    pub at: DVec2,
    /// Surface at the point; `None` in the sky.
    pub surface: Option<Surface>,
}

/// A surface that was clicked.
#[derive(Clone, Debug, PartialEq)]
pub struct Surface {
    /// World position in metres.
    pub position: DVec3,
    /// Geometric normal, turned towards the eye.
    pub normal: DVec3,
    /// View depth in metres.
    pub depth: f64,
    /// Index into the pose's objects.
    pub object: usize,
    /// True if the first light truly reaches the point.
    pub lit: bool,
    /// First object that truly blocks the light, and its distance in metres.
    pub blocker: Option<(usize, f64)>,
    /// Lookup of the point in each map of the first light that contains it.
    pub maps: Vec<MapLook>,
}

/// Lookup of a point in one map.
#[derive(Clone, Debug, PartialEq)]
pub struct MapLook {
    /// Index of the split.
    pub split: usize,
    /// Position in the map, in texels from the upper left.
    pub texel: DVec2,
    /// Edges of the texel at the point, in metres.
    pub texel_m: DVec2,
    /// Bias at the point: the distance towards the light, in metres, within which a stored surface
    /// does not shade it.
    pub bias: Bias,
    /// First object on the ray through the texel's centre, and its distance in metres in front of
    /// the receiver's plane at that texel.
    pub stored: Option<(usize, f64)>,
}

/// Answer of the judge.
#[derive(Debug)]
pub enum Finding {
    /// An overlay.
    Laid(Box<Laid>),
    /// The surface that was clicked.
    Picked(Box<Picked>),
    /// Reason why there is no answer.
    Failed(String),
}

/// Handle of the task that traces rays.
#[derive(Debug)]
pub struct Judge {
    questions: UnboundedSender<Question>,
    findings: Receiver<Finding>,
    progress: Arc<AtomicU32>,
}

/// Steps of the progress that make up the whole.
const WHOLE: u32 = 1000;

impl Judge {
    /// Starts the task. `wake` is called when there is a new finding.
    ///
    /// # Errors
    /// If the system has no thread left.
    pub fn start(wake: impl Fn() + Send + Sync + 'static) -> std::io::Result<Self> {
        let (questions, mut inbox) = unbounded();
        let (outbox, findings) = channel();
        let progress = Arc::new(AtomicU32::new(0));
        let shared = Arc::clone(&progress);
        let work = async move || {
            let mut court = Court { truth: None, progress: shared, wake: Box::new(wake) };
            while let Some(question) = latest(&mut inbox).await {
                court.progress.store(0, Ordering::Relaxed);
                // Where there is one thread for all, it shows first that this is under way.
                platform::pause().await;
                let finding = court.answer(question).await.unwrap_or_else(Finding::Failed);
                drop(outbox.send(finding));
                (court.wake)();
            }
        };
        platform::spawn("judge", work)?;
        Ok(Self { questions, findings, progress })
    }

    /// Asks a question. Returns false if the task has ended.
    #[must_use]
    pub fn ask(&self, question: Question) -> bool {
        self.questions.unbounded_send(question).is_ok()
    }

    /// Returns the new findings.
    pub fn findings(&self) -> impl Iterator<Item = Finding> + '_ {
        self.findings.try_iter()
    }

    /// Returns the share of the question that is done, 0 to 1.
    #[must_use]
    pub fn progress(&self) -> f32 {
        self.progress.load(Ordering::Relaxed) as f32 / WHOLE as f32
    }
}

/// Returns the last waiting question. A click is not dropped for an overlay.
async fn latest(inbox: &mut UnboundedReceiver<Question>) -> Option<Question> {
    let mut question = inbox.recv().await.ok()?;
    while let Ok(next) = inbox.try_recv() {
        if matches!((&question, &next), (Question::Pick(..), Question::Overlay(..))) {
            continue;
        }
        question = next;
    }
    Some(question)
}

struct Court {
    /// Truth of a scene at a time, with the scene's id and the time.
    truth: Option<(u64, f64, Truth)>,
    progress: Arc<AtomicU32>,
    wake: Box<dyn Fn() + Send + Sync>,
}

impl Court {
    async fn answer(&mut self, question: Question) -> Result<Finding, String> {
        match question {
            Question::Overlay(drawn, overlay) => {
                self.lay(&drawn, overlay).await.map(|laid| Finding::Laid(Box::new(laid)))
            }
            Question::Pick(drawn, at) => {
                let surface = self.surface(&drawn, at)?;
                Ok(Finding::Picked(Box::new(Picked { drawn, at, surface })))
            }
        }
    }

    fn truth(&mut self, drawn: &Drawn) -> Result<&Truth, String> {
        let key = (drawn.stage.id, drawn.shot.time_s);
        if self.truth.as_ref().is_none_or(|(id, time, _)| (*id, *time) != key) {
            // The former tree may be large.
            self.truth = None;
            let truth = Truth::build(&drawn.stage.scene, &drawn.pose, drawn.shot.view.eye())
                .map_err(|error| error.to_string())?;
            self.truth = Some((key.0, key.1, truth));
        }
        self.truth.as_ref().map(|(.., truth)| truth).ok_or_else(|| "there is no tree of the scene".to_owned())
    }

    async fn lay(&mut self, drawn: &Drawn, overlay: Overlay) -> Result<Laid, String> {
        if overlay == Overlay::Tests {
            // Counted with the picture: no ray is needed.
            let counts = drawn.taken.first().and_then(|taken| taken.edges.as_ref());
            let counts = counts.ok_or("edges are sampled and test no triangle; choose edges exact")?;
            let sums = Sums::Tests(counts.sums());
            return Ok(Laid { shot: drawn.shot.clone(), overlay, picture: counts.picture(), sums });
        }
        let progress = Arc::clone(&self.progress);
        self.truth(drawn)?;
        let Some((.., truth)) = &self.truth else { return Err("there is no tree of the scene".to_owned()) };
        let light = drawn.lights.first().map(|light| light.lamp.light).ok_or("the scene has no light")?;
        let wake = &self.wake;
        let heard = |done: f32| {
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a share of a thousand")]
            let now = (done.clamp(0.0, 1.0) * WHOLE as f32) as u32;
            // Not for every row: the window draws its bar in steps of a twentieth.
            if progress.fetch_max(now, Ordering::Relaxed) / 50 < now / 50 {
                wake();
            }
        };
        let view = &drawn.shot.view;
        let traced = platform::mask(truth, view, &light, drawn.shot.size, &heard).await;
        let traced = traced.map_err(|error| error.to_string())?;
        let taken = drawn.taken.first().ok_or("there is no picture to judge")?;
        let (picture, sums) = match overlay {
            Overlay::Density => density(view, &traced, &taken.stats.plan, drawn.shot.size),
            Overlay::Errors => {
                let mask = taken.mask.as_ref().ok_or("there is no mask to judge")?;
                errors(view, &traced, &taken.stats.plan, &Answers::from_mask(mask))?
            }
            Overlay::Tests => return Err("triangles are counted and not traced".to_owned()),
        };
        Ok(Laid { shot: drawn.shot.clone(), overlay, picture, sums })
    }

    fn surface(&mut self, drawn: &Drawn, at: DVec2) -> Result<Option<Surface>, String> {
        let light = drawn.lights.first().map(|light| light.lamp.light).ok_or("the scene has no light")?;
        let pixel = pixel_view(&drawn.shot.view, drawn.shot.size, at)?;
        let plan = drawn.taken.first().map(|taken| Arc::clone(&taken.stats.plan)).ok_or("there is no picture")?;
        let truth = self.truth(drawn)?;
        let mask = truth.mask_under(&pixel, &light, [1, 1], &|_| ()).map_err(|error| error.to_string())?;
        let Some(hit) = mask.hits()[0] else { return Ok(None) };
        let to_light = light.to_light(hit.position);
        let distance = light.position().map_or(f64::MAX, |position| position.distance(hit.position));
        let blocker = if hit.lit || hit.normal.dot(to_light) <= 0.0 {
            None
        } else {
            // A little above the surface: the truth knows which triangle is its own, a plain ray
            // does not.
            let lifted = hit.position + hit.normal * 1e-6 * (1.0 + hit.depth);
            truth.first_caster(lifted, to_light, distance).map_err(|error| error.to_string())?
        };
        let looks = plan.splits.iter().enumerate().filter(|(_, split)| split.contains(hit.position, 0.0));
        let maps = looks.map(|(index, split)| map_look(truth, index, split, &hit)).collect::<Result<_, _>>()?;
        Ok(Some(Surface {
            position: hit.position,
            normal: hit.normal,
            depth: drawn.shot.view.view_depth(hit.position),
            object: hit.object as usize,
            lit: hit.lit,
            blocker: blocker.map(|hit| (hit.object as usize, hit.depth)),
            maps,
        }))
    }
}

/// Returns the view through one pixel.
fn pixel_view(view: &View, size: [u32; 2], at: DVec2) -> Result<View, String> {
    let lens = *view.frustum();
    let [width, height] = size.map(f64::from);
    let column = (at.x.clamp(0.0, 1.0) * width).floor().min(width - 1.0);
    let row = (at.y.clamp(0.0, 1.0) * height).floor().min(height - 1.0);
    let across = |share: f64| lens.left + (lens.right - lens.left) * share / width;
    let down = |share: f64| lens.top + (lens.bottom - lens.top) * share / height;
    let pixel =
        Frustum { left: across(column), right: across(column + 1.0), top: down(row), bottom: down(row + 1.0), ..lens };
    view.with_frustum(pixel).map_err(|error| error.to_string())
}

/// Looks up a point in one map.
fn map_look(truth: &Truth, index: usize, split: &Split, hit: &Hit) -> Result<MapLook, String> {
    let at = split.map_from_world(hit.position);
    let texel = DVec2::new(at.x, at.y);
    let centre = texel.floor() + 0.5;
    // The ray of light through the texel's centre, from depth 0 to depth 1.
    let half = 0.5 * f64::from(split.size);
    let world_from_shadow = split.shadow_from_world().inverse();
    let along = |depth: f64| {
        let ndc = DVec3::new(centre.x / half - 1.0, 1.0 - centre.y / half, depth);
        world_from_shadow.project_point3(ndc)
    };
    let (from, to) = (along(0.0), along(1.0));
    let first = truth.first_caster(from, to - from, from.distance(to)).map_err(|error| error.to_string())?;
    // The receiver's plane, continued to the texel's centre: what an exact map of a flat surface
    // would store.
    let direction = (to - from).normalize_or_zero();
    let facing = hit.normal.dot(direction);
    let plane = if facing.abs() > 1e-6 { hit.normal.dot(hit.position - from) / facing } else { f64::NAN };
    let bias_normal = if facing > 0.0 { -hit.normal } else { hit.normal };
    Ok(MapLook {
        split: index,
        texel,
        texel_m: split.texel_size_m(hit.position),
        bias: split.bias_at(hit.position, bias_normal),
        stored: first.map(|first| (first.object as usize, plane - first.depth)),
    })
}

/// Returns the split whose map is read for a visible point.
#[must_use]
pub fn answering(plan: &ShadowPlan, point: DVec3) -> Option<&Split> {
    match plan.selection {
        Selection::Map => plan.splits.iter().find(|split| split.contains(point, split.filter_radius_texels)),
        Selection::Interval(_) => {
            let depth = plan.depth_at(point);
            let faces = plan.faces();
            let per_face = plan.splits.len() / faces.max(1);
            let face = plan.light.map_or(0, |light| light.face_of(point));
            plan.splits.iter().skip(face * per_face).take(per_face).find(|split| depth <= split.far)
        }
    }
}

fn gradient(plan: &ShadowPlan, point: DVec3) -> Option<TexelGradient> {
    let split = answering(plan, point)?;
    let [u, v] = split.texel_jacobian(point);
    Some(TexelGradient { u, v, width: split.texel_size_m(point).max_element() })
}

/// Colour of a number of texels per pixel, on a scale of doublings below and above 1.
#[must_use]
pub fn density_colour(texels_per_pixel: f64) -> [u8; 3] {
    // Blue is enough, yellow is just enough, red is coarse: told apart by the colour-blind too.
    const STOPS: [(f64, [f64; 3]); 5] = [
        (-3.0, [150.0, 0.0, 40.0]),
        (-1.0, [235.0, 90.0, 40.0]),
        (0.0, [250.0, 225.0, 90.0]),
        (1.0, [120.0, 190.0, 220.0]),
        (3.0, [30.0, 70.0, 160.0]),
    ];
    let at = texels_per_pixel.max(1e-9).log2().clamp(STOPS[0].0, STOPS[4].0);
    let upper = STOPS.iter().position(|stop| stop.0 >= at).unwrap_or(4).max(1);
    let ((from, a), (to, b)) = (STOPS[upper - 1], STOPS[upper]);
    let share = (at - from) / (to - from);
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "between two bytes")]
    std::array::from_fn(|i| (a[i] + (b[i] - a[i]) * share).round() as u8)
}

const DENSITY_ALPHA: u8 = 165;

fn density(view: &View, traced: &TruthMask, plan: &ShadowPlan, size: [u32; 2]) -> (RgbaImage, Sums) {
    let mut all = Vec::new();
    let range = plan.planes.first().copied().unwrap_or(0.0)..=plan.planes.last().copied().unwrap_or(0.0);
    let picture = RgbaImage::from_fn(size[0], size[1], |x, y| {
        let hit = traced.hits()[(y * size[0] + x) as usize];
        let hit = hit.filter(|hit| range.contains(&plan.depth_at(hit.position)));
        let Some((hit, split)) = hit.and_then(|hit| Some((hit, answering(plan, hit.position)?))) else {
            return Rgba([0; 4]);
        };
        let texels = 1.0 / split.pixels_per_texel_at(view, size, hit.position, hit.normal);
        all.push(texels);
        let [r, g, b] = density_colour(texels);
        Rgba([r, g, b, DENSITY_ALPHA])
    });
    all.sort_unstable_by(f64::total_cmp);
    let at = |share: usize| all.get(all.len() * share / 100).copied().unwrap_or(f64::NAN);
    (picture, Sums::Density { median: at(50), lowest: at(1) })
}

/// Colours of errors: acne, leaks, and errors that an edge explains.
pub const ERROR_COLOURS: [[u8; 3]; 3] = [[40, 120, 255], [235, 40, 30], [245, 190, 60]];

fn errors(view: &View, traced: &TruthMask, plan: &ShadowPlan, answers: &Answers) -> Result<(RgbaImage, Sums), String> {
    let text = |error: umbrage_truth::Error| error.to_string();
    let range = match plan.planes[..] {
        [near, .., far] if far.is_finite() => (near, far),
        [near, ..] => (near, f64::MAX),
        [] => return Err("there is no shadowed range to judge".to_owned()),
    };
    let domain = Domain::new(traced, range).map_err(text)?;
    let counted = acne_and_leak(view, traced, &domain, answers, |point, _| gradient(plan, point)).map_err(text)?;
    let [width, height] = domain.size().map(|n| n as u32);
    let mut picture = RgbaImage::new(width, height);
    let mut paint = |pixel: usize, [r, g, b]: [u8; 3], alpha: u8| {
        let pixel = pixel as u32;
        picture.put_pixel(pixel % width, pixel / width, Rgba([r, g, b, alpha]));
    };
    let mut wrong = 0_usize;
    for &pixel in domain.pixels() {
        if answers.visibility()[pixel].is_none_or(|answer| (answer >= 0.5) != domain.lit(pixel)) {
            wrong += 1;
            paint(pixel, ERROR_COLOURS[2], 200);
        }
    }
    for &pixel in &counted.wrong {
        paint(pixel, ERROR_COLOURS[usize::from(!domain.lit(pixel))], 255);
    }
    let share = |count: usize| count as f64 / counted.pixels.max(1) as f64;
    let at_edges = share(wrong.saturating_sub(counted.acne + counted.leak));
    let sums = Sums::Errors { acne: share(counted.acne), leak: share(counted.leak), at_edges, pixels: counted.pixels };
    Ok((picture, sums))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coarse_is_red_and_fine_is_blue() {
        let [coarse, enough, fine] = [1.0 / 16.0, 1.0, 16.0].map(density_colour);
        assert!(coarse[0] > coarse[2] && fine[2] > fine[0]);
        assert_eq!(enough, [250, 225, 90]);
        assert_eq!(density_colour(f64::NAN), coarse, "no number is coarse, and no panic");
    }

    #[test]
    fn a_pixel_is_a_view_of_its_own() {
        let lens = Frustum::perspective(1.0, 2.0, 0.5, 100.0).expect("valid");
        let view = View::look_at_upright(DVec3::new(1.0, 2.0, 3.0), DVec3::ZERO, lens).expect("valid");
        for at in [DVec2::new(0.3, 0.6), DVec2::ZERO, DVec2::ONE, DVec2::splat(7.0)] {
            let pixel = pixel_view(&view, [80, 40], at).expect("a pixel");
            let (x, y) = ((at.x.min(0.999) * 80.0).floor() + 0.5, (at.y.min(0.999) * 40.0).floor() + 0.5);
            let (_, whole) = view.ray_through(x / 80.0, y / 40.0);
            let (_, own) = pixel.ray_through(0.5, 0.5);
            assert!((whole - own).length() < 1e-12, "{at}");
        }
    }
}
