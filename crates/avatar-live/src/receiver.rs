use crate::bucket::Gate;
use crate::channel::{CHANNELS, channels};
use crate::lag::{Step, ThreeLags};
use crate::sender::{Sender, UNSEEN, is_shown_as, shown};
use crate::{
    Calibration, DecodeError, Frame, IFacialMocap, LiveLink, MediaPipe, Protocol, Settings, Status, Vmc,
};
use core::net::SocketAddr;

/// So many senders are known at a time.
const SENDERS: usize = 8;
/// Who has been silent for so long gives its place to another one.
const SILENT_SECS: f64 = 10.0;
/// Who is followed without having been chosen is let go after so long without a face.
const LET_GO_SECS: f64 = 3.0;
/// Steps of time are no longer, so that gaps are seen where they begin.
const LONGEST_STEP_SECS: f64 = 1.0 / 60.0;
/// After a longer pause the face goes on as if less had passed.
const LONGEST_PAUSE_SECS: f64 = 2.0;

/// What became of a packet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Received {
    /// Place of its sender in [`Receiver::senders`].
    pub sender: usize,
    /// The frame that it completed.
    pub frame: Option<Frame>,
}

/// Why a packet was not used.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Refused {
    /// It is larger than packets of its kind are.
    #[error("expected at most {limit} bytes, found {found}")]
    TooLong {
        /// The largest packet.
        limit: usize,
        /// Its size.
        found: usize,
    },
    /// Its source has sent too much of late, or there are too many sources.
    #[error("expected at most 4 MB a second from each of 16 sources, found more")]
    TooMuch,
    /// There are too many senders that are heard.
    #[error("expected at most 8 senders, found another one")]
    TooManySenders,
    /// It is no packet of its kind.
    #[error(transparent)]
    Unreadable(#[from] DecodeError),
    /// It is well-formed, but nothing in it is known.
    #[error("expected a message about a face, found others")]
    Unknown,
}

/// Several senders of faces, of which one is followed.
///
/// ```
/// use avatar_live::{LiveLink, FrameTime, Protocol, Receiver, Settings};
/// let mut values = [0.0; 61];
/// values[17] = 0.5; // jawOpen
/// let mut receiver = Receiver::new(Settings::default());
/// for frame in 0..30 {
///     let now_secs = f64::from(frame) / 60.0;
///     let time = Some(FrameTime { frame, part: 0.0, numerator: 60, denominator: 1 });
///     let mut packet = Vec::new();
///     LiveLink { device: "phone", subject: "Ann", time, values: Some(values) }.encode(&mut packet);
///     receiver.receive(now_secs, ([127, 0, 0, 1], 11111).into(), Protocol::LiveLink, &packet)?;
///     receiver.advance(now_secs);
/// }
/// assert!(receiver.face().named("jawOpen") > Some(0.3)); // it comes in gently
/// assert_eq!(receiver.senders().next().map(|sender| sender.name), Some("Ann"));
/// # Ok::<(), avatar_live::Refused>(())
/// ```
#[derive(Debug)]
pub struct Receiver {
    /// How the face follows; may be changed at any time.
    pub settings: Settings,
    gate: Gate,
    senders: Vec<Sender>,
    /// The sender that is followed.
    chosen: Option<usize>,
    /// Whether that is somebody's wish.
    is_wish: bool,
    is_mirrored: bool,
    mirror: ThreeLags,
    /// Of senders that are yet to come.
    calibration: Calibration,
    face: Frame,
    now_secs: Option<f64>,
}

impl Receiver {
    /// Nobody has sent anything yet: the face is neutral.
    pub fn new(settings: Settings) -> Self {
        Self {
            settings,
            gate: Gate::default(),
            senders: Vec::with_capacity(SENDERS),
            chosen: None,
            is_wish: false,
            is_mirrored: false,
            mirror: ThreeLags::at(0.0),
            calibration: Calibration::default(),
            face: Frame::default(),
            now_secs: None,
        }
    }

    /// Takes a packet that arrived at a time of our clock, in seconds, from an address. Times do not go back.
    ///
    /// # Errors
    /// See [`Refused`]. The face does not change then; of a packet of VMC, what stands before the mistake
    /// counts in the next frame.
    pub fn receive(
        &mut self,
        now_secs: f64,
        origin: SocketAddr,
        protocol: Protocol,
        packet: &[u8],
    ) -> Result<Received, Refused> {
        let limit = protocol.limit();
        if packet.len() > limit {
            return Err(Refused::TooLong { limit, found: packet.len() });
        }
        if !self.gate.admits(now_secs, origin, packet.len()) {
            return Err(Refused::TooMuch);
        }
        match protocol {
            Protocol::LiveLink => {
                let read = LiveLink::decode(packet)?;
                self.accept(now_secs, origin, protocol, [read.device, read.subject], &read.frame())
            }
            Protocol::IFacialMocap => {
                let frame = IFacialMocap::decode(packet)?;
                self.accept(now_secs, origin, protocol, ["", ""], &frame)
            }
            Protocol::MediaPipe => {
                let known = self.find(origin, protocol, ["", ""]);
                let read = known.map(|(_, sender)| sender.mediapipe.read(packet));
                let frame = read.unwrap_or_else(|| MediaPipe::decode(packet))?;
                self.accept(now_secs, origin, protocol, ["", ""], &frame)
            }
            Protocol::Vmc => self.vmc(now_secs, origin, packet),
            Protocol::Frames => Err(Refused::Unknown),
        }
    }

