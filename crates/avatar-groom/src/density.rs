use crate::pieces::Pieces;
use glam::Vec2;
use std::ops::Range;

/// How dense hair grows over texture coordinates: 0 nowhere, 1 fully. The origin is the top left corner; it
/// repeats.
#[derive(Clone, Debug, PartialEq)]
pub struct DensityMap {
    width: u32,
    height: u32,
    values: Vec<u8>,
    /// Least and largest of each square of [`BLOCK`] × [`BLOCK`] values, row by row.
    blocks: Vec<(u8, u8)>,
}

/// Side of a block. On most of a head the density is 0 or 1 over whole blocks, which is then known at once.
const BLOCK: u32 = 16;

/// The densities of all values.
const SHARES: [f32; 256] = {
    let mut shares = [0.0; 256];
    let mut value = 0;
    while value < 256 {
        shares[value] = value as f32 / 255.0;
        value += 1;
    }
    shares
};

/// How much longer pieces may be where the map is even.
const EVEN_VALUES: f32 = 6.0;

impl DensityMap {
    /// A map of `width` × `height` values row by row, 0 to 255; `None` for another number of values or 0.
    pub fn new(width: u32, height: u32, values: Vec<u8>) -> Option<Self> {
        let count = u64::from(width) * u64::from(height);
        if count == 0 || count != values.len() as u64 {
            return None;
        }
        let across = width.div_ceil(BLOCK) as usize;
        let mut blocks = vec![(u8::MAX, 0); across * height.div_ceil(BLOCK) as usize];
        for (y, row) in values.chunks(width as usize).enumerate() {
            for (x, part) in row.chunks(BLOCK as usize).enumerate() {
                let block = &mut blocks[y / BLOCK as usize * across + x];
                *block = part.iter().fold(*block, |(low, high), value| (low.min(*value), high.max(*value)));
            }
        }
        Some(Self { width, height, values, blocks })
    }

    /// Values per unit of texture coordinates, across and down.
    pub(crate) fn size(&self) -> Vec2 {
        Vec2::new(self.width as f32, self.height as f32)
    }

    /// The density at a place, between the nearest four values.
    pub fn at(&self, uv: Vec2) -> f32 {
        if !uv.is_finite() {
            return 0.0;
        }
        // The fraction first: it keeps its digits where coordinates have left 0…1.
        let place = (uv - uv.floor()) * self.size() - 0.5;
        let low = place.floor();
        let share = place - low;
        // One step beyond the edge at most, on either side.
        let wrap = |at: i32, size: u32| match u32::try_from(at) {
            Ok(at) if at < size => at,
            Ok(at) => at % size,
            Err(_) => size - 1,
        };
        let (x0, y0) = (wrap(low.x as i32, self.width), wrap(low.y as i32, self.height));
        let next = |at: u32, size: u32| if at + 1 == size { 0 } else { at + 1 };
        let (x1, y1) = (next(x0, self.width), next(y0, self.height));
        let value = |x: u32, y: u32| {
            self.values
                .get(y as usize * self.width as usize + x as usize)
                .map_or(0.0, |value| SHARES[usize::from(*value)])
        };
        let mix = |a: f32, b: f32, t: f32| a + (b - a) * t;
        let above = mix(value(x0, y0), value(x1, y0), share.x);
        mix(above, mix(value(x0, y1), value(x1, y1), share.x), share.y)
    }

    /// Cuts a triangle so that the map is nearly even on each piece; `None` where it is 0 all over.
    pub(crate) fn pieces(&self, uvs: [Vec2; 3]) -> Option<Pieces> {
        match self.range_at(uvs)? {
            (_, 0) => None,
            // Even places are cut only because of the regions, whose edges the map does not show.
            (low, high) if low == high => Some(Pieces::of(uvs, self.size() / EVEN_VALUES)),
            _ => Some(Pieces::of(uvs, self.size())),
        }
    }

    /// A lower and an upper bound of the map's values on a triangle; `None` if the triangle reads no value of
    /// the map.
    fn range_at(&self, uvs: [Vec2; 3]) -> Option<(u8, u8)> {
        let size = self.size();
        let (low, high) = (uvs[0].min(uvs[1]).min(uvs[2]) * size, uvs[0].max(uvs[1]).max(uvs[2]) * size);
        if uvs.iter().any(|uv| !uv.is_finite()) {
            return None;
        }
        let (rows, columns) = (spans(low.y, high.y, self.height), spans(low.x, high.x, self.width));
        let across = self.width.div_ceil(BLOCK);
        let seen = rows.into_iter().flat_map(blocks).flat_map(|row| {
            let columns = columns.clone().into_iter().flat_map(blocks);
            columns.filter_map(move |column| self.blocks.get((row * across + column) as usize))
        });
        seen.copied()
            .reduce(|(low, high), (other_low, other_high)| (low.min(other_low), high.max(other_high)))
    }
}

/// The values that are read from `low` to `high`: one or two ranges, because the map repeats.
fn spans(low: f32, high: f32, size: u32) -> [Range<u32>; 2] {
    // A value on either side, and what rounding of large coordinates may come to.
    let slack = 2.0 + (low.abs() + high.abs()) * 1e-5;
    let count = (high - low + 2.0 * slack).ceil();
    // No number where coordinates are too large.
    if count.is_nan() || count >= size as f32 {
        return [0..size, 0..0];
    }
    let first = ((low - slack).floor().rem_euclid(size as f32) as u32).min(size - 1);
    let end = first + count as u32 + 1;
    [first..end.min(size), 0..end.saturating_sub(size).min(size)]
}

/// The blocks that these values are in.
fn blocks(values: Range<u32>) -> Range<u32> {
    values.start / BLOCK..values.end.div_ceil(BLOCK)
}
