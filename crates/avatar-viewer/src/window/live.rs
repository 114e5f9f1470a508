//! The window's face follows a sender: packets wake the window, and no frame is drawn while nothing arrives.

use super::face::Face;
use super::messages::{About, Messages};
use super::session::Session;
use super::stage::Drawn;
use super::watch::Wake;
use crate::live::{
    CalibrationFile, FORMATS, Follow, Inbox, Pages, Recorder, Sending, Take, everywhere, usual,
};
use crate::live_args::LiveOptions;
use anyhow::{Result, bail};
use avatar_live::Calibration;
use avatar_pack::Pack;
use avatar_panel::{Inlet, LiveSender};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};
use winit::event_loop::EventLoopProxy;

/// A pause of the window that is longer is not recorded whole.
const LONGEST_PAUSE_SECS: f64 = 5.0;
/// The share of a new measurement in the mean.
const NEWEST: f32 = 0.1;

/// A face that somebody moves rests when it has been still for so long.
const STILL: Duration = Duration::from_secs(1);
/// What takes longer is no frame that was drawn at once.
const LONGEST_DRAWING: Duration = Duration::from_secs(1);

/// The title of an error.
pub(super) const CALIBRATION_NOT_READ: &str = "The calibration was not read.";

/// What drives the face from outside.
pub(super) struct Live {
    pub(super) follow: Follow,
    take: Option<(Take, Recorder)>,
    sending: Option<Sending>,
    /// Seconds from one frame that is recorded and sent to the next, and when that is.
    tick_secs: f64,
    next_secs: f64,
    /// When the recording of a clip began that the face makes.
    recorded_from_secs: Option<f64>,
    /// The window has been told of packets that it has not taken yet.
    is_told: Arc<AtomicBool>,
    values: Vec<f32>,
    /// Where it is listened to, as the panel shows it: a place for each of the usual formats.
    places: Vec<Option<String>>,
    hears_others: bool,
    smooth: f32,
    pub(super) is_on_top: bool,
    calibration: Option<CalibrationFile>,
    /// Name of that file, for people.
    calibration_name: Option<String>,
    /// The file that was named on the command line.
    named: Option<PathBuf>,
    /// The time that the last frame shows, and how many milliseconds later it was drawn, in the mean.
    shown_at: Instant,
    draw_ms: Option<f32>,
    /// When somebody last moved the face.
    moved_at: Option<Instant>,
    /// That frame is still being drawn.
    is_drawing: bool,
}

impl Live {
    /// What the command line says; without that nobody is listened to.
    pub(super) fn new(
        args: Option<&LiveOptions>,
        session: &Session,
        messages: &mut Messages,
        window: EventLoopProxy<Wake>,
    ) -> Result<Self> {
        let take = args.and_then(|args| args.record.as_deref()).map(Take::check).transpose()?;
        let is_told = Arc::new(AtomicBool::new(false));
        let tell = is_told.clone();
        // A flood wakes the window once for each frame.
        let wake = move || {
            if !tell.swap(true, Ordering::AcqRel) {
                // An error means that the window is closed.
                let _ = window.send_event(Wake::Packet);
            }
        };
        let pages = Pages::new(args.map_or(&[], |args| &args.page));
        let inbox = Inbox::open(args.map_or(&[], |args| &args.listen), pages, wake)?;
        let (smooth, hz) = args.map_or((0.0, 60.0), |args| (args.smooth, args.hz));
        let (calibrate, mirror) = args.map_or((false, false), |args| (args.calibrate, args.mirror));
        let mut follow = Follow::new(session.face.pack(), inbox, smooth, calibrate, mirror);
        if let Some(path) = args.and_then(|args| args.play.as_deref()) {
            follow.play(path, follow.secs(Instant::now()))?;
        }
        follow.places().for_each(crate::standard::tell);
        let sending = args.and_then(|args| args.send.as_ref());
        let mut live = Self {
            follow,
            take: take.map(|take| (take, Recorder::new(hz))),
            sending: sending.map(|to| Sending::new(&to.0)).transpose()?,
            tick_secs: 1.0 / hz,
            next_secs: 0.0,
            recorded_from_secs: None,
            is_told,
            values: Vec::new(),
            places: Vec::new(),
            hears_others: false,
            smooth,
            is_on_top: false,
            calibration: None,
            calibration_name: None,
            named: args.and_then(|args| args.calibration.clone()),
            shown_at: Instant::now(),
            draw_ms: None,
            moved_at: None,
            is_drawing: false,
        };
        let calibration = live.read_calibration(session);
        // One that nobody named must not keep the window from opening.
        match live.named {
            Some(_) => calibration?,
            None => messages.report(About::Live, CALIBRATION_NOT_READ, calibration),
        }
        live.name_places();
        live.hears_others = {
            let mut heard = live.follow.inbox.places().filter_map(|(_, place)| place.address());
            heard.any(|address| address.ip().is_unspecified())
        };
        Ok(live)
    }

