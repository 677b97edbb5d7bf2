//! Height maps: where posts stand, how quads are cut, and what is refused.

use std::path::{Path, PathBuf};

use glam::{DVec3, dvec3};
use image::{ImageBuffer, ImageFormat, Luma};
use proptest::prelude::*;
use serde_json::json;
use umbrage_scene::{Error, HeightMapOptions, OpenOptions, Scene, load_height_map, open};

/// A folder with a height map `land.png` and, if it is given, `land.json`.
struct Land {
    _folder: tempfile::TempDir,
    path: PathBuf,
}

impl Land {
    fn new(png: &[u8], side: Option<serde_json::Value>) -> Self {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("land.png");
        std::fs::write(&path, png).expect("a file");
        if let Some(side) = side {
            std::fs::write(path.with_extension("json"), side.to_string()).expect("a file");
        }
        Self { _folder: folder, path }
    }

    fn load(&self, options: &HeightMapOptions) -> Result<Scene, Error> {
        load_height_map(&self.path, options)
    }
}

fn grey16(width: u32, height: u32, at: impl Fn(u32, u32) -> u16) -> Vec<u8> {
    let picture = ImageBuffer::from_fn(width, height, |i, j| Luma([at(i, j)]));
    let mut bytes = std::io::Cursor::new(Vec::new());
    picture.write_to(&mut bytes, ImageFormat::Png).expect("a small picture can be encoded");
    bytes.into_inner()
}

fn metres(metres_per_post: f64) -> HeightMapOptions {
    HeightMapOptions { metres_per_post: Some(metres_per_post), ..HeightMapOptions::default() }
}

/// Every triangle in the world.
fn triangles(scene: &Scene) -> Vec<[DVec3; 3]> {
    let pose = scene.pose(0.0).unwrap_or_else(|error| panic!("{error}"));
    let mut triangles = Vec::new();
    for object in &pose.objects {
        for primitive in &scene.meshes[object.mesh].primitives {
            for corners in primitive.indices.chunks_exact(3) {
                triangles.push([0, 1, 2].map(|i| {
                    let local = primitive.positions[corners[i] as usize].map(f64::from);
                    object.world_from_local.transform_point3(local.into())
                }));
            }
        }
    }
    triangles
}

#[test]
fn posts_stand_where_the_contract_says() {
    let land = Land::new(
        &grey16(4, 3, |i, j| (10 * j + i) as u16),
        Some(json!({ "cell_x_m": 2.0, "cell_y_m": 5.0, "offset": 100 })),
    );
    let scene = land.load(&HeightMapOptions::default()).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(scene.placed_triangles(), 12);
    let post = |i: f64, j: f64| dvec3((i - 1.5) * 2.0, 10.0 * j + i + 100.0, (j - 1.0) * 5.0);
    let triangles = triangles(&scene);
    // The quad (1, 0), cut along (1, 0) to (2, 1).
    assert_eq!(triangles[2], [post(1.0, 0.0), post(1.0, 1.0), post(2.0, 1.0)]);
    assert_eq!(triangles[3], [post(1.0, 0.0), post(2.0, 1.0), post(2.0, 0.0)]);
    let up = |[a, b, c]: [DVec3; 3]| (b - a).cross(c - a).y > 0.0;
    assert!(triangles.iter().copied().all(up), "triangles face up");
    let pose = scene.pose(0.0).unwrap_or_else(|error| panic!("{error}"));
    assert!(pose.objects.iter().all(|object| object.casts), "terrain casts");
    // A plane has one normal.
    let expected = DVec3::new(-0.5, 1.0, -2.0).normalize().as_vec3();
    for normal in &scene.meshes[0].primitives[0].normals {
        assert!(glam::Vec3::from(*normal).distance(expected) < 1e-6, "{normal:?}");
    }
}

#[test]
fn options_go_before_the_side_file() {
    let land = Land::new(&grey16(2, 2, |_, _| 8), Some(json!({ "cell_x_m": 2.0, "cell_y_m": 5.0, "offset": 100 })));
    let options = HeightMapOptions {
        metres_per_post: Some(3.0),
        metres_per_unit: Some(0.5),
        height_offset: Some(-7.0),
        ..metres(3.0)
    };
    let scene = land.load(&options).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(triangles(&scene)[0], [dvec3(-1.5, -3.0, -1.5), dvec3(-1.5, -3.0, 1.5), dvec3(1.5, -3.0, 1.5)]);
    assert!(scene.notes.is_empty());
    // Without a side file a unit is a metre, and the report says so.
    let bare = Land::new(&grey16(2, 2, |_, _| 8), None).load(&metres(3.0)).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(triangles(&bare)[0][0], dvec3(-1.5, 8.0, -1.5));
    assert_eq!(bare.notes.len(), 1);
}

