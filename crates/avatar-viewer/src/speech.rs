//! A face that speaks by a file of sounds.

use crate::reading;
use crate::standard;
use anyhow::{Result, anyhow, bail};
use avatar_pack::Pack;
use avatar_speech::{Amounts, Means, Speech, SpeechMap, Timeline};
use std::path::Path;

/// Speech, and how this avatar shows it.
#[derive(Debug)]
pub(crate) struct Spoken {
    speech: Speech,
    map: SpeechMap,
}

impl Spoken {
    /// Reads a timeline of sounds, and warns of what was passed over and of a face that cannot speak.
    pub(crate) fn read(path: &Path, pack: &Pack) -> Result<Self> {
        let bytes = match reading::text_bytes(path) {
            Ok(bytes) => bytes,
            Err(error) => bail!("{}: {error}", path.display()),
        };
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        let timeline = Timeline::from_bytes(&name, &bytes);
        let timeline = timeline.map_err(|error| anyhow!("{}: {error}", path.display()))?;
        for note in timeline.notes() {
            standard::warn(format_args!("{}: {note}", path.display()));
        }
        if timeline.further_notes() > 0 {
            standard::warn(format_args!("{}: {} more like these", path.display(), timeline.further_notes()));
        }
        let map = SpeechMap::new(pack.controls());
        if map.means() == Means::Nothing {
            standard::warn("the avatar has no jaw and no shapes of a mouth: it does not speak");
        }
        Ok(Self { speech: Speech::new(&timeline), map })
    }

    /// Lays the mouth at a time over the values of a face.
    pub(crate) fn say(&self, secs: f64, values: &mut [f32]) {
        self.map.apply(&self.speech.at(secs), Amounts::default(), values);
    }

    /// When the mouth is at rest again.
    pub(crate) fn rest_secs(&self) -> f64 {
        self.speech.rest_secs()
    }

    /// Whether speech moves a control, or holds it back.
    pub(crate) fn concerns(&self, control: usize) -> bool {
        self.map.controls().any(|other| other == control)
    }
}
