//! The VMC protocol (<https://protocol.vmc.info/english>) and plain Open Sound Control, in and out.

use crate::channel::{SHAPES, channels, find};
use crate::osc::{Read, read_osc_unless};
use crate::turn::{self, Eye, Quaternion, about, head, matrix, other_handed, times};
use crate::{Arg, DecodeError, Frame, Message, OscWriter};

/// Addresses of the messages that VMC's senders send.
const VALUE: &str = "/VMC/Ext/Blend/Val";
const APPLY: &str = "/VMC/Ext/Blend/Apply";
const BONE: &str = "/VMC/Ext/Bone/Pos";
const TIME: &str = "/VMC/Ext/T";
const OK: &str = "/VMC/Ext/OK";

/// A frame without a time counts as much as so many with one; from this count on the sender has no clock, and
/// has one again when the count is back at 0.
const WITHOUT_TIME: u8 = 8;
const NO_CLOCK: u8 = 32;
/// A longer step from frame to frame is an interruption.
const LONGEST_STEP_SECS: f64 = 0.2;

/// What a sender of VMC has said so far. Its frames may be spread over several packets.
///
/// - `/VMC/Ext/Blend/Val name value` gives a channel its value: an expression of VRM 1.0 or 0.x, or a shape
///   of ARKit; `/VMC/Ext/Blend/Apply` makes a frame of all values so far.
/// - `/VMC/Ext/Bone/Pos` turns head (with the neck) and eyes. Its frame is Unity's, left-handed.
/// - `/VMC/Ext/T` is the sender's clock. A sender that does not say it for each frame has none.
/// - `/VMC/Ext/OK` may say that no face is seen.
/// - Any other address whose last word is the name of a channel gives that channel its first number:
///   `/face/jawOpen 0.5`. The end of the packet makes a frame of these. A bundle's time is the sender's
///   clock.
///
/// Where one packet with a time was lost, the time is guessed by the step before.
#[derive(Clone, Debug, Default)]
pub struct Vmc {
    frame: Frame,
    neck: Option<Quaternion>,
    head: Option<Quaternion>,
    /// The sender's time, if it was said since the last frame.
    time: Option<f64>,
    /// How often of late a frame came without a time of its own: a packet may be lost.
    without_time: u8,
    /// Whether that has been so often that the sender is taken for one that has no clock.
    has_no_clock: bool,
    /// The time of the last frame, and seconds from one to the next.
    last_secs: Option<f64>,
    step_secs: f64,
    /// Whether the sender says itself where a frame ends.
    applies: bool,
    /// Whether bones have moved since the last frame.
    is_turned: bool,
}

impl Vmc {
    /// Reads a packet. Returns the frame that it completes, the last one if there are several, and how many
    /// of its messages were understood.
    ///
    /// # Errors
    /// As those of [`crate::read_osc`]; what stands before the mistake counts. Messages that are well-formed
    /// but say something else are passed over.
    pub fn read(&mut self, packet: &[u8]) -> Result<(Option<Frame>, usize), DecodeError> {
        let (mut understood, mut done, mut plain) = (0, None, None);
        read_osc_unless(packet, &mut |read| {
            let message = match read {
                Read::Message(message) => message,
                Read::Bytes(bytes) => {
                    let known = known_value(bytes);
                    if let Some((channel, value)) = known {
                        self.frame.set(channel, value);
                        understood += 1;
                    }
                    return known.is_some();
                }
            };
            let is_understood = match message.address.starts_with("/VMC/") {
                true => self.message(&message, &mut done).is_some(),
                false => {
                    let is_plain = self.plain(&message).is_some();
                    if is_plain {
                        plain = Some(message.time);
                    }
                    is_plain
                }
            };
            understood += usize::from(is_understood);
            true
        })?;
        if let Some(time) = plain {
            // In 2⁻³² of a second, of which the upper half are seconds.
            self.frame.time_secs = time.map(|time| time as f64 / 4_294_967_296.0);
            done = Some(self.frame);
        }
        Ok((done, understood))
    }

