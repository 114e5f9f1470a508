//! The second track of an MP4: AAC-LC, in time with the frames.

use crate::{FilmError, Format, Rate, Soundtrack};
use mp4::{
    AacConfig, AudioObjectType, BoxHeader, ChannelConfig, MediaConfig, MoovBox, Mp4Sample, Mp4Writer,
    ReadBox, SampleFreqIndex, TrackConfig, TrackType, WriteBox,
};
use oxideav_aac::encoder::{EncoderConfig, FRAME_LEN, StreamEncoder};
use std::io::{Cursor, Seek, SeekFrom, Write};

/// The track of the sound; that of the frames is the first.
const TRACK: u32 = 2;
/// Bits for each sample: at 48 kHz 96 kbit/s a channel.
const BITS_A_SAMPLE: u32 = 2;
/// Frames of sound that a decoder gives before the first one that was put in, since each block is coded
/// together with the one before.
const PRIMING: u64 = FRAME_LEN as u64;
/// Bytes of ADTS before each block, which MP4 does without.
const ADTS_BYTES: usize = 7;
/// Ticks a second of the film's own clock, at least.
const LEAST_TICKS: u32 = 10_000;

/// A sound on its way into a film.
pub(crate) struct SoundCoder {
    sound: Soundtrack,
    encoder: StreamEncoder,
    /// Whether the track has begun.
    is_open: bool,
    /// Blocks that are written.
    blocks: u64,
}

impl SoundCoder {
    /// Of a sound that was checked.
    pub(crate) fn new(sound: Soundtrack) -> Result<Self, FilmError> {
        let channels = sound.channels as u8;
        let bitrate = sound.rate_hz * BITS_A_SAMPLE * u32::from(sound.channels);
        let config = EncoderConfig { sample_rate: sound.rate_hz, channels, bitrate };
        let encoder = StreamEncoder::new(config).map_err(coded)?;
        Ok(Self { sound, encoder, is_open: false, blocks: 0 })
    }

    /// Writes the sound up to a time of the film; at the end one block more, which completes the last one.
    pub(crate) fn write_until<W: Write + Seek>(
        &mut self,
        writer: &mut Mp4Writer<W>,
        secs: f64,
        is_end: bool,
    ) -> Result<(), FilmError> {
        if !self.is_open {
            self.open(writer)?;
        }
        let width = usize::from(self.sound.channels);
        let frames = self.frames_until(secs);
        // The block of number k holds the frames before k times its length, coded with those behind.
        let wanted = frames.div_ceil(PRIMING) + u64::from(is_end);
        while self.blocks < wanted {
            let from = (self.blocks as usize * FRAME_LEN * width).min(self.sound.samples.len());
            let to = (from + FRAME_LEN * width).min(self.sound.samples.len());
            let whole = self.sound.samples.get(from..to).unwrap_or_default();
            let block: Vec<i16> = whole.iter().map(|sample| (sample * 32_768.0).round() as i16).collect();
            let whole = block.len() / width * width;
            let adts = self.encoder.encode_frame(block.get(..whole).unwrap_or_default()).map_err(coded)?;
            let bytes = adts.get(ADTS_BYTES..).unwrap_or_default().to_vec();
            let duration = FRAME_LEN as u32;
            let start_time = self.blocks * PRIMING;
            let sample =
                Mp4Sample { start_time, duration, rendering_offset: 0, is_sync: true, bytes: bytes.into() };
            writer.write_sample(TRACK, &sample).map_err(muxing)?;
            self.blocks += 1;
        }
        Ok(())
    }

    /// Frames of sound before a time of the film.
    fn frames_until(&self, secs: f64) -> u64 {
        let all = (self.sound.samples.len() / usize::from(self.sound.channels)) as u64;
        ((secs * f64::from(self.sound.rate_hz)).ceil() as u64).min(all)
    }

    fn open<W: Write + Seek>(&mut self, writer: &mut Mp4Writer<W>) -> Result<(), FilmError> {
        self.is_open = true;
        let rate_hz = self.sound.rate_hz;
        let index = (0..13_u8).filter_map(|index| SampleFreqIndex::try_from(index).ok());
        let freq_index = index.into_iter().find(|index| index.freq() == rate_hz);
        let freq_index = freq_index.ok_or_else(|| coded("expected a rate of AAC"))?;
        let chan_conf = if self.sound.channels == 1 { ChannelConfig::Mono } else { ChannelConfig::Stereo };
        let bitrate = rate_hz * BITS_A_SAMPLE * u32::from(self.sound.channels);
        let profile = AudioObjectType::AacLowComplexity;
        let media_conf = MediaConfig::AacConfig(AacConfig { bitrate, profile, freq_index, chan_conf });
        let language = "und".to_owned();
        let track = TrackConfig { track_type: TrackType::Audio, timescale: rate_hz, language, media_conf };
        writer.add_track(&track).map_err(muxing)
    }

