//! Evens displacements out at the corners of the mouth and of the eyes.
//!
//! All of the difference between both lips, or both lids, falls between a few rows of vertices there, a
//! fiftieth of the mouth's width apart: the smallest triangles fold long before anything else does. Evened
//! out among neighbours, the same difference is spread over a few more rows. What counts is the difference
//! along an edge by the edge's length, so the ends of short edges move as one.

use glam::{DMat3, DVec2, DVec3};

use super::whole::Whole;
use crate::{
    anatomy::{CANTHUS_INNER, CANTHUS_OUTER, EYE, mouth_line},
    math::dome,
    skin::{Skin, Vertex},
    surface::half::Patch,
};

/// How far it reaches about the corners of the mouth and of an eye, as the width of a bell.
const MOUTH_REACH: f64 = 0.48;
const EYE_REACH: f64 = 0.48;
/// Edges below this length count as if they had it.
const LEAST_EDGE: f64 = 0.02;
/// How often values move toward the mean of their neighbours. Around the eyes the edges of the lids stay
/// where their bones bring them: what reaches the skin around them from afar would push it over them.
const MOUTH_ROUNDS: usize = 240;
/// See [`MOUTH_ROUNDS`].
const EYE_ROUNDS: usize = 2;

/// How much each joined vertex is evened out.
pub(super) struct Corners {
    near: Vec<f64>,
    /// The first joined vertex at each place near a corner or next to one.
    places: Vec<usize>,
    /// Which of the places each joined vertex is at; none for those that are far from all.
    place: Vec<Option<usize>>,
    /// Places at the ends of the edges near a corner, and the edges' weights.
    edges: Vec<(usize, usize, f64)>,
    rounds: usize,
}

impl Corners {
    /// The corners of the mouth.
    pub(super) fn of_mouth(whole: &Whole, skin: &Skin) -> Self {
        Self::new(whole, skin, &[(mouth_line(1.0), MOUTH_REACH)], MOUTH_ROUNDS)
    }

    /// The corners of the eyes.
    pub(super) fn of_eyes(whole: &Whole, skin: &Skin) -> Self {
        let eye = DVec2::new(EYE.x, EYE.y);
        let both = [(eye + CANTHUS_INNER, EYE_REACH), (eye + CANTHUS_OUTER, EYE_REACH)];
        Self::new(whole, skin, &both, EYE_ROUNDS)
    }

    fn new(whole: &Whole, skin: &Skin, corners: &[(DVec2, f64)], rounds: usize) -> Self {
        let mut near = vec![0.0; whole.places.len()];
        // The edges of the lids are closed by their bones to a hair's breadth, and what stands on them or
        // lies behind them goes with them: only the skin around them gives way.
        let gives_way = |v: &Vertex| {
            let node = &skin.half.nodes[v.source];
            v.p.z > 2.0 && node.lid > 0.0 && node.patch != Patch::Lash
        };
        for (v, n) in skin.vertices.iter().zip(&whole.number).filter(|(v, _)| gives_way(v)) {
            let place = DVec2::new(v.p.x.abs(), v.p.y);
            near[*n] = corners
                .iter()
                .map(|(corner, reach)| dome((place - *corner).length_squared() / (reach * reach)))
                .sum();
        }
        let mut corners = Self { place: vec![None; near.len()], near, places: vec![], edges: vec![], rounds };
        for t in &whole.triangles {
            if t.iter().all(|n| corners.near[*n] == 0.0) {
                continue;
            }
            let ends = t.map(|n| corners.place_of(whole.same[n]));
            for k in 0..3 {
                let (a, b) = (t[k], t[(k + 1) % 3]);
                let length = whole.places[a].distance(whole.places[b]).max(LEAST_EDGE);
                corners.edges.push((ends[k], ends[(k + 1) % 3], 1.0 / (length * length)));
            }
        }
        for (n, first) in whole.same.iter().enumerate() {
            corners.place[n] = corners.place[*first];
        }
        corners
    }