    fn plain(&mut self, message: &Message<'_>) -> Option<()> {
        let name = message.address.rsplit('/').next()?;
        let [value] = message.args().numbers()?;
        self.frame.set_named(name, value as f32).then_some(())
    }

    fn message(&mut self, message: &Message<'_>, done: &mut Option<Frame>) -> Option<()> {
        let mut args = message.args();
        match message.address {
            VALUE => {
                let name = args.text()?;
                let [value] = args.numbers()?;
                self.frame.set_named(name, value as f32).then_some(())?;
            }
            APPLY => {
                self.applies = true;
                *done = Some(self.finish());
            }
            BONE => {
                let name = args.text()?;
                let [_, _, _, x, y, z, w] = args.numbers()?;
                let turned = other_handed([x, y, z, w]);
                let rows = matrix(turned)?;
                match name {
                    "Head" => self.head = Some(turned),
                    "Neck" => self.neck = Some(turned),
                    "LeftEye" => Eye::Left.set(&mut self.frame, &rows),
                    "RightEye" => Eye::Right.set(&mut self.frame, &rows),
                    _ => return None,
                }
                self.is_turned = true;
                // Lengths beside 1 would grow in a product.
                let unit = |q: Option<Quaternion>| {
                    let q = q?;
                    let length = q.iter().map(|x| x * x).sum::<f64>().sqrt();
                    Some(q.map(|x| x / length))
                };
                if let Some(head) = unit(self.head) {
                    let whole = unit(self.neck).map_or(head, |neck| times(neck, head));
                    turn::set_head(&mut self.frame, &matrix(whole)?);
                }
            }
            TIME => {
                let [time] = args.numbers()?;
                if self.is_turned && !self.applies {
                    *done = Some(self.finish());
                }
                self.time = Some(time);
            }
            OK => {
                let [_is_loaded] = args.numbers()?;
                if let Some([_, _, is_tracked]) = args.numbers() {
                    self.frame.is_tracked = is_tracked != 0.0;
                }
            }
            _ => return None,
        }
        Some(())
    }

    fn finish(&mut self) -> Frame {
        let time = self.time.take();
        match (time, self.last_secs) {
            (Some(time), last) => {
                self.without_time = self.without_time.saturating_sub(1);
                self.has_no_clock &= self.without_time > 0;
                let step = last.map_or(0.0, |last| time - last);
                if (0.0..=LONGEST_STEP_SECS).contains(&step) {
                    self.step_secs = step;
                }
            }
            // The first frame may come before the first time.
            (None, None) => {}
            (None, Some(_)) => {
                self.without_time = (self.without_time + WITHOUT_TIME).min(2 * NO_CLOCK);
                self.has_no_clock |= self.without_time >= NO_CLOCK;
            }
        }
        self.last_secs = time.or(self.last_secs.map(|last| last + self.step_secs));
        self.frame.time_secs = self.last_secs.filter(|_| !self.has_no_clock);
        self.is_turned = false;
        self.frame
    }
}

/// The bytes of a message that gives a channel its value, as all senders write it: a packet has dozens of
/// them, and reading them as any other message takes three times as long. `None` for what has to be read so.
fn known_value(bytes: &[u8]) -> Option<(usize, f32)> {
    let (text, value) = bytes.strip_prefix(b"/VMC/Ext/Blend/Val\0\0,sf\0")?.split_last_chunk()?;
    let value = f32::from_be_bytes(*value);
    // A text ends with one to four zeros, up to a multiple of four bytes.
    let name = match text.as_chunks() {
        (words, []) => {
            let [.., last] = words else { return None };
            let zeros = match last {
                [0, 0, 0, 0] => 4,
                [_, 0, 0, 0] => 3,
                [_, _, 0, 0] => 2,
                [_, _, _, 0] => 1,
                _ => return None,
            };
            text.get(..text.len() - zeros)?
        }
        _ => return None,
    };
    Some((find(name)?, value)).filter(|_| value.is_finite())
}

