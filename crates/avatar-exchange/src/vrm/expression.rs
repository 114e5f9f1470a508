use super::{Expression, Vrm};
use crate::scene::ScenePose;
use avatar_mesh::expressions::{self, Group};
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
        expressions::output(value, self.is_binary)
    }

    /// The expression as [`avatar_mesh::expressions::add`] takes it. `place` says where the weight of a shape
    /// at a node is; shapes without a place are left out.
    pub fn in_places(&self, mut place: impl FnMut(usize, usize) -> Option<usize>) -> expressions::Expression {
        let groups = [(Group::Blink, &BLINK[..]), (Group::LookAt, &LOOK_AT), (Group::Mouth, &MOUTH)];
        let group = groups.iter().find(|(_, names)| names.contains(&self.name.as_str()));
        let binds = self.binds.iter();
        expressions::Expression {
            is_binary: self.is_binary,
            group: group.map(|(group, _)| *group),
            overrides: [self.override_blink, self.override_look_at, self.override_mouth],
            binds: binds.filter_map(|bind| Some((place(bind.node, bind.shape)?, bind.weight))).collect(),
        }
    }
}

/// Weights of shapes from values of expressions by name, by the formula of [`avatar_mesh::expressions`].
///
/// Names that the avatar lacks are ignored, expressions without value have 0, and of two values for a name
/// the later one counts.
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
    let values: Vec<f32> = vrm.expressions.iter().map(|expression| value(&expression.name)).collect();
    let mut places: BTreeMap<(usize, usize), usize> = BTreeMap::new();
    let expressions: Vec<_> = (vrm.expressions.iter())
        .map(|expression| {
            expression.in_places(|node, shape| {
                let next = places.len();
                Some(*places.entry((node, shape)).or_insert(next))
            })
        })
        .collect();
    let mut weights = vec![0.0; places.len()];
    expressions::add(&expressions, &values, &mut weights);
    ShapeWeights { by_shape: places.into_iter().map(|(shape, place)| (shape, weights[place])).collect() }
}
