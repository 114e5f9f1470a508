//! Visemes from the sound of a voice alone, in any language, while it is being spoken.
//!
//! Samples of any rate go in; a hundred times a second of sound, a [`Frame`] comes out: how much of each of
//! the fifteen visemes ([`VISEMES`], in the order of Oculus Lipsync) is heard, and how loud. A frame is told
//! [`DELAY_SECS`] after its own time, since the model hears a little of what follows. In silence the mouth is
//! shut: `sil`.
//!
//! ```
//! use avatar_hearing::{Hearing, VISEMES};
//!
//! let mut hearing = Hearing::new(48_000)?;
//! // A second of silence.
//! let samples = vec![0.0; 48_000];
//! let mut frames = 0;
//! hearing.push(&samples, |frame| {
//!     frames += 1;
//!     assert_eq!(VISEMES[frame.strongest()], "sil");
//! });
//! assert!(frames > 90);
//! # Ok::<(), avatar_hearing::HearingError>(())
//! ```
//!
//! Samples are from -1 to 1; others are cut off, and what is no number is taken for 0. Nothing allocates
//! after [`Hearing::new`], and results are the same however the samples are cut into pieces.
//!
//! Modules: [`resample`] brings any rate to 16 kHz, [`features`] makes spectra of it, [`model`] names what
//! they sound like, [`hearing`] puts the three together.

pub mod resample;

pub mod features;

pub mod model;

pub mod hearing;

pub use hearing::{DELAY_SECS, Frame, Hearing, HearingError, VISEMES};
