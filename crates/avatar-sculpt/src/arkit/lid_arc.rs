//! Keeps the skin of a closing upper lid at its distance from the eye.
//!
//! Where skin follows a lid by half, the mean of a still and a turning bone cuts the corner of the arc. The
//! loss grows with the square of the angle, so it is given back by two shapes: half way and at the end.

use glam::{DMat3, DVec3};

use crate::{
    anatomy::EYE,
    lids::{self, LOWER_CLOSE, UPPER_CLOSE, shrink},
    math::{cos, sin},
    skin::Skin,
    surface::{half::Patch, socket},
    weights,
};

/// The names of the shapes without their side, and which share of the lid's turn they are made for. The first
/// is the end of the control's range: without it the next one would go on below 0.
pub(super) const SHARES: [(&str, f64); 3] =
    [("lidOpened", -10.0 / 45.0), ("lidHalfClosed", 0.5), ("lidClosed", 1.0)];
/// The sides, and their controls.
pub(super) const SIDES: [(&str, &str, f64); 2] =
    [("Left", "lid.left.upper", 1.0), ("Right", "lid.right.upper", -1.0)];

/// How far below the edge of the closed upper lid the lower lashes come out, in radians about the eye.
const LASHES_BEFORE: f64 = 0.06;

/// How far the outer and the inner corner follow the lids that meet there: where they stayed, the skin beside
/// them would fold under the upper lid.
const CORNERS_FOLLOW: [DVec3; 2] = [DVec3::new(0.0, -0.025, 0.0), DVec3::new(0.0, 0.02, 0.0)];
/// How far the flesh between the lids gives way behind them, in its first row; in the second, half as far.
const FLESH_GIVES_WAY: [DVec3; 2] = [DVec3::new(0.0, 0.03, -0.1), DVec3::new(0.0, -0.02, -0.2)];

/// Where closed lids take a vertex that stands in a corner of the eye, whatever bones would do: a
/// displacement.
fn in_corner(skin: &Skin, number: usize) -> Option<DVec3> {
    let node = &skin.half.nodes[skin.vertices[number].source];
    let eye = &skin.loops.eye;
    let columns = [eye.len() / 2, 0];
    if node.patch == Patch::Socket {
        let corner = columns.iter().position(|c| (node.own.y * eye.len() as f64 - *c as f64).abs() < 0.5)?;
        let share = match socket::row(node) {
            1 => 1.0,
            2 => 0.5,
            _ => return None,
        };
        return Some(FLESH_GIVES_WAY[corner] * share);
    }
    let corner = columns.iter().position(|c| skin.half.nodes[eye[*c]].p == node.p)?;
    Some(CORNERS_FOLLOW[corner])
}

/// How much of the turn of a side's upper or lower lid a vertex takes.
fn share(skin: &Skin, number: usize, side: f64, lid: usize) -> f64 {
    let v = &skin.vertices[number];
    if v.p.x * side <= 0.0 {
        return 0.0;
    }
    let all = weights::of(skin.half.mover(v.source));
    all.iter().filter(|(bone, _)| *bone == lid).map(|(_, w)| w).sum()
}

/// What the bones of both lids do to each vertex when the upper one has turned by a share of its range: the
/// turn, and where the origin goes. A lower lid closes with the upper one, and does not open.
pub(super) fn bones(skin: &Skin, side: f64, turned: f64) -> Vec<(DMat3, DVec3)> {
    let about_x = |angle: f64| {
        let (s, c) = (sin(angle), cos(angle));
        DMat3::from_cols(DVec3::X, DVec3::new(0.0, c, s), DVec3::new(0.0, -s, c))
    };
    let (upper, lower) = (about_x(UPPER_CLOSE * turned), about_x(-LOWER_CLOSE * turned.max(0.0)));
    let eye = DVec3::new(EYE.x * side, EYE.y, EYE.z);
    let of = |i: usize| {
        let shares = (share(skin, i, side, weights::UPPER_LID), share(skin, i, side, weights::LOWER_LID));
        let turn = DMat3::IDENTITY * (1.0 - shares.0 - shares.1) + upper * shares.0 + lower * shares.1;
        (turn, eye - turn * eye)
    };
    (0..skin.vertices.len()).map(of).collect()
}

/// Offsets away from the lid's axis that make up for what the mean of two bones takes. Under closed lids the
/// lower lashes slide down, out from behind the edge of the upper one.
pub(super) fn offsets(skin: &Skin, side: f64, turned: f64, bones: &[(DMat3, DVec3)]) -> Vec<DVec3> {
    let of = |i: usize| {
        let v = &skin.vertices[i];
        let node = skin.half.nodes[v.source];
        if turned > 0.0
            && v.p.x * side > 0.0
            && let Some(d) = in_corner(skin, i)
        {
            let (turn, shift) = bones[i];
            return turn.inverse() * (v.p + d * turned - shift) - v.p;
        }
        if turned >= 1.0 && node.patch == Patch::Lash && node.lower && v.p.x * side > 0.0 {
            let root = skin.half.mover(v.source).p - EYE;
            let down = lids::covered(lids::along(root)) + LASHES_BEFORE;
            let (s, c) = (sin(down), cos(down));
            let rel = node.p - EYE;
            return DVec3::new(0.0, c * rel.y - s * rel.z - rel.y, c * rel.z + s * rel.y - rel.z);
        }
        let w = share(skin, i, side, weights::UPPER_LID);
        if w == 0.0 {
            return DVec3::ZERO;
        }
        let rel = skin.half.mover(skin.vertices[i].source).p - EYE;
        DVec3::new(0.0, rel.y, rel.z) * (1.0 / shrink(w, UPPER_CLOSE * turned) - 1.0)
    };
    (0..skin.vertices.len()).map(of).collect()
}
