use avatar_mesh::Mesh;
use glam::{Vec2, Vec3};

/// Directions of a hull on a side of its square.
pub const HULL_SIZE: usize = 48;

/// How far the skin reaches from the middle of the head in every direction, at bind pose: what strands stay outside of. It
/// moves rigidly with the head.
#[derive(Clone, Debug, PartialEq)]
pub struct Hull {
    /// The middle.
    pub center: Vec3,
    /// Radii over an octahedron unfolded to a square, row by row.
    pub radii: Vec<f32>,
}

impl Hull {
    /// The hull of the vertices around `center`.
    pub fn new(mesh: &Mesh, center: Vec3) -> Self {
        let mut radii = vec![0.0f32; HULL_SIZE * HULL_SIZE];
        // Triangles are larger than cells: several points of each.
        for corners in &mesh.triangles {
            let [Some(a), Some(b), Some(c)] = corners.map(|i| mesh.positions.get(i as usize)) else {
                continue;
            };
            for i in 0..=4u8 {
                for j in 0..=4 - i {
                    let p = *a + (*b - *a) * (f32::from(i) / 4.0) + (*c - *a) * (f32::from(j) / 4.0) - center;
                    let place = square_from_direction(p.normalize_or(Vec3::Y)) * HULL_SIZE as f32;
                    let cell = |v: f32| (v as usize).min(HULL_SIZE - 1);
                    let radius = &mut radii[cell(place.y) * HULL_SIZE + cell(place.x)];
                    *radius = radius.max(p.length());
                }
            }
        }
        let mut hull = Self { center, radii };
        hull.fill();
        hull
    }

    /// Cells that no point fell into take the mean of their neighbours.
    fn fill(&mut self) {
        for _ in 0..HULL_SIZE {
            let old = self.radii.clone();
            let mut missing = false;
            for y in 0..HULL_SIZE {
                for x in 0..HULL_SIZE {
                    if old[y * HULL_SIZE + x] > 0.0 {
                        continue;
                    }
                    let around = [(0i32, 1i32), (0, -1), (1, 0), (-1, 0)].map(|(dx, dy)| {
                        let (nx, ny) = (x as i32 + dx, y as i32 + dy);
                        let inside =
                            (0..HULL_SIZE as i32).contains(&nx) && (0..HULL_SIZE as i32).contains(&ny);
                        if inside { old[ny as usize * HULL_SIZE + nx as usize] } else { 0.0 }
                    });
                    let known: Vec<f32> = around.into_iter().filter(|r| *r > 0.0).collect();
                    missing |= known.is_empty();
                    if !known.is_empty() {
                        self.radii[y * HULL_SIZE + x] = known.iter().sum::<f32>() / known.len() as f32;
                    }
                }
            }
            if !missing {
                break;
            }
        }
    }

    /// The radius in a direction of unit length; the twin of `hull_radius` in WGSL.
    pub fn radius(&self, direction: Vec3) -> f32 {
        let place = square_from_direction(direction) * HULL_SIZE as f32 - 0.5;
        let last = (HULL_SIZE - 1) as f32;
        let place = place.clamp(Vec2::ZERO, Vec2::splat(last));
        let low = place.floor().min(Vec2::splat(last - 1.0));
        let share = place - low;
        let at = |dx: usize, dy: usize| {
            let (x, y) = (low.x as usize + dx, low.y as usize + dy);
            self.radii.get(y * HULL_SIZE + x).copied().unwrap_or(0.0)
        };
        let mix = |a: f32, b: f32, t: f32| a + (b - a) * t;
        mix(mix(at(0, 0), at(1, 0), share.x), mix(at(0, 1), at(1, 1), share.x), share.y)
    }
}

/// Q. Meyer et al., "On Floating-Point Normal Vectors", 2010: the octahedron around the sphere, unfolded, 0…1. Down is in
/// the middle of the edges, where hair never is: the seam lies at the corners.
fn square_from_direction(d: Vec3) -> Vec2 {
    let scale = 1.0 / (d.x.abs() + d.y.abs() + d.z.abs()).max(1e-12);
    let (x, z) = (d.x * scale, d.z * scale);
    let sign = |v: f32| if v < 0.0 { -1.0 } else { 1.0 };
    let folded = if d.y < 0.0 {
        Vec2::new((1.0 - z.abs()) * sign(x), (1.0 - x.abs()) * sign(z))
    } else {
        Vec2::new(x, z)
    };
    folded * 0.5 + 0.5
}
