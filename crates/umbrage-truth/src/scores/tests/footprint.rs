//! m and m_p.

use glam::{DAffine3, DQuat, DVec2, DVec3};
use umbrage::{Frustum, View};

use crate::TruthMask;
use crate::scores::{Domain, TexelGradient, texel_footprint};
use crate::tests::scenes::{Shape, Stage};

fn floor_seen(frustum: Frustum, eye: DVec3, target: DVec3, tilt: DQuat, sun: DVec3) -> (View, TruthMask, Domain) {
    let mut stage = Stage::default();
    stage.add(Shape::floor(2000.0, 0.0), DAffine3::from_quat(tilt));
    let view = View::look_at_upright(eye, target, frustum).unwrap();
    let mask = stage.mask(&view, sun, [64, 48]);
    let domain = Domain::new(&mask, (0.1, 1e4)).unwrap();
    (view, mask, domain)
}

/// An orthographic map along `travel` with texels of `texel` metres.
fn map(travel: DVec3, texel: DVec2) -> TexelGradient {
    let light = umbrage::DirectionalLight::new(travel).unwrap();
    let (u, v) = light.map_axes();
    TexelGradient::orthographic(u, v, texel)
}

#[test]
fn straight_down_a_texel_is_as_large_as_it_looks() {
    for (frustum, image_height) in [
        (Frustum::perspective(1.0, 4.0 / 3.0, 0.1, 1e3).unwrap(), 2.0 * 10.0 * 0.5_f64.tan()),
        (Frustum::orthographic(16.0, 12.0, 0.1, 1e3).unwrap(), 12.0),
    ] {
        let eye = DVec3::new(3.0, 10.0, -2.0);
        let (view, mask, domain) = floor_seen(frustum, eye, eye - DVec3::Y, DQuat::IDENTITY, DVec3::NEG_Y);
        let texels = map(DVec3::NEG_Y, DVec2::new(0.5, 0.25));
        let footprint = texel_footprint(&view, &mask, &domain, |_, _| Some(texels)).unwrap().unwrap();
        let expected = 0.5 / (image_height / 48.0);
        for m in [footprint.median, footprint.p99, footprint.perspective_median, footprint.perspective_p99] {
            assert!((m / expected - 1.0).abs() < 1e-9, "{m} {expected}");
        }
        assert_eq!(footprint.pixels, 64 * 48);
    }
}

#[test]
fn a_slanted_sun_stretches_texels_over_the_floor() {
    // Light 30 degrees above the horizon: a square texel is twice as long on the floor, m doubles,
    // m_p does not.
    let eye = DVec3::new(0.0, 10.0, 0.0);
    let frustum = Frustum::orthographic(16.0, 12.0, 0.1, 1e3).unwrap();
    let sun = DVec3::new(3_f64.sqrt(), -1.0, 0.0);
    let (view, mask, domain) = floor_seen(frustum, eye, DVec3::ZERO, DQuat::IDENTITY, sun);
    let footprint = texel_footprint(&view, &mask, &domain, |_, _| Some(map(sun, DVec2::splat(0.5)))).unwrap().unwrap();
    assert!((footprint.median - 4.0).abs() < 1e-9, "{}", footprint.median);
    assert!((footprint.perspective_median - 2.0).abs() < 1e-9);
}

#[test]
fn the_jacobian_is_that_of_the_rays() {
    // One pixel of a tilted plane at a time, against differences of true hits half a millipixel
    // apart.
    let tilt = DQuat::from_rotation_x(0.3) * DQuat::from_rotation_z(-0.2);
    let normal = tilt * DVec3::Y;
    let sun = DVec3::new(0.4, -1.0, -0.3);
    let frustum = Frustum { left: -0.2, right: 0.6, ..Frustum::perspective(0.9, 1.0, 0.1, 1e4).unwrap() };
    let (view, mask, domain) = floor_seen(frustum, DVec3::new(1.0, 6.0, 9.0), DVec3::new(2.0, 0.0, -3.0), tilt, sun);
    let texels = map(sun, DVec2::new(0.03, 0.05));
    assert!(domain.pixels().len() > 1000);
    for &pixel in domain.pixels().iter().step_by(97) {
        let mut alone = vec![None; mask.hits().len()];
        alone[pixel] = mask.hits()[pixel];
        let alone = TruthMask::from_hits(mask.size(), mask.light().to_light(DVec3::ZERO), alone).unwrap();
        let only = Domain::new(&alone, (0.1, 1e4)).unwrap();
        let ours = texel_footprint(&view, &alone, &only, |_, _| Some(texels)).unwrap().unwrap().median;
        let texel = |dx: f64, dy: f64| {
            let at = ((pixel % 64) as f64 + 0.5 + dx, (pixel / 64) as f64 + 0.5 + dy);
            let (origin, direction) = view.ray_through(at.0 / 64.0, at.1 / 48.0);
            let p = origin - direction * (normal.dot(origin) / normal.dot(direction));
            DVec2::new(texels.u.dot(p), texels.v.dot(p))
        };
        let h = 5e-4;
        let jx = (texel(h, 0.0) - texel(-h, 0.0)) / (2.0 * h);
        let jy = (texel(0.0, h) - texel(0.0, -h)) / (2.0 * h);
        // The least stretch over all directions of a step on the screen.
        let least = (0..20_000)
            .map(|i| {
                let angle = f64::from(i) * std::f64::consts::PI / 20_000.0;
                (jx * angle.cos() + jy * angle.sin()).length()
            })
            .fold(f64::INFINITY, f64::min);
        assert!((ours * least - 1.0).abs() < 1e-4, "pixel {pixel}: {ours} against {}", 1.0 / least);
    }
}

#[test]
fn points_without_a_map_are_left_out() {
    let eye = DVec3::new(0.0, 10.0, 0.0);
    let frustum = Frustum::orthographic(16.0, 12.0, 0.1, 1e3).unwrap();
    let (view, mask, domain) = floor_seen(frustum, eye, DVec3::ZERO, DQuat::IDENTITY, DVec3::NEG_Y);
    let texels = map(DVec3::NEG_Y, DVec2::splat(0.5));
    let half = texel_footprint(&view, &mask, &domain, |p, _| (p.x > 0.0).then_some(texels)).unwrap().unwrap();
    assert_eq!(half.pixels, 32 * 48);
    assert_eq!(texel_footprint(&view, &mask, &domain, |_, _| None).unwrap(), None);
    let other = TruthMask::from_hits([1, 1], DVec3::Y, vec![None]).unwrap();
    assert!(texel_footprint(&view, &other, &domain, |_, _| Some(texels)).is_err());
}
