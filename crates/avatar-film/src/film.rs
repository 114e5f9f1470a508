use crate::apng::ApngFilm;
use crate::gif_film::GifFilm;
#[cfg(feature = "mp4")]
use crate::mp4_film::Mp4Film;
use crate::{FilmError, Format, Rate, Soundtrack};
use std::fmt;
use std::io::{Seek, Write};

/// A film that is being written. It is not one before [`Self::finish`]; what was written till then can be
/// thrown away.
pub struct Film<W: Write + Seek> {
    format: Format,
    frame_bytes: usize,
    frames: u64,
    encoder: Encoder<W>,
}

enum Encoder<W: Write + Seek> {
    Gif(GifFilm<W>),
    Apng(ApngFilm<W>),
    #[cfg(feature = "mp4")]
    Mp4(Box<Mp4Film<W>>),
}

impl<W: Write + Seek> fmt::Debug for Film<W> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Film").field("frames", &self.frames).finish_non_exhaustive()
    }
}

impl<W: Write + Seek> Film<W> {
    /// Begins a film of frames of one size. The sink is written from where it stands.
    ///
    /// # Errors
    /// As [`Format::check`], or a sink that cannot be written.
    pub fn new(format: Format, sink: W, width: u32, height: u32, rate: Rate) -> Result<Self, FilmError> {
        format.check(width, height, rate)?;
        let size = || FilmError::Size { format, width, height, largest: format.largest() };
        let pixels = (width as usize).checked_mul(height as usize);
        let frame_bytes = pixels.and_then(|pixels| pixels.checked_mul(4)).ok_or_else(size)?;
        let encoder = match format {
            Format::Gif => {
                let (Ok(width), Ok(height)) = (width.try_into(), height.try_into()) else {
                    return Err(size());
                };
                Encoder::Gif(GifFilm::new(sink, width, height, rate)?)
            }
            Format::Apng => Encoder::Apng(ApngFilm::new(sink, width, height, rate)?),
            #[cfg(feature = "mp4")]
            Format::Mp4 => Encoder::Mp4(Box::new(Mp4Film::new(sink, width as usize, height as usize, rate)?)),
        };
        Ok(Self { format, frame_bytes, frames: 0, encoder })
    }

    /// Gives the film a sound, before its first frame: as much of it is heard as there are frames, and its
    /// first sample is heard with the first frame.
    ///
    /// # Errors
    /// A format that has no sound ([`Format::keeps_sound`]), a rate or channels that it does not know, or a
    /// film that has begun.
    pub fn set_sound(&mut self, sound: Soundtrack) -> Result<(), FilmError> {
        sound.check(self.format)?;
        if self.frames > 0 {
            let (expected, found) = ("a sound before the first frame", format!("{} frames", self.frames));
            return Err(FilmError::Sound { format: self.format, expected: expected.to_owned(), found });
        }
        match &mut self.encoder {
            #[cfg(feature = "mp4")]
            Encoder::Mp4(film) => film.set_sound(sound),
            Encoder::Gif(_) | Encoder::Apng(_) => Ok(()),
        }
    }

    /// Shows this frame next.
    ///
    /// # Errors
    /// Not `width · height · 4` bytes, then the film can go on; an encoder or a sink that fails, then it
    /// cannot.
    pub fn push(&mut self, rgba: &[u8]) -> Result<(), FilmError> {
        if rgba.len() != self.frame_bytes {
            return Err(FilmError::Frame { expected: self.frame_bytes, found: rgba.len() });
        }
        match &mut self.encoder {
            Encoder::Gif(film) => film.push(rgba),
            Encoder::Apng(film) => film.push(rgba),
            #[cfg(feature = "mp4")]
            Encoder::Mp4(film) => film.push(rgba),
        }?;
        self.frames += 1;
        Ok(())
    }

    /// How many frames there are.
    pub const fn frames(&self) -> u64 {
        self.frames
    }

    /// Writes what is left and hands the sink back.
    ///
    /// # Errors
    /// No frames, or an encoder or a sink that fails.
    pub fn finish(self) -> Result<W, FilmError> {
        if self.frames == 0 {
            return Err(FilmError::NoFrames);
        }
        let mut sink = match self.encoder {
            Encoder::Gif(film) => film.finish(),
            Encoder::Apng(film) => film.finish(),
            #[cfg(feature = "mp4")]
            Encoder::Mp4(film) => film.finish(),
        }?;
        sink.flush()?;
        Ok(sink)
    }
}

impl Format {
    /// Whether the format holds frames of this size at this rate.
    ///
    /// # Errors
    /// No pixels; GIF: a side beyond 65535, or more than 50 frames per second; MP4: more than 3840x2160,
    /// either way round.
    pub fn check(self, width: u32, height: u32, rate: Rate) -> Result<(), FilmError> {
        let largest = self.largest();
        if width.min(height) == 0 || width.max(height) > largest.0 || width.min(height) > largest.1 {
            return Err(FilmError::Size { format: self, width, height, largest });
        }
        match self.fastest().filter(|most| rate.per_second() > f64::from(*most)) {
            Some(most) => Err(FilmError::Rate { format: self, rate, most }),
            None => Ok(()),
        }
    }
}
