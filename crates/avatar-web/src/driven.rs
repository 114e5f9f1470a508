//! A face that somebody else drives.

use crate::WebError;
use avatar_live::{CHANNELS, ControlMap, Frame};
use pose_anim::ControlTable;

/// The way from a tracker's channels to the controls of an avatar.
#[derive(Clone, Debug)]
pub(crate) struct Driven {
    map: ControlMap,
    values: Vec<f32>,
}

impl Driven {
    pub(crate) fn new(controls: &ControlTable) -> Self {
        Self { map: ControlMap::new(controls), values: controls.defaults() }
    }

    /// Values of all controls of a face that was at `now`, for one value per channel; what is no number is
    /// not known.
    ///
    /// # Errors
    /// Another number of channels.
    pub(crate) fn follow(&mut self, channels: &[f32], now: &[f32]) -> Result<&[f32], WebError> {
        if channels.len() != CHANNELS {
            let found = channels.len();
            return Err(WebError::Count { what: "values of channels", expected: CHANNELS, found });
        }
        let mut frame = Frame::at(None);
        for (channel, value) in channels.iter().enumerate().filter(|(_, value)| value.is_finite()) {
            frame.set(channel, *value);
        }
        self.values.clear();
        self.values.extend_from_slice(now);
        self.map.apply(&frame, &mut self.values);
        Ok(&self.values)
    }
}
