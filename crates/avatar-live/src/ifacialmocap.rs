//! The texts of the app iFacialMocap: UDP, usually to port 49983, one for each frame.
//! <https://www.ifacialmocap.com/for-developer/>

use crate::bytes::Bytes;
use crate::channel::{HEAD_BEND, HEAD_BOW, HEAD_TURN, SHAPES, channels, find_sided};
use crate::turn::Eye;
use crate::{DecodeError, Found, Frame};
use std::io::Write;

/// What stands between a name and its number: this tells the two versions apart.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Separator {
    /// The first version: `jawOpen-12`.
    Minus,
    /// The second version, which an app sends when it is asked with `|sendDataVersion=v2`: `jawOpen&12`.
    Ampersand,
}

/// More fields than this are nobody's face.
const FIELDS: usize = 256;

/// Texts of iFacialMocap, of both versions and of Facemotion3d, which writes as the second one:
/// `jawOpen-12|…|=head#X,Y,Z,x,y,z|rightEye#X,Y,Z|leftEye#X,Y,Z|` with weights in percent and angles in
/// degrees.
///
/// The angles are those of ARKit's right-handed frame, whose X is the face's left: in the example of the
/// app's own page, eyes that look down and inward turn about +X, and about Y to each other's side. So X is
/// down, Y to the character's left, and Z, positive, bends to the right. The position is passed over.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct IFacialMocap;

impl IFacialMocap {
    /// What is sent to the app, at its port 49983, so that it begins to send to whoever asks.
    pub const REQUEST: &'static str =
        "iFacialMocap_sahuasouryya9218sauhuiayeta91555dy3719|sendDataVersion=v2";

    /// Reads a text. Names that are not known are passed over; there has to be one that is.
    ///
    /// # Errors
    /// Fields without a number, numbers that are not finite, too few angles, no known name, more than 256
    /// fields.
    pub fn decode(packet: &[u8]) -> Result<Frame, DecodeError> {
        let mut frame = Frame::default();
        let mut at = 0;
        for (count, field) in packet.split(|byte| *byte == b'|').enumerate() {
            if count >= FIELDS {
                return Err(DecodeError::new(at, "at most 256 fields", Found::Byte(b'|')));
            }
            let start = at;
            at += field.len() + 1;
            let trimmed = field.trim_ascii_start();
            let start = start + field.len() - trimmed.len();
            let field = trimmed.trim_ascii_end();
            // An app that sends by TCP puts this behind its text.
            if field.is_empty() || field.starts_with(b"___") {
                continue;
            }
            read_field(field, &mut frame).map_err(|error| error.further(start))?;
        }
        match frame.is_empty() && frame.is_tracked {
            true => {
                Err(DecodeError::new(0, "the name of a shape, or =head#", Bytes::new(packet).wrong("").found))
            }
            false => Ok(frame),
        }
    }

    /// Appends a frame's text to bytes: shapes in whole percent, angles, and a position of 0.
    pub fn encode(frame: &Frame, separator: Separator, out: &mut Vec<u8>) {
        // Writing to memory does not fail.
        let sign = if separator == Separator::Minus { '-' } else { '&' };
        for (channel, value) in frame.iter().take_while(|(channel, _)| *channel < SHAPES) {
            let name = channels().get(channel).map_or("", |channel| channel.name);
            let (stem, side) = match (name.strip_suffix("Left"), name.strip_suffix("Right")) {
                // These go to a side themselves.
                _ if matches!(name, "jawLeft" | "jawRight" | "mouthLeft" | "mouthRight") => (name, ""),
                (Some(stem), _) => (stem, "_L"),
                (_, Some(stem)) => (stem, "_R"),
                _ => (name, ""),
            };
            let _ = write!(out, "{stem}{side}{sign}{}|", (value * 100.0).round() as i32);
        }
        let angle = |channel| frame.get(channel).unwrap_or_default();
        let (down, left, right) = (angle(HEAD_BOW), angle(HEAD_TURN), -angle(HEAD_BEND) + 0.0);
        let _ = write!(out, "=head#{down},{left},{right},0,0,0|");
        for (name, eye) in [("rightEye", Eye::Right), ("leftEye", Eye::Left)] {
            let [aside, up] = eye.angles(frame).unwrap_or_default();
            let _ = write!(out, "{name}#{},{aside},0|", -up + 0.0);
        }
    }
}

