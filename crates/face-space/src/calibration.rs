//! What a tracker says of one person's face, made that of any face: `face.toml`.

use crate::space::Space;
use placed_toml::{Document, TomlError, string};
use std::sync::Arc;

/// The largest gain that a file may ask for.
const MOST_GAIN: f32 = 10.0;

/// What a tracker says while a person's face is at rest, and how much stronger the avatar shall move.
///
/// ```toml
/// [neutral]                # what the tracker says of the person's face at rest
/// jawOpen = 0.06
/// browInnerUp = 0.12
///
/// [gain]                   # factors for what is beyond that
/// mouthSmileLeft = 1.3
/// ```
///
/// A value becomes `rest + gain × (value − neutral)`. What lies between the neutral value and the end of the
/// range is stretched so that the end stays the end: a smile of 1 is 1 with any neutral value.
#[derive(Clone, Debug, PartialEq)]
pub struct Calibration {
    space: Arc<Space>,
    neutral: Vec<f32>,
    gain: Vec<f32>,
}

impl Calibration {
    /// One that changes nothing.
    pub fn new(space: Arc<Space>) -> Self {
        Self { neutral: space.rest(), gain: vec![1.0; space.len()], space }
    }

    /// Reads a `face.toml`. Names are those of the space, in any spelling.
    ///
    /// # Errors
    /// A name that the space does not have, a neutral value outside its range, a gain outside 0 to 10.
    pub fn from_toml(space: Arc<Space>, text: &str) -> Result<Self, TomlError> {
        let mut new = Self::new(space);
        let document = Document::parse(text)?;
        let mut root = document.root();
        for (key, values) in [("neutral", &mut new.neutral), ("gain", &mut new.gain)] {
            let Some(entry) = root.take(key) else { continue };
            for entry in entry.table()?.rest() {
                let names = || new.space.names().iter().map(|name| name.name.as_str());
                let place = new.space.find(entry.name());
                let place =
                    place.ok_or_else(|| entry.unknown_name(entry.name(), "one of the names", names()))?;
                let range = match new.space.names().get(place) {
                    Some(name) if key == "neutral" => name.min..=name.max,
                    _ => 0.0..=MOST_GAIN,
                };
                let expected = format!("a number from {} to {}", range.start(), range.end());
                let value = entry.number_within(range, &expected)?;
                values.get_mut(place).into_iter().for_each(|slot| *slot = value);
            }
        }
        root.finish(&["neutral", "gain"])?;
        Ok(new)
    }

    /// As a `face.toml` with what differs from [`Self::new`]; read again, it is the same.
    pub fn to_toml(&self) -> String {
        let mut text = String::new();
        let rest = self.space.rest();
        let ones = vec![1.0; rest.len()];
        for (key, values, usual) in [("neutral", &self.neutral, rest), ("gain", &self.gain, ones)] {
            text += &format!("{}[{key}]\n", if text.is_empty() { "" } else { "\n" });
            for ((name, value), usual) in self.space.names().iter().zip(values).zip(usual) {
                if *value != usual {
                    text += &format!("{} = {value:?}\n", string(&name.name));
                }
            }
        }
        text
    }

    /// The space of its values.
    pub fn space(&self) -> &Arc<Space> {
        &self.space
    }

    /// Takes these values for those of the face at rest: those of a moment at which the person does nothing,
    /// or means of many. Gains stay.
    pub fn set_neutral(&mut self, values: &[f32]) {
        for ((slot, name), value) in self.neutral.iter_mut().zip(self.space.names()).zip(values) {
            *slot = name.clean(*value);
        }
    }

    /// What the tracker says of the face at rest.
    pub fn neutral(&self) -> &[f32] {
        &self.neutral
    }

    /// The factors.
    pub fn gain(&self) -> &[f32] {
        &self.gain
    }

    /// Sets one factor, kept within 0 to 10.
    pub fn set_gain(&mut self, place: usize, gain: f32) {
        if let Some(slot) = self.gain.get_mut(place).filter(|_| !gain.is_nan()) {
            *slot = gain.clamp(0.0, MOST_GAIN);
        }
    }

    /// Changes a tracker's values in place. Allocates nothing.
    pub fn apply(&self, values: &mut [f32]) {
        let settings = self.neutral.iter().zip(&self.gain).zip(self.space.names());
        for (value, ((neutral, gain), name)) in values.iter_mut().zip(settings) {
            let beyond = name.clean(*value) - neutral;
            let (end, own) = if beyond >= 0.0 {
                (name.max - name.rest, name.max - neutral)
            } else {
                (name.rest - name.min, neutral - name.min)
            };
            // Below the neutral value there may be nothing to show: a mouth cannot be less than closed.
            let stretch = if own > 0.0 { end / own } else { 0.0 };
            *value = name.clean(name.rest + gain * beyond * stretch);
        }
    }
}
