//! Recordings as tables of comma-separated values, in the layout of Live Link Face.

use crate::channel::{CHANNELS, SHAPES, channels};
use crate::{Frame, FrameTime, LIVE_LINK_VALUES, LiveLink};
use pose_anim::{Control, ControlTable, Drive, Pace, Recording, RecordingError};
use std::io::Write;

/// What the app calls the numbers behind the shapes.
const ANGLES: [&str; 9] = [
    "HeadYaw",
    "HeadPitch",
    "HeadRoll",
    "LeftEyeYaw",
    "LeftEyePitch",
    "LeftEyeRoll",
    "RightEyeYaw",
    "RightEyePitch",
    "RightEyeRoll",
];

/// Appends the line with the names of the columns to bytes.
pub fn write_table_header(out: &mut Vec<u8>) {
    out.extend(b"FrameNumber,SubFrame,Numerator,Denominator,BlendShapeCount");
    for channel in channels().iter().take(SHAPES) {
        let (first, rest) = channel.name.split_at_checked(1).unwrap_or_default();
        // Writing to memory does not fail.
        let _ = write!(out, ",{}{rest}", first.to_uppercase());
    }
    for name in ANGLES {
        let _ = write!(out, ",{name}");
    }
    out.push(b'\n');
}

/// Appends a row to bytes: numbers as C's `%.9g` writes them, which says a number of 32 bits exactly.
pub fn write_table_row(time: &FrameTime, values: &[f32; LIVE_LINK_VALUES], out: &mut Vec<u8>) {
    let _ = write!(out, "{},", time.frame);
    write_number(time.part, out);
    let _ = write!(out, ",{},{},{LIVE_LINK_VALUES}", time.numerator, time.denominator);
    for value in values {
        out.push(b',');
        write_number(*value, out);
    }
    out.push(b'\n');
}

/// `%.9g`: nine significant digits without zeros at their end, with an exponent below 10⁻⁴ and from 10⁹ on.
fn write_number(number: f32, out: &mut Vec<u8>) {
    const DIGITS: i32 = 9;
    let start = out.len();
    let _ = write!(out, "{number:.8e}");
    let written = out.get(start..).unwrap_or_default();
    let mark = written.iter().position(|byte| *byte == b'e').unwrap_or(written.len());
    let exponent = std::str::from_utf8(written.get(mark + 1..).unwrap_or_default());
    let exponent = exponent.ok().and_then(|exponent| exponent.parse::<i32>().ok()).unwrap_or_default();
    if (-4..DIGITS).contains(&exponent) {
        out.truncate(start);
        let decimals = usize::try_from(DIGITS - 1 - exponent).unwrap_or_default();
        let _ = write!(out, "{number:.decimals$}");
        without_zeros(start, out);
    } else {
        out.truncate(start + mark);
        without_zeros(start, out);
        let sign = if exponent < 0 { '-' } else { '+' };
        let _ = write!(out, "e{sign}{:02}", exponent.abs());
    }
}

fn without_zeros(start: usize, out: &mut Vec<u8>) {
    if out.get(start..).is_some_and(|written| written.contains(&b'.')) {
        while out.last() == Some(&b'0') {
            out.pop();
        }
        if out.last() == Some(&b'.') {
            out.pop();
        }
    }
}

/// Reads a recording of Live Link Face into frames, each with its time from the first row on.
///
/// # Errors
/// As [`Recording::from_csv`], which reads it.
pub fn read_table(text: &str) -> Result<Vec<Frame>, RecordingError> {
    let control = |channel: &crate::Channel| Control {
        name: channel.name.to_owned(),
        drives: Drive::Shape { shape: channel.name.to_owned() },
        min: channel.min,
        max: channel.max,
        default: 0.0,
        pace: Pace::OTHER,
        group: None,
    };
    // Channels have names of their own and ranges around 0.
    let table = ControlTable::new(channels().iter().map(control).collect()).unwrap_or_default();
    let clip = Recording::from_csv("recording", text, &table)?.clip;
    let count = clip.tracks().iter().map(|track| track.keys().len()).max().unwrap_or_default();
    let mut frames = vec![Frame::default(); count];
    for track in clip.tracks() {
        for (frame, key) in frames.iter_mut().zip(track.keys()) {
            frame.time_secs = Some(key.time_secs);
            frame.set(track.control().min(CHANNELS), key.value as f32);
        }
    }
    Ok(frames)
}

impl LiveLink<'_> {
    /// A packet's row in a table: its time and values, if it has both.
    pub fn write_row(&self, out: &mut Vec<u8>) -> bool {
        let (Some(time), Some(values)) = (&self.time, &self.values) else { return false };
        write_table_row(time, values, out);
        true
    }
}
