//! Where the eyes look: one fixation after another, on targets and elsewhere, and the head after them.

use crate::Style;
use crate::anchor::Anchor;
use crate::chance::{Chance, Stream};
use crate::curves::{Steps, saccade, step};
use crate::parameters as p;

/// How many things a face may attend to at once.
pub const TARGETS: usize = 8;

/// Something to look at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Target {
    /// Where it is, in metres from the middle between the eyes: to the character's left, up, and forward, as
    /// its head is posed without life.
    pub position: [f64; 3],
    /// Metres a second by which it moves; it goes on so until it is told anew.
    pub velocity: [f64; 3],
    /// How often it is looked at, by the others' weights.
    pub weight: f64,
    /// Metres around it within which the eyes go to and fro: about 0.05 for a face, 0 for a point.
    pub size: f64,
}

impl Target {
    /// A point that keeps still, of weight 1.
    pub const fn point(position: [f64; 3]) -> Self {
        Self { position, velocity: [0.0; 3], weight: 1.0, size: 0.0 }
    }

    /// Someone's face that keeps still, of weight 1.
    pub const fn face(position: [f64; 3]) -> Self {
        Self { size: 0.05, ..Self::point(position) }
    }

    fn is_sound(&self) -> bool {
        let numbers = self.position.iter().chain(&self.velocity).chain([&self.weight, &self.size]);
        numbers.into_iter().all(|number| number.abs() < 1e6) && self.weight >= 0.0 && self.size >= 0.0
    }
}

/// The way from one anchor to the next.
#[derive(Clone, Copy, Debug)]
struct Shift {
    to: Anchor,
    /// The target that it goes to.
    target: Option<usize>,
    start: f64,
    secs: f64,
    peak: f64,
}

impl Shift {
    fn end(&self) -> f64 {
        self.start + self.secs.max(p::VERGENCE_SECS)
    }
}

/// A saccade that has been made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Saccade {
    /// When it began, in seconds.
    pub start_secs: f64,
    /// How long it takes, in seconds.
    pub duration_secs: f64,
    /// Degrees between its ends.
    pub degrees: f64,
    /// Its highest speed, in degrees a second.
    pub peak_speed: f64,
}

#[derive(Clone, Debug)]
pub(crate) struct Gaze {
    seed: u64,
    count: u64,
    micro_count: u64,
    /// What there is to look at, and when that was told.
    targets: [Option<(Target, f64)>; TARGETS],
    /// What is looked at, and which target that is.
    anchor: Anchor,
    target: Option<usize>,
    shift: Option<Shift>,
    micro: Steps<2>,
    head: Steps<2>,
    pub(crate) next: f64,
    pub(crate) next_micro: f64,
    pub(crate) next_head: f64,
    thinking: f64,
    latest: Option<Saccade>,
}

impl Gaze {
    pub(crate) fn new(seed: u64) -> Self {
        let mut chance = Chance::of(seed, Stream::Gaze, 0);
        Self {
            seed,
            count: 0,
            micro_count: 0,
            targets: [None; TARGETS],
            anchor: Anchor::ahead(),
            target: None,
            shift: None,
            micro: Steps::new(),
            head: Steps::new(),
            next: chance.between(0.2, 1.0),
            next_micro: chance.between(0.1, 0.7),
            next_head: p::HEAD_AGAIN_SECS,
            thinking: 0.0,
            latest: None,
        }
    }

    pub(crate) fn think(&mut self, share: f64) {
        if !share.is_nan() {
            self.thinking = share.clamp(0.0, 1.0);
        }
    }

    pub(crate) fn latest(&self) -> Option<Saccade> {
        self.latest
    }

    /// Yaw to the character's left, pitch up, and how far the eyes turn in, in degrees.
    pub(crate) fn value(&self, now: f64) -> [f64; 3] {
        let from = self.anchor.degrees(now);
        let Some(shift) = &self.shift else { return from };
        let since = now - shift.start;
        if since <= 0.0 {
            return from;
        }
        let to = shift.to.degrees(now);
        let (share, inward) = (saccade(since / shift.secs, shift.peak), step(since / p::VERGENCE_SECS));
        let between = |axis: usize, share: f64| from[axis] + share * (to[axis] - from[axis]);
        [between(0, share), between(1, share), between(2, inward)]
    }

    /// Small jumps in degrees, as [`Self::value`].
    pub(crate) fn micro(&self, now: f64) -> [f64; 2] {
        self.micro.value(now)
    }

