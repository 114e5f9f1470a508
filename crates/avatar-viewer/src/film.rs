//! Films as files, for verbs and for the window.

use crate::cli::Size;
use crate::drafts::{DraftFile, DraftFolder};
use crate::ending;
use crate::face_args::FaceChoice;
use crate::offscreen::Offscreen;
use crate::output::{Contents, OutputFile, OutputFolder, is_nameless};
use crate::picture_file::no_alpha;
use crate::standard;
use crate::usage::usage;
use anyhow::{Context, Error, Result, anyhow, bail};
use avatar_film::{Film, FilmError, Format, Rate, Soundtrack};
use avatar_pack::Pack;
use avatar_sound::Sound;
use avatar_stage::View;
use image::RgbaImage;
use std::io::BufWriter;
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::thread::JoinHandle;

/// Frames that may wait for the encoder: it works while the next one is drawn, and memory stays bounded.
const WAITING: usize = 2;

/// The sound of a folder of pictures.
const SOUND_NAME: &str = "sound.wav";

/// More pictures of one name than these are not looked through.
const MOST_NAMES: u32 = 100_000;

/// A name in the folder that the program was started in that nothing has yet.
pub(crate) fn free_name(stem: &str, ending: &str) -> Result<PathBuf> {
    let stem = stem.replace(['/', '\\', ':'], "-");
    let dot = if ending.is_empty() { "" } else { "." };
    let mut names = (1..=MOST_NAMES).map(|count| PathBuf::from(format!("{stem}-{count}{dot}{ending}")));
    let free = names.find(|path| !path.exists());
    free.ok_or_else(|| anyhow!("expected a free name up to {stem}-{MOST_NAMES}, found none"))
}

/// Where a film goes: checked before the work.
#[derive(Debug)]
pub(crate) enum FilmTarget {
    File(OutputFile, Format),
    /// Numbered pictures.
    Folder(OutputFolder),
}

impl FilmTarget {
    /// The end of a name says the format; one without an end is a folder. What has no name has the format
    /// that was asked for, or is a GIF. `background` is sRGB with straight alpha.
    pub(crate) fn check(
        path: &Path,
        asked: Option<&str>,
        size: Size,
        rate: Rate,
        background: [u8; 4],
    ) -> Result<Self> {
        let is_folder =
            path.to_string_lossy().ends_with(std::path::is_separator) || path.extension().is_none();
        if is_folder && !is_nameless(path) && asked.is_none() {
            return Ok(Self::Folder(OutputFolder::check(path)?));
        }
        let endings = Format::ALL.iter().copied();
        let endings: Vec<_> = endings
            .flat_map(|format| format.extensions().iter().map(move |ending| (*ending, format)))
            .collect();
        let format =
            ending::format(path, asked, &endings, ", or that of a folder of pictures (without an end)")?;
        if background[3] < 255 && !format.keeps_alpha() {
            let others = endings.iter().filter(|(_, format)| format.keeps_alpha());
            let others = ending::listed(others.map(|(ending, _)| *ending));
            return Err(no_alpha(&format.to_string(), &format!("{others}, or a folder of pictures")));
        }
        format.check(size.width, size.height, rate).map_err(|error| usage(error.to_string()))?;
        Ok(Self::File(OutputFile::check(path, Contents::Binary("a film"))?, format))
    }
}

/// Frames to be drawn, one after the other.
pub(crate) struct Take<'a> {
    pub(crate) pack: &'a Pack,
    pub(crate) size: Size,
    /// sRGB with straight alpha.
    pub(crate) background: [u8; 4],
    pub(crate) rate: Rate,
    pub(crate) frames: u64,
}

impl Take<'_> {
    /// Draws every frame from what `at` says of its time, and calls `shot` with the number of those that are
    /// done.
    ///
    /// # Errors
    /// The first of either, of drawing or of encoding.
    pub(crate) fn shoot(
        &self,
        offscreen: &mut Offscreen,
        film: &mut FilmSink,
        mut at: impl FnMut(f64) -> Result<(FaceChoice, View)>,
        mut shot: impl FnMut(u64) -> Result<()>,
    ) -> Result<()> {
        let mut before = None;
        for frame in 0..self.frames {
            let secs = self.rate.time_secs(frame);
            let (face, view) = at(secs)?;
            let after_secs = before.replace(secs).map(|before| secs - before);
            film.push(offscreen.frame(self.pack, &face, view, self.size, self.background, after_secs)?)?;
            shot(frame + 1)?;
        }
        Ok(())
    }
}

/// Frames from the beginning to the first one that is not before this time.
pub(crate) fn through(rate: Rate, secs: f64) -> u64 {
    if secs > 0.0 { rate.frames_before(secs) + 1 } else { 1 }
}

/// What goes to the encoder.
enum Message {
    Frame(RgbaImage),
    /// All frames are there.
    End,
}

/// A film that is being written, by a thread of its own. Dropped without [`Self::finish`] it leaves nothing
/// behind.
pub(crate) struct FilmSink {
    messages: Option<SyncSender<Message>>,
    encoder: Option<JoinHandle<Result<()>>>,
}

