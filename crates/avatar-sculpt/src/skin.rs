//! The skin: two mirrored halves with normals, weights, shapes and texture coordinates.

use std::collections::BTreeMap;

use glam::{DVec2, DVec3};

use crate::{
    crease, form, layout,
    math::smooth,
    mesh, shapes,
    surface::{
        ear,
        half::{Half, Patch},
        lashes, mouth_bag,
        rings::Loops,
        sheet, socket,
    },
    weights::{self, Influence},
};

/// A finished vertex of the skin.
#[derive(Clone, Copy, Debug)]
pub struct Vertex {
    /// Place at rest.
    pub p: DVec3,
    /// Texture coordinates, v downward.
    pub uv: DVec2,
    /// Unit normal at rest.
    pub normal: DVec3,
    /// Bones and weights.
    pub influence: Influence,
    /// Displacement and change of the normal per shape.
    pub shapes: [(DVec3, DVec3); 2],
    /// Number of the vertex of the half mesh that this one comes from.
    pub source: usize,
}

/// The finished skin.
#[derive(Clone, Debug)]
pub struct Skin {
    /// The left half that everything comes from.
    pub half: Half,
    /// Where the outer skin stops.
    pub loops: Loops,
    /// Vertices, split where the texture has a seam.
    pub vertices: Vec<Vertex>,
    /// Counter-clockwise triangles; the first half of them is the character's left side.
    pub triangles: Vec<[u32; 3]>,
}

/// Builds the skin.
#[must_use]
pub fn build() -> Skin {
    let (mut half, loops) = sheet::build();
    socket::add(&mut half, &loops);
    mouth_bag::add(&mut half, &loops);
    ear::add(&mut half, &loops);
    lashes::add(&mut half, &loops);
    for node in &mut half.nodes {
        // What the file will hold is what everything is computed from.
        node.p = node.p.as_vec3().as_dvec3();
    }

    let places = |half: &Half| half.nodes.iter().map(|n| n.p).collect::<Vec<DVec3>>();
    let whole = half_normals(&places(&half), &half.triangles);
    let mut base = base_normals(&half, &loops, &whole);
    let split_off = crease::split(&mut half, &base);
    let rest = places(&half);
    let from_mesh = half_normals(&rest, &half.triangles);
    base.resize(rest.len(), DVec3::ZERO);
    for i in 0..rest.len() {
        if split_off[i] {
            base[i] = from_mesh[i];
        }
    }
    let fields: Vec<Vec<(DVec3, DVec3)>> = shapes::SHAPES
        .iter()
        .map(|(_, field)| {
            let offset: Vec<DVec3> = (0..rest.len())
                .map(|i| {
                    let n = half.mover(i);
                    if n.p.x == 0.0 { field(n) * DVec3::new(0.0, 1.0, 1.0) } else { field(n) }
                })
                .collect();
            let moved: Vec<DVec3> = rest.iter().zip(&offset).map(|(p, d)| *p + *d).collect();
            let turned = half_normals(&moved, &half.triangles);
            let change = |i: usize| (base[i] + turned[i] - from_mesh[i]).normalize_or_zero() - base[i];
            offset.iter().enumerate().map(|(i, d)| (*d, change(i))).collect()
        })
        .collect();

    let mut skin = Skin { half, loops, vertices: Vec::new(), triangles: Vec::new() };
    let mut known: BTreeMap<(usize, bool, u64, u64), u32> = BTreeMap::new();
    for right in [false, true] {
        for t in &skin.half.triangles {
            let mut uvs = layout::corners(&skin.half, t);
            let mut corners = *t;
            if right {
                corners.swap(1, 2);
                uvs.swap(1, 2);
                uvs = uvs.map(|uv| DVec2::new(1.0 - uv.x, uv.y));
            }
            let mut numbers = [0; 3];
            for k in 0..3 {
                let i = corners[k];
                let node = &skin.half.nodes[i];
                let mirrored = right && node.p.x != 0.0;
                let key = (i, mirrored, uvs[k].x.to_bits(), uvs[k].y.to_bits());
                numbers[k] = *known.entry(key).or_insert_with(|| {
                    let vertex = Vertex {
                        p: node.p,
                        uv: uvs[k],
                        normal: base[i],
                        influence: weights::of(skin.half.mover(i)),
                        shapes: [fields[0][i], fields[1][i]],
                        source: i,
                    };
                    skin.vertices.push(if mirrored { mirror(vertex) } else { vertex });
                    (skin.vertices.len() - 1) as u32
                });
            }
            skin.triangles.push(numbers);
        }
    }
    skin
}

/// The same vertex on the character's right side.
fn mirror(v: Vertex) -> Vertex {
    let flip = |d: DVec3| DVec3::new(-d.x, d.y, d.z);
    let bone = |b: usize| if b == weights::UPPER_LID || b == weights::LOWER_LID { b + 1 } else { b };
    Vertex {
        p: flip(v.p),
        normal: flip(v.normal),
        influence: v.influence.map(|(b, w)| (bone(b), w)),
        shapes: v.shapes.map(|(d, n)| (flip(d), flip(n))),
        ..v
    }
}

/// Normals of the half mesh; on the midline the mirrored half is taken into account.
fn half_normals(positions: &[DVec3], triangles: &[[usize; 3]]) -> Vec<DVec3> {
    let mut normals = mesh::normals(positions, triangles);
    for (n, p) in normals.iter_mut().zip(positions) {
        if p.x == 0.0 {
            *n = DVec3::new(0.0, n.y, n.z).normalize_or_zero();
        }
    }
    normals
}

/// Normals at rest: those of the solid where the mesh follows it, those of the mesh on edges and swept parts.
fn base_normals(half: &Half, loops: &Loops, from_mesh: &[DVec3]) -> Vec<DVec3> {
    let mut on_edge = vec![false; half.nodes.len()];
    for &i in loops.eye.iter().chain(&loops.mouth).chain(&loops.ear) {
        on_edge[i] = true;
    }
    half.nodes
        .iter()
        .enumerate()
        .map(|(i, node)| {
            if node.patch != Patch::Sheet || on_edge[i] {
                return from_mesh[i];
            }
            let n = form::normal(node.p);
            // In a furrow finer than the mesh the solid's normal says nothing about the triangles around it.
            from_mesh[i].lerp(n, smooth(0.84, 0.98, n.dot(from_mesh[i]))).normalize_or_zero()
        })
        .collect()
}
