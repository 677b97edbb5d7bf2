//! A minimal town: boxes on a plain.

use umbrage_scene::Scene;

use crate::room::{cuboid, material, place};

/// Makes 60 boxes, 1 to 10 m high, on 240 × 240 m of flat ground around the origin, without cameras
/// and lights.
#[must_use]
pub fn town() -> Scene {
    let mut scene = Scene { name: "town".to_owned(), ..Scene::default() };
    let any = material(&mut scene, [0.7; 3]);
    let mut add = |name: &str, min, max| {
        let mut primitive = umbrage_scene::Primitive { material: any, ..Default::default() };
        cuboid(&mut primitive, min, max);
        place(&mut scene, name, primitive);
    };
    add("ground", [-120.0, -1.0, -120.0], [120.0, 0.0, 120.0]);
    for i in 0..60_u8 {
        // A regular scatter that no test tunes: the golden ratio's sequence over the plane.
        let i = f32::from(i);
        let at = [220.0 * (i * 0.754_877_7).fract() - 110.0, 0.0, 220.0 * (i * 0.569_840_3).fract() - 110.0];
        let size = [0.31, 0.47, 0.23].map(|share| (i * share).fract());
        let to = [at[0] + 1.0 + 4.0 * size[0], 1.0 + 9.0 * size[1], at[2] + 1.0 + 4.0 * size[2]];
        add(&format!("box {i}"), at, to);
    }
    scene
}

#[cfg(test)]
mod tests {
    #[test]
    fn the_town_is_a_scene() {
        super::town().validate().expect("valid");
    }
}