    /// The index of a film with this sound. The writer cannot say what is missing there: that the sound
    /// begins behind its priming, and how long the tracks are, for which its clock is too coarse.
    pub(crate) fn index(&self, moov: &[u8], rate: Rate, frames: u64) -> Result<Vec<u8>, FilmError> {
        let mut bytes = Cursor::new(moov);
        let header = BoxHeader::read(&mut bytes).map_err(muxing)?;
        let mut moov = MoovBox::read_box(&mut bytes, header.size).map_err(muxing)?;
        // Whole ticks for each frame.
        let ticks = u32::from(rate.frames()) * LEAST_TICKS.div_ceil(rate.frames().into());
        let of_film = frames * u64::from(rate.secs()) * u64::from(ticks) / u64::from(rate.frames());
        let heard = self.frames_until(rate.time_secs(frames));
        let of_sound = heard * u64::from(ticks) / u64::from(self.sound.rate_hz);
        moov.mvhd.timescale = ticks;
        moov.mvhd.duration = of_film.max(of_sound);
        moov.mvhd.version = u8::from(moov.mvhd.duration > u64::from(u32::MAX));
        moov.mvhd.next_track_id = TRACK + 1;
        let [film, sound] = moov.traks.as_mut_slice() else { return Err(coded("expected two tracks")) };
        for (track, duration) in [(film, of_film), (&mut *sound, of_sound)] {
            track.tkhd.duration = duration;
            track.tkhd.version = u8::from(duration > u64::from(u32::MAX));
        }
        let edits = sound.edts.insert(Default::default()).elst.insert(Default::default());
        edits.version = u8::from(of_sound > u64::from(u32::MAX));
        edits.entries.push(Default::default());
        if let Some(edit) = edits.entries.last_mut() {
            edit.segment_duration = of_sound;
            edit.media_time = PRIMING;
            edit.media_rate = 1;
        }
        let mut out = Vec::new();
        moov.write_box(&mut out).map_err(muxing)?;
        Ok(out)
    }
}

/// A sink that keeps back the index, which is put right before it is written: what the writer writes once it
/// has gone back to say how long the frames are, and has come to the end again.
pub(crate) struct Tail<W> {
    inner: W,
    /// Where the bytes end that went through.
    end: u64,
    at: u64,
    kept: Option<Vec<u8>>,
}

impl<W: Write + Seek> Tail<W> {
    pub(crate) fn new(mut inner: W) -> std::io::Result<Self> {
        let at = inner.stream_position()?;
        Ok(Self { inner, end: at, at, kept: None })
    }

    /// The sink, and what was kept.
    pub(crate) fn into_parts(self) -> (W, Vec<u8>) {
        (self.inner, self.kept.unwrap_or_default())
    }
}

impl<W: Write + Seek> Write for Tail<W> {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        if let Some(kept) = &mut self.kept {
            kept.extend_from_slice(bytes);
            return Ok(bytes.len());
        }
        let count = self.inner.write(bytes)?;
        self.at += count as u64;
        self.end = self.end.max(self.at);
        Ok(count)
    }

    fn flush(&mut self) -> std::io::Result<()> {
        self.inner.flush()
    }
}

impl<W: Write + Seek> Seek for Tail<W> {
    fn seek(&mut self, to: SeekFrom) -> std::io::Result<u64> {
        self.at = self.inner.seek(to)?;
        if matches!(to, SeekFrom::Start(_)) && self.at == self.end {
            self.kept = Some(Vec::new());
        }
        Ok(self.at)
    }
}

/// What an encoder of pictures or sound says.
pub(crate) fn coded(reason: impl ToString) -> FilmError {
    FilmError::encoder(Format::Mp4, reason)
}

/// What the writer of MP4 says.
pub(crate) fn muxing(error: mp4::Error) -> FilmError {
    match error {
        mp4::Error::IoError(error) => error.into(),
        other => coded(other),
    }
}
