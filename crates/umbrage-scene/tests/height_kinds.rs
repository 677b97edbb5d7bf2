//! Height maps in all the forms that people have: the same hill from each.

use std::io::Cursor;
use std::path::PathBuf;

use glam::DVec3;
use image::{DynamicImage, ImageBuffer, ImageFormat, Luma, LumaA, Rgb, Rgba};
use tiff::encoder::{TiffEncoder, colortype};
use tiff::tags::Tag;
use umbrage_scene::{HeightEncoding, HeightMapOptions, Scene, load_height_map};

const EDGE: u32 = 17;

/// A hill of whole metres.
fn hill(x: u32, y: u32) -> u16 {
    let (dx, dy) = (f64::from(x) - 8.0, f64::from(y) - 6.0);
    (200.0 * (-(dx * dx + dy * dy) / 20.0).exp()).round() as u16
}

fn folder() -> tempfile::TempDir {
    tempfile::tempdir().expect("a temporary folder")
}

fn png(picture: impl Into<DynamicImage>) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    picture.into().write_to(&mut bytes, ImageFormat::Png).expect("a small picture can be encoded");
    bytes.into_inner()
}

fn load(name: &str, bytes: &[u8], options: &HeightMapOptions) -> Result<Scene, String> {
    let folder = folder();
    let path: PathBuf = folder.path().join(name);
    std::fs::write(&path, bytes).expect("a file");
    load_height_map(&path, options).map_err(|error| error.to_string())
}

/// Heights of all posts, by column and row.
fn heights(scene: &Scene, cell: f64) -> Vec<(i64, i64, f64)> {
    let pose = scene.pose(0.0).unwrap_or_else(|error| panic!("{error}"));
    let mut posts = Vec::new();
    for object in &pose.objects {
        for position in &scene.meshes[object.mesh].primitives[0].positions {
            let at = object.world_from_local.transform_point3(DVec3::from(position.map(f64::from))) / cell;
            let post = |x: f64| (x + 0.5 * f64::from(EDGE - 1)).round() as i64;
            posts.push((post(at.x), post(at.z), (at.y * cell * 256.0).round() / 256.0));
        }
    }
    posts.sort_by_key(|post| (post.1, post.0));
    posts
}

fn expected() -> Vec<(i64, i64, f64)> {
    let row = |y: u32| (0..EDGE).map(move |x| (i64::from(x), i64::from(y), f64::from(hill(x, y))));
    (0..EDGE).flat_map(row).collect()
}

fn metres(metres_per_post: f64) -> HeightMapOptions {
    HeightMapOptions { metres_per_post: Some(metres_per_post), ..HeightMapOptions::default() }
}

#[track_caller]
fn is_the_hill(name: &str, bytes: &[u8], options: &HeightMapOptions) -> Scene {
    let scene = load(name, bytes, options).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(heights(&scene, 30.0), expected(), "{name}");
    scene
}

#[test]
fn grey_in_any_form_is_grey() {
    let h = |x, y| hill(x, y) as u8;
    for (form, bytes) in [
        ("grey", png(ImageBuffer::from_fn(EDGE, EDGE, |x, y| Luma([h(x, y)])))),
        ("grey 16", png(ImageBuffer::from_fn(EDGE, EDGE, |x, y| Luma([hill(x, y)])))),
        ("grey, alpha", png(ImageBuffer::from_fn(EDGE, EDGE, |x, y| LumaA([h(x, y), 255])))),
        ("grey, alpha 16", png(ImageBuffer::from_fn(EDGE, EDGE, |x, y| LumaA([hill(x, y), 65_535])))),
        ("rgb", png(ImageBuffer::from_fn(EDGE, EDGE, |x, y| Rgb([h(x, y); 3])))),
        ("rgba", png(ImageBuffer::from_fn(EDGE, EDGE, |x, y| Rgba([h(x, y), h(x, y), h(x, y), 255])))),
        ("rgb 16", png(ImageBuffer::from_fn(EDGE, EDGE, |x, y| Rgb([hill(x, y); 3])))),
        ("rgba 16", png(ImageBuffer::from_fn(EDGE, EDGE, |x, y| Rgba([hill(x, y), hill(x, y), hill(x, y), 65_535])))),
        ("palette", palette(h)),
    ] {
        let scene = is_the_hill("land.png", &bytes, &metres(30.0));
        assert_eq!(scene.notes.len(), 1, "{form}: {:?}", scene.notes);
        assert!(scene.notes[0].contains("grey was taken for 1 m"), "{form}");
    }
}

