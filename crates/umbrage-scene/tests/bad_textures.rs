//! Textures that are missing, damaged or too large: left out with a note, unless an alpha mask
//! depends on them.

mod common;

use common::*;
use serde_json::{Value, json};
use umbrage_scene::Error;

/// A triangle with a texture from a picture.
fn textured(image: Value) -> Glb {
    bent(|g| {
        g.json["images"] = json!([image]);
        g.json["textures"] = json!([{ "source": 0 }]);
        g.json["materials"] = json!([{ "pbrMetallicRoughness": { "baseColorTexture": { "index": 0 } } }]);
        g.primitive()["material"] = json!(0);
        let uvs = g.floats("VEC2", &[0.0; 6]);
        g.primitive()["attributes"]["TEXCOORD_0"] = json!(uvs);
    })
}

fn data_uri(bytes: &[u8]) -> Value {
    json!({ "uri": format!("data:image/png;base64,{}", base64(bytes)) })
}

#[test]
fn pictures_that_are_none_or_bombs() {
    let good = textured(data_uri(&png(2, 3, [9, 8, 7, 255]))).scene();
    assert_eq!((good.textures[0].width, good.textures[0].height), (2, 3));
    assert_eq!(good.textures[0].rgba[..4], [9, 8, 7, 255]);

    for (width, height) in [(1_000_000, 1_000_000), (16_385, 1), (1, 16_385), (16_384, 16_384), (0, 5)] {
        noted(&textured(data_uri(&png_bomb(width, height))), &["images[0]"]);
    }
    // The header is honest and the data is not there.
    noted(&textured(data_uri(&png_bomb(64, 64))), &["images[0]"]);
    let picture = png(16, 16, [1, 2, 3, 4]);
    for length in [0, 4, 20, picture.len() / 2] {
        noted(&textured(data_uri(&picture[..length])), &["images[0]"]);
    }
    noted(&textured(data_uri(b"GIF89a......")), &["images[0]"]);
    noted(&textured(json!({ "uri": "data:image/png;base64,@@@@" })), &["images[0]", "base64"]);
    noted(&textured(json!({ "uri": "data:image/png;base64" })), &["images[0]", "comma"]);
    noted(&textured(json!({})), &["images[0]"]);
    noted(&textured(json!({ "bufferView": 99 })), &["images[0]", "bufferViews[99]"]);
    let mut glb = textured(data_uri(&png(1, 1, [0; 4])));
    glb.json["textures"][0]["source"] = json!(5);
    noted(&glb, &["textures[0]", "images[5]"]);
    glb.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["index"] = json!(5);
    refused(&glb, &["materials[0]", "textures[5]"]);
}

#[test]
fn what_an_alpha_mask_depends_on_has_to_be_readable() {
    for image in [json!({ "uri": "nowhere.png" }), data_uri(b"GIF89a......"), data_uri(&png_bomb(64, 64))] {
        let mut glb = textured(image);
        glb.json["materials"][0]["alphaMode"] = json!("MASK");
        glb.json["materials"][0]["name"] = json!("leaf");
        let error = refused(&glb, &["materials[0] (leaf)", "textures[0]", "images[0]"]);
        assert!(matches!(error, Error::Image { .. }), "{error}");
        glb.json["materials"][0]["alphaMode"] = json!("BLEND");
        noted(&glb, &["materials[0] (leaf)", "images[0]"]);
    }
}
