//! Scenes of rigged meshes from interchange formats: what the formats have in common, and how to pose it.
//!
//! ```text
//!  bytes ──reader──▶ RawScene ──Scene::from_raw──▶ Scene ──at(clip, time)──▶ ScenePose ──bones──▶ matrices
//!                    (editable)                   (checked)                                         │
//!                                                   parts ────────── avatar_mesh::deform ◀──────────┘
//! ```
//!
//! Spaces and units are those of the crate `rig-core`: column vectors, right-handed, +Y up; a reader of a format
//! with other axes turns them. Transforms are called `a_from_b`.
//!
//! ```
//! use avatar_exchange::{Node, RawScene, Scene, ScenePart};
//! use glam::{Affine3A, Vec3};
//!
//! let mut raw = RawScene::default();
//! raw.nodes.push(Node { name: "root".to_owned(), ..Node::default() });
//! let mesh = avatar_mesh::Mesh {
//!     positions: vec![Vec3::X],
//!     uvs: vec![glam::Vec2::ZERO],
//!     normals: vec![Vec3::Y],
//!     ..avatar_mesh::Mesh::default()
//! };
//! raw.parts.push(ScenePart::rigid("dot", 0, mesh));
//! let scene = Scene::from_raw(raw)?;
//! let bones = scene.bones(&scene.rest());
//! assert_eq!(scene.bones_of(0, &bones), [Affine3A::IDENTITY]);
//! # Ok::<(), avatar_exchange::ImportError>(())
//! ```
//!
//! Each reader is behind a feature of its name. `fbx` compiles a C library, which does not build for
//! `wasm32-unknown-unknown`.
//!
//! This crate knows no files: readers take bytes, and a function that brings what a file refers to.

#[cfg(any(feature = "obj", feature = "md5"))]
mod angle_normals;
#[allow(dead_code, reason = "which readers are built in decides what of it is used")]
mod assemble;
#[cfg(feature = "bvh")]
pub mod bvh;
#[cfg(feature = "collada")]
pub mod collada;
#[cfg(any(feature = "collada", feature = "fbx"))]
mod corners;
mod error;
mod evaluate;
#[cfg(feature = "fbx")]
pub mod fbx;
mod freeze;
#[cfg(feature = "gltf")]
pub mod gltf;
#[cfg(feature = "gltf")]
mod gltf_write;
mod interpolate;
mod material;
#[cfg(feature = "md5")]
pub mod md5;
mod normals;
#[cfg(feature = "obj")]
pub mod obj;
mod read;
#[cfg(any(feature = "collada", feature = "fbx"))]
mod resolve;
mod scene;
#[cfg(feature = "target")]
pub mod target;
#[cfg(any(feature = "obj", feature = "bvh", feature = "md5"))]
mod text;
#[cfg(feature = "vrm")]
pub mod vrm;

/// Writing GLB, the binary form of glTF 2.0; [`gltf`] reads it.
#[cfg(feature = "gltf")]
pub mod glb {
    pub use crate::gltf_write::{ExportError, write, write_raw};
}

pub use error::ImportError;
pub use evaluate::ScenePose;
pub use freeze::{Palette, PaletteEntry, Scene};
pub use material::{AlphaMode, Material, SceneImage};
pub use normals::deform_unevenly;
pub use read::{FRAMES_PER_SECOND, Format, Resolve, TextFile, read};
pub use scene::{
    Channel, ChannelTarget, Clip, Interpolation, Node, NodeDrivers, Note, RawScene, ScenePart, Skin,
    Transform, Trs,
};
