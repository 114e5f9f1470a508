//! Normals for meshes whose files have none.

use glam::{DVec3, Vec3};

/// Adds to each group's sum the normals of a triangle, weighted by its angles (G. Thürmer, C. A. Wüthrich, *Computing
/// Vertex Normals from Polygonal Facets*, Journal of Graphics Tools 3(1), 1998). In f64: products of the largest
/// coordinates have no end in f32. Groups that are not there are left out.
pub(crate) fn add_triangle(points: [Vec3; 3], groups: [u32; 3], sums: &mut [DVec3]) {
    let points = points.map(|point| point.as_dvec3());
    let normal = (points[1] - points[0]).cross(points[2] - points[0]).normalize_or_zero();
    if normal == DVec3::ZERO {
        return;
    }
    for (k, group) in groups.into_iter().enumerate() {
        let (to_next, to_last) = (points[(k + 1) % 3] - points[k], points[(k + 2) % 3] - points[k]);
        let angle = to_next.cross(to_last).length().atan2(to_next.dot(to_last));
        if let Some(sum) = sums.get_mut(group as usize).filter(|_| angle.is_finite()) {
            *sum += angle * normal;
        }
    }
}

/// A sum as a normal; up where there is none, since a mesh needs one everywhere.
pub(crate) fn finish(sum: DVec3) -> Vec3 {
    sum.try_normalize().map_or(Vec3::Y, |normal| normal.as_vec3())
}