impl FilmSink {
    /// Begins a film of `frames` frames, as far as that is known; names of numbered pictures depend on it,
    /// and how much of the sound there is.
    pub(crate) fn create(
        target: FilmTarget,
        size: Size,
        rate: Rate,
        frames: u64,
        sound: Option<Sound>,
    ) -> Result<Self> {
        let sound = sound.map(|sound| cut(sound, rate.time_secs(frames)));
        let (messages, received) = sync_channel(WAITING);
        // Made here, so that a folder that cannot be written to is reported before anything is drawn.
        let write: Box<dyn FnOnce() -> Result<()> + Send> = match target {
            FilmTarget::File(out, format) => {
                let draft = out.draft()?;
                let sound = sound.map(|sound| soundtrack(&sound, format)).transpose()?.flatten();
                Box::new(move || write_film(&received, &out, draft, (format, sound), size, rate))
            }
            FilmTarget::Folder(out) => {
                let draft = out.draft()?;
                if let Some(sound) = sound {
                    draft.write(SOUND_NAME, &sound.to_wav()?).with_context(|| out.expected())?;
                }
                Box::new(move || write_folder(&received, &out, draft, frames))
            }
        };
        let encoder = std::thread::Builder::new().name("film".to_owned()).spawn(write);
        let encoder = encoder.context("a thread that encodes")?;
        Ok(Self { messages: Some(messages), encoder: Some(encoder) })
    }

    /// Shows this frame next. Waits where the encoder is behind.
    pub(crate) fn push(&mut self, frame: RgbaImage) -> Result<()> {
        self.send(Message::Frame(frame))
    }

    /// Waits for the encoder, and puts the film in its place.
    pub(crate) fn finish(mut self) -> Result<()> {
        self.send(Message::End)?;
        self.join()
    }

    fn send(&mut self, message: Message) -> Result<()> {
        match self.messages.as_ref().map(|messages| messages.send(message)) {
            Some(Ok(())) => Ok(()),
            // The encoder has gone: it says why.
            _ => self.join().and_then(|()| bail!("expected a film that goes on, found one that has ended")),
        }
    }

    fn join(&mut self) -> Result<()> {
        self.messages = None;
        match self.encoder.take().map(JoinHandle::join) {
            Some(Ok(result)) => result,
            Some(Err(_)) => bail!("the encoder has stopped"),
            None => Ok(()),
        }
    }
}

impl Drop for FilmSink {
    fn drop(&mut self) {
        // What is half written is removed by the thread, which must not outlive the program's work.
        let _ = self.join();
    }
}

/// The sound of a film: one or two channels, at a rate that films have. A format without sound is warned of.
fn soundtrack(sound: &Sound, format: Format) -> Result<Option<Soundtrack>> {
    if !format.keeps_sound() {
        let others = Format::ALL.iter().filter(|format| format.keeps_sound());
        let others = ending::listed(others.flat_map(|format| format.extensions()).copied());
        standard::warn(format_args!(
            "{format} is silent: {others} has the sound, and a folder gets it as {SOUND_NAME}"
        ));
        return Ok(None);
    }
    let mixed;
    let sound = match sound.channels {
        1 | 2 => sound,
        _ => {
            mixed = Sound { rate_hz: sound.rate_hz, channels: 1, samples: sound.mono().into_owned() };
            &mixed
        }
    };
    let Sound { rate_hz, channels, samples } = sound.resampled(Soundtrack::rate_for(sound.rate_hz))?;
    Ok(Some(Soundtrack { rate_hz, channels, samples }))
}

/// The sound up to a time.
fn cut(mut sound: Sound, secs: f64) -> Sound {
    let frames = (secs * f64::from(sound.rate_hz)).ceil() as usize;
    sound.samples.truncate(frames.saturating_mul(sound.channels.into()));
    sound
}

fn write_film(
    received: &Receiver<Message>,
    out: &OutputFile,
    draft: DraftFile,
    (format, sound): (Format, Option<Soundtrack>),
    size: Size,
    rate: Rate,
) -> Result<()> {
    let failed = |error: FilmError| with_place(error, || out.expected());
    let mut film = Film::new(format, BufWriter::new(draft), size.width, size.height, rate).map_err(failed)?;
    if let Some(sound) = sound {
        film.set_sound(sound).map_err(failed)?;
    }
    while let Ok(message) = received.recv() {
        match message {
            Message::Frame(frame) => film.push(frame.as_raw()).map_err(failed)?,
            Message::End => {
                let file = film.finish().map_err(failed)?;
                let draft = file.into_inner().map_err(|error| failed(error.into_error().into()))?;
                return out.commit(draft);
            }
        }
    }
    Ok(())
}

fn write_folder(
    received: &Receiver<Message>,
    out: &OutputFolder,
    draft: DraftFolder,
    frames: u64,
) -> Result<()> {
    let mut number = 0;
    while let Ok(message) = received.recv() {
        match message {
            Message::Frame(frame) => {
                let bytes = avatar_film::png(frame.width(), frame.height(), frame.as_raw(), &[])?;
                let name = avatar_film::frame_name(number, frames);
                draft.write(&name, &bytes).with_context(|| out.expected())?;
                number += 1;
            }
            Message::End => return out.commit(draft),
        }
    }
    Ok(())
}

/// What the sink says needs the name of the file; the rest speaks for itself.
fn with_place(error: FilmError, place: impl FnOnce() -> String) -> Error {
    match error {
        FilmError::Io(error) => anyhow!(error).context(place()),
        other => other.into(),
    }
}
