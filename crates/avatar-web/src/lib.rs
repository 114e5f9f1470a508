//! A face on a web page: what its scripts call, and what is drawn on a canvas by WebGPU.
//!
//! ```text
//!  bytes, name ──Avatar::read──▶ Avatar ──▶ Stage ──▶ Show ──▶ canvas, pictures
//!  poses, sliders, sounds, trackers ───────▶ │  ▲         (WebGPU, or any adapter)
//!  a link ◀── Stage::link ─────── Stage::follow ┘
//! ```
//!
//! What a page does is told in texts and numbers: names of poses, controls and looks go in, JSON and links
//! come out. All of that is in [`Stage`], which knows no browser and is tested without one. [`Show`] is what
//! it is drawn with. The layer that scripts call is compiled for `wasm32` only, and holds nothing but
//! conversions; `web/mimik.js` makes of it what a page uses.
//!
//! The crate reads no clock and starts no threads: a page tells how much time has passed.

mod error;
#[cfg(feature = "zip")]
mod archive;
mod avatar;
mod look;
mod person;
mod voice;
#[cfg(feature = "live")]
mod driven;
mod stage;
mod link;
mod info;
mod show;
#[cfg(target_arch = "wasm32")]
mod web;

#[cfg(feature = "zip")]
pub use archive::Archive;
pub use avatar::Avatar;
pub use error::WebError;
pub use look::Look;
pub use show::{Picture, Shot, Show};
pub use stage::Stage;
