//! Films of frames that are pushed one by one, and pictures with text in them.
//!
//! ```text
//!  frame 0, 1, 2 … (RGBA8) ──push──▶ Film ──▶ sink: GIF, animated PNG or MP4
//! ```
//!
//! # Conventions
//!
//! - A frame is `width · height` pixels of four bytes, rows from top to bottom: red, green, blue in sRGB and
//!   straight alpha.
//! - Frame k is shown from `k / rate` on ([`Rate`] is a fraction, so nothing drifts), and a film of n frames
//!   lasts `n / rate`.
//! - A film can have a sound ([`Soundtrack`]) where its format keeps one: MP4 does. It is heard from the
//!   first frame on.
//! - The same frames and the same sound give the same bytes.
//!
//! # Example
//!
//! ```
//! use avatar_film::{Film, Format, Rate};
//! use std::io::Cursor;
//!
//! let format = Format::of_name("blink.gif").ok_or("no format of a film")?;
//! let mut film = Film::new(format, Cursor::new(Vec::new()), 2, 1, Rate::new(25, 1)?)?;
//! film.push(&[255, 0, 0, 255, 0, 0, 255, 255])?;
//! film.push(&[0, 0, 255, 255, 255, 0, 0, 255])?;
//! assert!(film.finish()?.into_inner().starts_with(b"GIF89a"));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! What each format keeps of a frame, and what it costs, is told in `docs/films.md`. This crate knows no
//! files, no clock and no threads.

mod rate;
mod format;
mod error;
mod soundtrack;
mod changed;
mod palette;
mod gif_film;
mod picture;
mod apng;
#[cfg(feature = "mp4")]
mod yuv;
#[cfg(feature = "mp4")]
mod mp4_sound;
#[cfg(feature = "mp4")]
mod mp4_film;
mod film;

pub use error::FilmError;
pub use film::Film;
pub use format::Format;
pub use picture::{frame_name, png};
pub use rate::{Rate, RateError};
pub use soundtrack::Soundtrack;
