use super::{DriversError, Input, Rule, ShapeRule};
use std::collections::HashMap;

/// A piecewise linear function: 1 at `at`, 0 at its neighbours and beyond.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Peak {
    at: f32,
    below: Option<Neighbour>,
    above: Option<Neighbour>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Neighbour {
    at: f32,
    /// Nothing lies beyond it: the line goes on.
    outermost: bool,
}

impl Peak {
    #[inline(always)]
    pub(crate) fn weight(self, x: f32) -> f32 {
        let from = |n: Neighbour, inside: bool| match inside || n.outermost {
            true => (x - n.at) / (self.at - n.at),
            false => 0.0,
        };
        match (self.below, self.above) {
            (Some(below), above) if x < self.at || above.is_none() => from(below, x >= below.at),
            (_, Some(above)) => from(above, x <= above.at),
            (_, None) => x,
        }
    }
}

/// The function of each rule; that of products is not used.
pub(crate) fn peaks(rules: &[ShapeRule]) -> Result<Vec<Peak>, DriversError> {
    // The base shape stands at 0 of every input.
    let mut of_input: HashMap<&Input, Vec<(f32, &str)>> = HashMap::new();
    for rule in rules {
        if let Rule::Follows { input, full_weight } = &rule.rule {
            if !full_weight.is_finite() || *full_weight == 0.0 {
                return Err(DriversError::FullWeight { shape: rule.shape.clone(), found: *full_weight });
            }
            of_input.entry(input).or_insert_with(|| vec![(0.0, "")]).push((*full_weight, &rule.shape));
        }
    }
    for shapes in of_input.values_mut() {
        shapes.sort_by(|a, b| a.0.total_cmp(&b.0));
    }
    let mut peaks = Vec::with_capacity(rules.len());
    for rule in rules {
        let (at, shapes) = match &rule.rule {
            Rule::Follows { input, full_weight } => (*full_weight, of_input.get(input)),
            Rule::Product(_) => (0.0, None),
        };
        let shapes = shapes.map_or(&[][..], Vec::as_slice);
        let mut here = shapes.iter().filter(|(other, _)| *other == at);
        if let (Some(first), Some(second)) = (here.next(), here.next()) {
            let (first, second) = (first.1.to_owned(), second.1.to_owned());
            return Err(DriversError::SameFullWeight { first, second, found: at });
        }
        let k = shapes.iter().position(|(other, _)| *other == at).unwrap_or(0);
        let neighbour = |k: usize| {
            let (at, _) = shapes.get(k)?;
            Some(Neighbour { at: *at, outermost: k == 0 || k + 1 == shapes.len() })
        };
        peaks.push(Peak { at, below: k.checked_sub(1).and_then(neighbour), above: neighbour(k + 1) });
    }
    Ok(peaks)
}
