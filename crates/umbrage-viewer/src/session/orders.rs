//! Orders to the studio, questions to the judge, and the handling of their answers.

use std::sync::Arc;

use umbrage::ShadowConfig;
use umbrage_render::ProbePoint;

use super::{HISTORY, MOST_SLOW_REPEATS, SLOW_MS, Session, Tab, Times, project};
use crate::judge::{Finding, Laid, Overlay, Question};
use crate::studio::{Drawn, News, Order, Shot, Wants};

impl Session {
    /// Returns the shot that is to be drawn now.
    #[must_use]
    pub fn shot(&self) -> Option<Shot> {
        let (stage, camera) = (self.stage.as_ref()?, self.camera.as_ref()?);
        let slow = self.times.back().is_some_and(|times| times.wall > SLOW_MS);
        let coarse = slow && self.is_moving();
        Some(Shot {
            stage: stage.id,
            time_s: self.time_s,
            view: *camera.view(),
            planned_for: self.frozen,
            sun: self.last_sun,
            configs: std::iter::once(&self.config).chain(&self.other).cloned().collect(),
            size: if coarse { self.size.map(|edge| edge.div_ceil(2)) } else { self.size },
            tint: self.show.tint,
            shadows_on: self.show.shadows,
        })
    }

    /// Returns the outputs that are wanted beside the picture.
    fn wants(&self, shot: &Shot) -> Wants {
        let probe = self.picked.as_ref().filter(|picked| picked.drawn.shot == *shot).and_then(|picked| {
            let surface = picked.surface.as_ref()?;
            Some(ProbePoint { position: surface.position, normal: surface.normal })
        });
        let overlay = self.show.overlay;
        let (mask, edges) = (overlay == Some(Overlay::Errors), overlay == Some(Overlay::Tests));
        Wants { maps: self.show.tab == Some(Tab::Maps), mask, edges, probe }
    }

    /// Returns the next picture to order: none while one is being drawn, or if nothing has changed.
    pub fn next_order(&mut self) -> Option<Order> {
        // At night the last sun stays.
        if let Ok(sun) = self.sun.light() {
            self.last_sun = sun.filter(|_| self.shown_sun().is_some());
        }
        if self.in_flight {
            return None;
        }
        let shot = self.shot()?;
        if self.failed.as_ref() == Some(&shot) {
            return None;
        }
        let stage = Arc::clone(self.stage.as_ref()?);
        let is_still = self.drawn.as_ref().is_some_and(|drawn| drawn.shot == shot);
        let wants = if is_still { self.wants(&shot) } else { Wants::default() };
        let is_met = is_still && self.drawn.as_ref().is_some_and(|drawn| wants.are_met_by(&drawn.wants));
        if is_met && self.settled {
            return None;
        }
        self.in_flight = true;
        Some(Order { stage, shot, wants, gpu: None })
    }

    /// Handles an order that could not be given because the studio has ended.
    pub fn order_lost(&mut self, why: &str) {
        self.in_flight = false;
        self.say(true, why);
    }

    /// Handles news from the studio.
    pub fn hear(&mut self, news: News) {
        match news {
            News::Adapter(adapter) => self.adapter = Some(adapter),
            News::Busy(what) => self.busy = Some(what),
            News::Failed { shot, why } => {
                (self.in_flight, self.busy) = (false, None);
                self.say(true, why);
                self.failed = Some(*shot);
            }
            News::Drawn(drawn) => {
                (self.in_flight, self.busy, self.failed) = (false, None, None);
                // A picture of a scene that was left is nobody's.
                if self.is_of_stage(&drawn.shot) {
                    self.show_picture(*drawn);
                }
            }
        }
    }

