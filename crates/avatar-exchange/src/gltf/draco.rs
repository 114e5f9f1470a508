//! `KHR_draco_mesh_compression`: primitives whose vertices and triangles are compressed.

use super::document::{Document, in_range};
use crate::scene::ImportError;
use draco_core::{DataType, DecodeLimits, DecoderBuffer, Mesh, MeshDecoder, PointAttribute, PointIndex};
use gltf::json::accessor::{ComponentType, GenericComponentType, Type};
use gltf::json::mesh::Mode;
use gltf::json::validation::{Checked, USize64};
use gltf::json::{Accessor, Index, buffer};
use serde_json::Value;

const NAME: &str = "KHR_draco_mesh_compression";
/// What a triangle and a vertex take while they are decoded, without the values of their attributes.
const TRIANGLE_COST: u64 = 64;
const VERTEX_COST: u64 = 16;

impl Document<'_> {
    /// Decompresses all primitives that are compressed: they get accessors of their own in the place of the
    /// file's, so that what reads them need not know.
    pub(super) fn unpack_primitives(&mut self) -> Result<(), ImportError> {
        for mesh in 0..self.root.meshes.len() {
            for primitive in 0..self.root.meshes[mesh].primitives.len() {
                let extensions = &self.root.meshes[mesh].primitives[primitive].extensions;
                let Some(json) = extensions.as_ref().and_then(|all| all.others.get(NAME)).cloned() else {
                    continue;
                };
                let place = format!("mesh {mesh}, primitive {primitive}, {NAME}");
                self.unpack_primitive(&place, mesh, primitive, &json)?;
            }
        }
        Ok(())
    }

    fn unpack_primitive(
        &mut self,
        place: &str,
        mesh: usize,
        primitive: usize,
        json: &Value,
    ) -> Result<(), ImportError> {
        let view = json.get("bufferView").and_then(Value::as_u64).and_then(|view| u32::try_from(view).ok());
        let Some(view) = view else { return Err(ImportError::new(place, "a bufferView", "none")) };
        let left = self.budget.left();
        let limits = DecodeLimits::default()
            .with_max_decoded_bytes(left)
            .with_max_faces(left / TRIANGLE_COST)
            .with_max_points(left / VERTEX_COST);
        let mut packed = DecoderBuffer::new(self.view(Index::new(view))?.bytes).with_limits(limits);
        let mut found = Mesh::new();
        MeshDecoder::new()
            .decode(&mut packed, &mut found)
            .map_err(|error| ImportError::new(place, "a mesh that Draco can decode", error.to_string()))?;
        let vertices = found.num_points();
        self.take(place, found.num_faces(), TRIANGLE_COST as usize)?;
        self.take(place, vertices, VERTEX_COST as usize)?;
        // Also what the file does not name: many primitives may have the same data decoded again.
        let attributes = (0..found.num_attributes()).filter_map(|id| found.try_attribute(id).ok());
        let decoded = attributes.map(|attribute| attribute.buffer().data().len()).sum();
        self.take(place, decoded, 1)?;

        let attributes = json.get("attributes").and_then(Value::as_object);
        let of_primitive = &self.root.meshes[mesh].primitives[primitive];
        let mut given = Vec::new();
        for (semantic, accessor) in &of_primitive.attributes {
            let Checked::Valid(valid) = semantic else { continue };
            let id = attributes.and_then(|all| all.get(&valid.to_string())).and_then(Value::as_u64);
            let Some(id) = id.and_then(|id| u32::try_from(id).ok()) else { continue };
            given.push((valid.clone(), *accessor, id));
        }
        let mut indices = Vec::with_capacity(3 * size_of::<u32>() * found.num_faces());
        for corner in found.faces().iter().flatten() {
            indices.extend(corner.0.to_le_bytes());
        }
        // Of the template, only what is not said here stays.
        let template = of_primitive.indices.or(given.first().map(|(_, accessor, _)| *accessor));
        for (semantic, accessor, id) in given {
            let attribute = found.attribute_by_unique_id(id).ok_or_else(|| {
                ImportError::new(place, format!("an attribute {id} for {}", semantic.to_string()), "none")
            })?;
            let (kind, type_) = kind_of(attribute).ok_or_else(|| {
                let found = format!("{} of {:?}", attribute.num_components(), attribute.data_type());
                ImportError::new(place, "one to four numbers of at most 32 bits", found)
            })?;
            let size = kind.size() * type_.multiplicity();
            self.take(place, vertices, size)?;
            let bytes = values(attribute, vertices, size).map_err(|vertex| {
                let expected = format!("a value of {} for each vertex", semantic.to_string());
                ImportError::new(place, expected, format!("none for vertex {vertex}"))
            })?;
            let new = self.add_accessor(accessor, bytes, kind, type_, vertices)?;
            self.root.meshes[mesh].primitives[primitive].attributes.insert(Checked::Valid(semantic), new);
        }
        if let Some(template) = template {
            let corners = indices.len() / size_of::<u32>();
            let new = self.add_accessor(template, indices, ComponentType::U32, Type::Scalar, corners)?;
            let of_primitive = &mut self.root.meshes[mesh].primitives[primitive];
            of_primitive.indices = Some(new);
            of_primitive.mode = Checked::Valid(Mode::Triangles);
            if let Some(indices) = self.root.accessors.get_mut(new.value()) {
                indices.normalized = false;
            }
        }
        Ok(())
    }

    /// A copy of an accessor with other data.
    fn add_accessor(
        &mut self,
        template: Index<Accessor>,
        bytes: Vec<u8>,
        kind: ComponentType,
        type_: Type,
        count: usize,
    ) -> Result<Index<Accessor>, ImportError> {
        let mut accessor = in_range("accessors", &self.root.accessors, template.value())?.clone();
        let view = buffer::View {
            buffer: Index::new(0),
            byte_length: USize64::from(bytes.len()),
            byte_offset: None,
            byte_stride: None,
            name: None,
            target: None,
            extensions: None,
            extras: None,
        };
        let store = self.store(bytes);
        self.unpacked.insert(self.root.buffer_views.len(), store);
        accessor.buffer_view = Some(position(self.root.buffer_views.len())?);
        self.root.buffer_views.push(view);
        accessor.byte_offset = None;
        accessor.component_type = Checked::Valid(GenericComponentType(kind));
        accessor.type_ = Checked::Valid(type_);
        accessor.count = USize64::from(count);
        accessor.sparse = None;
        let number = position(self.root.accessors.len())?;
        self.root.accessors.push(accessor);
        Ok(number)
    }
}

