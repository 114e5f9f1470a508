//! What all formats have in common: the scene, its checks and its evaluation.

mod error;
mod input;
mod note;
mod material;
mod raw;
mod interpolate;
mod freeze;
mod evaluate;

pub use error::ImportError;
pub use evaluate::{SceneGraph, ScenePose};
pub use freeze::{Palette, PaletteEntry, Scene};
pub use input::{Resolve, TextFile};
pub use material::{AlphaMode, Material, SceneImage, TextureRef, ToonMaterial, UvSet, Wrap};
pub use note::{Finding, Note};
pub use raw::{
    Channel, ChannelTarget, Clip, Interpolation, Node, NodeDrivers, RawScene, ScenePart, Skin, Transform, Trs,
};

#[cfg(any(feature = "bvh", feature = "collada", feature = "fbx", feature = "gltf"))]
pub(crate) use error::quoted;
#[cfg(feature = "gltf")]
pub(crate) use interpolate::sample;
#[cfg(any(feature = "collada", feature = "gltf", feature = "md5"))]
pub(crate) use raw::narrow;
#[cfg(feature = "collada")]
pub(crate) use raw::widen;
