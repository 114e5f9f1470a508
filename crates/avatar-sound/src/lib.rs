//! Sound files as samples, and samples as WAV.
//!
//! ```text
//!  WAV, FLAC, Ogg Vorbis, MP3 ──decode──▶ Sound ──mono, resampled──▶ whoever hears or plays it
//!                    └──SoundReader──▶ blocks   └──to_wav──▶ WAV
//! ```
//!
//! # Conventions
//!
//! Samples are numbers from -1 to 1; those of several channels follow each other moment by moment
//! (interleaved). A moment of all channels is a frame, and rates are frames a second. What a file has beyond
//! -1 to 1 is cut off, and what is no number is 0.
//!
//! # Example
//!
//! ```
//! use avatar_sound::{Limits, Sound, decode};
//!
//! let sound = Sound { rate_hz: 8_000, channels: 2, samples: vec![0.5, -0.5, 0.25, -0.25] };
//! let (read, notes) = decode(&sound.to_wav()?, &Limits::default())?;
//! assert_eq!((read, notes), (sound.clone(), Vec::new()));
//! assert_eq!(*sound.mono(), [0.0, 0.0]);
//! # Ok::<(), avatar_sound::SoundError>(())
//! ```
//!
//! The crate has no files, clock or threads.

mod error;
mod sound;
mod wav;
mod resample;
mod kind;
mod read;

pub use error::{Note, SoundError};
pub use read::{SoundReader, decode};
pub use sound::{Limits, Sound};
