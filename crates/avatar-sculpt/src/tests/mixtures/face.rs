//! The face under a mixture of shapes, and what is wrong with it.

use std::{collections::BTreeMap, sync::OnceLock};

use glam::{DMat3, DVec3};

use super::super::{Mesh, eye, hit, mesh, sculpture, skin};
use crate::{
    anatomy::{EYE_REACH, JAW},
    arkit::{self, Weight},
    layout,
    mesh::{normals, weld},
    parts::teeth,
};

/// Weights by the names of the 52 shapes.
pub(super) type Weights = BTreeMap<String, f64>;

/// Moved vertices and their displacements.
type Moves = Vec<(usize, DVec3)>;

/// The face that mixtures are made of.
pub(super) struct Face {
    /// Name, weight and moved vertices of every shape.
    pub(super) moved: Vec<(String, Weight, Moves)>,
    pub(super) triangles: Vec<[usize; 3]>,
    /// Triangles of the skin around each eye, left first.
    lids: [Vec<[usize; 3]>; 2],
    /// Vertices near the mouth, inside and outside.
    lips: Vec<usize>,
    /// Teeth and gums as closed pieces: of the upper row, then of the lower one.
    rows: [Vec<Piece>; 2],
}

/// A closed piece of a row of teeth.
pub(in crate::tests) struct Piece {
    triangles: Vec<[DVec3; 3]>,
    low: DVec3,
    high: DVec3,
}

pub(super) fn face() -> &'static Face {
    static FACE: OnceLock<Face> = OnceLock::new();
    FACE.get_or_init(|| {
        let m = skin();
        let moved = arkit::moved(sculpture());
        let sparse = |d: &Vec<DVec3>| -> Moves {
            d.iter().copied().enumerate().filter(|(_, d)| *d != DVec3::ZERO).collect()
        };
        let moved = moved.iter().filter(|s| s.stem == "MarsienneSkin");
        let mut known = BTreeMap::new();
        let vertices = &sculpture().skin.vertices;
        let joined: Vec<usize> =
            (0..m.p.len()).map(|i| *known.entry((vertices[i].source, m.p[i].x < 0.0)).or_insert(i)).collect();
        let around = |side: f64| {
            let near = |t: &&[usize; 3]| {
                let outer = |i: usize| m.p[i].z > eye(side).z - 0.5 && m.uv[i].y < layout::STRIP_TOP;
                t.iter().all(|&i| m.p[i].distance(eye(side)) < 4.0 && outer(i))
            };
            m.triangles.iter().filter(near).copied().collect()
        };
        let near_mouth = |i: &usize| m.p[*i].z > 0.0 && m.p[*i].y < -3.0 && m.p[*i].y > -9.0;
        Face {
            moved: moved.map(|s| (s.name.clone(), s.weight, sparse(&s.offsets))).collect(),
            triangles: m.triangles.iter().map(|t| t.map(|i| joined[i])).collect(),
            lids: [around(1.0), around(-1.0)],
            lips: (0..m.p.len()).filter(near_mouth).collect(),
            rows: ["UpperJaw", "LowerJaw"].map(|stem| pieces(&mesh(stem))),
        }
    })
}

/// The closed pieces of a row, without the tongue.
pub(in crate::tests) fn pieces(m: &Mesh) -> Vec<Piece> {
    let welded = weld(&m.p);
    // Pieces hang together through shared places.
    let mut root: Vec<usize> = (0..m.p.len()).collect();
    fn find(root: &mut [usize], mut i: usize) -> usize {
        while root[i] != i {
            root[i] = root[root[i]];
            i = root[i];
        }
        i
    }
    for t in &m.triangles {
        for k in 1..3 {
            let (a, b) = (find(&mut root, welded[t[0]]), find(&mut root, welded[t[k]]));
            root[a] = b;
        }
    }
    let mut of: BTreeMap<usize, Vec<[DVec3; 3]>> = BTreeMap::new();
    for t in m.triangles.iter().filter(|t| !teeth::is_tongue(m.uv[t[0]])) {
        of.entry(find(&mut root, welded[t[0]])).or_default().push(t.map(|i| m.p[i]));
    }
    let piece = |triangles: Vec<[DVec3; 3]>| {
        let corners = || triangles.iter().flatten();
        let low = corners().fold(DVec3::INFINITY, |a, b| a.min(*b));
        let high = corners().fold(DVec3::NEG_INFINITY, |a, b| a.max(*b));
        Piece { low, high, triangles }
    };
    of.into_values().map(piece).collect()
}

