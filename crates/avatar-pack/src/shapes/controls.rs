//! How further shapes hang on controls: more controls, what mixtures move, and rules for weights.

use super::{FurtherShapes, ShapeWeight};
use crate::{ControlSlider, Expressions, Sliders};
use avatar_mesh::FACE_SHAPES;
use avatar_mesh::drivers::{DriversError, Input, Rule, ShapeDrivers, ShapeRule};
use pose_anim::{Control, ControlError, ControlTable, Coupling, Drive, Pace};
use std::collections::{BTreeMap, HashMap, HashSet};

/// What an input of a shape is.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(super) enum Resolved {
    /// A slider, by its name.
    Slider(String),
    /// A control of a joint.
    Joint(usize),
}

/// What a name means as an input, where `has_control` says which shapes have a control of their own.
pub(super) fn resolve(
    name: &str,
    controls: &ControlTable,
    has_control: impl Fn(&str) -> bool,
) -> Option<Resolved> {
    if has_control(name) {
        return Some(Resolved::Slider(name.to_owned()));
    }
    let index = controls.index(name)?;
    match &controls.controls().get(index)?.drives {
        Drive::Joint { .. } => Some(Resolved::Joint(index)),
        Drive::Shape { shape } => has_control(shape).then(|| Resolved::Slider(shape.clone())),
    }
}

impl FurtherShapes {
    /// These controls, and behind them one for each shape and mixture that needs one and has none.
    pub(crate) fn add_controls(&self, controls: &ControlTable) -> Result<ControlTable, ControlError> {
        let own = self.shapes.iter().filter(|shape| shape.weight == ShapeWeight::Control);
        let mixtures = self.mixtures.iter().map(|mixture| (&mixture.name, &mixture.group));
        let own = own.map(|shape| (&shape.name, &shape.group)).chain(mixtures);
        let driven: HashSet<&str> = controls.controls().iter().filter_map(driven_shape).collect();
        let new = own.filter(|(name, _)| !driven.contains(name.as_str()));
        let all = controls.controls().iter().cloned().chain(new.map(|(name, group)| control(name, group)));
        ControlTable::with_couplings(all.collect(), controls.couplings().to_vec())
    }

    /// What each mixture moves, as pairs of controls; mixtures of mixtures are multiplied out.
    fn mixing(&self, controls: &ControlTable) -> Vec<Coupling> {
        // By their names, and by the shape that they drive: the first of several.
        let with_places = || controls.controls().iter().zip(0..);
        let mut of_name: HashMap<&str, usize> =
            with_places().map(|(control, index)| (control.name.as_str(), index)).collect();
        for (control, index) in with_places() {
            if let Some(shape) = driven_shape(control) {
                of_name.entry(shape).or_insert(index);
            }
        }
        let mut mixing = Vec::new();
        let mut flat: HashMap<&str, Vec<(usize, f32)>> = HashMap::new();
        for mixture in &self.mixtures {
            let mut ways: BTreeMap<usize, f32> = BTreeMap::new();
            for (target, way) in &mixture.of {
                match flat.get(target.as_str()) {
                    Some(earlier) => {
                        earlier.iter().for_each(|(to, part)| *ways.entry(*to).or_default() += way * part);
                    }
                    None => of_name
                        .get(target.as_str())
                        .into_iter()
                        .for_each(|to| *ways.entry(*to).or_default() += way),
                }
            }
            if let Some(&from) = of_name.get(mixture.name.as_str()) {
                mixing.extend(ways.iter().map(|(&to, &factor)| Coupling { from, to, factor }));
            }
            flat.insert(&mixture.name, ways.into_iter().collect());
        }
        mixing
    }

