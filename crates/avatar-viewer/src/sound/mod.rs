//! The machine's sound: what its speakers play, and what its microphone hears.
//!
//! Built with the feature `sound`; without it both are refused with what would give them.

#[cfg(feature = "sound")]
mod device;
#[cfg(not(feature = "sound"))]
mod without;

#[cfg(feature = "sound")]
pub(crate) use device::{Microphone, Speaker};
#[cfg(not(feature = "sound"))]
pub(crate) use without::{Microphone, Speaker};

/// Why this program plays and hears nothing at all, as a sentence.
pub(crate) const MISSING: Option<&str> = match cfg!(feature = "sound") {
    true => None,
    false => Some(
        "This program was built without sound: build it with --features sound (on Linux that needs ALSA's headers, libasound2-dev).",
    ),
};
