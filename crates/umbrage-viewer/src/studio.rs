//! The studio: the task that draws, beside the window. On a desktop it is a thread with a graphics
//! device of its own, so that the window goes on however long a picture takes. It opens another
//! device if that one is lost. In a browser it is a task that draws with the window's device.

use std::future::poll_fn;
use std::pin::pin;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::task::Poll;
use std::time::Duration;

use futures_channel::mpsc::{UnboundedReceiver, UnboundedSender, unbounded};
use image::{GrayAlphaImage, GrayImage, RgbaImage};
use umbrage::{DirectionalLight, ShadowConfig, View};
use umbrage_lab::lights::{self, NamedLight};
use umbrage_render::{
    EdgeCounts, Frame, FrameStats, Gpu, GpuOptions, Lamp, Outputs, ProbeAnswer, ProbePoint, RenderSettings, Renderer,
    Samples,
};
use umbrage_scene::{Pose, Poser};
use web_time::Instant;

use crate::platform::{self, Movable};
use crate::stage::Stage;

/// Time without an order after which pipelines are made that a later order may need.
const IDLE: Duration = Duration::from_millis(1_000);

/// All inputs that a picture depends on.
#[derive(Clone, Debug, PartialEq)]
pub struct Shot {
    /// Id of the scene: [`Stage::id`].
    pub stage: u64,
    /// Time of the animations in seconds.
    pub time_s: f64,
    /// View of the eye.
    pub view: View,
    /// View that maps are planned for, if they are held while the eye moves on.
    pub planned_for: Option<View>,
    /// Sun that replaces the scene's own light; `None` keeps that light.
    pub sun: Option<DirectionalLight>,
    /// One config, or two that are compared.
    pub configs: Vec<ShadowConfig>,
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// True if splits are coloured.
    pub tint: bool,
    /// True if objects cast shadows.
    pub shadows_on: bool,
}

/// Outputs that are wanted beside the picture. They take time, and are asked for while nothing
/// moves.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Wants {
    /// True if the maps are wanted as pictures.
    pub maps: bool,
    /// True if the visibility of each pixel is wanted.
    pub mask: bool,
    /// True if counts of exact edges are wanted for each pixel.
    pub edges: bool,
    /// Point at which the maps are probed.
    pub probe: Option<ProbePoint>,
}

impl Wants {
    /// Returns whether the outputs `given` hold all that is wanted.
    #[must_use]
    pub fn are_met_by(&self, given: &Self) -> bool {
        let probe = self.probe.is_none() || self.probe == given.probe;
        (given.maps || !self.maps) && (given.mask || !self.mask) && (given.edges || !self.edges) && probe
    }

    /// Returns whether no output is wanted.
    #[must_use]
    pub fn is_nothing(&self) -> bool {
        *self == Self::default()
    }
}

/// An order for a picture.
#[derive(Clone, Debug)]
pub struct Order {
    /// The scene.
    pub stage: Arc<Stage>,
    /// Shot to draw.
    pub shot: Shot,
    /// Outputs that are wanted beside the picture.
    pub wants: Wants,
    /// Device to draw with, where the studio has none of its own.
    pub gpu: Option<Gpu>,
}

/// A picture drawn with one config.
#[derive(Debug)]
pub struct Taken {
    /// The picture.
    pub picture: RgbaImage,
    /// Visibility mask, if it was wanted.
    pub mask: Option<GrayAlphaImage>,
    /// Counts of exact edges, if they were wanted and edges are exact.
    pub edges: Option<EdgeCounts>,
    /// Pictures of the maps, if they were wanted.
    pub maps: Vec<GrayImage>,
    /// Statistics and plans.
    pub stats: FrameStats,
    /// Objects of the pose that the casters of plans refer to.
    pub casters: Vec<usize>,
    /// Answer of the maps at the probed point.
    pub answer: Option<ProbeAnswer>,
    /// Fallbacks, and settings that were changed to suit the lights.
    pub notes: Vec<String>,
}

