use crate::Mesh;
use glam::Vec3A;

/// How many triangles run counter-clockwise around their vertices' normals.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Winding {
    /// Triangles that agree with their normals.
    pub agreeing: usize,
    /// Triangles that contradict their normals.
    pub contradicting: usize,
    /// Triangles without area, or at right angles to their normals.
    pub undecided: usize,
}

impl Winding {
    /// Counts the triangles of a valid mesh; corners beyond the vertices count as undecided.
    pub fn of(mesh: &Mesh) -> Self {
        let mut winding = Self::default();
        winding.count(mesh, &mesh.triangles);
        winding
    }

    /// The count of a mesh that is inside out ([`Winding::is_inside_out`]), and `None` for any other: as
    /// soon as half of the triangles agree with their normals, the others are not looked at.
    pub fn of_inside_out(mesh: &Mesh) -> Option<Self> {
        let mut winding = Self::default();
        // The first half, and then a little at a time.
        let (half, rest) = mesh.triangles.split_at(mesh.triangles.len().div_ceil(2));
        for triangles in std::iter::once(half).chain(rest.chunks(1024)) {
            winding.count(mesh, triangles);
            if 2 * winding.agreeing >= mesh.triangles.len() {
                return None;
            }
        }
        winding.is_inside_out().then_some(winding)
    }

    /// Whether the part must be turned around for drawing.
    pub fn is_inside_out(self) -> bool {
        self.contradicting > self.agreeing
    }

    fn count(&mut self, mesh: &Mesh, triangles: &[[u32; 3]]) {
        let vertices = mesh.positions.len().min(mesh.normals.len());
        let (positions, normals) = (&mesh.positions[..vertices], &mesh.normals[..vertices]);
        let (mut agreeing, mut contradicting) = (0, 0);
        for corners in triangles {
            let [a, b, c] = corners.map(|corner| corner as usize);
            let agreement = if a.max(b).max(c) < vertices {
                let point = |corner: usize| Vec3A::from(positions[corner]);
                let normal = |corner: usize| Vec3A::from(normals[corner]);
                let face = (point(b) - point(a)).cross(point(c) - point(a));
                face.dot(normal(a) + normal(b) + normal(c))
            } else {
                0.0
            };
            agreeing += usize::from(agreement > 0.0);
            contradicting += usize::from(agreement < 0.0);
        }
        self.agreeing += agreeing;
        self.contradicting += contradicting;
        self.undecided += triangles.len() - agreeing - contradicting;
    }
}
