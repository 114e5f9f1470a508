use crate::{Mesh, Offsets, weld_positions};
use glam::Vec3;
use std::collections::HashMap;

/// Authored normals of one place that differ by less than this (the cosine of 5°) belong to one smooth
/// surface: texture seams do, hard edges do not.
const SMOOTH_COS: f32 = 0.996_194_7;

/// Normals recomputed from blended positions, for shapes that have none of their own.
///
/// The normal of a smooth group (vertices at one place whose authored normals agree) is `N(v) = normalize(
/// Σ_corners α · n_face )` with α the angle of the face at the corner (G. Thürmer, C. A. Wüthrich, *Computing
/// Vertex Normals from Polygonal Facets*, Journal of Graphics Tools 3(1), 1998). Each vertex gets its
/// authored normal plus the change, `n + N(v_blend) − N(v)`: at rest nothing changes, seams stay closed and
/// hard edges stay hard.
///
/// Its memory is allocated once, by [`Self::new`].
#[derive(Clone, Debug)]
pub struct SmoothNormals {
    /// The smooth group of each vertex.
    group_of: Vec<u32>,
    /// Those whose corners are vertices.
    triangles: Vec<[u32; 3]>,
    /// 1, or -1 where triangles run against the authored normals, for each group.
    signs: Vec<f32>,
    /// `N(v)` of each group at rest, zero where no triangle has area.
    rest: Vec<Vec3>,
    /// Room for the sums of a blended mesh.
    sums: Vec<Vec3>,
}

impl SmoothNormals {
    /// Prepares for a mesh. Triangles with corners beyond the vertices do not count.
    pub fn new(mesh: &Mesh) -> Self {
        let vertices = mesh.positions.len();
        let valid = |corners: &&[u32; 3]| corners.iter().all(|corner| (*corner as usize) < vertices);
        let triangles: Vec<[u32; 3]> = mesh.triangles.iter().filter(valid).copied().collect();
        let (group_of, authored) = groups(mesh);
        let mut smooth = Self {
            signs: vec![1.0; authored.len()],
            rest: vec![Vec3::ZERO; authored.len()],
            sums: vec![Vec3::ZERO; authored.len()],
            group_of,
            triangles,
        };
        smooth.sum_up(&mesh.positions);
        for (group, authored) in authored.iter().enumerate() {
            let normal = smooth.sums[group].normalize_or_zero();
            smooth.signs[group] = if normal.dot(*authored) < 0.0 { -1.0 } else { 1.0 };
            smooth.rest[group] = normal;
        }
        smooth
    }

    /// Number of vertices of the mesh.
    pub fn vertex_count(&self) -> usize {
        self.group_of.len()
    }

    /// Adds `N(positions) − N(v)` to each normal. Where a group has no normal, at rest or now, nothing
    /// changes. Slices of another length than the mesh are taken as far as they go.
    pub fn add_change(&mut self, positions: &[Vec3], normals: &mut [Vec3]) {
        self.sum_up(positions);
        for ((sum, rest), sign) in self.sums.iter_mut().zip(&self.rest).zip(&self.signs) {
            let now = sum.normalize_or_zero();
            let known = now != Vec3::ZERO && *rest != Vec3::ZERO;
            *sum = if known { (now - *rest) * *sign } else { Vec3::ZERO };
        }
        for (normal, &group) in normals.iter_mut().zip(&self.group_of) {
            *normal += self.sums[group as usize];
        }
    }

    /// The normal offsets of a shape of this mesh as they are at weight 1: an approximation for renderers
    /// that blend normals as they blend positions, exact at weights 0 and 1 of the shape alone.
    pub fn offsets(&mut self, mesh: &Mesh, positions: &Offsets) -> Offsets {
        let mut moved = mesh.positions.clone();
        positions.add_scaled(1.0, &mut moved);
        let mut change = vec![Vec3::ZERO; moved.len()];
        self.add_change(&moved, &mut change);
        change.into()
    }

    fn sum_up(&mut self, positions: &[Vec3]) {
        self.sums.fill(Vec3::ZERO);
        let at = |vertex: u32| positions.get(vertex as usize).copied().unwrap_or_default();
        for corners in &self.triangles {
            let points = corners.map(at);
            let normal = (points[1] - points[0]).cross(points[2] - points[0]).normalize_or_zero();
            if normal == Vec3::ZERO {
                continue;
            }
            for (k, &corner) in corners.iter().enumerate() {
                let (to_next, to_last) = (points[(k + 1) % 3] - points[k], points[(k + 2) % 3] - points[k]);
                // Precise for the thinnest of triangles, which the arc cosine is not.
                let angle = to_next.cross(to_last).length().atan2(to_next.dot(to_last));
                if angle.is_finite() {
                    self.sums[self.group_of[corner as usize] as usize] += angle * normal;
                }
            }
        }
    }
}

/// The smooth group of each vertex, and an authored normal of each group.
fn groups(mesh: &Mesh) -> (Vec<u32>, Vec<Vec3>) {
    let mut authored: Vec<Vec3> = Vec::new();
    let mut at_place: HashMap<u32, Vec<u32>> = HashMap::new();
    let places = weld_positions(&mesh.positions, 0.0);
    let group_of = places.iter().enumerate().map(|(vertex, place)| {
        let normal = mesh.normals.get(vertex).copied().unwrap_or_default().normalize_or_zero();
        let here = at_place.entry(*place).or_default();
        let known = here
            .iter()
            .find(|group| authored[**group as usize].dot(normal) >= SMOOTH_COS || normal == Vec3::ZERO);
        known.copied().unwrap_or_else(|| {
            let group = authored.len() as u32;
            authored.push(normal);
            here.push(group);
            group
        })
    });
    let group_of = group_of.collect();
    (group_of, authored)
}

impl Mesh {
    /// Gives shapes without normal offsets those of [`SmoothNormals::offsets`].
    pub fn add_shape_normals(&mut self) {
        if self.shapes.iter().all(|shape| shape.normals.is_some()) {
            return;
        }
        let mut smooth = SmoothNormals::new(self);
        let mut shapes = std::mem::take(&mut self.shapes);
        for shape in shapes.iter_mut().filter(|shape| shape.normals.is_none()) {
            shape.normals = Some(smooth.offsets(self, &shape.positions));
        }
        self.shapes = shapes;
    }
}