    /// Another avatar follows.
    ///
    /// # Errors
    /// Its calibration cannot be read; it follows without one then.
    pub(super) fn set_pack(&mut self, session: &Session) -> Result<()> {
        self.follow.set_pack(session.face.pack());
        self.read_calibration(session)
    }

    fn read_calibration(&mut self, session: &Session) -> Result<()> {
        self.calibration = CalibrationFile::of(self.named.as_deref(), |name| session.files.kept(name));
        self.calibration_name = self.calibration.as_ref().map(|file| file.path().display().to_string());
        let read =
            self.calibration.as_ref().map_or_else(|| Ok(Calibration::default()), CalibrationFile::read);
        self.follow.receiver.set_calibration(read.as_ref().unwrap_or(&Calibration::default()));
        read.map(|_| ())
    }

    /// Takes what has arrived, and gives the face what it is now.
    pub(super) fn frame(&mut self, face: &mut Face) -> Result<()> {
        let began = Instant::now();
        self.is_told.store(false, Ordering::Release);
        let began_secs = self.follow.secs(began);
        if face.recording.is_none() {
            self.recorded_from_secs = None;
        }
        // What comes later than this tells the window of itself.
        while let Some(packet) = self.follow.inbox.take() {
            self.go(self.follow.secs(packet.at).min(began_secs), face)?;
            self.follow.take(&packet);
            if packet.at > began {
                break;
            }
        }
        self.shown_at = Instant::now();
        let now_secs = self.follow.secs(self.shown_at);
        self.go(now_secs, face)?;
        // What is kept is as it was sent; who looks sees it as early as possible.
        let is_kept = self.take.is_some() || self.sending.is_some() || face.recording.is_some();
        let lead_ms = self.draw_ms.filter(|_| !is_kept).unwrap_or_default();
        self.follow.receiver.settings.lead_secs = f64::from(lead_ms) / 1e3;
        self.follow.advance(now_secs)?;
        // Until somebody sends, keys and sliders have the face.
        if !self.show(face) {
            return Ok(());
        }
        if self.recorded_from_secs.is_none() {
            self.recorded_from_secs = face.begin_to_feed().map(|secs| now_secs - secs);
        }
        face.follow(&self.values)
    }

    /// Whether the controls are a sender's now, and if so, what they are.
    fn show(&mut self, face: &Face) -> bool {
        self.values.clear();
        self.values.extend_from_slice(face.performer.values());
        self.follow.apply(&mut self.values)
    }

