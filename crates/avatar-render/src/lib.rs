//! Draws rigged faces with wgpu: deformation in WGSL, skin, teeth, eyes and corneas.

mod camera;
mod color;
mod deformer;
mod drawable;
mod frame;
pub mod headless;
mod image;
#[cfg(test)]
mod layout_tests;
mod material;
mod mips;
mod model;
mod part;
mod readback;
mod renderer;
mod scene;
mod shaders;
mod state;
mod targets;
mod texture;

pub use camera::Camera;
pub use deformer::{Deformer, DeformerError};
pub use image::{Image, ImageSizeError};
pub use material::Material;
pub use model::{AvatarModel, ModelError, PartBones, PartDesc, PartProblem, PartTextures};
pub use readback::ReadbackError;
pub use renderer::{DrawError, Renderer, RendererConfig, RendererError};
pub use scene::{Lamp, Light, Scene};
pub use state::{AvatarState, StateError};
pub use targets::{SizeError, Targets};