impl Piece {
    pub(in crate::tests) fn contains(&self, p: DVec3) -> bool {
        if p.cmplt(self.low).any() || p.cmpgt(self.high).any() {
            return false;
        }
        // An odd number of crossings; the direction is none of the mesh's own.
        let ray = DVec3::new(0.123, 0.317, 0.94);
        self.triangles.iter().filter(|t| hit(p, ray, **t).is_some()).count() % 2 == 1
    }
}

/// What is wrong with a face.
#[derive(Debug, Default)]
pub(super) struct Faults {
    pub(super) flipped: usize,
    pub(super) flipped_inside: usize,
    /// Least distance of the lids from an eye's centre.
    pub(super) lids: f64,
    /// Vertices of the skin inside a tooth or a gum.
    pub(super) in_teeth: usize,
    pub(super) place: DVec3,
    pub(super) flips: Vec<usize>,
    pub(super) touching: Vec<usize>,
}

impl Faults {
    pub(super) fn clean(&self) -> bool {
        self.flipped == 0 && self.in_teeth == 0 && self.lids > EYE_REACH
    }
}

/// The jaw's turn: opened first, then sideways.
fn jaw(weights: &Weights) -> DMat3 {
    let w = |name: &str| weights.get(name).copied().unwrap_or(0.0);
    DMat3::from_rotation_x((20.0 * w("jawOpen")).to_radians())
        * DMat3::from_rotation_y((8.0 * (w("jawLeft") - w("jawRight"))).to_radians())
}

/// How much a shape counts that stands alone where its input is `at`: 0 at rest and where the next one stands
/// alone, evenly between; beyond the outermost of 0 and all shapes the last line goes on.
fn follows(face: &Face, input: &str, at: f64, x: f64) -> f64 {
    let mut places = vec![0.0];
    places.extend(face.moved.iter().filter_map(|(_, weight, _)| match weight {
        Weight::Follows(of, at) if *of == input => Some(*at),
        _ => None,
    }));
    places.sort_by(f64::total_cmp);
    let last = places.len() - 1;
    // The two places whose line counts at `x`.
    let k = places.iter().filter(|p| **p <= x).count().clamp(1, last);
    let (low, high) = (places[k - 1], places[k]);
    let along = (x - low) / (high - low);
    if at == low {
        1.0 - along
    } else if at == high {
        along
    } else {
        0.0
    }
}

