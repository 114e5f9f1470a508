//! A face that follows whoever sends, as an avatar's controls have it.

use super::inbox::Inbox;
use super::queue::Packet;
use crate::standard;
use anyhow::{Result, anyhow, bail};
use avatar_live::{Calibration, ControlMap, Frame, Receiver, Refused, Settings, Status, read_table};
use avatar_pack::{Pack, retarget};
use std::path::Path;
use std::time::Instant;

/// Seconds after the first face that `--calibrate` calls neutral.
const CALIBRATE_SECS: f64 = 1.0;

/// A recording that is played into the face by its own times.
#[derive(Debug)]
struct Tape {
    name: String,
    frames: Vec<Frame>,
    next: usize,
    /// When it began, in seconds from the beginning.
    from_secs: f64,
}

/// The receiver, the avatar's map, and what is yet to happen.
#[derive(Debug)]
pub(crate) struct Follow {
    pub(crate) receiver: Receiver,
    map: ControlMap,
    pub(crate) inbox: Inbox,
    tape: Option<Tape>,
    start: Instant,
    /// Whether the face is still to be called neutral.
    calibrate: bool,
    /// When a face came first.
    first_face_secs: Option<f64>,
    /// What has been called neutral, until it is asked for.
    calibrated: Option<Calibration>,
    /// The last face that somebody had sent, until it has been neutral.
    had: Option<Frame>,
    /// The last packet that was refused, and how many were.
    pub(crate) refused: Option<(u64, Refused)>,
}

impl Follow {
    /// Begins to follow. `smooth` is a share of the greatest smoothing, 100 ms.
    pub(crate) fn new(pack: &Pack, inbox: Inbox, smooth: f32, calibrate: bool, is_mirrored: bool) -> Self {
        let mut receiver = Receiver::new(Settings::default());
        receiver.set_mirrored(is_mirrored);
        let map = ControlMap::with(pack.controls(), retarget(pack));
        let start = Instant::now();
        let mut follow = Self {
            receiver,
            map,
            inbox,
            tape: None,
            start,
            calibrate,
            first_face_secs: None,
            calibrated: None,
            had: None,
            refused: None,
        };
        follow.set_smooth(smooth);
        follow
    }

    /// Plays a recording, from a time in seconds from the beginning.
    pub(crate) fn play(&mut self, path: &Path, from_secs: f64) -> Result<()> {
        let Some(text) = crate::reading::text(path)? else {
            bail!("{}: expected a recording of a face, found nothing of that name", path.display())
        };
        let frames = read_table(&text).map_err(|error| anyhow!("{}: {error}", path.display()))?;
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        self.tape = Some(Tape { name, frames, next: 0, from_secs });
        Ok(())
    }

    /// Another avatar follows.
    pub(crate) fn set_pack(&mut self, pack: &Pack) {
        self.map = ControlMap::with(pack.controls(), retarget(pack));
    }

    /// How long the recording is, in seconds; 0 without one.
    pub(crate) fn tape_secs(&self) -> f64 {
        let frames = self.tape.as_ref().map(|tape| tape.frames.as_slice());
        frames.and_then(|frames| frames.last()?.time_secs).unwrap_or_default()
    }

    /// The time of an instant, in seconds from the beginning.
    pub(crate) fn secs(&self, at: Instant) -> f64 {
        at.saturating_duration_since(self.start).as_secs_f64()
    }

    /// The instant of a time.
    pub(crate) fn instant(&self, secs: f64) -> Instant {
        self.start + std::time::Duration::from_secs_f64(secs.clamp(0.0, 1e9))
    }

    /// Name of the recording, until it is over.
    pub(crate) fn tape_name(&self) -> Option<&str> {
        let tape = self.tape.as_ref().filter(|tape| tape.next < tape.frames.len());
        tape.map(|tape| tape.name.as_str())
    }

    /// Smooths by a share of the greatest smoothing, 100 ms.
    pub(crate) fn set_smooth(&mut self, smooth: f32) {
        self.receiver.settings.smooth_secs = (smooth > 0.0).then_some(f64::from(smooth) * 0.1);
    }

    /// What has been called neutral since this was asked last.
    pub(crate) fn calibrated(&mut self) -> Option<Calibration> {
        self.calibrated.take()
    }

    /// Takes what arrives until then, waiting for it.
    pub(crate) fn wait(&mut self, until_secs: f64) {
        let then = self.instant(until_secs);
        while let Some(packet) = self.inbox.take_until(then) {
            self.take(&packet);
            // A flood would go on for ever.
            if packet.at > then {
                break;
            }
        }
    }

