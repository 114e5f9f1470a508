//! A place of the skin as the fields see it.

use glam::DVec3;

use crate::{
    anatomy::{EYE, MOUTH_HALF_WIDTH, brow, mouth_line},
    math::{curve, dome, ramp, smooth},
    surface::half::{Node, Patch},
};

/// A vertex of one of the two halves. All places and displacements are those of the left half: x points away
/// from the midline.
#[derive(Clone, Copy, Debug)]
pub struct Spot<'a> {
    /// The vertex of the left half.
    pub node: &'a Node,
    /// 1 on the shape's own side, −1 on the other one.
    pub side: f64,
}

/// Where a place lies about the mouth.
#[derive(Clone, Copy, Debug)]
pub struct Mouth {
    /// 0 at the midline, 1 at the corner; larger outside of it.
    pub u: f64,
    /// Height over the line between the lips.
    pub height: f64,
    /// 1 for the upper lip, −1 for the lower one, and evenly through 0 beside the corner.
    pub upper: f64,
    /// Distance across the lip: 0 at the line between the lips, 1 at the border of the red; rises with the
    /// height further out.
    pub across: f64,
    /// How much of a motion of the lips arrives here: 1 outside, fading toward the back of the mouth.
    pub front: f64,
}

/// [`dome`] with a width below zero (`less`) and one above (`more`).
#[must_use]
pub(super) fn dome_skewed(x: f64, less: f64, more: f64) -> f64 {
    let d = x / if x < 0.0 { less } else { more };
    dome(d * d)
}

impl Spot<'_> {
    /// The place at rest.
    #[must_use]
    pub fn p(&self) -> DVec3 {
        self.node.p
    }

    /// Whether it is inside the mouth.
    #[must_use]
    pub fn in_mouth(&self) -> bool {
        self.node.patch == Patch::Mouth
    }

    /// How much the face's outer skin, or what hangs on it, is meant here: nothing of the ears and the back.
    #[must_use]
    pub fn on_face(&self) -> f64 {
        match self.node.patch {
            Patch::Ear | Patch::Lash => 0.0,
            Patch::Mouth => 0.0,
            Patch::Socket => smooth(0.55, 0.2, self.node.own.x),
            Patch::Sheet => smooth(-3.6, -0.6, self.node.p.z),
        }
    }

    /// Describes the place relative to the mouth.
    #[must_use]
    pub fn mouth(&self) -> Mouth {
        let p = self.node.p;
        let u = p.x / MOUTH_HALF_WIDTH;
        let height = p.y - mouth_line(u.min(1.0)).y;
        let known = self.node.lip <= 2.0;
        let lower = if known { self.node.lower } else { height < 0.0 };
        // Where both lips end, what only one of them does must end, too.
        let open = if self.in_mouth() { smooth(1.0, 0.8, u) } else { smooth(1.06, 0.72, u) };
        let beyond = ramp(-0.5, 0.5, height) * 2.0 - 1.0;
        let upper = if lower { -1.0 } else { 1.0 } * open + beyond * (1.0 - open);
        let across = if known { self.node.lip.max(0.0) } else { 2.0 };
        let front = if self.in_mouth() { smooth(0.60, 0.22, self.node.own.x) } else { self.on_face() };
        Mouth { u, height, upper, across, front }
    }

    /// Where a place lies about the brow: 0 at the inner end, 1 at the tail, and the height over its middle.
    #[must_use]
    pub fn brow(&self) -> (f64, f64) {
        let p = self.node.p;
        let s = (p.x - 1.25) / 4.5;
        (s, p.y - brow(s.clamp(0.0, 1.0)).0.y)
    }

    /// Displacement of skin that slides about the eye by a small angle (positive lifts), in radians.
    ///
    /// It is the tangent of the turn: sums of such displacements never come nearer to the eye.
    #[must_use]
    pub fn about_eye(&self, angle_rad: f64) -> DVec3 {
        let rel = self.node.p - EYE;
        DVec3::new(0.0, angle_rad * rel.z, -angle_rad * rel.y)
    }

    /// Which lid a place near the eye belongs to.
    #[must_use]
    pub fn on_lower_lid(&self) -> bool {
        if self.node.lid <= 1.0 { self.node.lower } else { self.node.p.y < EYE.y }
    }
}

impl Mouth {
    /// 1 on the upper lip, 0 on the lower one.
    #[must_use]
    pub fn is_upper(&self) -> f64 {
        0.5 + 0.5 * self.upper
    }

    /// 1 on the lower lip, 0 on the upper one.
    #[must_use]
    pub fn is_lower(&self) -> f64 {
        0.5 - 0.5 * self.upper
    }

    /// Height that fades use: inside the mouth the rows spread up and down, but follow the lip they hang on.
    #[must_use]
    pub fn fade_height(&self, spot: &Spot) -> f64 {
        if spot.in_mouth() { 0.0 } else { self.height }
    }

    /// How near the corner of the mouth is: 1 there, with widths toward the midline, outward, up and down.
    #[must_use]
    pub fn corner(&self, spot: &Spot, inner: f64, outer: f64, up: f64, down: f64) -> f64 {
        let beside = (self.u - 1.0) * MOUTH_HALF_WIDTH;
        let x = beside / if beside < 0.0 { inner } else { outer };
        let h = self.fade_height(spot);
        let y = h / if h < 0.0 { down } else { up };
        // Skin hangs together: a weak motion reaches far over the cheek.
        let d2 = x * x + y * y;
        (0.78 * dome(d2) + 0.22 * dome(0.27 * d2)) * self.front
    }

    /// Like [`Mouth::corner`], but with a table for the way along the lips: a lip bends as a whole, the skin
    /// around it follows evenly.
    #[must_use]
    pub fn bent(&self, spot: &Spot, lips: &[(f64, f64)], widths: [f64; 4]) -> f64 {
        let [inner, outer, up, down] = widths;
        let even = self.corner(spot, inner, outer, up, down);
        if self.u >= 1.0 {
            return even;
        }
        let h = self.fade_height(spot);
        let y = h / if h < 0.0 { down } else { up };
        let bent = curve(lips, self.u) * (0.78 * dome(y * y) + 0.22 * dome(0.27 * y * y)) * self.front;
        // At the corner both agree; away from the red the even one takes over.
        let far = if spot.in_mouth() { 0.0 } else { smooth(0.9, 2.0, self.across) };
        bent + (even - bent) * far
    }

    /// A table over the way from the midline to the corner and beyond, in halves of the mouth's width.
    #[must_use]
    pub fn along(&self, knots: &[(f64, f64)]) -> f64 {
        curve(knots, self.u)
    }
}
