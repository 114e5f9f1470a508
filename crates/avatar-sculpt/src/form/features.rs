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
    // On to the ear: without its arch the bone would end in a dent.
    let arch = cone(q, DVec3::new(6.0, -0.9, -1.6), 0.75, DVec3::new(6.5, -1.1, -4.6), 0.46);
    let d = join(join(d, join(bone, arch, 0.6), 1.6), apple, 1.4);
    let inner = cone(q, DVec3::new(0.9, 1.80, 3.28), 0.52, DVec3::new(3.1, 2.38, 2.92), 0.60);
    let outer = cone(q, DVec3::new(3.1, 2.38, 2.92), 0.60, DVec3::new(5.3, 1.85, 0.8), 0.5);
    join(d, join(inner, outer, 0.5), 1.1)
}

/// Sockets around the eyes, and the lids as a ball that rests in them.
pub(super) fn add_eyes(d: f64, q: DVec3) -> f64 {
    let socket = ellipsoid(q, EYE + DVec3::new(-0.08, 0.06, 2.6), DVec3::new(2.0, 1.38, 1.66));
    let inner = ball(q, DVec3::new(1.68, 0.05, 3.72), 0.58);
    let d = carve(carve(d, socket, 1.15), inner, 0.8);
    // The lids' ball sits a trace high, so that the upper lid passes in front of the lower one, and a second
    // swelling keeps the fold above the lid clear of the eye when the lid comes down and the fold is drawn
    // flat.
    let lids = ball(q, EYE + DVec3::new(0.0, 0.20, 0.0), LID_RADIUS + 0.01);
    let fold = ball(q, EYE + DVec3::new(0.16, 0.47, -0.08), LID_RADIUS - 0.05);
    // Below, a tight fillet: the cheek must not rise above the lower lid, where the upper one comes to rest.
    let fillet = lerp(0.34, 0.5, smooth(-0.9, 0.2, q.y - EYE.y));
    // Toward the nose the hollow between lid and brow is filled: a deep one would be smeared over the closed
    // lid.
    let filled = ellipsoid(q, DVec3::new(2.25, 1.26, 2.74), DVec3::new(0.95, 0.78, 0.64));
    let d = join(d, filled, 0.8);
    join(d, join(lids, fold, 0.3), fillet)
}

/// Bridge, tip, wings and nostrils.
pub(super) fn add_nose(d: f64, q: DVec3) -> f64 {
    let bridge = cone(q, DVec3::new(0.0, 1.5, 3.30), 0.54, DVec3::new(0.0, -1.0, 4.26), 0.42);
    let dorsum = cone(q, DVec3::new(0.0, -1.0, 4.26), 0.42, DVec3::new(0.0, -2.45, 5.13), 0.46);
    let tip = ellipsoid_pitched(q, DVec3::new(0.0, -2.92, 5.34), DVec3::new(0.54, 0.54, 0.58), -0.30);
    let x = soft_abs(q.x, 0.1);
    let w = DVec3::new(x, q.y, q.z);
    let wing = ellipsoid_pitched(w, DVec3::new(0.98, -3.08, 4.36), DVec3::new(0.48, 0.54, 0.78), 0.25);
    // From the tip to the wing: without it both would be balls of their own.
    let lobule = cone(w, DVec3::new(0.20, -2.84, 5.28), 0.42, DVec3::new(0.86, -2.98, 4.62), 0.38);
    let columella = cone(q, DVec3::new(0.0, -3.24, 5.22), 0.27, DVec3::new(0.0, -3.76, 4.2), 0.31);
    let wall = cone(w, DVec3::new(0.32, 0.9, 2.95), 0.38, DVec3::new(0.36, -2.2, 4.16), 0.52);
    let ridge = join(join(join(bridge, dorsum, 0.6), wall, 0.9), join(tip, lobule, 0.5), 0.8);
    let lower = join(join(ridge, wing, 0.7), columella, 0.35);
    // Where the septum meets the lip, a rise instead of a pit.
    let spine = cone(q, DVec3::new(0.0, -3.60, 4.35), 0.26, DVec3::new(0.0, -4.2, 3.98), 0.20);
    let d = join(join(d, spine, 0.5), lower, 0.9);
    carve(d, nostril(w), 0.22)
}

/// Distance from the hollow of the left nostril.
pub(super) fn nostril(q: DVec3) -> f64 {
    ellipsoid_pitched(q, DVec3::new(0.58, -3.66, 4.72), DVec3::new(0.29, 0.54, 0.48), -0.35)
}

/// The pad of the chin.
pub(super) fn chin(q: DVec3) -> f64 {
    ellipsoid(q, DVec3::new(0.0, -8.75, 3.2), DVec3::new(1.3, 0.95, 1.2))
}
