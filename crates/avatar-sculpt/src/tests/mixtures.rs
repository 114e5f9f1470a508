//! Single shapes and mixtures of the 52: no triangle flips, lids stay off the eyes, lips off the teeth.

use std::{collections::BTreeMap, sync::OnceLock};

use glam::{DMat3, DVec3};

use super::{eye, mesh, sculpture, skin};
use crate::{
    anatomy::{EYE_REACH, JAW},
    arkit, layout,
    mesh::{normals, weld},
    parts::teeth,
};

/// Weights by the names of the 52 shapes.
type Weights = BTreeMap<String, f64>;

/// The face that mixtures are made of.
struct Face {
    moved: BTreeMap<String, Vec<(usize, DVec3)>>,
    triangles: Vec<[usize; 3]>,
    /// Triangles of the skin around each eye, left first.
    lids: [Vec<[usize; 3]>; 2],
    /// Vertices near the mouth, inside and outside.
    lips: Vec<usize>,
    /// Teeth and gums as closed pieces: of the upper row, then of the lower one.
    rows: [Vec<Piece>; 2],
}

/// A closed piece of a row of teeth.
struct Piece {
    triangles: Vec<[DVec3; 3]>,
    low: DVec3,
    high: DVec3,
}

fn face() -> &'static Face {
    static FACE: OnceLock<Face> = OnceLock::new();
    FACE.get_or_init(|| {
        let m = skin();
        let moved = arkit::moved(sculpture());
        let sparse = |d: &Vec<DVec3>| -> Vec<(usize, DVec3)> {
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
            moved: moved.map(|s| (s.name.clone(), sparse(&s.offsets))).collect(),
            triangles: m.triangles.iter().map(|t| t.map(|i| joined[i])).collect(),
            lids: [around(1.0), around(-1.0)],
            lips: (0..m.p.len()).filter(near_mouth).collect(),
            rows: [pieces("UpperJaw"), pieces("LowerJaw")],
        }
    })
}

/// The closed pieces of a row, without the tongue.
fn pieces(stem: &str) -> Vec<Piece> {
    let m = mesh(stem);
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
    fn contains(&self, p: DVec3) -> bool {
        if p.cmplt(self.low).any() || p.cmpgt(self.high).any() {
            return false;
        }
        // An odd number of crossings; the direction is none of the mesh's own.
        let ray = DVec3::new(0.123, 0.317, 0.94);
        self.triangles.iter().filter(|t| super::hit(p, ray, **t).is_some()).count() % 2 == 1
    }
}

/// What is wrong with a face.
#[derive(Debug, Default)]
struct Faults {
    flipped: usize,
    flipped_inside: usize,
    /// Least distance of the lids from an eye's centre.
    lids: f64,
    /// Vertices of the skin inside a tooth or a gum.
    in_teeth: usize,
    place: DVec3,
}

impl Faults {
    fn clean(&self) -> bool {
        self.flipped == 0 && self.in_teeth == 0 && self.lids > EYE_REACH
    }
}

/// The jaw's turn: opened first, then sideways.
fn jaw(weights: &Weights) -> DMat3 {
    let w = |name: &str| weights.get(name).copied().unwrap_or(0.0);
    DMat3::from_rotation_x((20.0 * w("jawOpen")).to_radians())
        * DMat3::from_rotation_y((8.0 * (w("jawLeft") - w("jawRight"))).to_radians())
}

