//! A face that lives: events in the order of time, and what they make of it at every moment.

use crate::blink::Blinks;
use crate::body::{Breath, MOTIONS, Motion, Pupils};
use crate::curves::{Follow, positive};
use crate::gaze::Gaze;
use crate::parameters as p;
use crate::wiring::{CHANNELS, Channel, Wiring};
use crate::{Role, Saccade, Style, Target};
use pose_anim::ControlTable;

/// Places of the numbers that follow a style.
const AMOUNTS: usize = 8;
const FOLLOWED: usize = AMOUNTS + 2;

/// Why a face does not go on living.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum LifeError {
    /// A time step that is negative, longer than a day, or NaN.
    #[error("expected a step of 0 to 86,400 seconds, found {dt_secs}")]
    Step {
        /// The step.
        dt_secs: f64,
    },
    /// Another number of values than the avatar has controls.
    #[error("expected {expected} {what}, found {found}")]
    Length {
        /// Which slice.
        what: &'static str,
        /// Number of controls.
        expected: usize,
        /// Length of the slice.
        found: usize,
    },
}

/// How often things have happened, for statistics.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Blinks that have begun.
    pub blinks: u64,
    /// Micro-saccades.
    pub micro_saccades: u64,
    /// Breaths that have begun.
    pub breaths: u64,
}

/// What a face does by itself, as a layer over any values of its controls.
///
/// ```
/// use avatar_life::{Life, Style, Target};
/// use pose_anim::ControlTable;
///
/// let controls = ControlTable::default_face();
/// let mut life = Life::new(&controls, Style::preset("lively").unwrap_or_default(), 7);
/// life.attend(0, Some(Target::face([0.3, 0.0, 1.2])));
///
/// let posed = controls.defaults();
/// let mut values = posed.clone();
/// for _ in 0..60 {
///     life.advance(1.0 / 60.0)?;
///     life.apply(&posed, &mut values)?;
/// }
/// // The eyes, or the eyes and the head, have turned to the character's left.
/// let at = |name: &str| controls.index(name).map_or(0.0, |index| values[index]);
/// assert!(at("eye.left.lr") + at("head.turn") > 5.0);
/// # Ok::<(), avatar_life::LifeError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Life {
    now: f64,
    style: Style,
    role: Role,
    /// The style in this role.
    lived: Style,
    followed: Follow<FOLLOWED>,
    wiring: Wiring,
    count: usize,
    blinks: Blinks,
    gaze: Gaze,
    breath: Breath,
    motion: Motion,
    pupils: Pupils,
    channels: [f64; CHANNELS],
    pupil_mm: f64,
}

impl Life {
    /// The longest step of time in seconds, a day: what happens in it is gone through one by one.
    pub const LONGEST_SECS: f64 = 86_400.0;

    /// A face with these controls, at time 0. Faces of different seeds do different things; the same seed
    /// does the same on every machine. What the controls are called decides what they show; what an avatar
    /// lacks is left out.
    pub fn new(controls: &ControlTable, style: Style, seed: u64) -> Self {
        let style = style.sound();
        let mut life = Self {
            now: 0.0,
            followed: Follow::at(followed(&style), [0.0; FOLLOWED], p::AMOUNT_RATE, 0.0),
            wiring: Wiring::new(controls),
            count: controls.len(),
            blinks: Blinks::new(seed, &style),
            gaze: Gaze::new(seed),
            breath: Breath::new(seed, &style),
            motion: Motion::new(seed),
            pupils: Pupils::new(),
            channels: [0.0; CHANNELS],
            pupil_mm: 0.0,
            role: Role::Neither,
            lived: style,
            style,
        };
        life.look();
        life
    }

    /// Lives in another way from now on. Amounts change smoothly within about a second; rates hold for what
    /// happens next.
    pub fn set_style(&mut self, style: Style) {
        self.style = style.sound();
        self.live();
    }

    /// Takes a part in a talk, or gives it up: who speaks looks away more and blinks more often, who listens
    /// looks away less.
    pub fn set_role(&mut self, role: Role) {
        if role != self.role {
            self.role = role;
            self.live();
        }
    }

    /// Its part in a talk.
    pub fn role(&self) -> Role {
        self.role
    }

    fn live(&mut self) {
        self.lived = self.style.in_role(self.role);
        self.followed.lead(followed(&self.lived), [0.0; FOLLOWED], self.now);
    }

