/// What a part of a face is made of; it decides how the part is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum PartKind {
    /// Skin, deformed by bones and shapes.
    Skin,
    /// Every surface without a shading of its own: teeth, gums and tongue of a face; clothes and anything
    /// else of other files.
    Surface,
    /// Eyeball with iris and pupil.
    Eyeball,
    /// Transparent front of the eye.
    Cornea,
}

/// What moves a part.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Follows {
    /// Every vertex names up to four bones of [`FACE_BONES`].
    Bones,
    /// The whole part follows one joint's bone matrix `X`.
    Joint(&'static str),
}

/// A part of the nine-joint face.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PartSpec {
    /// Name for people and for the command line.
    pub name: &'static str,
    /// The files are `<stem>_VB.raw` and `<stem>_IB.raw`.
    pub stem: &'static str,
    /// How it is drawn.
    pub kind: PartKind,
    /// What moves it.
    pub follows: Follows,
}

const fn part(name: &'static str, stem: &'static str, kind: PartKind, follows: Follows) -> PartSpec {
    PartSpec { name, stem, kind, follows }
}

/// The seven parts of a face in the raw format.
pub const FACE_PARTS: [PartSpec; 7] = [
    part("skin", "MarsienneSkin", PartKind::Skin, Follows::Bones),
    part("upper-jaw", "UpperJaw", PartKind::Surface, Follows::Joint("HeadJoint")),
    part("lower-jaw", "LowerJaw", PartKind::Surface, Follows::Joint("JawJoint")),
    part("right-eyeball", "RtEyeBall_smtt", PartKind::Eyeball, Follows::Joint("RtEyeJoint")),
    part("left-eyeball", "LtEyeBall_smtt", PartKind::Eyeball, Follows::Joint("LtEyeJoint")),
    part("right-cornea", "RtEyeTransp_smtt", PartKind::Cornea, Follows::Joint("RtEyeJoint")),
    part("left-cornea", "LtEyeTransp_smtt", PartKind::Cornea, Follows::Joint("LtEyeJoint")),
];

/// The joints that bone indices of the raw format stand for, whatever the order of the joints in the XML.
pub const FACE_BONES: [&str; 9] = [
    "NeckJoint",
    "HeadJoint",
    "LtUpperLidJoint",
    "RtUpperLidJoint",
    "LtLowerLidJoint",
    "RtLowerLidJoint",
    "JawJoint",
    "LtEyeJoint",
    "RtEyeJoint",
];

/// The blend shapes of the raw format, in the order of their offsets.
pub const FACE_SHAPES: [&str; 2] = ["SSmile", "Frown"];
