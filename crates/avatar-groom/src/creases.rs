//! Creases that are too narrow for hair.

use crate::grid::{Grid, Nearest};

/// Below the skin by more than so many cells no crease reaches.
const DEEPEST: f32 = 3.0;
/// By how much less creases are filled, in cells: the surface of the ball's reach is known from single places
/// on it, so that all that is convex would become a little thicker.
const LEAST: f32 = 0.65;
/// How thick the layer of places is, in cells, from which the surface of the ball's reach is known.
const LAYER: f32 = 2.0;

/// Makes distances from the skin of a grid those from all that a ball of this radius cannot touch from
/// outside: the closing of the skin's inside, J. Serra, "Image Analysis and Mathematical Morphology", 1982.
/// What is convex stays as it is, and so do distances of at least the radius.
///
/// The ball's middle reaches all places at least its radius away from the skin. What it cannot touch is
/// further from these than the radius.
pub(crate) fn fill(grid: &Grid, distances: &mut [f32], radius: f32) {
    let mut reach = grid.emptied();
    for (index, distance) in distances.iter().enumerate() {
        if (radius..radius + LAYER * grid.cell).contains(distance) {
            // On the way to the nearest point of the skin, this one is exactly at the radius.
            let (place, near) = (grid.place_of(index), grid.nearest[index].point);
            let point = near + (place - near) * (radius / *distance);
            reach.nearest[index] = Nearest { point, squared: point.distance_squared(place), ..Nearest::NONE };
        }
    }
    let is_open: Vec<bool> =
        (distances.iter()).map(|distance| (-DEEPEST * grid.cell..radius).contains(distance)).collect();
    reach.sweep(&is_open);
    for ((distance, nearest), is_open) in distances.iter_mut().zip(&reach.nearest).zip(is_open) {
        if is_open && nearest.squared.is_finite() {
            *distance = distance.min(radius - nearest.squared.sqrt() + LEAST * grid.cell);
        }
    }
}
