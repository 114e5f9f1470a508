//! Light that the form itself decides: how open a place is to the sky, and how thick the flesh behind it is.
//!
//! Both are measured at the mesh's vertices by rays against the real meshes and drawn between them. Vertices
//! lie densest where folds are, so nothing is lost; and a value between vertices cannot become a speck.

mod bvh;

use glam::{DMat3, DVec3};

pub use bvh::Bvh;

use crate::{
    anatomy::{EYE, JAW},
    math::{cos, exp, lerp, sin, smooth},
    sculpture::Sculpture,
    skin::Skin,
    surface::{
        half::{Node, Patch},
        scatter,
    },
    weights,
};

const PI: f64 = std::f64::consts::PI;
/// Rays per vertex for openness and for thickness.
const RAYS: u32 = 160;
/// Farther than this nothing takes light away: rooms are bright.
const REACH: f64 = 7.0;
/// Flesh of this depth and more counts as thick, in head units (about centimetres).
pub const THICK: f64 = 2.5;

/// The head at rest and with mouth and eyes half open and half shut.
#[derive(Debug)]
pub struct Scene<'a> {
    skin: &'a Skin,
    /// Normal of every vertex of the left half.
    normals: Vec<DVec3>,
    rest: Vec<DVec3>,
    posed: Vec<DVec3>,
    posed_normals: Vec<DVec3>,
    rest_tree: Bvh,
    posed_tree: Bvh,
    skin_tree: Bvh,
    eyeball: Vec<(DVec3, DVec3)>,
}

/// What was measured.
#[derive(Clone, Debug, Default)]
pub struct Baked {
    /// Openness of every vertex of the left half, 0…1.
    pub openness: Vec<f64>,
    /// Thickness of every vertex of the left half, 0…1 of [`THICK`].
    pub thickness: Vec<f64>,
    /// Openness of every vertex of the left eyeball, with its direction from the eye's centre.
    pub eyeball: Vec<(DVec3, f64)>,
}

/// The turns of the second pose: bone, pivot, angle about x in radians.
const POSE: [(usize, DVec3, f64); 3] =
    [(weights::JAW, JAW, 0.21), (weights::UPPER_LID, EYE, 0.42), (weights::LOWER_LID, EYE, -0.05)];

fn turned(bone: usize, p: DVec3) -> DVec3 {
    // The right lid's numbers follow the left one's; by then the place is mirrored onto the left.
    POSE.iter()
        .find(|(b, ..)| *b == bone)
        .map_or(p, |(_, about, angle)| *about + about_x(*angle) * (p - *about))
}

fn about_x(angle: f64) -> DMat3 {
    let (s, c) = (sin(angle), cos(angle));
    DMat3::from_cols(DVec3::X, DVec3::new(0.0, c, s), DVec3::new(0.0, -s, c))
}

impl<'a> Scene<'a> {
    /// Prepares both poses.
    #[must_use]
    pub fn new(sculpture: &'a Sculpture) -> Self {
        let skin = &sculpture.skin;
        let rest: Vec<DVec3> = skin.half.nodes.iter().map(|n| n.p).collect();
        let mut normals = vec![DVec3::ZERO; rest.len()];
        for v in skin.vertices.iter().filter(|v| v.p.x >= 0.0) {
            normals[v.source] = v.normal;
        }
        let posed = skin.half.nodes.iter().enumerate().map(|(i, node)| {
            weights::of(skin.half.mover(i))
                .iter()
                .fold(DVec3::ZERO, |sum, (bone, w)| sum + turned(*bone, node.p) * *w)
        });
        let posed: Vec<DVec3> = posed.collect();
        let posed_normals = crate::mesh::normals(&posed, &skin.half.triangles);
        let half = |places: &[DVec3]| {
            // Lashes are too thin to take much light away, and would leave specks.
            let left = skin.half.triangles.iter().filter(|t| skin.half.nodes[t[0]].patch != Patch::Lash);
            let left: Vec<[DVec3; 3]> = left.map(|t| t.map(|i| places[i])).collect();
            let right = left.iter().map(|t| t.map(|p| DVec3::new(-p.x, p.y, p.z)));
            left.iter().copied().chain(right).collect::<Vec<_>>()
        };
        let rigid = |stems: &[&str], jaw: bool| {
            let mut all = Vec::new();
            for (stem, part) in sculpture.parts.iter().filter(|(stem, _)| stems.contains(stem)) {
                let at = |p: DVec3| if jaw && *stem == "LowerJaw" { turned(weights::JAW, p) } else { p };
                all.extend(part.triangles.iter().map(|t| t.map(|i| at(part.positions[i as usize]))));
            }
            all
        };
        let solid = ["UpperJaw", "LowerJaw", "RtEyeBall_smtt", "LtEyeBall_smtt"];
        let with = |mut a: Vec<[DVec3; 3]>, b: Vec<[DVec3; 3]>| {
            a.extend(b);
            Bvh::new(a)
        };
        let eye = &sculpture.parts[3].1;
        Self {
            skin,
            rest_tree: with(half(&rest), rigid(&solid, false)),
            posed_tree: with(half(&posed), rigid(&solid, true)),
            skin_tree: Bvh::new(half(&rest)),
            eyeball: eye.positions.iter().copied().zip(eye.normals.iter().copied()).collect(),
            normals,
            rest,
            posed,
            posed_normals,
        }
    }
}

