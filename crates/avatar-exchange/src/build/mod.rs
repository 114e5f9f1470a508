//! What several readers build scenes with. Each stands here once; the readers differ in what they put in.
//!
//! `text` decodes bytes and reads numbers with their lines, `path` keeps references inside the file's folder,
//! `budget` bounds memory, `names` tells equal names apart; `normals`, `influences`, `shape`, `polygon` and
//! `corners` make meshes; `srgb` decodes colours.

#[cfg(any(feature = "collada", feature = "fbx", feature = "gltf", feature = "obj"))]
pub(crate) mod budget;
#[cfg(any(feature = "collada", feature = "fbx"))]
pub(crate) mod corners;
#[cfg(any(feature = "collada", feature = "fbx", feature = "gltf", feature = "md5"))]
pub(crate) mod influences;
#[cfg(any(feature = "collada", feature = "fbx", feature = "gltf", feature = "obj"))]
pub(crate) mod names;
#[cfg(any(feature = "collada", feature = "fbx", feature = "gltf", feature = "obj", feature = "md5"))]
pub(crate) mod normals;
#[cfg(any(feature = "collada", feature = "fbx", feature = "gltf", feature = "obj"))]
pub(crate) mod path;
#[cfg(any(feature = "collada", feature = "obj"))]
pub(crate) mod polygon;
#[cfg(feature = "gltf")]
pub(crate) mod shape;
#[cfg(any(feature = "collada", feature = "fbx", feature = "obj", feature = "vrm"))]
pub(crate) mod srgb;
#[cfg(any(feature = "collada", feature = "obj", feature = "bvh", feature = "md5"))]
pub(crate) mod text;