fn deformed(face: &Face, weights: &Weights) -> Vec<DVec3> {
    let m = skin();
    let w = |name: &str| weights.get(name).copied().unwrap_or(0.0);
    let mut p = m.p.clone();
    for (name, weight) in weights {
        // Lips are closed by as much as the jaw has parted them.
        let weight = if name == "mouthClose" { weight * w("jawOpen") } else { *weight };
        for (i, d) in face.moved.get(name).into_iter().flatten() {
            p[*i] += *d * weight;
        }
    }
    let about_x = |degrees: f64| DMat3::from_rotation_x(degrees.to_radians());
    let lid = |side: &str, upper: bool| {
        let blink = w(&format!("eyeBlink{side}"));
        if upper {
            let follows = 7.5 * (w(&format!("eyeLookDown{side}")) - w(&format!("eyeLookUp{side}")));
            about_x((45.0 * blink + follows).min(45.0))
        } else {
            about_x(-25.0 * blink)
        }
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

fn faults(face: &Face, weights: &Weights) -> Faults {
    let m = skin();
    let p = deformed(face, weights);
    let mut found = Faults { lids: f64::INFINITY, ..Faults::default() };
    let n = normals(&p, &face.triangles);
    for t in &face.triangles {
        let cross = (p[t[1]] - p[t[0]]).cross(p[t[2]] - p[t[0]]);
        if cross.dot(n[t[0]] + n[t[1]] + n[t[2]]) <= 0.0 {
            if m.uv[t[0]].y < layout::STRIP_TOP || m.uv[t[1]].y < layout::STRIP_TOP {
                found.flipped += 1;
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
        let below = JAW + back * (p[i] - JAW) - w("jawForward") * arkit::FORWARD;
        let inside = face.rows[0].iter().any(|piece| piece.contains(p[i]))
            || face.rows[1].iter().any(|piece| piece.contains(below));
        if inside {
            found.in_teeth += 1;
            found.place = m.p[i];
        }
    }
    found
}

/// Distance from a point to a triangle that it sees from within a convex neighbourhood: to its plane where
/// the foot lies inside, else to its nearest edge.
fn distance(from: DVec3, t: [DVec3; 3]) -> f64 {
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

fn names() -> Vec<String> {
    let bones = arkit::BY_BONES.map(str::to_owned);
    face().moved.keys().cloned().chain(bones).chain(["tongueOut".to_owned()]).collect()
}

/// Shapes of fields, one at a time.
#[test]
fn a_shape_alone_flips_nothing_and_keeps_off_eyes_and_teeth() {
    let face = face();
    assert!(faults(face, &Weights::new()).clean());
    for name in names().into_iter().filter(|n| !arkit::BY_BONES.contains(&n.as_str())) {
        for weight in [0.5, 1.0] {
            let found = faults(face, &[(name.clone(), weight)].into());
            assert!(found.clean(), "{name} {weight}: {found:?}");
        }
    }
}

#[test]
fn the_test_finds_faults() {
    // Far too much of shapes: lips go through teeth, lids come to the eye or fold.
    let face = face();
    let rolled = faults(face, &[("mouthRollUpper".to_owned(), 4.0)].into());
    assert!(rolled.in_teeth > 0 && rolled.flipped > 0, "{rolled:?}");
    let pressed = distance(
        DVec3::ZERO,
        [DVec3::new(-1.0, -1.0, 0.5), DVec3::new(2.0, -1.0, 0.5), DVec3::new(0.0, 2.0, 0.5)],
    );
    assert!((pressed - 0.5).abs() < 1e-12, "{pressed}");
}

#[test]
fn left_and_right_mirror_each_other() {
    let m = skin();
    let vertices = &sculpture().skin.vertices;
    // The right half's triangles come after the left half's, in the same order and turned around.
    let half = m.triangles.len() / 2;
    let mut twin: Vec<usize> = (0..m.p.len()).collect();
    for (l, r) in sculpture().skin.triangles[..half].iter().zip(&sculpture().skin.triangles[half..]) {
        for (a, b) in [(0, 0), (1, 2), (2, 1)] {
            twin[l[a] as usize] = r[b] as usize;
            twin[r[b] as usize] = l[a] as usize;
        }
    }
    let flip = |d: DVec3| DVec3::new(-d.x, d.y, d.z);
    assert!((0..twin.len()).all(|i| vertices[i].p.distance(flip(vertices[twin[i]].p)) < 1e-6));
    let all = arkit::moved(sculpture());
    let find = |name: &str| all.iter().find(|s| s.name == name && s.stem == "MarsienneSkin").unwrap();
    for shape in all.iter().filter(|s| s.stem == "MarsienneSkin") {
        let other = if let Some(stem) = shape.name.strip_suffix("Left") {
            find(&format!("{stem}Right"))
        } else if let Some(stem) = shape.name.strip_suffix("Right") {
            find(&format!("{stem}Left"))
        } else {
            shape
        };
        for (i, &k) in twin.iter().enumerate() {
            let off = shape.offsets[i].distance(flip(other.offsets[k]));
            let turned = shape.normals[i].distance(flip(other.normals[k]));
            assert!(off < 1e-4 && turned < 1e-4, "{}: {off} {turned} at {}", shape.name, m.p[i]);
        }
    }
}
