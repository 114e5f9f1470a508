//! Parts: for each node with a mesh, one for each of the mesh's materials.

use super::coordinates::Coordinates;
use super::shapes::Blend;
use super::skin::BoundSkin;
use super::{note, place_of, vec3};
use crate::build::budget::{Budget, Exceeded};
use crate::build::corners::{Corner, Corners};
use crate::build::srgb;
use crate::scene::{Finding, ImportError, RawScene, ScenePart};
use glam::{Vec2, Vec3, Vec4};

/// Reads all parts, and their skins, shapes and weights on the way. Returns the shapes of nodes that have
/// any.
pub(super) fn read<'a>(
    fbx: &'a ufbx::Scene,
    coordinates: &Coordinates,
    scene: &mut RawScene,
    budget: &mut Budget,
) -> Result<Vec<Blend<'a>>, ImportError> {
    let mut blends = Vec::new();
    for node in &fbx.nodes {
        let Some(mesh) = &node.mesh else { continue };
        let place = place_of(node);
        let wrong = |exceeded: Exceeded| exceeded.at(place.as_str());
        budget.take(mesh.vertices.len(), 1).map_err(wrong)?;
        let points: Vec<Vec3> = mesh.vertices.iter().map(|point| vec3(*point)).collect();
        let blend = Blend::of(node, mesh, &mut scene.notes);
        let second = coordinates.second(mesh);
        let mut skin = None;
        let parts_before = scene.parts.len();
        for (primitive, segment) in mesh.material_parts.iter().enumerate() {
            let corners = corners(mesh, second, segment, budget, &place)?;
            if corners.is_empty() {
                continue;
            }
            let number = node.element.typed_id as usize;
            let mut mesh_here = corners.mesh(&points);
            mesh_here.shapes = match &blend {
                Some(blend) => blend.shapes(&corners, budget).map_err(wrong)?,
                None => Vec::new(),
            };
            let mut part = ScenePart::rigid(&name_of(node, mesh), number, mesh_here);
            part.primitive = primitive;
            part.material = material_of(node, mesh, segment.index).filter(|at| *at < scene.materials.len());
            if skin.is_none() {
                skin = BoundSkin::read(node, mesh, scene)?;
            }
            if let Some(skin) = &skin {
                part.skin = Some(skin.number);
                part.mesh.skinning = Some(corners.skinning(&skin.influences));
            }
            scene.parts.push(part);
        }
        if mesh.num_line_faces + mesh.num_point_faces > 0 {
            let text = "faces with less than three corners are left out";
            note(&mut scene.notes, place.as_str(), Finding::left_out(text));
        }
        if mesh.subdivision_display_mode != ufbx::SubdivisionDisplayMode::Disabled {
            let text = "it is a subdivision surface, of which the cage is read";
            note(&mut scene.notes, place.as_str(), Finding::converted(text));
        }
        for (what, count, read) in
            [("colours", mesh.color_sets.len(), 1), ("texture coordinates", mesh.uv_sets.len(), 2)]
        {
            if count > read {
                let text = format!("{} further sets of {what} are left out", count - read);
                note(&mut scene.notes, place.as_str(), Finding::LeftOut(text));
            }
        }
        if let Some(blend) = blend {
            if scene.parts.len() > parts_before {
                blend.write(scene);
            }
            blends.push(blend);
        }
    }
    Ok(blends)
}

fn name_of(node: &ufbx::Node, mesh: &ufbx::Mesh) -> String {
    let name = if node.element.name.is_empty() { &mesh.element.name } else { &node.element.name };
    name.to_string()
}

/// Nodes have materials of their own for the mesh they show.
fn material_of(node: &ufbx::Node, mesh: &ufbx::Mesh, index: u32) -> Option<usize> {
    let materials = if node.materials.is_empty() { &mesh.materials } else { &node.materials };
    Some(materials.get(index as usize)?.element.typed_id as usize)
}

