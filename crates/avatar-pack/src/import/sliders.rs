use super::parts::ShapeNames;
use crate::Sliders;
use avatar_exchange::{NodeDrivers, Scene};
use avatar_mesh::drivers::{DriversError, Input, Rule, ShapeDrivers, ShapeRule};

/// What controls are made for: a slider of each name.
#[derive(Debug, Default)]
pub(super) struct Wanted {
    pub(super) names: Vec<String>,
    /// Least and greatest values at which shapes stand alone, and 0 and 1; and the values at rest.
    pub(super) ranges: Vec<(f32, f32, f32)>,
    pub(super) sliders: Option<Sliders>,
}

impl Wanted {
    /// The sliders of the scene; where shapes have none, they are their own.
    pub(super) fn of(scene: &Scene, shapes: &ShapeNames) -> Result<Self, DriversError> {
        let mut wanted = Self::default();
        // Names may come more than once, numbers do not.
        let (mut keys, mut rules) = (Vec::new(), Vec::new());
        for node in 0..scene.nodes.len() {
            let first = shapes.first.get(node).copied().unwrap_or(0);
            let end = shapes.first.get(node + 1).copied().unwrap_or(shapes.names.len());
            match scene.drivers.iter().find(|drivers| drivers.node == node) {
                Some(drivers) => wanted.add_node(drivers, first..end, &mut keys, &mut rules),
                None => {
                    for shape in first..end {
                        let key = wanted.add(
                            shapes.names[shape].clone(),
                            shapes.weights[shape],
                            [0.0, 1.0],
                            &mut keys,
                        );
                        let rule = Rule::Product(vec![Input::Driver(key)]);
                        rules.push(ShapeRule { shape: key_of(shape), rule });
                    }
                }
            }
        }
        if !scene.drivers.is_empty() {
            let of_shapes: Vec<String> = (0..shapes.names.len()).map(key_of).collect();
            let drivers = ShapeDrivers::new(&keys, &of_shapes, &rules)?;
            let of_shapes = of_shapes.iter().map(|shape| followed(shape, &keys, &rules)).collect();
            wanted.sliders = Some(Sliders { names: wanted.names.clone(), of_shapes, drivers });
        }
        Ok(wanted)
    }

    fn add(&mut self, name: String, rest: f32, outermost: [f32; 2], keys: &mut Vec<String>) -> String {
        let key = format!("slider {}", keys.len());
        let rest = if rest.is_finite() { rest } else { 0.0 };
        let [min, max] = outermost;
        self.names.push(name);
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
        let own: Vec<String> = (drivers.drivers.iter().enumerate())
            .map(|(number, name)| {
                let mut outermost = [0.0f32, 1.0];
                for rule in &drivers.rules {
                    if let Rule::Follows { input: Input::Driver(input), full_weight } = &rule.rule
                        && input == name
                    {
                        outermost = [outermost[0].min(*full_weight), outermost[1].max(*full_weight)];
                    }
                }
                let rest = drivers.rest.get(number).copied().unwrap_or(0.0);
                self.add(name.clone(), rest, outermost, keys)
            })
            .collect();
        let driver = |name: &str| {
            let number = drivers.drivers.iter().position(|other| other == name);
            number.and_then(|number| own.get(number).cloned())
        };
        let shape = |name: &str| {
            let number = drivers.shapes.iter().position(|other| other == name);
            number.map(|number| places.start + number).filter(|place| places.contains(place)).map(key_of)
        };
        // A name that there is not stays, and is refused.
        let renamed = |input: &Input| match input {
            Input::Driver(name) => Input::Driver(driver(name).unwrap_or_else(|| name.clone())),
            Input::Shape(name) => Input::Shape(shape(name).unwrap_or_else(|| name.clone())),
        };
        for (number, name) in drivers.shapes.iter().enumerate() {
            let rule = match drivers.rules.iter().find(|rule| rule.shape == *name).map(|rule| &rule.rule) {
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

/// The sliders that a shape follows, itself or by way of other shapes. Rules that were accepted run in no circles.
fn followed(shape: &str, keys: &[String], rules: &[ShapeRule]) -> Vec<usize> {
    let mut found = Vec::new();
    let mut left = vec![shape];
    while let Some(shape) = left.pop() {
        let inputs = match rules.iter().find(|rule| rule.shape == shape).map(|rule| &rule.rule) {
            Some(Rule::Follows { input, .. }) => std::slice::from_ref(input),
            Some(Rule::Product(inputs)) => inputs,
            None => &[],
        };
        for input in inputs {
            match input {
                Input::Shape(other) => left.push(other),
                Input::Driver(key) => found.extend(keys.iter().position(|other| other == key)),
            }
        }
    }
    found.sort_unstable();
    found.dedup();
    found
}
