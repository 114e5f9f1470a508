use crate::kind::named;
use crate::wav::check;
use crate::{Limits, Note, Sound, SoundError};
use std::fmt;
use std::io::Cursor;
use symphonia::core::codecs::audio::{AudioDecoder, AudioDecoderOptions};
use symphonia::core::errors::Error;
use symphonia::core::formats::probe::Hint;
use symphonia::core::formats::{FormatOptions, FormatReader, TrackType};
use symphonia::core::io::MediaSourceStream;
use symphonia::core::meta::MetadataOptions;
use symphonia::default::{get_codecs, get_probe};

/// So many notes are kept; the rest is counted.
const MAX_NOTES: usize = 20;
/// No damaged part is taken to last longer than this.
const MOST_SILENCE_SECS: f64 = 1.0;
/// Of samples as loud as this somebody should know that they are cut off; decoders often go a little over 1.
const TOO_LOUD: f32 = 2.0;
/// From here on the length of a WAV is that of a writer who did not know how long it would be.
const UNKNOWN_BYTES: u32 = 0x7fff_0000;

/// Reads a whole sound. Notes tell what was passed over or put right.
///
/// # Errors
/// Bytes that are no sound of a kind that is read, and a sound that is longer than the limits allow. Damage
/// behind the first samples is no error.
pub fn decode(bytes: &[u8], limits: &Limits) -> Result<(Sound, Vec<Note>), SoundError> {
    let mut reader = SoundReader::new(bytes)?;
    let (rate_hz, channels) = (reader.rate_hz(), reader.channels());
    let mut sound = Sound { rate_hz, channels, samples: Vec::new() };
    while let Some(block) = reader.next_block() {
        let is_room = sound.samples.len() + block.len() <= limits.max_samples;
        if !is_room || sound.samples.try_reserve(block.len()).is_err() {
            return Err(sound.too_long(limits.max_samples));
        }
        sound.samples.extend_from_slice(block);
    }
    sound.samples.shrink_to_fit();
    Ok((sound, reader.into_notes()))
}

/// A sound that is read block by block, however long it is.
///
/// ```
/// use avatar_sound::{Sound, SoundReader};
/// let file = Sound { rate_hz: 8_000, channels: 1, samples: vec![0.1; 80_000] }.to_wav()?;
/// let (mut reader, mut heard) = (SoundReader::new(&file)?, 0);
/// while let Some(block) = reader.next_block() {
///     heard += block.len();
/// }
/// assert_eq!(heard, 80_000);
/// # Ok::<(), avatar_sound::SoundError>(())
/// ```
pub struct SoundReader<'a> {
    format: Box<dyn FormatReader + 'a>,
    decoder: Box<dyn AudioDecoder>,
    track: u32,
    rate_hz: u32,
    channels: u16,
    /// How many frames the file says it has.
    promised: Option<u64>,
    /// Whether its writer did not know how long it would be.
    is_endless: bool,
    block: Vec<f32>,
    /// Whether the block has been read and not yet been given away.
    is_waiting: bool,
    /// Frames of the blocks before this one.
    frames: u64,
    has_ended: bool,
    notes: Vec<Note>,
    more_notes: usize,
    is_too_loud: bool,
}

impl fmt::Debug for SoundReader<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut shown = f.debug_struct("SoundReader");
        shown.field("rate_hz", &self.rate_hz).field("channels", &self.channels);
        shown.field("frames", &self.frames).finish_non_exhaustive()
    }
}

