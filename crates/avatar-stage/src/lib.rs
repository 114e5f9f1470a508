//! From a pack to a moving face in your own wgpu program.
//!
//! ```text
//!  Pack, Textures ──upload──▶ AvatarModel ────────────────────┐
//!  Pack ──Performer──▶ press, play, speak, …; advance(dt)     ├──▶ Renderer::draw ──▶ your texture view
//!                      └──▶ bones, weights ──▶ AvatarState ───┤
//!  Pack ──portrait, View::scene──▶ Scene ─────────────────────┘
//! ```
//!
//! The crates below do the work: [`avatar_pack`] reads faces, [`pose_anim`] moves them, [`avatar_render`]
//! draws them. This one holds what every program that shows a face needs between them, so that nobody writes
//! it twice. It opens no window and no file, and has neither clock nor threads.
//!
//! # Example
//!
//! ```no_run
//! use avatar_stage::avatar_pack::{MemorySource, Pack, Textures};
//! use avatar_stage::avatar_render::AvatarState;
//! use avatar_stage::avatar_render::headless::{GpuOptions, open_blocking, render_image};
//! use avatar_stage::{Performer, SAMPLES, portrait, upload};
//!
//! let source = MemorySource::default(); // the pack's files: names and bytes
//! let (pack, textures) = (Pack::load(&source)?, Textures::load(&source));
//! let gpu = open_blocking(GpuOptions::default())?;
//! let model = upload(&gpu.device, &gpu.queue, &pack, &textures)?;
//! let mut avatar = AvatarState::new(&gpu.device, &model);
//! let mut face = Performer::new(pack);
//!
//! face.press("smile")?;
//! face.advance(0.2)?; // seconds: the smile is on its way
//! avatar.set(&gpu.queue, face.bones(), face.weights())?;
//! let picture = render_image(&gpu, 512, 512, SAMPLES, &portrait(face.pack(), 1.0), &[(&model, &avatar)])?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Where drawing takes long, [`Drafts`] draw what moves with as much care as [`Pace`] finds time for.
//!
//! [`Screen`] draws on the surface of any window; `examples/window.rs` does the same with the program's own
//! device.

mod upload;
mod view;
mod performer;
mod pace;
mod drafts;
mod screen;
#[cfg(feature = "default-face")]
mod default_face;

/// The crate that knows what faces do by themselves.
pub use avatar_life;
/// The crate that reads packs.
pub use avatar_pack;
/// The crate that draws, with [`wgpu`] and [`glam`] as it was built
/// with them.
pub use avatar_render;
pub use avatar_render::{glam, wgpu};
/// The crate that knows what faces do while they speak.
pub use avatar_speech;
#[cfg(feature = "default-face")]
pub use default_face::DefaultFace;
pub use drafts::{DraftError, Drafts};
pub use pace::{Pace, Step};
pub use performer::{Attention, Performer, PerformerError, Words};
/// The crate that moves controls.
pub use pose_anim;
pub use screen::{Screen, ScreenError};
pub use upload::{UploadError, set_colors, set_groom, set_hair, set_materials, upload, upload_with_hair};
pub use view::{BACKGROUND, Framing, NamedView, SAMPLES, View, portrait};
