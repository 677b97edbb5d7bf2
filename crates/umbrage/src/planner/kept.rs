//! The last plan, which is returned again while its inputs do not change.

use super::inputs::{Boxes, PlanInputs};
use crate::held::Held;
use crate::{Layers, Light, ShadowPlan, View};

/// Inputs of a plan made from sets, which a number tells apart. Lists would have to be compared box
/// by box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Inputs {
    view: View,
    light: Light,
    image_size: [u32; 2],
    layers: Layers,
    casters: (u64, u64),
    receivers: (u64, u64),
}

impl Inputs {
    /// The inputs of a plan that is made from sets alone.
    pub fn of(inputs: &PlanInputs<'_>) -> Option<Self> {
        let &PlanInputs { view, light, image_size, layers, receiver_clusters: None, seen: None, .. } = inputs else {
            return None;
        };
        let (Boxes::Set(casters), Boxes::Set(receivers)) = (inputs.casters, inputs.receivers) else { return None };
        Some(Self { view: *view, light, image_size, layers, casters: casters.stamp(), receivers: receivers.stamp() })
    }
}

/// A plan and everything that it was made from: equal inputs and equal held values give an equal
/// plan.
#[derive(Clone, Debug, Default)]
pub(super) struct Kept {
    inputs: Option<Inputs>,
    before: Held,
    after: Held,
    plan: ShadowPlan,
}

impl Kept {
    /// Writes the plan of these inputs and the state held after and before it, if they are known.
    /// Returns whether they are.
    pub fn serve(
        &self,
        inputs: Option<&Inputs>,
        (held, before): (&mut Held, &mut Held),
        plan: &mut ShadowPlan,
    ) -> bool {
        let is_known = inputs.is_some() && self.inputs.as_ref() == inputs && self.before == *held;
        if is_known {
            plan.copy_from(&self.plan);
            before.clone_from(&self.before);
            held.clone_from(&self.after);
        }
        is_known
    }

    /// Keeps a plan.
    pub fn keep(&mut self, inputs: Option<Inputs>, before: &Held, after: &Held, plan: &ShadowPlan) {
        self.inputs = inputs;
        if inputs.is_some() {
            self.before.clone_from(before);
            self.after.clone_from(after);
            self.plan.copy_from(plan);
        }
    }

    pub fn clear(&mut self) {
        self.inputs = None;
    }
}
