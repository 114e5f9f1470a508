//! `EXT_meshopt_compression` and `KHR_meshopt_compression`: views whose bytes are compressed.

use super::document::Document;
use super::json::shortened;
use crate::scene::ImportError;
use draco_gltf::meshopt::{MeshoptFilter, MeshoptMode, decode_buffer_view};
use gltf::json::buffer;
use serde_json::Value;

/// Both extensions say the same; the younger one allows a further filter and a second version of the data.
const NAMES: [&str; 2] = ["KHR_meshopt_compression", "EXT_meshopt_compression"];

/// What a view says of its compressed bytes.
struct Packed {
    name: &'static str,
    buffer: usize,
    offset: u64,
    length: u64,
    count: usize,
    stride: usize,
    mode: MeshoptMode,
    filter: MeshoptFilter,
}

impl Document<'_> {
    /// Decompresses all views that are compressed. What they unpack to is taken from the budget before.
    pub(super) fn unpack_views(&mut self) -> Result<(), ImportError> {
        for number in 0..self.root.buffer_views.len() {
            let view = &self.root.buffer_views[number];
            let Some(packed) = packed(number, view)? else { continue };
            let place = || format!("bufferView {number}, {}", packed.name);
            let length = view.byte_length.0;
            let unpacked = packed.count.checked_mul(packed.stride).filter(|all| *all as u64 == length);
            let Some(unpacked) = unpacked else {
                let expected = format!("{length} bytes, as the view has");
                let found = format!("{} times {}", packed.count, packed.stride);
                return Err(ImportError::new(place(), expected, found));
            };
            self.budget.take(unpacked, 1).map_err(|exceeded| exceeded.at(place()))?;
            let source = self.part_of_buffer(place, packed.buffer, packed.offset, packed.length)?;
            let mut bytes = vec![0; unpacked];
            decode_buffer_view(&mut bytes, source, packed.mode, packed.filter, packed.count, packed.stride)
                .map_err(|error| ImportError::new(place(), "compressed data", error.to_string()))?;
            let store = self.store(bytes);
            self.unpacked.insert(number, store);
        }
        Ok(())
    }
}

fn packed(number: usize, view: &buffer::View) -> Result<Option<Packed>, ImportError> {
    let Some(extensions) = &view.extensions else { return Ok(None) };
    let Some(name) = NAMES.into_iter().find(|name| extensions.others.contains_key(*name)) else {
        return Ok(None);
    };
    let json = &extensions.others[name];
    let wrong = |key: &str, expected: &str| {
        let found = json.get(key).map_or_else(|| "none".to_owned(), shortened);
        ImportError::new(format!("bufferView {number}, {name}, {key}"), expected, found)
    };
    let whole = |key: &str, otherwise: Option<u64>| match (json.get(key), otherwise) {
        (None, Some(otherwise)) => Ok(otherwise),
        (value, _) => value.and_then(Value::as_u64).ok_or_else(|| wrong(key, "a whole number")),
    };
    let size = |key: &str| {
        let value = usize::try_from(whole(key, None)?).ok().filter(|size| *size <= u32::MAX as usize);
        value.ok_or_else(|| wrong(key, "a number of 32 bits"))
    };
    let text = |key: &str| json.get(key).map(|value| value.as_str().unwrap_or_default());
    let mode = MeshoptMode::from_name(text("mode").unwrap_or_default())
        .map_err(|_| wrong("mode", "ATTRIBUTES, TRIANGLES or INDICES"))?;
    let filter = MeshoptFilter::from_name(text("filter").unwrap_or("NONE"))
        .map_err(|_| wrong("filter", "NONE, OCTAHEDRAL, QUATERNION, EXPONENTIAL or COLOR"))?;
    Ok(Some(Packed {
        name,
        buffer: size("buffer")?,
        offset: whole("byteOffset", Some(0))?,
        length: whole("byteLength", None)?,
        count: size("count")?,
        stride: size("byteStride")?,
        mode,
        filter,
    }))
}
