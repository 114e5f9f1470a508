use super::apart::{Driven, Slot};
use super::known::NamedExpression;
use super::parts::ShapeNames;
use crate::look_rule::EXPRESSION;
use crate::{Expressions, Sliders};
use avatar_exchange::{NodeDrivers, Scene};
use avatar_mesh::drivers::{DriversError, Input, Rule, ShapeDrivers, ShapeRule};
use avatar_mesh::expressions::Expression;
use std::collections::{HashMap, HashSet};
use std::hash::Hash;

/// What controls are made for: a slider of each name.
#[derive(Debug, Default)]
pub(super) struct Wanted {
    /// The sliders: where they are, and their values at rest.
    slots: Vec<Slot>,
    /// What controls drive.
    pub(super) driven: Driven,
    /// Least and greatest values at which shapes stand alone, and 0 and 1; and the values at rest.
    pub(super) ranges: Vec<(f32, f32, f32)>,
    pub(super) sliders: Option<Sliders>,
    /// From here on the names of `driven` are those of expressions.
    pub(super) first_expression: usize,
    /// What the controls of the expressions are called.
    pub(super) expressions: Vec<String>,
}

impl Wanted {
    /// The sliders of the scene; where shapes have none, they are their own, by names that tell them apart
    /// where nodes differ. Each expression has one more.
    pub(super) fn of(
        scene: &Scene,
        node_names: &[String],
        shapes: &mut ShapeNames,
        known: &[NamedExpression],
    ) -> Result<Self, DriversError> {
        let mut wanted = Self::default();
        // Names may come more than once, numbers do not.
        let (mut keys, mut rules) = (Vec::new(), Vec::new());
        let of_nodes = first_of(scene.drivers.iter().map(|drivers| (drivers.node, drivers)));
        for node in 0..scene.nodes.len() {
            let first = shapes.first.get(node).copied().unwrap_or(0);
            let end = shapes.first.get(node + 1).copied().unwrap_or(shapes.names.len());
            match of_nodes.get(&node) {
                Some(drivers) => wanted.add_node(drivers, first..end, &mut keys, &mut rules),
                None => {
                    for shape in first..end {
                        let slot = Slot {
                            node,
                            name: shapes.names[shape].clone(),
                            shape: Some(shape - first),
                            rest: shapes.weights[shape],
                        };
                        let key = wanted.add(slot, [0.0, 1.0], &mut keys);
                        let rule = Rule::Product(vec![Input::Driver(key)]);
                        rules.push(ShapeRule { shape: key_of(shape), rule });
                    }
                }
            }
        }
        wanted.driven = Driven::of(scene, &wanted.slots, node_names);
        let expressions = wanted.add_expressions(shapes, known, &mut keys);
        if scene.drivers.is_empty() && known.is_empty() {
            // Each shape is a slider of its own.
            shapes.names.clone_from(&wanted.driven.names);
        } else {
            let of_shapes: Vec<String> = (0..shapes.names.len()).map(key_of).collect();
            let drivers = ShapeDrivers::new(&keys, &of_shapes, &rules)?;
            let followed = Followed::new(&keys, &rules);
            let mut of_shapes: Vec<_> = of_shapes.iter().map(|shape| followed.by(shape)).collect();
            for (number, expression) in expressions.list.iter().enumerate() {
                for (shape, _) in &expression.binds {
                    // A shape may be bound by one expression twice.
                    let followed = &mut of_shapes[*shape];
                    let slider = expressions.first_slider + number;
                    followed.extend((followed.last() != Some(&slider)).then_some(slider));
                }
            }
            let names = wanted.driven.names.clone();
            wanted.sliders = Some(Sliders {
                names,
                of_shapes,
                drivers,
                expressions,
                of_controls: Vec::new(),
                mixing: Vec::new(),
            });
        }
        Ok(wanted)
    }

    /// The sliders of the expressions, and what these do to the shapes.
    fn add_expressions(
        &mut self,
        shapes: &ShapeNames,
        known: &[NamedExpression],
        keys: &mut Vec<String>,
    ) -> Expressions {
        self.first_expression = self.driven.names.len();
        let mut names: HashSet<String> = self.driven.names.iter().cloned().collect();
        let mut bound = vec![false; shapes.names.len()];
        let mut list = Vec::with_capacity(known.len());
        for NamedExpression { name, expression, binds } in known {
            let mut unique = format!("{EXPRESSION}{name}");
            self.expressions.push(unique.clone());
            // A shape may have that name.
            while !names.insert(unique.clone()) {
                unique.push('\'');
            }
            self.add_key(0.0, [0.0, 1.0], keys);
            self.driven.names.push(unique);
            let place = |bind: usize| {
                let (node, shape) = *binds.get(bind)?;
                shapes.place(node, shape)
            };
            let weights = expression.binds.iter();
            let binds = weights.filter_map(|(bind, weight)| Some((place(*bind)?, *weight)));
            let expression = Expression { binds: binds.collect(), ..expression.clone() };
            expression.binds.iter().for_each(|(shape, _)| bound[*shape] = true);
            list.push(expression);
        }
        let weights = shapes.weights.iter().copied().enumerate();
        let rest = weights.filter(|(shape, weight)| bound[*shape] && *weight != 0.0 && weight.is_finite());
        Expressions { first_slider: self.first_expression, list, rest: rest.collect() }
    }

