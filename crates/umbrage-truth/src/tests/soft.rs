//! Soft shadows whose falloff is known.

use std::f64::consts::PI;

use glam::{DAffine3, DVec3};

use super::scenes::{Shape, Stage, view};
use crate::SunDisc;

/// Share of a disc of radius 1 on the side x > c of a line.
fn share_of_disc(c: f64) -> f64 {
    let c = c.clamp(-1.0, 1.0);
    (c.acos() - c * (1.0 - c * c).sqrt()) / PI
}

#[test]
fn a_half_plane_throws_the_segment_of_a_disc() {
    // Everything west of x = 0 is roofed at height 10; the sun is straight above and 10 degrees
    // wide.
    let mut stage = Stage::default();
    stage.add(
        Shape::quad([[-1e3, 10.0, 1e3], [0.0, 10.0, 1e3], [0.0, 10.0, -1e3], [-1e3, 10.0, -1e3]]),
        DAffine3::IDENTITY,
    );
    let truth = stage.truth(DVec3::ZERO);
    let angle = 10_f64.to_radians();
    let radius = 10.0 * (0.5 * angle).tan();
    let xs: Vec<f64> = (-60..=60).map(|i| f64::from(i) * radius / 50.0).collect();
    let points: Vec<_> = xs.iter().map(|&x| (DVec3::new(x, 0.0, 0.3), DVec3::Y)).collect();
    for (samples, tolerance) in [(256, 0.015), (1024, 0.006)] {
        let disc = SunDisc::new(angle, samples);
        for disc in [disc, disc.other_set()] {
            let shares = truth.soft_visibility_at(&points, DVec3::NEG_Y, &disc).unwrap();
            for (x, share) in xs.iter().zip(shares) {
                let expected = share_of_disc(-x / radius);
                assert!((f64::from(share) - expected).abs() < tolerance, "x = {x}: {share}, expected {expected}");
            }
        }
    }
}

#[test]
fn a_sun_on_the_horizon_is_half_set() {
    // A bare floor sees the half of the disc that stands above its own horizon.
    let mut stage = Stage::default();
    stage.add(Shape::floor(10.0, 0.0), DAffine3::IDENTITY);
    let truth = stage.truth(DVec3::ZERO);
    let disc = SunDisc::new(0.05, 1024);
    let answer = truth.soft_visibility_at(&[(DVec3::ZERO, DVec3::Y)], DVec3::X, &disc).unwrap();
    assert!((answer[0] - 0.5).abs() < 0.01, "{answer:?}");
}

#[test]
fn pixels_and_points_agree_and_a_small_sun_is_hard() {
    let mut stage = Stage::default();
    stage.add(Shape::floor(30.0, 0.0), DAffine3::IDENTITY);
    stage.add(Shape::cuboid([-1.0, 2.0, -1.0], [1.0, 3.0, 1.0]), DAffine3::IDENTITY);
    let sun = DVec3::new(0.3, -1.0, 0.2);
    let view = view(DVec3::new(3.0, 5.0, 7.0), DVec3::ZERO);
    let truth = stage.truth(view.eye());
    let mask = truth.mask(&view, sun, [48, 36], &|_| {}).unwrap();
    let disc = SunDisc::new(0.3, 64);
    let soft = truth.soft(&mask, &disc, &|_| {}).unwrap();
    assert_eq!(soft.size(), mask.size());
    let hits: Vec<_> = mask.hits().iter().flatten().collect();
    let points: Vec<_> = hits.iter().map(|hit| (hit.position, hit.normal)).collect();
    let by_point = truth.soft_visibility_at(&points, sun, &disc).unwrap();
    let by_pixel: Vec<f32> = soft.visibility().iter().flatten().copied().collect();
    assert_eq!(by_point, by_pixel);
    assert!(by_pixel.iter().filter(|v| (0.02..0.98).contains(*v)).count() > 20);
    assert_eq!(soft.to_image().pixels().filter(|p| p.0[1] == 0).count(), soft.visibility().len() - hits.len());

    let hard = truth.soft(&mask, &SunDisc::new(1e-9, 8), &|_| {}).unwrap();
    for (soft, hit) in hard.visibility().iter().zip(mask.hits()) {
        assert_eq!(*soft, hit.map(|hit| f32::from(u8::from(hit.lit))));
    }
}