    /// How it lives.
    pub fn style(&self) -> &Style {
        &self.style
    }

    /// Puts a target of attention in one of the places 0 to 7 of the list, or takes it away. Where one is
    /// there already, it is the same one that has moved: the eyes follow it smoothly, or by a saccade where
    /// it has jumped. A new one is looked at soon. Targets with numbers that are not finite count as none.
    ///
    /// What moves is best told with its velocity: then results are the same however often it is told.
    pub fn attend(&mut self, place: usize, target: Option<Target>) {
        self.gaze.attend(place, target, self.now);
    }

    /// How much it thinks, 0 to 1: who thinks looks away.
    pub fn think(&mut self, share: f64) {
        self.gaze.think(share);
    }

    /// Tells that an utterance has ended: people often blink then.
    pub fn end_utterance(&mut self) {
        self.blinks.wish(self.now, p::UTTERANCE_BLINK, &self.lived);
    }

    /// How bright it is before the eyes, in candela a square metre: 100 in a lit room, 5,000 outdoors.
    pub fn set_light(&mut self, luminance: f64) {
        self.pupils.light(luminance, self.now);
    }

    /// How interesting it is what the face sees, -1 to 1: pupils widen.
    pub fn set_interest(&mut self, interest: f64) {
        self.pupils.interest(interest, self.now);
    }

    /// Lets time pass. Takes time that grows with what happens in it: some six events a second.
    ///
    /// # Errors
    /// A step that is negative, longer than a day, or NaN; then nothing changes.
    pub fn advance(&mut self, dt_secs: f64) -> Result<(), LifeError> {
        if !(0.0..=Self::LONGEST_SECS).contains(&dt_secs) {
            return Err(LifeError::Step { dt_secs });
        }
        let until = self.now + dt_secs;
        loop {
            let Gaze { next, next_micro, next_head, .. } = self.gaze;
            let (blink, breath) = (self.blinks.next, self.breath.next);
            let first = blink.min(breath).min(next).min(next_micro).min(next_head);
            if first > until {
                break;
            }
            if first == blink {
                self.blinks.happen(&self.lived);
            } else if first == breath {
                self.breath.happen(&self.lived);
            } else if first == next {
                let degrees = self.gaze.happen(&self.lived);
                let [none, all] = p::GAZE_BLINK_DEGREES;
                let probability = p::GAZE_BLINK_MOST * ((degrees - none) / (all - none)).clamp(0.0, 1.0);
                if probability > 0.0 {
                    self.blinks.wish(first, probability, &self.lived);
                }
            } else if first == next_micro {
                self.gaze.jump();
            } else {
                self.gaze.look_after(&self.lived);
            }
        }
        self.now = until;
        self.look();
        Ok(())
    }

    /// All channels at this moment.
    fn look(&mut self) {
        let now = self.now;
        self.followed.settle(now);
        let [blinks, gaze, micro, head, sway, brows, breathing, pupils, droop, sway_degrees] =
            self.followed.value(now);
        let blink = self.blinks.value(now);
        let [yaw, pitch, inward] = self.gaze.value(now);
        let jumps = self.gaze.micro(now);
        let after = self.gaze.head(now);
        let air = breathing * self.breath.value(now);
        let [turn, bow, bend, inner, left, right, unrest]: [f64; MOTIONS] = self.motion.values(now);
        let sway = sway * sway_degrees;

        let head_turn = head * after[0] + sway * turn;
        let head_up = head * after[1] + p::SWAY_NOD * sway * bow + p::BREATH_HEAD * air;
        // Eyes keep on what they look at while the head moves.
        let eye_yaw = gaze * (yaw - head_turn) + micro * jumps[0];
        let eye_pitch = gaze * (pitch - head_up) + micro * jumps[1] - p::BLINK_EYES_DOWN * blinks * blink;
        let half = gaze * 0.5 * inward + p::BLINK_EYES_IN * blinks * blink;
        let raised = brows * p::BROW_PER_DEGREE * positive(pitch - p::BROW_FROM_DEGREES, 4.0);
        let brow = |motion: f64| brows * p::BROW_WEIGHT * 2.0 * motion + raised;

        use Channel::*;
        let mut put = |channel: Channel, value: f64| self.channels[channel as usize] = value;
        put(Closed, 1.0 - (1.0 - blinks * blink) * (1.0 - droop));
        put(LeftEyeYaw, eye_yaw - half);
        put(RightEyeYaw, eye_yaw + half);
        put(EyePitch, eye_pitch);
        put(HeadTurn, head_turn);
        put(HeadBow, -head_up);
        put(HeadBend, sway * bend);
        put(BrowsInner, brow(inner));
        let outer = |own: f64| brow(p::BROW_OUTER[0] * inner + p::BROW_OUTER[1] * own);
        put(BrowLeft, outer(left));
        put(BrowRight, outer(right));
        put(Breath, air);
        let wide = self.pupils.value(now) + p::PUPIL_UNREST * unrest;
        let in_room = self.pupils.in_room();
        let wide = in_room + pupils * (wide - in_room);
        put(Pupils, (wide - in_room) / 6.0);
        self.pupil_mm = wide;
    }