/// Result of an order.
#[derive(Debug)]
pub struct Drawn {
    /// The scene.
    pub stage: Arc<Stage>,
    /// Shot that was drawn.
    pub shot: Shot,
    /// Outputs that were wanted.
    pub wants: Wants,
    /// Pose of the scene at the shot's time.
    pub pose: Arc<Pose>,
    /// Lights at the shot's time.
    pub lights: Vec<NamedLight>,
    /// Pictures, one for each config.
    pub taken: Vec<Taken>,
    /// Milliseconds from the order to the pictures.
    pub wall_ms: f64,
}

/// News from the studio.
#[derive(Debug)]
pub enum News {
    /// The adapter that draws.
    Adapter(String),
    /// Name of a task that takes a moment.
    Busy(&'static str),
    /// Pictures that were drawn.
    Drawn(Box<Drawn>),
    /// Failure of an order. The studio goes on.
    Failed {
        /// Shot that was to be drawn.
        shot: Box<Shot>,
        /// Reason of the failure.
        why: String,
    },
}

/// Handle of the task that draws.
#[derive(Debug)]
pub struct Studio {
    orders: UnboundedSender<Order>,
    news: Receiver<News>,
}

impl Studio {
    /// Starts the task. `wake` is called when there is news.
    ///
    /// # Errors
    /// If the system has no thread left.
    pub fn start(wake: impl Fn() + Movable + 'static) -> std::io::Result<Self> {
        let (orders, inbox) = unbounded();
        let (outbox, news) = channel();
        platform::spawn("studio", async move || work(inbox, Tell { outbox, wake }).await)?;
        Ok(Self { orders, news })
    }

    /// Orders a picture. Returns false if the task has ended.
    #[must_use]
    pub fn order(&self, order: Order) -> bool {
        self.orders.unbounded_send(order).is_ok()
    }

    /// Returns the news.
    pub fn news(&self) -> impl Iterator<Item = News> + '_ {
        self.news.try_iter()
    }
}

struct Tell<W> {
    outbox: Sender<News>,
    wake: W,
}

impl<W: Fn()> Tell<W> {
    fn say(&self, news: News) {
        // Nobody listens once the window is closed.
        drop(self.outbox.send(news));
        (self.wake)();
    }

    /// Reports a task that takes a moment, and lets the report be shown where one thread does all.
    async fn busy(&self, with: &'static str) {
        self.say(News::Busy(with));
        platform::pause().await;
    }
}

async fn work(mut inbox: UnboundedReceiver<Order>, tell: Tell<impl Fn()>) {
    let mut gpu = None;
    let mut next = inbox.recv().await.ok();
    while let Some(order) = next {
        next = with_scene(order, &mut inbox, &tell, &mut gpu).await;
    }
}

/// Returns the last waiting order, or the next one; `None` once nobody can order.
async fn latest(inbox: &mut UnboundedReceiver<Order>) -> Option<Order> {
    let mut order = inbox.recv().await.ok()?;
    while let Ok(later) = inbox.try_recv() {
        order = later;
    }
    Some(order)
}

/// Draws one scene until another is ordered.
async fn with_scene(
    first: Order,
    inbox: &mut UnboundedReceiver<Order>,
    tell: &Tell<impl Fn()>,
    gpu: &mut Option<Gpu>,
) -> Option<Order> {
    let stage = Arc::clone(&first.stage);
    let mut order = first;
    let mut set = match Poser::new(&stage.scene) {
        Ok(poser) => {
            Set { stage: &stage, poser, posed: (stage.request.time_s, Arc::clone(&stage.pose)), booths: Vec::new() }
        }
        Err(error) => {
            tell.say(News::Failed { shot: Box::new(order.shot), why: error.to_string() });
            return latest(inbox).await;
        }
    };
    loop {
        let shot = order.shot.clone();
        let again = Order { wants: Wants::default(), ..order.clone() };
        match set.draw(order, tell, gpu).await {
            Ok(drawn) => tell.say(News::Drawn(Box::new(drawn))),
            Err(failure) => {
                if failure.lost_device {
                    set.booths.clear();
                    *gpu = None;
                }
                tell.say(News::Failed { shot: Box::new(shot), why: failure.why });
            }
        }
        let is_slow = gpu.as_ref().is_some_and(platform::makes_pipelines_slowly);
        let soon = if is_slow { within(IDLE, inbox).await } else { None };
        order = match soon {
            Some(order) => order,
            None => {
                if is_slow && set.make_any_filter() {
                    // A driver makes pipelines when they first draw. What fails here fails again
                    // when somebody asks for it.
                    drop(set.draw(again, tell, gpu).await);
                }
                latest(inbox).await?
            }
        };
        if order.stage.id != stage.id {
            return Some(order);
        }
    }
}

