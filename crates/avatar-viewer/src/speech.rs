//! A face that speaks by a file of sounds, a recording, or a text.

use crate::espeak;
use crate::reading;
use crate::speech_args::SpeechArgs;
use crate::standard;
use anyhow::{Context, Result, anyhow, bail};
use avatar_hearing::resample::RATES;
use avatar_hearing::{Frame, Hearing};
use avatar_pack::Pack;
use avatar_sound::{Limits, Sound};
use avatar_speech::{Amounts, HeardSpeech, Means, Phones, Speech, SpeechMap, Timeline, VISEMES};
use avatar_stage::Words;
use std::fmt::Display;
use std::path::Path;

/// What sounds are brought to that are not heard as they are.
const USUAL_HZ: u32 = 48_000;

/// Something to say.
#[derive(Debug)]
pub(crate) struct Line {
    /// What the mouth follows.
    pub(crate) words: Words,
    /// What is heard of it, if that is known.
    pub(crate) sound: Option<Sound>,
    /// What was passed over, in lines for people.
    pub(crate) notes: Vec<String>,
}

impl Line {
    /// Sounds that somebody has written down, and a recording of them.
    pub(crate) fn of_labels(labels: &Path, audio: Option<&Path>) -> Result<Self> {
        let timeline = timeline(labels)?;
        let mut notes: Vec<_> =
            notes(&timeline).map(|note| format!("{}: {note}", labels.display())).collect();
        let sound = audio.map(|audio| recording(audio, &mut notes)).transpose()?;
        let speech = Speech::new(&timeline);
        let speech = match &sound {
            Some(sound) => speech.with_loudness(heard(sound)?.loudness()),
            None => speech,
        };
        Ok(Self { words: speech.into(), sound, notes })
    }

    /// Sounds that are heard in a recording.
    pub(crate) fn of_recording(path: &Path) -> Result<Self> {
        let mut notes = Vec::new();
        let sound = recording(path, &mut notes)?;
        let heard = heard(&sound).with_context(|| path.display().to_string())?;
        Ok(Self { words: heard.into(), sound: Some(sound), notes })
    }

    /// A text as espeak-ng says it. It does not tell when: its phones are found in its own sound.
    pub(crate) fn of_text(text: &str, voice: Option<&str>) -> Result<Self> {
        let said = espeak::say(text, voice)?;
        let mut notes = Vec::new();
        let sound = decode(&said.wav, &"espeak-ng", &mut notes)?;
        let (phones, passed_over) = Phones::read(&said.phones);
        notes.extend(passed_over.into_iter().map(|note| format!("espeak-ng's phones: {note}")));
        let (frames, first_secs) = hear(&sound)?;
        let weights: Vec<_> = frames.iter().map(|(weights, _)| *weights).collect();
        let timeline = phones.align(&weights, first_secs);
        let loudness = HeardSpeech::new(frames, first_secs).loudness();
        let words = Speech::new(&timeline).with_loudness(loudness).into();
        Ok(Self { words, sound: Some(sound), notes })
    }

    /// When the mouth is at rest again, and the sound at its end.
    pub(crate) fn rest_secs(&self) -> f64 {
        let rest = self.words.rest_secs();
        self.sound.as_ref().map_or(rest, |sound| rest.max(sound.secs()))
    }
}

/// Something to say, and how this avatar shows it.
#[derive(Debug)]
pub(crate) struct Spoken {
    line: Line,
    map: SpeechMap,
}

impl Spoken {
    /// What the command line asks for, if that is anything. Warns of what was passed over, and of a face that
    /// cannot speak.
    pub(crate) fn read(args: &SpeechArgs, pack: &Pack) -> Result<Option<Self>> {
        let line = match (&args.say, &args.visemes, &args.audio) {
            (Some(_), ..) => {
                let say = || Line::of_text(&args.text()?, args.voice.as_deref());
                say().context("--say")?
            }
            (None, Some(labels), audio) => Line::of_labels(labels, audio.as_deref())?,
            (None, None, Some(audio)) => Line::of_recording(audio)?,
            (None, None, None) => return Ok(None),
        };
        line.notes.iter().for_each(standard::warn);
        let spoken = Self::new(line, pack);
        if spoken.map.means() == Means::Nothing {
            standard::warn("the avatar has no jaw and no shapes of a mouth: it does not speak");
        }
        Ok(Some(spoken))
    }

    /// A line in the mouth of this avatar.
    pub(crate) fn new(line: Line, pack: &Pack) -> Self {
        Self { line, map: SpeechMap::new(pack.controls()) }
    }

    /// Lays the mouth at a time over the values of a face.
    pub(crate) fn say(&self, secs: f64, values: &mut [f32]) {
        self.map.apply(&self.line.words.at(secs), Amounts::default(), values);
    }

    /// When the mouth is at rest again, and the sound at its end.
    pub(crate) fn rest_secs(&self) -> f64 {
        self.line.rest_secs()
    }

    /// What is heard of it.
    pub(crate) fn take_sound(&mut self) -> Option<Sound> {
        self.line.sound.take()
    }

    /// Whether speech moves a control, or holds it back.
    pub(crate) fn concerns(&self, control: usize) -> bool {
        self.map.controls().any(|other| other == control)
    }
}

/// Reads a timeline of sounds.
fn timeline(path: &Path) -> Result<Timeline> {
    let bytes = match reading::text_bytes(path) {
        Ok(bytes) => bytes,
        Err(error) => bail!("{}: {error}", path.display()),
    };
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    Timeline::from_bytes(&name, &bytes).map_err(|error| anyhow!("{}: {error}", path.display()))
}

/// What was passed over in a timeline, a line for each.
fn notes(timeline: &Timeline) -> impl Iterator<Item = String> {
    let more = timeline.further_notes();
    let more = (more > 0).then(|| format!("{more} more like these"));
    timeline.notes().iter().map(ToString::to_string).chain(more)
}

/// Reads a recording.
fn recording(path: &Path, notes: &mut Vec<String>) -> Result<Sound> {
    let bytes = match reading::file(path) {
        Ok(bytes) => bytes,
        Err(error) => bail!("{}: {error}", path.display()),
    };
    decode(&bytes, &path.display(), notes)
}

fn decode(bytes: &[u8], place: &dyn Display, notes: &mut Vec<String>) -> Result<Sound> {
    let (sound, passed_over) =
        avatar_sound::decode(bytes, &Limits::default()).map_err(|error| anyhow!("{place}: {error}"))?;
    notes.extend(passed_over.iter().map(|note| format!("{place}: {note}")));
    Ok(sound)
}

/// Weights of visemes and loudness, a hundred times a second.
type Frames = Vec<([f32; VISEMES], f32)>;

/// What is heard in a sound, and the time of the first frame in seconds.
fn hear(sound: &Sound) -> Result<(Frames, f64)> {
    let other;
    let sound = match RATES.contains(&sound.rate_hz) {
        true => sound,
        false => {
            other = sound.resampled(USUAL_HZ)?;
            &other
        }
    };
    let mut hearing = Hearing::new(sound.rate_hz)?;
    let (mut frames, mut first_secs) = (Vec::new(), None);
    let mut take = |frame: &Frame| {
        first_secs.get_or_insert(frame.time_secs);
        frames.push((frame.weights, frame.loudness));
    };
    hearing.push(&sound.mono(), &mut take);
    hearing.finish(&mut take);
    Ok((frames, first_secs.unwrap_or_default()))
}

fn heard(sound: &Sound) -> Result<HeardSpeech> {
    let (frames, first_secs) = hear(sound)?;
    Ok(HeardSpeech::new(frames, first_secs))
}
