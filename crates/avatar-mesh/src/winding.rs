use crate::Mesh;

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
        for corners in &mesh.triangles {
            let corner = |i: usize| corners[i] as usize;
            let point = |i| mesh.positions.get(corner(i)).copied().unwrap_or_default();
            let normal = |i| mesh.normals.get(corner(i)).copied().unwrap_or_default();
            let face = (point(1) - point(0)).cross(point(2) - point(0));
            let agreement = face.dot(normal(0) + normal(1) + normal(2));
            if agreement > 0.0 {
                winding.agreeing += 1;
            } else if agreement < 0.0 {
                winding.contradicting += 1;
            } else {
                winding.undecided += 1;
            }
        }
        winding
    }

    /// Whether the part must be turned around for drawing.
    pub fn is_inside_out(self) -> bool {
        self.contradicting > self.agreeing
    }
}
