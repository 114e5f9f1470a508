//! Draws rigged faces with wgpu: deformation in WGSL, skin, teeth, eyes and corneas.
//!
//! ```text
//!  meshes, textures ──▶ AvatarModel ─┐   shared by many avatars, uploaded once
//!                                    ├──▶ Renderer::draw ──▶ any texture view
//!  bones X, weights ──▶ AvatarState ─┤   one per avatar, set per frame
//!  camera, light ─────▶ Scene ───────┘
//! ```
//!
//! The caller brings the device, the queue, the encoder and the view; nothing beyond WebGPU's default limits and no
//! optional feature is needed. This crate opens no files and windows, reads neither clock nor environment, starts no
//! threads and knows neither joints nor poses: a pose arrives as bone matrices and blend weights.
//!
//! # Conventions
//!
//! Spaces are those of the [rig](../rig_core/index.html#conventions): right-handed, +Y up, the face looks along +Z, the
//! character's left is +X. Matrices are called `a_from_b`, here and in WGSL, so that neighbours cancel. Clip space is
//! wgpu's, with reversed depth ([`Camera`]). Triangles run counter-clockwise seen from outside; a part that is mostly
//! inside out is turned around. Colours are linear unless they are 8-bit; a target holds them premultiplied by alpha.
//!
//! # One frame
//!
//! ```text
//!  pass "avatars"       clear, then for all avatars:
//!    skin               front sides
//!    teeth              both sides
//!    eyeball            front sides
//!    skin back          what shows at the rim of the neck, lids and lips: a hollow in ambient light
//!    cornea             front sides, blended, far to near, depth tested but not written
//! ```
//!
//! Bind groups change rarely in front and often behind: 0 frame (camera, light, sampler), 1 avatar (bones, active
//! shapes), 2 part geometry (vertices, bones per vertex, shape offsets), 3 part looks (material, textures). Vertices are
//! deformed in the vertex stage by one WGSL function, which the compute pass of [`Deformer`] calls as well; its twin on
//! the CPU is [`avatar_mesh::deform()`].
//!
//! # Example
//!
//! ```no_run
//! use avatar_mesh::{Mesh, PartKind};
//! use avatar_render::headless::{GpuOptions, open_blocking, render_image};
//! use avatar_render::{AvatarModel, AvatarState, Camera, Light, PartBones, PartDesc, PartTextures, Scene};
//! use glam::{Affine3A, Vec3};
//!
//! # let mesh = Mesh::default();
//! let gpu = open_blocking(GpuOptions::default())?;
//! let bones = PartBones::Rigid(0);
//! let part = PartDesc { label: "skin", mesh: &mesh, kind: PartKind::Skin, bones, textures: PartTextures::default() };
//! let model = AvatarModel::new(&gpu.device, &gpu.queue, &[part], 1)?;
//! let mut state = AvatarState::new(&gpu.device, &model);
//! state.set(&gpu.queue, &[Affine3A::from_rotation_y(0.3)], &[])?;
//! let camera = Camera::orbit(Vec3::ZERO, 4.0, 0.0, 0.1, 0.5, 4.0 / 3.0);
//! let scene = Scene { camera, background: [0.0; 4], light: Light::default() };
//! let picture = render_image(&gpu, 640, 480, 4, &scene, &[(&model, &state)])?;
//! assert_eq!(picture.rgba.len(), 4 * 640 * 480);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

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
pub use color::linear_from_srgb8;
pub use deformer::{Deformer, DeformerError};
pub use image::{Image, ImageSizeError};
pub use material::Material;
pub use model::{AvatarModel, ModelError, PartBones, PartDesc, PartProblem, PartTextures};
pub use readback::ReadbackError;
pub use renderer::{DrawError, Renderer, RendererConfig, RendererError};
pub use scene::{Lamp, Light, Scene};
pub use state::{AvatarState, StateError};
pub use targets::{SizeError, Targets};