    /// What moves a pack's shapes of these names: the format's two, these ones, once for each part that has
    /// them.
    pub(crate) fn sliders(
        &self,
        controls: &ControlTable,
        shapes: &[String],
    ) -> Result<Sliders, DriversError> {
        let own: Vec<&str> = (self.shapes.iter())
            .filter(|shape| shape.weight == ShapeWeight::Control)
            .map(|shape| shape.name.as_str())
            .chain(FACE_SHAPES)
            .collect();
        let own: HashSet<&str> = own.into_iter().collect();
        let mut wires =
            Wires { controls, own, names: Vec::new(), places: HashMap::new(), of_controls: Vec::new() };
        FACE_SHAPES.iter().for_each(|name| wires.add_slider(name));
        for shape in self.shapes.iter().filter(|shape| shape.weight == ShapeWeight::Control) {
            wires.add_slider(&shape.name);
        }
        self.mixtures.iter().for_each(|mixture| wires.add_slider(&mixture.name));
        let weights: HashMap<&str, &ShapeWeight> =
            self.shapes.iter().map(|shape| (shape.name.as_str(), &shape.weight)).collect();
        let (mut keys, mut rules, mut of_shapes) = (Vec::new(), Vec::new(), Vec::new());
        // The same rule for the shapes of all parts that have one name: the first leads.
        let mut first: HashMap<&str, usize> = HashMap::new();
        for (number, name) in shapes.iter().enumerate() {
            keys.push(format!("shape {number}"));
            let leader = *first.entry(name).or_insert(number);
            if leader != number {
                let input = Input::Shape(format!("shape {leader}"));
                rules.push(ShapeRule { shape: keys[number].clone(), rule: Rule::Product(vec![input]) });
                of_shapes.push(of_shapes.get(leader).cloned().unwrap_or_default());
                continue;
            }
            let (rule, followed) = wires.rule(name, weights.get(name.as_str()).copied());
            rules.push(ShapeRule { shape: keys[number].clone(), rule });
            of_shapes.push(followed);
        }
        let Wires { names, of_controls, .. } = wires;
        let sliders: Vec<String> = (0..names.len()).map(slider_key).collect();
        let drivers = ShapeDrivers::new(&sliders, &keys, &rules)?;
        let mixing = self.mixing(controls);
        Ok(Sliders { names, of_shapes, drivers, expressions: Expressions::default(), of_controls, mixing })
    }
}

/// The shape that a control drives.
fn driven_shape(control: &Control) -> Option<&str> {
    match &control.drives {
        Drive::Shape { shape } => Some(shape),
        Drive::Joint { .. } => None,
    }
}

/// The control of a shape or mixture that `controls.toml` does not have.
fn control(name: &str, group: &Option<String>) -> Control {
    let drives = Drive::Shape { shape: name.to_owned() };
    let pace = Pace::named(name, &drives);
    Control { name: name.to_owned(), drives, min: 0.0, max: 1.0, default: 0.0, pace, group: group.clone() }
}

/// Names may come more than once, keys do not.
fn slider_key(slider: usize) -> String {
    format!("slider {slider}")
}

/// Sliders while they are made.
struct Wires<'a> {
    controls: &'a ControlTable,
    /// The shapes that have a control of their own.
    own: HashSet<&'a str>,
    names: Vec<String>,
    places: HashMap<Resolved, usize>,
    of_controls: Vec<ControlSlider>,
}

impl Wires<'_> {
    fn add_slider(&mut self, name: &str) {
        self.places.insert(Resolved::Slider(name.to_owned()), self.names.len());
        self.names.push(name.to_owned());
    }

    /// The slider that an input is; one more where it is a joint's control that has none yet.
    fn slider(&mut self, name: &str) -> Option<usize> {
        let resolved = resolve(name, self.controls, |shape| self.own.contains(shape))?;
        if let Some(place) = self.places.get(&resolved) {
            return Some(*place);
        }
        let Resolved::Joint(index) = resolved else { return None };
        let control = self.controls.controls().get(index)?;
        let slider = self.names.len();
        let ways = [control.max - control.default, control.min - control.default];
        let way = ways.into_iter().find(|way| *way != 0.0).unwrap_or(1.0);
        self.names.push(control.name.clone());
        self.places.insert(resolved, slider);
        self.of_controls.push(ControlSlider { slider, control: index, rest: control.default, way });
        Some(slider)
    }

    /// The rule of a shape and the sliders that it follows.
    fn rule(&mut self, name: &str, weight: Option<&ShapeWeight>) -> (Rule, Vec<usize>) {
        let follows = |slider: Option<usize>, full_weight| {
            // An unknown input is refused with its name by `ShapeDrivers`; the reader let none through.
            let key = slider.map_or_else(String::new, slider_key);
            let rule = Rule::Follows { input: Input::Driver(key), full_weight };
            (rule, slider.into_iter().collect())
        };
        match weight {
            None | Some(ShapeWeight::Control) => follows(self.slider(name), 1.0),
            Some(ShapeWeight::Follows { input, at }) => follows(self.slider(input), *at),
            Some(ShapeWeight::Product(inputs)) => {
                let sliders: Vec<usize> = inputs.iter().filter_map(|input| self.slider(input)).collect();
                let rule =
                    Rule::Product(sliders.iter().map(|slider| Input::Driver(slider_key(*slider))).collect());
                let mut followed = sliders;
                followed.sort_unstable();
                followed.dedup();
                (rule, followed)
            }
        }
    }
}
