use crate::channel::{Channel, Cold, MoveSpec};
use crate::range::Range;
use crate::{AdvanceError, Clip, ControlTable, Jet, JumpError, Pace, Pose, Wrap};
use std::sync::Arc;

/// Moves the controls of one face from pose to pose.
///
/// A press sends controls towards a pose from wherever they are and however they move. Value, velocity and
/// acceleration of every control are continuous at every press, every value is in its control's range all the
/// time, and after its duration each control has exactly the pose's value, at rest. The state is a closed
/// function of the time since the last press: how that time is cut into steps does not matter.
///
/// A player has no clock: time passes in [`Self::advance`] only, and a press happens between two advances.
/// Neither allocates.
#[derive(Clone, Debug)]
pub struct Player {
    channels: Vec<Channel>,
    cold: Vec<Cold>,
    paces: Vec<Pace>,
    values: Vec<f32>,
    velocities: Vec<f32>,
    accelerations: Vec<f32>,
    confined: bool,
}

impl Player {
    /// All controls at rest at their defaults.
    pub fn new(controls: &ControlTable) -> Self {
        let channel = |control: &crate::Control| {
            let range = Range { min: control.min.into(), max: control.max.into() };
            Channel::rest(range, control.default.into())
        };
        Self {
            channels: controls.controls().iter().map(channel).collect(),
            cold: controls.controls().iter().map(|_| Cold::new()).collect(),
            paces: controls.controls().iter().map(|control| control.pace).collect(),
            values: controls.defaults(),
            velocities: vec![0.0; controls.len()],
            accelerations: vec![0.0; controls.len()],
            confined: true,
        }
    }

    /// The same player, whose values may leave their ranges where a transition function overshoots on purpose
    /// (back, elastic). Without this, such a value rests at the end of its range for a while, so its velocity
    /// jumps.
    #[must_use]
    pub fn with_overshoot(self) -> Self {
        Self { confined: false, ..self }
    }

    /// Heads for a pose, from now on. The controls that the pose leaves out go on with whatever they do.
    ///
    /// Takes any pose: values are clamped to the ranges, and a control that does not exist or a value that is
    /// not finite is ignored, as is a transition that is not sound ([`crate::Easing::is_sound`]). Durations,
    /// after their factor, are clamped to 0.001 to 3600 s; delays to 0 to 3600 s. NaN means the default: the
    /// control's own pace, no delay. Poses that were read from a text are within these limits already.
    pub fn press(&mut self, pose: &Pose) {
        for (control, value) in &pose.values {
            let (Some(channel), Some(cold)) = (self.channels.get_mut(*control), self.cold.get_mut(*control))
            else {
                continue;
            };
            let Some(pace) = self.paces.get(*control) else { continue };
            press(pose, *control, *value, *pace, channel, cold);
        }
    }

    /// Plays a clip from its start, from now on: every control that it has a track for fades into it from
    /// whatever it does, in `fade_secs` or, with `None`, in the time that a move to the clip's start takes;
    /// the others go on. A press interrupts it as any motion, and a clip that ends at speed comes to rest
    /// smoothly.
    ///
    /// The motion is as smooth as the clip is: a track with corners or jumps keeps them, and so do the seams
    /// of a clip that repeats itself ([`crate::Wrap`]). The fade takes 0.001 to 3600 s, so 0 means 1 ms.
    pub fn play(&mut self, clip: &Arc<Clip>, fade_secs: Option<f64>) {
        for (index, track) in clip.tracks().iter().enumerate() {
            let control = track.control();
            let (Some(channel), Some(cold)) = (self.channels.get_mut(control), self.cold.get_mut(control))
            else {
                continue;
            };
            let Some(pace) = self.paces.get(control) else { continue };
            channel.play(clip, index, *pace, fade_secs, cold);
        }
    }

    /// Brings everything that moves to rest where it is, as soon as is smooth; drops what waits.
    pub fn stop(&mut self) {
        for ((channel, cold), pace) in self.channels.iter_mut().zip(&mut self.cold).zip(&self.paces) {
            channel.stop(*pace, cold);
        }
    }

    /// Lets time pass. 0 changes nothing; enough of it (even infinity) brings every control to its target. A
    /// clip that repeats has no target: it goes on from its phase at that time, and after an infinite time
    /// from its start.
    ///
    /// # Errors
    /// A negative time step or NaN; then nothing changes.
    pub fn advance(&mut self, dt_secs: f64) -> Result<(), AdvanceError> {
        AdvanceError::check(dt_secs)?;
        if dt_secs == 0.0 {
            // Not even by rounding: just after a press, the new motion repeats the old state up to the last
            // bit.
            return Ok(());
        }
        self.advance_and(dt_secs, |_, _| ());
        Ok(())
    }

    /// Lets a time above 0 pass, and calls `look` with every control's new state before it is clamped.
    #[inline]
    pub(crate) fn advance_and(&mut self, dt_secs: f64, mut look: impl FnMut(usize, Jet)) {
        let outputs = self.values.iter_mut().zip(&mut self.velocities).zip(&mut self.accelerations);
        let channels = self.channels.iter_mut().zip(&mut self.cold).enumerate();
        for ((index, (channel, cold)), ((value, velocity), acceleration)) in channels.zip(outputs) {
            if channel.sleeps() {
                look(index, channel.at_rest());
                continue;
            }
            let state = channel.advance(dt_secs, cold);
            look(index, state);
            let state = if self.confined { channel.range().confine(state) } else { state };
            *value = state.value as f32;
            *velocity = state.velocity as f32;
            *acceleration = state.acceleration as f32;
        }
    }

