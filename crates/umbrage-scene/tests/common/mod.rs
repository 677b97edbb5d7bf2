//! Small glTF files made by hand, for tests that bend them.
#![expect(dead_code, reason = "each test binary uses a part of this")]

pub mod exercise;
pub mod rich;

use serde_json::{Value, json};
use umbrage_scene::{Error, GltfOptions, Scene, load_gltf_slice};

pub const U8: u32 = 5121;
pub const U16: u32 = 5123;
pub const U32: u32 = 5125;
pub const I8: u32 = 5120;
pub const I16: u32 = 5122;
pub const F32: u32 = 5126;

/// A .glb in the making.
#[derive(Clone, Debug)]
pub struct Glb {
    pub json: Value,
    pub binary: Vec<u8>,
}

impl Glb {
    /// No nodes, no meshes.
    pub fn empty() -> Self {
        Self { json: json!({ "asset": { "version": "2.0" } }), binary: Vec::new() }
    }

    /// One node with one triangle in the plane z = 0, facing +Z, with indices; all its parts are
    /// number 0.
    pub fn triangle() -> Self {
        let mut glb = Self::empty();
        let positions = glb.floats("VEC3", &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0]);
        let indices = glb.accessor(&[0, 0, 1, 0, 2, 0], U16, "SCALAR", 3);
        glb.json["meshes"] =
            json!([{ "primitives": [{ "attributes": { "POSITION": positions }, "indices": indices }] }]);
        glb.json["nodes"] = json!([{ "name": "thing", "mesh": 0 }]);
        glb.json["scenes"] = json!([{ "nodes": [0] }]);
        glb.json["scene"] = json!(0);
        glb
    }

    pub fn view(&mut self, bytes: &[u8]) -> usize {
        self.binary.resize(self.binary.len().next_multiple_of(4), 0);
        let view = json!({ "buffer": 0, "byteOffset": self.binary.len(), "byteLength": bytes.len() });
        self.binary.extend_from_slice(bytes);
        self.push("bufferViews", view)
    }

    pub fn accessor(&mut self, bytes: &[u8], component: u32, kind: &str, count: usize) -> usize {
        let view = self.view(bytes);
        self.push("accessors", json!({ "bufferView": view, "componentType": component, "type": kind, "count": count }))
    }

    pub fn floats(&mut self, kind: &str, values: &[f32]) -> usize {
        let components = match kind {
            "SCALAR" => 1,
            "VEC2" => 2,
            "VEC3" => 3,
            "VEC4" => 4,
            _ => 16,
        };
        let bytes: Vec<u8> = values.iter().flat_map(|value| value.to_le_bytes()).collect();
        self.accessor(&bytes, F32, kind, values.len() / components)
    }

    /// Appends to a list of the document and returns the index.
    pub fn push(&mut self, list: &str, value: Value) -> usize {
        if self.json[list].is_null() {
            self.json[list] = json!([]);
        }
        let list = self.json[list].as_array_mut().expect("the lists of a document are arrays");
        list.push(value);
        list.len() - 1
    }

    pub fn primitive(&mut self) -> &mut Value {
        &mut self.json["meshes"][0]["primitives"][0]
    }

    pub fn bytes(&self) -> Vec<u8> {
        let mut json = self.json.clone();
        if json["buffers"].is_null() && !self.binary.is_empty() {
            json["buffers"] = json!([{ "byteLength": self.binary.len() }]);
        }
        container(json.to_string().as_bytes(), Some(&self.binary))
    }

    pub fn load(&self) -> Result<Scene, Error> {
        load_gltf_slice("test.glb", &self.bytes(), &GltfOptions::default())
    }

    #[track_caller]
    pub fn scene(&self) -> Scene {
        self.load().unwrap_or_else(|error| panic!("{error}"))
    }
}

