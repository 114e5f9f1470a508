use crate::channel::{ALL_CHANNELS_MASK, CHANNELS, channels, find};

/// What a sender knows of a face at one moment: a number for some of the channels, or for all.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    values: [f32; CHANNELS],
    /// A bit for each channel that has a value.
    has: u128,
    /// When it was, in seconds of the sender's clock, if the sender says so.
    pub time_secs: Option<f64>,
    /// Whether there was a face to be seen.
    pub is_tracked: bool,
}

impl Default for Frame {
    /// A frame without any value.
    fn default() -> Self {
        Self { values: [0.0; CHANNELS], has: 0, time_secs: None, is_tracked: true }
    }
}

impl Frame {
    /// A frame without any value, of a time of the sender's clock in seconds.
    pub fn at(time_secs: Option<f64>) -> Self {
        Self { time_secs, ..Self::default() }
    }

    /// The value of a channel, the number of which is its place in [`channels`]; `None` if the sender says
    /// nothing of it.
    pub fn get(&self, channel: usize) -> Option<f32> {
        (channel < CHANNELS && self.has >> channel & 1 == 1).then(|| self.values.get(channel).copied())?
    }

    /// The value of the channel of this name.
    pub fn named(&self, name: &str) -> Option<f32> {
        self.get(find(name.as_bytes())?)
    }

    /// Gives a channel a value, kept within its range. Nothing happens for a channel that does not exist and
    /// for what is no number.
    pub fn set(&mut self, channel: usize, value: f32) {
        let (Some(slot), Some(range)) = (self.values.get_mut(channel), channels().get(channel)) else {
            return;
        };
        if !value.is_nan() {
            *slot = value.clamp(range.min, range.max);
            self.has |= 1 << channel;
        }
    }

    /// Gives the channel of this name a value; whether there is one.
    pub fn set_named(&mut self, name: &str, value: f32) -> bool {
        let channel = find(name.as_bytes());
        if let Some(channel) = channel {
            self.set(channel, value);
        }
        channel.is_some()
    }

    /// The channels that have a value, with it.
    pub fn iter(&self) -> impl Iterator<Item = (usize, f32)> + '_ {
        (0..CHANNELS).filter_map(|channel| Some((channel, self.get(channel)?)))
    }

    /// Whether no channel has a value.
    pub fn is_empty(&self) -> bool {
        self.has & ALL_CHANNELS_MASK == 0
    }

    /// The numbers of all channels, 0 for those without a value.
    pub fn values(&self) -> &[f32; CHANNELS] {
        &self.values
    }
}
