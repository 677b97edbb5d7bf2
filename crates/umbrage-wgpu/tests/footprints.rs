//! Fragments on a GPU: what a pixel covers, and which split its quad agrees on.

mod common;

use common::{EVSM4, Gpu, VSM, World, config, cuboid, ground, plan};
use glam::{DVec3, Vec3};
use umbrage::ShadowPlan;
use umbrage::config::{Derivatives, Filter};
use umbrage_wgpu::FrameOptions;

const SIZE: u32 = 64;

/// A ground of 64 m by 64 m, a metre per pixel; splits meet askew. Colour: visibility, split, what
/// `expression` says.
fn drawn(world: &World, expression: &str) -> Vec<[f32; 4]> {
    let source = world.maps.receiver_wgsl(2)
        + "
@vertex fn vs(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
    return vec4f(vec2f(f32(index & 1u), f32(index >> 1u)) * 4.0 - 1.0, 0.0, 1.0);
}
@fragment fn fs(@builtin(position) pixel: vec4f) -> @location(0) vec4f {
    let position = vec3f(pixel.x, 0.0, pixel.y - 32.0);
    let up = vec3f(0.0, 1.0, 0.0);
    let shadow = umbrage_shadow(umbrage_fragment_query(position, up, dpdx(position), dpdy(position), pixel.xy));
    return vec4f(shadow.visibility, f32(shadow.split), "
        + expression
        + ");
}";
    world.gpu.fragments(&source, SIZE, &world.maps)
}

/// Borders at view depths that run askew through quads, some narrower than a quad.
fn askew() -> ShadowPlan {
    let sizes = [128; 4];
    let mut plan = plan(
        DVec3::new(0.3, -0.8, 0.2),
        DVec3::new(32.0, 0.0, 0.0),
        &sizes,
        &[0.0, 16.3, 17.1, 40.6, 90.0],
        &[90.0; 4],
    );
    plan.view_depth_plane = glam::DVec4::new(1.0, 0.0, 0.35, 11.2);
    plan
}

fn world(filter: Filter) -> Option<World> {
    Some(World::new(Gpu::new()?, &config(&[128; 4], filter, "")))
}

#[test]
fn a_quad_agrees_on_its_last_split() {
    let Some(mut world) = world(VSM) else { return };
    for derivatives in [Derivatives::Analytic, Derivatives::Quad] {
        world.set(&format!("derivatives={derivatives}"));
        world.draw(&askew(), &FrameOptions::default(), &ground(400.0));
        let own = |x: u32, y: u32| {
            let depth = f64::from(x) + 0.5 + 0.35 * (f64::from(y) + 0.5 - 32.0) + 11.2;
            [16.3, 17.1, 40.6].iter().filter(|plane| depth >= **plane).count()
        };
        let pixels = drawn(&world, "0.0, 1.0");
        let (mut mixed, mut three) = (0, 0);
        for y in (0..SIZE).step_by(2) {
            for x in (0..SIZE).step_by(2) {
                let quad = [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(i, j)| (x + i, y + j));
                let splits = quad.map(|(x, y)| own(x, y));
                let last = splits.into_iter().max().unwrap_or(0);
                let distinct = splits.iter().collect::<std::collections::BTreeSet<_>>().len();
                mixed += u32::from(distinct > 1);
                three += u32::from(distinct > 2);
                for ((x, y), own) in quad.into_iter().zip(splits) {
                    let expected = if derivatives == Derivatives::Quad { last } else { own };
                    let found = pixels[(y * SIZE + x) as usize];
                    assert_eq!(found[1], expected as f32, "{derivatives:?} at {x}, {y}: {found:?} of {splits:?}");
                }
            }
        }
        assert!(mixed > 30 && three > 5, "{mixed} quads with two splits, {three} with three");
    }
}

/// Both ways see the same shadow but for the pixels of the border.
#[test]
fn both_derivatives_see_one_shadow() {
    for filter in [VSM, EVSM4] {
        let Some(mut world) = world(filter) else { return };
        let mut triangles = ground(400.0);
        triangles.extend(cuboid(Vec3::new(10.0, 0.0, -20.0), Vec3::new(40.0, 6.0, -10.0)));
        let [analytic, quad] = [Derivatives::Analytic, Derivatives::Quad].map(|derivatives| {
            world.set(&format!("derivatives={derivatives}"));
            world.draw(&askew(), &FrameOptions::default(), &triangles);
            drawn(&world, "0.0, 1.0")
        });
        let dark = analytic.iter().filter(|pixel| pixel[0] < 0.1).count();
        let lit = analytic.iter().filter(|pixel| pixel[0] > 0.9).count();
        assert!(dark > 200 && lit > 2000, "{filter:?}: {dark} dark, {lit} lit");
        for (index, (a, q)) in analytic.iter().zip(&quad).enumerate() {
            let (x, y) = (index as u32 % SIZE, index as u32 / SIZE);
            assert!((a[0] - q[0]).abs() < 0.35, "{filter:?} at {x}, {y}: {} and {}", a[0], q[0]);
            assert!(a[1] != q[1] || a[0] == q[0], "{filter:?} at {x}, {y}");
        }
    }
}
