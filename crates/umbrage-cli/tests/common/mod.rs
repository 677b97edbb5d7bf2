//! Running the command in a folder of its own, and the files it is run on.

#![allow(dead_code, reason = "each test file uses some of this")]

use std::{
    fs,
    path::{Path, PathBuf},
    process::{Command, Output, Stdio},
    sync::OnceLock,
};

/// Where the command lies.
pub const UMBRAGE: &str = env!("CARGO_BIN_EXE_umbrage");

/// A temporary folder in which the command runs, with the scene files of [`Folder::new`] in it.
pub struct Folder {
    folder: tempfile::TempDir,
    given: Vec<String>,
}

impl Folder {
    /// A folder with `tiny.glb` (a box of 2 m above a plane of 40 m), `empty.gltf` and `path.json`.
    pub fn new() -> Self {
        let folder = tempfile::tempdir().expect("a temporary folder");
        fs::write(folder.path().join("tiny.glb"), tiny_glb()).expect("tiny.glb");
        fs::write(folder.path().join("empty.gltf"), EMPTY_GLTF).expect("empty.gltf");
        fs::write(folder.path().join("path.json"), path_json()).expect("path.json");
        let mut new = Self { folder, given: Vec::new() };
        new.given = new.names();
        new
    }

    /// A folder with one more file.
    pub fn with(name: &str, bytes: impl AsRef<[u8]>) -> Self {
        let mut new = Self::new();
        fs::write(new.at(name), bytes).expect("the extra file");
        new.given = new.names();
        new
    }

    /// A path in the folder.
    pub fn at(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// All names in the folder, sorted.
    pub fn names(&self) -> Vec<String> {
        names(self.folder.path())
    }

    /// The names that were not there at first.
    pub fn new_names(&self) -> Vec<String> {
        self.names().into_iter().filter(|name| !self.given.contains(name)).collect()
    }

    /// Runs `umbrage` with these words, split at blanks, in the folder.
    pub fn run(&self, words: &str) -> Output {
        self.command(words).output().expect("the command starts")
    }

    /// The command, not yet started.
    pub fn command(&self, words: &str) -> Command {
        let mut command = Command::new(UMBRAGE);
        command.current_dir(self.folder.path()).args(words.split_whitespace()).stdin(Stdio::null());
        command
    }

    /// Runs `umbrage` and demands success and silence but for notes.
    pub fn succeed(&self, words: &str) {
        let output = self.run(words);
        assert!(output.status.success(), "umbrage {words}: {:?}\n{}", output.status, stderr(&output));
        let said = stderr(&output);
        let chatter: Vec<&str> = said.lines().filter(|line| !line.starts_with("umbrage: note: ")).collect();
        assert_eq!(chatter, [""; 0], "umbrage {words}: no bar in a pipe, no chatter");
    }

    /// Runs `umbrage` and demands exit code 2, all of `culprits` in the message, and no file left.
    pub fn refuse(&self, words: &str, culprits: &[&str]) {
        let output = self.run(words);
        self.is_refusal(words, &output, culprits);
    }

    /// What [`Folder::refuse`] demands of an output.
    pub fn is_refusal(&self, words: &str, output: &Output, culprits: &[&str]) {
        let message = stderr(output);
        assert_eq!(output.status.code(), Some(2), "umbrage {words}: {:?}\n{message}", output.status);
        for culprit in culprits {
            assert!(message.contains(culprit), "umbrage {words}: the message does not name {culprit:?}\n{message}");
        }
        assert!(!message.contains("panicked"), "umbrage {words}: {message}");
        assert_eq!(self.new_names(), [""; 0], "umbrage {words}: files are left");
    }

    /// A report, or any JSON.
    pub fn json(&self, name: &str) -> serde_json::Value {
        let text = fs::read(self.at(name)).expect("the JSON file is there");
        serde_json::from_slice(&text).expect("it is JSON")
    }

    /// A mask: 8-bit grey and alpha.
    pub fn mask(&self, name: &str) -> image::GrayAlphaImage {
        match image::open(self.at(name)).expect("the mask is there") {
            image::DynamicImage::ImageLumaA8(mask) => mask,
            other => panic!("{name} is {:?}, not 8-bit grey and alpha", other.color()),
        }
    }
}

/// All names in a folder, sorted.
pub fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).expect("the folder can be read");
    let mut names: Vec<String> =
        entries.map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

/// What the command said on standard error.
pub fn stderr(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// Whether there is a graphics adapter. Says so loudly if not; fails where one is demanded.
pub fn has_adapter() -> bool {
    static FOUND: OnceLock<bool> = OnceLock::new();
    *FOUND.get_or_init(|| {
        let output = Command::new(UMBRAGE).arg("adapter").output().expect("the command starts");
        let found = output.status.success();
        assert!(
            found || std::env::var_os("UMBRAGE_REQUIRE_GPU").is_none_or(|value| value != "1"),
            "UMBRAGE_REQUIRE_GPU is 1, but {}",
            stderr(&output)
        );
        if !found {
            eprintln!("SKIPPED: no adapter");
        }
        found
    })
}

/// A scene without anything.
pub const EMPTY_GLTF: &str = r#"{"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[]}]}"#;

/// Two points and a sun.
pub fn path_json() -> String {
    let points: Vec<String> = (0..20).map(|i| format!("[{},0,{}]", i - 10, 15 - i)).collect();
    format!(r#"{{"sun_direction_to_light":[0.3,1.0,0.2],"closed":false,"points":[{}]}}"#, points.join(","))
}

/// A plane of 40 m at y = 0 and a box of 2 m whose middle stands at y = 2, as binary glTF.
pub fn tiny_glb() -> Vec<u8> {
    glb(&tiny_json(8), &tiny_bin())
}

/// The JSON of [`tiny_glb`]; `corners` is what it claims the box has.
pub fn tiny_json(corners: u32) -> String {
    format!(
        r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0,1,2,4]}}],
