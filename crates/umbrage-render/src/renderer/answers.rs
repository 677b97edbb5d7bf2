//! Answers at given points: draws the maps and records the pass that probes them.

use glam::DVec3;
use umbrage::{Aabb, ShadowPlan};

use super::prepare::Prepared;
use super::record::{Recorded, new_encoder};
use super::{Frame, Renderer};
use crate::probe::{self, Probe, ProbeAnswer, ProbePoint, Responder};
use crate::{Result, cull};

impl Renderer {
    pub(crate) async fn probe_unguarded(
        &mut self,
        frame: &Frame<'_>,
        points: &[ProbePoint],
    ) -> Result<Vec<ProbeAnswer>> {
        let gpu = self.gpu.clone();
        let prepared = self.prepare(frame, false)?;
        let rounds = if prepared.slices.is_empty() { 1 } else { prepared.caster_runs.len() };
        let mut answers = Vec::new();
        for round in 0..rounds {
            // One map for all splits: it answers for one after the other.
            let sliced = !prepared.slices.is_empty();
            let passes = if sliced { round..round + 1 } else { 0..prepared.caster_runs.len() };
            let mut encoder = new_encoder(&gpu);
            self.draw_maps(&mut encoder, passes, &prepared, &mut Recorded::default());
            gpu.queue.submit([encoder.finish()]);
            let maps = if sliced { self.shadows.maps().slice_bind_group(round) } else { self.shadows.bind_group() };
            for (batch, points) in points.chunks(probe::BATCH).enumerate() {
                let replies = self.ask(frame, &prepared, maps, points).await?;
                if round == 0 {
                    answers.extend(replies);
                    continue;
                }
                for (answer, reply) in answers[batch * probe::BATCH..].iter_mut().zip(replies) {
                    if reply.split == round as i32 {
                        *answer = reply;
                    }
                }
            }
        }
        Ok(answers)
    }

    /// Probes one batch of points.
    async fn ask(
        &self,
        frame: &Frame<'_>,
        prepared: &Prepared,
        maps: &wgpu::BindGroup,
        points: &[ProbePoint],
    ) -> Result<Vec<ProbeAnswer>> {
        let gpu = &self.gpu;
        let asked: Vec<(ProbePoint, Responder)> = points
            .iter()
            .map(|&point| (point, self.responder(frame, self.shadows.frame().plan(0), point.position)))
            .collect();
        let mut encoder = new_encoder(gpu);
        let named = self.names.entries(&self.scene, Probe::NAMES);
        let pending = self.probe_pass().record(gpu, &mut encoder, (maps, &named), prepared.origin, &asked)?;
        gpu.queue.submit([encoder.finish()]);
        let mut replies = pending.read(gpu).await?;
        for (reply, (point, responder)) in replies.iter_mut().zip(&asked) {
            let faces_light = point.normal.dot(frame.light.light.to_light(point.position)) > 0.0;
            let unshaded = f32::from(u8::from(faces_light));
            match *responder {
                Responder::Nobody => *reply = ProbeAnswer { visibility: unshaded, split: -1 },
                // No caster reaches this split: whatever its map looks like, it is lit.
                Responder::Split(split)
                    if self.shadows.frame().plan(0).casters(split).is_empty() || !frame.shadows_on =>
                {
                    *reply = ProbeAnswer { visibility: unshaded, split: split as i32 };
                }
                Responder::Split(_) | Responder::View => {}
            }
        }
        Ok(replies)
    }

    /// Chooses the split that answers for a point.
    fn responder(&self, frame: &Frame<'_>, plan: &ShadowPlan, point: DVec3) -> Responder {
        if !frame.light.light.illuminates(point) {
            return Responder::Nobody;
        }
        let in_range = plan.planes.last().is_some_and(|&far| plan.depth_at(point) < far);
        if in_range && cull::may_be_seen(frame.view, &Aabb::new(point, point)) {
            return Responder::View;
        }
        plan.covering_split(point).map_or(Responder::Nobody, Responder::Split)
    }
}
