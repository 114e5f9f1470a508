//! What is spoken in the window: a recording, sounds with their times, or a text.

use crate::sound::Speaker;
use crate::speech::Line;
use anyhow::Result;
use avatar_sound::Sound;
use avatar_speech::Format;
use avatar_stage::Words;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// How names of files end that hold sound.
const SOUNDS: [&str; 5] = ["wav", "flac", "ogg", "oga", "mp3"];
/// So much of a text is its name.
const NAME_LETTERS: usize = 40;

/// Where something to say comes from.
#[derive(Clone, Debug)]
pub(in crate::window) enum Source {
    File(PathBuf),
    Text { text: String, voice: Option<String> },
}

impl Source {
    /// For people.
    pub(super) fn name(&self) -> String {
        match self {
            Self::File(path) => name_of(path),
            Self::Text { text, .. } => {
                let mut words = text.split_whitespace().collect::<Vec<_>>().join(" ");
                if let Some((end, _)) = words.char_indices().nth(NAME_LETTERS) {
                    words.truncate(end);
                    words.push('…');
                }
                format!("“{words}”")
            }
        }
    }

    /// The beginning of a film's name.
    fn stem(&self) -> String {
        match self {
            Self::File(path) => path.file_stem().unwrap_or_default().to_string_lossy().into_owned(),
            Self::Text { .. } => "speech".to_owned(),
        }
    }

    fn read(&self) -> Result<Line> {
        match self {
            Self::Text { text, voice } => Line::of_text(text, voice.as_deref()),
            Self::File(path) if is_sound(path) => Line::of_recording(path),
            Self::File(path) => {
                let beside = SOUNDS.iter().map(|ending| path.with_extension(ending));
                Line::of_labels(path, beside.into_iter().find(|path| path.is_file()).as_deref())
            }
        }
    }
}

/// Something that the face can say, again and again.
pub(in crate::window) struct Script {
    /// For people.
    pub(super) name: String,
    /// The beginning of a film's name.
    pub(super) stem: String,
    pub(super) words: Words,
    /// What is heard with it, if there is anything.
    pub(super) sound: Option<Arc<Sound>>,
    /// The same as the speakers want it, as far as they were asked.
    played: Option<Samples>,
    /// What was passed over.
    pub(super) notes: Vec<String>,
}

/// One channel at the rate of a device.
#[derive(Clone)]
struct Samples {
    rate_hz: u32,
    samples: Arc<[f32]>,
}

impl Script {
    /// How names of files end that are offered to be spoken by.
    pub(in crate::window) fn endings() -> Vec<&'static str> {
        let labels = Format::ENDINGS.iter().map(|(ending, _)| *ending).chain(["json"]);
        SOUNDS.into_iter().chain(labels).collect()
    }

    /// Whether a file is one to speak by, as far as its name tells.
    pub(in crate::window) fn is_for(path: &Path) -> bool {
        let name = name_of(path);
        let is_pack = avatar_pack::files::RIG_NAMES.contains(&&*name);
        let ends_in_json = name.to_ascii_lowercase().ends_with(".json");
        let is_text = ends_in_json || Format::of_name(&name).is_some();
        !is_pack && !path.is_dir() && (is_text || is_sound(path))
    }

    /// Reads, listens, or has a text read aloud: takes its time.
    pub(super) fn read(source: &Source) -> Result<Self> {
        let Line { words, sound, notes } = source.read()?;
        let (name, stem) = (source.name(), source.stem());
        let mut script = Self { name, stem, words, sound: sound.map(Arc::new), played: None, notes };
        // Without a device there is time enough to tell so when it is to be heard.
        if let Ok(rate_hz) = Speaker::rate_hz() {
            let _ = script.samples(rate_hz);
        }
        Ok(script)
    }

    /// Its sound in one channel at this rate, if it has any.
    pub(super) fn samples(&mut self, rate_hz: u32) -> Result<Option<Arc<[f32]>>> {
        let Some(sound) = &self.sound else { return Ok(None) };
        if let Some(played) = self.played.as_ref().filter(|played| played.rate_hz == rate_hz) {
            return Ok(Some(Arc::clone(&played.samples)));
        }
        let mono = Sound { rate_hz: sound.rate_hz, channels: 1, samples: sound.mono().into_owned() };
        let samples: Arc<[f32]> = mono.resampled(rate_hz)?.samples.into();
        self.played = Some(Samples { rate_hz, samples: Arc::clone(&samples) });
        Ok(Some(samples))
    }

    /// When all is said and heard, in seconds from the beginning.
    pub(super) fn end_secs(&self) -> f64 {
        let words = self.words.end_secs();
        self.sound.as_ref().map_or(words, |sound| words.max(sound.secs()))
    }

    /// The same as something to be filmed.
    pub(super) fn line(&self) -> Line {
        let sound = self.sound.as_deref().cloned();
        Line { words: self.words.clone(), sound, notes: Vec::new() }
    }
}

fn is_sound(path: &Path) -> bool {
    let ending = path.extension().and_then(|ending| ending.to_str()).unwrap_or_default();
    SOUNDS.iter().any(|sound| sound.eq_ignore_ascii_case(ending))
}

fn name_of(path: &Path) -> String {
    path.file_name().unwrap_or_default().to_string_lossy().into_owned()
}

#[cfg(test)]
mod tests {
    use super::{Script, Source};
    use std::path::{Path, PathBuf};

    #[test]
    fn recordings_and_labels_are_spoken_and_avatars_are_not() {
        for name in
            ["talk.WAV", "a/talk.mp3", "talk.ogg", "talk.flac", "talk.TextGrid", "marks.json", "a.srt"]
        {
            assert!(Script::is_for(Path::new(name)), "{name}");
        }
        for name in ["face.glb", "head.obj", "Transformations.xml", "picture.png", "folder"] {
            assert!(!Script::is_for(Path::new(name)), "{name}");
        }
        let endings = Script::endings();
        assert!(["wav", "mp3", "lab", "json"].iter().all(|ending| endings.contains(ending)), "{endings:?}");
    }

    #[test]
    fn a_text_is_named_by_its_beginning() {
        let text = |text: &str| Source::Text { text: text.to_owned(), voice: None }.name();
        assert_eq!(text(" Hello,\n you "), "“Hello, you”");
        assert_eq!(text(&"ä".repeat(50)), format!("“{}…”", "ä".repeat(40)));
        assert_eq!(Source::File(PathBuf::from("a/talk.wav")).name(), "talk.wav");
    }
}
