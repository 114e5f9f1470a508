//! Maps from the values of one space to those of another.

mod text;

use crate::space::Space;
use placed_toml::TomlError;
use std::ops::Range;
use std::sync::Arc;

/// A product of source values with a factor.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Term {
    /// The factor.
    pub by: f32,
    /// Sources whose values, as differences from rest, are multiplied.
    pub of: Vec<usize>,
    /// Sources of which 1 less their value is multiplied, too.
    pub less: Vec<usize>,
}

/// What one target value is.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Rule {
    /// The place of the target.
    pub to: usize,
    /// What is added to the sum.
    pub plus: f32,
    /// What is summed up.
    pub terms: Vec<Term>,
}

/// The way from the values of one space to those of another: each target value is its rest, plus a constant,
/// plus a sum of products, clamped to its range.
#[derive(Clone, Debug, PartialEq)]
pub struct Map {
    from: Arc<Space>,
    to: Arc<Space>,
    rules: Vec<Rule>,
    unused: Vec<usize>,
    unset: Vec<usize>,
    flat: Flat,
}

/// The rules without a list of its own for each: what a frame reads.
#[derive(Clone, Debug, Default, PartialEq)]
struct Flat {
    rules: Vec<FlatRule>,
    terms: Vec<(f32, Range<usize>)>,
    /// Places of sources, and whether 1 less the value counts.
    factors: Vec<(usize, bool)>,
}

#[derive(Clone, Debug, PartialEq)]
struct FlatRule {
    to: usize,
    plus: f32,
    terms: Range<usize>,
}

impl Map {
    /// Reads a map, there and back. `spaces` are those that it can be between.
    ///
    /// ```toml
    /// from = "arkit"
    /// to = "ours"
    ///
    /// [there]
    /// rules = [
    ///   { to = "wink*", sum = { "eyeBlink*" = 1 } },        # each side by itself
    ///   { to = "grin", sum = { "mouthSmile*" = 0.5 } },     # both sides into one
    ///   { to = "gape", plus = -1, products = [{ of = ["jawOpen"], less = ["mouthClose"], by = 2 }] },
    /// ]
    /// unused = ["browDown*"]    # names of `from` that no rule has: all of them
    /// unset = ["grimace"]       # names of `to` that have no rule: all of them
    ///
    /// [back]
    /// same = true               # names that both spaces have mean the same, where no rule says otherwise
    /// ```
    ///
    /// A product in which a name has `*`, of a target without, counts once for each side.
    ///
    /// # Errors
    /// What is misspelt or of another type; two rules for one target; a name that is in no rule and not
    /// listed as unused or unset, or listed although a rule has it.
    pub fn from_toml(text: &str, spaces: &[Arc<Space>]) -> Result<[Self; 2], TomlError> {
        text::read(text, spaces)
    }

    fn new([from, to]: [Arc<Space>; 2], rules: Vec<Rule>, [unused, unset]: [Vec<usize>; 2]) -> Self {
        let mut flat = Flat::default();
        for rule in &rules {
            let start = flat.terms.len();
            for term in &rule.terms {
                let first = flat.factors.len();
                flat.factors.extend(term.of.iter().map(|source| (*source, false)));
                flat.factors.extend(term.less.iter().map(|source| (*source, true)));
                flat.terms.push((term.by, first..flat.factors.len()));
            }
            flat.rules.push(FlatRule { to: rule.to, plus: rule.plus, terms: start..flat.terms.len() });
        }
        Self { from, to, rules, unused, unset, flat }
    }

    /// The space of the values that it takes.
    pub fn from(&self) -> &Arc<Space> {
        &self.from
    }

    /// The space of the values that it gives.
    pub fn to(&self) -> &Arc<Space> {
        &self.to
    }

    /// Its rules, at most one for each target.
    pub fn rules(&self) -> &[Rule] {
        &self.rules
    }

    /// Places of the source values that it does not look at.
    pub fn unused(&self) -> &[usize] {
        &self.unused
    }

    /// Places of the target values that it leaves at rest.
    pub fn unset(&self) -> &[usize] {
        &self.unset
    }

    /// Computes the target values of a face. Sources that are missing are at rest; only as many targets are
    /// written as there is room for. Allocates nothing.
    pub fn apply(&self, from: &[f32], to: &mut [f32]) {
        for (value, name) in to.iter_mut().zip(self.to.names()) {
            *value = name.rest;
        }
        let source = |place: usize| {
            let name = self.from.names().get(place)?;
            Some(from.get(place).map_or(0.0, |value| name.clean(*value) - name.rest))
        };
        for rule in &self.flat.rules {
            let (Some(slot), Some(name)) = (to.get_mut(rule.to), self.to.names().get(rule.to)) else {
                continue;
            };
            let terms = self.flat.terms.get(rule.terms.clone()).unwrap_or_default();
            let sum = terms.iter().map(|(by, factors)| {
                let factors = self.flat.factors.get(factors.clone()).unwrap_or_default();
                factors.iter().fold(*by, |product, (place, less)| {
                    let value = source(*place).unwrap_or(0.0);
                    product * if *less { (1.0 - value).clamp(0.0, 1.0) } else { value }
                })
            });
            *slot = name.clean(name.rest + rule.plus + sum.sum::<f32>());
        }
    }

    /// A rule in words, as `happy = 0.5 mouthSmileLeft + 0.5 mouthSmileRight`.
    pub fn describe(&self, rule: &Rule) -> String {
        let name = |space: &Space, place: usize| match space.names().get(place) {
            Some(name) => name.name.clone(),
            None => format!("value {place}"),
        };
        let mut text = format!("{} =", name(&self.to, rule.to));
        let mut is_first = true;
        let mut add = |number: f32, rest: &str| {
            let sign = match (is_first, number < 0.0) {
                (true, false) => "",
                (true, true) => "-",
                (false, false) => "+ ",
                (false, true) => "- ",
            };
            is_first = false;
            let number = number.abs();
            text += &match (number == 1.0, rest.is_empty()) {
                (true, false) => format!(" {sign}{rest}"),
                (_, true) => format!(" {sign}{number}"),
                (false, false) => format!(" {sign}{number} {rest}"),
            };
        };
        if rule.plus != 0.0 {
            add(rule.plus, "");
        }
        for term in &rule.terms {
            let of = term.of.iter().map(|place| name(&self.from, *place));
            let less = term.less.iter().map(|place| format!("(1 - {})", name(&self.from, *place)));
            add(term.by, &of.chain(less).collect::<Vec<_>>().join(" × "));
        }
        text
    }
}