    fn show_picture(&mut self, drawn: Drawn) {
        self.pictures += 1;
        if let Some(taken) = drawn.taken.first() {
            let stats = &taken.stats;
            let maps = stats.shadow_ms;
            let view = (stats.frame_ms - maps).max(0.0);
            self.times.push_back(Times { plan: stats.plan_ms, maps, view, wall: drawn.wall_ms });
            while self.times.len() > HISTORY {
                self.times.pop_front();
            }
        }
        let plans = |drawn: &Drawn| drawn.taken.iter().map(|taken| Arc::clone(&taken.stats.plan)).collect::<Vec<_>>();
        // Stabilised maps go back to a fresh plan's in small steps while the camera stands.
        let holds = drawn.shot.configs.iter().any(ShadowConfig::is_stabilised) && drawn.shot.shadows_on;
        let before = self.drawn.as_ref().filter(|before| before.shot == drawn.shot);
        self.repeats = if before.is_some() { self.repeats + 1 } else { 0 };
        let is_tedious = drawn.wall_ms > SLOW_MS && self.repeats >= MOST_SLOW_REPEATS;
        self.settled = !holds || is_tedious || before.is_some_and(|before| plans(before) == plans(&drawn));
        let notes: Vec<String> = drawn.taken.iter().flat_map(|taken| taken.notes.clone()).collect();
        if self.drawn.as_ref().is_none_or(|before| before.shot.configs != drawn.shot.configs) {
            notes.into_iter().for_each(|note| self.say(false, note));
        }
        self.drawn = Some(Arc::new(drawn));
    }

    /// Returns whether the picture is current, with all outputs that were asked for.
    #[must_use]
    pub fn is_up_to_date(&self) -> bool {
        let Some((shot, drawn)) = self.shot().zip(self.drawn.as_ref()) else { return false };
        drawn.shot == shot
            && self.wants(&shot).are_met_by(&drawn.wants)
            && (self.show.overlay.is_none() || self.fitting_overlay().is_some())
            && self.judging.is_none()
            && self.click.is_none()
    }

    /// Returns the overlay of the picture that is shown.
    #[must_use]
    pub fn fitting_overlay(&self) -> Option<&Laid> {
        let drawn = self.drawn.as_ref()?;
        self.laid.as_ref().filter(|laid| laid.shot == drawn.shot && Some(laid.overlay) == self.show.overlay)
    }

    /// Returns the next question to the judge: about the picture that is shown, once nothing moves.
    pub fn next_question(&mut self) -> Option<Question> {
        if self.judging.is_some() {
            return None;
        }
        let drawn = self.drawn.as_ref()?;
        let shot = self.shot()?;
        if drawn.shot != shot || self.in_flight && !self.settled {
            return None;
        }
        let follows = || {
            // What was clicked on is asked again in each new picture.
            let picked = self.picked.as_ref().filter(|picked| picked.drawn.shot != shot)?;
            let surface = picked.surface.as_ref()?;
            project(&shot.view, surface.position).map(|(at, _)| at)
        };
        if let Some(at) = self.click.take().or_else(follows) {
            self.judging = Some((shot, None));
            return Some(Question::Pick(Arc::clone(drawn), at));
        }
        let overlay = self.show.overlay?;
        let has_mask = match overlay {
            Overlay::Density => true,
            Overlay::Errors => drawn.wants.mask,
            Overlay::Tests => drawn.wants.edges,
        };
        let is_there = self.laid.as_ref().is_some_and(|laid| laid.shot == shot && laid.overlay == overlay);
        if is_there || !has_mask || !self.settled {
            return None;
        }
        self.judging = Some((shot, Some(overlay)));
        Some(Question::Overlay(Arc::clone(drawn), overlay))
    }

    /// Returns whether rays are being traced.
    #[must_use]
    pub fn is_judging(&self) -> bool {
        self.judging.is_some()
    }

    /// Handles a finding of the judge.
    pub fn found(&mut self, finding: Finding) {
        let asked = self.judging.take();
        match finding {
            Finding::Laid(laid) => self.laid = Some(*laid),
            Finding::Picked(picked) => {
                if let (Some(surface), Some(camera)) = (&picked.surface, &mut self.camera) {
                    camera.set_pivot(surface.position);
                }
                self.picked = Some(*picked);
            }
            Finding::Failed(why) => {
                self.say(true, why);
                match asked {
                    // Not asked again for this picture.
                    Some((_, Some(_))) => self.show.overlay = None,
                    _ => self.picked = None,
                }
            }
        }
    }

    /// Handles a question that could not be asked because the judge has ended.
    pub fn question_lost(&mut self, why: &str) {
        self.judging = None;
        self.show.overlay = None;
        self.say(true, why);
    }
}
