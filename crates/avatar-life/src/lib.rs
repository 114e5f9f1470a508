//! What a face does by itself: blinks, glances, breath and small motions.
//!
//! ```text
//!  ControlTable ──▶ Life ──advance(dt)──▶ events ──▶ channels ──apply──▶ values of the controls
//!  Style, seed ─────▲                                              ▲
//!  attend, think, set_role ─▲                    values of a pose ┘
//! ```
//!
//! A [`Life`] lies over whatever moves a face ([`pose_anim::Player`], [`pose_anim::Layers`], speech): it
//! takes values of controls and returns values of controls. It knows an avatar's controls by their names:
//! those of the nine-joint face ([`pose_anim::face`]), the shapes of ARKit, or the expressions of VRM.
//!
//! - **Blinks** come at human intervals, some in pairs, many with large gaze shifts; lids close faster than
//!   they open.
//! - **Gaze** jumps from one fixation to the next along the main sequence, between targets of attention and
//!   elsewhere; eyes meet at a point, follow what moves, and never quite rest. The head follows late and
//!   less, and the eyes turn back against it.
//! - **Breath, sway, brows and pupils** move slowly.
//!
//! The numbers of human behaviour, and the literature that they come from where there is some, are in
//! `src/parameters.rs`.
//!
//! Everything that happens has a time and random numbers of its own, which depend on the seed and on its
//! number only, and all motion is a formula of time since then: so a face does the same at every frame rate,
//! and its values are twice continuously differentiable. Angles are degrees, times seconds, and left and
//! right are the character's own.
//!
//! This crate knows no files, no clock, no threads and no GPU, and allocates nothing once a [`Life`] is made.

mod parameters;
mod chance;
mod curves;
mod anchor;
mod blink;
mod gaze;
mod body;
mod wiring;
mod life;

pub use gaze::{Saccade, TARGETS, Target};
pub use life::{Counts, Life, LifeError};
pub use parameters::{Amounts, Role, Style};
