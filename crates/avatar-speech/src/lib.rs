//! What a face does while it speaks.
//!
//! ```text
//!  text of Rhubarb, Praat … ──▶ Timeline ──▶ Speech ──at(secs)──▶ Mouth ──SpeechMap──▶ values of controls
//!      phones of a text ──Phones──┘                               │  └──▶ weights of Oculus, ARKit
//!  weights of visemes, from a voice ──HeardSpeech, LiveMouth──────┘
//! ```
//!
//! - A [`Timeline`] is a list of sounds with their times, read from any of the [`Format`]s that other
//!   programs write. Mistakes are told with line and column; phones that are not known become notes.
//! - A [`Speech`] is a timeline with coarticulation: sounds insist on jaw, lips and tongue more or less, and
//!   these move at times of their own. For p, b and m the lips close whatever the rate, for f and v the
//!   lower lip goes up to the edge of the upper teeth.
//! - A [`Mouth`] is plain numbers. A [`SpeechMap`] lays them over the values of a face, so that a smile is
//!   kept while speaking, and lips close all the same.
//!
//! # Conventions
//!
//! Times are seconds. Weights are 0 to 1. Everything is a function of the time alone: the same at any frame
//! rate, C², and within the ranges of controls. The crate has no clock, no files and no threads, and
//! allocates nothing once a [`Speech`] is made.
//!
//! # Example
//!
//! ```
//! use avatar_speech::{Amounts, Means, Speech, SpeechMap, Timeline};
//! use pose_anim::ControlTable;
//!
//! // A word with the times of its phones, as Festival writes it.
//! let labels = "#\n0.10 100 pau\n0.17 100 hh\n0.24 100 ax\n0.31 100 l\n0.52 100 ow\n0.80 100 pau\n";
//! let speech = Speech::new(&Timeline::read(labels, None)?);
//! let controls = ControlTable::default_face();
//! let map = SpeechMap::new(&controls);
//! // The nine joints have a jaw only; a face with ARKit's shapes uses lips and tongue as well.
//! assert_eq!(map.means(), Means::Jaw);
//!
//! let mut values = controls.defaults();
//! map.apply(&speech.at(0.38), Amounts::default(), &mut values);
//! let jaw = controls.index("jaw.open").ok_or("no jaw")?;
//! assert!(values[jaw] > 4.0);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod viseme;
mod error;
mod timeline;
mod phone;
mod read;
mod params;
mod amounts;
mod ease;
mod mouth;
mod loudness;
mod grips;
mod speech;
mod heard;
mod align;
mod face;

pub use align::Phones;
pub use amounts::Amounts;
pub use error::{Note, SpeechError};
pub use face::{Means, SpeechMap};
pub use heard::{HeardSpeech, LiveMouth, speaks};
pub use loudness::Loudness;
pub use mouth::{Articulator, Mouth};
pub use params::UTTERANCE_PAUSE_SECS;
pub use phone::Alphabet;
pub use read::Format;
pub use speech::Speech;
pub use timeline::{Cue, Timeline};
pub use viseme::{VISEMES, Viseme};
