//! Scenes of rigged meshes from interchange formats: what the formats have in common, and how to pose it.
//!
//! ```text
//!  bytes ──reader──▶ RawScene ──Scene::from_raw──▶ Scene ──at(clip, time)──▶ ScenePose ──bones──▶ matrices
//!                    (editable)                   (checked)                                         │
//!                                                   parts ────────── avatar_mesh::deform ◀──────────┘
//!
//!  rooms:  scene ◀── build ◀── gltf ◀── vrm    obj ◀── target    fbx    collada    md5    bvh ◀── read
//!            └────────────── write (glb)          look_at ◀── vrm
//! ```
//!
//! Spaces and units are those of the crate `rig-core`: column vectors, right-handed, +Y up; a reader of a
//! format with other axes turns them. Transforms are called `a_from_b`.
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

pub mod memory;
mod scene;
pub mod look_at;
mod build;
#[cfg(feature = "gltf")]
pub mod gltf;
#[cfg(feature = "vrm")]
pub mod vrm;
#[cfg(feature = "obj")]
pub mod obj;
#[cfg(feature = "target")]
pub mod target;
#[cfg(feature = "fbx")]
pub mod fbx;
#[cfg(feature = "collada")]
pub mod collada;
#[cfg(feature = "md5")]
pub mod md5;
#[cfg(feature = "bvh")]
pub mod bvh;
mod read;
#[cfg(feature = "gltf")]
mod write;

/// Writing GLB, the binary form of glTF 2.0; [`gltf`] reads it.
#[cfg(feature = "gltf")]
pub mod glb {
    pub use crate::write::{ExportError, write, write_raw};
}

pub use read::{FRAMES_PER_SECOND, Format, read};
pub use scene::{
    AlphaMode, Channel, ChannelTarget, Clip, Finding, ImportError, Interpolation, Material, Node,
    NodeDrivers, Note, Palette, PaletteEntry, RawScene, Resolve, Scene, SceneGraph, SceneImage, ScenePart,
    ScenePose, Skin, TextFile, TextureRef, ToonMaterial, Transform, Trs, UvSet, Wrap,
};