impl<'a> SoundReader<'a> {
    /// Reads as far as to the first samples.
    ///
    /// # Errors
    /// Bytes that are no sound of a kind that is read.
    pub fn new(bytes: &'a [u8]) -> Result<Self, SoundError> {
        let kind = || SoundError::Kind { found: named(bytes) };
        if bytes.is_empty() {
            return Err(kind());
        }
        let damaged = |error: Error| match error {
            // The end of the bytes, or nothing that a decoder knows.
            Error::IoError(_) | Error::Unsupported(_) => kind(),
            other => SoundError::Damaged { reason: other.to_string() },
        };
        let source = MediaSourceStream::new(Box::new(Cursor::new(bytes)), Default::default());
        let (hint, options, meta) = (Hint::new(), FormatOptions::default(), MetadataOptions::default());
        let format = get_probe().probe(&hint, source, options, meta).map_err(damaged)?;
        let track = format.default_track(TrackType::Audio).ok_or_else(kind)?;
        let params = track.codec_params.as_ref().and_then(|params| params.audio()).ok_or_else(kind)?;
        let decoder =
            get_codecs().make_audio_decoder(params, &AudioDecoderOptions::default()).map_err(damaged)?;
        let kind_of_file = format.format_info().short_name;
        let said_bytes = bytes.get(4..8).and_then(|size| size.try_into().ok()).map(u32::from_le_bytes);
        let is_endless = kind_of_file == "wave" && said_bytes.is_some_and(|size| size >= UNKNOWN_BYTES);
        // Frames of MP3 are often estimated.
        let promised = track.num_frames.filter(|_| !is_endless && kind_of_file != "mp3");
        let track = track.id;
        let mut reader = Self {
            format,
            decoder,
            track,
            rate_hz: 0,
            channels: 0,
            promised,
            is_endless,
            block: Vec::new(),
            is_waiting: false,
            frames: 0,
            has_ended: false,
            notes: Vec::new(),
            more_notes: 0,
            is_too_loud: false,
        };
        reader.begin()?;
        Ok(reader)
    }

    /// Frames a second.
    pub fn rate_hz(&self) -> u32 {
        self.rate_hz
    }

    /// Samples in a frame.
    pub fn channels(&self) -> u16 {
        self.channels
    }

    /// The next frames, whole ones; `None` behind the last ones.
    pub fn next_block(&mut self) -> Option<&[f32]> {
        if !self.is_waiting {
            self.frames += (self.block.len() / usize::from(self.channels.max(1))) as u64;
            self.block.clear();
            if !self.fill() {
                return None;
            }
        }
        self.is_waiting = false;
        Some(&self.block)
    }

    /// What was passed over or put right so far, the first twenty, and how many more there were.
    pub fn into_notes(mut self) -> Vec<Note> {
        if self.more_notes > 0 {
            let text = format!("and {} more places like these", self.more_notes);
            self.notes.push(Note { secs: self.secs(), text });
        }
        self.notes
    }

    /// Reads the first samples, which say the rate and the channels for certain.
    fn begin(&mut self) -> Result<(), SoundError> {
        let (mut lost, mut reason) = (0, String::new());
        loop {
            match self.step() {
                Step::Samples(rate_hz, channels) if !self.block.is_empty() => {
                    check(rate_hz, channels)?;
                    self.rate_hz = rate_hz;
                    self.channels = u16::try_from(channels).unwrap_or(u16::MAX);
                    self.is_waiting = true;
                    self.clean();
                    if !reason.is_empty() {
                        let silence = vec![0.0; self.most_silence(lost)];
                        self.block.splice(0..0, silence);
                        self.say_damaged(&reason);
                    }
                    return Ok(());
                }
                Step::Samples(..) | Step::Other => {}
                Step::Damaged(frames, what) => {
                    lost = lost.saturating_add(frames);
                    reason = what;
                }
                Step::End(what) => {
                    let reason = if reason.is_empty() { what.unwrap_or_default() } else { reason };
                    return Err(SoundError::Empty { reason });
                }
            }
        }
    }

