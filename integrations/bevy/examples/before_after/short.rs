//! One view with a check, for CI.

use std::process::ExitCode;

use umbrage_truth::Truth;

use crate::judge::Judge;
use crate::scores::{answer, cases, range_of};
use crate::studio::Size;
use crate::worlds::Stage;
use crate::{Failure, say};

const SIZE: Size = [480, 270];

/// Draws one view without and with planned cascades and judges both. Says so and succeeds if there
/// is no graphics adapter.
pub fn check() -> Result<ExitCode, Failure> {
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
    if bevy::tasks::block_on(instance.enumerate_adapters(wgpu::Backends::all())).is_empty() {
        say("no graphics adapter: nothing drawn");
        return Ok(ExitCode::SUCCESS);
    }
    let stage = Stage::new("robot-war", None)?;
    let view = stage.view("middle", SIZE)?;
    let range = range_of(&view, &stage.pose);
    let truth = Truth::build(&stage.scene, &stage.pose, view.eye())?;
    let judge = Judge::new(&stage, &truth, &view, SIZE, range)?;
    let [_, reaching, planned] = cases(range.1);
    let rates = [reaching, planned].map(|(name, shadows)| -> Result<f64, Failure> {
        let answer = answer((&stage, &view, &judge), SIZE, 1024, shadows)?;
        let rate = 100.0 * answer.verdict.wrong.rate();
        say(format!("{name}: {rate:.2} % of pixels wrong, casters {:?}", answer.casters));
        Ok(rate)
    });
    let [bevys, planned] = rates;
    let (bevys, planned) = (bevys?, planned?);
    if planned < bevys {
        return Ok(ExitCode::SUCCESS);
    }
    say(format!("planned cascades are not better than Bevy's: {planned:.2} % and {bevys:.2} % wrong"));
    Ok(ExitCode::FAILURE)
}
