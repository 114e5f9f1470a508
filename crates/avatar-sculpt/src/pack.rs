//! The whole pack in memory.

use anyhow::Result;

use crate::{
    paint,
    parts::{eyes, teeth},
    raw, rig, skin,
};

/// Files by name, in a fixed order.
#[derive(Clone, Debug, Default)]
pub struct Pack {
    /// Name and content of every file.
    pub files: Vec<(String, Vec<u8>)>,
}

/// Builds every file of the pack; touches no file itself.
///
/// # Errors
///
/// If a picture cannot be encoded.
pub fn build() -> Result<Pack> {
    let mut files = vec![("Transformations.xml".to_owned(), rig::transformations_xml().into_bytes())];
    let skin = skin::build();
    files.push(("MarsienneSkin_VB.raw".to_owned(), raw::skin_vertices(&skin)));
    files.push(("MarsienneSkin_IB.raw".to_owned(), raw::indices(&skin.triangles)));
    let (eyeball, cornea) = (eyes::eyeball(), eyes::cornea());
    let parts = [
        ("UpperJaw", teeth::upper()),
        ("LowerJaw", teeth::lower()),
        ("RtEyeBall_smtt", eyeball.mirrored()),
        ("LtEyeBall_smtt", eyeball),
        ("RtEyeTransp_smtt", cornea.mirrored()),
        ("LtEyeTransp_smtt", cornea),
    ];
    for (name, part) in &parts {
        files.push((format!("{name}_VB.raw"), raw::part_vertices(part)));
        files.push((format!("{name}_IB.raw"), raw::indices(&part.triangles)));
    }
    files.extend(paint::all(&skin)?);
    Ok(Pack { files })
}