fn position<T>(number: usize) -> Result<Index<T>, ImportError> {
    let number = u32::try_from(number)
        .map_err(|_| ImportError::new("accessors", "positions of 32 bits", number.to_string()))?;
    Ok(Index::new(number))
}

/// How the values of an attribute are stored, in the words of glTF.
fn kind_of(attribute: &PointAttribute) -> Option<(ComponentType, Type)> {
    let kind = match attribute.data_type() {
        DataType::Int8 => ComponentType::I8,
        DataType::Uint8 => ComponentType::U8,
        DataType::Int16 => ComponentType::I16,
        DataType::Uint16 => ComponentType::U16,
        DataType::Uint32 => ComponentType::U32,
        DataType::Float32 => ComponentType::F32,
        _ => return None,
    };
    let type_ = match attribute.num_components() {
        1 => Type::Scalar,
        2 => Type::Vec2,
        3 => Type::Vec3,
        4 => Type::Vec4,
        _ => return None,
    };
    Some((kind, type_))
}

/// The value of each vertex, one after the other, or the first vertex that has none.
fn values(attribute: &PointAttribute, vertices: usize, size: usize) -> Result<Vec<u8>, u32> {
    let data = attribute.buffer().data();
    let stride = usize::try_from(attribute.byte_stride()).unwrap_or(size);
    let mut values = Vec::with_capacity(vertices * size);
    for vertex in 0..u32::try_from(vertices).unwrap_or(u32::MAX) {
        let value = attribute.mapped_index(PointIndex(vertex)).0 as usize;
        match value.checked_mul(stride).and_then(|from| data.get(from..from.checked_add(size)?)) {
            Some(bytes) => values.extend_from_slice(bytes),
            None => return Err(vertex),
        }
    }
    Ok(values)
}

#[cfg(test)]
#[allow(clippy::expect_used, reason = "a test may panic")]
mod tests {
    use super::super::container::Container;
    use super::super::document::Document;
    use super::values;
    use crate::build::budget::Budget;
    use draco_core::{AttributeValueIndex, DataType, GeometryAttributeType, PointAttribute, PointIndex};
    use serde_json::{Value, json};