    /// Fills the block; not at the end.
    fn fill(&mut self) -> bool {
        while !self.has_ended {
            match self.step() {
                Step::Samples(rate_hz, channels) => {
                    if (rate_hz, channels) != (self.rate_hz, self.channels.into()) {
                        self.block.clear();
                        self.note(format!(
                            "from here on the sound has {rate_hz} samples a second and {channels} channels, \
                             before {} and {}: the rest is left out",
                            self.rate_hz, self.channels
                        ));
                        self.has_ended = true;
                    }
                }
                Step::Damaged(frames, reason) => {
                    self.block.resize(self.most_silence(frames), 0.0);
                    self.say_damaged(&reason);
                }
                Step::Other => {}
                Step::End(what) => {
                    self.has_ended = true;
                    self.say_end(what);
                }
            }
            if !self.block.is_empty() {
                self.clean();
                return true;
            }
        }
        false
    }

    /// Reads one packet of the file into the empty block.
    fn step(&mut self) -> Step {
        let packet = match self.format.next_packet() {
            Ok(Some(packet)) if packet.track_id == self.track => packet,
            Ok(Some(_)) => return Step::Other,
            Ok(None) => return Step::End(None),
            Err(Error::ResetRequired) => {
                return Step::End(Some("another sound follows here, which is left out".to_owned()));
            }
            Err(Error::IoError(_)) => return Step::End(Some("the file ends in the middle".to_owned())),
            Err(error) => return Step::End(Some(format!("the rest is left out: {error}"))),
        };
        let decoded = match self.decoder.decode(&packet) {
            Ok(decoded) => decoded,
            Err(error) => return Step::Damaged(packet.dur.get(), error.to_string()),
        };
        let (rate_hz, channels) = (decoded.spec().rate(), decoded.spec().channels().count());
        decoded.copy_to_vec_interleaved(&mut self.block);
        Step::Samples(rate_hz, channels)
    }

    /// Cuts off what is beyond -1 to 1, and makes 0 of what is no number.
    fn clean(&mut self) {
        let (mut nonsense, mut loudest) = (0_usize, 0.0_f32);
        for sample in &mut self.block {
            if sample.is_finite() {
                loudest = loudest.max(sample.abs());
                *sample = sample.clamp(-1.0, 1.0);
            } else {
                nonsense += 1;
                *sample = 0.0;
            }
        }
        if nonsense > 0 {
            self.note(format!("{nonsense} samples are no numbers, and are taken for 0"));
        }
        if loudest >= TOO_LOUD && !self.is_too_loud {
            self.is_too_loud = true;
            self.note(format!("samples from here on reach {loudest}: what is beyond -1 to 1 is cut off"));
        }
    }

    /// Samples of so many frames that could not be read.
    fn most_silence(&self, frames: u64) -> usize {
        let most = (MOST_SILENCE_SECS * f64::from(self.rate_hz)) as u64;
        frames.min(most) as usize * usize::from(self.channels)
    }

    fn say_damaged(&mut self, reason: &str) {
        self.note(format!("a part is silent, since it is damaged ({reason})"));
    }

    /// What is to be said of the end.
    fn say_end(&mut self, what: Option<String>) {
        match (what, self.promised) {
            (_, Some(promised)) if promised > self.frames => {
                let secs = promised as f64 / f64::from(self.rate_hz.max(1));
                self.note(format!("the file ends here, of {secs:.3} s that it says it has"));
            }
            (Some(what), None) if !self.is_endless => self.note(what),
            _ => {}
        }
    }

    fn note(&mut self, text: String) {
        let secs = self.secs();
        match self.notes.len() < MAX_NOTES {
            true => self.notes.push(Note { secs, text }),
            false => self.more_notes += 1,
        }
    }

    fn secs(&self) -> f64 {
        self.frames as f64 / f64::from(self.rate_hz.max(1))
    }
}

/// What a packet of a file was.
enum Step {
    /// Samples in the block, at a rate, of so many channels.
    Samples(u32, usize),
    /// Something that is not heard.
    Other,
    /// So many frames that cannot be read, and why.
    Damaged(u64, String),
    /// Nothing is left; why, if that is not the end.
    End(Option<String>),
}