#[test]
fn eight_bits_are_whole_steps_too() {
    let mut bytes = std::io::Cursor::new(Vec::new());
    let picture: ImageBuffer<Luma<u8>, Vec<u8>> = ImageBuffer::from_fn(2, 2, |i, j| Luma([(200 + i + 2 * j) as u8]));
    picture.write_to(&mut bytes, ImageFormat::Png).expect("a small picture can be encoded");
    let scene = Land::new(&bytes.into_inner(), None).load(&metres(1.0)).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(triangles(&scene)[0].map(|p| p.y), [200.0, 202.0, 203.0]);
}

#[test]
fn what_is_refused() {
    let flat = |width, height| grey16(width, height, |_, _| 5);
    let side = || json!({ "width": 3, "height": 2, "cell_x_m": 1.0, "cell_y_m": 1.0, "height_m": "pixel + offset", "row0": "north" });
    let none = HeightMapOptions::default();
    assert!(Land::new(&flat(3, 2), Some(side())).load(&none).is_ok());

    #[track_caller]
    fn refused(land: &Land, options: &HeightMapOptions, word: &str) {
        let error = land.load(options).expect_err(word);
        assert!(matches!(error, Error::HeightMap { .. }), "{error}");
        let message = error.to_string();
        assert!(message.contains(word) && message.contains("land."), "\"{word}\" is missing in: {message}");
    }
    refused(&Land::new(&flat(3, 2), None), &none, "--metres-per-post");
    refused(&Land::new(&flat(3, 2), Some(json!({ "cell_x_m": 1.0 }))), &none, "cell_y_m");
    for (key, value, word) in [
        ("width", json!(4), "width is 4"),
        ("height", json!(20), "height is 20"),
        ("cell_x_m", json!(0.0), "above 0"),
        ("cell_y_m", json!(-30.0), "above 0"),
        ("cell_x_m", json!(1e-300), "above 0"),
        ("cell_x_m", json!("thirty"), "side file"),
        ("offset", json!(null), ""),
        ("height_m", json!("pixel * 2"), "pixel * 2"),
        ("row0", json!("south"), "south"),
    ] {
        let mut bent = side();
        bent[key] = value;
        let land = Land::new(&flat(3, 2), Some(bent));
        if word.is_empty() {
            assert!(land.load(&none).is_ok());
        } else {
            refused(&land, &none, word);
        }
    }
    refused(&Land::new(&flat(3, 2), Some(json!([]))), &none, "side file");
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e-42] {
        refused(&Land::new(&flat(3, 2), None), &metres(bad), "metres per post");
        refused(
            &Land::new(&flat(3, 2), None),
            &HeightMapOptions { metres_per_unit: Some(bad), ..metres(1.0) },
            "metres per unit",
        );
    }
    refused(
        &Land::new(&flat(3, 2), None),
        &HeightMapOptions { height_offset: Some(f64::NAN), ..metres(1.0) },
        "offset",
    );
    refused(&Land::new(&flat(3, 2), None), &metres(1e30), "1e12");
    refused(&Land::new(&flat(1, 9), None), &metres(1.0), "2×2");
    refused(&Land::new(&flat(9, 1), None), &metres(1.0), "2×2");
    refused(&Land::new(b"no picture", None), &metres(1.0), "picture");
    let whole = flat(64, 64);
    refused(&Land::new(&whole[..whole.len() / 2], None), &metres(1.0), "decoded");
    refused(&Land::new(&[], None), &metres(1.0), "picture");
    let mut color = std::io::Cursor::new(Vec::new());
    image::RgbImage::from_fn(4, 4, |x, y| image::Rgb([(70 * x) as u8, 9, (70 * y) as u8]))
        .write_to(&mut color, ImageFormat::Png)
        .expect("a small picture can be encoded");
    refused(&Land::new(&color.into_inner(), None), &metres(1.0), "grey");
    assert!(matches!(load_height_map(Path::new("/nonexistent/land.png"), &none), Err(Error::Read { .. })));
}

mod common;

#[test]
fn bombs_are_refused() {
    for (width, height) in [(1_000_000, 1_000_000), (16_384, 16_384), (16_385, 2)] {
        let land = Land::new(&common::png_bomb(width, height), None);
        assert!(matches!(land.load(&metres(1.0)), Err(Error::HeightMap { .. })));
    }
}