/// A shape with a whole number of one to three digits, as most fields are: from the end, where only a few
/// bytes have to be looked at. Names have neither separator, so a name that is known was all of it.
fn whole_percent(field: &[u8]) -> Option<(usize, f32)> {
    let digit = |byte: &u8| f32::from(byte - b'0');
    let (name, percent) = match field {
        [name @ .., b'-' | b'&', a @ b'0'..=b'9'] => (name, digit(a)),
        [name @ .., b'-' | b'&', a @ b'0'..=b'9', b @ b'0'..=b'9'] => (name, 10.0 * digit(a) + digit(b)),
        [name @ .., b'-' | b'&', b'1', b'0', b'0'] => (name, 100.0),
        _ => return None,
    };
    Some((find_sided(name)?, percent))
}

fn read_field(field: &[u8], frame: &mut Frame) -> Result<(), DecodeError> {
    if let Some((channel, percent)) = whole_percent(field) {
        frame.set(channel, percent / 100.0);
        return Ok(());
    }
    if let Some((name, values, at)) = split(field, |byte| byte == b'#') {
        // The position is behind the head's angles.
        return match name.strip_prefix(b"=").unwrap_or(name) {
            b"head" => {
                let [down, left, right] = angles(values, at)?;
                frame.set(HEAD_BOW, down);
                frame.set(HEAD_TURN, left);
                frame.set(HEAD_BEND, -right);
                Ok(())
            }
            name @ (b"leftEye" | b"rightEye") => {
                let [down, left, _] = angles(values, at)?;
                let eye = if name == b"leftEye" { Eye::Left } else { Eye::Right };
                eye.set_angles(frame, left, -down);
                Ok(())
            }
            _ => Ok(()),
        };
    }
    let Some((name, value, at)) = split(field, |byte| byte == b'-' || byte == b'&') else {
        let found = field.first().map_or(Found::End, |byte| Found::Byte(*byte));
        return Err(DecodeError::new(0, "a name, - or &, and a number", found));
    };
    let value = number(value, at)?;
    if name == b"trackingStatus" {
        frame.is_tracked = value != 0.0;
    } else if let Some(channel) = find_sided(name) {
        frame.set(channel, value / 100.0);
    }
    Ok(())
}

/// What is before and behind a byte, and where the latter begins.
fn split(field: &[u8], is_separator: impl Fn(u8) -> bool) -> Option<(&[u8], &[u8], usize)> {
    let at = field.iter().position(|byte| is_separator(*byte))?;
    Some((field.get(..at)?, field.get(at + 1..)?, at + 1))
}

fn number(text: &[u8], at: usize) -> Result<f32, DecodeError> {
    let number: Option<f32> = std::str::from_utf8(text).ok().and_then(|text| text.trim().parse().ok());
    number.filter(|number| number.is_finite()).ok_or_else(|| {
        let found = text.first().map_or(Found::End, |byte| Found::Byte(*byte));
        DecodeError::new(at, "a finite number", found)
    })
}

fn angles(text: &[u8], at: usize) -> Result<[f32; 3], DecodeError> {
    let mut angles = [0.0; 3];
    let mut rest = Some((text, at));
    for angle in &mut angles {
        let Some((text, at)) = rest else {
            return Err(DecodeError::new(at + text.len(), "three angles", Found::End));
        };
        let (this, further) = match split(text, |byte| byte == b',') {
            Some((this, further, by)) => (this, Some((further, at + by))),
            None => (text, None),
        };
        *angle = number(this, at)?;
        rest = further;
    }
    Ok(angles)
}
