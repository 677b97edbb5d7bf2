//! Compressed geometry: Draco streams of known meshes, compressed buffer views.

mod common;

use common::*;
use draco_core::{
    DataType, EncoderBuffer, EncoderOptions, FaceIndex, GeometryAttributeType, MeshEncoder, PointAttribute, PointIndex,
};
use serde_json::{Value, json};
use umbrage_scene::{GltfOptions, Scene, load_gltf_slice};

/// Vertices along an edge of the patch.
const EDGE: usize = 9;

/// Positions, normals and triangles.
type Shape = (Vec<[f32; 3]>, Vec<[f32; 3]>, Vec<[u32; 3]>);

/// A bumpy patch.
fn patch() -> Shape {
    let height = |x: f32, z: f32| (x * 0.7).sin() * (z * 0.9).cos();
    let at = |i: usize| ((i % EDGE) as f32, (i / EDGE) as f32);
    let positions = (0..EDGE * EDGE).map(|i| [at(i).0, height(at(i).0, at(i).1), at(i).1]).collect();
    let normal = |i: usize| {
        let (x, z) = at(i);
        let slope = [-0.7 * (x * 0.7).cos() * (z * 0.9).cos(), 1.0, 0.9 * (x * 0.7).sin() * (z * 0.9).sin()];
        let length = slope.iter().map(|c| c * c).sum::<f32>().sqrt();
        slope.map(|c| c / length)
    };
    let normals = (0..EDGE * EDGE).map(normal).collect();
    let quads = (0..EDGE - 1).flat_map(|z| (0..EDGE - 1).map(move |x| (z * EDGE + x) as u32));
    let e = EDGE as u32;
    let triangles = quads.flat_map(|q| [[q, q + e, q + e + 1], [q, q + e + 1, q + 1]]).collect();
    (positions, normals, triangles)
}

fn attribute(kind: GeometryAttributeType, values: &[[f32; 3]]) -> PointAttribute {
    let mut attribute = PointAttribute::new();
    attribute.init(kind, 3, DataType::Float32, false, values.len());
    let bytes: Vec<u8> = values.as_flattened().iter().flat_map(|v| v.to_le_bytes()).collect();
    attribute.buffer_mut().write(0, &bytes);
    attribute
}

/// A Draco stream of the patch; `speed` from 0, small, to 10, sequential.
fn stream(speed: i32) -> Vec<u8> {
    let (positions, normals, triangles) = patch();
    let mut mesh = draco_core::Mesh::new();
    mesh.set_num_points(positions.len());
    mesh.add_attribute(attribute(GeometryAttributeType::Position, &positions));
    mesh.add_attribute(attribute(GeometryAttributeType::Normal, &normals));
    mesh.set_num_faces(triangles.len());
    for (i, triangle) in triangles.iter().enumerate() {
        mesh.set_face(FaceIndex(i as u32), triangle.map(PointIndex));
    }
    let mut options = EncoderOptions::new();
    options.set_global_int("encoding_speed", speed);
    options.set_global_int("decoding_speed", speed);
    options.set_attribute_quantization(0, 14);
    options.set_attribute_quantization(1, 10);
    let mut encoder = MeshEncoder::new();
    encoder.set_mesh(mesh);
    let mut buffer = EncoderBuffer::new();
    encoder.encode(&options, &mut buffer).expect("the patch can be encoded");
    buffer.data().to_vec()
}

/// A file of the patch under Draco.
fn draco(stream: &[u8]) -> Glb {
    let count = EDGE * EDGE;
    let mut glb = Glb::triangle();
    let view = glb.view(stream);
    let described = |kind: &str| json!({ "componentType": F32, "type": kind, "count": count });
    let position = glb.push("accessors", described("VEC3"));
    let normal = glb.push("accessors", described("VEC3"));
    let indices =
        glb.push("accessors", json!({ "componentType": U16, "type": "SCALAR", "count": 6 * (EDGE - 1) * (EDGE - 1) }));
    *glb.primitive() = json!({
        "attributes": { "POSITION": position, "NORMAL": normal }, "indices": indices,
        "extensions": { "KHR_draco_mesh_compression": {
            "bufferView": view, "attributes": { "POSITION": 0, "NORMAL": 1 } } },
    });
    glb.json["extensionsUsed"] = json!(["KHR_draco_mesh_compression"]);
    glb.json["extensionsRequired"] = json!(["KHR_draco_mesh_compression"]);
    glb
}