/// Directions over a half space, denser around its axis as matte surfaces see it (Malley's method on a
/// Hammersley set): always the same ones.
fn directions() -> Vec<DVec3> {
    (0..RAYS)
        .map(|i| {
            let share = (f64::from(i) + 0.5) / f64::from(RAYS);
            let turn = 2.0 * PI * (f64::from(i.reverse_bits()) / 4_294_967_296.0);
            let r = share.sqrt();
            DVec3::new(r * cos(turn), r * sin(turn), (1.0 - share).sqrt())
        })
        .collect()
}

/// Two directions square to `n`.
fn across(n: DVec3) -> (DVec3, DVec3) {
    let away = if n.x.abs() < 0.6 { DVec3::X } else { DVec3::Y };
    let u = n.cross(away).normalize_or_zero();
    (u, n.cross(u))
}

/// Share of the sky that a place sees.
fn openness(tree: &Bvh, p: DVec3, n: DVec3, fan: &[DVec3]) -> f64 {
    let (u, v) = across(n);
    let from = p + n * 0.012;
    let mut closed = 0.0;
    for d in fan {
        let direction = u * d.x + v * d.y + n * d.z;
        if let Some(s) = tree.nearest(from, direction, REACH) {
            // Far walls take less: light comes back from them.
            closed += 1.0 - smooth(0.25 * REACH, REACH, s);
        }
    }
    1.0 - closed / fan.len() as f64
}

/// Depth of the flesh below a place, as light would measure it: short ways count for more than long ones
/// (Beer and Lambert's law over the rays inward).
fn thickness(tree: &Bvh, p: DVec3, n: DVec3, fan: &[DVec3]) -> f64 {
    const FADE: f64 = 0.6;
    let (u, v) = across(n);
    let mut light = 0.0;
    for d in fan {
        let direction = u * d.x + v * d.y - n * d.z;
        let way = tree.nearest(p - n * 0.02, direction, THICK).unwrap_or(THICK);
        light += exp(-way / FADE);
    }
    -FADE * libm::log(light / fan.len() as f64) / THICK
}

/// How much of a place's openness is that of the moved face: lips, lids and the mouth are seen moving.
fn moving(node: &Node) -> f64 {
    match node.patch {
        Patch::Mouth => 1.0,
        Patch::Ear | Patch::Lash => 0.0,
        _ => smooth(1.7, 0.5, node.lip).max(smooth(1.0, 0.7, node.lid)),
    }
}

/// Measures everything.
#[must_use]
pub fn bake(scene: &Scene) -> Baked {
    let fan = directions();
    let nodes = &scene.skin.half.nodes;
    let mut open = Vec::with_capacity(nodes.len());
    let mut thick = Vec::with_capacity(nodes.len());
    for (i, node) in nodes.iter().enumerate() {
        let still = openness(&scene.rest_tree, scene.rest[i], scene.normals[i], &fan);
        let share = 0.6 * moving(node);
        open.push(if share > 0.0 {
            let moved = openness(&scene.posed_tree, scene.posed[i], scene.posed_normals[i], &fan);
            lerp(still, moved.max(still), share)
        } else {
            still
        });
        thick.push(thickness(&scene.skin_tree, scene.rest[i], scene.normals[i], &fan));
    }
    for _ in 0..2 {
        open = evened(scene.skin, &open);
        thick = evened(scene.skin, &thick);
    }
    // Where the mesh is wide its triangles would show in the shade.
    for _ in 0..6 {
        let softer = evened(scene.skin, &open);
        for ((value, soft), node) in open.iter_mut().zip(softer).zip(nodes) {
            if node.patch == Patch::Sheet {
                *value = lerp(*value, soft, smooth(0.24, 0.32, scatter::spacing(node.p)));
            }
        }
    }
    let eyeball = scene
        .eyeball
        .iter()
        .map(|(p, n)| ((*p - EYE).normalize_or_zero(), openness(&scene.skin_tree, *p, *n, &fan)));
    Baked { openness: open, thickness: thick, eyeball: eyeball.collect() }
}

/// Each value moved half way to the mean of its neighbours' values.
fn evened(skin: &Skin, values: &[f64]) -> Vec<f64> {
    let mut sum = vec![(0.0, 0.0); values.len()];
    for t in &skin.half.triangles {
        for k in 0..3 {
            for j in [t[(k + 1) % 3], t[(k + 2) % 3]] {
                sum[t[k]] = (sum[t[k]].0 + values[j], sum[t[k]].1 + 1.0);
            }
        }
    }
    values.iter().zip(&sum).map(|(v, (s, n))| if *n > 0.0 { lerp(*v, s / n, 0.5) } else { *v }).collect()
}
