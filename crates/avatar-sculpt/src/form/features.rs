//! Cheeks, brow, eye sockets with lids, nose and chin.

use glam::DVec3;

use crate::{
    anatomy::{EYE, LID_RADIUS},
    math::{lerp, smooth, soft_abs},
    sdf::{ball, carve, cone, ellipsoid, ellipsoid_pitched, join},
};

/// Cheekbones, the fat of the cheek and the ridge of the brow.
pub(super) fn add_cheeks_and_brow(d: f64, q: DVec3) -> f64 {
    let bone = cone(q, DVec3::new(3.6, -1.75, 2.1), 0.95, DVec3::new(6.0, -0.9, -1.6), 0.75);
    let apple = ellipsoid(q, DVec3::new(2.9, -2.9, 2.35), DVec3::new(1.5, 1.5, 1.25));
    let d = join(join(d, bone, 1.6), apple, 1.4);
    let inner = cone(q, DVec3::new(0.9, 1.75, 3.35), 0.55, DVec3::new(3.1, 2.35, 3.05), 0.62);
    let outer = cone(q, DVec3::new(3.1, 2.35, 3.05), 0.62, DVec3::new(5.3, 1.85, 0.8), 0.5);
    join(d, join(inner, outer, 0.5), 1.1)
}

/// Sockets around the eyes, and the lids as a ball that rests in them.
pub(super) fn add_eyes(d: f64, q: DVec3) -> f64 {
    let socket = ellipsoid(q, EYE + DVec3::new(-0.08, 0.06, 2.6), DVec3::new(2.0, 1.38, 1.66));
    let inner = ball(q, DVec3::new(1.75, 0.05, 3.72), 0.58);
    let d = carve(carve(d, socket, 1.15), inner, 0.8);
    // The lids' ball sits a trace high, so that the upper lid passes in front of the lower one, and a second
    // swelling keeps the fold above the lid clear of the eye when the lid comes down and the fold is drawn flat.
    let lids = ball(q, EYE + DVec3::new(0.0, 0.20, 0.0), LID_RADIUS + 0.01);
    let fold = ball(q, EYE + DVec3::new(0.16, 0.47, -0.08), LID_RADIUS - 0.05);
    // Below, a tight fillet: the cheek must not rise above the lower lid, where the upper one comes to rest.
    let fillet = lerp(0.26, 0.5, smooth(-0.9, 0.2, q.y - EYE.y));
    join(d, join(lids, fold, 0.3), fillet)
}

/// Bridge, tip, wings and nostrils.
pub(super) fn add_nose(d: f64, q: DVec3) -> f64 {
    let bridge = cone(q, DVec3::new(0.0, 1.5, 3.25), 0.62, DVec3::new(0.0, -1.0, 4.14), 0.56);
    let dorsum = cone(q, DVec3::new(0.0, -1.0, 4.14), 0.56, DVec3::new(0.0, -2.45, 5.0), 0.58);
    let tip = ellipsoid_pitched(q, DVec3::new(0.0, -2.88, 5.36), DVec3::new(0.68, 0.56, 0.64), -0.30);
    let x = soft_abs(q.x, 0.1);
    let w = DVec3::new(x, q.y, q.z);
    let wing = ellipsoid_pitched(w, DVec3::new(0.78, -3.12, 4.42), DVec3::new(0.56, 0.54, 0.90), 0.25);
    let columella = cone(q, DVec3::new(0.0, -3.26, 5.20), 0.27, DVec3::new(0.0, -3.66, 4.2), 0.33);
    let wall = cone(w, DVec3::new(0.32, 0.9, 2.95), 0.44, DVec3::new(0.38, -2.2, 4.12), 0.58);
    let ridge = join(join(join(bridge, dorsum, 0.6), wall, 1.1), tip, 0.7);
    let lower = join(join(ridge, wing, 0.75), columella, 0.3);
    let nostril = ellipsoid_pitched(w, DVec3::new(0.47, -3.74, 4.74), DVec3::new(0.22, 0.34, 0.38), -0.35);
    let d = join(d, lower, 0.9);
    carve(d, nostril, 0.34)
}

/// The pad of the chin.
pub(super) fn chin(q: DVec3) -> f64 {
    ellipsoid(q, DVec3::new(0.0, -8.75, 3.2), DVec3::new(1.3, 0.95, 1.2))
}