/// Triangles by their corners, rounded to a thousandth, in an order of their own.
fn shape(scene: &Scene) -> Vec<[[i32; 3]; 3]> {
    let primitive = &scene.meshes[0].primitives[0];
    let corner = |&index: &u32| primitive.positions[index as usize].map(|c| (f64::from(c) * 100.0).round() as i32);
    let mut triangles: Vec<[[i32; 3]; 3]> = primitive
        .indices
        .chunks_exact(3)
        .map(|triangle| {
            let mut corners = [corner(&triangle[0]), corner(&triangle[1]), corner(&triangle[2])];
            // Turned until the least is first; the sense of rotation stays.
            let least = (0..3).min_by_key(|&i| corners[i]).unwrap_or(0);
            corners.rotate_left(least);
            corners
        })
        .collect();
    triangles.sort_unstable();
    triangles
}

/// The patch without compression.
fn plain() -> Glb {
    let (positions, normals, triangles) = patch();
    let mut glb = Glb::triangle();
    let position = glb.floats("VEC3", positions.as_flattened());
    let normal = glb.floats("VEC3", normals.as_flattened());
    let bytes: Vec<u8> = triangles.as_flattened().iter().flat_map(|i| i.to_le_bytes()).collect();
    let indices = glb.accessor(&bytes, U32, "SCALAR", 3 * triangles.len());
    *glb.primitive() = json!({ "attributes": { "POSITION": position, "NORMAL": normal }, "indices": indices });
    glb
}

#[test]
fn draco_streams_of_every_speed_give_the_patch() {
    let expected = plain().scene();
    for speed in [0, 3, 5, 7, 10] {
        let scene = draco(&stream(speed)).scene();
        let primitive = &scene.meshes[0].primitives[0];
        assert_eq!(primitive.indices.len(), expected.meshes[0].primitives[0].indices.len(), "speed {speed}");
        let near = |(a, b): (&[[i32; 3]; 3], &[[i32; 3]; 3])| {
            a.as_flattened().iter().zip(b.as_flattened()).all(|(a, b)| (a - b).abs() <= 1)
        };
        assert!(shape(&scene).iter().zip(&shape(&expected)).all(near), "speed {speed}");
        assert!(primitive.normals.iter().all(|n| n[1] > 0.5), "speed {speed}");
        assert!(!primitive.flat && scene.notes.is_empty(), "{:?}", scene.notes);
    }
}

#[test]
fn draco_streams_that_are_none() {
    let whole = stream(5);
    for length in [0, 4, 11, whole.len() / 2, whole.len() - 1] {
        let error = draco(&whole[..length]).load().expect_err("it is cut short").to_string();
        assert!(error.contains("meshes[0].primitives[0].extensions.KHR_draco_mesh_compression"), "{error}");
    }
    for attributes in [json!({ "POSITION": 9 }), json!({ "NORMAL": 1 }), json!({ "POSITION": "x" })] {
        let mut glb = draco(&whole);
        glb.primitive()["extensions"]["KHR_draco_mesh_compression"]["attributes"] = attributes;
        // Without its positions in the stream a primitive has those of its accessor, which is all
        // zeros.
        if let Err(error) = glb.load() {
            assert!(error.to_string().contains("meshes[0].primitives[0]"), "{error}");
        }
    }
    // Beside accessors with bytes the stream is not needed.
    let mut glb = plain();
    let view = glb.view(&whole[..20]);
    glb.primitive()["extensions"] =
        json!({ "KHR_draco_mesh_compression": { "bufferView": view, "attributes": { "POSITION": 0 } } });
    let scene = glb.scene();
    assert_eq!(shape(&scene), shape(&plain().scene()));
    assert!(scene.notes[0].contains("KHR_draco_mesh_compression"), "{:?}", scene.notes);
}

/// Bytes of elements as a stream of mode 0, version 0, in which each group of each byte stands as
/// it is.
fn attributes(bytes: &[u8], stride: usize) -> Vec<u8> {
    let count = bytes.len() / stride;
    let most = ((8192 / stride) & !15).min(256);
    let mut out = vec![0xa0];
    let mut last = vec![0_u8; stride];
    for block in bytes.chunks(most * stride) {
        let groups = (block.len() / stride).div_ceil(16);
        for byte in 0..stride {
            out.extend(vec![0xff; groups.div_ceil(4)]);
            let mut before = last[byte];
            let mut differences: Vec<u8> = block
                .chunks(stride)
                .map(|element| {
                    let difference = element[byte].wrapping_sub(before);
                    before = element[byte];
                    (difference << 1) ^ (difference.cast_signed() >> 7).cast_unsigned()
                })
                .collect();
            differences.resize(groups * 16, 0);
            out.extend(differences);
        }
        last.copy_from_slice(&block[block.len() - stride..]);
    }
    assert!(count > 0);
    out.extend(vec![0; 32.max(stride)]);
    out
}

