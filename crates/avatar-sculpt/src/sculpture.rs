//! All surfaces: the skin and the rigid parts.

use crate::{
    mesh::Part,
    parts::{eyes, teeth},
    skin::{self, Skin},
};

/// Everything that has a form.
#[derive(Clone, Debug)]
pub struct Sculpture {
    /// The skin.
    pub skin: Skin,
    /// The rigid parts by the stem of their files.
    pub parts: [(&'static str, Part); 6],
}

/// Sculpts skin and rigid parts.
#[must_use]
pub fn sculpt() -> Sculpture {
    let (eyeball, cornea) = (eyes::eyeball(), eyes::cornea());
    let parts = [
        ("UpperJaw", teeth::upper()),
        ("LowerJaw", teeth::lower()),
        ("RtEyeBall_smtt", eyeball.mirrored()),
        ("LtEyeBall_smtt", eyeball),
        ("RtEyeTransp_smtt", cornea.mirrored()),
        ("LtEyeTransp_smtt", cornea),
    ];
    Sculpture { skin: skin::build(), parts }
}