    /// Lets the same time pass for many players.
    ///
    /// # Errors
    /// As [`Self::advance`]; then none of them changes.
    pub fn advance_all(players: &mut [Self], dt_secs: f64) -> Result<(), AdvanceError> {
        AdvanceError::check(dt_secs)?;
        players.iter_mut().try_for_each(|player| player.advance(dt_secs))
    }

    /// Puts all controls at rest at these values, at once; they are clamped to the ranges.
    ///
    /// # Errors
    /// Not one value per control, or a value that is not finite; then nothing changes.
    pub fn jump_to(&mut self, values: &[f32]) -> Result<(), JumpError> {
        let (expected, found) = (self.channels.len(), values.len());
        if expected != found {
            return Err(JumpError::Length { expected, found });
        }
        if let Some(control) = values.iter().position(|value| !value.is_finite()) {
            return Err(JumpError::NotFinite { control, value: values[control] });
        }
        let channels = self.channels.iter_mut().zip(&mut self.cold).zip(&mut self.values);
        for (((channel, cold), shown), value) in channels.zip(values) {
            let range = channel.range();
            let value = range.clamp(f64::from(*value));
            *channel = Channel::rest(range, value);
            // It may be the last owner of a clip.
            cold.forget();
            *shown = value as f32;
        }
        self.velocities.fill(0.0);
        self.accelerations.fill(0.0);
        Ok(())
    }

    /// Present values, one per control, each in its range.
    pub fn values(&self) -> &[f32] {
        &self.values
    }

    /// Where every control is heading, in the order of the table: the value at which it comes to rest if
    /// nothing else is pressed. A control that a clip moves heads for no value of its own; it has its present
    /// one.
    pub fn targets(&self) -> impl ExactSizeIterator<Item = f32> {
        self.channels.iter().zip(&self.cold).map(|(channel, cold)| channel.target(cold) as f32)
    }

    /// Where one control is heading, as [`Self::targets`]; `None` if there is no such control.
    pub fn target(&self, control: usize) -> Option<f32> {
        Some(self.channels.get(control)?.target(self.cold.get(control)?) as f32)
    }

    /// Where a clip stands that was handed to [`Self::play`], in seconds from its start: within its duration,
    /// or, where it goes there and back ([`crate::Wrap::PingPong`]), within twice its duration. `None` once
    /// it has ended, or while it moves no control: all of them have been pressed elsewhere, or the clip has
    /// no length.
    pub fn clip_time_secs(&self, clip: &Arc<Clip>) -> Option<f64> {
        let mut moved = self.channels.iter().zip(&self.cold).filter_map(|(channel, cold)| channel.clip(cold));
        let (_, age_secs) = moved.find(|(moving, _)| Arc::ptr_eq(moving, clip))?;
        let duration_secs = clip.duration_secs();
        let period_secs = match clip.wrap {
            Wrap::Once => return (age_secs < duration_secs).then_some(age_secs),
            Wrap::Loop => duration_secs,
            Wrap::PingPong => 2.0 * duration_secs,
        };
        (period_secs > 0.0).then(|| age_secs % period_secs)
    }

    /// First derivatives of the values, per second.
    pub fn velocities(&self) -> &[f32] {
        &self.velocities
    }

    /// Second derivatives of the values, per second squared.
    pub fn accelerations(&self) -> &[f32] {
        &self.accelerations
    }

    /// Value, velocity and acceleration of one control in full precision; `None` if there is no such control.
    pub fn state(&self, control: usize) -> Option<Jet> {
        let range = self.channels.get(control)?.range();
        let state = self.free_state(control)?;
        Some(if self.confined { range.confine(state) } else { state })
    }

    /// The same before the end of the pipeline.
    pub(crate) fn free_state(&self, control: usize) -> Option<Jet> {
        Some(self.channels.get(control)?.state(self.cold.get(control)?))
    }

    /// Whether all controls have arrived.
    pub fn is_at_rest(&self) -> bool {
        self.channels.iter().zip(&self.cold).all(|(channel, cold)| channel.is_at_rest(cold))
    }

    /// Seconds until all controls have arrived, if nothing is pressed; infinite while a clip repeats.
    pub fn secs_to_rest(&self) -> f64 {
        let channels = self.channels.iter().zip(&self.cold);
        channels.map(|(channel, cold)| channel.remaining_secs(cold)).fold(0.0, f64::max)
    }
}

/// Sends one control towards its value in a pose ([`Player::press`]).
pub(crate) fn press(
    pose: &Pose,
    control: usize,
    value: f32,
    pace: Pace,
    channel: &mut Channel,
    cold: &mut Cold,
) {
    if !value.is_finite() {
        return;
    }
    let timing = pose.timing(control);
    let goal = MoveSpec {
        target: channel.range().clamp(f64::from(value)),
        duration_secs: pose.duration_secs,
        pace,
        factor: timing.factor,
        easing: pose.transition.filter(|easing| easing.is_sound()),
    };
    let delay_secs = if timing.delay_secs.is_nan() { 0.0 } else { timing.delay_secs.min(3600.0) };
    channel.press(goal, delay_secs, cold);
}
