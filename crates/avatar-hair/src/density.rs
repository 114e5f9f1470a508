use glam::{Vec2, Vec3};

/// How dense hair grows over texture coordinates: 0 nowhere. The origin is the top left corner, and it repeats.
#[derive(Clone, Debug, PartialEq)]
pub struct DensityMap {
    width: u32,
    height: u32,
    values: Vec<f32>,
}

/// Why numbers are no density map.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum DensityError {
    /// No value at all, or not as many as there are places.
    #[error("expected {width} x {height} densities, found {found}")]
    Size {
        /// Places in a row.
        width: u32,
        /// Rows.
        height: u32,
        /// Number of values.
        found: usize,
    },
    /// A value that is negative, infinite or no number.
    #[error("expected a density from 0 at place {index}")]
    Value {
        /// Its number, row by row.
        index: usize,
    },
}

/// A triangle is cut into at most this many pieces along an edge.
const MOST_STEPS: u32 = 256;
/// And into at least so many: densities that are even still end at the edges of regions.
const LEAST_STEPS: u32 = 4;

impl DensityMap {
    /// From values row by row.
    ///
    /// # Errors
    /// Another number of values than places, none, and values that are no density.
    pub fn new(width: u32, height: u32, values: Vec<f32>) -> Result<Self, DensityError> {
        let found = values.len();
        if found == 0 || u64::from(width) * u64::from(height) != found as u64 {
            return Err(DensityError::Size { width, height, found });
        }
        let wrong = values.iter().position(|value| !(value.is_finite() && *value >= 0.0));
        match wrong {
            Some(index) => Err(DensityError::Value { index }),
            None => Ok(Self { width, height, values }),
        }
    }

    /// From the bytes of a grey picture, row by row: 255 is density 1.
    ///
    /// # Errors
    /// Another number of bytes than places, or none.
    pub fn from_bytes(width: u32, height: u32, bytes: &[u8]) -> Result<Self, DensityError> {
        Self::new(width, height, bytes.iter().map(|byte| f32::from(*byte) / 255.0).collect())
    }

    /// The density at a place, between its four nearest values.
    pub fn at(&self, uv: Vec2) -> f32 {
        if !uv.is_finite() {
            return 0.0;
        }
        // The fraction first: it keeps its digits where coordinates have left 0…1.
        let place = (uv - uv.floor()) * Vec2::new(self.width as f32, self.height as f32) - 0.5;
        let low = place.floor();
        let share = place - low;
        // One step beyond the edge at most, on either side.
        let wrap = |at: i32, size: u32| if at < 0 { size - 1 } else { at as u32 % size };
        let (x0, y0) = (wrap(low.x as i32, self.width), wrap(low.y as i32, self.height));
        let (x1, y1) = ((x0 + 1) % self.width, (y0 + 1) % self.height);
        let value = |x: u32, y: u32| self.values[y as usize * self.width as usize + x as usize];
        let mix = |a: f32, b: f32, t: f32| a + (b - a) * t;
        let above = mix(value(x0, y0), value(x1, y0), share.x);
        mix(above, mix(value(x0, y1), value(x1, y1), share.x), share.y)
    }

    /// The mean over a triangle, of one place per value of the map or more.
    pub fn mean(&self, uvs: [Vec2; 3]) -> f32 {
        let pieces = Pieces::new(self.steps(uvs));
        let sum: f64 = pieces.iter().map(|piece| f64::from(self.at(weighted(uvs, piece.middle())))).sum();
        (sum / pieces.len() as f64) as f32
    }

    /// Into how many pieces along an edge a triangle is to be cut so that the map is about even on each.
    pub(crate) fn steps(&self, [a, b, c]: [Vec2; 3]) -> u32 {
        let size = Vec2::new(self.width as f32, self.height as f32);
        let longest = [b - a, c - b, a - c].map(|edge| (edge * size).length());
        let longest = longest.into_iter().fold(0.0, f32::max);
        (longest as u32).saturating_add(1).clamp(LEAST_STEPS, MOST_STEPS)
    }
}

/// The sum of three places by barycentric weights.
pub(crate) fn weighted(uvs: [Vec2; 3], weights: Vec3) -> Vec2 {
    uvs[0] * weights.x + uvs[1] * weights.y + uvs[2] * weights.z
}

/// A triangle that is cut into `steps`² alike ones.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pieces {
    steps: u32,
}

