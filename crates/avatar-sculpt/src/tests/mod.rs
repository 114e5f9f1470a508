//! Checks on the finished pack: the bytes that other programs will read.

mod eyes;
mod files;
mod identity;
mod load;
mod mixtures;
mod mouth;
mod pictures;
mod rig;
mod shapes;
mod surface;
mod witness;

use std::{
    io::Write as _,
    path::{Path, PathBuf},
    sync::OnceLock,
};

use glam::{DMat3, DVec2, DVec3};

use crate::{
    anatomy::EYE,
    pack::{self, Pack},
    sculpture::{self, Sculpture},
};

/// A folder of the data beside the workspace. Where it is missing, that is said on the terminal, or is a
/// failure under `MIMIK_REQUIRE_DATA=1`.
pub(super) fn shared(name: &str) -> Option<PathBuf> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data").join(name);
    if path.is_dir() {
        return Some(path);
    }
    let required = std::env::var_os("MIMIK_REQUIRE_DATA").is_some_and(|value| value == "1");
    assert!(!required, "expected data in {} (MIMIK_REQUIRE_DATA=1), found none", path.display());
    // Past the harness, which keeps the output of tests that pass to itself.
    let _ = writeln!(std::io::stderr(), "SKIPPED: {} is not there", path.display());
    None
}

/// A part as read back from its files.
pub(super) struct Mesh {
    pub(super) p: Vec<DVec3>,
    pub(super) uv: Vec<DVec2>,
    pub(super) n: Vec<DVec3>,
    pub(super) skin: Vec<SkinData>,
    pub(super) triangles: Vec<[usize; 3]>,
}

/// What only skin vertices have.
#[derive(Clone, Copy)]
pub(super) struct SkinData {
    pub(super) bones: [f64; 4],
    pub(super) weights: [f64; 4],
    pub(super) shapes: [(DVec3, DVec3); 2],
}

/// The sculpture, made once for all tests.
pub(super) fn sculpture() -> &'static Sculpture {
    static SCULPTURE: OnceLock<Sculpture> = OnceLock::new();
    SCULPTURE.get_or_init(sculpture::sculpt)
}

/// Its files, without the pictures.
pub(super) fn geometry() -> &'static Pack {
    static GEOMETRY: OnceLock<Pack> = OnceLock::new();
    GEOMETRY.get_or_init(|| pack::geometry(sculpture()).unwrap())
}

pub(super) fn file(name: &str) -> &'static [u8] {
    &geometry().files.iter().find(|(n, _)| n == name).unwrap().1
}

pub(super) const RIGID: [&str; 6] =
    ["UpperJaw", "LowerJaw", "RtEyeBall_smtt", "LtEyeBall_smtt", "RtEyeTransp_smtt", "LtEyeTransp_smtt"];

pub(super) fn mesh(stem: &str) -> Mesh {
    let bytes = file(&format!("{stem}_VB.raw"));
    let floats: Vec<f64> =
        bytes.chunks(4).map(|c| f64::from(f32::from_le_bytes(c.try_into().unwrap()))).collect();
    let wide = stem == "MarsienneSkin";
    let stride = if wide { 31 } else { 8 };
    let mut m = Mesh { p: vec![], uv: vec![], n: vec![], skin: vec![], triangles: vec![] };
    for v in floats.chunks(stride) {
        let at = |k: usize| DVec3::new(v[k], v[k + 1], v[k + 2]);
        m.p.push(at(0));
        m.uv.push(DVec2::new(v[3], v[4]));
        m.n.push(at(5));
        if wide {
            m.skin.push(SkinData {
                bones: [v[8], v[9], v[10], v[11]],
                weights: [v[12], v[13], v[14], v[15]],
                shapes: [(at(19), at(22)), (at(25), at(28))],
            });
        }
    }
    let numbers: Vec<usize> = file(&format!("{stem}_IB.raw"))
        .chunks(4)
        .map(|c| u32::from_le_bytes(c.try_into().unwrap()) as usize)
        .collect();
    m.triangles = numbers.chunks(3).map(|t| [t[0], t[1], t[2]]).collect();
    m
}

/// The skin, read once.
pub(super) fn skin() -> &'static Mesh {
    static SKIN: OnceLock<Mesh> = OnceLock::new();
    SKIN.get_or_init(|| mesh("MarsienneSkin"))
}

/// Turn of a bone that is not at rest, about a point.
#[derive(Clone, Copy)]
pub(super) struct Turn {
    pub(super) bone: f64,
    pub(super) about: DVec3,
    pub(super) by: DMat3,
}

/// Places of the skin's vertices under some turned bones and shape weights.
pub(super) fn deformed(turns: &[Turn], shapes: [f64; 2]) -> Vec<DVec3> {
    let m = skin();
    m.p.iter()
        .zip(&m.skin)
        .map(|(p, s)| {
            let q = *p + shapes[0] * s.shapes[0].0 + shapes[1] * s.shapes[1].0;
            (0..4).fold(DVec3::ZERO, |sum, k| {
                let moved =
                    turns.iter().find(|t| t.bone == s.bones[k]).map_or(q, |t| t.about + t.by * (q - t.about));
                sum + s.weights[k] * moved
            })
        })
        .collect()
}

/// The centre of the left (1) or right (−1) eye.
pub(super) fn eye(side: f64) -> DVec3 {
    DVec3::new(side * EYE.x, EYE.y, EYE.z)
}

/// The lids of one side closed by these angles in degrees.
pub(super) fn lids(side: f64, upper: f64, lower: f64) -> [Turn; 2] {
    let about_x = |degrees: f64| DMat3::from_rotation_x(degrees.to_radians());
    let next = if side > 0.0 { 0.0 } else { 1.0 };
    [
        Turn { bone: 2.0 + next, about: eye(side), by: about_x(upper) },
        Turn { bone: 4.0 + next, about: eye(side), by: about_x(-lower) },
    ]
}

/// Distance along a ray to a triangle, if it is hit from either side.
pub(super) fn hit(from: DVec3, direction: DVec3, t: [DVec3; 3]) -> Option<f64> {
    let (e1, e2) = (t[1] - t[0], t[2] - t[0]);
    let cross = direction.cross(e2);
    let det = e1.dot(cross);
    if det.abs() < 1e-14 {
        return None;
    }
    let rel = from - t[0];
    let u = rel.dot(cross) / det;
    let q = rel.cross(e1);
    let v = direction.dot(q) / det;
    let s = e2.dot(q) / det;
    (u >= 0.0 && v >= 0.0 && u + v <= 1.0 && s > 1e-9).then_some(s)
}
