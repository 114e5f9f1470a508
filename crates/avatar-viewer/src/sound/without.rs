//! What there is instead of sound in a program that was built without it.

use super::MISSING;
use anyhow::{Result, bail};
use std::convert::Infallible;

/// Speakers that play a sound.
pub(crate) struct Speaker(Infallible);

/// A microphone that hears.
pub(crate) struct Microphone(Infallible);

fn refused<T>() -> Result<T> {
    bail!("{}", MISSING.unwrap_or_default())
}

impl Speaker {
    pub(crate) fn rate_hz() -> Result<u32> {
        refused()
    }

    pub(crate) fn play(
        _: std::sync::Arc<[f32]>,
        _: u32,
        _: f64,
        _: impl FnMut(String) + Send + 'static,
    ) -> Result<Self> {
        refused()
    }

    pub(crate) fn secs(&self) -> Option<f64> {
        match self.0 {}
    }
}

impl Microphone {
    pub(crate) fn open(_: impl FnMut(String) + Send + 'static) -> Result<Self> {
        refused()
    }

    pub(crate) fn rate_hz(&self) -> u32 {
        match self.0 {}
    }

    pub(crate) fn take(&self, _: &mut Vec<f32>) {
        match self.0 {}
    }
}
