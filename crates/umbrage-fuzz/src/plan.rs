//! Frames to plan, made of bytes.

use glam::{DQuat, DVec3, EulerRot};
use umbrage::config::{
    Crop, ExtentSteps, FitTo, Preset, Range, Selection, ShadowConfig, SplitMetric, SplitScheme, Stability, Transition,
};
use umbrage::{Aabb, DirectionalLight, FilterReach, Frustum, PlannerOptions, Projection, View};

use crate::case::{Case, keeps_its_promises, seen};

/// Plans the case whose choices are `bytes`.
pub fn plan(bytes: &[u8]) {
    let Some(case) = case(&mut Choices(bytes)) else { return };
    if let Err(broken) = keeps_its_promises(&case) {
        panic!("{broken}\n{case:#?}");
    }
}

/// Choices that follow from bytes, one after the other; zeros follow the last.
struct Choices<'a>(&'a [u8]);

impl Choices<'_> {
    fn byte(&mut self) -> u8 {
        let (first, rest) = self.0.split_first().map_or((0, self.0), |(first, rest)| (*first, rest));
        self.0 = rest;
        first
    }

    fn of<T: Clone>(&mut self, list: &[T]) -> T {
        list[usize::from(self.byte()) % list.len()].clone()
    }

    /// One in so many.
    fn rarely(&mut self, of: u8) -> bool {
        self.byte() % of == of - 1
    }

    fn between(&mut self, least: f64, most: f64) -> f64 {
        let share = f64::from(u16::from_le_bytes([self.byte(), self.byte()])) / f64::from(u16::MAX);
        least + (most - least) * share
    }

    fn point(&mut self, least: [f64; 3], most: [f64; 3]) -> DVec3 {
        let mut axis = |axis: usize| self.between(least[axis], most[axis]);
        DVec3::new(axis(0), axis(1), axis(2))
    }

    /// Any direction, with those among them in which axes coincide or nearly do.
    fn direction(&mut self) -> DVec3 {
        let mut part = || match self.byte() % 6 {
            0 => 0.0,
            1 => 1.0,
            2 => -1.0,
            3 => 1e-7,
            4 => -1e-12,
            _ => self.between(-1.0, 1.0),
        };
        let direction = DVec3::new(part(), part(), part());
        if direction.length() > 1e-3 { direction } else { DVec3::NEG_Y }
    }

    /// Boxes about the origin, often on a ground of any size, sometimes with one that is very far
    /// away.
    fn boxes(&mut self) -> Vec<Aabb> {
        let mut boxes = Vec::new();
        for _ in 0..1 + self.byte() % 23 {
            let at = self.point([-30.0, -0.5, -30.0], [30.0, 8.0, 30.0]);
            let mut size = || match self.byte() % 6 {
                0 => 0.0,
                1 => self.between(10.0, 80.0),
                _ => self.between(0.05, 4.0),
            };
            boxes.push(Aabb::new(at, at + DVec3::new(size(), size(), size())));
        }
        if !self.rarely(4) {
            let half = 10_f64.powf(self.between(1.0, 6.0));
            boxes.push(Aabb::new(DVec3::new(-half, 0.0, -half), DVec3::new(half, 0.0, half)));
        }
        if self.rarely(4) {
            let (direction, distance, size) = (self.direction(), self.between(4.0, 9.0), self.between(-3.0, 0.0));
            let (at, half) = (direction.normalize() * 10_f64.powf(distance), 10_f64.powf(distance + size - 1.0));
            boxes.push(Aabb::new(at - half, at + half));
        }
        boxes
    }

    fn lens(&mut self) -> Option<Frustum> {
        let lens = if self.rarely(6) {
            let width = self.between(5.0, 200.0);
            Frustum::orthographic(width, 0.7 * width, self.between(0.1, 10.0), self.between(50.0, 3000.0))
        } else {
            let (near, far) = (self.between(0.01, 1.0), self.between(20.0, 3000.0));
            let far = if self.rarely(2) { f64::INFINITY } else { far };
            Frustum::perspective(self.between(0.05, 2.6), self.between(0.5, 2.5), near, far)
        };
        let lens = lens.ok()?;
        let off_axis = Frustum { left: 0.2 * lens.left, top: 1.3 * lens.top, ..lens };
        Some(if self.rarely(2) { off_axis } else { lens })
    }

    fn settings(&mut self) -> (ShadowConfig, PlannerOptions) {
        let scheme =
            self.of(&[SplitScheme::Logarithmic, SplitScheme::Uniform, SplitScheme::Optimal, SplitScheme::practical()]);
        let stability = self.of(&[
            Stability::tight(),
            Stability::Exact,
            Stability::Approximate { steps: ExtentSteps::default() },
            Stability::Approximate { steps: ExtentSteps::Levels(64) },
        ]);
        let selection = self.of(&[
            Selection::Interval(SplitMetric::ViewDepth),
            Selection::Map,
            Selection::Interval(SplitMetric::Distance),
        ]);
        let near = self.between(0.1, 50.0);
        let range = match self.byte() % 4 {
            0 => Range::Metres { near, far: near * self.between(1.5, 1000.0) },
            1 if selection.metric() == SplitMetric::ViewDepth => Range::Visible,
            _ => Range::Camera,
        };
        let dependent = self.rarely(2);
        let fits_to_depth = dependent && selection == Selection::Map && stability != Stability::Exact;
        let config = ShadowConfig {
            map_sizes: vec![256; 1 + usize::from(self.byte() % 8)],
            scheme,
            stability,
            selection,
            range,
            transition: Transition::Blend { share: self.between(0.0, 1.0) },
            crop: if dependent { Crop::SceneDependent } else { Crop::SceneIndependent },
            fit_to: if fits_to_depth { FitTo::Depth } else { FitTo::Boxes },
            ..Preset::Papers.config()
        };
        let reach = FilterReach { radius_texels: self.between(0.5, 4.0), radius_m: None };
        let depth_clamp = self.rarely(2);
        (config, PlannerOptions { depth_clamp, filter_reach: Some(reach), ..PlannerOptions::default() })
    }
}

