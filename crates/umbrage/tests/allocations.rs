//! After the first frame the planner allocates nothing.

use glam::DVec3;
use umbrage::config::{Crop, ExtentSteps, Preset, SplitScheme, Stability};
use umbrage::{
    Aabb, DirectionalLight, Frustum, Light, PlanInputs, Planner, PointLight, ShadowConfig, ShadowPlan, SpotLight, View,
    Warp,
};

#[test]
fn only_the_first_frame_allocates() {
    let world: Vec<Aabb> = (0..1000)
        .map(|i| {
            let at = DVec3::new(f64::from(i % 40) * 20.0 - 400.0, 0.0, f64::from(i / 40) * 20.0 - 250.0);
            Aabb::new(at, at + 5.0)
        })
        .collect();
    let light = DirectionalLight::new(DVec3::new(0.4, -1.0, 0.3)).expect("valid");
    let frustum = Frustum::perspective(1.0, 1.5, 0.5, 500.0).expect("valid");
    let view = |angle: f64| View::look_at_upright(DVec3::Y * 10.0, DVec3::new(angle.cos(), 9.9, angle.sin()), frustum);
    for crop in [Crop::SceneDependent, Crop::SceneIndependent] {
        for stability in [Stability::Exact, Stability::tight()] {
            let settings = ShadowConfig { crop, stability: stability.clone(), ..Preset::Papers.config() };
            let mut planner = Planner::new(&settings).expect("valid");
            let view = view(0.3).expect("valid");
            let at = DVec3::new(60.0, 20.0, 10.0);
            let lamp = PointLight::new(at, 80.0).expect("valid");
            let spot = SpotLight::new(at, DVec3::new(0.3, -1.0, 0.0), 0.8, 90.0).expect("valid");
            for light in [Light::from(light), lamp.into(), spot.into()] {
                planner.plan(&view, &light, &world, &world).expect("valid");
                let again = allocation_counter::measure(|| {
                    planner.plan(&view, &light, &world, &world).expect("valid");
                });
                assert_eq!(again.count_total, 0, "{crop:?} {stability:?} {light:?} allocated {again:?}");
            }
        }
        for stability in
            [Stability::Exact, Stability::tight(), Stability::Approximate { steps: ExtentSteps::default() }]
        {
            let scheme = SplitScheme::Optimal;
            let settings = ShadowConfig { crop, stability: stability.clone(), scheme, ..Preset::Papers.config() };
            let mut planner = Planner::new(&settings).expect("valid");
            let view = view(0.3).expect("valid");
            let inputs = PlanInputs::new(&view, light, &world, &world);
            let inputs = PlanInputs { receiver_clusters: Some(&world), ..inputs };
            let mut plan = ShadowPlan::default();
            planner.plan_into(&inputs, &mut plan).expect("valid");
            // What is held stands among the candidates from the second frame on.
            planner.plan_into(&inputs, &mut plan).expect("valid");
            let again = allocation_counter::measure(|| {
                for _ in 0..30 {
                    planner.plan_into(&inputs, &mut plan).expect("valid");
                }
            });
            assert_eq!(again.count_total, 0, "{crop:?} {stability:?} fitted planes allocated {again:?}");
        }
        for warp in [Warp::Psm, Warp::Lispsm, Warp::Tsm { focus: 0.2 }] {
            let settings =
                ShadowConfig { crop, stability: Stability::Tight { warps: vec![warp] }, ..Preset::Papers.config() };
            let mut planner = Planner::new(&settings).expect("valid");
            let view = view(0.3).expect("valid");
            planner.plan(&view, &light, &world, &world).expect("valid");
            let again = allocation_counter::measure(|| {
                planner.plan(&view, &light, &world, &world).expect("valid");
            });
            assert_eq!(again.count_total, 0, "{crop:?} {warp:?} allocated {again:?}");
        }
    }
}
