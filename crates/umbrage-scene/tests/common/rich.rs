//! A file with everything in it.

use serde_json::json;

use super::*;

/// Everything that the loader knows in one small file.
pub fn rich() -> Glb {
    let mut glb = Glb::triangle();
    let uvs = glb.floats("VEC2", &[0.0, 0.0, 1.0, 0.0, 0.0, 1.0]);
    let normals = glb.accessor(&[0, 0, 127, 0, 0, 0, 127, 0, 0, 0, 127, 0], I8, "VEC3", 3);
    glb.json["accessors"][normals]["normalized"] = json!(true);
    let view = glb.json["accessors"][normals]["bufferView"].as_u64().expect("a number") as usize;
    glb.json["bufferViews"][view]["byteStride"] = json!(4);
    let colors = glb.accessor(&[255; 12], U8, "VEC4", 3);
    glb.json["accessors"][colors]["normalized"] = json!(true);
    let joints = glb.accessor(&[0, 1, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0], U8, "VEC4", 3);
    let weights = glb.floats("VEC4", &[0.5, 0.5, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0]);
    let (changed, values) = (glb.view(&[2, 0]), glb.view(&[0; 12]));
    glb.json["accessors"][0]["sparse"] = json!({
        "count": 1, "indices": { "bufferView": changed, "componentType": U16 }, "values": { "bufferView": values },
    });
    glb.json["meshes"] = json!([
        { "primitives": [{ "attributes": { "POSITION": 0, "TEXCOORD_0": uvs, "NORMAL": normals, "COLOR_0": colors },
            "indices": 1, "material": 0 }] },
        { "primitives": [{ "attributes": { "POSITION": 0, "JOINTS_0": joints, "WEIGHTS_0": weights }, "mode": 5 }] },
    ]);
    let picture = glb.view(&png(2, 2, [1, 2, 3, 4]));
    glb.json["images"] = json!([{ "bufferView": picture, "mimeType": "image/png" }]);
    glb.json["samplers"] = json!([{ "wrapS": 33071, "wrapT": 33648 }]);
    glb.json["textures"] = json!([{ "source": 0, "sampler": 0 }]);
    glb.json["materials"] = json!([{
        "alphaMode": "MASK", "doubleSided": true,
        "pbrMetallicRoughness": { "baseColorTexture": { "index": 0, "extensions": {
            "KHR_texture_transform": { "offset": [0.5, 0.5], "rotation": 1.0, "scale": [2, 2] } } } },
    }]);
    let (times, turns) = (glb.floats("SCALAR", &[0.0, 1.0]), glb.floats("VEC4", &[0., 0., 0., 1., 0., 1., 0., 0.]));
    let moves = glb.floats("VEC3", &[0.0; 18]);
    glb.json["animations"] = json!([{
        "channels": [
            { "sampler": 0, "target": { "node": 1, "path": "rotation" } },
            { "sampler": 1, "target": { "node": 2, "path": "translation" } },
        ],
        "samplers": [{ "input": times, "output": turns }, { "input": times, "output": moves, "interpolation": "CUBICSPLINE" }],
    }]);
    glb.json["skins"] = json!([{ "joints": [1, 2] }]);
    let places = glb.floats("VEC3", &[0.0, 1.0, 2.0, 3.0, 4.0, 5.0]);
    glb.json["extensions"] = json!({ "KHR_lights_punctual": { "lights": [{ "type": "spot", "spot": {} }] } });
    glb.json["cameras"] = json!([{ "type": "perspective", "perspective": { "yfov": 1.0, "znear": 0.1 } }]);
    glb.json["nodes"] = json!([
        { "mesh": 0, "extras": { "castShadow": false }, "children": [1, 3],
          "extensions": { "EXT_mesh_gpu_instancing": { "attributes": { "TRANSLATION": places } } } },
        { "translation": [1, 2, 3], "children": [2] },
        { "camera": 0, "extensions": { "KHR_lights_punctual": { "light": 0 } } },
        { "mesh": 1, "skin": 0, "matrix": [1, 0, 0, 0, 0.5, 1, 0, 0, 0, 0, 1, 0, 1, 2, 3, 1] },
    ]);
    glb
}
