use crate::{Groom, Hull};
use glam::{Affine3A, Vec3};

/// Segments of a strand.
pub const SEGMENTS: usize = 12;

/// The deformed triangle of a root.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Triangle {
    /// Corners in the world.
    pub positions: [Vec3; 3],
    /// Their normals in the world, unit length.
    pub normals: [Vec3; 3],
}

/// How far strands keep from the hull, as a fraction of the height of the skin.
pub const MARGIN: f32 = 0.006;

/// Length of the first segment by that of an even one.
pub const FIRST_SEGMENT: f32 = 0.15;

/// Neighbouring triangles, by number, whose strands bend alike.
pub const TUFT_TRIANGLES: u32 = 24;

/// The points of a strand, in the world; the twin of `grow_strand` in WGSL, line by line.
///
/// It starts on the triangle, goes on along the normal for one segment, and turns to where it is combed and pulled. `head`
/// takes the head from bind pose to its pose of now.
pub fn grow(
    groom: &Groom,
    strand: usize,
    triangle: &Triangle,
    head: &Affine3A,
) -> Option<[Vec3; SEGMENTS + 1]> {
    let (root, comb_local) = (groom.roots.get(strand)?, groom.combs.get(strand)?);
    let style = groom.style.region(root.region);
    let [w0, w1, w2] = root.barycentric;
    let [a, b, c] = triangle.positions;
    let start = a * w0 + b * w1 + c * w2;
    let [na, nb, nc] = triangle.normals;
    let normal = (na * w0 + nb * w1 + nc * w2).normalize_or(Vec3::Y);
    let [x, y, z] = axes(triangle.positions);
    let comb = x * comb_local.x + y * comb_local.y + z * comb_local.z;
    let length = style.length * groom.height * (1.0 - style.length_variation * root.random[0]);
    // The first segment only says where the strand leaves; long hair would stand off by its whole length otherwise.
    let first = FIRST_SEGMENT * length / SEGMENTS as f32;
    let step = (length - first) / (SEGMENTS - 1) as f32;
    let own = Vec3::from_array([root.random[1], root.random[2], root.random[3]]) * 2.0 - 1.0;
    let tuft = tuft(root.triangle);
    let aside = own * style.noise + tuft * style.clump;

    let mut points = [start; SEGMENTS + 1];
    let mut direction = normal;
    for i in 1..=SEGMENTS {
        let t = (i - 1) as f32 / SEGMENTS as f32;
        if i > 1 {
            let wanted = (comb * (1.0 - t)
                + aside * (2.0 * t).min(1.0)
                + Vec3::NEG_Y * (style.gravity * (0.3 + 3.0 * t)))
                .normalize_or(direction);
            let turned = direction + (wanted - direction) * style.bend;
            direction = turned.normalize_or(direction);
        }
        let mut next = points[i - 1] + direction * if i > 1 { step } else { first };
        if i > 1 {
            next = outside(&groom.hull, head, next, MARGIN * groom.height);
            direction = (next - points[i - 1]).normalize_or(direction);
            next = points[i - 1] + direction * step;
        }
        points[i] = next;
    }
    curl(&mut points, style.curl_radius * groom.height, style.curl_turns, root.random[3]);
    Some(points)
}

/// The frame of a triangle.
pub(crate) fn axes([a, b, c]: [Vec3; 3]) -> [Vec3; 3] {
    let x = (b - a).normalize_or(Vec3::X);
    let z = x.cross(c - a).normalize_or(Vec3::Z);
    [x, z.cross(x), z]
}

/// The way of a tuft: neighbours in the mesh go alike.
fn tuft(triangle: u32) -> Vec3 {
    let group = triangle / TUFT_TRIANGLES;
    let h = |salt: u32| {
        let mut v = group.wrapping_mul(0x9E37_79B1) ^ salt;
        v = (v ^ (v >> 15)).wrapping_mul(0x2C1B_3C6D);
        v = (v ^ (v >> 12)).wrapping_mul(0x297A_2D39);
        ((v ^ (v >> 15)) >> 8) as f32 / (1u32 << 23) as f32 - 1.0
    };
    Vec3::new(h(1), h(2), h(3))
}

/// The nearest point along the ray from the head's middle that is not inside of it.
fn outside(hull: &Hull, head: &Affine3A, point: Vec3, margin: f32) -> Vec3 {
    let rotation = head.matrix3;
    let from_center = rotation.transpose() * (point - Vec3::from(head.translation)) - hull.center;
    let distance = from_center.length();
    if distance <= 0.0 {
        return point;
    }
    let direction = from_center / distance;
    let least = hull.radius(direction) + margin;
    if distance >= least {
        return point;
    }
    point + Vec3::from(rotation * glam::Vec3A::from(direction * (least - distance)))
}

/// Winds a strand around itself, more toward the tip.
fn curl(points: &mut [Vec3; SEGMENTS + 1], radius: f32, turns: f32, phase: f32) {
    if radius <= 0.0 {
        return;
    }
    let along = (points[SEGMENTS] - points[1]).normalize_or(Vec3::NEG_Y);
    let side = along.cross(if along.x.abs() < 0.8 { Vec3::X } else { Vec3::Y }).normalize_or(Vec3::Z);
    let other = along.cross(side);
    for (i, point) in points.iter_mut().enumerate().skip(2) {
        let t = (i - 1) as f32 / (SEGMENTS - 1) as f32;
        let angle = std::f32::consts::TAU * (turns * t + phase);
        *point += (side * angle.cos() + other * angle.sin()) * (radius * t.min(0.35) / 0.35);
    }
}
