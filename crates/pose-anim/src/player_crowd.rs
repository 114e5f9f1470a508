use crate::channel::{Channel, Cold};
use crate::player::press;
use crate::range::Range;
use crate::{AdvanceError, Clip, ControlTable, Jet, JumpError, Pace, Pose, UnknownFace};
use lanes::{LANES, Lanes, Simd, Wide64, Work, steps64};
use std::sync::Arc;

/// Moves the controls of many faces from pose to pose: a [`crate::Player`] for each, at a fraction of the
/// time.
///
/// Every control of every face moves as that of a player does which is pressed and advanced alike, with
/// the same guarantees. Nearly always a motion is a polynomial; those of [`LANES`] faces are computed at
/// once by the processor's vectors, and blocks of faces in which a control rests cost nothing. What a
/// polynomial cannot be (fades, transition functions, clips, delays, the first step after a press) is
/// computed as a player does, one control at a time.
///
/// A crowd has no clock, and only [`Self::new`] allocates.
///
/// ```
/// use pose_anim::{ControlTable, Player, PlayerCrowd, PoseSet};
///
/// let controls = ControlTable::default_face();
/// let poses = PoseSet::default_face(&controls);
/// let smile = poses.get("smile").ok_or("no such pose")?;
/// let mut crowd = PlayerCrowd::new(&controls, 1000);
/// let mut single = Player::new(&controls);
/// crowd.press(7, smile)?;
/// single.press(smile);
/// for _ in 0..10 {
///     crowd.advance(1.0 / 60.0)?;
///     single.advance(1.0 / 60.0)?;
/// }
/// let mut values = controls.defaults();
/// crowd.copy_values(7, &mut values)?;
/// assert_eq!(values, single.values());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct PlayerCrowd {
    faces: usize,
    /// One per control.
    paces: Vec<Pace>,
    ranges: Vec<Range>,
    /// By face, its controls. Where a motion is in `moves`, its age there is the one that counts.
    channels: Vec<Channel>,
    cold: Vec<Cold>,
    /// Which channels are not in `moves`, and their list.
    is_rare: Vec<bool>,
    rare: Vec<usize>,
    /// By block of faces, its controls.
    moves: Vec<MoveLanes>,
    values: Vec<Lanes>,
    confined: bool,
}

/// The polynomials of one control in [`LANES`] faces ([`crate::quintic::Quintic`]).
#[derive(Clone, Debug)]
struct MoveLanes {
    age_secs: Lanes<f64>,
    duration_secs: Lanes<f64>,
    /// `1 / duration`, 0 at rest.
    rate: Lanes<f64>,
    target: Lanes<f64>,
    c: [Lanes<f64>; 3],
    /// Whether all have arrived, and the values say so.
    sleeps: bool,
}

impl MoveLanes {
    const fn rest(value: f64) -> Self {
        let zero = Lanes::splat(0.0);
        Self {
            age_secs: zero,
            duration_secs: zero,
            rate: zero,
            target: Lanes::splat(value),
            c: [zero; 3],
            sleeps: true,
        }
    }
}

impl PlayerCrowd {
    /// This many faces, all of whose controls are at rest at their defaults.
    pub fn new(controls: &ControlTable, faces: usize) -> Self {
        let (count, blocks) = (controls.len(), faces.div_ceil(LANES));
        let table = controls.controls();
        let range = |control: &crate::Control| Range { min: control.min.into(), max: control.max.into() };
        let each = |_| table.iter().map(|control| Channel::rest(range(control), control.default.into()));
        let moves = |_| table.iter().map(|control| MoveLanes::rest(control.default.into()));
        Self {
            faces,
            paces: table.iter().map(|control| control.pace).collect(),
            ranges: table.iter().map(range).collect(),
            channels: (0..faces).flat_map(each).collect(),
            cold: (0..faces * count).map(|_| Cold::new()).collect(),
            is_rare: vec![false; faces * count],
            rare: Vec::with_capacity(faces * count),
            moves: (0..blocks).flat_map(moves).collect(),
            values: (0..blocks).flat_map(|_| table.iter().map(|c| Lanes::splat(c.default))).collect(),
            confined: true,
        }
    }

    /// The same crowd, whose values may leave their ranges as those of [`crate::Player::with_overshoot`].
    #[must_use]
    pub fn with_overshoot(self) -> Self {
        Self { confined: false, ..self }
    }

    /// Number of faces.
    pub fn len(&self) -> usize {
        self.faces
    }

    /// Whether there is no face at all.
    pub fn is_empty(&self) -> bool {
        self.faces == 0
    }

    /// Heads for a pose with one face, from now on, as [`crate::Player::press`].
    ///
    /// # Errors
    /// The crowd has no such face.
    pub fn press(&mut self, face: usize, pose: &Pose) -> Result<(), UnknownFace> {
        self.check(face)?;
        for (control, value) in &pose.values {
            let Some(pace) = self.paces.get(*control).copied() else { continue };
            self.change(face, *control, |channel, cold| press(pose, *control, *value, pace, channel, cold));
        }
        Ok(())
    }