/// Some frames: a camera that walks, turns or stands, at first along the sun, nearly so, or
/// anywhere. `None` if the choices make no view.
fn case(choices: &mut Choices<'_>) -> Option<Case> {
    let (mut settings, options) = choices.settings();
    let boxes = choices.boxes();
    let sun = DirectionalLight::new(choices.direction()).ok()?;
    let lens = choices.lens()?;
    let mut at = choices.point([-40.0, 0.2, -40.0], [40.0, 30.0, 40.0]);
    let off = choices.of(&[0.0, 1e-15, 1e-9, 1e-6, 1e-3, 1.0]);
    let along = if choices.rarely(2) { -sun.direction() } else { sun.direction() };
    let ahead = (along + off * choices.direction()).try_normalize().unwrap_or(along);
    let upright = |ahead: DVec3| if ahead.y.abs() > 0.99 { DVec3::X } else { DVec3::Y };
    let mut views = vec![View::look_at(at, at + ahead, upright(ahead), lens).ok()?];
    for _ in 0..choices.byte() % 4 {
        at += DVec3::X * if choices.rarely(2) { 0.0 } else { choices.between(0.0, 3.0) };
        let turn = choices.between(-0.3, 0.3);
        let ahead = DQuat::from_euler(EulerRot::YXZ, turn, 0.1 * turn, 0.0) * ahead;
        views.push(View::look_at(at, at + ahead, upright(ahead), lens).ok()?);
    }
    if settings.selection.metric() == SplitMetric::Distance && lens.projection == Projection::Orthographic {
        settings.selection = Selection::VIEW_DEPTH;
    }
    let seen = choices.rarely(2).then(|| seen(&boxes, &[(); 8].map(|()| choices.byte() % 16)));
    let probes = (0..12).map(|_| choices.point([-120.0, -2.0, -120.0], [120.0, 20.0, 120.0])).collect();
    let standing = if choices.rarely(8) { 60 } else { 0 };
    let moves = if choices.rarely(2) { choices.point([-0.5; 3], [0.5; 3]) } else { DVec3::ZERO };
    Some(Case { settings, options, views, standing, moves, sun, boxes, seen, probes })
}