    /// Records and sends what is due until then, each frame as it is at its own time.
    fn go(&mut self, until_secs: f64, face: &mut Face) -> Result<()> {
        self.next_secs = self.next_secs.max(until_secs - LONGEST_PAUSE_SECS);
        loop {
            let row_secs = self.recorded_from_secs.zip(face.next_row_secs()).map(|(from, row)| from + row);
            let ticks = self.take.is_some() || self.sending.is_some();
            let tick_secs = ticks.then_some(self.next_secs);
            let due = [row_secs, tick_secs].into_iter().flatten().min_by(f64::total_cmp);
            let Some(due) = due.filter(|due| *due <= until_secs) else { return Ok(()) };
            self.follow.advance(due)?;
            if row_secs.is_some_and(|row| row <= due) {
                // Of a face that has left, the neutral one comes once: the face has to take it here, too.
                if self.show(face) {
                    face.follow(&self.values)?;
                }
                face.feed(&self.values);
            }
            if tick_secs.is_some_and(|tick| tick <= due) {
                if let Some((_, recorder)) = &mut self.take {
                    recorder.add(self.follow.receiver.face());
                }
                if let Some(sending) = &mut self.sending {
                    sending.send(&self.follow, due);
                }
                self.next_secs += self.tick_secs;
            }
        }
    }

    /// When the next frame is to be drawn, should nothing arrive.
    pub(super) fn wakes_at(&self) -> Option<Instant> {
        self.follow.wakes_at().map(|secs| self.follow.instant(secs))
    }

    /// Somebody moves the face now.
    pub(super) fn moved(&mut self) {
        self.moved_at = Some(Instant::now());
    }

    /// Whether somebody has moved the face just before, and may go on at any moment: nobody who has just held
    /// still wants to wait for a picture that is drawn with all care.
    pub(super) fn may_go_on(&self) -> bool {
        self.moved_at.is_some_and(|moved| moved.elapsed() < STILL)
            && self.follow.receiver.senders().any(|sender| sender.is_chosen && sender.is_live)
    }

    /// A frame with a face that is driven has been handed over to be drawn.
    pub(super) fn drawn(&mut self, drawn: &Drawn) {
        if drawn.all || drawn.part {
            self.is_drawing = true;
            if !drawn.is_waited_for {
                self.finished(Some(Instant::now()));
            }
        }
    }

    /// The frame before was finished then, if that is known.
    pub(super) fn finished(&mut self, then: Option<Instant>) {
        let is_drawing = std::mem::take(&mut self.is_drawing);
        let passed = then.map(|then| then.saturating_duration_since(self.shown_at));
        // A window that is hidden meanwhile tells nothing of drawing.
        if let Some(passed) = passed.filter(|passed| is_drawing && *passed < LONGEST_DRAWING) {
            let ms = passed.as_secs_f32() * 1e3;
            self.draw_ms = Some(self.draw_ms.map_or(ms, |mean| mean + NEWEST * (ms - mean)));
        }
    }

    /// Writes what was recorded.
    pub(super) fn finish(&self, pack: &Pack) -> Result<()> {
        for sender in self.follow.receiver.senders() {
            crate::standard::tell(crate::live::line(&sender));
        }
        if let Some(ms) = self.draw_ms {
            crate::standard::tell(format_args!("a frame is drawn {ms:.1} ms after its time"));
        }
        self.take.as_ref().map_or(Ok(()), |(take, recorder)| take.write(recorder, pack))
    }

    /// Listens to one of the usual formats, or ends that.
    pub(super) fn listen(&mut self, inlet: usize, is_wanted: bool) -> Result<()> {
        let Some((protocol, ..)) = FORMATS.get(inlet) else { return Ok(()) };
        self.follow.inbox.silence(*protocol);
        let listen = usual(*protocol, self.hears_others).filter(|_| is_wanted);
        let begun = listen.map_or(Ok(()), |listen| self.follow.inbox.listen(listen));
        self.name_places();
        begun
    }

    /// Hears other computers, too, or this one alone: each format at the port that it has.
    ///
    /// # Errors
    /// That of the first format that is not heard any more; the others are.
    pub(super) fn hear_others(&mut self, hears_others: bool) -> Result<()> {
        self.hears_others = hears_others;
        let moved = self.follow.inbox.move_to(everywhere(hears_others));
        self.name_places();
        moved
    }