/// A PNG with a palette of all greys, uncompressed.
fn palette(at: impl Fn(u32, u32) -> u8) -> Vec<u8> {
    fn crc(bytes: &[u8]) -> u32 {
        !bytes.iter().fold(!0_u32, |crc, byte| {
            (0..8).fold(crc ^ u32::from(*byte), |crc, _| (crc >> 1) ^ (0xedb8_8320 & (crc & 1).wrapping_neg()))
        })
    }
    let mut png = b"\x89PNG\r\n\x1a\n".to_vec();
    let mut chunk = |kind: &[u8; 4], data: &[u8]| {
        let body = [kind.as_slice(), data].concat();
        png.extend((data.len() as u32).to_be_bytes());
        png.extend(&body);
        png.extend(crc(&body).to_be_bytes());
    };
    chunk(b"IHDR", &[&EDGE.to_be_bytes()[..], &EDGE.to_be_bytes(), &[8, 3, 0, 0, 0]].concat());
    chunk(b"PLTE", &(0..=255).flat_map(|i| [i; 3]).collect::<Vec<u8>>());
    let rows: Vec<u8> =
        (0..EDGE).flat_map(|y| [0].into_iter().chain((0..EDGE).map(|x| at(x, y)).collect::<Vec<_>>())).collect();
    let (mut a, mut b) = (1_u32, 0_u32);
    for byte in &rows {
        a = (a + u32::from(*byte)) % 65_521;
        b = (b + a) % 65_521;
    }
    let length = rows.len() as u16;
    let zlib =
        [&[0x78, 1, 1][..], &length.to_le_bytes(), &(!length).to_le_bytes(), &rows, &(b << 16 | a).to_be_bytes()];
    chunk(b"IDAT", &zlib.concat());
    chunk(b"IEND", &[]);
    png
}

#[test]
fn metres_in_colours_are_recognized() {
    let split = |v: u32| Rgb([(v >> 16) as u8, (v >> 8) as u8, v as u8]);
    let terrarium = |x, y| split((u32::from(hill(x, y)) + 32_768) * 256);
    let mapbox = |x, y| split((u32::from(hill(x, y)) + 10_000) * 10);
    for (encoding, bytes) in [
        (HeightEncoding::Terrarium, png(ImageBuffer::from_fn(EDGE, EDGE, terrarium))),
        (HeightEncoding::Mapbox, png(ImageBuffer::from_fn(EDGE, EDGE, mapbox))),
    ] {
        let scene = is_the_hill("land.png", &bytes, &metres(30.0));
        assert!(scene.notes.len() == 1 && scene.notes[0].contains(&format!("{encoding:?}")), "{:?}", scene.notes);
        let told = HeightMapOptions { encoding: Some(encoding), ..metres(30.0) };
        assert!(is_the_hill("land.png", &bytes, &told).notes.is_empty());
    }
    // Half a metre is 128 of Terrarium's blue.
    let half = png(ImageBuffer::from_fn(2, 2, |_, _| Rgb([128, 7, 128_u8])));
    let scene = load("land.png", &half, &metres(30.0)).unwrap_or_else(|error| panic!("{error}"));
    let bounds = scene.pose(0.0).unwrap_or_else(|error| panic!("{error}")).bounds.expect("there are triangles");
    assert_eq!(bounds.min.y, 7.5);
}