    /// Plays a clip with one face from its start, from now on, as [`crate::Player::play`].
    ///
    /// # Errors
    /// The crowd has no such face.
    pub fn play(&mut self, face: usize, clip: &Arc<Clip>, fade_secs: Option<f64>) -> Result<(), UnknownFace> {
        self.check(face)?;
        for (index, track) in clip.tracks().iter().enumerate() {
            let Some(pace) = self.paces.get(track.control()).copied() else { continue };
            self.change(face, track.control(), |channel, cold| {
                channel.play(clip, index, pace, fade_secs, cold);
            });
        }
        Ok(())
    }

    /// Brings everything that moves in one face to rest, as [`crate::Player::stop`].
    ///
    /// # Errors
    /// The crowd has no such face.
    pub fn stop(&mut self, face: usize) -> Result<(), UnknownFace> {
        self.check(face)?;
        for control in 0..self.paces.len() {
            let pace = self.paces[control];
            self.change(face, control, |channel, cold| channel.stop(pace, cold));
        }
        Ok(())
    }

    /// Puts all controls of one face at rest at these values, at once, as [`crate::Player::jump_to`].
    ///
    /// # Errors
    /// The crowd has no such face, not one value per control, or a value that is not finite; then nothing
    /// changes.
    pub fn jump_to(&mut self, face: usize, values: &[f32]) -> Result<(), JumpError> {
        self.check(face)?;
        let (expected, found) = (self.paces.len(), values.len());
        if expected != found {
            return Err(JumpError::Length { expected, found });
        }
        if let Some(control) = values.iter().position(|value| !value.is_finite()) {
            return Err(JumpError::NotFinite { control, value: values[control] });
        }
        for (control, value) in values.iter().enumerate() {
            let range = self.ranges[control];
            let value = range.clamp(f64::from(*value));
            self.change(face, control, |channel, cold| {
                *channel = Channel::rest(range, value);
                cold.forget();
            });
            let (place, lane) = self.place(face, control);
            self.values[place][lane] = value as f32;
        }
        Ok(())
    }

    /// Lets time pass for all faces, as [`crate::Player::advance`].
    ///
    /// # Errors
    /// A negative time step or NaN; then nothing changes.
    pub fn advance(&mut self, dt_secs: f64) -> Result<(), AdvanceError> {
        AdvanceError::check(dt_secs)?;
        if dt_secs == 0.0 {
            return Ok(());
        }
        let ranges = self.confined.then_some(self.ranges.as_slice());
        lanes::run(Advance {
            dt_secs,
            ranges,
            count: self.paces.len(),
            moves: &mut self.moves,
            values: &mut self.values,
        });
        let mut next = 0;
        while let Some(&at) = self.rare.get(next) {
            if self.advance_rare(at, dt_secs) {
                next += 1;
            } else {
                self.rare.swap_remove(next);
            }
        }
        Ok(())
    }

    /// Advances a channel by itself. Returns whether it has to go on so; otherwise it is among the
    /// polynomials now.
    fn advance_rare(&mut self, at: usize, dt_secs: f64) -> bool {
        let (face, control) = (at / self.paces.len(), at % self.paces.len());
        let (place, lane) = self.place(face, control);
        let channel = &mut self.channels[at];
        if !channel.sleeps() {
            let state = channel.advance(dt_secs, &mut self.cold[at]);
            let state = if self.confined { self.ranges[control].confine(state) } else { state };
            self.values[place][lane] = state.value as f32;
        }
        let Some((quintic, age_secs)) = channel.quintic() else { return true };
        self.is_rare[at] = false;
        let moves = &mut self.moves[place];
        let duration_secs = quintic.duration_secs();
        moves.age_secs[lane] = age_secs;
        moves.duration_secs[lane] = duration_secs;
        moves.rate[lane] = if duration_secs > 0.0 { 1.0 / duration_secs } else { 0.0 };
        moves.target[lane] = quintic.target;
        for (slot, coefficient) in moves.c.iter_mut().zip(quintic.coefficients()) {
            slot[lane] = coefficient;
        }
        moves.sleeps = false;
        false
    }

    /// Values of all faces: by block of [`LANES`] faces, one per control. Lanes behind the last face are at
    /// their defaults.
    pub fn values(&self) -> &[Lanes] {
        &self.values
    }

    /// Writes the present values of one face, one per control, each in its range.
    ///
    /// # Errors
    /// The crowd has no such face. Values beyond the slices' common length are left alone.
    pub fn copy_values(&self, face: usize, out: &mut [f32]) -> Result<(), UnknownFace> {
        self.check(face)?;
        let block = &self.values[face / LANES * self.paces.len()..];
        for (slot, lanes) in out.iter_mut().take(self.paces.len()).zip(block) {
            *slot = lanes[face % LANES];
        }
        Ok(())
    }

    /// Value, velocity and acceleration of one control of one face; `None` if there is none.
    pub fn state(&self, face: usize, control: usize) -> Option<Jet> {
        let (channel, cold) = self.channel(face, control)?;
        let state = channel.state(cold);
        Some(if self.confined { channel.range().confine(state) } else { state })
    }

