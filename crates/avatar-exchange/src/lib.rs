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

#[cfg(feature = "collada")]
pub mod collada;
#[cfg(any(feature = "collada", feature = "fbx"))]
mod corners;
mod error;
mod evaluate;
#[cfg(feature = "fbx")]
pub mod fbx;
mod freeze;
mod interpolate;
mod material;
#[cfg(any(feature = "collada", feature = "fbx"))]
mod resolve;
mod scene;

pub use error::ImportError;
pub use evaluate::ScenePose;
pub use freeze::{Palette, PaletteEntry, Scene};
pub use material::{AlphaMode, Material, SceneImage};
#[cfg(any(feature = "collada", feature = "fbx"))]
pub use resolve::Resolve;
pub use scene::{
    Channel, ChannelTarget, Clip, Interpolation, Node, NodeDrivers, Note, RawScene, ScenePart, Skin,
    Transform, Trs,
};
