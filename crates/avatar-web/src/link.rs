//! A face as a link: what differs from the avatar at rest, as the query of an address.

use crate::{Look, Stage, WebError};
use percent_encoding::{AsciiSet, NON_ALPHANUMERIC, percent_decode_str, utf8_percent_encode};
use std::borrow::Cow;
use std::fmt::Write;

/// Everything but what means nothing in a query, and reads better as it is.
const SPECIAL: &AsciiSet = &NON_ALPHANUMERIC.remove(b'-').remove(b'.').remove(b'_').remove(b',').remove(b':');

fn add(link: &mut String, key: &str, value: &str) {
    let separator = if link.is_empty() { "" } else { "&" };
    // Writing into a text does not fail.
    let _ = write!(link, "{separator}{key}={}", utf8_percent_encode(value, SPECIAL));
}

/// The keys of a link, and the texts of their values.
fn pairs(link: &str) -> impl Iterator<Item = (&str, Cow<'_, str>)> {
    let pairs = link.trim_start_matches(['?', '#']).split('&').filter(|pair| !pair.is_empty());
    pairs.map(|pair| {
        let (key, value) = pair.split_once('=').unwrap_or((pair, ""));
        (key, percent_decode_str(value).decode_utf8_lossy())
    })
}

impl Look {
    /// The look that a link tells; what of it is no look, or does not exist, is passed over.
    pub fn of_link(link: &str) -> Self {
        let mut look = Self::default();
        for (option, word) in pairs(link) {
            // Whoever follows the link is told.
            let _ = look.set(option, &word);
        }
        look
    }
}

impl Stage {
    /// The face as it will be when all motion has ended, as the query of an address: `smile=1&hair=bob`. Of
    /// controls only those that are not at rest, with all their digits, so that [`Stage::follow`] leads to
    /// the same numbers bit for bit. What is said, and which file it was, is not told.
    pub fn link(&self) -> String {
        let mut link = String::new();
        if !self.identity.is_empty() {
            add(&mut link, "identity", &self.identity);
        }
        for (option, word) in self.look.said() {
            add(&mut link, option, word);
        }
        if self.life() != "off" {
            add(&mut link, "life", self.life());
            add(&mut link, "seed", &self.seed.to_string());
        }
        let view = [self.view.yaw_degrees, self.view.pitch_degrees, self.view.distance];
        if view != [0.0, 0.0, 1.0] {
            add(&mut link, "view", &view.map(|number| number.to_string()).join(","));
        }
        let controls = self.pack().controls().controls();
        let mut set = String::new();
        for (control, target) in controls.iter().zip(self.performer.targets()) {
            if target.to_bits() != control.default.to_bits() {
                let separator = if set.is_empty() { "" } else { "," };
                let _ = write!(set, "{separator}{}:{target}", control.name);
            }
        }
        if !set.is_empty() {
            add(&mut link, "set", &set);
        }
        link
    }

    /// Puts the face at rest where a link says, from whatever it was. Returns what of it was not followed,
    /// since it does not exist here: a link may be of another avatar.
    ///
    /// # Errors
    /// Values that do not become a face.
    pub fn follow(&mut self, link: &str) -> Result<Vec<WebError>, WebError> {
        let mut passed_over = Vec::new();
        if !self.identity.is_empty() {
            self.become_person("")?;
        }
        self.look = Look::default();
        self.look_from_the_front();
        let mut values = self.pack().controls().defaults();
        let (mut life, mut seed) = ("off".to_owned(), 0);
        for (key, value) in pairs(link) {
            let done = match key {
                "identity" => self.become_person(&value),
                "life" => {
                    life = value.into_owned();
                    Ok(())
                }
                "seed" => value
                    .parse()
                    .map(|number| seed = number)
                    .map_err(|_| WebError::number("seed", "a whole number", &value)),
                "view" => self.go_to_view(&value),
                "set" => {
                    for setting in value.split(',') {
                        if let Err(error) = self.read_setting(setting, &mut values) {
                            passed_over.push(error);
                        }
                    }
                    Ok(())
                }
                _ => self.look.set(key, &value),
            };
            passed_over.extend(done.err());
        }
        self.jump_to(&values)?;
        passed_over.extend(self.live(&life, seed).err());
        Ok(passed_over)
    }

    fn go_to_view(&mut self, text: &str) -> Result<(), WebError> {
        let form = || WebError::number("view", "three numbers: yaw, pitch, distance", text);
        let numbers: Vec<f32> = text.split(',').map_while(|number| number.parse().ok()).collect();
        let [yaw, pitch, distance] = <[f32; 3]>::try_from(numbers).map_err(|_| form())?;
        self.look_from_the_front();
        self.orbit(yaw, pitch, distance);
        Ok(())
    }

    fn read_setting(&self, setting: &str, values: &mut [f32]) -> Result<(), WebError> {
        let form = || WebError::number("set", "CONTROL:VALUE", setting);
        let (name, value) = setting.rsplit_once(':').ok_or_else(form)?;
        let value: f32 = value.parse().ok().filter(|value: &f32| value.is_finite()).ok_or_else(form)?;
        let controls = self.pack().controls();
        let names: Vec<&str> = controls.controls().iter().map(|control| control.name.as_str()).collect();
        let index = controls.index(name).ok_or_else(|| WebError::word("set", name, names, ""))?;
        if let (Some(slot), Some(control)) = (values.get_mut(index), controls.controls().get(index)) {
            *slot = value.clamp(control.min, control.max);
        }
        Ok(())
    }
}
