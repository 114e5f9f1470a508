use super::{Expression, Override, Vrm};
use crate::scene::ScenePose;
use std::collections::BTreeMap;

const BLINK: [&str; 3] = ["blink", "blinkLeft", "blinkRight"];
const LOOK_AT: [&str; 4] = ["lookUp", "lookDown", "lookLeft", "lookRight"];
const MOUTH: [&str; 5] = ["aa", "ih", "ou", "ee", "oh"];

/// Weights of all shapes that expressions bind, by node and shape.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ShapeWeights {
    /// The weights; 0 for shapes whose expressions rest.
    pub by_shape: BTreeMap<(usize, usize), f32>,
}

impl ShapeWeights {
    /// Sets them in a pose of the scene; shapes that no expression binds, and those that the pose lacks, stay
    /// as they are.
    pub fn apply(&self, pose: &mut ScenePose) {
        for (&(node, shape), &weight) in &self.by_shape {
            if let Some(slot) = pose.weights.get_mut(node).and_then(|weights| weights.get_mut(shape)) {
                *slot = weight;
            }
        }
    }
}

impl Expression {
    /// The value that is used: clamped to 0…1, and either 0 or 1 for binary expressions. NaN counts as 0.
    pub fn output(&self, value: f32) -> f32 {
        let value = if value.is_nan() { 0.0 } else { value.clamp(0.0, 1.0) };
        match self.is_binary {
            true => f32::from(u8::from(value > 0.5)),
            false => value,
        }
    }
}

impl Override {
    /// How much an expression with this output takes from others.
    fn rate(self, output: f32) -> f32 {
        match self {
            Self::None => 0.0,
            Self::Block => f32::from(u8::from(output > 0.0)),
            Self::Blend => output,
        }
    }
}

/// Weights of shapes from values of expressions by name, as VRM 1.0 says (`expressions.md`, "Procedural
/// override"):
///
/// ```text
/// output = clamp(value), or 1 where a binary one is above 0.5, else 0
/// rate   = Σ over expressions, 1 for a block with output > 0, the output for a blend
/// factor = 1 − clamp(rate)             for blinks, looks and mouths; 0 of a binary one with a rate above 0
/// weight = Σ output · factor · weight of the bind
/// ```
///
/// An expression does not override others of its own kind. Names that the avatar lacks are ignored,
/// expressions without value have 0, and of two values for a name the later one counts.
///
/// ```
/// use avatar_exchange::vrm::{Expression, MorphBind, Override, Vrm, expression_weights};
///
/// let bind = |shape| vec![MorphBind { node: 0, shape, weight: 1.0 }];
/// let mut happy = Expression { name: "happy".into(), binds: bind(0), ..Default::default() };
/// happy.override_blink = Override::Blend;
/// let blink = Expression { name: "blink".into(), is_preset: true, binds: bind(1), ..Default::default() };
/// let vrm = Vrm { expressions: vec![happy, blink], ..Default::default() };
/// let weights = expression_weights(&vrm, &[("happy", 0.75), ("blink", 1.0)]);
/// assert_eq!((weights.by_shape[&(0, 0)], weights.by_shape[&(0, 1)]), (0.75, 0.25));
/// ```
pub fn expression_weights(vrm: &Vrm, values: &[(&str, f32)]) -> ShapeWeights {
    let value = |name: &str| values.iter().rev().find(|(other, _)| *other == name).map_or(0.0, |(_, v)| *v);
    let outputs: Vec<f32> = vrm.expressions.iter().map(|e| e.output(value(&e.name))).collect();
    let rate = |kind: &[&str], of: fn(&Expression) -> Override| {
        let others = vrm.expressions.iter().zip(&outputs).filter(|(e, _)| !kind.contains(&e.name.as_str()));
        others.map(|(expression, output)| of(expression).rate(*output)).sum::<f32>().clamp(0.0, 1.0)
    };
    let rates = [
        (&BLINK[..], rate(&BLINK, |expression| expression.override_blink)),
        (&LOOK_AT[..], rate(&LOOK_AT, |expression| expression.override_look_at)),
        (&MOUTH[..], rate(&MOUTH, |expression| expression.override_mouth)),
    ];
    let mut weights = ShapeWeights::default();
    for (expression, output) in vrm.expressions.iter().zip(&outputs) {
        let rate = rates.iter().find(|(kind, _)| kind.contains(&expression.name.as_str()));
        let rate = rate.map_or(0.0, |(_, rate)| *rate);
        let factor = if expression.is_binary && rate > 0.0 { 0.0 } else { 1.0 - rate };
        for bind in &expression.binds {
            *weights.by_shape.entry((bind.node, bind.shape)).or_insert(0.0) += output * factor * bind.weight;
        }
    }
    weights
}
