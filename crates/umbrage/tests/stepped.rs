//! Suns that move in steps: what stands still, how far behind they fall, and that nothing jumps.

use glam::{DQuat, DVec3};
use proptest::prelude::*;
use umbrage::{DirectionalLight, Error, SteppedSun, SunFade};

fn sun(angle: f64) -> DirectionalLight {
    DirectionalLight::new(DQuat::from_rotation_z(angle) * DVec3::new(0.1, -1.0, 0.2)).expect("a direction")
}

#[test]
fn a_step_is_held_then_faded() {
    let mut stepped = SteppedSun::new(0.01, 4.0).expect("valid");
    let mut at = |angle| stepped.follow(&sun(angle), 1.0).expect("valid");
    let first = at(0.0);
    assert_eq!(first, SunFade { from: sun(0.0), to: sun(0.0), weight: 1.0 });
    assert_eq!(at(0.009), first, "less than a step");
    assert_eq!(at(-0.009), first, "in either direction");
    for (angle, weight) in [(0.013, 0.25), (0.014, 0.5), (0.015, 0.75)] {
        let fade = at(angle);
        assert_eq!((fade.from, fade.to, fade.weight), (sun(0.0), sun(0.013), weight));
        assert!(fade.is_fading());
    }
    assert_eq!(at(0.017), SunFade { from: sun(0.013), to: sun(0.013), weight: 1.0 });
    assert_eq!(at(0.022).to, sun(0.013), "0.009 behind");
}

#[test]
fn no_fade_is_a_sudden_step() {
    let mut stepped = SteppedSun::new(0.01, 0.0).expect("valid");
    for (angle, shown) in [(0.0, 0.0), (0.005, 0.0), (0.02, 0.02), (0.025, 0.02)] {
        let fade = stepped.follow(&sun(angle), 0.0).expect("valid");
        assert_eq!((fade.to, fade.is_fading()), (sun(shown), false));
    }
}

#[test]
fn a_fade_that_is_not_given_time_stays_where_it_is() {
    let mut stepped = SteppedSun::new(0.01, 1.0).expect("valid");
    stepped.follow(&sun(0.0), 0.1).expect("valid");
    for _ in 0..3 {
        assert_eq!(stepped.follow(&sun(0.5), 0.0).expect("valid").weight, 0.0);
    }
}

#[test]
fn a_fade_waits_until_its_maps_are_filled() {
    let mut stepped = SteppedSun::new(0.01, 4.0).expect("valid");
    let mut at = |angle, is_filled| {
        let fade = stepped.follow_filled(&sun(angle), 1.0, is_filled).expect("valid");
        (fade.from, fade.to, fade.weight)
    };
    assert_eq!(at(0.0, false), (sun(0.0), sun(0.0), 1.0), "the first has none to wait for");
    assert_eq!(at(0.013, true), (sun(0.0), sun(0.013), 0.0), "filled are the maps before the step");
    assert_eq!(at(0.014, false), (sun(0.0), sun(0.013), 0.0));
    assert_eq!(at(0.015, true), (sun(0.0), sun(0.013), 0.25));
    assert_eq!(at(0.016, false), (sun(0.0), sun(0.013), 0.25), "a gap opens again");
    for weight in [0.5, 0.75] {
        assert_eq!(at(0.017, true), (sun(0.0), sun(0.013), weight));
    }
    assert_eq!(at(0.018, true), (sun(0.013), sun(0.013), 1.0));
}

#[test]
fn a_sudden_step_waits_too() {
    let mut stepped = SteppedSun::new(0.01, 0.0).expect("valid");
    let mut at = |angle, is_filled| stepped.follow_filled(&sun(angle), 1.0, is_filled).expect("valid");
    at(0.0, true);
    let waiting = SunFade { from: sun(0.0), to: sun(0.02), weight: 0.0 };
    assert_eq!(at(0.02, true), waiting);
    assert_eq!(at(0.02, false), waiting);
    assert_eq!(at(0.02, true), SunFade { from: sun(0.02), to: sun(0.02), weight: 1.0 });
}

#[test]
fn mixing() {
    let fade = SunFade { from: sun(0.0), to: sun(0.1), weight: 0.25 };
    assert_eq!((fade.mix(1.0, 0.0), fade.mix(0.0, 1.0), fade.mix(0.3, 0.3)), (0.75, 0.25, 0.3));
}

#[test]
fn bad_input() {
    let field = |result: Result<(), Error>| match result.expect_err("refused") {
        Error::InvalidLight { field, .. } => field,
        other => panic!("another error: {other}"),
    };
    for step in [0.0, -1.0, 4.0, f64::NAN] {
        assert_eq!(field(SteppedSun::new(step, 1.0).map(drop)), "step");
    }
    for fade in [-1.0, f64::NAN, f64::INFINITY] {
        assert_eq!(field(SteppedSun::new(0.1, fade).map(drop)), "fade");
    }
    let mut stepped = SteppedSun::new(0.1, 1.0).expect("valid");
    assert_eq!(field(stepped.follow(&sun(0.0), -0.1).map(drop)), "elapsed");
}

proptest! {
    /// However the sun moves: what is shown of any point moves by no more than time allows, never
    /// to a sun that was not there, and never farther behind than a step and what the sun moves in
    /// one fade.
    #[test]
    fn nothing_jumps_and_nothing_lags(
        step in 0.001..0.1f64, fade in 0.0..8.0f64, moves in prop::collection::vec(-0.03..0.05f64, 2..80),
    ) {
        let mut stepped = SteppedSun::new(step, fade)?;
        let (mut angle, mut angles) = (0.0, Vec::new());
        let mut before: Option<SunFade> = None;
        let fastest = moves.iter().fold(0.0, |fastest: f64, by| fastest.max(by.abs()));
        for by in moves {
            angle += by;
            angles.push(sun(angle));
            let now = stepped.follow(&sun(angle), 1.0)?;
            prop_assert!((0.0..=1.0).contains(&now.weight));
            prop_assert!(angles.contains(&now.from) && angles.contains(&now.to));
            prop_assert!(now.is_fading() || now.from == now.to);
            let behind = now.to.direction().angle_between(sun(angle).direction());
            prop_assert!(behind <= step + fastest * (fade.ceil() + 1.0) + 1e-9, "{behind} behind");
            if let Some(before) = before {
                // The share of each sun that ever was changes by at most 1 / fade.
                for light in [before.from, before.to, now.to] {
                    let share = |fade: &SunFade| {
                        f64::from(u8::from(fade.from == light)) * (1.0 - fade.weight)
                            + f64::from(u8::from(fade.to == light)) * fade.weight
                    };
                    let change = (share(&now) - share(&before)).abs();
                    prop_assert!(change <= 1.0 / fade.max(1.0) + 1e-9, "{before:?} {now:?}");
                }
            }
            before = Some(now);
        }
    }
}
