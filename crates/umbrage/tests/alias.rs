//! Predicted texels per pixel against finite differences.

use glam::{DMat2, DVec2, DVec3};
use umbrage::config::{Preset, Stability};
use umbrage::{Aabb, DirectionalLight, Frustum, Planner, ShadowConfig, View};

#[test]
fn the_jacobian_agrees_with_rays_a_pixel_apart() {
    let frustum = Frustum::perspective(1.0, 4.0 / 3.0, 1.0, 500.0).expect("valid");
    let view = View::look_at_upright(DVec3::new(3.0, 12.0, 40.0), DVec3::new(-5.0, 0.0, 0.0), frustum).expect("valid");
    let light = DirectionalLight::new(DVec3::new(0.4, -1.0, -0.2)).expect("valid");
    let settings = ShadowConfig { stability: Stability::tight(), ..Preset::Papers.config() };
    let mut planner = Planner::new(&settings).expect("valid");
    let world = [Aabb::new(DVec3::new(-200.0, 0.0, -200.0), DVec3::new(200.0, 3.0, 200.0))];
    let plan = planner.plan(&view, &light, &world, &world).expect("valid");
    let (width, height) = (800.0, 600.0);
    for normal in [DVec3::Y, DVec3::new(0.3, 1.0, 0.2).normalize()] {
        for (x, y) in [(400.0, 500.0), (100.0, 320.0), (700.0, 590.0)] {
            let hit = |x: f64, y: f64, through: DVec3| {
                let (origin, direction) = view.ray_through(x / width, y / height);
                origin + direction * ((through - origin).dot(normal) / direction.dot(normal))
            };
            let (origin, direction) = view.ray_through(x / width, y / height);
            let point = origin + direction * (-origin.y / direction.y);
            let split = &plan.splits[1];
            let texel = |p: DVec3| split.map_from_world(p).truncate();
            let step = 1e-4;
            let jacobian = DMat2::from_cols(
                (texel(hit(x + step, y, point)) - texel(point)) / step,
                (texel(hit(x, y + step, point)) - texel(point)) / step,
            );
            // σ_min by search over directions: no formula shared with what is tested.
            let smallest = (0..20_000)
                .map(|i| (jacobian * DVec2::from_angle(f64::from(i) * std::f64::consts::PI / 20_000.0)).length())
                .fold(f64::INFINITY, f64::min);
            let predicted = split.pixels_per_texel_at(&view, [800, 600], point, normal);
            assert!((predicted * smallest - 1.0).abs() < 1e-3, "{predicted} against {}", 1.0 / smallest);
        }
    }
}

#[test]
fn the_perspective_part_is_the_formula() {
    let frustum = Frustum::perspective(60f64.to_radians(), 4.0 / 3.0, 1.0, 500.0).expect("valid");
    let view = View::look_at_upright(DVec3::Y, DVec3::ZERO, frustum).expect("valid");
    let mut planner = Planner::new(&Preset::Papers.config()).expect("valid");
    let light = DirectionalLight::new(DVec3::NEG_Y).expect("valid");
    let plan = planner.plan(&view, &light, &[], &[]).expect("valid");
    let split = &plan.splits[2];
    let expected = split.texel_m.x * 600.0 / (2.0 * 50.0 * 30f64.to_radians().tan());
    assert!((split.pixels_per_texel(&view, 600, 50.0) / expected - 1.0).abs() < 1e-12);
}