    /// Takes a frame from elsewhere, such as a recording, of a sender of this name.
    ///
    /// # Errors
    /// If there are too many senders.
    pub fn push(&mut self, now_secs: f64, name: &str, frame: &Frame) -> Result<Received, Refused> {
        let origin = SocketAddr::from(([127, 0, 0, 1], 0));
        self.accept(now_secs, origin, Protocol::Frames, ["", name], frame)
    }

    fn vmc(&mut self, now_secs: f64, origin: SocketAddr, packet: &[u8]) -> Result<Received, Refused> {
        let known = self.find(origin, Protocol::Vmc, ["", ""]);
        let (place, frame) = match known {
            Some((place, sender)) => {
                let (frame, understood) = sender.vmc.read(packet)?;
                if understood == 0 {
                    return Err(Refused::Unknown);
                }
                (place, frame)
            }
            None => {
                // Only who says something that is understood becomes a sender.
                let mut vmc = Vmc::default();
                let (frame, understood) = vmc.read(packet)?;
                if understood == 0 {
                    return Err(Refused::Unknown);
                }
                let (place, sender) = self.add(now_secs, origin, Protocol::Vmc, ["", ""])?;
                sender.vmc = vmc;
                (place, frame)
            }
        };
        let Some(frame) = frame else {
            if let Some(sender) = self.senders.get_mut(place) {
                sender.seen_secs = now_secs;
            }
            return Ok(Received { sender: place, frame: None });
        };
        self.take(now_secs, place, &frame)
    }

    fn accept(
        &mut self,
        now_secs: f64,
        origin: SocketAddr,
        protocol: Protocol,
        names: [&str; 2],
        frame: &Frame,
    ) -> Result<Received, Refused> {
        let place = match self.find(origin, protocol, names) {
            Some((place, _)) => place,
            None => self.add(now_secs, origin, protocol, names)?.0,
        };
        self.take(now_secs, place, frame)
    }

    fn take(&mut self, now_secs: f64, place: usize, frame: &Frame) -> Result<Received, Refused> {
        // What was before the packet is not changed by it.
        if self.now_secs.is_some_and(|before| now_secs - before > LONGEST_STEP_SECS) {
            self.advance(now_secs);
        }
        if let Some(sender) = self.senders.get_mut(place) {
            sender.accept(now_secs, frame, &self.settings);
        }
        Ok(Received { sender: place, frame: Some(*frame) })
    }

    /// A sender is known by its protocol, address and names; a phone's port may change.
    fn find(
        &mut self,
        origin: SocketAddr,
        protocol: Protocol,
        [device, name]: [&str; 2],
    ) -> Option<(usize, &mut Sender)> {
        self.senders.iter_mut().enumerate().find(|(_, sender)| {
            let has_names = !name.is_empty() || !device.is_empty();
            sender.protocol == protocol
                && sender.origin.ip() == origin.ip()
                && if has_names {
                    *sender.device == *device && is_shown_as(name, &sender.name)
                } else {
                    sender.origin.port() == origin.port()
                }
        })
    }

    fn add(
        &mut self,
        now_secs: f64,
        origin: SocketAddr,
        protocol: Protocol,
        [device, name]: [&str; 2],
    ) -> Result<(usize, &mut Sender), Refused> {
        let shown: String = match name.is_empty() {
            true => format!("{protocol} {origin}"),
            false => shown(name).collect(),
        };
        let mut sender = Sender::new(shown.into(), device.into(), protocol, origin);
        sender.motion.calibration = self.calibration;
        let place = if self.senders.len() < SENDERS {
            self.senders.push(sender);
            self.senders.len() - 1
        } else {
            let followed = self.chosen;
            let is_silent = |(place, old): &(usize, &Sender)| {
                now_secs - old.seen_secs > SILENT_SECS && Some(*place) != followed
            };
            let (place, _) =
                self.senders.iter().enumerate().find(is_silent).ok_or(Refused::TooManySenders)?;
            if let Some(old) = self.senders.get_mut(place) {
                *old = sender;
            }
            place
        };
        self.senders.get_mut(place).map(|sender| (place, sender)).ok_or(Refused::TooManySenders)
    }

