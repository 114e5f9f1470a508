use crate::channel::{Channel, Cold, MoveSpec};
use crate::range::Range;
use crate::soft_limit::soft_limit;
use crate::{AdvanceError, ControlTable, Jet, JumpError, Pace, Player};
use std::sync::atomic::{AtomicUsize, Ordering};

/// How a layer acts on what is below it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LayerMode {
    /// Adds the distance of the layer's value from the default: breathing, small movements of the head.
    Additive,
    /// Takes over: a blink, speech.
    Override,
}

/// Name of a layer of a [`Layers`], and of its clones. Other stacks do not know it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LayerId {
    stack: usize,
    index: usize,
}

/// Number of the next stack.
static STACKS: AtomicUsize = AtomicUsize::new(0);

/// A base player with further players on top of it, each with a mask over the controls and a weight.
///
/// From below to above, with the base's value as the first `x`, the layer's own value `y`, its share `w =
/// weight · mask` and the control's default `d`:
///
/// ```text
/// Override    x ← (1 − w) · x + w · y
/// Additive    x ← x + w · (y − d), bent smoothly where it would leave the range
/// ```
///
/// Velocities and accelerations follow by the rules for sums and products, and the result is as smooth as the
/// players are: weights move as smoothly as values. Where all shares are 0, the result is the base to the
/// last bit.
///
/// Values that overshoot their range on purpose are clamped after all layers only, or not at all:
/// [`Self::with_overshoot`].
#[derive(Clone, Debug)]
pub struct Layers {
    stack: usize,
    confined: bool,
    base: Player,
    layers: Vec<Layer>,
    defaults: Vec<f64>,
    ranges: Vec<Range>,
    /// What is combined in a tick.
    states: Vec<Jet>,
    values: Vec<f32>,
    velocities: Vec<f32>,
    accelerations: Vec<f32>,
}

#[derive(Clone, Debug)]
struct Layer {
    player: Player,
    mode: LayerMode,
    mask: Vec<f64>,
    weight: Channel,
    cold: Cold,
}

const WEIGHTS: Range = Range { min: 0.0, max: 1.0 };

impl Layers {
    /// A base without layers, everything at rest at its default.
    pub fn new(controls: &ControlTable) -> Self {
        let base = Player::new(controls);
        Self {
            stack: STACKS.fetch_add(1, Ordering::Relaxed),
            confined: true,
            states: vec![Jet::default(); controls.len()],
            layers: Vec::new(),
            defaults: controls.controls().iter().map(|control| control.default.into()).collect(),
            ranges: controls
                .controls()
                .iter()
                .map(|control| Range { min: control.min.into(), max: control.max.into() })
                .collect(),
            values: base.values().to_vec(),
            velocities: base.velocities().to_vec(),
            accelerations: base.accelerations().to_vec(),
            base,
        }
    }

    /// The same layers, whose combined values may leave their ranges where a transition function overshoots
    /// on purpose (back, elastic). The offset of an additive layer still moves no value out of its range.
    #[must_use]
    pub fn with_overshoot(self) -> Self {
        Self { confined: false, ..self }
    }

    /// Puts a layer on top, with weight 0 and everything at its default. `controls` is the table that the
    /// stack was made from. `mask` is the share of the layer per control, 0 to 1; controls beyond the end of
    /// the mask, or of a shorter table, have a share of 0. This allocates; nothing after it does.
    pub fn add(&mut self, controls: &ControlTable, mode: LayerMode, mask: &[f32]) -> LayerId {
        let mask = &mask[..mask.len().min(controls.len())];
        let share = |index: usize| mask.get(index).map_or(0.0, |share| WEIGHTS.clamp(f64::from(*share)));
        self.layers.push(Layer {
            player: Player::new(controls),
            mode,
            mask: (0..self.defaults.len()).map(share).collect(),
            weight: Channel::rest(WEIGHTS, 0.0),
            cold: Cold::new(),
        });
        LayerId { stack: self.stack, index: self.layers.len() - 1 }
    }

    /// The base, to press poses on.
    pub fn base(&mut self) -> &mut Player {
        &mut self.base
    }

    /// The base, to be asked.
    pub fn base_ref(&self) -> &Player {
        &self.base
    }

    /// Puts all controls of the base at rest at these values, at once, and combines the layers anew.
    ///
    /// # Errors
    /// As [`Player::jump_to`]; then nothing changes.
    pub fn jump_to(&mut self, values: &[f32]) -> Result<(), JumpError> {
        self.base.jump_to(values)?;
        for control in 0..self.values.len() {
            if let Some(state) = self.state(control) {
                self.values[control] = state.value as f32;
                self.velocities[control] = state.velocity as f32;
                self.accelerations[control] = state.acceleration as f32;
            }
        }
        Ok(())
    }

