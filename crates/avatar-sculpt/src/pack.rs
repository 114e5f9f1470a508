//! The whole pack in memory.

use anyhow::Result;
use avatar_mesh::{
    Mesh,
    raw::{write_triangles, write_vertices},
};

use crate::{
    arkit,
    bake::{self, Scene},
    paint::{self, Complexion, Detail},
    raw, rig,
    sculpture::{Sculpture, sculpt},
};

/// The controls are text that people read and edit; it goes into the pack as it is.
const CONTROLS: &str = include_str!("controls.toml");
/// As are the materials.
const MATERIALS: &str = include_str!("materials.toml");
/// And the hair.
const HAIR: &str = include_str!("hair.toml");

/// As are the axes that make other people of her.
const IDENTITY: &str = include_str!("identity.toml");

/// Files by name, in a fixed order.
#[derive(Clone, Debug, Default)]
pub struct Pack {
    /// Name and content of every file.
    pub files: Vec<(String, Vec<u8>)>,
}

/// Joints, controls and meshes: all files but the pictures.
///
/// # Errors
///
/// If the joints cannot be written.
pub fn geometry(sculpture: &Sculpture) -> Result<Pack> {
    let mut files = vec![
        ("Transformations.xml".to_owned(), rig::transformations_xml()?.into_bytes()),
        ("controls.toml".to_owned(), CONTROLS.as_bytes().to_vec()),
        ("materials.toml".to_owned(), MATERIALS.as_bytes().to_vec()),
        ("identity.toml".to_owned(), IDENTITY.as_bytes().to_vec()),
        ("hair.toml".to_owned(), HAIR.as_bytes().to_vec()),
    ];
    let mut add = |stem: &str, mesh: &Mesh| {
        files.push((format!("{stem}_VB.raw"), write_vertices(mesh)));
        files.push((format!("{stem}_IB.raw"), write_triangles(mesh)));
    };
    add("MarsienneSkin", &raw::skin(&sculpture.skin));
    for (stem, part) in &sculpture.parts {
        add(stem, &raw::part(part));
    }
    let shapes = arkit::moved(sculpture);
    files.push(("shapes.toml".to_owned(), arkit::toml(&shapes).into_bytes()));
    files.push(("shapes.raw".to_owned(), arkit::raw(&shapes)));
    Ok(Pack { files })
}

/// The pictures, painted from the sculpture.
///
/// # Errors
///
/// If a picture cannot be encoded.
pub fn pictures(sculpture: &Sculpture, detail: Detail, complexion: &Complexion) -> Result<Pack> {
    let baked = bake::bake(&Scene::new(sculpture));
    Ok(Pack { files: paint::all(&sculpture.skin, &baked, detail, complexion)? })
}

/// Builds every file of the pack; touches no file itself.
///
/// # Errors
///
/// If a file cannot be encoded.
pub fn build(detail: Detail, complexion: &Complexion) -> Result<Pack> {
    let sculpture = sculpt();
    let mut pack = geometry(&sculpture)?;
    pack.files.extend(pictures(&sculpture, detail, complexion)?.files);
    Ok(pack)
}
