//! Creases and hollows that are too narrow for hair.

use crate::grid::{Grid, Nearest, places};

/// Below the skin by more than so many cells no crease reaches.
const DEEPEST: f32 = 3.0;
/// By how much less creases are filled, in cells: the surface of the ball's reach is known from single places
/// on it, so all that is convex would become a little thicker. Found by trial.
const LEAST: f32 = 0.65;
/// How thick the layer of places is, in cells, from which the surface of the ball's reach is known.
const LAYER: f32 = 2.0;

/// Makes distances from the skin of a grid those from all that a ball of this radius cannot touch from
/// outside: the closing of the skin's inside, J. Serra, "Image Analysis and Mathematical Morphology", 1982.
/// What is convex stays as it is, and so do distances of at least the radius.
///
/// The ball's middle reaches all places at least its radius away from the skin to which it can roll from the
/// edge of the grid: the sockets behind the eyes are wide enough for it, but their openings are not. What it
/// cannot touch is further from these places than the radius.
pub(crate) fn fill(grid: &Grid, distances: &mut [f32], radius: f32) {
    let is_reached = reached(grid, distances, radius);
    let mut reach = grid.emptied();
    for (index, distance) in distances.iter().enumerate() {
        if is_reached[index] && *distance < radius + LAYER * grid.cell {
            // On the way to the nearest point of the skin, this one is exactly at the radius.
            let (place, near) = (grid.place_of(index), grid.nearest[index].point);
            let point = near + (place - near) * (radius / *distance);
            reach.nearest[index] = Nearest { point, squared: point.distance_squared(place), ..Nearest::NONE };
        }
    }
    let is_open: Vec<bool> = (distances.iter().zip(&is_reached))
        .map(|(distance, is_reached)| *distance >= -DEEPEST * grid.cell && !is_reached)
        .collect();
    reach.sweep(&is_open);
    for ((distance, nearest), is_open) in distances.iter_mut().zip(&reach.nearest).zip(is_open) {
        if is_open && nearest.squared.is_finite() {
            *distance = distance.min(radius - nearest.squared.sqrt() + LEAST * grid.cell);
        }
    }
}

/// To which places the middle of a ball of this radius comes from the edge of the grid, over neighbours.
fn reached(grid: &Grid, distances: &[f32], radius: f32) -> Vec<bool> {
    let [nx, ny, nz] = grid.size;
    let mut is_reached = vec![false; distances.len()];
    let mut ahead: Vec<(usize, [usize; 3])> = Vec::new();
    let step = |index: usize, at: [usize; 3], is_reached: &mut [bool], ahead: &mut Vec<_>| {
        if distances[index] >= radius && !is_reached[index] {
            is_reached[index] = true;
            ahead.push((index, at));
        }
    };
    for (index, [x, y, z]) in places(grid.size).enumerate() {
        if x == 0 || y == 0 || z == 0 || x + 1 == nx || y + 1 == ny || z + 1 == nz {
            step(index, [x, y, z], &mut is_reached, &mut ahead);
        }
    }
    let strides = [1, nx, nx * ny];
    while let Some((index, at)) = ahead.pop() {
        for axis in 0..3 {
            let beside = |along: usize| std::array::from_fn(|i| if i == axis { along } else { at[i] });
            if at[axis] > 0 {
                step(index - strides[axis], beside(at[axis] - 1), &mut is_reached, &mut ahead);
            }
            if at[axis] + 1 < grid.size[axis] {
                step(index + strides[axis], beside(at[axis] + 1), &mut is_reached, &mut ahead);
            }
        }
    }
    is_reached
}