    /// A pyramid of five corners and six triangles: places, texture coordinates and four bytes of colour, by
    /// Google's Draco 1.5.7.
    const PYRAMID: &str = "445241434f02020100000006050100010200020300040101040202040303040001030009030000030902000102020400020202010\
        00101000c03cd0c2335330304e082f83f0000000000fcffff0000000003f03f00000000ff070000000101000b036926cd0c1bcd0\
        c0305f59da4fc2f2000000000ff030000000101000903cd0c9919139d1903de90b0698061c6bc5c76d6cc8c0600000000ff00000\
        0000000000000000000000000000000400b00000000000000000000803f0a";

    fn pyramid() -> Vec<u8> {
        let digit = |digit: u8| char::from(digit).to_digit(16).and_then(|digit| u8::try_from(digit).ok());
        let digits: Vec<u8> = PYRAMID.bytes().filter_map(digit).collect();
        digits.chunks(2).map(|pair| 16 * pair[0] + pair[1]).collect()
    }

    /// What is decoded counts also where the primitive names nothing of it, and what is named counts again,
    /// since it is copied for each vertex.
    #[test]
    fn all_that_is_decoded_counts_against_the_budget() {
        let bin = pyramid();
        let json = json!({
            "asset": {"version": "2.0"},
            "buffers": [{"byteLength": bin.len()}],
            "bufferViews": [{"buffer": 0, "byteLength": bin.len()}],
            "accessors": [{"componentType": 5126, "count": 5, "type": "VEC3"}],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}]
        })
        .to_string();
        let container = Container { json: json.as_bytes(), bin: Some(&bin) };
        let mut resolve = |_: &str| Err("no files".to_owned());
        let mut document = Document::open(&container, 0, &mut resolve).expect("a good file");
        let mut unpack = |left: u64, attributes: Value| {
            document.budget = Budget::with_bytes_left(left);
            let extension = json!({"bufferView": 0, "attributes": attributes});
            let outcome = document.unpack_primitive("p", 0, 0, &extension);
            outcome.map(|()| left - document.budget.left()).map_err(|error| error.expected)
        };
        // Triangles and vertices, then 12, 8 and 4 bytes for each of the five.
        let decoded = 6 * 64 + 5 * 16 + 5 * (12 + 8 + 4);
        let plenty = 1 << 20;
        assert_eq!(unpack(plenty, json!({})), Ok(decoded));
        assert_eq!(unpack(plenty, json!({"POSITION": 0})), Ok(decoded + 5 * 12));
        assert_eq!(unpack(decoded + 5 * 12, json!({"POSITION": 0})), Ok(decoded + 5 * 12));
        let error = unpack(decoded + 5 * 12 - 1, json!({"POSITION": 0})).expect_err("one byte less");
        assert_eq!(error, "at most 59 bytes more in a file of this size");
        assert!(unpack(decoded - 1, json!({})).is_err());
    }

    /// Data that the decoder accepts may still lack the value of a vertex: that is told, and is no zero.
    #[test]
    fn a_value_that_is_missing_is_told() {
        let mut colors = PointAttribute::new();
        colors.init(GeometryAttributeType::Color, 4, DataType::Uint8, true, 2);
        colors.buffer_mut().data_mut().copy_from_slice(&[1, 2, 3, 4, 5, 6, 7, 8]);
        assert_eq!(values(&colors, 2, 4), Ok(vec![1, 2, 3, 4, 5, 6, 7, 8]));
        assert_eq!(values(&colors, 3, 4), Err(2));
        colors.set_explicit_mapping(3);
        for (vertex, value) in [(0, 1), (1, 0), (2, 1)] {
            colors.set_point_map_entry(PointIndex(vertex), AttributeValueIndex(value));
        }
        assert_eq!(values(&colors, 3, 4), Ok(vec![5, 6, 7, 8, 1, 2, 3, 4, 5, 6, 7, 8]));
        colors.set_point_map_entry(PointIndex(1), AttributeValueIndex(2));
        assert_eq!(values(&colors, 3, 4), Err(1));
        // Beyond those that have one at all.
        assert_eq!(values(&colors, 4, 4), Err(1));
    }
}