    /// Degrees by which the head has turned to the character's left and up.
    pub(crate) fn head(&self, now: f64) -> [f64; 2] {
        self.head.value(now)
    }

    fn arrive(&mut self, now: f64) {
        if let Some(shift) = self.shift.filter(|shift| now >= shift.end()) {
            (self.anchor, self.target, self.shift) = (shift.to, shift.target, None);
        }
        self.anchor.settle(now);
    }

    /// Puts a target in a place of the list, moves the one that is there, or takes it away.
    pub(crate) fn attend(&mut self, place: usize, target: Option<Target>, now: f64) {
        let Some(slot) = self.targets.get_mut(place) else { return };
        let before = std::mem::replace(slot, target.filter(Target::is_sound).map(|target| (target, now)));
        let after = *slot;
        self.arrive(now);
        let is_shown = match &self.shift {
            Some(shift) => shift.target == Some(place),
            None => self.target == Some(place),
        };
        match (before, after) {
            (Some(_), Some((target, _))) if is_shown => {
                // On the way, too, what the eyes go to moves with the target.
                let anchor = self.shift.as_mut().map_or(&mut self.anchor, |shift| &mut shift.to);
                let jump = anchor.degrees_off(target.position, now);
                if jump < p::JUMP_DEGREES {
                    anchor.follow(target.position, target.velocity, now);
                } else {
                    self.next = self.next.min(now + p::REACTION_SECS);
                }
            }
            (Some(_), None) if is_shown => self.next = self.next.min(now + p::REACTION_SECS),
            (None, Some(_)) => self.next = self.next.min(now + p::REACTION_SECS),
            _ => {}
        }
    }

    /// The end of a fixation at `next`: the eyes go elsewhere. Returns the degrees of the saccade.
    pub(crate) fn happen(&mut self, style: &Style) -> f64 {
        let now = self.next;
        self.arrive(now);
        if let Some(shift) = self.shift {
            // A target has jumped while the eyes were still under way.
            self.next = shift.end();
            return 0.0;
        }
        self.count += 1;
        let mut chance = Chance::of(self.seed, Stream::Gaze, self.count);
        let (to, target, mean_secs) = self.choose(&mut chance, style, now);
        let (here, there) = (self.anchor.degrees(now), to.degrees(now));
        let degrees = libm::hypot(there[0] - here[0], there[1] - here[1]);
        // No two people, and no two saccades, are quite the same.
        let secs = (p::SACCADE_SECS + p::SACCADE_SECS_PER_DEGREE * degrees)
            * chance.between(p::SACCADE_VARIATION[0], p::SACCADE_VARIATION[1]);
        let speed = p::SACCADE_SPEED * (1.0 - libm::exp(-degrees / p::SACCADE_DEGREES));
        let peak = if degrees > 1e-9 { (speed * secs / degrees).clamp(1.2, 1.95) } else { 1.5 };
        let stay = chance.log_normal(mean_secs, p::FIXATION_SPREAD).max(p::FIXATION_LEAST_SECS);
        self.latest = Some(Saccade {
            start_secs: now,
            duration_secs: secs,
            degrees,
            peak_speed: peak * degrees / secs,
        });
        let shift = Shift { to, target, start: now, secs, peak };
        self.shift = Some(shift);
        self.next = now + secs + stay;
        self.turn_head(now, &there, style);
        degrees
    }

