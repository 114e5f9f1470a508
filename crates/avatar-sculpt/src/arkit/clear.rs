//! What keeps skin off the eye and the teeth, whatever a field says.

use glam::DVec3;

use super::spot::Spot;
use crate::{anatomy::EYE, math::smooth, parts::teeth, surface::half::Patch};

/// Takes the part of a displacement toward the eye away where the lids lie on it.
///
/// What is left slides or leads away, so that sums of such displacements keep clear, too.
pub(super) fn of_eye(spot: &Spot, d: DVec3) -> DVec3 {
    if spot.in_mouth() || spot.node.patch == Patch::Ear {
        return d;
    }
    let rel = spot.p() - EYE;
    let r = rel.length();
    let near = smooth(3.3, 2.2, r);
    let outward = rel / r.max(1e-9);
    d - outward * (d.dot(outward).min(0.0) * near)
}

/// Takes the part of a displacement toward the gums away on the inner side of the lips, which lies close to
/// them.
///
/// The rows of teeth bulge forward everywhere: what slides along them or leaves them stays outside, whatever
/// sum it is part of.
pub(super) fn of_teeth(spot: &Spot, d: DVec3) -> DVec3 {
    if !spot.in_mouth() {
        return d;
    }
    // The lips' edges are free: they lie well before the teeth.
    let inside = smooth(0.12, 0.32, spot.node.own.x);
    let outward = teeth::outward(spot.p());
    d - outward * (d.dot(outward).min(0.0) * inside)
}