    /// One more slider; returns its key.
    fn add(&mut self, slot: Slot, outermost: [f32; 2], keys: &mut Vec<String>) -> String {
        let rest = if slot.rest.is_finite() { slot.rest } else { 0.0 };
        self.slots.push(Slot { rest, ..slot });
        self.add_key(rest, outermost, keys)
    }

    fn add_key(&mut self, rest: f32, [min, max]: [f32; 2], keys: &mut Vec<String>) -> String {
        let key = format!("slider {}", keys.len());
        self.ranges.push((min.min(rest), max.max(rest), rest));
        keys.push(key.clone());
        key
    }

    /// The rules of a node in terms of keys.
    fn add_node(
        &mut self,
        drivers: &NodeDrivers,
        places: std::ops::Range<usize>,
        keys: &mut Vec<String>,
        rules: &mut Vec<ShapeRule>,
    ) {
        let mut outermost: HashMap<&str, [f32; 2]> = HashMap::new();
        for rule in &drivers.rules {
            if let Rule::Follows { input: Input::Driver(input), full_weight } = &rule.rule {
                let [min, max] = outermost.entry(input).or_insert([0.0, 1.0]);
                (*min, *max) = (min.min(*full_weight), max.max(*full_weight));
            }
        }
        let own: Vec<String> = (drivers.drivers.iter().enumerate())
            .map(|(number, name)| {
                let outermost = outermost.get(name.as_str()).copied().unwrap_or([0.0, 1.0]);
                let rest = drivers.rest.get(number).copied().unwrap_or(0.0);
                self.add(Slot { node: drivers.node, name: name.clone(), shape: None, rest }, outermost, keys)
            })
            .collect();
        // Of several of one name the first counts.
        let driver_keys = first_of(drivers.drivers.iter().map(String::as_str).zip(&own));
        let driver = |name: &str| driver_keys.get(name).map(|key| (*key).clone());
        let shape_numbers = first_of(drivers.shapes.iter().map(String::as_str).zip(places.clone()));
        let shape = |name: &str| shape_numbers.get(name).copied().map(key_of);
        let rule_of = first_of(drivers.rules.iter().map(|rule| (rule.shape.as_str(), &rule.rule)));
        // An unknown name is kept as it is; `ShapeDrivers` refuses it.
        let renamed = |input: &Input| match input {
            Input::Driver(name) => Input::Driver(driver(name).unwrap_or_else(|| name.clone())),
            Input::Shape(name) => Input::Shape(shape(name).unwrap_or_else(|| name.clone())),
        };
        for (number, name) in drivers.shapes.iter().enumerate() {
            let rule = match rule_of.get(name.as_str()) {
                Some(Rule::Follows { input, full_weight }) => {
                    Rule::Follows { input: renamed(input), full_weight: *full_weight }
                }
                Some(Rule::Product(inputs)) => Rule::Product(inputs.iter().map(renamed).collect()),
                // As `ShapeDrivers` has it: the driver of its name, or nothing.
                None => match driver(name) {
                    Some(key) => Rule::Product(vec![Input::Driver(key)]),
                    None => continue,
                },
            };
            if places.contains(&(places.start + number)) {
                rules.push(ShapeRule { shape: key_of(places.start + number), rule });
            }
        }
    }
}

fn key_of(shape: usize) -> String {
    format!("shape {shape}")
}

/// A map of these pairs; if a key occurs several times, its first value counts.
fn first_of<K: Eq + Hash, V>(pairs: impl IntoIterator<Item = (K, V)>) -> HashMap<K, V> {
    let mut first = HashMap::new();
    for (key, value) in pairs {
        first.entry(key).or_insert(value);
    }
    first
}

/// Finds the sliders that shapes follow.
struct Followed<'a> {
    sliders: HashMap<&'a str, usize>,
    rules: HashMap<&'a str, &'a Rule>,
}

impl<'a> Followed<'a> {
    fn new(keys: &'a [String], rules: &'a [ShapeRule]) -> Self {
        Self {
            sliders: first_of(keys.iter().map(String::as_str).zip(0..)),
            rules: first_of(rules.iter().map(|rule| (rule.shape.as_str(), &rule.rule))),
        }
    }

    /// The sliders that a shape follows, itself or by way of other shapes, each shape once.
    fn by(&self, shape: &'a str) -> Vec<usize> {
        let mut found = Vec::new();
        let (mut left, mut seen) = (vec![shape], HashSet::from([shape]));
        while let Some(shape) = left.pop() {
            let inputs = match self.rules.get(shape) {
                Some(Rule::Follows { input, .. }) => std::slice::from_ref(input),
                Some(Rule::Product(inputs)) => inputs,
                None => &[],
            };
            for input in inputs {
                match input {
                    Input::Shape(other) => {
                        left.extend(Some(other.as_str()).filter(|other| seen.insert(other)))
                    }
                    Input::Driver(key) => found.extend(self.sliders.get(key.as_str())),
                }
            }
        }
        found.sort_unstable();
        found.dedup();
        found
    }
}