/// Packets are no larger than this, so that networks do not divide them.
const PACKET_LIMIT: usize = 1400;

/// Writes frames as VMC's packets, into a buffer of its own.
#[derive(Clone, Debug, Default)]
pub struct VmcSender {
    packet: Vec<u8>,
}

impl VmcSender {
    /// Hands over the packets of a frame: bundles of at most 1400 bytes with the sender's time in seconds,
    /// the bones of head and eyes, and values under the channels' own names. The last packet applies them.
    pub fn send(&mut self, frame: &Frame, secs: f64, send: &mut dyn FnMut(&[u8])) {
        self.begin();
        self.add(OK, &[Arg::Int(1)], send);
        self.add(TIME, &[Arg::Float(secs as f32)], send);
        let eyes = [("LeftEye", Eye::Left), ("RightEye", Eye::Right)];
        let eyes = eyes.map(|(name, eye)| (name, eye.turned(frame)));
        let has_head = (SHAPES..SHAPES + 3).any(|channel| frame.get(channel).is_some());
        let bones = [("Neck", has_head.then(|| about(0, 0.0))), ("Head", has_head.then(|| head(frame)))];
        for (name, turned) in bones.into_iter().chain(eyes) {
            let Some(turned) = turned else { continue };
            let [x, y, z, w] = other_handed(turned).map(|x| Arg::Float(x as f32));
            let nothing = Arg::Float(0.0);
            self.add(BONE, &[Arg::Text(name), nothing, nothing, nothing, x, y, z, w], send);
        }
        for (channel, value) in frame.iter() {
            // Angles have been said as bones.
            if let Some(channel) = channels().get(channel).filter(|channel| channel.min == 0.0) {
                self.add(VALUE, &[Arg::Text(channel.name), Arg::Float(value)], send);
            }
        }
        self.add(APPLY, &[], send);
        send(&self.packet);
    }

    fn begin(&mut self) {
        self.packet.clear();
        OscWriter::new(&mut self.packet).bundle(1);
    }

    fn add(&mut self, address: &str, args: &[Arg<'_>], send: &mut dyn FnMut(&[u8])) {
        let before = self.packet.len();
        OscWriter::new(&mut self.packet).element(|out| out.message(address, args));
        if self.packet.len() > PACKET_LIMIT {
            send(self.packet.get(..before).unwrap_or_default());
            self.begin();
            OscWriter::new(&mut self.packet).element(|out| out.message(address, args));
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "helpers of tests fail as tests do")]

    use super::*;
    use crate::read_osc;

    /// What the short way knows, the long way reads as the same.
    #[test]
    fn known_values_are_those_of_any_message() {
        let mut messages = Vec::new();
        for name in ["jawOpen", "A", "Joy", "mouthSmileLeft", "blink_l", "nobody", "", "Größe"] {
            for value in [0.25, -1.0, 2.0, f32::NAN, f32::INFINITY] {
                let mut packet = Vec::new();
                OscWriter::new(&mut packet).message(VALUE, &[Arg::Text(name), Arg::Float(value)]);
                messages.push(packet);
            }
        }
        let mut state = 3u32;
        let mut random = |below: usize| {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state >> 8) as usize % below
        };
        let mut known = 0;
        for message in messages {
            for change in 0..2000 {
                let mut changed = message.clone();
                if change > 0 {
                    let at = random(changed.len());
                    changed[at] = [0, b',', b'f', b's', b'A', b'_', 0x7f, 0x80][random(8)];
                    changed.truncate(message.len() - random(3) / 2 * 4);
                }
                let Some((channel, value)) = known_value(&changed) else { continue };
                known += 1;
                let mut read = None;
                read_osc(&changed, &mut |message| {
                    let mut args = message.args();
                    let name = args.text().unwrap();
                    let [number] = args.numbers().unwrap();
                    read = Some((message.address == VALUE, find(name.as_bytes()), number as f32));
                })
                .unwrap();
                assert_eq!(read, Some((true, Some(channel), value)));
            }
        }
        assert!(known > 3000, "{known}");
    }
}