    /// Where one control of one face is heading, as [`crate::Player::target`]; `None` if there is none.
    pub fn target(&self, face: usize, control: usize) -> Option<f32> {
        let (channel, cold) = self.channel(face, control)?;
        Some(channel.target(cold) as f32)
    }

    /// Whether all controls of one face have arrived; also of a face that the crowd does not have.
    pub fn is_at_rest(&self, face: usize) -> bool {
        self.secs_to_rest(face) == 0.0
    }

    /// Seconds until all controls of one face have arrived, as [`crate::Player::secs_to_rest`].
    pub fn secs_to_rest(&self, face: usize) -> f64 {
        let channels = (0..self.paces.len()).filter_map(|control| self.channel(face, control));
        channels.map(|(channel, cold)| channel.remaining_secs(cold)).fold(0.0, f64::max)
    }

    fn check(&self, face: usize) -> Result<(), UnknownFace> {
        let faces = self.faces;
        if face < faces { Ok(()) } else { Err(UnknownFace { face, faces }) }
    }

    /// Where a control of a face is among the blocks: the place and the lane.
    fn place(&self, face: usize, control: usize) -> (usize, usize) {
        (face / LANES * self.paces.len() + control, face % LANES)
    }

    /// The channel as it is at this moment.
    fn channel(&self, face: usize, control: usize) -> Option<(Channel, &Cold)> {
        if face >= self.faces || control >= self.paces.len() {
            return None;
        }
        let at = face * self.paces.len() + control;
        let (place, lane) = self.place(face, control);
        let channel = &self.channels[at];
        let now = if self.is_rare[at] { channel.clone() } else { channel.at_age(self.age(place, lane)) };
        Some((now, &self.cold[at]))
    }

    /// The age of a polynomial. In blocks that sleep it stands still, at or behind the end.
    fn age(&self, place: usize, lane: usize) -> f64 {
        self.moves[place].age_secs[lane]
    }

    /// Changes a channel, which is computed by itself from now on until it is nothing but a polynomial. Both
    /// exist.
    fn change(&mut self, face: usize, control: usize, change: impl FnOnce(&mut Channel, &mut Cold)) {
        let at = face * self.paces.len() + control;
        let (place, lane) = self.place(face, control);
        if !self.is_rare[at] {
            self.channels[at] = self.channels[at].at_age(self.age(place, lane));
            self.is_rare[at] = true;
            self.rare.push(at);
            // Of no use any more, so it need not keep its block awake.
            self.moves[place].duration_secs[lane] = 0.0;
        }
        change(&mut self.channels[at], &mut self.cold[at]);
    }
}

/// The polynomials of [`PlayerCrowd::advance`], for vectors of some width.
struct Advance<'a> {
    dt_secs: f64,
    /// What values are kept in, if they are.
    ranges: Option<&'a [Range]>,
    count: usize,
    moves: &'a mut [MoveLanes],
    values: &'a mut [Lanes],
}

impl Work for Advance<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        const FREE: Range = Range { min: f64::NEG_INFINITY, max: f64::INFINITY };
        let count = self.count.max(1);
        for (moves, values) in self.moves.chunks_mut(count).zip(self.values.chunks_mut(count)) {
            for (control, (moves, values)) in moves.iter_mut().zip(values).enumerate() {
                if !moves.sleeps {
                    let range = self.ranges.and_then(|ranges| ranges.get(control));
                    moves.advance(simd, self.dt_secs, range.copied().unwrap_or(FREE), values);
                }
            }
        }
    }
}

impl MoveLanes {
    /// As [`crate::quintic::Quintic::at`], in the same order of operations.
    #[inline(always)]
    fn advance<S: Simd>(&mut self, simd: S, dt_secs: f64, range: Range, values: &mut Lanes) {
        let splat = |value| Wide64::splat(simd, value);
        let (dt_secs, one, min, max) = (splat(dt_secs), splat(1.0), splat(range.min), splat(range.max));
        let mut exact = Lanes::splat(0.0);
        let mut left_secs = Lanes::splat(0.0);
        for step in 0..steps64::<S>() {
            let load = |lanes: &Lanes<f64>| Wide64::load(simd, lanes, step);
            let age_secs = load(&self.age_secs) + dt_secs;
            age_secs.store(&mut self.age_secs, step);
            let duration_secs = load(&self.duration_secs);
            (duration_secs - age_secs).store(&mut left_secs, step);
            let (target, [c0, c1, c2]) =
                (load(&self.target), [load(&self.c[0]), load(&self.c[1]), load(&self.c[2])]);
            let s = age_secs * load(&self.rate);
            let u = one - s;
            let g = c0 + s * (c1 + s * c2);
            let value = age_secs.below(duration_secs, target + u * u * u * g, target);
            value.clamp(min, max).store(&mut exact, step);
        }
        let mut moves = false;
        for lane in 0..LANES {
            values[lane] = exact[lane] as f32;
            moves |= left_secs[lane] > 0.0;
        }
        self.sleeps = !moves;
    }
}
