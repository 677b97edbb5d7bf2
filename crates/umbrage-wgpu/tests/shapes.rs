//! Shapes by the size of a texel: each caster is drawn once, in the shape that was chosen.

mod common;

use common::{Gpu, PCF3, config};
use glam::DVec3;
use umbrage::{Aabb, DirectionalLight, Frustum, Light, View};
use umbrage_wgpu::{Inputs, Shadows};

fn boxes() -> Vec<Aabb> {
    (0..900)
        .map(|i| {
            let at = DVec3::new(4.0 * f64::from(i % 30) - 60.0, 0.0, 4.0 * f64::from(i / 30) - 60.0);
            Aabb::new(at, at + DVec3::new(1.0, 2.0 + f64::from(i % 3), 1.0))
        })
        .collect()
}

#[test]
fn every_caster_is_drawn_in_the_shape_that_its_texels_show() {
    let Some(gpu) = Gpu::new() else { return };
    let (casters, view, sun) = (boxes(), view(), sun());
    for settings in ["", "generation=layered", "generation=instanced storage=atlas"] {
        let config = config(&[128, 128, 128], PCF3, settings);
        let mut shadows = Shadows::new(&gpu.device, &config).expect("a config");
        let inputs = Inputs { casters: &casters, receivers: &casters, ..Inputs::new(&view, &sun) };
        let frame = shadows.prepare(&gpu.queue, &inputs).expect("a frame");
        let splits = &frame.plan(0).splits;
        for map in frame.maps() {
            let finest = splits[map.splits()].iter().map(|split| split.texel_m.max_element()).fold(f64::MAX, f64::min);
            assert_eq!(map.texel_m(), finest, "{settings}");
            let mut asked = Vec::new();
            let draws = map.shapes(|caster, texel_m| {
                asked.push((caster, texel_m));
                // Three kinds of casters; small texels show their finest shape.
                (caster % 3, u32::from(texel_m > 0.5))
            });
            assert!(asked.iter().all(|&(_, texel_m)| texel_m == finest));
            assert!(draws.windows(2).all(|pair| pair[0].shape < pair[1].shape), "shape by shape");
            let mut drawn: Vec<_> = draws.iter().flat_map(|draw| draw.casters.clone()).collect();
            for draw in &draws {
                let wanted = (draw.casters[0].0 % 3, u32::from(finest > 0.5));
                assert_eq!(draw.shape, wanted);
                assert!(draw.casters.iter().all(|(caster, _)| caster % 3 == wanted.0));
                let rows: Vec<u32> = draw.rows().flatten().collect();
                assert!(rows.iter().eq(draw.casters.iter().map(|(caster, _)| caster)));
            }
            drawn.sort_by_key(|(caster, _)| *caster);
            assert!(drawn.iter().cloned().eq(map.casters()), "{settings}");
        }
        let texels: Vec<f64> = frame.maps().map(|map| map.texel_m()).collect();
        assert!(texels.len() == 1 || texels[0] < 0.5 && texels[2] > 0.5, "both shapes are chosen: {texels:?}");
    }
}

fn view() -> View {
    let frustum = Frustum::perspective(1.0, 1.5, 0.5, 150.0).expect("a lens");
    View::look_at_upright(DVec3::new(0.0, 6.0, 40.0), DVec3::new(0.0, 0.0, -40.0), frustum).expect("a view")
}

fn sun() -> [Light; 1] {
    [DirectionalLight::new(DVec3::new(0.4, -1.0, 0.3)).expect("a sun").into()]
}
