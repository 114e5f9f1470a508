//! Random scripts, and the stage on which they are played.

use glam::{Quat, Vec3};
use pose_anim::{
    Clip, Control, ControlTable, Easing, Jet, JointPlayer, JointTarget, Key, LayerId, LayerMode, Layers,
    Pose, Timing, Track, Transition, Wrap,
};
use std::sync::Arc;

/// SplitMix64 (Steele, Lea & Flood 2014): scripts have to be the same on every machine.
pub(crate) struct Random(pub(crate) u64);

impl Random {
    pub(crate) fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    pub(crate) fn unit(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1u64 << 53) as f64
    }

    pub(crate) fn below(&mut self, end: usize) -> usize {
        (self.next() % end as u64) as usize
    }

    pub(crate) fn one_in(&mut self, count: usize) -> bool {
        self.below(count) == 0
    }
}

/// A few controls with default paces and ranges, so that scripts are many rather than wide.
pub(crate) fn table() -> ControlTable {
    let text = "
        [[control]]\nname = 'turn'\njoint = 'HeadJoint'\naxis = '+x'\nmin = -70\nmax = 70
        [[control]]\nname = 'lid'\njoint = 'LtUpperLidJoint'\naxis = '-z'\nmin = -10\nmax = 45
        [[control]]\nname = 'smile'\nshape = 'S'";
    ControlTable::from_toml(text).unwrap()
}

/// What a script does.
#[derive(Clone, Debug)]
pub(crate) enum Action {
    Press(Pose),
    Play(Arc<Clip>, Option<f64>),
    Stop,
    Weight(f32, f64),
    Joint(JointTarget, f64),
}

impl Action {
    /// Seconds after the action at which something begins or ends.
    pub(crate) fn seams(&self) -> Vec<f64> {
        match self {
            Self::Press(pose) => pose.timings.iter().map(|(_, timing)| timing.delay_secs).collect(),
            Self::Play(clip, fade_secs) => {
                let ends = clip.tracks().iter().map(|track| track.keys().last().unwrap().time_secs);
                ends.chain(*fade_secs).collect()
            }
            Self::Stop => Vec::new(),
            Self::Weight(_, secs) | Self::Joint(_, secs) => vec![*secs],
        }
    }
}

/// Layered players and a joint.
#[derive(Clone)]
pub(crate) struct Stage {
    pub(crate) layers: Layers,
    pub(crate) ids: [LayerId; 2],
    pub(crate) joint: JointPlayer,
}

/// An action at a time. The number says to whom: 0 the base, 1 and 2 the layers.
pub(crate) type Event = (f64, usize, Action);

impl Stage {
    /// `free`: not clamped at the end of the pipeline, to see that nothing has to be.
    pub(crate) fn new(table: &ControlTable, free: bool) -> Self {
        let layers = Layers::new(table);
        let mut layers = if free { layers.with_overshoot() } else { layers };
        let ids = [
            layers.add(table, LayerMode::Additive, &[1.0, 0.5, 0.8]),
            layers.add(table, LayerMode::Override, &[0.0, 1.0, 0.3]),
        ];
        let joint = JointPlayer::new(JointTarget { rotation: Quat::IDENTITY, translation: Vec3::ZERO });
        Self { layers, ids, joint }
    }

    pub(crate) fn act(&mut self, who: usize, action: &Action) {
        let id = self.ids[who.max(1) - 1];
        let player = if who == 0 { self.layers.base() } else { self.layers.layer(id).unwrap() };
        match action {
            Action::Press(pose) => player.press(pose),
            Action::Play(clip, fade_secs) => player.play(clip, *fade_secs),
            Action::Stop => player.stop(),
            Action::Weight(weight, secs) => self.layers.fade_to(id, *weight, *secs),
            Action::Joint(target, secs) => self.joint.press(*target, *secs),
        }
    }

    pub(crate) fn advance(&mut self, dt_secs: f64) {
        self.layers.advance(dt_secs).unwrap();
        self.joint.advance(dt_secs).unwrap();
    }

    /// Seconds until each player rests, and the joint.
    pub(crate) fn secs_to_rest(&mut self) -> Vec<f64> {
        let [a, b] = self.ids;
        let mut secs = vec![self.layers.base().secs_to_rest()];
        secs.extend([a, b].map(|id| self.layers.layer(id).unwrap().secs_to_rest()));
        secs
    }

    /// The controls, then the joint's translation, then its rotation in place of a value with its angular
    /// rates.
    pub(crate) fn states(&self) -> Vec<Jet> {
        let jet = |value, velocity, acceleration| Jet { value, velocity, acceleration };
        let mut states: Vec<_> =
            (0..self.layers.values().len()).map(|control| self.layers.state(control).unwrap()).collect();
        let (at, (v, a)) = (self.joint.translation(), self.joint.linear_rates());
        states.extend((0..3).map(|axis| jet(at[axis], v[axis], a[axis])));
        let (q, (v, a)) = (self.joint.rotation(), self.joint.angular_rates());
        // One value per axis that does not depend on the quaternion's sign and length.
        let q = q.normalize();
        states.extend((0..3).map(|axis| jet(q.to_array()[axis] * q.w, v[axis], a[axis])));
        states
    }
}

