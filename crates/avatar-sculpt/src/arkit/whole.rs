//! The skin with its vertices joined, and the normals of the moved skin.

use glam::{DMat3, DVec3};

use crate::{
    mesh,
    skin::{Skin, Vertex},
};

/// Offsets below this length (a fortieth of a millimetre) are none.
pub(super) const LEAST: f64 = 2.5e-3;
/// Changes of normals below this length (a quarter of a degree) are none.
pub(super) const LEAST_TURN: f64 = 4e-3;

/// What is too little to be seen is none, so that shapes stay small.
pub(super) fn drop_traces(values: &mut [DVec3], least: f64) {
    values.iter_mut().filter(|d| d.length_squared() < least * least).for_each(|d| *d = DVec3::ZERO);
}

/// The skin with its vertices joined across the seams of the picture, but not across sharp folds.
pub(super) struct Whole {
    /// Places of joined vertices.
    pub(super) places: Vec<DVec3>,
    /// Triangles between them.
    pub(super) triangles: Vec<[usize; 3]>,
    /// Which joined vertex each vertex of the skin is.
    pub(super) number: Vec<usize>,
    /// For each joined vertex the first at the same place: sharp folds have several there.
    pub(super) same: Vec<usize>,
    rest: Vec<DVec3>,
}

impl Whole {
    /// The skin at rest.
    pub(super) fn new(skin: &Skin) -> Self {
        let count = skin.half.nodes.len();
        let number: Vec<usize> =
            skin.vertices.iter().map(|v| if v.p.x < 0.0 { count + v.source } else { v.source }).collect();
        let mut places = vec![DVec3::ZERO; 2 * count];
        for (v, n) in skin.vertices.iter().zip(&number) {
            places[*n] = v.p;
        }
        let triangles: Vec<[usize; 3]> =
            skin.triangles.iter().map(|t| t.map(|i| number[i as usize])).collect();
        let rest = mesh::normals(&places, &triangles);
        let same = mesh::weld(&places);
        Self { places, triangles, number, same, rest }
    }

    /// How normals at rest change under offsets of the vertices, seen where these bones have taken them.
    pub(super) fn changes(&self, skin: &Skin, offsets: &[DVec3], bones: &[(DMat3, DVec3)]) -> Vec<DVec3> {
        let mut moved = self.places.clone();
        for (k, n) in self.number.iter().enumerate() {
            moved[*n] = bones[k].0 * (self.places[*n] + offsets[k]) + bones[k].1;
        }
        let turned = mesh::normals(&moved, &self.triangles);
        // Elsewhere bones alone decide.
        let mut touched = vec![false; self.places.len()];
        let mut still = vec![true; self.places.len()];
        let least = LEAST * LEAST;
        self.number.iter().zip(offsets).for_each(|(n, d)| still[*n] = d.length_squared() < least);
        for t in self.triangles.iter().filter(|t| t.iter().any(|n| !still[*n])) {
            t.iter().for_each(|n| touched[*n] = true);
        }
        let change = |(k, v): (usize, &Vertex)| {
            let n = self.number[k];
            if !touched[n] {
                return DVec3::ZERO;
            }
            // The bones will turn what is added here.
            let wanted = bones[k].0.inverse() * turned[n];
            (v.normal + wanted - self.rest[n]).normalize_or_zero() - v.normal
        };
        skin.vertices.iter().enumerate().map(change).collect()
    }
}