pub fn container(json: &[u8], binary: Option<&[u8]>) -> Vec<u8> {
    let pad = |bytes: &[u8], with: u8| {
        let mut bytes = bytes.to_vec();
        bytes.resize(bytes.len().next_multiple_of(4), with);
        bytes
    };
    let mut chunks = vec![(b"JSON", pad(json, b' '))];
    chunks.extend(binary.map(|binary| (b"BIN\0", pad(binary, 0))));
    let length: usize = 12 + chunks.iter().map(|(_, content)| 8 + content.len()).sum::<usize>();
    let mut file = b"glTF".to_vec();
    file.extend(2_u32.to_le_bytes());
    file.extend((length as u32).to_le_bytes());
    for (kind, content) in chunks {
        file.extend((content.len() as u32).to_le_bytes());
        file.extend(kind);
        file.extend(content);
    }
    file
}

/// A PNG of one colour.
pub fn png(width: u32, height: u32, rgba: [u8; 4]) -> Vec<u8> {
    let mut bytes = std::io::Cursor::new(Vec::new());
    image::RgbaImage::from_pixel(width, height, image::Rgba(rgba))
        .write_to(&mut bytes, image::ImageFormat::Png)
        .expect("a small picture can be encoded");
    bytes.into_inner()
}

/// A PNG header that promises more pixels than anyone has; its data is a few bytes.
pub fn png_bomb(width: u32, height: u32) -> Vec<u8> {
    fn chunk(kind: &[u8; 4], data: &[u8]) -> Vec<u8> {
        let mut body = kind.to_vec();
        body.extend_from_slice(data);
        let mut chunk = (data.len() as u32).to_be_bytes().to_vec();
        chunk.extend_from_slice(&body);
        chunk.extend_from_slice(&crc32(&body).to_be_bytes());
        chunk
    }
    fn crc32(bytes: &[u8]) -> u32 {
        !bytes.iter().fold(!0_u32, |crc, byte| {
            (0..8).fold(crc ^ u32::from(*byte), |crc, _| (crc >> 1) ^ (0xedb8_8320 & (crc & 1).wrapping_neg()))
        })
    }
    let mut header = width.to_be_bytes().to_vec();
    header.extend(height.to_be_bytes());
    header.extend([8, 6, 0, 0, 0]);
    let mut png = b"\x89PNG\r\n\x1a\n".to_vec();
    png.extend(chunk(b"IHDR", &header));
    png.extend(chunk(b"IDAT", &[0x78, 0x9c, 0x03, 0x00, 0x00, 0x00, 0x00, 0x01]));
    png.extend(chunk(b"IEND", &[]));
    png
}

/// Base64, for data: URIs.
pub fn base64(bytes: &[u8]) -> String {
    const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::new();
    for three in bytes.chunks(3) {
        let bits = (0..3).fold(0_u32, |bits, i| bits << 8 | u32::from(three.get(i).copied().unwrap_or(0)));
        for i in 0..4 {
            let digit = DIGITS[(bits >> (18 - 6 * i)) as usize & 63] as char;
            text.push(if i <= three.len() { digit } else { '=' });
        }
    }
    text
}

/// Loads, expects an error, and expects all of `parts` in its message.
#[track_caller]
pub fn refused(glb: &Glb, parts: &[&str]) -> Error {
    let error = glb.load().expect_err("this file lies");
    let message = error.to_string();
    for part in parts.iter().chain(&["test.glb"]) {
        assert!(message.contains(part), "\"{part}\" is missing in: {message}");
    }
    error
}

/// Loads and expects a note with all of `parts`.
#[track_caller]
pub fn noted(glb: &Glb, parts: &[&str]) -> Scene {
    let scene = glb.scene();
    let says = |note: &String| parts.iter().all(|part| note.contains(part));
    assert!(scene.notes.iter().any(says), "no note has all of {parts:?}: {:?}", scene.notes);
    scene
}

pub fn bent(bend: impl FnOnce(&mut Glb)) -> Glb {
    let mut glb = Glb::triangle();
    bend(&mut glb);
    glb
}
