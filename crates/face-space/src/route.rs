//! Ways between any two spaces.

use crate::map::Map;
use crate::space::Space;
use crate::standard::{Standard, maps};
use std::collections::VecDeque;
use std::sync::Arc;

/// Maps one after the other, from one space to another.
#[derive(Clone, Debug)]
pub struct Route {
    from: Arc<Space>,
    maps: Vec<Arc<Map>>,
    /// Values between two maps.
    between: [Vec<f32>; 2],
}

impl Route {
    /// The way with the fewest maps between two standard spaces; the way from a space to itself has none.
    /// There is one between any two: `None` is for spaces of a later version only.
    pub fn between(from: Standard, to: Standard) -> Option<Self> {
        let (start, goal) = (from.space().key(), to.space().key());
        let mut ways = VecDeque::from([(start, Vec::new())]);
        let mut seen = vec![start];
        while let Some((key, way)) = ways.pop_front() {
            if key == goal {
                return Some(Self::along(from.space().clone(), way));
            }
            for map in maps().iter().filter(|map| map.from().key() == key) {
                let next = map.to().key();
                if !seen.contains(&next) {
                    seen.push(next);
                    ways.push_back((next, way.iter().chain([map]).cloned().collect()));
                }
            }
        }
        None
    }

    /// The way of one map.
    pub fn of_map(map: Arc<Map>) -> Self {
        Self::along(map.from().clone(), vec![map])
    }

    /// The way from a space to itself.
    pub(crate) fn to_itself(space: Arc<Space>) -> Self {
        Self::along(space, Vec::new())
    }

    fn along(from: Arc<Space>, maps: Vec<Arc<Map>>) -> Self {
        let longest = maps.iter().map(|map| map.to().len()).max().unwrap_or(0);
        Self { from, maps, between: [vec![0.0; longest], vec![0.0; longest]] }
    }

    /// The space of the values that it takes.
    pub fn from(&self) -> &Arc<Space> {
        &self.from
    }

    /// The space of the values that it gives.
    pub fn to(&self) -> &Arc<Space> {
        self.maps.last().map_or(&self.from, |map| map.to())
    }

    /// Its maps, in order.
    pub fn maps(&self) -> &[Arc<Map>] {
        &self.maps
    }

    /// Computes the values of a face in the other space. Sources that are missing are at rest; only as many
    /// targets are written as there is room for. Allocates nothing.
    pub fn apply(&mut self, from: &[f32], to: &mut [f32]) {
        let [now, next] = &mut self.between;
        match self.maps.as_slice() {
            [] => {
                for (place, (slot, name)) in to.iter_mut().zip(self.from.names()).enumerate() {
                    *slot = from.get(place).map_or(name.rest, |value| name.clean(*value));
                }
            }
            [only] => only.apply(from, to),
            [first, middle @ .., last] => {
                first.apply(from, now);
                for map in middle {
                    map.apply(now, next);
                    std::mem::swap(now, next);
                }
                last.apply(now, to);
            }
        }
    }
}
