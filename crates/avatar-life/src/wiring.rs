//! Which controls of an avatar show what, by their names.

use crate::curves::step;
use crate::parameters as p;
use pose_anim::{ControlTable, face, soft_sum};

/// What a face does, before it becomes controls.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Channel {
    /// Share of the way to closed lids.
    Closed,
    /// Degrees to the character's left, and up.
    LeftEyeYaw,
    RightEyeYaw,
    EyePitch,
    /// Degrees, as the head's controls.
    HeadTurn,
    HeadBow,
    HeadBend,
    /// Weights, which may be below 0.
    BrowsInner,
    BrowLeft,
    BrowRight,
    /// Air that is in.
    Breath,
    /// Width of the pupils by that in a lit room, as a share of the whole range.
    Pupils,
}

pub(crate) const CHANNELS: usize = 12;

/// One control, and what moves it. Small, since each of many faces goes through its own in each frame.
#[derive(Clone, Copy, Debug)]
struct Wire {
    control: u32,
    min: f32,
    max: f32,
    /// Whether lids are closed where it is at its largest.
    closes: bool,
    term: Term,
}

#[derive(Clone, Copy, Debug)]
struct Term {
    channel: Channel,
    /// Whether only what is positive counts: of two controls for one axis, one for each direction.
    is_one_sided: bool,
    factor: f32,
}

/// A factor for a channel.
fn all(channel: Channel, factor: f64) -> Term {
    Term { channel, factor: factor as f32, is_one_sided: false }
}

/// One side of a channel: of two controls, one for each direction.
fn one(channel: Channel, factor: f64) -> Term {
    Term { channel, factor: factor as f32, is_one_sided: true }
}

/// Weight within which one of two opposite shapes sets in.
const GENTLE: f64 = 0.02;
/// Weight of a shape that looks aside, up or down, for each degree.
const LOOK: f64 = 1.0 / 30.0;
const LOOK_UP: f64 = 1.0 / 25.0;

#[derive(Clone, Debug)]
pub(crate) struct Wiring {
    wires: Vec<Wire>,
}

impl Wiring {
    pub(crate) fn new(controls: &ControlTable) -> Self {
        let mut wiring = Self { wires: Vec::new() };
        wiring.lids(controls);
        wiring.eyes(controls);
        use Channel::*;
        for (name, channel) in
            [(face::HEAD_TURN, HeadTurn), (face::HEAD_BOW, HeadBow), (face::HEAD_BEND, HeadBend)]
        {
            wiring.add(controls, name, all(channel, 1.0));
        }
        wiring.add(controls, "browInnerUp", one(BrowsInner, 1.0));
        wiring.add(controls, "browOuterUpLeft", one(BrowLeft, 1.0));
        wiring.add(controls, "browOuterUpRight", one(BrowRight, 1.0));
        wiring.add(controls, "browDownLeft", one(BrowLeft, -0.6));
        wiring.add(controls, "browDownRight", one(BrowRight, -0.6));
        for name in ["noseSneerLeft", "noseSneerRight"] {
            wiring.add(controls, name, all(Breath, p::BREATH_NOSTRILS));
        }
        let range = |name: &str| controls.index(name).and_then(|index| controls.controls().get(index));
        for name in ["breath", "chest.breath", "shoulders.up", "shoulder.left.up", "shoulder.right.up"] {
            if let Some(range) = range(name) {
                let factor = p::BREATH_SHOULDERS * f64::from(range.max - range.default);
                wiring.add(controls, name, all(Breath, factor));
            }
        }
        for name in ["pupil", "pupils", "pupil.left", "pupil.right", "pupilDilateLeft", "pupilDilateRight"] {
            if let Some(range) = range(name) {
                wiring.add(controls, name, all(Pupils, f64::from(range.max - range.min)));
            }
        }
        wiring
    }

    /// Lids of their own, or shapes that close the eyes, or one for both eyes.
    fn lids(&mut self, controls: &ControlTable) {
        let sides = [
            (face::LID_LEFT_UPPER, face::LID_LEFT_LOWER, face::EYE_LEFT_UD),
            (face::LID_RIGHT_UPPER, face::LID_RIGHT_LOWER, face::EYE_RIGHT_UD),
        ];
        let mut has_lids = false;
        for (upper, lower, eye) in sides {
            for (lid, per_degree) in [(upper, p::UPPER_LID_PER_DEGREE), (lower, p::LOWER_LID_PER_DEGREE)] {
                if self.close(controls, lid) {
                    has_lids = true;
                    let is_coupled = controls.couplings().iter().any(|coupling| {
                        Some(coupling.to) == controls.index(lid) && Some(coupling.from) == controls.index(eye)
                    });
                    if !is_coupled {
                        self.add(controls, lid, all(Channel::EyePitch, per_degree));
                    }
                }
            }
        }
        if has_lids {
            return;
        }
        for names in [
            &["eyeBlinkLeft", "eyeBlinkRight"][..],
            &["expression.blink"],
            &["expression.blinkLeft", "expression.blinkRight"],
            &["blink"],
            &["blinkLeft", "blinkRight"],
        ] {
            let mut is_found = false;
            for name in names {
                is_found |= self.close(controls, name);
            }
            if is_found {
                return;
            }
        }
    }

