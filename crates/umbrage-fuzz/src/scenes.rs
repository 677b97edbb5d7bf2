//! Height maps and camera paths.

use umbrage_scene::{CameraPath, HeightEncoding, HeightMapOptions, load_height_map_slice};

/// A name without files beside it, and the format that its content looks like.
fn name(bytes: &[u8]) -> &'static str {
    let is_text = bytes.iter().all(|byte| byte.is_ascii_graphic() || byte.is_ascii_whitespace());
    if is_text { "/nonexistent/map.asc" } else { "/nonexistent/map.png" }
}

/// Loads a height map with its own scale, and with one that is given.
pub fn height_map(bytes: &[u8]) {
    let encodings = [None, Some(HeightEncoding::Terrarium), Some(HeightEncoding::Mapbox), Some(HeightEncoding::Grey)];
    let scaled = HeightMapOptions {
        metres_per_post: Some(30.0),
        encoding: encodings[bytes.len() % encodings.len()],
        ..HeightMapOptions::default()
    };
    for options in [HeightMapOptions::default(), scaled] {
        let Ok(scene) = load_height_map_slice(name(bytes), bytes, &options) else { continue };
        let pose = scene.pose(0.0).unwrap_or_else(|error| panic!("terrain that loaded has no pose: {error}"));
        assert!(pose.objects.iter().all(|object| object.bounds.is_valid()), "bounds of a tile");
        let positions = scene.meshes.iter().flat_map(|mesh| &mesh.primitives).flat_map(|it| &it.positions);
        assert!(positions.flatten().all(|value| value.is_finite()), "no NaN comes out");
    }
}

/// Walks a camera path and writes it.
pub fn path(bytes: &[u8]) {
    let Ok(path) = CameraPath::from_slice("path.json", bytes) else { return };
    for frames in [1, 2, 17] {
        for frame in 0..frames {
            let Ok((eye, target)) = path.pose_at(frame, frames, 1.7) else { continue };
            assert!(eye.is_finite() && target.is_finite(), "frame {frame} of {frames}: {eye} looks at {target}");
        }
    }
    let written = path.to_json().expect("a path that was read can be written");
    let again = CameraPath::from_slice("path.json", written.as_bytes());
    assert_eq!(again.unwrap_or_else(|error| panic!("what we wrote does not load: {error}")), path);
}
