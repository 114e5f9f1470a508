//! Small glTF files.

use avatar_exchange::{ImportError, Scene, gltf};
use std::path::Path;

/// Reads a file and what it refers to beside it.
pub fn read_file(path: &Path) -> Result<Scene, ImportError> {
    let bytes = std::fs::read(path).expect("a readable file");
    let folder = path.parent().expect("a folder");
    let name = path.file_name().expect("a name").to_string_lossy();
    let mut resolve = |uri: &str| std::fs::read(folder.join(uri)).map_err(|error| error.to_string());
    gltf::read(&name, &bytes, &mut resolve)
}

/// Reads bytes that refer to nothing else.
pub fn read(bytes: &[u8]) -> Result<Scene, ImportError> {
    gltf::read("test", bytes, &mut |_| Err("no other files".to_owned()))
}

/// A GLB of JSON and binary data.
pub fn glb(json: &str, bin: &[u8]) -> Vec<u8> {
    let padded = |bytes: &[u8], with: u8| {
        let mut bytes = bytes.to_vec();
        bytes.resize(bytes.len().next_multiple_of(4), with);
        bytes
    };
    let (json, bin) = (padded(json.as_bytes(), b' '), padded(bin, 0));
    let mut glb = b"glTF".to_vec();
    let word = |glb: &mut Vec<u8>, word: usize| {
        glb.extend(u32::try_from(word).expect("a small file").to_le_bytes());
    };
    word(&mut glb, 2);
    word(&mut glb, 12 + 8 + json.len() + 8 + bin.len());
    for (kind, chunk) in [(0x4e4f_534a, &json), (0x004e_4942, &bin)] {
        word(&mut glb, chunk.len());
        word(&mut glb, kind);
        glb.extend_from_slice(chunk);
    }
    glb
}

/// Little-endian bytes of floats.
pub fn floats(values: &[f32]) -> Vec<u8> {
    values.iter().flat_map(|value| value.to_le_bytes()).collect()
}

/// A glTF file in the making: accessors with data of their own, and the rest as JSON text.
#[derive(Default)]
pub struct Builder {
    bin: Vec<u8>,
    views: Vec<String>,
    accessors: Vec<String>,
    /// Further buffers, as JSON.
    buffers: String,
}

pub const I8: u32 = 5120;
pub const U8: u32 = 5121;
pub const I16: u32 = 5122;
pub const U16: u32 = 5123;
pub const U32: u32 = 5125;
pub const F32: u32 = 5126;

impl Builder {
    /// A file whose second buffer has no data, as a compressed one's.
    pub fn with_fallback(extension: &str) -> Self {
        let buffers =
            format!(r#", {{"byteLength": 4096, "extensions": {{"{extension}": {{"fallback": true}}}}}}"#);
        Self { buffers, ..Self::default() }
    }

    /// A bufferView as JSON text.
    pub fn raw_view(&mut self, json: String) -> usize {
        self.views.push(json);
        self.views.len() - 1
    }

    /// Where the bytes of a view are, and how many there are.
    pub fn range(&self, view: usize) -> (usize, usize) {
        let json: serde_json::Value = serde_json::from_str(&self.views[view]).expect("JSON");
        let number = |key: &str| json[key].as_u64().expect("a number") as usize;
        (number("byteOffset"), number("byteLength"))
    }

    /// Changes the JSON of the view that was added last.
    pub fn change_last_view(&mut self, change: impl Fn(String) -> String) {
        let view = self.views.pop().expect("a view");
        self.views.push(change(view));
    }

    /// A bufferView of these bytes; `more` is JSON such as `, "byteStride": 8`.
    pub fn view(&mut self, bytes: &[u8], more: &str) -> usize {
        let (offset, length) = (self.bin.len(), bytes.len());
        self.bin.extend_from_slice(bytes);
        self.views.push(format!(r#"{{"buffer": 0, "byteOffset": {offset}, "byteLength": {length}{more}}}"#));
        self.views.len() - 1
    }

    /// An accessor as JSON text.
    pub fn raw_accessor(&mut self, json: String) -> usize {
        self.accessors.push(json);
        self.accessors.len() - 1
    }

    /// An accessor of a view of its own.
    pub fn accessor(&mut self, bytes: &[u8], component: u32, type_: &str, count: usize) -> usize {
        self.accessor_with(bytes, component, type_, count, "")
    }

    /// The same with more members.
    pub fn accessor_with(
        &mut self,
        bytes: &[u8],
        component: u32,
        type_: &str,
        count: usize,
        more: &str,
    ) -> usize {
        let view = self.view(bytes, "");
        self.raw_accessor(format!(
            r#"{{"bufferView": {view}, "componentType": {component}, "type": "{type_}", "count": {count}{more}}}"#
        ))
    }

    /// An accessor of floats.
    pub fn floats(&mut self, values: &[f32], type_: &str) -> usize {
        let width = match type_ {
            "SCALAR" => 1,
            "VEC2" => 2,
            "VEC3" => 3,
            "VEC4" => 4,
            _ => 16,
        };
        self.accessor(&floats(values), F32, type_, values.len() / width)
    }

    /// A triangle's corners at the origin, x and y.
    pub fn triangle(&mut self) -> usize {
        self.floats(&[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0], "VEC3")
    }

    /// The file; `rest` are further members of its JSON.
    pub fn glb(&self, rest: &str) -> Vec<u8> {
        let json = format!(
            r#"{{"asset": {{"version": "2.0"}}, "buffers": [{{"byteLength": {}}}{}], "bufferViews": [{}], "accessors": [{}], {rest}}}"#,
            self.bin.len(),
            self.buffers,
            self.views.join(", "),
            self.accessors.join(", ")
        );
        glb(&json, &self.bin)
    }

    /// The scene; `rest` are further members of the JSON.
    pub fn scene(&self, rest: &str) -> Scene {
        read(&self.glb(rest)).unwrap_or_else(|error| panic!("{error}"))
    }

    /// The error that the file gives.
    pub fn error(&self, rest: &str) -> ImportError {
        read(&self.glb(rest)).expect_err("an error")
    }
}

/// Members of a file with one mesh of one primitive at one node.
pub fn one_primitive(primitive: &str) -> String {
    format!(r#""nodes": [{{"mesh": 0}}], "meshes": [{{"primitives": [{primitive}]}}]"#)
}
