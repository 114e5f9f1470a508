//! The packets of the app Live Link Face (Epic Games): UDP, usually to port 11111, one for each frame.

use crate::bytes::Bytes;
use crate::channel::{HEAD_BEND, HEAD_BOW, HEAD_TURN, SHAPES};
use crate::turn::Eye;
use crate::{DecodeError, Found, Frame};

/// How many numbers a packet with a face has: the 52 shapes of ARKit, then yaw, pitch and roll of the head,
/// of the left and of the right eye, in radians.
pub const LIVE_LINK_VALUES: usize = 61;

/// The version of the format that is known.
const VERSION: u8 = 6;

/// Names are no longer than this, in bytes.
const NAME_LIMIT: usize = 256;

/// When a frame was: a number of frames, and how many of them a second has.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrameTime {
    /// Whole frames, usually since midnight.
    pub frame: i32,
    /// What is to be added to them.
    pub part: f32,
    /// Frames in as many seconds as the denominator says.
    pub numerator: i32,
    /// See the numerator.
    pub denominator: i32,
}

impl FrameTime {
    /// Seconds; `None` unless the rate is above 0.
    pub fn secs(&self) -> Option<f64> {
        let frames = f64::from(self.frame) + f64::from(self.part);
        let secs = frames * f64::from(self.denominator) / f64::from(self.numerator);
        (self.numerator > 0 && self.denominator > 0 && secs.is_finite()).then_some(secs)
    }
}

/// A packet of Live Link Face.
///
/// | bytes | what |
/// |---|---|
/// | 1 | version, 6 |
/// | 4 + n | length and text: id of the device |
/// | 4 + n | length and text: name of the subject |
/// | 4 + 4 + 4 + 4 | frame, part of a frame, numerator and denominator of the rate |
/// | 1 | how many numbers follow: 61, or 0 without a face |
/// | 61 · 4 | the numbers |
///
/// A packet without a face may end after the subject or after the rate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LiveLink<'a> {
    /// Which device sends.
    pub device: &'a str,
    /// What the device calls what it sends.
    pub subject: &'a str,
    /// When the frame was.
    pub time: Option<FrameTime>,
    /// Its numbers, if there was a face.
    pub values: Option<[f32; LIVE_LINK_VALUES]>,
}

impl<'a> LiveLink<'a> {
    /// Reads a packet.
    ///
    /// # Errors
    /// Another version, names of more than 256 bytes or not in UTF-8, numbers that are not finite, another
    /// count of them than 61 or 0, and a packet that ends early or late.
    pub fn decode(packet: &'a [u8]) -> Result<Self, DecodeError> {
        let mut bytes = Bytes::new(packet);
        let version = bytes.byte("a version")?;
        if version != VERSION {
            return Err(DecodeError::new(0, "version 6 of Live Link Face", Found::Number(version.into())));
        }
        let device = name(&mut bytes, "the id of a device of at most 256 bytes")?;
        let subject = name(&mut bytes, "the name of a subject of at most 256 bytes")?;
        let mut read = Self { device, subject, time: None, values: None };
        if bytes.is_empty() {
            return Ok(read);
        }
        read.time = Some(FrameTime {
            frame: bytes.i32("a frame's number")?,
            part: bytes.f32("a part of a frame")?,
            numerator: bytes.i32("the numerator of a rate")?,
            denominator: bytes.i32("the denominator of a rate")?,
        });
        if bytes.is_empty() {
            return Ok(read);
        }
        let at = bytes.at();
        match usize::from(bytes.byte("a count of values")?) {
            0 => {}
            LIVE_LINK_VALUES => {
                let mut values = [0.0; LIVE_LINK_VALUES];
                for value in &mut values {
                    *value = bytes.f32("a finite value")?;
                }
                read.values = Some(values);
            }
            count => return Err(DecodeError::new(at, "61 values, or 0", Found::Number(count as f64))),
        }
        if !bytes.is_empty() {
            return Err(bytes.wrong("the end of the packet"));
        }
        Ok(read)
    }

    /// Appends the packet to bytes. Names are cut at 256 bytes; values without a time are left out.
    pub fn encode(&self, out: &mut Vec<u8>) {
        out.push(VERSION);
        for name in [self.device, self.subject] {
            let name = name.get(..name.floor_char_boundary(NAME_LIMIT)).unwrap_or_default();
            out.extend((name.len() as u32).to_be_bytes());
            out.extend(name.as_bytes());
        }
        let Some(time) = self.time else { return };
        out.extend(time.frame.to_be_bytes());
        out.extend(time.part.to_be_bytes());
        out.extend(time.numerator.to_be_bytes());
        out.extend(time.denominator.to_be_bytes());
        match &self.values {
            Some(values) => {
                out.push(LIVE_LINK_VALUES as u8);
                out.extend(values.iter().flat_map(|value| value.to_be_bytes()));
            }
            None => out.push(0),
        }
    }

    /// The packet's frame. The signs of the head's angles are those of [`pose_anim::Recording`]; those of the
    /// eyes are known by `EyeLook…`, which say the same: their yaw is to the right, their pitch down.
    pub fn frame(&self) -> Frame {
        let mut frame = Frame::at(self.time.and_then(|time| time.secs()));
        frame.is_tracked = self.values.is_some();
        let Some(values) = &self.values else { return frame };
        for (channel, value) in values.iter().take(SHAPES).enumerate() {
            frame.set(channel, *value);
        }
        if let Some([turn, lift, bend, left @ .., _, right_yaw, right_pitch, _]) = values.get(SHAPES..) {
            frame.set(HEAD_TURN, turn.to_degrees());
            frame.set(HEAD_BOW, -lift.to_degrees());
            frame.set(HEAD_BEND, bend.to_degrees());
            if let [yaw, pitch] = left {
                Eye::Left.set_angles(&mut frame, -yaw.to_degrees(), -pitch.to_degrees());
            }
            Eye::Right.set_angles(&mut frame, -right_yaw.to_degrees(), -right_pitch.to_degrees());
        }
        frame
    }

    /// The numbers of a frame as Live Link Face has them; 0 where it has none.
    pub fn values_of(frame: &Frame) -> [f32; LIVE_LINK_VALUES] {
        let mut values = [0.0; LIVE_LINK_VALUES];
        for (value, shape) in values.iter_mut().zip(frame.values().iter().take(SHAPES)) {
            *value = *shape;
        }
        let angle = |channel| frame.get(channel).unwrap_or_default().to_radians();
        let head = [angle(HEAD_TURN), -angle(HEAD_BOW), angle(HEAD_BEND)];
        let eyes = [Eye::Left, Eye::Right].map(|eye| {
            let [aside, up] = eye.angles(frame).unwrap_or_default();
            [-aside.to_radians(), -up.to_radians(), 0.0]
        });
        let angles = head.into_iter().chain(eyes.into_iter().flatten());
        for (value, angle) in values.iter_mut().skip(SHAPES).zip(angles) {
            // The sum turns −0 into 0.
            *value = angle + 0.0;
        }
        values
    }
}

fn name<'a>(bytes: &mut Bytes<'a>, expected: &'static str) -> Result<&'a str, DecodeError> {
    let at = bytes.at();
    let length = bytes.u32(expected)?;
    match usize::try_from(length) {
        Ok(length) if length <= NAME_LIMIT => bytes.text(length, expected),
        _ => Err(DecodeError::new(at, expected, Found::Number(length.into()))),
    }
}
