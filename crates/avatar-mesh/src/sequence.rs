//! Vertex animation: geometries of one connectivity as keys in time.
//!
//! Between two keys at `t_a` and `t_b` a transition function `f` of the progress gives the weights:
//!
//! ```text
//!  s = (t − t_a) / (t_b − t_a)        w_b = f(s)        w_a = 1 − f(s)
//! ```
//!
//! Any function will do; where it leaves 0…1 the geometries are extrapolated. Before the first key and after
//! the last one nothing moves. Times are seconds, in any range.

use crate::Shape;
use crate::weights::VertexCountError;
use glam::Vec3;

/// A geometry at a time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SequenceKey {
    /// When, in seconds.
    pub time_secs: f64,
    /// The position of each vertex.
    pub positions: Vec<Vec3>,
}

/// Two keys and their weights, which sum to 1; outside the keys twice the same one, at weights 1 and 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Between {
    /// The earlier key.
    pub a: usize,
    /// The later key.
    pub b: usize,
    /// `1 − f(s)`.
    pub weight_a: f32,
    /// `f(s)`.
    pub weight_b: f32,
}

/// Why keys do not form a sequence, or why it cannot be edited so.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SequenceError {
    /// A time that is NaN or infinite.
    #[error("expected a time in seconds, found {found}")]
    Time {
        /// The number.
        found: f64,
    },
    /// Two keys at one time.
    #[error("expected each time once, found {time_secs} s again")]
    SameTime {
        /// The time.
        time_secs: f64,
    },
    /// A geometry with another number of vertices.
    #[error("expected {expected} vertices, found {found}")]
    VertexCount {
        /// Vertices of the sequence.
        expected: usize,
        /// Vertices of the key, or room for them.
        found: usize,
    },
    /// Another number of weights than there are keys.
    #[error("expected room for {expected} weights, found {found}")]
    WeightCount {
        /// Number of keys.
        expected: usize,
        /// Number of weights.
        found: usize,
    },
    /// A key that is not there.
    #[error("expected a key below {keys}, found {found}")]
    NoKey {
        /// Number of keys.
        keys: usize,
        /// Number of the key.
        found: usize,
    },
}

/// Keys in ascending order of their times, which differ, of one number of vertices.
///
/// ```
/// use avatar_mesh::sequence::{Sequence, SequenceKey};
/// use glam::Vec3;
///
/// let key = |time_secs, x| SequenceKey { time_secs, positions: vec![Vec3::X * x] };
/// let mut drop = Sequence::new(vec![key(0.0, 0.0), key(2.0, 8.0)])?;
/// // Accelerating: a quarter of the way after half of the time.
/// let mut at = vec![Vec3::ZERO];
/// drop.positions(1.0, |s| s * s, &mut at)?;
/// assert_eq!(at, [Vec3::X * 2.0]);
/// // Bake it, and linger there.
/// let baked = drop.bake(1.0, |s| s * s)?;
/// drop.move_to(baked, 1.5)?;
/// drop.positions(1.5, |s| s, &mut at)?;
/// assert_eq!(at, [Vec3::X * 2.0]);
/// # Ok::<(), avatar_mesh::sequence::SequenceError>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Sequence {
    keys: Vec<SequenceKey>,
}

impl Sequence {
    /// A sequence of keys in any order.
    ///
    /// # Errors
    /// Times that are NaN, infinite or equal; geometries of different numbers of vertices.
    pub fn new(mut keys: Vec<SequenceKey>) -> Result<Self, SequenceError> {
        let expected = keys.first().map_or(0, |key| key.positions.len());
        for SequenceKey { time_secs, positions } in &keys {
            check_time(*time_secs)?;
            check_count(expected, positions.len())?;
        }
        keys.sort_by(|a, b| a.time_secs.total_cmp(&b.time_secs));
        match keys.windows(2).find(|two| two[0].time_secs == two[1].time_secs) {
            Some(two) => Err(SequenceError::SameTime { time_secs: two[1].time_secs }),
            None => Ok(Self { keys }),
        }
    }

    /// A sequence of files of positions, such as OBJ, one every `interval_secs` from 0 on.
    ///
    /// # Errors
    /// An interval of 0 or without end (a negative one runs backward), geometries of different numbers of
    /// vertices.
    pub fn from_frames(
        interval_secs: f64,
        frames: impl IntoIterator<Item = Vec<Vec3>>,
    ) -> Result<Self, SequenceError> {
        let keys = frames.into_iter().enumerate();
        Self::new(
            keys.map(|(i, positions)| SequenceKey { time_secs: i as f64 * interval_secs, positions })
                .collect(),
        )
    }

    /// The keys, in the order of their times.
    pub fn keys(&self) -> &[SequenceKey] {
        &self.keys
    }

    /// Number of vertices of every key; 0 without keys.
    pub fn vertex_count(&self) -> usize {
        self.keys.first().map_or(0, |key| key.positions.len())
    }