#[test]
fn pictures_of_anything_else_are_no_heights() {
    let noise = |x: u32, y: u32| (x.wrapping_mul(7919) ^ y.wrapping_mul(104_729)) % 251;
    let photo = png(ImageBuffer::from_fn(EDGE, EDGE, |x, y| Rgb([noise(x, y) as u8, 90, noise(y, x + 5) as u8])));
    let muddy = png(ImageBuffer::from_fn(EDGE, EDGE, |x, y| Rgb([90 + (noise(x, y) % 70) as u8, 80, 70])));
    for bytes in [photo, muddy] {
        let error = load("land.png", &bytes, &metres(30.0)).expect_err("these are no heights");
        assert!(error.contains("land.png") && error.contains("--height-encoding"), "{error}");
    }
}

#[test]
fn transparent_posts_are_holes() {
    let at = |x: u32, y: u32| LumaA([hill(x, y) as u8, if (x, y) == (4, 4) { 0 } else { 255 }]);
    let scene =
        load("land.png", &png(ImageBuffer::from_fn(EDGE, EDGE, at)), &metres(30.0)).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(scene.placed_triangles(), 2 * (16 * 16 - 4));
    assert_eq!(heights(&scene, 30.0).len(), 17 * 17 - 1);
    assert!(scene.notes.iter().any(|note| note.contains("1 posts")), "{:?}", scene.notes);
    let normals = scene.meshes.iter().flat_map(|mesh| &mesh.primitives[0].normals);
    assert!(normals.flatten().all(|c| c.is_finite()));
    let clear = png(ImageBuffer::from_fn(EDGE, EDGE, |x, y| LumaA([hill(x, y) as u8, 0])));
    assert!(is_the_hill("land.png", &clear, &metres(30.0)).notes.iter().any(|note| note.contains("transparent")));
}

/// Keys of a GeoTIFF as its directory has them.
fn keys(list: &[[u16; 2]]) -> Vec<u16> {
    let header = [1, 1, 0, list.len() as u16];
    header.into_iter().chain(list.iter().flat_map(|&[key, value]| [key, 0, 1, value])).collect()
}

/// A GeoTIFF of floats whose posts are `scale` apart; posts below 0 have no data.
fn geotiff(scale: f64, list: &[[u16; 2]], at: impl Fn(u32, u32) -> f32) -> Vec<u8> {
    let values: Vec<f32> = (0..EDGE).flat_map(|y| (0..EDGE).map(move |x| (x, y))).map(|(x, y)| at(x, y)).collect();
    let mut bytes = Cursor::new(Vec::new());
    let mut tiff = TiffEncoder::new(&mut bytes).expect("a file in memory");
    let mut image = tiff.new_image::<colortype::Gray32Float>(EDGE, EDGE).expect("a picture");
    image.encoder().write_tag(Tag::ModelPixelScaleTag, &[scale, scale, 0.0][..]).expect("a tag");
    image.encoder().write_tag(Tag::GdalNodata, "-9999").expect("a tag");
    if !list.is_empty() {
        image.encoder().write_tag(Tag::GeoKeyDirectoryTag, &keys(list)[..]).expect("a tag");
    }
    image.write_data(&values).expect("data");
    bytes.into_inner()
}

