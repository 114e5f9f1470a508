//! What a map cannot say.

use crate::map::{Map, Term};
use crate::route::Route;

/// Values that differ by no more than this are the same: rounding of factors such as a third.
const SAME: f32 = 1e-4;

/// What becomes of one value on the way there and back.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Fate {
    /// It comes back as it was.
    Kept,
    /// What comes back differs: other values move with it, or it is weaker or stronger.
    Changed(Vec<(usize, f32)>),
    /// It counts only where others are away from rest, too.
    WithOthers,
    /// Nothing of it comes back: the other space has no word for it.
    Lost,
}

/// What is lost between two spaces, on the way there and back.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Loss {
    /// What becomes of each value of the first space, alone and as large as it can be (or as small, where
    /// that is further from rest).
    pub fates: Vec<Fate>,
    /// Values that come back as one: places in the first space, of those that the way there adds up.
    pub merged: Vec<Vec<usize>>,
    /// Places in the other space that the way there never sets.
    pub unset: Vec<usize>,
}

impl Loss {
    /// Follows each value of the first space to the other and back.
    pub fn of(there: &mut Route, back: &mut Route) -> Self {
        let from = there.from().clone();
        let (mut value, mut said, mut returned) = (from.rest(), there.to().rest(), from.rest());
        let mut fates = Vec::new();
        let mut answers = Vec::new();
        for (place, name) in from.names().iter().enumerate() {
            let is_high = name.max - name.rest >= name.rest - name.min;
            let extreme = if is_high { name.max } else { name.min };
            let range = name.max - name.min;
            value.get_mut(place).into_iter().for_each(|slot| *slot = extreme);
            there.apply(&value, &mut said);
            back.apply(&said, &mut returned);
            value.get_mut(place).into_iter().for_each(|slot| *slot = name.rest);
            let moved = |(at, value): (usize, &f32)| {
                let name = from.names().get(at)?;
                ((value - name.rest).abs() > SAME * (name.max - name.min)).then_some((at, *value))
            };
            let moved: Vec<_> = returned.iter().enumerate().filter_map(moved).collect();
            let is_kept = |value: f32| (value - extreme).abs() <= SAME * range;
            fates.push(match moved.as_slice() {
                [(at, value)] if *at == place && is_kept(*value) => Fate::Kept,
                [] if is_used(there.maps(), place) => Fate::WithOthers,
                [] => Fate::Lost,
                _ => Fate::Changed(moved.clone()),
            });
            answers.push(said.clone());
        }
        let mut merged: Vec<Vec<usize>> = Vec::new();
        let rest = there.to().rest();
        for (place, answer) in answers.iter().enumerate() {
            let is_alike = |other: &Vec<usize>| {
                other
                    .first()
                    .and_then(|other| answers.get(*other))
                    .is_some_and(|other| alike(answer, other, &rest))
            };
            if answer.iter().zip(&rest).all(|(said, rest)| (said - rest).abs() <= SAME) {
                continue;
            }
            match merged.iter_mut().find(|other| is_alike(other)) {
                Some(group) => group.push(place),
                None => merged.push(vec![place]),
            }
        }
        merged.retain(|group| group.len() > 1);
        let unset = unset(there);
        Self { fates, merged, unset }
    }

    /// How many values are kept, changed, heard only with others, and lost.
    pub fn counts(&self) -> [usize; 4] {
        let mut counts = [0; 4];
        for fate in &self.fates {
            counts[match fate {
                Fate::Kept => 0,
                Fate::Changed(_) => 1,
                Fate::WithOthers => 2,
                Fate::Lost => 3,
            }] += 1;
        }
        counts
    }
}

/// Places in the space of a route's end that nothing of its beginning reaches.
fn unset(route: &Route) -> Vec<usize> {
    let mut is_set = vec![true; route.from().len()];
    for map in route.maps() {
        let mut next = vec![false; map.to().len()];
        for rule in map.rules() {
            let counts = |term: &Term| term.of.iter().all(|place| is_set.get(*place) == Some(&true));
            let is_moved = rule.terms.iter().any(counts);
            next.get_mut(rule.to).into_iter().for_each(|slot| *slot = is_moved);
        }
        is_set = next;
    }
    (0..is_set.len()).filter(|place| is_set.get(*place) == Some(&false)).collect()
}

/// Whether a rule of the first map has a value.
fn is_used(maps: &[std::sync::Arc<Map>], place: usize) -> bool {
    maps.first().is_some_and(|map| !map.unused().contains(&place))
}

/// Whether two answers differ by a factor above 0 only.
fn alike(a: &[f32], b: &[f32], rest: &[f32]) -> bool {
    let dot = |a: &[f32], b: &[f32]| {
        let products =
            a.iter().zip(b).zip(rest).map(|((a, b), rest)| f64::from(a - rest) * f64::from(b - rest));
        products.sum::<f64>()
    };
    let (aa, bb, ab) = (dot(a, a), dot(b, b), dot(a, b));
    ab > 0.0 && ab * ab >= aa * bb * (1.0 - f64::from(SAME))
}

/// How far vertices are from where they should be, over many frames.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct VertexError {
    sum: f64,
    squares: f64,
    count: u64,
    max: f64,
}

impl VertexError {
    /// Adds a frame: where vertices are, and where they should be. Vertices beyond the shorter list, and
    /// those that are no numbers, do not count.
    pub fn add(&mut self, found: &[[f32; 3]], wanted: &[[f32; 3]]) {
        for (found, wanted) in found.iter().zip(wanted) {
            let square: f64 =
                found.iter().zip(wanted).map(|(a, b)| (f64::from(*a) - f64::from(*b)).powi(2)).sum();
            if square.is_finite() {
                self.sum += square.sqrt();
                self.squares += square;
                self.count += 1;
                self.max = self.max.max(square.sqrt());
            }
        }
    }

    /// The mean distance, in the unit of the places; 0 without any.
    pub fn mean(&self) -> f64 {
        self.sum / self.count.max(1) as f64
    }

    /// The root of the mean square of the distances.
    pub fn root_mean_square(&self) -> f64 {
        (self.squares / self.count.max(1) as f64).sqrt()
    }

    /// The largest distance.
    pub fn max(&self) -> f64 {
        self.max
    }
}
