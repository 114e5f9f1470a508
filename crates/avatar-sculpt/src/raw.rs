//! From the sculptor's double precision to the meshes of the raw format.

use avatar_mesh::{FACE_SHAPES, Mesh, Offsets, Shape, Skinning};
use glam::{DVec2, DVec3, Vec2, Vec3};

use crate::{mesh::Part, skin::Skin};

fn vec3(v: DVec3) -> Vec3 {
    // Adding zero turns a negative zero into a plain one: mirrored files stay easy to compare.
    v.as_vec3() + Vec3::ZERO
}

fn vec2(v: DVec2) -> Vec2 {
    v.as_vec2() + Vec2::ZERO
}

/// A rigid part.
#[must_use]
pub fn part(part: &Part) -> Mesh {
    Mesh {
        positions: part.positions.iter().copied().map(vec3).collect(),
        uvs: part.uvs.iter().copied().map(vec2).collect(),
        normals: part.normals.iter().copied().map(vec3).collect(),
        triangles: part.triangles.clone(),
        ..Mesh::default()
    }
}

/// The skin with bones and shapes.
#[must_use]
pub fn skin(skin: &Skin) -> Mesh {
    let vertices = &skin.vertices;
    let shape = |(k, name): (usize, &&str)| {
        let positions = vertices.iter().map(|v| vec3(v.shapes[k].0)).collect::<Offsets>();
        Shape::new(*name, positions)
            .with_normals(vertices.iter().map(|v| vec3(v.shapes[k].1)).collect::<Offsets>())
    };
    Mesh {
        positions: vertices.iter().map(|v| vec3(v.p)).collect(),
        uvs: vertices.iter().map(|v| vec2(v.uv)).collect(),
        normals: vertices.iter().map(|v| vec3(v.normal)).collect(),
        triangles: skin.triangles.clone(),
        skinning: Some(Skinning {
            bones: vertices.iter().map(|v| v.influence.map(|(bone, _)| bone as u16)).collect(),
            weights: vertices.iter().map(|v| weights(v.influence.map(|(_, w)| w))).collect(),
            ..Skinning::default()
        }),
        shapes: FACE_SHAPES.iter().enumerate().map(shape).collect(),
        ..Mesh::default()
    }
}

/// Weights rounded to the file's precision, with the largest taking up what rounding left of 1.
fn weights(exact: [f64; 4]) -> [f32; 4] {
    let mut rounded = exact.map(|w| w.clamp(0.0, 1.0) as f32 + 0.0);
    let largest = (0..4).fold(0, |best, k| if rounded[k] > rounded[best] { k } else { best });
    let others: f64 = (0..4).filter(|k| *k != largest).map(|k| f64::from(rounded[k])).sum();
    rounded[largest] = (1.0 - others) as f32;
    rounded
}
