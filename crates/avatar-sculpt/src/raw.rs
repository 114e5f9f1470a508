//! The raw format: little-endian floats and indices.

use glam::{DVec2, DVec3};

use crate::{mesh::Part, skin::Skin};

/// Bytes of a skin vertex.
pub const SKIN_VERTEX_BYTES: usize = 124;
/// Bytes of a vertex of any other part.
pub const PART_VERTEX_BYTES: usize = 32;

fn put(out: &mut Vec<u8>, value: f64) {
    // Adding zero turns a negative zero into a plain one: mirrored files stay easy to compare.
    out.extend((value as f32 + 0.0).to_le_bytes());
}

fn put3(out: &mut Vec<u8>, v: DVec3) {
    v.to_array().iter().for_each(|c| put(out, *c));
}

fn put2(out: &mut Vec<u8>, v: DVec2) {
    v.to_array().iter().for_each(|c| put(out, *c));
}

/// Triangles as an index file.
#[must_use]
pub fn indices(triangles: &[[u32; 3]]) -> Vec<u8> {
    triangles.iter().flatten().flat_map(|i| i.to_le_bytes()).collect()
}

/// A rigid part's vertex file.
#[must_use]
pub fn part_vertices(part: &Part) -> Vec<u8> {
    let mut out = Vec::with_capacity(part.positions.len() * PART_VERTEX_BYTES);
    for ((p, uv), n) in part.positions.iter().zip(&part.uvs).zip(&part.normals) {
        put3(&mut out, *p);
        put2(&mut out, *uv);
        put3(&mut out, *n);
    }
    out
}

/// The skin's vertex file.
#[must_use]
pub fn skin_vertices(skin: &Skin) -> Vec<u8> {
    let mut out = Vec::with_capacity(skin.vertices.len() * SKIN_VERTEX_BYTES);
    for v in &skin.vertices {
        put3(&mut out, v.p);
        put2(&mut out, v.uv);
        put3(&mut out, v.normal);
        v.influence.iter().for_each(|(bone, _)| put(&mut out, *bone as f64));
        weights(v.influence.map(|(_, w)| w)).iter().for_each(|w| put(&mut out, *w));
        (0..3).for_each(|_| put(&mut out, 0.0));
        for (offset, normal) in v.shapes {
            put3(&mut out, offset);
            put3(&mut out, normal);
        }
    }
    out
}

/// Weights rounded to the file's precision, with the largest taking up what rounding left of 1.
fn weights(exact: [f64; 4]) -> [f64; 4] {
    let mut rounded = exact.map(|w| f64::from(w.clamp(0.0, 1.0) as f32));
    let largest = (0..4).fold(0, |best, k| if rounded[k] > rounded[best] { k } else { best });
    let others: f64 = (0..4).filter(|k| *k != largest).map(|k| rounded[k]).sum();
    rounded[largest] = f64::from((1.0 - others) as f32);
    rounded
}