    /// Goes to a time of our clock, in seconds, and returns the face there. Times do not go back.
    pub fn advance(&mut self, now_secs: f64) -> &Frame {
        let before = self.now_secs.unwrap_or(now_secs);
        if !now_secs.is_finite() || now_secs < before {
            return &self.face;
        }
        self.now_secs = Some(now_secs);
        self.follow(now_secs);
        let passed = (now_secs - before).min(LONGEST_PAUSE_SECS);
        let steps = (passed / LONGEST_STEP_SECS).ceil().max(1.0);
        let dt_secs = passed / steps;
        for step in (0..steps as u32).rev() {
            let at_secs = now_secs - f64::from(step) * dt_secs;
            for (place, sender) in self.senders.iter_mut().enumerate() {
                sender.advance(at_secs, dt_secs, self.chosen == Some(place), &self.settings);
            }
            let mirror = if self.is_mirrored { 1.0 } else { 0.0 };
            self.mirror.go(&Step::new(3.0 / self.settings.ease_secs.max(1e-3), dt_secs), mirror);
        }
        self.mix();
        &self.face
    }

    /// Follows whoever sends a face, unless somebody was chosen.
    fn follow(&mut self, now_secs: f64) {
        let is_heard = |sender: &Sender| now_secs - sender.face_secs < LET_GO_SECS;
        let is_good = self.chosen.and_then(|place| self.senders.get(place)).is_some_and(is_heard);
        if !self.is_wish && !is_good {
            let live = self.senders.iter().position(|sender| sender.is_live(now_secs, &self.settings));
            self.chosen = live.or(self.chosen);
        }
    }

    fn mix(&mut self) {
        let mut values = [0.0f64; CHANNELS];
        let mut has = [false; CHANNELS];
        for sender in self.senders.iter().filter(|sender| sender.share() > 0.0) {
            for (channel, _) in sender.has.iter() {
                if let (Some(value), Some(has)) = (values.get_mut(channel), has.get_mut(channel)) {
                    *value += sender.share() * sender.motion.value(channel);
                    *has = true;
                }
            }
        }
        let mirror = self.mirror.value();
        self.face = Frame::at(self.now_secs);
        for (index, channel) in channels().iter().enumerate() {
            let own = values.get(index).copied().unwrap_or_default();
            let other = values.get(channel.mirrored).copied().unwrap_or_default();
            if has.get(index) == Some(&true) || has.get(channel.mirrored) == Some(&true) {
                let mirrored = other * f64::from(channel.mirror_sign);
                self.face.set(index, (own + (mirrored - own) * mirror) as f32);
            }
        }
    }

    /// The face at the time of the last [`Self::advance`]: a value for each channel that the senders in it
    /// have.
    pub fn face(&self) -> &Frame {
        &self.face
    }

    /// How the senders are doing.
    pub fn senders(&self) -> impl ExactSizeIterator<Item = Status<'_>> {
        let now_secs = self.now_secs.unwrap_or_default();
        self.senders
            .iter()
            .enumerate()
            .map(move |(place, sender)| sender.status(now_secs, self.chosen == Some(place), &self.settings))
    }

    /// Follows the sender at this place of [`Self::senders`] from now on; `None` whoever sends a face.
    pub fn choose(&mut self, sender: Option<usize>) {
        self.is_wish = sender.is_some();
        self.chosen = sender.or(self.chosen);
    }

    /// Whether the sender that is followed was chosen by [`Self::choose`].
    pub fn is_choice(&self) -> bool {
        self.is_wish
    }

    /// Whether the face is its mirror image, left for right.
    pub fn is_mirrored(&self) -> bool {
        self.is_mirrored
    }

    /// Mirrors the face, or does not.
    pub fn set_mirrored(&mut self, is_mirrored: bool) {
        self.is_mirrored = is_mirrored;
    }

    /// Calls the face of the sender that is followed neutral, as it was in the last half second. Returns what
    /// [`Self::set_calibration`] would give it, to be kept; `None` if there is no face.
    pub fn calibrate(&mut self) -> Option<Calibration> {
        let sender = self.senders.get_mut(self.chosen?)?;
        sender.calibrate().then_some(sender.motion.calibration)
    }

    /// How the sender that is followed is calibrated; without one, how senders will be.
    pub fn calibration(&self) -> &Calibration {
        let chosen = self.chosen.and_then(|place| self.senders.get(place));
        chosen.map_or(&self.calibration, |sender| &sender.motion.calibration)
    }

    /// Calibrates all senders, also those that are yet to come.
    pub fn set_calibration(&mut self, calibration: &Calibration) {
        self.calibration = *calibration;
        self.senders.iter_mut().for_each(|sender| sender.motion.calibration = *calibration);
    }

    /// When [`Self::advance`] is to be called again, should no packet arrive: `None` for never, since the
    /// face rests. Whoever draws need not draw until then.
    pub fn wakes_at(&self) -> Option<f64> {
        let now_secs = self.now_secs?;
        let mirror = if self.is_mirrored { 1.0 } else { 0.0 };
        if !self.mirror.is_at(mirror, UNSEEN) && self.senders.iter().any(|sender| sender.share() > 0.0) {
            return Some(now_secs);
        }
        let senders = self.senders.iter().enumerate();
        let times = senders.filter_map(|(place, sender)| {
            sender.rests_until(now_secs, self.chosen == Some(place), &self.settings)
        });
        times.min_by(f64::total_cmp)
    }
}