pub(super) fn deformed(face: &Face, weights: &Weights) -> Vec<DVec3> {
    let m = skin();
    let w = |name: &str| weights.get(name).copied().unwrap_or(0.0);
    let mut p = m.p.clone();
    let upper_lid = |side: &str| {
        let follows = 7.5 * (w(&format!("eyeLookDown{side}")) - w(&format!("eyeLookUp{side}")));
        (45.0 * w(&format!("eyeBlink{side}")) + follows).clamp(-10.0, 45.0)
    };
    // Controls of bones count 1 at their ends.
    let control = |name: &str| match name {
        "jaw.open" => w("jawOpen"),
        "jaw.jut" => w("jawLeft") - w("jawRight"),
        "lid.left.upper" => upper_lid("Left") / 45.0,
        "lid.right.upper" => upper_lid("Right") / 45.0,
        _ => w(name),
    };
    for (name, weight, moved) in &face.moved {
        let weight = match weight {
            Weight::Control => w(name),
            Weight::Follows(input, at) => follows(face, input, *at, control(input)),
            Weight::Product([a, b]) => control(a) * control(b),
            Weight::OfSide(..) => unreachable!("{name} has the weight of its side"),
        };
        if weight != 0.0 {
            moved.iter().for_each(|(i, d)| p[*i] += *d * weight);
        }
    }
    let about_x = |degrees: f64| DMat3::from_rotation_x(degrees.to_radians());
    let lid = |side: &str, upper: bool| {
        if upper { about_x(upper_lid(side)) } else { about_x(-25.0 * w(&format!("eyeBlink{side}"))) }
    };
    let still = (DVec3::ZERO, DMat3::IDENTITY);
    let (left, right) = (eye(1.0), eye(-1.0));
    let bones = [
        still,
        still,
        (left, lid("Left", true)),
        (right, lid("Right", true)),
        (left, lid("Left", false)),
        (right, lid("Right", false)),
        (JAW, jaw(weights)),
    ];
    p.iter()
        .zip(&m.skin)
        .map(|(p, s)| {
            (0..4).fold(DVec3::ZERO, |sum, k| {
                let (about, by) = bones[s.bones[k] as usize];
                sum + s.weights[k] * (about + by * (*p - about))
            })
        })
        .collect()
}

pub(super) fn faults(face: &Face, weights: &Weights) -> Faults {
    let m = skin();
    let p = deformed(face, weights);
    let mut found = Faults { lids: f64::INFINITY, ..Faults::default() };
    let n = normals(&p, &face.triangles);
    for (number, t) in face.triangles.iter().enumerate() {
        let cross = (p[t[1]] - p[t[0]]).cross(p[t[2]] - p[t[0]]);
        if cross.dot(n[t[0]] + n[t[1]] + n[t[2]]) <= 0.0 {
            if m.uv[t[0]].y < layout::STRIP_TOP || m.uv[t[1]].y < layout::STRIP_TOP {
                found.flipped += 1;
                found.flips.push(number);
                found.place = m.p[t[0]];
            } else {
                found.flipped_inside += 1;
            }
        }
    }
    for (side, triangles) in [1.0, -1.0].into_iter().zip(&face.lids) {
        for t in triangles {
            found.lids = found.lids.min(distance(eye(side), t.map(|i| p[i])));
        }
    }
    let back = jaw(weights).inverse();
    let w = |name: &str| weights.get(name).copied().unwrap_or(0.0);
    for &i in &face.lips {
        let below = JAW + back * (p[i] - JAW)
            - w("jawForward") * arkit::FORWARD
            - w("tongueOut") * arkit::TONGUE_DROP;
        let inside = face.rows[0].iter().any(|piece| piece.contains(p[i]))
            || face.rows[1].iter().any(|piece| piece.contains(below));
        if inside {
            found.in_teeth += 1;
            found.touching.push(i);
            found.place = m.p[i];
        }
    }
    found
}

/// Distance from a point to a triangle that it sees from within a convex neighbourhood: to its plane where
/// the foot lies inside, else to its nearest edge.
pub(in crate::tests) fn distance(from: DVec3, t: [DVec3; 3]) -> f64 {
    let n = (t[1] - t[0]).cross(t[2] - t[0]).normalize_or_zero();
    let height = (t[0] - from).dot(n);
    let foot = from + n * height;
    let inside = (0..3).all(|k| (t[(k + 1) % 3] - t[k]).cross(foot - t[k]).dot(n) >= 0.0);
    if inside {
        return height.abs();
    }
    let edge = |k: usize| {
        let (a, b) = (t[k], t[(k + 1) % 3]);
        let s = ((from - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
        (a + (b - a) * s - from).length()
    };
    edge(0).min(edge(1)).min(edge(2))
}

pub(super) fn names() -> Vec<String> {
    let bones = arkit::BY_BONES.map(str::to_owned);
    let own = face().moved.iter().filter(|m| m.1 == Weight::Control).map(|m| m.0.clone());
    own.chain(bones).collect()
}