#[test]
fn geotiffs_have_their_scale() {
    let none = HeightMapOptions::default();
    let h = |x, y| f32::from(hill(x, y));
    let projected = is_the_hill("land.tif", &geotiff(30.0, &[[1024, 1], [3076, 9001]], h), &none);
    assert!(projected.notes.is_empty(), "{:?}", projected.notes);
    let bare = is_the_hill("land.tif", &geotiff(30.0, &[], h), &none);
    assert!(bare.notes[0].contains("taken for metres"), "{:?}", bare.notes);
    // In feet, both ways.
    let feet = geotiff(30.0 / 0.3048, &[[1024, 1], [3076, 9002], [4099, 9002]], |x, y| {
        (f64::from(hill(x, y)) / 0.3048) as f32
    });
    let scene = load("land.tif", &feet, &none).unwrap_or_else(|error| panic!("{error}"));
    for (got, wanted) in heights(&scene, 30.0).iter().zip(expected()) {
        assert!((got.2 - wanted.2).abs() < 0.01, "{got:?} {wanted:?}");
    }
    // In degrees there is no scale.
    let degrees = geotiff(0.0003, &[[1024, 2]], h);
    let error = load("land.tif", &degrees, &none).expect_err("degrees are no metres");
    assert!(error.contains("degrees") && error.contains("--metres-per-post"), "{error}");
    is_the_hill("land.tif", &degrees, &metres(30.0));
    // Missing data.
    let holed = geotiff(30.0, &[], |x, y| if (x, y) == (0, 0) { -9999.0 } else { h(x, y) });
    let scene = load("land.tif", &holed, &none).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(scene.placed_triangles(), 2 * (16 * 16 - 1));
    let whole = geotiff(30.0, &[], h);
    for length in [0, 4, 8, 100, whole.len() - 1] {
        assert!(load("land.tif", &whole[..length], &none).is_err(), "{length}");
    }
}

#[test]
fn geotiffs_of_whole_numbers() {
    let values: Vec<i16> = expected().iter().map(|(_, _, y)| *y as i16).collect();
    let mut bytes = Cursor::new(Vec::new());
    let mut tiff = TiffEncoder::new(&mut bytes).expect("a file in memory");
    tiff.write_image::<colortype::GrayI16>(EDGE, EDGE, &values).expect("data");
    is_the_hill("land.tiff", &bytes.into_inner(), &metres(30.0));
}

#[test]
fn ascii_grids_have_their_scale() {
    let grid = |header: &str, missing: Option<(u32, u32)>| {
        let value = |x, y| if missing == Some((x, y)) { "-9999".to_owned() } else { hill(x, y).to_string() };
        let row = |y: u32| (0..EDGE).map(|x| value(x, y)).collect::<Vec<_>>().join(" ");
        let rows: Vec<String> = (0..EDGE).map(row).collect();
        format!("{header}\n{}\n", rows.join("\n")).into_bytes()
    };
    let none = HeightMapOptions::default();
    let header = "ncols 17\nnrows 17\nxllcorner 500000\nyllcorner 4000000\ncellsize 30\nNODATA_value -9999";
    let scene = is_the_hill("land.asc", &grid(header, None), &none);
    assert!(scene.notes[0].contains("taken for metres"), "{:?}", scene.notes);
    is_the_hill("land.asc", &grid("NCOLS 17\r\nNROWS 17\r\nXLLCENTER 0\r\nYLLCENTER 0\r\nDX 30\r\nDY 30", None), &none);
    let holed = load("land.asc", &grid(header, Some((16, 16))), &none).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(holed.placed_triangles(), 2 * (16 * 16 - 1));
    let degrees = "ncols 17\nnrows 17\nxllcorner 8.5\nyllcorner 47\ncellsize 0.0003";
    let error = load("land.asc", &grid(degrees, None), &none).expect_err("degrees are no metres");
    assert!(error.contains("degrees"), "{error}");

    let folder = folder();
    let path = folder.path().join("land.asc");
    std::fs::write(&path, grid(header, None)).expect("a file");
    std::fs::write(
        path.with_extension("prj"),
        "PROJCS[\"x\",GEOGCS[\"y\",UNIT[\"Degree\",0.017]],UNIT[\"Meter\",1.0]]",
    )
    .expect("a file");
    let scene = load_height_map(&path, &none).unwrap_or_else(|error| panic!("{error}"));
    assert!(scene.notes.is_empty() && heights(&scene, 30.0) == expected());
}

#[test]
fn small_files_of_huge_maps_are_refused() {
    let flat = png(ImageBuffer::from_pixel(8192, 8192, Luma([7_u8])));
    assert!(flat.len() < 1 << 20);
    let error = load("land.png", &flat, &metres(1.0)).expect_err("it would take 3 GiB");
    assert!(error.contains("8192×8192"), "{error}");
}
