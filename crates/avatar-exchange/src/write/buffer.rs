use avatar_mesh::Offsets;
use serde_json::{Map, Value, json};
use std::collections::BTreeMap;

const U8: u32 = 5121;
const U16: u32 = 5123;
const U32: u32 = 5125;
const F32: u32 = 5126;

/// What the JSON of an accessor with two more views takes at least.
const SPARSE_OVERHEAD_BYTES: usize = 256;

/// What a buffer view is used for on the graphics card.
#[derive(Clone, Copy, Debug)]
pub(super) enum Target {
    /// Attributes of vertices.
    Vertices = 34962,
    /// Corners of triangles.
    Indices = 34963,
}

/// The binary data, and what the JSON says of it.
#[derive(Debug, Default)]
pub(super) struct Buffer {
    bytes: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
    /// Accessors of key times by their bits: the channels of a clip mostly share them.
    times: BTreeMap<Vec<u32>, usize>,
}

impl Buffer {
    /// Accessors, views and bytes.
    pub(super) fn finish(self) -> (Vec<Value>, Vec<Value>, Vec<u8>) {
        (self.accessors, self.views, self.bytes)
    }

    /// A view of these bytes, which begins at a multiple of 4.
    pub(super) fn view(&mut self, bytes: impl IntoIterator<Item = u8>, target: Option<Target>) -> usize {
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        let start = self.bytes.len();
        self.bytes.extend(bytes);
        let mut view = Map::new();
        view.insert("buffer".to_owned(), json!(0));
        view.insert("byteOffset".to_owned(), json!(start));
        view.insert("byteLength".to_owned(), json!(self.bytes.len() - start));
        if let Some(target) = target {
            view.insert("target".to_owned(), json!(target as u32));
        }
        self.views.push(Value::Object(view));
        self.views.len() - 1
    }

    fn accessor(&mut self, view: Option<usize>, component: u32, type_: &str, count: usize) -> usize {
        let mut accessor = Map::new();
        if let Some(view) = view {
            accessor.insert("bufferView".to_owned(), json!(view));
        }
        accessor.insert("componentType".to_owned(), json!(component));
        accessor.insert("count".to_owned(), json!(count));
        accessor.insert("type".to_owned(), json!(type_));
        self.accessors.push(Value::Object(accessor));
        self.accessors.len() - 1
    }

    /// Adds a member to the JSON of the last accessor.
    fn add(&mut self, key: &str, value: Value) {
        if let Some(Value::Object(accessor)) = self.accessors.last_mut() {
            accessor.insert(key.to_owned(), value);
        }
    }

    /// An accessor of floats: scalars, vectors or matrices by their number.
    pub(super) fn vectors<const N: usize>(
        &mut self,
        values: impl Iterator<Item = [f32; N]>,
        target: Option<Target>,
        with_bounds: bool,
    ) -> usize {
        let mut bounds = Bounds::default();
        let mut bytes = Vec::new();
        for value in values {
            bounds.add(value);
            bytes.extend(value.iter().flat_map(|x| x.to_le_bytes()));
        }
        let view = self.view(bytes, target);
        let accessor = self.accessor(Some(view), F32, type_of(N), bounds.count);
        if with_bounds {
            self.bounds(&bounds);
        }
        accessor
    }

    /// Times of keys; equal ones share an accessor.
    pub(super) fn times(&mut self, times: &[f32]) -> usize {
        let bits: Vec<u32> = times.iter().map(|time| time.to_bits()).collect();
        if let Some(&known) = self.times.get(&bits) {
            return known;
        }
        let accessor = self.vectors(times.iter().map(|time| [*time]), None, true);
        self.times.insert(bits, accessor);
        accessor
    }

    /// Corners of triangles, in 16 bits where these suffice: the largest number of a type is not for
    /// vertices.
    pub(super) fn corners(&mut self, corners: &[u32]) -> usize {
        let is_small = corners.iter().all(|corner| *corner < u32::from(u16::MAX));
        let (component, bytes): (_, Vec<u8>) = if is_small {
            (U16, corners.iter().flat_map(|corner| (*corner as u16).to_le_bytes()).collect())
        } else {
            (U32, corners.iter().flat_map(|corner| corner.to_le_bytes()).collect())
        };
        let view = self.view(bytes, Some(Target::Indices));
        self.accessor(Some(view), component, "SCALAR", corners.len())
    }

