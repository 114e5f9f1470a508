//! Draws rigged faces with wgpu: deformation in WGSL, skin, teeth, eyes and corneas.
//!
//! ```text
//!  meshes, textures ──▶ AvatarModel ─┐   shared by many avatars, uploaded once
//!                                    ├──▶ Renderer::draw ──▶ any texture view
//!  bones X, weights ──▶ AvatarState ─┤   one per avatar, set per frame
//!  camera, light ─────▶ Scene ───────┘
//! ```
//!
//! The caller brings the device, the queue, the encoder and the view; nothing beyond WebGPU's default limits
//! and no optional feature is needed. This crate opens no files and windows, reads neither clock nor
//! environment, starts no threads and knows neither joints nor poses: a pose arrives as bone matrices and
//! blend weights.
//!
//! # Conventions
//!
//! Spaces are those of the [rig](../rig_core/index.html#conventions): right-handed, +Y up, the face looks
//! along +Z, the character's left is +X. Matrices are called `a_from_b`, here and in WGSL, so that neighbours
//! cancel. Clip space is wgpu's, with reversed depth ([`Camera`]). Triangles run counter-clockwise seen from
//! outside; a part that is mostly inside out is turned around. Colours are linear unless they are 8-bit; a
//! target holds them premultiplied by alpha.
//!
//! [`wgpu`], [`glam`] and [`avatar_mesh`], whose types stand in this interface, are reexported: a program
//! that names them through this crate cannot mix versions.
//!
//! # One frame
//!
//! ```text
//!  deform               compute: shapes and bones, every part once
//!  grow hair            compute: every strand anew on the deformed skin, where a model has hair
//!  shadows              depth that the key and rim lamps see
//!  shadow of hair       how much of the key's light strands keep off
//!  depth and normals    one sample a pixel ┐ medium and high
//!  ambient occlusion    from both          ┘
//!  light on skin        before its colour  ┐ high
//!  scatter across       spread sideways    ┘
//!  avatars              clear, then for all avatars:
//!    skin               front sides
//!    teeth              both sides
//!    eyeball            front sides
//!    skin back          what shows at the rim of the neck, lids and lips: a hollow in ambient light
//!    outlines           toon only
//!    surfaces           of interchange files: opaque ones, those with holes, lines around cartoons
//!  hair                 strands as ribbons, where a model has hair
//!  corneas              and all that is blended, far to near, depth tested but not written; without hair
//!                       in one pass with the avatars
//! ```
//!
//! [`Shading`] decides which passes run and which terms programs have; [`Quality`] and [`Style`] choose a
//! shading.
//!
//! Of the bind groups of passes that draw, the first change rarely and the last often: 0 frame (camera,
//! light, tables), 1 view (what earlier passes left), 2 part looks (material, textures). The vertices are
//! buffers that the deform pass has written; its twin on the CPU is [`avatar_mesh::deform()`]. Materials,
//! lights and their mathematics are those of [`avatar_look`], whose types are reexported here.
//!
//! # Example
//!
//! ```no_run
//! use avatar_render::avatar_mesh::{Mesh, PartKind};
//! use avatar_render::glam::{Affine3A, Vec3};
//! use avatar_render::headless::{GpuOptions, open_blocking, render_image};
//! use avatar_render::{AvatarModel, AvatarState, Camera, Light, PartBones, PartDesc, PartTextures, Scene};
//!
//! # let mesh = Mesh::default();
//! let gpu = open_blocking(GpuOptions::default())?;
//! let bones = PartBones::Rigid(0);
//! let (kind, textures) = (PartKind::Skin, PartTextures::default());
//! let part = PartDesc { label: "skin", mesh: &mesh, first_weight: 0, kind, bones, textures };
//! let model = AvatarModel::new(&gpu.device, &gpu.queue, &[part], 1)?;
//! let mut state = AvatarState::new(&gpu.device, &model);
//! state.set(&gpu.queue, &[Affine3A::from_rotation_y(0.3)], &[])?;
//! let camera = Camera::orbit(Vec3::ZERO, 4.0, 0.0, 0.1, 0.5, 4.0 / 3.0);
//! let scene = Scene { camera, background: [0.0; 4], light: Light::studio() };
//! let picture = render_image(&gpu, 640, 480, 4, &scene, &[(&model, &state)])?;
//! assert_eq!(picture.rgba.len(), 4 * 640 * 480);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod gpu;
mod model;
mod deform;
mod view;
mod hair;
mod avatar;
mod frame;
pub mod headless;
#[cfg(test)]
mod layout_tests;
#[cfg(test)]
mod program_tests;

pub use avatar::crowd::AvatarCrowd;
pub use avatar::model::AvatarModel;
pub use avatar::read_back::{DeformerError, GrowerError};
pub use avatar::state::AvatarState;
/// The crate whose [`Groom`](avatar_groom::Groom)s [`AvatarModel::set_hair`] plants.
pub use avatar_groom;
pub use avatar_look::{
    Alpha, Cartoon, Environment, Iris, Lamp, Light, Lighting, Material, Panel, SecondUvs, Standard, Tone,
    ToneMap, Wrap, Wraps, Wrinkle,
};
/// The crate whose meshes are drawn.
pub use avatar_mesh;
pub use deform::crowd_error::CrowdError;
pub use deform::crowd_pose::CrowdWork;
pub use deform::deformer::Deformer;
pub use deform::pose::StateError;
pub use frame::draw::DrawError;
pub use frame::renderer::{Renderer, RendererError};
pub use frame::see_through::SeeThrough;
pub use frame::targets::{SizeError, Targets};
pub use frame::timer::PassTimer;
/// The crate of vectors and matrices that this one was built with: types of another version of it do not fit.
pub use glam;
pub use gpu::color::linear_from_srgb8;
pub use gpu::image::{Image, ImageSizeError};
pub use gpu::readback::ReadbackError;
pub use hair::detail::HairDetail;
pub use hair::error::HairError;
pub use hair::grower::Grower;
pub use model::desc::{PartBones, PartDesc, PartTextures, Wrinkles};
pub use model::error::{ModelError, NoSuchPart, PartProblem};
pub use view::camera::Camera;
pub use view::config::RendererConfig;
pub use view::scene::Scene;
pub use view::shading::{Quality, Scattering, Shading, Shadows, Style, Terms};
/// The crate of devices, queues and views that this one was built with: types of another version of it do not
/// fit.
pub use wgpu;
