//! Curves: values between keys.

use super::Reader;
use super::xml::At;
use crate::scene::{Finding, ImportError};

/// Halvings when a Bézier curve's parameter is looked for: the time is then exact to 2⁻⁴⁰ of the span.
const HALVINGS: usize = 40;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Way {
    Step,
    Linear,
    Bezier,
    Hermite,
}

/// A `<sampler>`.
#[derive(Debug)]
pub(super) struct Sampler {
    /// Times of keys, rising.
    pub(super) times: Vec<f64>,
    /// Numbers in a value.
    pub(super) width: usize,
    values: Vec<f64>,
    ways: Vec<Way>,
    in_tangents: Vec<f64>,
    out_tangents: Vec<f64>,
}

impl<'a> Reader<'a> {
    pub(super) fn sampler(&mut self, at: At<'a>) -> Result<Sampler, ImportError> {
        let (times, values) = (self.source_of(at, "INPUT")?, self.source_of(at, "OUTPUT")?);
        let (Some(times), Some(values)) = (times, values) else {
            return Err(at.error("inputs INPUT and OUTPUT", "others"));
        };
        let (times, _) = times.flat();
        let (values, width) = values.flat();
        if times.is_empty() || values.len() != times.len() * width {
            let found = format!("{} values of {width} numbers", values.len() / width);
            return Err(at.error(format!("as many values as the {} keys", times.len()), found));
        }
        if let Some(wrong) = times.iter().chain(&values).find(|x| !x.is_finite()) {
            return Err(at.error("finite numbers", wrong.to_string()));
        }
        if times.windows(2).any(|pair| pair[1] < pair[0]) {
            return Err(at.error("times that do not fall", "others"));
        }
        let names = self.source_of(at, "INTERPOLATION")?;
        let mut unknown = None;
        let mut way =
            |key: usize| match names.as_ref().and_then(|names| names.names.get(key)).map(String::as_str) {
                Some("STEP") => Way::Step,
                Some("BEZIER") => Way::Bezier,
                Some("HERMITE") => Way::Hermite,
                Some("LINEAR") | None => Way::Linear,
                Some(other) => {
                    unknown = Some(other.to_owned());
                    Way::Linear
                }
            };
        let mut ways: Vec<Way> = (0..times.len()).map(&mut way).collect();
        if let Some(unknown) = unknown {
            self.note(at, Finding::Converted(format!("{unknown} became LINEAR")));
        }
        let mut tangents =
            |semantic| Ok(self.source_of(at, semantic)?.map_or(Vec::new(), |source| source.flat().0));
        let (in_tangents, out_tangents) = (tangents("IN_TANGENT")?, tangents("OUT_TANGENT")?);
        // One number, or time and number, for each number of each key.
        let fit = |found: &Vec<f64>| found.len() == values.len() || found.len() == 2 * values.len();
        let curved = ways.iter().any(|way| [Way::Bezier, Way::Hermite].contains(way));
        if curved && !(fit(&in_tangents) && fit(&out_tangents)) {
            self.note(at, Finding::mended("a curve without tangents became LINEAR"));
            ways.iter_mut().filter(|way| **way != Way::Step).for_each(|way| *way = Way::Linear);
        }
        Ok(Sampler { times, width, values, ways, in_tangents, out_tangents })
    }
}

impl Sampler {
    /// Whether some span is no straight line.
    pub(super) fn is_curved(&self) -> bool {
        self.ways.iter().any(|way| [Way::Bezier, Way::Hermite].contains(way))
    }

    /// A number of the value just before a time, or from it on. Outside of the keys the nearest one holds.
    pub(super) fn at(&self, time: f64, after: bool, dimension: usize) -> f64 {
        let next = self.times.partition_point(|key| if after { *key <= time } else { *key < time });
        let value = |key: usize| self.values.get(key * self.width + dimension).copied().unwrap_or(0.0);
        let last = self.times.len().saturating_sub(1);
        let Some(a) = next.checked_sub(1) else { return value(0) };
        if next > last {
            return value(last);
        }
        let (from, to) = (self.times[a], self.times[next]);
        let s = if to > from { ((time - from) / (to - from)).clamp(0.0, 1.0) } else { 1.0 };
        let (start, end) = (value(a), value(next));
        match self.ways[a] {
            Way::Step => start,
            Way::Linear => start + (end - start) * s,
            way => {
                let out = self.tangent(&self.out_tangents, a, dimension);
                let into = self.tangent(&self.in_tangents, next, dimension);
                let [p1, p2] = match way {
                    // Control points; without times these are at thirds of the span.
                    Way::Bezier => [
                        (out.0.unwrap_or(from + (to - from) / 3.0), out.1),
                        (into.0.unwrap_or(to - (to - from) / 3.0), into.1),
                    ],
                    // Directions at both ends: control points at a third of them.
                    _ => [
                        (from + out.0.unwrap_or(to - from) / 3.0, start + out.1 / 3.0),
                        (to - into.0.unwrap_or(to - from) / 3.0, end - into.1 / 3.0),
                    ],
                };
                let s = parameter(time, [from, p1.0.clamp(from, to), p2.0.clamp(from, to), to]);
                bezier([start, p1.1, p2.1, end], s)
            }
        }
    }

    /// Time, where the file has it, and number.
    fn tangent(&self, tangents: &[f64], key: usize, dimension: usize) -> (Option<f64>, f64) {
        let at = key * self.width + dimension;
        let number = |at: usize| tangents.get(at).copied().unwrap_or(0.0);
        if tangents.len() == 2 * self.values.len() {
            (Some(number(2 * at)), number(2 * at + 1))
        } else {
            (None, number(at))
        }
    }
}

fn bezier(p: [f64; 4], s: f64) -> f64 {
    let r = 1.0 - s;
    r * r * r * p[0] + 3.0 * r * r * s * p[1] + 3.0 * r * s * s * p[2] + s * s * s * p[3]
}

/// Where a curve of times, which do not leave their span, reaches a time.
fn parameter(time: f64, times: [f64; 4]) -> f64 {
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if bezier(times, middle) < time { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}