/// One of them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Piece {
    steps: u32,
    column: u32,
    row: u32,
    /// Turned around, as every second one of a row is.
    is_turned: bool,
}

impl Pieces {
    pub(crate) fn new(steps: u32) -> Self {
        Self { steps }
    }

    pub(crate) fn len(self) -> usize {
        self.steps as usize * self.steps as usize
    }

    pub(crate) fn iter(self) -> impl Iterator<Item = Piece> {
        let steps = self.steps;
        let row = move |row: u32| {
            (0..2 * (steps - row) - 1).map(move |place| Piece {
                steps,
                column: place / 2,
                row,
                is_turned: place % 2 == 1,
            })
        };
        (0..steps).flat_map(row)
    }
}

impl Piece {
    /// The barycentric weights, in the whole triangle, of a place in this piece.
    pub(crate) fn place(self, right: f32, up: f32) -> Vec3 {
        let (right, up) = if self.is_turned { (1.0 - right, 1.0 - up) } else { (right, up) };
        let (v, w) =
            ((self.column as f32 + right) / self.steps as f32, (self.row as f32 + up) / self.steps as f32);
        Vec3::new((1.0 - v - w).max(0.0), v, w)
    }

    pub(crate) fn middle(self) -> Vec3 {
        self.place(1.0 / 3.0, 1.0 / 3.0)
    }

    pub(crate) fn corners(self) -> [Vec3; 3] {
        [self.place(0.0, 0.0), self.place(1.0, 0.0), self.place(0.0, 1.0)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_stand_at_the_middles_of_their_places_and_repeat() {
        let map = DensityMap::new(2, 2, vec![0.0, 1.0, 0.25, 0.5]).expect("four values");
        assert_eq!(map.at(Vec2::new(0.25, 0.25)), 0.0);
        assert_eq!(map.at(Vec2::new(0.75, 0.25)), 1.0);
        assert_eq!(map.at(Vec2::new(0.25, 0.75)), 0.25);
        assert_eq!(map.at(Vec2::new(0.5, 0.25)), 0.5);
        assert_eq!(map.at(Vec2::new(0.0, 0.25)), 0.5, "half of its neighbour over the edge");
        assert_eq!(map.at(Vec2::new(3.75, -1.75)), 1.0);
        assert_eq!(map.at(Vec2::new(f32::NAN, 0.0)), 0.0);
        for uv in [-1e-9, 1.0 - f32::EPSILON / 2.0, -0.0, 1e9, -1e30] {
            assert!(map.at(Vec2::splat(uv)) <= 1.0);
        }
    }

    #[test]
    fn the_mean_sees_what_the_corners_do_not() {
        let mut values = vec![0.0; 32 * 32];
        for row in 8..16 {
            values[row * 32 + 8..row * 32 + 16].fill(1.0);
        }
        let map = DensityMap::new(32, 32, values).expect("as many values");
        let uvs = [Vec2::new(0.02, 0.02), Vec2::new(0.98, 0.02), Vec2::new(0.02, 0.98)];
        assert_eq!(uvs.map(|uv| map.at(uv)), [0.0; 3]);
        let expected = (0.25 * 0.25) / (0.5 * 0.96 * 0.96);
        assert!((map.mean(uvs) - expected).abs() < 0.01 * expected, "{} for {expected}", map.mean(uvs));
    }

    #[test]
    fn pieces_cover_the_triangle_once() {
        for steps in [1, 2, 7] {
            let pieces = Pieces::new(steps);
            assert_eq!(pieces.iter().count(), pieces.len());
            let sum: Vec3 = pieces.iter().map(Piece::middle).sum();
            assert!((sum / pieces.len() as f32 - Vec3::splat(1.0 / 3.0)).length() < 1e-5);
        }
    }

    #[test]
    fn what_is_no_density_is_refused() {
        assert_eq!(DensityMap::new(0, 0, vec![]), Err(DensityError::Size { width: 0, height: 0, found: 0 }));
        let short = DensityError::Size { width: 2, height: 2, found: 3 };
        assert_eq!(DensityMap::from_bytes(2, 2, &[0; 3]), Err(short));
        for value in [-0.5, f32::NAN, f32::INFINITY] {
            assert_eq!(DensityMap::new(1, 2, vec![0.0, value]), Err(DensityError::Value { index: 1 }));
        }
    }
}
