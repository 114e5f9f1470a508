//! glTF 2.0 and its binary form GLB.
//!
//! ```text
//!  bytes ──container──▶ JSON, BIN ──document──▶ views ──accessor──▶ numbers ──▶ nodes, parts, skins, clips
//! ```
//!
//! Structures of the JSON come from the crate `gltf`; everything behind them is read here with checked
//! arithmetic, since its own iterators trust counts and positions of a file. Whatever a file says, reading
//! ends with a scene or an error, in time and memory that are linear in the bytes given.

mod accessor;
mod animation;
mod component;
mod container;
mod coordinates;
mod document;
mod draco;
mod extensions;
mod json;
mod material;
mod meshopt;
mod node;
mod pointer;
mod primitive;
mod scan;
mod shown;
mod skin;
mod targets;
mod texture;
mod triangles;
mod uri;
mod vertex;
mod weights;

#[cfg(feature = "vrm")]
use crate::scene::TextureRef;
use crate::scene::{ImportError, RawScene, Resolve, Scene};
use document::Document;

pub use container::{Container, split};
pub use extensions::{EXTENSIONS, Extension, Support, support_of};

/// Reads `.gltf` (JSON) or `.glb`. `file` is its name for messages.
///
/// Every node of the file is in the scene; meshes of nodes that the file's default scene does not show are
/// left out, with a note. Primitives without normals get some, with a note. Points and lines are left out,
/// with a note.
///
/// ```
/// let json = br#"{"asset": {"version": "2.0"}, "nodes": [{"name": "hip", "translation": [0, 1, 0]}]}"#;
/// let scene = avatar_exchange::gltf::read("hip.gltf", json, &mut |_| Err("no other files".to_owned()))?;
/// assert_eq!(scene.worlds(&scene.rest())[0].translation.y, 1.0);
/// # Ok::<(), avatar_exchange::ImportError>(())
/// ```
///
/// # Errors
/// Data that is not glTF 2.0, required extensions that are not read here, files that `resolve` does not
/// bring.
pub fn read(file: &str, bytes: &[u8], resolve: &mut Resolve<'_>) -> Result<Scene, ImportError> {
    let raw = read_raw(file, bytes, resolve)?;
    Scene::from_raw(raw).map_err(|error| error.in_file(file))
}

/// As [`read()`], before the scene is checked as a whole: for readers of formats that build on glTF.
///
/// # Errors
/// As [`read()`].
pub fn read_raw(file: &str, bytes: &[u8], resolve: &mut Resolve<'_>) -> Result<RawScene, ImportError> {
    read_all(bytes, resolve).map_err(|error| error.in_file(file))
}

/// What formats that build on glTF read beside the scene.
#[cfg(feature = "vrm")]
pub(crate) struct Extras {
    /// The file's extensions by name.
    pub(crate) extensions: serde_json::Map<String, serde_json::Value>,
    /// For each mesh of the file the nodes that show it.
    pub(crate) nodes_of_meshes: Vec<Vec<usize>>,
    /// For each node its extensions of VRM by name.
    pub(crate) nodes: Vec<serde_json::Map<String, serde_json::Value>>,
    /// For each material its extensions of VRM by name.
    pub(crate) materials: Vec<serde_json::Map<String, serde_json::Value>>,
    /// For each texture its image.
    pub(crate) textures: Vec<Option<usize>>,
    /// For each material the texture that its extension says, with the place of its coordinates in meshes.
    pub(crate) further_textures: Vec<Option<TextureRef>>,
}

/// As [`read_raw()`], with what the scene lacks; the JSON is parsed once. `further` is an extension of
/// materials and its member that is a texture: meshes get its coordinates, too.
#[cfg(feature = "vrm")]
pub(crate) fn read_with_extras(
    bytes: &[u8],
    further: (&'static str, &'static str),
    resolve: &mut Resolve<'_>,
) -> Result<(RawScene, Extras), ImportError> {
    let container = split(bytes)?;
    let mut document = Document::open(&container, bytes.len(), resolve)?;
    document.further = Some(further);
    let extensions = document.root.extensions.take().map(|extensions| extensions.others).unwrap_or_default();
    let mut nodes_of_meshes = vec![Vec::new(); document.root.meshes.len()];
    for (number, node) in document.root.nodes.iter().enumerate() {
        let mesh = node.mesh.and_then(|mesh| nodes_of_meshes.get_mut(mesh.value()));
        mesh.into_iter().for_each(|nodes| nodes.push(number));
    }
    let nodes = document.root.nodes.iter().map(|node| own(&node.extensions, |all| &all.others)).collect();
    let materials = document.root.materials.iter();
    let materials = materials.map(|material| own(&material.extensions, |all| &all.others)).collect();
    let images = document.images;
    let textures = document.root.textures.iter();
    let textures = textures.map(|texture| texture::image_of(texture, images)).collect();
    let scene = read_scene(&mut document)?;
    let further_textures = std::mem::take(&mut document.further_textures);
    Ok((scene, Extras { extensions, nodes_of_meshes, nodes, materials, textures, further_textures }))
}

/// The extensions of VRM among those of an element.
#[cfg(feature = "vrm")]
fn own<T>(
    extensions: &Option<T>,
    others: impl Fn(&T) -> &serde_json::Map<String, serde_json::Value>,
) -> serde_json::Map<String, serde_json::Value> {
    let all = extensions.iter().flat_map(others);
    all.filter(|(name, _)| name.starts_with("VRM"))
        .map(|(name, value)| (name.clone(), value.clone()))
        .collect()
}

fn read_all(bytes: &[u8], resolve: &mut Resolve<'_>) -> Result<RawScene, ImportError> {
    let container = split(bytes)?;
    read_scene(&mut Document::open(&container, bytes.len(), resolve)?)
}

fn read_scene(document: &mut Document<'_>) -> Result<RawScene, ImportError> {
    let mut scene = RawScene::default();
    let showers = document.showers();
    document.read_nodes(&mut scene)?;
    document.read_skins(&mut scene)?;
    document.read_images(&mut scene)?;
    document.read_materials(&mut scene)?;
    document.read_parts(&mut scene)?;
    document.read_clips(&mut scene, &showers)?;
    document.note_the_rest();
    scene.notes = document.take_notes();
    Ok(scene)
}
