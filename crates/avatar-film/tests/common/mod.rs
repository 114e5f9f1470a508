//! Frames to film, and what decoders make of films.
#![allow(dead_code, reason = "every test file uses its own share of these helpers")]
#![allow(unreachable_pub, reason = "a module of several test programs")]

use avatar_film::{Film, Format, Rate};
use image::AnimationDecoder;
use image::codecs::png::PngDecoder;
use std::io::Cursor;

/// A soft round thing of many colours that moves over a ground, which stays; see-through around it if wished.
pub fn frames(width: u32, height: u32, count: u32, transparent: bool) -> Vec<Vec<u8>> {
    let (w, h) = (width as f32, height as f32);
    let frame = |k: u32| {
        let center = (w * (0.3 + 0.05 * k as f32), h * 0.5);
        let mut rgba = Vec::new();
        for at in 0..width * height {
            let (x, y) = ((at % width) as f32, (at / width) as f32);
            let distance = ((x - center.0).powi(2) + (y - center.1).powi(2)).sqrt() / (0.35 * h.max(w));
            let light = (1.0 - distance).max(0.0);
            let ground = if transparent { [0.0; 4] } else { [35.0, 39.0, 46.0, 255.0] };
            let thing =
                [120.0 + 120.0 * light, 80.0 + 110.0 * light + 20.0 * x / w, 70.0 + 90.0 * light, 255.0];
            let share = (light * 12.0).min(1.0);
            rgba.extend((0..4).map(|c| (ground[c] + (thing[c] - ground[c]) * share) as u8));
        }
        rgba
    };
    (0..count).map(frame).collect()
}

/// The bytes of a film.
pub fn film(format: Format, pictures: &[Vec<u8>], width: u32, height: u32, rate: Rate) -> Vec<u8> {
    let mut film = Film::new(format, Cursor::new(Vec::new()), width, height, rate).expect("a film");
    pictures.iter().for_each(|picture| film.push(picture).expect("a frame"));
    film.finish().expect("a film").into_inner()
}

/// Decibels of signal over noise in red, green and blue.
pub fn psnr(a: &[u8], b: &[u8]) -> f64 {
    assert_eq!(a.len(), b.len());
    let colors = |rgba: &'static [usize], bytes: &[u8]| -> Vec<f64> {
        bytes.chunks_exact(4).flat_map(|pixel| rgba.iter().map(|c| f64::from(pixel[*c]))).collect()
    };
    let (a, b) = (colors(&[0, 1, 2], a), colors(&[0, 1, 2], b));
    let squares: f64 = a.iter().zip(&b).map(|(a, b)| (a - b).powi(2)).sum();
    10.0 * (255.0 * 255.0 / (squares / a.len() as f64)).log10()
}

/// A whole picture, and its delay as the file has it.
pub struct Shown<D> {
    pub rgba: Vec<u8>,
    pub delay: D,
}

/// Frames as `image` puts them together; delays in seconds as `png` reads them.
pub fn apng(bytes: &[u8]) -> Vec<Shown<(u16, u16)>> {
    let decoder = PngDecoder::new(Cursor::new(bytes)).expect("a PNG").apng().expect("an animated one");
    let pictures = decoder.into_frames().collect_frames().expect("frames");
    let mut reader = png::Decoder::new(Cursor::new(bytes)).read_info().expect("a PNG");
    let control = *reader.info().animation_control().expect("an animation");
    assert_eq!((control.num_frames as usize, control.num_plays), (pictures.len(), 0));
    let mut room = vec![0; reader.output_buffer_size().expect("a size")];
    let delays = pictures.iter().map(|_| {
        reader.next_frame(&mut room).expect("a frame");
        let control = reader.info().frame_control().expect("a control");
        (control.delay_num, control.delay_den)
    });
    let delays: Vec<_> = delays.collect();
    pictures
        .into_iter()
        .zip(delays)
        .map(|(frame, delay)| Shown { rgba: frame.into_buffer().into_raw(), delay })
        .collect()
}

/// Frames put together as GIF89a says, delays in hundredths of a second, and whether it repeats for ever.
pub fn gif(bytes: &[u8]) -> (Vec<Shown<u16>>, bool) {
    let mut options = gif::DecodeOptions::new();
    options.set_color_output(gif::ColorOutput::RGBA);
    let mut decoder = options.read_info(bytes).expect("a GIF");
    let (width, height) = (usize::from(decoder.width()), usize::from(decoder.height()));
    let mut canvas = vec![0u8; width * height * 4];
    let mut shown = Vec::new();
    while let Some(frame) = decoder.read_next_frame().expect("a frame") {
        let places: Vec<usize> = (0..usize::from(frame.height))
            .flat_map(|y| {
                let row = (usize::from(frame.top) + y) * width + usize::from(frame.left);
                (row..row + usize::from(frame.width)).map(|place| place * 4)
            })
            .collect();
        for (place, pixel) in places.iter().zip(frame.buffer.chunks_exact(4)) {
            if pixel[3] != 0 {
                canvas[*place..place + 4].copy_from_slice(pixel);
            }
        }
        shown.push(Shown { rgba: canvas.clone(), delay: frame.delay });
        match frame.dispose {
            gif::DisposalMethod::Background => {
                places.iter().for_each(|place| canvas[*place..place + 4].fill(0));
            }
            other => assert_eq!(other, gif::DisposalMethod::Keep),
        }
    }
    (shown, decoder.repeat() == gif::Repeat::Infinite)
}
