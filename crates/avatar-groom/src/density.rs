use glam::Vec2;

/// How dense hair grows over texture coordinates: 0 nowhere, 1 fully. The origin is the top left corner; it repeats.
#[derive(Clone, Debug, PartialEq)]
pub struct DensityMap {
    width: u32,
    height: u32,
    values: Vec<u8>,
}

/// Places per edge of a triangle at which its mean is taken.
const STEPS: u32 = 6;

impl DensityMap {
    /// A map of `width` × `height` values row by row, 0 to 255; `None` where there are not as many.
    pub fn new(width: u32, height: u32, values: Vec<u8>) -> Option<Self> {
        let count = u64::from(width) * u64::from(height);
        (count > 0 && count == values.len() as u64).then_some(Self { width, height, values })
    }

    /// The density at a place, between the nearest four values.
    pub fn at(&self, uv: Vec2) -> f32 {
        if !uv.is_finite() {
            return 0.0;
        }
        let size = Vec2::new(self.width as f32, self.height as f32);
        let place = (uv - uv.floor()) * size - 0.5;
        let (low, share) = (place.floor(), place - place.floor());
        let value = |dx: i32, dy: i32| {
            let x = (low.x as i32 + dx).rem_euclid(self.width as i32) as usize;
            let y = (low.y as i32 + dy).rem_euclid(self.height as i32) as usize;
            self.values.get(y * self.width as usize + x).map_or(0.0, |v| f32::from(*v) / 255.0)
        };
        let mix = |a: f32, b: f32, t: f32| a + (b - a) * t;
        mix(mix(value(0, 0), value(1, 0), share.x), mix(value(0, 1), value(1, 1), share.x), share.y)
    }

    /// The mean over a triangle: over the middles of the small triangles that an even grid cuts it into.
    pub fn mean(&self, [a, b, c]: [Vec2; 3]) -> f32 {
        let n = STEPS as f32;
        let at = |i: f32, j: f32| self.at(a + (b - a) * (i / n) + (c - a) * (j / n));
        let mut sum = 0.0;
        for i in 0..STEPS {
            for j in 0..STEPS - i {
                let (x, y) = (i as f32, j as f32);
                sum += at(x + 1.0 / 3.0, y + 1.0 / 3.0);
                if i + j + 1 < STEPS {
                    sum += at(x + 2.0 / 3.0, y + 2.0 / 3.0);
                }
            }
        }
        sum / (n * n)
    }
}