    /// Plays a recording from its beginning.
    pub(super) fn play(&mut self, path: &Path) -> Result<()> {
        self.follow.play(path, self.follow.secs(Instant::now()))
    }

    pub(super) fn set_smooth(&mut self, smooth: f32) {
        self.smooth = smooth;
        self.follow.set_smooth(smooth);
    }

    /// Calls what the face is now neutral.
    pub(super) fn calibrate(&mut self) -> Result<()> {
        let Some(calibration) = self.follow.receiver.calibrate() else {
            bail!("expected somebody who sends a face, found nobody")
        };
        self.keep(&calibration)
    }

    /// Takes the face as it is sent; how strong the avatar moves stays.
    pub(super) fn forget_calibration(&mut self) -> Result<()> {
        let receiver = &mut self.follow.receiver;
        let calibration = receiver.calibration().with_neutral(&avatar_live::Frame::default());
        receiver.set_calibration(&calibration);
        self.keep(&calibration)
    }

    /// Keeps what has been called neutral since this was asked last.
    pub(super) fn keep_calibration(&mut self) -> Result<()> {
        self.follow.calibrated().map_or(Ok(()), |calibration| self.keep(&calibration))
    }

    fn keep(&self, calibration: &Calibration) -> Result<()> {
        self.calibration.as_ref().map_or(Ok(()), |file| file.write(calibration))
    }

    fn name_places(&mut self) {
        let inbox = &self.follow.inbox;
        let place = |wanted| {
            let mut found = inbox.places().filter(|(protocol, _)| *protocol == wanted);
            found.next().map(|(_, place)| place.to_string())
        };
        self.places = FORMATS.into_iter().map(|(protocol, ..)| place(protocol)).collect();
    }

    /// What can be listened to, for the panel.
    pub(super) fn inlets(&self) -> [Inlet<'_>; FORMATS.len()] {
        let mut inlets = [Inlet { name: "", place: None }; FORMATS.len()];
        for ((inlet, (_, name, _)), place) in inlets.iter_mut().zip(&FORMATS).zip(&self.places) {
            *inlet = Inlet { name, place: place.as_deref() };
        }
        inlets
    }

    /// Lets one of the pages in that were turned away.
    pub(super) fn let_in(&self, page: usize) {
        self.follow.inbox.pages().let_in(page);
    }

    /// The pages that were turned away, for the panel.
    pub(super) fn turned_away(&self) -> Vec<String> {
        self.follow.inbox.pages().turned_away()
    }

    /// Who sends, for the panel.
    pub(super) fn senders(&self) -> Vec<LiveSender<'_>> {
        let senders = self.follow.receiver.senders().map(|sender| LiveSender {
            name: sender.name,
            protocol: sender.protocol.name(),
            is_followed: sender.is_chosen,
            is_live: sender.is_live,
            rate_hz: sender.rate_hz,
            received: sender.received,
            lost: sender.lost,
            late: sender.late,
            delay_ms: sender.delay_secs * 1e3,
        });
        senders.collect()
    }

    /// What the panel shows.
    pub(super) fn model<'a>(
        &'a self,
        inlets: &'a [Inlet<'a>],
        senders: &'a [LiveSender<'a>],
        turned_away: &'a [String],
    ) -> avatar_panel::Live<'a> {
        let receiver = &self.follow.receiver;
        avatar_panel::Live {
            inlets,
            hears_others: self.hears_others,
            turned_away,
            recording: self.follow.tape_name(),
            senders,
            is_choice: receiver.is_choice(),
            draw_ms: self.draw_ms,
            is_calibrated: receiver.calibration().has_neutral(),
            calibration_file: self.calibration_name.as_deref(),
            is_mirrored: receiver.is_mirrored(),
            smooth: self.smooth,
            is_on_top: self.is_on_top,
        }
    }
}
