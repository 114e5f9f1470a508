//! The fine relief of skin: small round bumps between grooves, as a tile of tangent-space normals.

/// Pixels of the tile on a side.
pub(crate) const PORE_SIZE: u32 = 128;
/// Bumps of the tile on a side.
pub(crate) const PORE_CELLS: u32 = 12;

/// Red and green of a normal map, per pixel: 0.5 is flat.
pub(crate) fn pore_tile() -> Vec<[u8; 2]> {
    let pixels = || (0..PORE_SIZE).flat_map(|y| (0..PORE_SIZE).map(move |x| (x, y)));
    let heights: Vec<f32> = pixels()
        .map(|(x, y)| {
            let at = |v: u32| (v as f32 + 0.5) / PORE_SIZE as f32;
            height(at(x), at(y))
        })
        .collect();
    let at = |x: u32, y: u32| heights[((y % PORE_SIZE) * PORE_SIZE + x % PORE_SIZE) as usize];
    // Slopes per cell: 1 means that the height changes by one cell's width over one cell.
    let slope = PORE_SIZE as f32 / (2.0 * PORE_CELLS as f32);
    let byte = |value: f32| (value.clamp(-1.0, 1.0) * 127.0 + 127.5) as u8;
    pixels()
        .map(|(x, y)| {
            let dx = (at(x + 1, y) - at(x + PORE_SIZE - 1, y)) * slope;
            // Rows of the tile run downward; its green points upward.
            let dy = (at(x, y + PORE_SIZE - 1) - at(x, y + 1)) * slope;
            [byte(-dx), byte(-dy)]
        })
        .collect()
}

/// Distance to the nearest of scattered points, rounded: S. Worley, "A Cellular Texture Basis Function",
/// 1996.
fn height(u: f32, v: f32) -> f32 {
    let cells = PORE_CELLS as i32;
    let (x, y) = (u * cells as f32, v * cells as f32);
    let (column, row) = (x.floor() as i32, y.floor() as i32);
    let mut nearest = f32::MAX;
    for (dy, dx) in (-1..=1).flat_map(|dy| (-1..=1).map(move |dx| (dy, dx))) {
        let (cx, cy) = (column + dx, row + dy);
        let [jx, jy] = jitter(cx.rem_euclid(cells) as u32, cy.rem_euclid(cells) as u32);
        let (px, py) = (cx as f32 + 0.5 + 0.38 * jx, cy as f32 + 0.5 + 0.38 * jy);
        nearest = nearest.min((px - x).hypot(py - y));
    }
    1.0 - (nearest * nearest).min(1.0)
}

/// Two numbers from −1 to 1 that belong to a cell.
fn jitter(x: u32, y: u32) -> [f32; 2] {
    let hash = |seed: u32| {
        let mut h = x.wrapping_mul(0x9E37_79B1) ^ y.wrapping_mul(0x85EB_CA77) ^ seed;
        h = (h ^ (h >> 15)).wrapping_mul(0x2C1B_3C6D);
        h = (h ^ (h >> 12)).wrapping_mul(0x297A_2D39);
        ((h ^ (h >> 15)) >> 8) as f32 / (1u32 << 23) as f32 - 1.0
    };
    [hash(1), hash(2)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_tile_is_flat_on_the_whole_and_repeats_without_a_seam() {
        let tile = pore_tile();
        for channel in 0..2 {
            let mean = tile.iter().map(|p| f64::from(p[channel])).sum::<f64>() / tile.len() as f64;
            assert!((mean - 127.5).abs() < 1.0, "{mean}");
        }
        for at in [0.11f32, 0.5, 0.93] {
            assert!((height(0.0, at) - height(1.0, at)).abs() < 1e-3);
            assert!((height(at, 0.0) - height(at, 1.0)).abs() < 1e-3);
        }
    }
}