/// Indices as a stream of mode 1 in which each is explicit.
fn triangles(indices: &[u32]) -> Vec<u8> {
    let mut out = vec![0xe1];
    out.extend(vec![0xff; indices.len() / 3]);
    let mut last = 0_u32;
    for triangle in indices.chunks(3) {
        out.push(0xff);
        for &index in triangle {
            let difference = index.wrapping_sub(last);
            last = index;
            let mut v = (difference << 1) ^ (difference.cast_signed() >> 31).cast_unsigned();
            while v >= 0x80 {
                out.push(v as u8 | 0x80);
                v >>= 7;
            }
            out.push(v as u8);
        }
    }
    out.extend([0; 16]);
    out
}

/// The patch with compressed buffer views; their own buffer has no bytes.
fn meshopt(name: &str) -> Glb {
    let (positions, normals, faces) = patch();
    let mut glb = Glb::triangle();
    let mut view = |packed: Vec<u8>, mode: &str, stride: usize, count: usize| {
        let offset = glb.binary.len().next_multiple_of(4);
        glb.view(&packed);
        let view = json!({ "buffer": 1, "byteLength": stride * count, "extensions": { name: {
            "buffer": 0, "byteOffset": offset, "byteLength": packed.len(), "byteStride": stride, "count": count,
            "mode": mode } } });
        glb.push("bufferViews", view)
    };
    let bytes = |list: &[[f32; 3]]| list.as_flattened().iter().flat_map(|v| v.to_le_bytes()).collect::<Vec<u8>>();
    let count = EDGE * EDGE;
    let views = [
        view(attributes(&bytes(&positions), 12), "ATTRIBUTES", 12, count),
        view(attributes(&bytes(&normals), 12), "ATTRIBUTES", 12, count),
        view(triangles(faces.as_flattened()), "TRIANGLES", 4, 3 * faces.len()),
    ];
    let accessor = |glb: &mut Glb, view: usize, component: u32, kind: &str, count: usize| {
        glb.push("accessors", json!({ "bufferView": view, "componentType": component, "type": kind, "count": count }))
    };
    let position = accessor(&mut glb, views[0], F32, "VEC3", count);
    let normal = accessor(&mut glb, views[1], F32, "VEC3", count);
    let indices = accessor(&mut glb, views[2], U32, "SCALAR", 3 * faces.len());
    *glb.primitive() = json!({ "attributes": { "POSITION": position, "NORMAL": normal }, "indices": indices });
    glb.json["buffers"] = json!([{ "byteLength": glb.binary.len() },
        { "byteLength": 1_000_000, "extensions": { name: { "fallback": true } } }]);
    glb.json["extensionsRequired"] = json!([name]);
    glb
}

#[test]
fn compressed_buffer_views_give_the_patch() {
    for name in ["EXT_meshopt_compression", "KHR_meshopt_compression"] {
        let scene = meshopt(name).scene();
        assert_eq!(shape(&scene), shape(&plain().scene()));
        assert_eq!(scene.meshes[0].primitives[0].normals, plain().scene().meshes[0].primitives[0].normals);
        assert!(scene.notes.is_empty());
    }
}

#[test]
fn compressed_buffer_views_that_lie() {
    let refused = |field: &str, value: Value| {
        let name = "EXT_meshopt_compression";
        let mut glb = meshopt(name);
        let views = glb.json["bufferViews"].as_array_mut().expect("a list");
        let view = views.iter_mut().find(|view| view["buffer"] == 1).expect("a compressed view");
        view["extensions"][name][field] = value;
        glb.load().expect_err("it lies").to_string()
    };
    for (field, value) in [
        ("count", json!(82)),
        ("count", json!(80)),
        ("count", json!(1_u64 << 60)),
        ("byteStride", json!(13)),
        ("byteStride", json!(0)),
        ("byteLength", json!(3)),
        ("byteLength", json!(1_u64 << 60)),
        ("mode", json!("WAVES")),
        ("mode", json!("INDICES")),
        ("filter", json!("QUATERNION")),
        ("buffer", json!(7)),
        ("byteOffset", json!(8)),
    ] {
        let message = refused(field, value.clone());
        assert!(message.contains("bufferViews["), "{field} {value}: {message}");
    }
}

#[test]
fn streams_of_the_common_encoder_give_the_patch() {
    let expected = plain().scene();
    let files: [(&str, &[u8]); 2] =
        [("patch-ext", include_bytes!("files/patch-ext.glb")), ("patch-khr", include_bytes!("files/patch-khr.glb"))];
    for (name, bytes) in files {
        let scene = load_gltf_slice(name, bytes, &GltfOptions::default()).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(shape(&scene), shape(&expected), "{name}");
        let (got, wanted) = (&scene.meshes[0].primitives[0], &expected.meshes[0].primitives[0]);
        // The encoder keeps the order of vertices; 8 bits of a normal are half a degree.
        for (a, b) in got.normals.iter().zip(&wanted.normals) {
            assert!(a.iter().zip(b).all(|(a, b)| (a - b).abs() < 0.02), "{name}: {a:?} {b:?}");
        }
    }
}