/// The height of the terrain over a point, found in its triangles.
fn height_over(triangles: &[[DVec3; 3]], x: f64, z: f64) -> Option<f64> {
    triangles.iter().find_map(|[a, b, c]| {
        let cross = |p: DVec3, q: DVec3| (q.x - p.x) * (z - p.z) - (q.z - p.z) * (x - p.x);
        let (wa, wb, wc) = (cross(*b, *c), cross(*c, *a), cross(*a, *b));
        let area = wa + wb + wc;
        let inside = [wa, wb, wc].iter().all(|w| *w * area >= -1e-9 * area * area);
        inside.then(|| (wa * a.y + wb * b.y + wc * c.y) / area)
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// Tiles cover the map without gaps or overlaps: the area is right and heights are those of the
    /// cut quads.
    #[test]
    fn tiles_are_the_map(width in 2_u32..150, height in 2_u32..150, seed in any::<u32>(), at in prop::array::uniform2(0.0..1.0)) {
        let grey = |i: u32, j: u32| ((i.wrapping_mul(7919) ^ j.wrapping_mul(104_729) ^ seed) % 1000) as u16;
        let land = Land::new(&grey16(width, height, grey), Some(json!({ "cell_x_m": 3.0, "cell_y_m": 3.0, "offset": 20 })));
        let scene = land.load(&HeightMapOptions::default()).unwrap_or_else(|error| panic!("{error}"));
        prop_assert_eq!(scene.placed_triangles(), ((width - 1) * (height - 1) * 2) as usize);
        let triangles = triangles(&scene);
        let area: f64 = triangles.iter().map(|[a, b, c]| 0.5 * ((c.x - a.x) * (b.z - a.z) - (b.x - a.x) * (c.z - a.z))).sum();
        prop_assert!((area - f64::from((width - 1) * (height - 1)) * 9.0).abs() < 1e-6 * area);

        let (u, v) = (at[0] * f64::from(width - 1), at[1] * f64::from(height - 1));
        let (i, j) = ((u as u32).min(width - 2), (v as u32).min(height - 2));
        let (s, t) = (u - f64::from(i), v - f64::from(j));
        let y = |di: u32, dj: u32| f64::from(grey(i + di, j + dj)) + 20.0;
        // Below the diagonal (t > s) the triangle has the south-west post, above it the north-east
        // one.
        let expected: f64 = if t > s {
            y(0, 0) + t * (y(0, 1) - y(0, 0)) + s * (y(1, 1) - y(0, 1))
        } else {
            y(0, 0) + s * (y(1, 0) - y(0, 0)) + t * (y(1, 1) - y(1, 0))
        };
        let (x, z) = ((u - 0.5 * f64::from(width - 1)) * 3.0, (v - 0.5 * f64::from(height - 1)) * 3.0);
        let got = height_over(&triangles, x, z);
        prop_assert!(got.is_some_and(|got: f64| (got - expected).abs() < 1e-6 * (1.0 + expected)), "{got:?} {expected}");

        // Seams between tiles: equal posts have equal normals, so no seam can be seen.
        let pose = scene.pose(0.0).unwrap_or_else(|error| panic!("{error}"));
        let mut normals = std::collections::HashMap::new();
        for object in &pose.objects {
            let primitive = &scene.meshes[object.mesh].primitives[0];
            for (position, normal) in primitive.positions.iter().zip(&primitive.normals) {
                let at = object.world_from_local.transform_point3(DVec3::from(position.map(f64::from)));
                let key = ((at.x * 2.0).round() as i64, (at.z * 2.0).round() as i64);
                prop_assert_eq!(*normals.entry(key).or_insert(*normal), *normal);
            }
        }
        prop_assert_eq!(normals.len(), (width * height) as usize);
    }
}

/// The size and the side file of a real terrain: 1197 × 643 posts at 30 m, heights of 315 to 2295 m
/// in whole metres.
#[test]
fn a_terrain_of_many_tiles_is_as_large_as_its_side_file_says() {
    let (width, height) = (1197, 643);
    let png = grey16(width, height, |i, j| ((i * 7919 + j * 104_729) % 1981) as u16);
    let side = json!({"width": width, "height": height, "cell_x_m": 30.0, "cell_y_m": 30.0, "height_m": "pixel + offset", "offset": 315});
    let land = Land::new(&png, Some(side));
    let scene = open(&land.path.display().to_string(), &OpenOptions::default()).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(scene.placed_triangles(), 1_535_664);
    let bounds = scene.pose(0.0).unwrap_or_else(|error| panic!("{error}")).bounds.expect("there are triangles");
    let size = bounds.max - bounds.min;
    assert_eq!([size.x, size.z], [35_880.0, 19_260.0]);
    assert_eq!([bounds.min.y, bounds.max.y], [315.0, 2295.0]);
}