    /// Eyes that turn, or shapes that look.
    fn eyes(&mut self, controls: &ControlTable) {
        use Channel::*;
        let turning = [
            (face::EYE_LEFT_LR, LeftEyeYaw),
            (face::EYE_RIGHT_LR, RightEyeYaw),
            (face::EYE_LEFT_UD, EyePitch),
            (face::EYE_RIGHT_UD, EyePitch),
        ];
        let mut is_found = false;
        for (name, channel) in turning {
            is_found |= self.add(controls, name, all(channel, 1.0));
        }
        if is_found {
            return;
        }
        let looking = [
            ("eyeLookOutLeft", LeftEyeYaw, LOOK),
            ("eyeLookInLeft", LeftEyeYaw, -LOOK),
            ("eyeLookInRight", RightEyeYaw, LOOK),
            ("eyeLookOutRight", RightEyeYaw, -LOOK),
            ("eyeLookUpLeft", EyePitch, LOOK_UP),
            ("eyeLookUpRight", EyePitch, LOOK_UP),
            ("eyeLookDownLeft", EyePitch, -LOOK_UP),
            ("eyeLookDownRight", EyePitch, -LOOK_UP),
        ];
        for (name, channel, factor) in looking {
            is_found |= self.add(controls, name, one(channel, factor));
        }
        let both = [
            ("lookLeft", LeftEyeYaw, LOOK),
            ("lookRight", LeftEyeYaw, -LOOK),
            ("lookUp", EyePitch, LOOK_UP),
            ("lookDown", EyePitch, -LOOK_UP),
        ];
        for (name, channel, factor) in both.into_iter().filter(|_| !is_found) {
            // A program's own face may have them without the word that expressions of VRM have before them.
            let _ = self.add(controls, &format!("expression.{name}"), one(channel, factor))
                || self.add(controls, name, one(channel, factor));
        }
    }

    /// The wire of a control, which is new if the control has none yet. Each has one term at most: no name
    /// is asked for twice.
    fn wire(&mut self, controls: &ControlTable, name: &str) -> Option<&mut Wire> {
        let index = controls.index(name)?;
        let control = u32::try_from(index).ok()?;
        let place = match self.wires.iter().position(|wire| wire.control == control) {
            Some(place) => place,
            None => {
                let range = controls.controls().get(index)?;
                let term = all(Channel::Closed, 0.0);
                self.wires.push(Wire { control, min: range.min, max: range.max, closes: false, term });
                self.wires.len() - 1
            }
        };
        self.wires.get_mut(place)
    }

    fn add(&mut self, controls: &ControlTable, name: &str, term: Term) -> bool {
        let wire = self.wire(controls, name);
        wire.map(|wire| wire.term = term).is_some()
    }

    fn close(&mut self, controls: &ControlTable, name: &str) -> bool {
        let wire = self.wire(controls, name);
        wire.map(|wire| wire.closes = true).is_some()
    }

    /// The controls that are moved.
    pub(crate) fn controls(&self) -> impl ExactSizeIterator<Item = usize> {
        self.wires.iter().map(|wire| wire.control as usize)
    }

    /// Puts life on top of values of all controls.
    pub(crate) fn apply(&self, channels: &[f64; CHANNELS], out: &mut [f32]) {
        for wire in &self.wires {
            if let Some(slot) = out.get_mut(wire.control as usize) {
                *slot = wire.value(channels, f64::from(*slot)) as f32;
            }
        }
    }

    pub(crate) fn value(&self, channels: &[f64; CHANNELS], control: usize, below: f64) -> f64 {
        let wire = self.wires.iter().find(|wire| wire.control as usize == control);
        wire.map_or(below, |wire| wire.value(channels, below))
    }
}

impl Wire {
    fn value(&self, channels: &[f64; CHANNELS], below: f64) -> f64 {
        let Term { channel, is_one_sided, factor } = self.term;
        let by = f64::from(factor) * channels[channel as usize];
        // `x r(x)` is as smooth at 0 as the step `r` is.
        let offset = if is_one_sided { by.max(0.0) * step(by / GENTLE) } else { by };
        let value = soft_sum(below, offset, self.min.into(), self.max.into());
        match self.closes {
            true => value + channels[Channel::Closed as usize] * (f64::from(self.max) - value),
            false => value,
        }
    }
}