fn corners(
    mesh: &ufbx::Mesh,
    second: Option<&ufbx::UvSet>,
    segment: &ufbx::MeshPart,
    budget: &mut Budget,
    place: &str,
) -> Result<Corners, ImportError> {
    let mut corners = Corners::default();
    let mut triangles = vec![0; mesh.max_face_triangles.saturating_mul(3)];
    for &face in &segment.face_indices {
        let hole = mesh.face_hole.get(face as usize).copied().unwrap_or(false);
        let Some(&face) = mesh.faces.get(face as usize).filter(|face| face.num_indices >= 3 && !hole) else {
            continue;
        };
        // The library's function stops the program where this room is too small.
        if (face.num_indices as usize - 2).saturating_mul(3) > triangles.len() {
            let expected = format!("at most {} corners in a face", triangles.len() / 3 + 2);
            return Err(ImportError::new(place, expected, face.num_indices.to_string()));
        }
        let vertices_before = corners.vertices.len();
        let count = mesh.triangulate_face(&mut triangles, face) as usize;
        budget.take(count, 1).map_err(|exceeded| exceeded.at(place))?;
        for triangle in triangles.as_chunks::<3>().0.iter().take(count) {
            corners.triangle(triangle.map(|index| corner(mesh, second, index as usize)));
        }
        // A vertex takes more than a triangle: itself, and what finds those like it.
        let new = corners.vertices.len() - vertices_before;
        budget.take(new, 2).map_err(|exceeded| exceeded.at(place))?;
    }
    Ok(corners)
}

fn corner(mesh: &ufbx::Mesh, second: Option<&ufbx::UvSet>, index: usize) -> Corner {
    let value = |values: &ufbx::VertexVec3| {
        let at = *values.indices.get(index)?;
        Some(vec3(*values.values.get(at as usize)?)).filter(|value| value.is_finite())
    };
    // Origin bottom left in FBX.
    let coordinates = |uvs: &ufbx::VertexVec2| {
        let uv = uvs.values.get(*uvs.indices.get(index)? as usize)?;
        Some(Vec2::new(uv.x as f32, 1.0 - uv.y as f32)).filter(|uv| uv.is_finite())
    };
    let normal = value(&mesh.vertex_normal).and_then(Vec3::try_normalize);
    let tangent = value(&mesh.vertex_tangent).and_then(Vec3::try_normalize);
    let bitangent = value(&mesh.vertex_bitangent);
    let tangent = match (normal, tangent, bitangent) {
        (Some(normal), Some(tangent), Some(bitangent)) => {
            // v grows downward here and upward in FBX, so its direction is the opposite one; glTF's
            // definition of the bitangent counts v upward on the picture, too, and keeps the sign.
            let hand = if normal.cross(tangent).dot(bitangent) < 0.0 { -1.0 } else { 1.0 };
            tangent.extend(hand)
        }
        _ => Vec4::ZERO,
    };
    let point = mesh.vertex_indices.get(index).copied().unwrap_or(0);
    Corner {
        point,
        uv: coordinates(&mesh.vertex_uv).unwrap_or_default(),
        normal,
        tangent,
        uv_1: second.map(|set| coordinates(&set.vertex_uv).unwrap_or_default()),
        color: color(mesh, index),
    }
}

/// FBX does not say how colours of vertices are encoded. Blender writes and reads them as sRGB unless it is
/// told otherwise (`io_scene_fbx`, `colors_type`), and three.js's FBXLoader reads them so.
fn color(mesh: &ufbx::Mesh, index: usize) -> Option<Vec4> {
    let at = *mesh.vertex_color.indices.get(index)?;
    let color = mesh.vertex_color.values.get(at as usize)?;
    let encoded = [color.x, color.y, color.z].map(|x| x as f32);
    let [r, g, b] = srgb::linear(encoded);
    Some(Vec4::new(r, g, b, (color.w as f32).clamp(0.0, 1.0))).filter(|color| color.is_finite())
}