    /// The player of a layer, to press poses on; `None` if the layer is of another [`Layers`].
    pub fn layer(&mut self, layer: LayerId) -> Option<&mut Player> {
        self.find(layer).map(|layer| &mut layer.player)
    }

    fn find(&mut self, layer: LayerId) -> Option<&mut Layer> {
        if layer.stack == self.stack { self.layers.get_mut(layer.index) } else { None }
    }

    /// Moves the weight of a layer to a value from 0 to 1, smoothly, in this many seconds (0.001 to 3600).
    /// Like a press, it may come at any time. Other weights are clamped; NaN or a layer of another [`Layers`]
    /// changes nothing.
    pub fn fade_to(&mut self, layer: LayerId, weight: f32, duration_secs: f64) {
        let Some(layer) = self.find(layer) else { return };
        if weight.is_nan() {
            return;
        }
        let goal = MoveSpec {
            target: WEIGHTS.clamp(weight.into()),
            duration_secs: Some(duration_secs),
            pace: Pace::SHAPE,
            factor: 1.0,
            easing: None,
        };
        layer.weight.press(goal, 0.0, &mut layer.cold);
    }

    /// The present weight of a layer with its derivatives; `None` if the layer is of another [`Layers`].
    pub fn weight(&self, layer: LayerId) -> Option<Jet> {
        let layer = if layer.stack == self.stack { self.layers.get(layer.index) } else { None };
        layer.map(|layer| WEIGHTS.confine(layer.weight.state(&layer.cold)))
    }

    /// Lets time pass in all players and weights, and combines them.
    ///
    /// # Errors
    /// A negative time step or NaN; then nothing changes.
    pub fn advance(&mut self, dt_secs: f64) -> Result<(), AdvanceError> {
        AdvanceError::check(dt_secs)?;
        if dt_secs == 0.0 {
            return Ok(());
        }
        let Self { base, layers, states, defaults, ranges, .. } = self;
        base.advance_and(dt_secs, |control, state| states[control] = state);
        for layer in layers {
            let weight = WEIGHTS.confine(layer.weight.advance(dt_secs, &mut layer.cold));
            let (mode, mask) = (layer.mode, &layer.mask);
            layer.player.advance_and(dt_secs, |control, own| {
                // A layer's table may be longer than the stack's.
                let Some(state) = states.get_mut(control) else { return };
                *state = mode.over(*state, own, mask[control], weight, defaults[control], ranges[control]);
            });
        }
        for (control, state) in self.states.iter().enumerate() {
            let state = if self.confined { self.ranges[control].confine(*state) } else { *state };
            self.values[control] = state.value as f32;
            self.velocities[control] = state.velocity as f32;
            self.accelerations[control] = state.acceleration as f32;
        }
        Ok(())
    }

    /// Value, velocity and acceleration of one control in full precision; `None` if there is no such control.
    pub fn state(&self, control: usize) -> Option<Jet> {
        let (range, default) = (*self.ranges.get(control)?, *self.defaults.get(control)?);
        let mut state = self.base.free_state(control)?;
        for layer in &self.layers {
            let weight = WEIGHTS.confine(layer.weight.state(&layer.cold));
            if let Some(own) = layer.player.free_state(control) {
                state = layer.mode.over(state, own, *layer.mask.get(control)?, weight, default, range);
            }
        }
        Some(if self.confined { range.confine(state) } else { state })
    }

    /// Combined values, one per control, each in its range.
    pub fn values(&self) -> &[f32] {
        &self.values
    }

    /// First derivatives of the values, per second.
    pub fn velocities(&self) -> &[f32] {
        &self.velocities
    }

    /// Second derivatives of the values, per second squared.
    pub fn accelerations(&self) -> &[f32] {
        &self.accelerations
    }

    /// Whether all players and weights have arrived.
    pub fn is_at_rest(&self) -> bool {
        let rests = |layer: &Layer| layer.player.is_at_rest() && layer.weight.is_at_rest(&layer.cold);
        self.base.is_at_rest() && self.layers.iter().all(rests)
    }
}

impl LayerMode {
    /// The state `own` of a layer over the state of what is below.
    fn over(self, below: Jet, own: Jet, mask: f64, weight: Jet, default: f64, range: Range) -> Jet {
        let share = Jet::rest(mask) * weight;
        match self {
            _ if share == Jet::rest(0.0) => below,
            Self::Override if share == Jet::rest(1.0) => own,
            Self::Override => below.mix(own, share),
            Self::Additive => soft_limit(below, share * (own - Jet::rest(default)), range),
        }
    }
}
