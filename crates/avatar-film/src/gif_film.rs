use crate::changed::{Region, changed};
use crate::palette::Palette;
use crate::{FilmError, Format, Rate};
use gif::{DisposalMethod, Encoder, EncodingError, Frame, Repeat};
use std::io::Write;

/// Alpha from which on a pixel is opaque: a GIF knows no others than these two.
const OPAQUE_FROM: u8 = 128;

/// GIF: of each frame only the pixels that changed are painted, with a palette of their own.
pub(crate) struct GifFilm<W: Write> {
    encoder: Encoder<W>,
    width: usize,
    height: usize,
    rate: Rate,
    written: u64,
    /// What is seen before the frame that waits; `None` is nothing at all.
    shown: Option<Vec<u8>>,
    /// The last frame. How it goes away is written with it, and depends on the next one.
    waiting: Option<Vec<u8>>,
}

impl<W: Write> GifFilm<W> {
    pub(crate) fn new(sink: W, width: u16, height: u16, rate: Rate) -> Result<Self, FilmError> {
        let mut encoder = Encoder::new(sink, width, height, &[]).map_err(failed)?;
        encoder.set_repeat(Repeat::Infinite).map_err(failed)?;
        let (width, height) = (width.into(), height.into());
        Ok(Self { encoder, width, height, rate, written: 0, shown: None, waiting: None })
    }

    pub(crate) fn push(&mut self, rgba: &[u8]) -> Result<(), FilmError> {
        let next = all_or_nothing(rgba);
        if let Some(frame) = self.waiting.take() {
            let mut pairs = frame.chunks_exact(4).zip(next.chunks_exact(4));
            // What is painted over stays; only wiping makes a pixel transparent again.
            let wiped = pairs.any(|(before, after)| before[3] != 0 && after[3] == 0);
            self.write(&frame, wiped)?;
            self.shown = (!wiped).then_some(frame);
        }
        self.waiting = Some(next);
        Ok(())
    }

    pub(crate) fn finish(mut self) -> Result<W, FilmError> {
        if let Some(frame) = self.waiting.take() {
            self.write(&frame, false)?;
        }
        self.encoder.into_inner().map_err(failed)
    }

    fn write(&mut self, frame: &[u8], wiped: bool) -> Result<(), FilmError> {
        let whole = Region { left: 0, top: 0, width: self.width, height: self.height };
        let before = self.shown.as_deref();
        let region = before.filter(|_| !wiped).map_or(whole, |before| changed(before, frame, self.width));
        let colors = |pixel: &[u8]| [pixel[0], pixel[1], pixel[2]];
        let after = || region.rows(frame, self.width).flat_map(|row| row.chunks_exact(4));
        // Whether each pixel has to be painted: the others show what lies below.
        let painted: Vec<bool> = match before {
            None => after().map(|pixel| pixel[3] != 0).collect(),
            Some(before) => {
                let before = region.rows(before, self.width).flat_map(|row| row.chunks_exact(4));
                before.zip(after()).map(|(before, after)| after[3] != 0 && before != after).collect()
            }
        };
        let pixels: Vec<_> =
            after().zip(&painted).filter(|(_, painted)| **painted).map(|(pixel, _)| colors(pixel)).collect();
        let mut palette = Palette::of(&pixels);
        let transparent = palette.transparent();
        let buffer: Vec<u8> = after()
            .zip(&painted)
            .map(|(pixel, painted)| if *painted { palette.index_of(colors(pixel)) } else { transparent })
            .collect();
        palette.rgb.extend([0; 3]);
        let frame = Frame {
            delay: self.delay(),
            dispose: if wiped { DisposalMethod::Background } else { DisposalMethod::Keep },
            transparent: Some(transparent),
            left: region.left as u16,
            top: region.top as u16,
            width: region.width as u16,
            height: region.height as u16,
            palette: Some(palette.rgb),
            buffer: buffer.into(),
            ..Frame::default()
        };
        self.encoder.write_frame(&frame).map_err(failed)?;
        self.written += 1;
        Ok(())
    }

    /// Hundredths of a second that the next frame stays: what is missing from the rounded beginning of the
    /// frame after it, so that rounding never adds up.
    fn delay(&self) -> u16 {
        let (frames, secs) = (u64::from(self.rate.frames()), u64::from(self.rate.secs()));
        let begin = |frame: u64| (200 * frame * secs + frames) / (2 * frames);
        (begin(self.written + 1) - begin(self.written)) as u16
    }
}

/// The frame with pixels that are opaque, or transparent and black.
fn all_or_nothing(rgba: &[u8]) -> Vec<u8> {
    let pixels = rgba.chunks_exact(4);
    pixels
        .flat_map(|pixel| match pixel[3] {
            OPAQUE_FROM.. => [pixel[0], pixel[1], pixel[2], 255],
            _ => [0; 4],
        })
        .collect()
}

fn failed(error: EncodingError) -> FilmError {
    match error {
        EncodingError::Io(error) => error.into(),
        other => FilmError::encoder(Format::Gif, other),
    }
}