    /// Puts life on top of values of all controls, such as those of a
    /// [`Player`](pose_anim::Player): lids close from where they are, everything else is added, and bent
    /// smoothly where it would leave the control's range ([`pose_anim::soft_sum`]). Both slices have one
    /// value per control.
    ///
    /// # Errors
    /// A slice of another length; then nothing is written.
    pub fn apply(&self, below: &[f32], out: &mut [f32]) -> Result<(), LifeError> {
        for (what, found) in [("values", below.len()), ("values to be written", out.len())] {
            if found != self.count {
                return Err(LifeError::Length { what, expected: self.count, found });
            }
        }
        out.copy_from_slice(below);
        self.apply_in_place(out)
    }

    /// As [`Self::apply`], over values that stand where the result is written.
    ///
    /// # Errors
    /// A slice of another length; then nothing is written.
    pub fn apply_in_place(&self, values: &mut [f32]) -> Result<(), LifeError> {
        if values.len() != self.count {
            let (expected, found) = (self.count, values.len());
            return Err(LifeError::Length { what: "values", expected, found });
        }
        self.wiring.apply(&self.channels, values);
        Ok(())
    }

    /// The value of one control over a value below, in full precision. A control that life does not move
    /// keeps its value.
    pub fn value(&self, control: usize, below: f64) -> f64 {
        self.wiring.value(&self.channels, control, below)
    }

    /// The controls that life moves.
    pub fn controls(&self) -> impl ExactSizeIterator<Item = usize> {
        self.wiring.controls()
    }

    /// Seconds since it was made.
    pub fn time_secs(&self) -> f64 {
        self.now
    }

    /// The width of the pupils in millimetres.
    pub fn pupil_mm(&self) -> f64 {
        self.pupil_mm
    }

    /// Share of the way to closed lids, 0 to 1.
    pub fn closed(&self) -> f64 {
        self.channels[Channel::Closed as usize]
    }

    /// Degrees to which the left and the right eye are turned in the head: each to the character's left, and
    /// up.
    pub fn eyes(&self) -> [[f64; 2]; 2] {
        let at = |channel: Channel| self.channels[channel as usize];
        let up = at(Channel::EyePitch);
        [[at(Channel::LeftEyeYaw), up], [at(Channel::RightEyeYaw), up]]
    }

    /// Degrees by which the head is turned, bowed and bent, as `head.turn`, `head.bow` and `head.bend`.
    pub fn head(&self) -> [f64; 3] {
        [Channel::HeadTurn, Channel::HeadBow, Channel::HeadBend].map(|one| self.channels[one as usize])
    }

    /// Air that is in, about 0 to 1: for chests and shoulders of avatars that have them.
    pub fn breath(&self) -> f64 {
        self.channels[Channel::Breath as usize]
    }

    /// The saccade that began last.
    pub fn latest_saccade(&self) -> Option<Saccade> {
        self.gaze.latest()
    }

    /// How often things have happened.
    pub fn counts(&self) -> Counts {
        Counts {
            blinks: self.blinks.count(),
            micro_saccades: self.gaze.micro_count(),
            breaths: self.breath.count(),
        }
    }
}

fn followed(style: &Style) -> [f64; FOLLOWED] {
    let mut all = [0.0; FOLLOWED];
    all[..AMOUNTS].copy_from_slice(&style.amounts.clamped());
    (all[AMOUNTS], all[AMOUNTS + 1]) = (style.droop, style.sway_degrees);
    all
}
