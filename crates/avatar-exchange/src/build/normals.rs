//! Normals that a file lacks: sums over the triangles around a vertex, in f64, since products of the largest
//! coordinates overflow in f32.

use glam::{DVec3, Vec3};

/// How much a triangle counts at its corners.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Weighting {
    /// By its area. Where no triangles share a vertex these are the flat normals that glTF 2.0 (section
    /// 3.7.2.1) asks for.
    #[cfg(any(feature = "collada", feature = "fbx", feature = "gltf"))]
    Area,
    /// By its angle there (G. Thürmer, C. A. Wüthrich, *Computing Vertex Normals from Polygonal Facets*,
    /// Journal of Graphics Tools 3(1), 1998), which does not depend on how a polygon is cut.
    #[cfg(any(feature = "obj", feature = "md5"))]
    Angle,
}

/// Sums of normals: one for each group of corners that share a normal.
#[derive(Debug)]
pub(crate) struct NormalSums {
    sums: Vec<DVec3>,
    weighting: Weighting,
}

impl NormalSums {
    /// So many groups.
    pub(crate) fn new(groups: usize, weighting: Weighting) -> Self {
        Self { sums: vec![DVec3::ZERO; groups], weighting }
    }

    /// One more group: its number.
    #[cfg(feature = "obj")]
    pub(crate) fn add_group(&mut self) -> u32 {
        self.sums.push(DVec3::ZERO);
        self.sums.len() as u32 - 1
    }

    /// Adds a triangle to the groups of its corners. Groups out of range are ignored.
    pub(crate) fn add(&mut self, points: [Vec3; 3], groups: [u32; 3]) {
        let points = points.map(|point| point.as_dvec3());
        let twice_area = (points[1] - points[0]).cross(points[2] - points[0]);
        let of_corner = |corner: usize| match self.weighting {
            #[cfg(any(feature = "collada", feature = "fbx", feature = "gltf"))]
            Weighting::Area => {
                let _ = corner;
                twice_area
            }
            #[cfg(any(feature = "obj", feature = "md5"))]
            Weighting::Angle => {
                let from = points[corner];
                let (next, last) = (points[(corner + 1) % 3] - from, points[(corner + 2) % 3] - from);
                let angle = next.cross(last).length().atan2(next.dot(last));
                if angle.is_finite() { angle * twice_area.normalize_or_zero() } else { DVec3::ZERO }
            }
        };
        for (corner, group) in groups.into_iter().enumerate() {
            if let Some(sum) = self.sums.get_mut(group as usize) {
                *sum += of_corner(corner);
            }
        }
    }

    /// The normal of a group. One without area has none, and a mesh needs one everywhere: it looks along +Z
    /// by area (as the flat picture planes that such files hold) and +Y by angle.
    pub(crate) fn normal(&self, group: u32) -> Vec3 {
        let otherwise = match self.weighting {
            #[cfg(any(feature = "collada", feature = "fbx", feature = "gltf"))]
            Weighting::Area => DVec3::Z,
            #[cfg(any(feature = "obj", feature = "md5"))]
            Weighting::Angle => DVec3::Y,
        };
        self.sums.get(group as usize).copied().unwrap_or_default().normalize_or(otherwise).as_vec3()
    }
}

/// Normals for a mesh whose file has none, weighted by area: flat where no triangles share a vertex, smooth
/// where they do, since vertices keep the numbers that the file gives them.
#[cfg(feature = "gltf")]
pub(crate) fn normals_of(positions: &[Vec3], triangles: &[[u32; 3]]) -> Vec<Vec3> {
    let mut sums = NormalSums::new(positions.len(), Weighting::Area);
    for corners in triangles {
        sums.add(corners.map(|corner| positions.get(corner as usize).copied().unwrap_or_default()), *corners);
    }
    (0..positions.len() as u32).map(|vertex| sums.normal(vertex)).collect()
}