    /// Takes a packet.
    pub(crate) fn take(&mut self, packet: &Packet) {
        let at_secs = self.secs(packet.at);
        let result = self.receiver.receive(at_secs, packet.origin, packet.protocol, &packet.bytes);
        if let Err(refused) = result {
            if self.refused.is_none() {
                standard::warn(format_args!("{} from {}: {refused}", packet.protocol, packet.origin));
            }
            let (count, _) = self.refused.unwrap_or((0, refused));
            self.refused = Some((count + 1, refused));
        }
    }

    /// Goes to a time, in seconds from the beginning.
    ///
    /// # Errors
    /// There are too many senders for the recording to be one more. It is over then, and whoever sends goes
    /// on.
    pub(crate) fn advance(&mut self, now_secs: f64) -> Result<()> {
        let played = self.play_until(now_secs);
        if played.is_err() {
            self.tape = None;
        }
        self.receiver.advance(now_secs);
        if self.first_face_secs.is_none() && self.receiver.senders().any(|sender| sender.is_live) {
            self.first_face_secs = Some(now_secs);
        }
        if self.calibrate && self.first_face_secs.is_some_and(|first| now_secs - first >= CALIBRATE_SECS) {
            self.calibrated = self.receiver.calibrate();
            self.calibrate = self.calibrated.is_none();
        }
        played
    }

    /// Sends the frames of the recording that are due until then.
    fn play_until(&mut self, now_secs: f64) -> Result<()> {
        let Some(tape) = &mut self.tape else { return Ok(()) };
        while let Some(frame) = tape.frames.get(tape.next) {
            let at_secs = frame.time_secs.map(|secs| tape.from_secs + secs);
            let Some(at_secs) = at_secs.filter(|at_secs| *at_secs <= now_secs) else { break };
            self.receiver.push(at_secs, &tape.name, frame)?;
            tape.next += 1;
        }
        Ok(())
    }

    /// Gives the avatar's controls the face's values; whether there is a face. Once, when nobody has it any
    /// more, that is the neutral one: however long ago the last frame was, nothing stays of it.
    pub(crate) fn apply(&mut self, values: &mut [f32]) -> bool {
        let face = *self.receiver.face();
        if !face.is_empty() {
            self.had = Some(face);
            self.map.apply(&face, values);
            return true;
        }
        let Some(had) = self.had.take() else { return false };
        let mut neutral = Frame::default();
        had.iter().for_each(|(channel, _)| neutral.set(channel, 0.0));
        self.map.apply(&neutral, values);
        true
    }

    /// When the face moves next, should nothing arrive: in seconds from the beginning.
    pub(crate) fn wakes_at(&self) -> Option<f64> {
        let tape = self.tape.as_ref();
        let tape = tape.and_then(|tape| Some(tape.from_secs + tape.frames.get(tape.next)?.time_secs?));
        let face = self.receiver.wakes_at();
        [tape, face].into_iter().flatten().min_by(f64::total_cmp)
    }

    /// Where it listens, for people.
    pub(crate) fn places(&self) -> impl Iterator<Item = String> {
        self.inbox.places().map(|(protocol, place)| format!("listening for {protocol} at {place}"))
    }
}

/// How a sender is doing, in one line.
pub(crate) fn line(sender: &Status<'_>) -> String {
    let Status { name, protocol, rate_hz, received, lost, reordered, duplicates, late, .. } = sender;
    let (ms, ppm) = (sender.delay_secs * 1e3, sender.drift_ppm);
    format!(
        "{name} ({protocol}): {rate_hz:.1} frames a second, {received} received, {lost} lost, {reordered} reordered, \
         {duplicates} twice, {late} late; delay {ms:.1} ms, clock {ppm:+.0} ppm"
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use avatar_stage::DefaultFace;

    #[test]
    fn a_recording_for_which_there_is_no_room_is_over_and_the_face_goes_on() {
        let pack = Pack::load(&DefaultFace).expect("the built-in face");
        let inbox = Inbox::open(&[], crate::live::Pages::default(), || ()).expect("nothing to listen to");
        let mut follow = Follow::new(&pack, inbox, 0.0, false, false);
        let mut frame = Frame::default();
        frame.set_named("jawOpen", 0.5);
        for sender in 0..8 {
            follow.receiver.push(0.0, &format!("sender {sender}"), &frame).expect("room for eight");
        }
        let frames = vec![Frame::at(Some(0.0)), Frame::at(Some(0.1))];
        follow.tape = Some(Tape { name: "take".to_owned(), frames, next: 0, from_secs: 0.0 });
        assert_eq!(follow.tape_name(), Some("take"));
        let error = follow.advance(0.05).expect_err("a ninth sender");
        assert_eq!(error.to_string(), "expected at most 8 senders, found another one");
        assert_eq!(follow.tape_name(), None);
        follow.advance(0.2).expect("the others go on");
        assert_ne!(follow.receiver.face().named("jawOpen"), None);
    }
}
