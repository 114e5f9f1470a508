//! Evens displacements out at the corners of the mouth.
//!
//! All of the difference between both lips falls between a few rows of vertices there, a fiftieth of
//! the mouth's width apart: the smallest triangles fold long before anything else does. Evened out among
//! neighbours, the same difference is spread over a few more rows.

use glam::{DMat3, DVec2, DVec3};

use super::{spot::dome, whole::Whole};
use crate::{
    anatomy::mouth_line,
    skin::{Skin, Vertex},
};

/// How far it reaches, as the width of a bell.
const REACH: f64 = 0.48;
const ROUNDS: usize = 8;

/// How much each joined vertex is evened out.
pub(super) struct Corners {
    near: Vec<f64>,
}

impl Corners {
    /// The corners of the mouth.
    pub(super) fn new(whole: &Whole, skin: &Skin) -> Self {
        let mut near = vec![0.0; whole.places.len()];
        for (v, n) in skin.vertices.iter().zip(&whole.number).filter(|(v, _)| v.p.z > 2.6) {
            let away = DVec2::new(v.p.x.abs(), v.p.y) - mouth_line(1.0);
            near[*n] = dome(away.length_squared() / (REACH * REACH));
        }
        Self { near }
    }

    /// Moves values of joined vertices toward the mean of their neighbours; those at one place stay together.
    fn even(&self, whole: &Whole, values: &mut [DVec3]) {
        let same = &whole.same;
        for _ in 0..ROUNDS {
            let mut sums = vec![(DVec3::ZERO, 0.0); values.len()];
            for t in whole.triangles.iter().filter(|t| t.iter().any(|n| self.near[*n] > 0.0)) {
                for k in 0..3 {
                    let (a, b) = (same[t[k]], same[t[(k + 1) % 3]]);
                    sums[a] = (sums[a].0 + values[b], sums[a].1 + 1.0);
                    sums[b] = (sums[b].0 + values[a], sums[b].1 + 1.0);
                }
            }
            for (n, (sum, count)) in sums.into_iter().enumerate() {
                if self.near[n] > 0.0 && count > 0.0 {
                    values[n] = values[n].lerp(sum / count, 0.5 * self.near[n]);
                }
            }
            let joined: Vec<DVec3> = same.iter().map(|n| values[*n]).collect();
            values.copy_from_slice(&joined);
        }
    }

    /// Evens offsets of the skin's vertices out.
    pub(super) fn offsets(&self, whole: &Whole, offsets: &mut [DVec3]) {
        let mut joined = vec![DVec3::ZERO; whole.places.len()];
        whole.number.iter().zip(&*offsets).for_each(|(n, d)| joined[*n] = *d);
        self.even(whole, &mut joined);
        offsets.iter_mut().zip(&whole.number).for_each(|(d, n)| *d = joined[*n]);
    }

    /// Offsets that even out the corners of a mouth that the jaw's bone has moved: vertices move toward the
    /// middle of their neighbours where the bone has taken them.
    pub(super) fn turned(&self, whole: &Whole, skin: &Skin, bones: &[(DMat3, DVec3)]) -> Vec<DVec3> {
        let mut places = whole.places.clone();
        for ((v, n), (turn, shift)) in skin.vertices.iter().zip(&whole.number).zip(bones) {
            places[*n] = *turn * v.p + *shift;
        }
        self.even(whole, &mut places);
        let offset = |((v, n), (turn, shift)): ((&Vertex, &usize), &(DMat3, DVec3))| {
            if self.near[*n] == 0.0 { DVec3::ZERO } else { turn.inverse() * (places[*n] - *shift) - v.p }
        };
        skin.vertices.iter().zip(&whole.number).zip(bones).map(offset).collect()
    }
}