    /// The number of a place, which is new if it had none.
    fn place_of(&mut self, first: usize) -> usize {
        *self.place[first].get_or_insert_with(|| {
            self.places.push(first);
            self.places.len() - 1
        })
    }

    /// Moves values of joined vertices toward the mean of their neighbours; those at one place stay together.
    fn even(&self, values: &mut [DVec3]) {
        let mut at: Vec<DVec3> = self.places.iter().map(|n| values[*n]).collect();
        let mut sums = vec![(DVec3::ZERO, 0.0); at.len()];
        for _ in 0..self.rounds {
            sums.fill((DVec3::ZERO, 0.0));
            for &(a, b, weight) in &self.edges {
                sums[a] = (sums[a].0 + at[b] * weight, sums[a].1 + weight);
                sums[b] = (sums[b].0 + at[a] * weight, sums[b].1 + weight);
            }
            for ((value, first), (sum, weight)) in at.iter_mut().zip(&self.places).zip(&sums) {
                *value = value.lerp(*sum / *weight, 0.5 * self.near[*first]);
            }
        }
        for (value, place) in values.iter_mut().zip(&self.place) {
            if let Some(place) = place {
                *value = at[*place];
            }
        }
    }

    /// Evens offsets of the skin's vertices out.
    pub(super) fn offsets(&self, whole: &Whole, offsets: &mut [DVec3]) {
        let mut joined = vec![DVec3::ZERO; whole.places.len()];
        whole.number.iter().zip(&*offsets).for_each(|(n, d)| joined[*n] = *d);
        self.even(&mut joined);
        offsets.iter_mut().zip(&whole.number).for_each(|(d, n)| *d = joined[*n]);
    }

    /// Offsets that even out the corners of a mouth that the jaw's bone has moved: vertices move toward the
    /// middle of their neighbours where the bone has taken them.
    pub(super) fn turned(&self, whole: &Whole, skin: &Skin, bones: &[(DMat3, DVec3)]) -> Vec<DVec3> {
        let mut moved = vec![DVec3::ZERO; whole.places.len()];
        for ((v, n), (turn, shift)) in skin.vertices.iter().zip(&whole.number).zip(bones) {
            moved[*n] = *turn * v.p + *shift - v.p;
        }
        self.even(&mut moved);
        let offset = |((v, n), (turn, shift)): ((&Vertex, &usize), &(DMat3, DVec3))| {
            if self.near[*n] == 0.0 { DVec3::ZERO } else { turn.inverse() * (v.p + moved[*n] - *shift) - v.p }
        };
        skin.vertices.iter().zip(&whole.number).zip(bones).map(offset).collect()
    }

    /// Offsets that even out what bones and these offsets do to the corners of the eyes. What is evened out
    /// keeps its distance from the lids' axis.
    pub(super) fn closed(
        &self,
        whole: &Whole,
        skin: &Skin,
        bones: &[(DMat3, DVec3)],
        offsets: &[DVec3],
    ) -> Vec<DVec3> {
        let places: Vec<DVec3> = skin
            .vertices
            .iter()
            .zip(bones)
            .zip(offsets)
            .map(|((v, (turn, shift)), d)| *turn * (v.p + *d) + *shift)
            .collect();
        let mut moved = vec![DVec3::ZERO; whole.places.len()];
        for ((v, n), place) in skin.vertices.iter().zip(&whole.number).zip(&places) {
            moved[*n] = *place - v.p;
        }
        self.even(&mut moved);
        let offset = |i: usize| {
            let (v, n, (turn, shift)) = (&skin.vertices[i], whole.number[i], &bones[i]);
            if self.near[n] == 0.0 {
                return offsets[i];
            }
            let eye = DVec3::new(EYE.x * v.p.x.signum(), EYE.y, EYE.z);
            let (away, before) = (v.p + moved[n] - eye, places[i] - eye);
            let longer = before.y.hypot(before.z) / away.y.hypot(away.z).max(1e-9);
            let place = eye + DVec3::new(away.x, away.y * longer, away.z * longer);
            turn.inverse() * (place - *shift) - v.p
        };
        (0..places.len()).map(offset).collect()
    }
}
