//! Attributes of vertices beside positions, normals and bones.

use super::coordinates::{Looks, UvSource};
use super::document::Document;
use crate::scene::{Finding, ImportError};
use glam::{Vec2, Vec3, Vec4};
use gltf::json::accessor::{ComponentType, Type};
use gltf::json::mesh::{Primitive, Semantic};
use gltf::json::validation::Checked;
use gltf::json::{Accessor, Index};

impl Document<'_> {
    pub(super) fn take(&mut self, place: &str, count: usize, size: usize) -> Result<(), ImportError> {
        self.budget.take(count, size).map_err(|exceeded| exceeded.at(place))
    }

    pub(super) fn per_vertex<const N: usize, T: From<[f32; N]> + bytemuck::Pod>(
        &mut self,
        primitive: &Primitive,
        semantic: Semantic,
        type_: Type,
        vertices: usize,
    ) -> Result<Option<Vec<T>>, ImportError> {
        let Some(accessor) = attribute(primitive, semantic) else { return Ok(None) };
        let values = self.floats::<N, T>(accessor, type_)?;
        same_count(&format!("accessor {}", accessor.value()), vertices, values.len())?;
        Ok(Some(values))
    }

    /// The first and second texture coordinates as the material of a primitive needs them. Without any, the
    /// first are zeros and there are no second ones.
    pub(super) fn coordinates(
        &mut self,
        place: &str,
        primitive: &Primitive,
        looks: Looks,
        vertices: usize,
    ) -> Result<(Vec<Vec2>, Vec<Vec2>), ImportError> {
        let ((first, needs_first), (second, needs_second)) = (looks.first(), looks.second());
        let uvs = self.transformed(place, primitive, first, needs_first, vertices)?;
        let uvs_1 = self.transformed(place, primitive, second, needs_second, vertices)?;
        self.note_attributes(place, primitive, [first.set, second.set]);
        let zeros = || vec![Vec2::ZERO; vertices];
        let uvs = uvs.unwrap_or_else(zeros);
        Ok((uvs, uvs_1.unwrap_or_else(|| if needs_second { zeros() } else { Vec::new() })))
    }

    fn transformed(
        &mut self,
        place: &str,
        primitive: &Primitive,
        source: UvSource,
        is_needed: bool,
        vertices: usize,
    ) -> Result<Option<Vec<Vec2>>, ImportError> {
        let semantic = Semantic::TexCoords(source.set);
        let Some(mut uvs) = self.per_vertex::<2, Vec2>(primitive, semantic, Type::Vec2, vertices)? else {
            self.take(place, vertices, size_of::<Vec2>())?;
            if is_needed {
                let text =
                    format!("has no TEXCOORD_{}, which its material uses: it is 0 everywhere", source.set);
                self.note(place, Finding::Mended(text));
            }
            return Ok(None);
        };
        if let Some(transform) = source.transform {
            uvs.iter_mut().for_each(|uv| *uv = transform.apply(*uv));
        }
        Ok(Some(uvs))
    }

    /// Linear colours and opacities, without opacity 1 (section 3.7.2.1); empty where there are none.
    pub(super) fn colors(
        &mut self,
        place: &str,
        primitive: &Primitive,
        vertices: usize,
    ) -> Result<Vec<Vec4>, ImportError> {
        let semantic = Semantic::Colors(0);
        let Some(accessor) = attribute(primitive, semantic.clone()) else { return Ok(Vec::new()) };
        let json = self.root.accessors.get_mut(accessor.value());
        let is_opaque = json.as_ref().is_some_and(|json| json.type_ == Checked::Valid(Type::Vec3));
        if let Some(json) = json
            && let Checked::Valid(kind) = json.component_type
            && kind.0 != ComponentType::F32
            && !json.normalized
        {
            json.normalized = true;
            self.note(place, Finding::mended("COLOR_0 of integers is taken for fractions"));
        }
        if is_opaque {
            self.take(place, vertices, size_of::<Vec4>())?;
            let colors = self.per_vertex::<3, Vec3>(primitive, semantic, Type::Vec3, vertices)?;
            return Ok(colors.unwrap_or_default().into_iter().map(|color| color.extend(1.0)).collect());
        }
        Ok(self.per_vertex::<4, Vec4>(primitive, semantic, Type::Vec4, vertices)?.unwrap_or_default())
    }

    fn note_attributes(&mut self, place: &str, primitive: &Primitive, sets: [u32; 2]) {
        for semantic in primitive.attributes.keys() {
            let name = match semantic {
                Checked::Valid(Semantic::Colors(set)) if *set > 0 => format!("COLOR_{set}"),
                Checked::Valid(Semantic::TexCoords(set)) if !sets.contains(set) => format!("TEXCOORD_{set}"),
                Checked::Valid(Semantic::Extras(_)) => format!("_{}", extra_name(semantic)),
                Checked::Invalid => "an unknown attribute".to_owned(),
                _ => continue,
            };
            self.note(place, Finding::LeftOut(format!("{name} is left out")));
        }
    }
}

/// The name of an attribute that the file made up, without its underscore; empty for others.
pub(super) fn extra_name(semantic: &Checked<Semantic>) -> &str {
    match semantic {
        Checked::Valid(Semantic::Extras(name)) => name,
        _ => "",
    }
}

pub(super) fn attribute(primitive: &Primitive, semantic: Semantic) -> Option<Index<Accessor>> {
    primitive.attributes.get(&Checked::Valid(semantic)).copied()
}

pub(super) fn same_count(place: &str, vertices: usize, found: usize) -> Result<(), ImportError> {
    if found == vertices {
        return Ok(());
    }
    Err(ImportError::new(place, format!("{vertices} elements, one for each vertex"), found.to_string()))
}