    /// What to look at next: where it is, which target that is, and for how many seconds in the mean.
    fn choose(&self, chance: &mut Chance, style: &Style, now: f64) -> (Anchor, Option<usize>, f64) {
        let stay = style.fixation_secs;
        let side = |chance: &mut Chance| if chance.happens(0.5) { 1.0 } else { -1.0 };
        let metres = |chance: &mut Chance| chance.between(p::GLANCE_METRES[0], p::GLANCE_METRES[1]);
        if chance.happens(p::AVERT_MOST * self.thinking) {
            let yaw = side(chance) * chance.between(p::AVERT_SIDE[0], p::AVERT_SIDE[1]);
            let pitch = match chance.happens(p::AVERT_IS_UP) {
                true => chance.between(p::AVERT_UP[0], p::AVERT_UP[1]),
                false => -chance.between(p::AVERT_DOWN[0], p::AVERT_DOWN[1]),
            };
            return (Anchor::toward(yaw, pitch, metres(chance)), None, p::AVERT_SECS);
        }
        if chance.happens(style.contact) {
            let listed = || (0..).zip(&self.targets).filter_map(|(place, target)| Some((place, (*target)?)));
            let total: f64 = listed().map(|(_, (target, _))| target.weight).sum();
            let mut left = chance.share() * total;
            let found = listed().find(|(_, (target, _))| {
                left -= target.weight;
                left < 0.0
            });
            let (place, target) = match found {
                Some((place, (target, told))) => {
                    let Target { position, velocity, .. } = target;
                    let moved = |axis: usize| position[axis] + velocity[axis] * (now - told);
                    (Some(place), Target { position: std::array::from_fn(moved), ..target })
                }
                // Someone who is talked to.
                None => (None, Target::face([0.0, 0.0, p::PARTNER_METRES])),
            };
            let offset = [chance.normal(), chance.normal()].map(|by| target.size * by.clamp(-1.5, 1.5));
            return (Anchor::on(&target.position, &target.velocity, offset, now), place, stay);
        }
        let [yaw, pitch, _] = self.anchor.degrees(now);
        let away = chance.exponential(style.glance_degrees).min(p::GLANCE_MOST);
        let angle = std::f64::consts::TAU * chance.share();
        let yaw = (p::GLANCE_BACK * yaw + away * libm::cos(angle)).clamp(-p::GLANCE_MOST, p::GLANCE_MOST);
        let upright = p::GLANCE_UPRIGHT;
        let pitch = p::GLANCE_BACK * pitch + upright * away * libm::sin(angle);
        let pitch = pitch.clamp(-upright * p::GLANCE_MOST, upright * p::GLANCE_MOST);
        (Anchor::toward(yaw, pitch, metres(chance)), None, p::GLANCE_STAY * stay)
    }

    /// The head is asked again at `next_head`: it follows what moves.
    pub(crate) fn look_after(&mut self, style: &Style) {
        let now = self.next_head;
        self.arrive(now);
        let anchor = self.shift.map_or(self.anchor, |shift| shift.to);
        if !anchor.is_still() {
            self.turn_head(now, &anchor.degrees(now + 0.5 * p::HEAD_SECS), style);
        }
        self.next_head = now + p::HEAD_AGAIN_SECS;
    }

    fn turn_head(&mut self, now: f64, toward: &[f64; 3], style: &Style) {
        let (small, large) = (p::HEAD_SMALL_SHARE, style.head_share);
        let free = p::HEAD_FREE_DEGREES;
        let share = |degrees: f64| {
            let beyond = (degrees.abs() - free).clamp(0.0, 90.0);
            (small * degrees.abs().min(free) + large * beyond).copysign(degrees)
        };
        let here = self.head.target();
        let by = [share(toward[0]) - here[0], share(toward[1]) - here[1]];
        let degrees = libm::hypot(by[0], by[1]);
        if degrees > p::HEAD_IDLE_DEGREES {
            let secs = p::HEAD_SECS + p::HEAD_SECS_PER_DEGREE * degrees;
            self.head.add(now, now + p::HEAD_LATER_SECS, secs, by);
        }
    }

    /// A micro-saccade at `next_micro`: about half of them take back what the ones before did.
    pub(crate) fn jump(&mut self) {
        let now = self.next_micro;
        self.micro_count += 1;
        let mut chance = Chance::of(self.seed, Stream::Micro, self.micro_count);
        let beyond = p::MICRO_SECS - p::MICRO_LEAST_SECS;
        self.next_micro = now + p::MICRO_LEAST_SECS + chance.exponential(beyond).min(60.0);
        let here = self.micro.target();
        let angle = std::f64::consts::TAU * chance.share();
        let by = [libm::cos(angle) - 2.0 * here[0], 0.6 * libm::sin(angle) - 2.0 * here[1]];
        let length = libm::hypot(by[0], by[1]).max(1e-9);
        let degrees = chance
            .log_normal(p::MICRO_MEAN_DEGREES, p::MICRO_SPREAD)
            .clamp(p::MICRO_DEGREES[0], p::MICRO_DEGREES[1]);
        let secs = p::SACCADE_SECS + p::SACCADE_SECS_PER_DEGREE * degrees;
        self.micro.add(now, now, secs, by.map(|by| by * degrees / length));
    }

    pub(crate) fn micro_count(&self) -> u64 {
        self.micro_count
    }
}
