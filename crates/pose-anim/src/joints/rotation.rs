//! Rotations and rotation vectors with their first two derivatives.

use crate::Jet;
use glam::{DQuat, DVec3};

/// `cos(θ/2)` and `sin(θ/2)/θ` as functions of `θ²`. Both are analytic, so the rotation vector may pass 0.
pub(super) fn half_angle(square: Jet) -> (Jet, Jet) {
    let q = square.value;
    let (cosine, sine) = if q < 1e-4 {
        // Series in θ²: exact to rounding here.
        let c = [1.0, -1.0 / 8.0, 1.0 / 384.0, -1.0 / 46_080.0];
        let s = [0.5, -1.0 / 48.0, 1.0 / 3_840.0, -1.0 / 645_120.0];
        (series(c, q), series(s, q))
    } else {
        let t = q.sqrt();
        let (sin, cos) = (0.5 * t).sin_cos();
        // d/dq = 1/(2t) · d/dt
        let s0 = sin / t;
        let c1 = -0.25 * s0;
        let s1 = (0.5 * cos - s0) / (2.0 * q);
        let s2 = (-0.125 * s0 - 3.0 * s1) / (2.0 * q);
        (
            Jet { value: cos, velocity: c1, acceleration: -0.25 * s1 },
            Jet { value: s0, velocity: s1, acceleration: s2 },
        )
    };
    (square.through(cosine), square.through(sine))
}

/// `angle / sin(angle/2)` as a function of `w = cos(angle/2)` in 0…1.
fn angle_by_sine(w: Jet) -> Jet {
    let c = w.value.clamp(0.0, 1.0);
    let left = 1.0 - c;
    // 2·acos(c)/√(1 − c²) is analytic at c = 1; with y its value, (1 − c²)·y' = c·y − 2.
    let f = if left < 1e-3 {
        // In powers of (1 − c): 2·Σ (n!)²·2ⁿ/(2n + 1)! (1 − c)ⁿ.
        let a = [2.0, 2.0 / 3.0, 4.0 / 15.0, 4.0 / 35.0, 16.0 / 315.0];
        let value = a[0] + left * (a[1] + left * (a[2] + left * (a[3] + left * a[4])));
        let slope = a[1] + left * (2.0 * a[2] + left * (3.0 * a[3] + left * 4.0 * a[4]));
        let curve = 2.0 * a[2] + left * (6.0 * a[3] + left * 12.0 * a[4]);
        Jet { value, velocity: -slope, acceleration: curve }
    } else {
        let square = 1.0 - c * c;
        let value = 2.0 * c.acos() / square.sqrt();
        let slope = (c * value - 2.0) / square;
        Jet { value, velocity: slope, acceleration: (value + 3.0 * c * slope) / square }
    };
    w.through(f)
}

/// The rotation vector from `end` to `rotation`, which are no more than half a turn apart as they are.
pub(super) fn offset_from(rotation: &[Jet; 4], end: DQuat) -> [Jet; 3] {
    let way = multiply(*rotation, end.conjugate());
    let scale = angle_by_sine(way[3]);
    [scale * way[0], scale * way[1], scale * way[2]]
}

/// `left · right` with a constant right factor.
pub(super) fn multiply([x, y, z, w]: [Jet; 4], right: DQuat) -> [Jet; 4] {
    let by = |a: f64, b: f64, c: f64, d: f64| {
        Jet::rest(a) * x + Jet::rest(b) * y + Jet::rest(c) * z + Jet::rest(d) * w
    };
    let DQuat { x: rx, y: ry, z: rz, w: rw } = right;
    [by(rw, rz, -ry, rx), by(-rz, rw, rx, ry), by(ry, -rx, rw, rz), by(-rx, -ry, -rz, rw)]
}

/// The vector part of a product of quaternions of any length.
pub(super) fn raw_product(a: DQuat, b: DQuat) -> DVec3 {
    let (av, bv) = (DVec3::new(a.x, a.y, a.z), DVec3::new(b.x, b.y, b.z));
    a.w * bv + b.w * av + av.cross(bv)
}

fn series([a, b, c, d]: [f64; 4], x: f64) -> Jet {
    Jet {
        value: a + x * (b + x * (c + x * d)),
        velocity: b + x * (2.0 * c + x * 3.0 * d),
        acceleration: 2.0 * c + 6.0 * d * x,
    }
}