    /// Joints of vertices, in 8 bits where these suffice.
    pub(super) fn joints(&mut self, joints: &[[u16; 4]]) -> usize {
        let all = joints.as_flattened();
        let (component, bytes): (_, Vec<u8>) = if all.iter().all(|joint| *joint <= u16::from(u8::MAX)) {
            (U8, all.iter().map(|joint| *joint as u8).collect())
        } else {
            (U16, all.iter().flat_map(|joint| joint.to_le_bytes()).collect())
        };
        let view = self.view(bytes, Some(Target::Vertices));
        self.accessor(Some(view), component, "VEC4", joints.len())
    }

    /// Offsets of a morph target: those of moved vertices only, where that takes less room.
    pub(super) fn offsets(&mut self, offsets: &Offsets, with_bounds: bool) -> usize {
        let (len, moved) = (offsets.len(), offsets.moved_vertices());
        let largest = offsets.iter().last().map_or(0, |(vertex, _)| vertex);
        let (component, index_bytes) = match largest {
            0..=0xfe => (U8, 1),
            0xff..=0xfffe => (U16, 2),
            _ => (U32, 4),
        };
        let sparse_bytes = moved.saturating_mul(index_bytes + 12).saturating_add(SPARSE_OVERHEAD_BYTES);
        if moved > 0 && sparse_bytes >= len.saturating_mul(12) {
            let target = Some(Target::Vertices);
            return self.vectors(offsets.per_vertex().map(|offset| offset.to_array()), target, with_bounds);
        }
        let mut bounds = Bounds::default();
        if moved < len {
            bounds.add([0.0; 3]);
        }
        offsets.iter().for_each(|(_, offset)| bounds.add(offset.to_array()));
        // Without any data, an accessor is all zeros.
        if moved == 0 {
            let accessor = self.accessor(None, F32, type_of(3), len);
            if with_bounds {
                self.bounds(&bounds);
            }
            return accessor;
        }
        let indices: Vec<u8> = offsets
            .iter()
            .flat_map(|(vertex, _)| (vertex as u32).to_le_bytes().into_iter().take(index_bytes))
            .collect();
        let indices = self.view(indices, None);
        let values: Vec<u8> =
            offsets.iter().flat_map(|(_, offset)| offset.to_array()).flat_map(f32::to_le_bytes).collect();
        let values = self.view(values, None);
        let accessor = self.accessor(None, F32, type_of(3), len);
        if with_bounds {
            self.bounds(&bounds);
        }
        let indices = json!({ "bufferView": indices, "componentType": component });
        self.add("sparse", json!({ "count": moved, "indices": indices, "values": { "bufferView": values } }));
        accessor
    }

    fn bounds<const N: usize>(&mut self, bounds: &Bounds<N>) {
        self.add("min", super::numbers(&bounds.min));
        self.add("max", super::numbers(&bounds.max));
    }
}

fn type_of(width: usize) -> &'static str {
    match width {
        1 => "SCALAR",
        2 => "VEC2",
        3 => "VEC3",
        4 => "VEC4",
        _ => "MAT4",
    }
}

/// The least and the largest of each component.
struct Bounds<const N: usize> {
    count: usize,
    min: [f32; N],
    max: [f32; N],
}

impl<const N: usize> Default for Bounds<N> {
    fn default() -> Self {
        Self { count: 0, min: [0.0; N], max: [0.0; N] }
    }
}

impl<const N: usize> Bounds<N> {
    fn add(&mut self, value: [f32; N]) {
        if self.count == 0 {
            (self.min, self.max) = (value, value);
        }
        self.count += 1;
        for (i, x) in value.into_iter().enumerate() {
            self.min[i] = self.min[i].min(x);
            self.max[i] = self.max[i].max(x);
        }
    }
}
