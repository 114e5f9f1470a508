use crate::changed::{Region, changed};
use crate::picture::png;
use crate::{FilmError, Format, Rate};
use std::io::{Seek, SeekFrom, Write};

const SIGNATURE: &[u8; 8] = b"\x89PNG\r\n\x1a\n";

/// Animated PNG (PNG, third edition): of each frame the rectangle that changed, to the bit.
///
/// The crate `png` compresses; the chunks around it are written here, because it wants to know beforehand how
/// many frames there will be.
pub(crate) struct ApngFilm<W: Write + Seek> {
    sink: W,
    width: usize,
    height: usize,
    rate: Rate,
    frames: u32,
    /// The next number in the order of all chunks of the animation.
    sequence: u32,
    /// Where the number of frames stands.
    control_at: u64,
    shown: Vec<u8>,
    /// The rectangle's pixels.
    pixels: Vec<u8>,
}

impl<W: Write + Seek> ApngFilm<W> {
    pub(crate) fn new(mut sink: W, width: u32, height: u32, rate: Rate) -> Result<Self, FilmError> {
        sink.write_all(SIGNATURE)?;
        let mut header = [width.to_be_bytes(), height.to_be_bytes()].concat();
        // Eight bits a channel, RGBA; the only methods of compression and filtering; not interlaced.
        header.extend([8, 6, 0, 0, 0]);
        write_chunk(&mut sink, b"IHDR", &[&header])?;
        let control_at = sink.stream_position()?;
        write_chunk(&mut sink, b"acTL", &[&control(0)])?;
        let (width, height) = (width as usize, height as usize);
        let (shown, pixels) = (Vec::new(), Vec::new());
        Ok(Self { sink, width, height, rate, frames: 0, sequence: 0, control_at, shown, pixels })
    }

    pub(crate) fn push(&mut self, rgba: &[u8]) -> Result<(), FilmError> {
        let region = match self.frames {
            0 => Region { left: 0, top: 0, width: self.width, height: self.height },
            _ => changed(&self.shown, rgba, self.width),
        };
        self.pixels.clear();
        region.rows(rgba, self.width).for_each(|row| self.pixels.extend_from_slice(row));
        let [left, top, width, height] =
            [region.left, region.top, region.width, region.height].map(|length| length as u32);
        let mut control = [self.next()?, width, height, left, top].map(u32::to_be_bytes).concat();
        // The delay as a fraction; then: it stays, and takes the place of what was there.
        control.extend([self.rate.secs().to_be_bytes(), self.rate.frames().to_be_bytes()].concat());
        control.extend([0, 0]);
        write_chunk(&mut self.sink, b"fcTL", &[&control])?;
        let picture = png(width, height, &self.pixels, &[])?;
        for data in image_data(&picture) {
            match self.frames {
                0 => write_chunk(&mut self.sink, b"IDAT", &[data])?,
                _ => {
                    let number = self.next()?.to_be_bytes();
                    write_chunk(&mut self.sink, b"fdAT", &[&number, data])?;
                }
            }
        }
        self.shown.clear();
        self.shown.extend_from_slice(rgba);
        self.frames += 1;
        Ok(())
    }

    pub(crate) fn finish(mut self) -> Result<W, FilmError> {
        write_chunk(&mut self.sink, b"IEND", &[])?;
        let end = self.sink.stream_position()?;
        self.sink.seek(SeekFrom::Start(self.control_at))?;
        write_chunk(&mut self.sink, b"acTL", &[&control(self.frames)])?;
        self.sink.seek(SeekFrom::Start(end))?;
        Ok(self.sink)
    }

    fn next(&mut self) -> Result<u32, FilmError> {
        let number = self.sequence;
        // Numbers in PNG have 31 bits.
        let most = 1 << 30;
        if number >= (1 << 31) - 1 {
            return Err(FilmError::TooManyFrames { format: Format::Apng, most });
        }
        self.sequence += 1;
        Ok(number)
    }
}

/// So many frames, again and again.
fn control(frames: u32) -> [u8; 8] {
    let [a, b, c, d] = frames.to_be_bytes();
    [a, b, c, d, 0, 0, 0, 0]
}

fn write_chunk(sink: &mut impl Write, kind: &[u8; 4], parts: &[&[u8]]) -> Result<(), FilmError> {
    let length: usize = parts.iter().map(|part| part.len()).sum();
    let length =
        u32::try_from(length).map_err(|_| FilmError::encoder(Format::Apng, "a frame is too large"))?;
    let mut check = crc32fast::Hasher::new();
    sink.write_all(&length.to_be_bytes())?;
    for part in [&kind[..]].iter().chain(parts) {
        sink.write_all(part)?;
        check.update(part);
    }
    sink.write_all(&check.finalize().to_be_bytes())?;
    Ok(())
}

/// The contents of a PNG's `IDAT` chunks.
fn image_data(png: &[u8]) -> impl Iterator<Item = &[u8]> {
    let mut rest = png.get(SIGNATURE.len()..).unwrap_or_default();
    std::iter::from_fn(move || {
        let (length, after) = rest.split_first_chunk::<4>()?;
        let (kind, after) = after.split_first_chunk::<4>()?;
        let (data, after) = after.split_at_checked(u32::from_be_bytes(*length) as usize)?;
        rest = after.get(4..)?;
        Some((kind, data))
    })
    .filter(|(kind, _)| *kind == b"IDAT")
    .map(|(_, data)| data)
}
