//! Texture coordinates: the chart of the outer skin, and rectangles for the swept parts below it.

use glam::DVec2;

use crate::{
    form,
    math::curve,
    surface::{
        chart::Place,
        half::{Half, Node, Patch},
    },
};

/// Turn → distance from the image's middle, in halves of its width: the face gets most of the pixels.
const ACROSS: [(f64, f64); 5] =
    [(0.0, 0.0), (0.9, 0.48), (1.35, 0.69), (2.1, 0.86), (3.141_592_653_589_793_6, 0.998)];
/// Elevation → height in the image. The crown stays off the edge: smaller versions of the image repeat across
/// it. So does the bust's edge from the swept parts, whose colours would run onto the top.
const DOWN: [(f64, f64); 9] = [
    (-5.2, 0.850),
    (-3.6, 0.828),
    (-2.5, 0.785),
    (-1.4, 0.75),
    (-0.95, 0.705),
    (0.0, 0.37),
    (0.6, 0.16),
    (1.0, 0.075),
    (1.6, 0.012),
];

/// Elevation → width in the image. In front of the chest turns are narrow: at the whole width smaller
/// versions of the image, chosen by the width, would mix skin from above and below into the top.
const WIDTH: [(f64, f64); 4] = [(-5.2, 0.4), (-1.75, 0.42), (-0.95, 1.0), (1.6, 1.0)];

/// Below this height the picture holds only swept parts.
pub const STRIP_TOP: f64 = 0.9;

/// Rectangles (left, top, width, height) of the swept parts, for the left half.
const MOUTH: (f64, f64, f64, f64) = (0.505, 0.905, 0.08, 0.085);
const LASHES: (f64, f64, f64, f64) = (0.595, 0.905, 0.035, 0.085);
const SOCKET: (f64, f64, f64, f64) = (0.64, 0.905, 0.14, 0.085);
const EAR: (f64, f64, f64, f64) = (0.79, 0.905, 0.20, 0.085);

/// By how much the cloth lies lower in the picture than skin in its place would: between the two is room, so
/// that none of the one's colour is drawn onto the other, even in the small pictures that are made of it.
const HEM_GAP: f64 = 0.03;

/// Whether a triangle with these corners belongs to the top: a row of vertices lies on its neckline.
#[must_use]
pub fn is_cloth(corners: &[Node; 3]) -> bool {
    corners.iter().all(|n| n.patch == Patch::Sheet && form::below_neckline(n.p) > -1e-3)
}

/// Texture coordinates of the three corners of a triangle of the left half.
#[must_use]
pub fn corners(half: &Half, triangle: &[usize; 3]) -> [DVec2; 3] {
    let nodes = triangle.map(|i| half.nodes[i]);
    match nodes.iter().find(|n| n.patch != Patch::Sheet) {
        None => {
            let below = if is_cloth(&nodes) { HEM_GAP } else { 0.0 };
            sheet(nodes.map(|n| n.place)).map(|uv| uv + DVec2::new(0.0, below))
        }
        Some(swept) => {
            let (rect, closed) = match swept.patch {
                Patch::Mouth => (MOUTH, false),
                Patch::Ear => (EAR, true),
                Patch::Lash => (LASHES, false),
                _ => (SOCKET, true),
            };
            let mut own = nodes.map(|n| n.own);
            if swept.patch == Patch::Lash {
                return own.map(|o| DVec2::new(rect.0 + rect.2 * o.x, rect.1 + rect.3 * o.y));
            }
            let wide = own.iter().any(|o| o.x < 1.0 && o.y > 0.5);
            for o in &mut own {
                if closed && wide && o.y == 0.0 && o.x < 1.0 {
                    o.y = 1.0;
                }
            }
            // The last row ends in a point that belongs to all places along it.
            if let Some(k) = own.iter().position(|o| o.x == 1.0) {
                own[k].y = 0.5 * (own[(k + 1) % 3].y + own[(k + 2) % 3].y);
            }
            // Closed rows run the other way round than the mouth's: turned, no part of the picture is
            // mirrored.
            let across = |y: f64| if closed { 1.0 - y } else { y };
            own.map(|o| DVec2::new(rect.0 + rect.2 * across(o.y), rect.1 + rect.3 * o.x))
        }
    }
}

fn sheet(mut places: [Place; 3]) -> [DVec2; 3] {
    let pole = |t: f64| t > 1.565;
    if let Some(k) = places.iter().position(|p| pole(p.t)) {
        places[k].phi = 0.5 * (places[(k + 1) % 3].phi + places[(k + 2) % 3].phi);
    }
    places.map(|p| DVec2::new(0.5 + 0.5 * curve(&ACROSS, p.phi) * curve(&WIDTH, p.t), curve(&DOWN, p.t)))
}