    /// Which keys count at a time, and how much; `None` without keys. NaN is before the first key.
    pub fn between(&self, time_secs: f64, transition: impl Fn(f32) -> f32) -> Option<Between> {
        let last = self.keys.len().checked_sub(1)?;
        let b = self.keys.partition_point(|key| key.time_secs <= time_secs);
        if b == 0 || b > last {
            let only = b.min(last);
            return Some(Between { a: only, b: only, weight_a: 1.0, weight_b: 0.0 });
        }
        // Halves, because the difference of two finite numbers may be infinite.
        let half = |k: usize| self.keys[k].time_secs * 0.5;
        let s = (time_secs * 0.5 - half(b - 1)) / (half(b) - half(b - 1));
        let weight_b = transition(if s.is_finite() { s as f32 } else { 0.0 });
        Some(Between { a: b - 1, b, weight_a: 1.0 - weight_b, weight_b })
    }

    /// The weight of each key at a time. They sum to 1, so that they fit [`Self::shapes`] whatever the base
    /// is.
    ///
    /// # Errors
    /// Another number of weights than there are keys.
    pub fn weights(
        &self,
        time_secs: f64,
        transition: impl Fn(f32) -> f32,
        weights: &mut [f32],
    ) -> Result<(), SequenceError> {
        if weights.len() != self.keys.len() {
            return Err(SequenceError::WeightCount { expected: self.keys.len(), found: weights.len() });
        }
        weights.fill(0.0);
        if let Some(Between { a, b, weight_a, weight_b }) = self.between(time_secs, transition) {
            weights[b] = weight_b;
            weights[a] = weight_a;
        }
        Ok(())
    }

    /// The in-between geometry at a time: `w_a S_a + w_b S_b`. Allocates nothing.
    ///
    /// # Errors
    /// Room for another number of vertices.
    pub fn positions(
        &self,
        time_secs: f64,
        transition: impl Fn(f32) -> f32,
        out: &mut [Vec3],
    ) -> Result<(), SequenceError> {
        check_count(self.vertex_count(), out.len())?;
        let Some(Between { a, b, weight_a, weight_b }) = self.between(time_secs, transition) else {
            return Ok(());
        };
        let (a, b) = (&self.keys[a].positions, &self.keys[b].positions);
        for ((out, a), b) in out.iter_mut().zip(a).zip(b) {
            *out = if weight_b == 0.0 { *a } else { weight_a * *a + weight_b * *b };
        }
        Ok(())
    }

    /// Each key as a shape of a base, for meshes that blend by weights.
    ///
    /// # Errors
    /// A base with another number of vertices.
    pub fn shapes(
        &self,
        base: &[Vec3],
        name: impl Fn(usize) -> String,
    ) -> Result<Vec<Shape>, VertexCountError> {
        let keys = self.keys.iter().enumerate();
        keys.map(|(k, key)| Shape::from_absolute(name(k), base, &key.positions)).collect()
    }

    /// Adds a key and returns where it is now.
    ///
    /// # Errors
    /// A time that is NaN, infinite or taken; another number of vertices.
    pub fn insert(&mut self, key: SequenceKey) -> Result<usize, SequenceError> {
        if !self.keys.is_empty() {
            check_count(self.vertex_count(), key.positions.len())?;
        }
        let place = self.free_place(key.time_secs)?;
        self.keys.insert(place, key);
        Ok(place)
    }

    /// Makes the in-between at a time a key, and returns where it is.
    ///
    /// # Errors
    /// A time that is NaN, infinite or taken.
    pub fn bake(&mut self, time_secs: f64, transition: impl Fn(f32) -> f32) -> Result<usize, SequenceError> {
        self.free_place(time_secs)?;
        let mut positions = vec![Vec3::ZERO; self.vertex_count()];
        self.positions(time_secs, transition, &mut positions)?;
        self.insert(SequenceKey { time_secs, positions })
    }

    /// Moves a key in time, past others if need be, and returns where it is now.
    ///
    /// # Errors
    /// A key that is not there; a time that is NaN, infinite or another key's. Nothing changes then.
    pub fn move_to(&mut self, key: usize, time_secs: f64) -> Result<usize, SequenceError> {
        check_time(time_secs)?;
        let mut moved = self.delete(key)?;
        let place = self.free_place(time_secs);
        let to = match place {
            Ok(to) => {
                moved.time_secs = time_secs;
                to
            }
            Err(_) => key,
        };
        self.keys.insert(to, moved);
        place
    }

    /// Takes a key out.
    ///
    /// # Errors
    /// A key that is not there.
    pub fn delete(&mut self, key: usize) -> Result<SequenceKey, SequenceError> {
        match key < self.keys.len() {
            true => Ok(self.keys.remove(key)),
            false => Err(SequenceError::NoKey { keys: self.keys.len(), found: key }),
        }
    }

    fn free_place(&self, time_secs: f64) -> Result<usize, SequenceError> {
        check_time(time_secs)?;
        let place = self.keys.partition_point(|key| key.time_secs < time_secs);
        match self.keys.get(place) {
            Some(key) if key.time_secs == time_secs => Err(SequenceError::SameTime { time_secs }),
            _ => Ok(place),
        }
    }
}

fn check_time(found: f64) -> Result<(), SequenceError> {
    if found.is_finite() { Ok(()) } else { Err(SequenceError::Time { found }) }
}

fn check_count(expected: usize, found: usize) -> Result<(), SequenceError> {
    if expected == found { Ok(()) } else { Err(SequenceError::VertexCount { expected, found }) }
}