/// Returns the last waiting order, or one that arrives within some time.
async fn within(time: Duration, inbox: &mut UnboundedReceiver<Order>) -> Option<Order> {
    let (mut order, mut timer) = (pin!(latest(inbox)), pin!(platform::sleep(time)));
    poll_fn(|context| match order.as_mut().poll(context) {
        Poll::Ready(order) => Poll::Ready(order),
        Poll::Pending => timer.as_mut().poll(context).map(|()| None),
    })
    .await
}

struct Failure {
    why: String,
    lost_device: bool,
}

impl From<umbrage_render::Error> for Failure {
    fn from(error: umbrage_render::Error) -> Self {
        use umbrage_render::Error as E;
        let lost_device = matches!(error, E::Device { .. } | E::OutOfMemory { .. } | E::NoDevice { .. });
        Self { why: error.to_string(), lost_device }
    }
}

/// A scene with its renderers.
struct Set<'s> {
    stage: &'s Arc<Stage>,
    poser: Poser<'s>,
    posed: (f64, Arc<Pose>),
    booths: Vec<Booth>,
}

/// A renderer with one config.
struct Booth {
    renderer: Renderer,
    lights: Vec<umbrage::config::LightKind>,
}

impl Set<'_> {
    /// Makes pipelines for every filter, if there are none yet. Returns whether there were none.
    fn make_any_filter(&mut self) -> bool {
        let made = |booth: &mut Booth| booth.renderer.make_any_filter().unwrap_or(false);
        self.booths.iter_mut().map(made).fold(false, |any, is_new| any | is_new)
    }

    async fn draw(&mut self, order: Order, tell: &Tell<impl Fn()>, gpu: &mut Option<Gpu>) -> Result<Drawn, Failure> {
        let begun = Instant::now();
        let Order { shot, wants, gpu: shared, .. } = order;
        let (pose, lights) = self.pose(&shot)?;
        if shared.as_ref().is_some_and(|shared| gpu.as_ref().is_none_or(|known| known.device != shared.device)) {
            self.booths.clear();
            *gpu = None;
        }
        let gpu = open(gpu, shared, tell).await?;
        let mut taken = Vec::new();
        for (slot, config) in shot.configs.iter().enumerate() {
            taken.push(self.take(slot, config, (&shot, &wants), (&pose, &lights), (gpu, tell)).await?);
        }
        // A comparison that has ended gives its memory back.
        self.booths.truncate(shot.configs.len());
        let wall_ms = begun.elapsed().as_secs_f64() * 1e3;
        Ok(Drawn { stage: Arc::clone(self.stage), shot, wants, pose, lights, taken, wall_ms })
    }

    fn pose(&mut self, shot: &Shot) -> Result<(Arc<Pose>, Vec<NamedLight>), Failure> {
        let plain = |why: String| Failure { why, lost_device: false };
        if self.posed.0 != shot.time_s {
            let pose = self.poser.pose(shot.time_s).map_err(|error| plain(error.to_string()))?;
            self.posed = (shot.time_s, Arc::new(pose));
        }
        let pose = Arc::clone(&self.posed.1);
        let stage = self.stage;
        let mut lights = lights::chosen(&stage.request, &stage.scene, &pose, stage.path.as_ref(), &mut Vec::new())
            .map_err(|failure| plain(failure.to_string()))?;
        if let (Some(sun), Some(first)) = (shot.sun, lights.first_mut()) {
            *first = NamedLight { name: "sun".to_owned(), lamp: sun.into() };
        }
        Ok((pose, lights))
    }

    async fn take(
        &mut self,
        slot: usize,
        config: &ShadowConfig,
        (shot, wants): (&Shot, &Wants),
        (pose, lights): (&Pose, &[NamedLight]),
        (gpu, tell): (&Gpu, &Tell<impl Fn()>),
    ) -> Result<Taken, Failure> {
        let kinds = lights::kinds(lights);
        let (config, mut notes) = config.for_lights(&kinds);
        let scene = &self.stage.scene;
        self.booths.truncate(self.booths.len().min(if self.is_made_for(slot, &kinds) { usize::MAX } else { slot }));
        if self.booths.len() == slot {
            tell.busy("uploading the scene and building its pipelines").await;
            let slots = kinds.iter().copied().map(Into::into).collect();
            let settings = RenderSettings {
                size: shot.size,
                samples: Samples::default(),
                config: config.clone(),
                lights: slots,
                ..RenderSettings::default()
            };
            self.booths.push(Booth { renderer: Renderer::new(gpu, scene, &settings)?, lights: kinds });
        }
        let renderer = &mut self.booths[slot].renderer;
        if *renderer.config() != config {
            if renderer.config().rebuilds(&config).is_some_and(|(what, _)| what > umbrage::config::Rebuilds::Nothing) {
                tell.busy("making shaders and maps for the new settings").await;
            }
            renderer.plan_for(None)?;
            renderer.set_config(scene, &config)?;
        }
        renderer.resize(shot.size)?;
        renderer.plan_for(shot.planned_for)?;
        let more_lights: Vec<Lamp> = lights[1..].iter().map(|light| light.lamp).collect();
        let frame = Frame {
            pose,
            moved: None,
            view: &shot.view,
            light: lights[0].lamp,
            more_lights: &more_lights,
            shadows_on: shot.shadows_on,
            tint: shot.tint,
        };
        let maps = wants.maps && config.filter.samples() == 1 && shot.shadows_on;
        let outputs = Outputs { picture: true, mask: wants.mask, maps, edges: wants.edges };
        let rendered = renderer.render_async(&frame, outputs).await?;
        let answer = match wants.probe {
            Some(point) => renderer.probe_async(&frame, &[point]).await?.into_iter().next(),
            None => None,
        };
        notes.extend(rendered.stats.notes.iter().cloned());
        Ok(Taken {
            picture: rendered.picture.ok_or_else(|| Failure {
                why: "the renderer gave no picture, which is a defect; please report it".to_owned(),
                lost_device: false,
            })?,
            mask: rendered.mask,
            edges: rendered.edges,
            maps: rendered.maps,
            stats: rendered.stats,
            casters: renderer.casters_of(pose),
            answer,
            notes,
        })
    }

    /// Returns whether the renderer of a slot has maps for lights of these kinds, or there is no
    /// renderer yet.
    fn is_made_for(&self, slot: usize, kinds: &[umbrage::config::LightKind]) -> bool {
        self.booths.get(slot).is_none_or(|booth| booth.lights == kinds)
    }
}

/// Returns the device: the shared one if given, else the studio's own, which is opened if there is
/// none.
async fn open<'g>(gpu: &'g mut Option<Gpu>, shared: Option<Gpu>, tell: &Tell<impl Fn()>) -> Result<&'g Gpu, Failure> {
    match gpu {
        Some(gpu) => Ok(gpu),
        None => {
            let opened = match shared {
                Some(shared) => shared,
                None => {
                    tell.busy("opening the graphics device").await;
                    Gpu::open(&GpuOptions::default()).await?
                }
            };
            tell.say(News::Adapter(opened.description()));
            Ok(gpu.insert(opened))
        }
    }
}