"extensionsUsed":["KHR_lights_punctual"],
"extensions":{{"KHR_lights_punctual":{{"lights":[{{"type":"directional","name":"sun"}},{{"type":"point","name":"lamp"}}]}}}},
"cameras":[{{"type":"perspective","name":"front","perspective":{{"yfov":1.0,"znear":0.5,"zfar":200}}}}],
"nodes":[{{"name":"ground","mesh":0}},{{"name":"box","mesh":1,"translation":[0,2,0]}},
{{"name":"rig","camera":0,"translation":[0,6,14],"rotation":[-0.2,0,0,0.979796],"children":[3]}},
{{"name":"sun","rotation":[-0.5,0,0,0.866025],"extensions":{{"KHR_lights_punctual":{{"light":0}}}}}},
{{"name":"lamp","translation":[0,9,0],"extensions":{{"KHR_lights_punctual":{{"light":1}}}}}}],
"meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}},"indices":1}}]}},{{"primitives":[{{"attributes":{{"POSITION":2}},"indices":3}}]}}],
"accessors":[
{{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3","min":[-20,0,-20],"max":[20,0,20]}},
{{"bufferView":1,"componentType":5123,"count":6,"type":"SCALAR"}},
{{"bufferView":2,"componentType":5126,"count":{corners},"type":"VEC3","min":[-1,-1,-1],"max":[1,1,1]}},
{{"bufferView":3,"componentType":5123,"count":36,"type":"SCALAR"}}],
"bufferViews":[{{"buffer":0,"byteOffset":0,"byteLength":48}},{{"buffer":0,"byteOffset":48,"byteLength":12}},
{{"buffer":0,"byteOffset":60,"byteLength":96}},{{"buffer":0,"byteOffset":156,"byteLength":72}}],
"buffers":[{{"byteLength":228}}]}}"#
    )
}

/// The buffer of [`tiny_glb`].
pub fn tiny_bin() -> Vec<u8> {
    let mut bin = Vec::new();
    let floats = |bin: &mut Vec<u8>, values: &[f32]| bin.extend(values.iter().flat_map(|value| value.to_le_bytes()));
    let indices = |bin: &mut Vec<u8>, values: &[u16]| bin.extend(values.iter().flat_map(|value| value.to_le_bytes()));
    floats(&mut bin, &[-20., 0., -20., 20., 0., -20., -20., 0., 20., 20., 0., 20.]);
    indices(&mut bin, &[0, 2, 1, 1, 2, 3]);
    for corner in 0..8 {
        let side = |bit: u32| if corner >> bit & 1 == 0 { -1.0 } else { 1.0 };
        floats(&mut bin, &[side(0), side(1), side(2)]);
    }
    for [a, b, c, d] in [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]] {
        indices(&mut bin, &[a, b, c, a, c, d]);
    }
    bin
}

/// A binary glTF of these two chunks.
pub fn glb(json: &str, bin: &[u8]) -> Vec<u8> {
    let mut json = json.as_bytes().to_vec();
    json.resize(json.len().next_multiple_of(4), b' ');
    let mut bin = bin.to_vec();
    bin.resize(bin.len().next_multiple_of(4), 0);
    let word = |value: usize| u32::try_from(value).expect("a small file").to_le_bytes();
    [
        b"glTF".as_slice(),
        &word(2),
        &word(12 + 8 + json.len() + 8 + bin.len()),
        &word(json.len()),
        b"JSON",
        &json,
        &word(bin.len()),
        b"BIN\0",
        &bin,
    ]
    .concat()
}

/// A PNG whose header claims a 16-bit grey picture of this size, and that holds next to nothing.
pub fn bomb_png(width: u32, height: u32) -> Vec<u8> {
    let chunk = |kind: &[u8; 4], data: &[u8]| {
        let body = [kind.as_slice(), data].concat();
        let length = u32::try_from(data.len()).expect("a small chunk").to_be_bytes();
        [length.as_slice(), &body, &crc32(&body).to_be_bytes()].concat()
    };
    let header = [width.to_be_bytes().as_slice(), &height.to_be_bytes(), &[16, 0, 0, 0, 0]].concat();
    [
        b"\x89PNG\r\n\x1a\n".as_slice(),
        &chunk(b"IHDR", &header),
        &chunk(b"IDAT", &[0x78, 0x9c, 0x03, 0, 0, 0, 0, 1]),
        &chunk(b"IEND", &[]),
    ]
    .concat()
}

fn crc32(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(!0, |crc, &byte| {
        (0..8).fold(crc ^ u32::from(byte), |crc, _| if crc & 1 == 1 { crc >> 1 ^ 0xedb8_8320 } else { crc >> 1 })
    })
}