/// Plays a script in the given steps until `end`; looks at the stage after each step.
pub(crate) fn play(
    stage: &mut Stage,
    events: &[Event],
    end: f64,
    mut next_step: impl FnMut() -> f64,
    mut look: impl FnMut(f64, &Stage),
) {
    let (mut now, mut events) = (0.0, events.iter().peekable());
    while now < end {
        let until = (now + next_step()).min(end);
        while let Some((at, who, action)) = events.next_if(|event| event.0 <= until) {
            stage.advance(at - now);
            now = *at;
            stage.act(*who, action);
        }
        stage.advance(until - now);
        now = until;
        look(now, stage);
    }
}

pub(crate) fn value(random: &mut Random, control: &Control) -> f32 {
    match random.below(5) {
        0 => control.min,
        1 => control.max,
        _ => control.min + (control.max - control.min) * random.unit() as f32,
    }
}

/// A clip for some controls, twice continuously differentiable by itself. Some end at full speed.
pub(crate) fn clip(random: &mut Random, table: &ControlTable) -> Clip {
    let wrap = [Wrap::Once, Wrap::Loop, Wrap::PingPong][random.below(3)];
    let mut tracks = Vec::new();
    for (index, control) in table.controls().iter().enumerate() {
        let mut value = || f64::from(value(random, control));
        let (start, middle, end) = (value(), value(), value());
        let end_secs = 0.2 + random.unit();
        let keys = match (random.below(4), wrap) {
            (0, _) => continue,
            (1, Wrap::Once) => {
                // Monotone, so that it stays in range; it arrives with a slope, but not at the end of the
                // range.
                let end = 0.9 * end + 0.1 * f64::from(0.5 * (control.min + control.max));
                let arriving = 1.5 * (end - start) / end_secs;
                let transition = Transition::Hermite { leaving: 0.3 * arriving, arriving };
                vec![
                    Key { time_secs: 0.0, value: start, transition },
                    Key::new(end_secs, end, Easing::Linear),
                ]
            }
            _ => {
                let key = |time_secs, value| Key::new(time_secs, value, Easing::MinimumJerk);
                let inner = [key(0.0, start), key(0.3 * end_secs, middle), key(0.8 * end_secs, end)];
                inner.into_iter().chain([key(end_secs, start)]).collect()
            }
        };
        tracks.push(Track::new(index, keys).unwrap());
    }
    Clip::new("c", tracks).unwrap().wrapped(wrap)
}

pub(crate) fn pose(random: &mut Random, table: &ControlTable, transitions: &[Easing]) -> Pose {
    let mut values = Vec::new();
    for (index, control) in table.controls().iter().enumerate() {
        if !random.one_in(5) {
            values.push((index, value(random, control)));
        }
    }
    let mut pose = Pose::new("p", values);
    pose.duration_secs = random.one_in(3).then(|| 0.02 + random.unit());
    if random.one_in(4) {
        pose.transition = Some(transitions[random.below(transitions.len())]);
    }
    for control in 0..table.len() {
        if random.one_in(4) {
            let delay_secs = 0.3 * random.unit();
            pose = pose.timed(control, Timing { delay_secs, factor: 0.5 + random.unit() });
        }
    }
    if random.one_in(4) {
        pose = Pose::mixed("m", &[(&pose, 1.5 * random.unit() as f32)], table);
    }
    pose
}

/// One to eight events, sorted. A third of the scripts leaves the layers alone, so that the base shows as it
/// is.
pub(crate) fn script(random: &mut Random, table: &ControlTable, transitions: &[Easing]) -> Vec<Event> {
    let count = 1 + random.below(8);
    // Half of the scripts are hectic: everything within a tenth of a second.
    let span = if random.one_in(2) { 0.1 } else { 1.2 };
    let mut times: Vec<f64> = (0..count).map(|_| random.unit() * span).collect();
    times.sort_by(f64::total_cmp);
    if random.one_in(4) && count > 1 {
        // Two at the same moment, or one in the very first.
        times[1] = times[0];
    } else if random.one_in(4) {
        times[0] = 0.0;
    }
    let layered = !random.one_in(3);
    let event = |at: f64| {
        let who = if layered { random.below(3) } else { 0 };
        let secs = 0.05 + random.unit();
        let action = match random.below(9) {
            0 => Action::Play(Arc::new(clip(random, table)), random.one_in(2).then_some(secs)),
            1 if random.one_in(2) => Action::Stop,
            2 => {
                let mut number = || 2.0 * random.unit() as f32 - 1.0;
                let (x, y, z, w) = (number(), number(), number(), number());
                let translation = Vec3::new(number(), number(), number());
                Action::Joint(JointTarget { rotation: Quat::from_xyzw(x, y, z, w), translation }, secs)
            }
            3 | 4 if who > 0 => Action::Weight(random.below(3) as f32 / 2.0, secs),
            _ => Action::Press(pose(random, table, transitions)),
        };
        (at, who, action)
    };
    times.into_iter().map(event).collect()
}
