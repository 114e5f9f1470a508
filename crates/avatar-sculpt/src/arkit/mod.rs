//! The shapes of Apple's ARKit that bones cannot make, by their names.
//!
//! Of the 52, lids, eyes and the turns of the jaw are bones ([`BY_BONES`]). The other 39 are fields of
//! displacement on the landmarks of [`crate::anatomy`], written for the left half: a shape that has sides is
//! one field whose shares for both sides add up to the whole, and the right side is the exact mirror image.
//! Near the eye skin only slides about it or moves away from it, and lips keep clear of the teeth, so that
//! mixtures stay as clean as single shapes.

mod brows;
mod cheeks;
mod clear;
mod corners;
mod evened;
mod file;
mod jaw;
mod lid_arc;
mod lips;
mod mouth;
mod moved;
mod opened;
mod spot;
mod whole;

use glam::DVec3;

pub use file::{raw, toml};
pub use jaw::{FORWARD, TONGUE_DROP};
pub use moved::{Moved, moved};
pub use spot::Spot;

/// A displacement for a place of one of the two halves; x points away from the midline.
pub type Field = fn(&Spot) -> DVec3;

/// How a field makes shapes.
#[derive(Clone, Copy, Debug)]
pub enum Kind {
    /// One shape, the same on both sides.
    Both(Field),
    /// Two shapes, `…Left` and `…Right`, of which each moves its own side. The number is half the breadth of
    /// the change from all to nothing at the midline.
    Sided(Field, f64),
    /// Two shapes, `…Left` and `…Right`, of which each moves both sides in different ways.
    Across(Field),
    /// One shape, the same on both sides, that follows the jaw's share of the skin, which changes steeply at
    /// the corners of the mouth.
    WithJaw(Field),
    /// One shape, the same on both sides, that is meant for the fully opened jaw.
    OpenJaw(Field),
}

/// What the skin does, by the name without its side.
pub const FIELDS: [(&str, Kind); 25] = [
    ("browDown", Kind::Sided(brows::down, 0.9)),
    ("browInnerUp", Kind::Both(brows::inner_up)),
    ("browOuterUp", Kind::Sided(brows::outer_up, 0.3)),
    ("cheekPuff", Kind::Both(cheeks::puff)),
    ("cheekSquint", Kind::Sided(cheeks::squint, 0.5)),
    ("eyeSquint", Kind::Sided(brows::eye_squint, 0.3)),
    ("eyeWide", Kind::Sided(brows::eye_wide, 0.3)),
    ("jawForward", Kind::WithJaw(jaw::forward)),
    ("mouthClose", Kind::Both(mouth::close)),
    ("mouthDimple", Kind::Sided(corners::dimple, 1.1)),
    ("mouthFrown", Kind::Sided(corners::frown, 1.0)),
    ("mouthFunnel", Kind::Both(mouth::funnel)),
    ("mouth", Kind::Across(mouth::sideways)),
    ("mouthLowerDown", Kind::Sided(lips::lower_down, 1.0)),
    ("mouthPress", Kind::Sided(lips::press, 1.1)),
    ("mouthPucker", Kind::Both(mouth::pucker)),
    ("mouthRollLower", Kind::Both(lips::roll_lower)),
    ("mouthRollUpper", Kind::Both(lips::roll_upper)),
    ("mouthShrugLower", Kind::Both(lips::shrug_lower)),
    ("mouthShrugUpper", Kind::Both(lips::shrug_upper)),
    ("mouthSmile", Kind::Sided(corners::smile, 1.2)),
    ("mouthStretch", Kind::Sided(corners::stretch, 1.1)),
    ("mouthUpperUp", Kind::Sided(lips::upper_up, 1.0)),
    ("noseSneer", Kind::Sided(cheeks::sneer, 0.8)),
    ("tongueOut", Kind::WithJaw(jaw::tongue_room)),
];

/// What the tongue does inside the mouth, by names of our own: ARKit's trackers do not see it, visemes need
/// it.
pub const FURTHER: [&str; 2] = ["tongueBackUp", "tongueTipUp"];

/// What is added where linear motion fails, by name: the field, and what its weight is ([`Weight`]).
pub const CORRECTIVES: [(&str, Kind, Weight); 5] = [
    ("jawOpen_mouthClose", Kind::OpenJaw(mouth::close_opened), Weight::Product(["mouthClose", "jaw.open"])),
    ("jawOpen_mouthFunnel", Kind::Both(opened::funnel), Weight::Product(["mouthFunnel", "jaw.open"])),
    ("jawOpen_mouthPucker", Kind::Both(opened::pucker), Weight::Product(["mouthPucker", "jaw.open"])),
    (
        "jawOpen_mouthSmile",
        Kind::Sided(opened::smile, 1.2),
        Weight::OfSide(["mouthSmileLeft", "mouthSmileRight"], ["jaw.open"; 2]),
    ),
    (
        "lidClosed_eyeSquint",
        Kind::Sided(brows::closed_squint, 0.3),
        Weight::OfSide(["eyeSquintLeft", "eyeSquintRight"], ["lid.left.upper", "lid.right.upper"]),
    ),
];

/// Where the weight of a shape comes from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Weight {
    /// It has a control of its own.
    Control,
    /// It follows a control of a bone, which counts 0 at its default and 1 at its end, and stands alone at
    /// this value.
    Follows(&'static str, f64),
    /// It is the product of the values of two controls, of which that of a bone counts 1 at its end.
    Product([&'static str; 2]),
    /// For a shape with sides: the product of two controls, of which each has one for the left and one for
    /// the right.
    OfSide([&'static str; 2], [&'static str; 2]),
}

impl Weight {
    /// The weight of the left (0) or right (1) one of two shapes.
    fn of_side(self, side: usize) -> Self {
        if let Self::OfSide(own, other) = self { Self::Product([own[side], other[side]]) } else { self }
    }
}

/// What lids, eyes and jaw do by turning bones.
pub const BY_BONES: [&str; 13] = [
    "eyeBlinkLeft",
    "eyeBlinkRight",
    "eyeLookDownLeft",
    "eyeLookDownRight",
    "eyeLookInLeft",
    "eyeLookInRight",
    "eyeLookOutLeft",
    "eyeLookOutRight",
    "eyeLookUpLeft",
    "eyeLookUpRight",
    "jawLeft",
    "jawOpen",
    "jawRight",
];
