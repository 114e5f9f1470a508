//! Rows of vertices that follow the features: around the eye, around the mouth, around the ear's root, along
//! the bust's edge and over the crown.

use glam::{DVec2, DVec3};

use super::{
    chart::{self, Place},
    ear_root::{self, EAR_AROUND},
    half::{Half, Node},
};
use crate::{
    anatomy::{
        BUST_EDGE_Y, EYE, MOUTH_HALF_WIDTH, MOUTH_Y, lid_margin, lower_lip, mouth_depth, mouth_line,
        upper_lip,
    },
    form::HEM_EDGE,
    math::{cos, curve, lerp, sin, smooth},
};

const PI: f64 = std::f64::consts::PI;

/// Vertices around an eye; every ring is a closed row.
pub const EYE_AROUND: usize = 76;
/// Vertices from the middle of the upper lip over the corner to the middle of the lower lip.
pub const MOUTH_AROUND: usize = 61;

/// Where the outer skin stops, as rows of vertex numbers.
#[derive(Clone, Debug, Default)]
pub struct Loops {
    /// Outer edge of the lids, counter-clockwise seen from the front, from the inner corner along the lower
    /// lid.
    pub eye: Vec<usize>,
    /// Line between the lips: from the midline of the upper lip over the corner to that of the lower lip.
    pub mouth: Vec<usize>,
    /// The ear's root, counter-clockwise seen from the character's left.
    pub ear: Vec<usize>,
    /// The bust's lower edge, from the front to the back.
    pub edge: Vec<usize>,
    /// All rings around the eye, from the lids' edge outward; each runs like `eye`.
    pub eye_rings: Vec<Vec<usize>>,
    /// All rows around the mouth, from the lips' line outward; each runs like `mouth`.
    pub mouth_rings: Vec<Vec<usize>>,
    /// Last ring around the eye, in the flat chart.
    pub eye_outline: Vec<DVec2>,
    /// Last ring around the mouth, in the flat chart, closed over the midline.
    pub mouth_outline: Vec<DVec2>,
}

/// How much of the steps along lids and lips is even. Steps of a circle seen from its side shrink to nothing
/// toward the corners, and triangles that thin fold long before any other does.
const LIDS_EVEN: f64 = 0.2;
/// See [`LIDS_EVEN`].
const LIPS_EVEN: f64 = 0.2;

/// How far from the inner (0) to the outer corner of the eye (1) a vertex of the rings around it stands, by
/// its place along the ring.
fn along_lids(at: f64) -> f64 {
    let turn = 2.0 * at / EYE_AROUND as f64;
    let turn = if turn > 1.0 { 2.0 - turn } else { turn };
    lerp(0.5 * (1.0 - cos(PI * turn)), turn, LIDS_EVEN)
}

/// The place along the ring's lower half that `along_lids` takes to `s`.
pub fn at_lids(s: f64) -> f64 {
    let (mut low, mut high) = (0.0, 0.5 * EYE_AROUND as f64);
    for _ in 0..40 {
        let middle = 0.5 * (low + high);
        if along_lids(middle) < s { low = middle } else { high = middle }
    }
    low
}

/// How far from the midline (0) to the corner of the mouth (1) a vertex of the line between the lips stands.
fn along_lips(i: usize) -> f64 {
    let half = (MOUTH_AROUND / 2) as f64;
    let aside = 1.0 - (i as f64 - half).abs() / half;
    lerp(sin(0.5 * PI * aside), aside, LIPS_EVEN)
}

/// Spreads ring fractions so that rings are dense at the feature.
fn graded(k: usize, count: usize) -> f64 {
    let s = k as f64 / count as f64;
    0.55 * s + 0.45 * s * s
}

/// Adds the rings around the eye.
pub fn eye(half: &mut Half, loops: &mut Loops) {
    const RINGS: usize = 11;
    let centre = chart::place_of(chart::leave(EYE + DVec3::Z * 1.2, DVec3::Z));
    let mut inner = Vec::new();
    for i in 0..EYE_AROUND {
        let lower = i < EYE_AROUND / 2;
        let flat = lid_margin(along_lids(i as f64), !lower);
        // Straight from the front: where the opening ends is then where the weights say it ends.
        let p = chart::cast(EYE + DVec3::new(flat.x, flat.y, 6.0), DVec3::NEG_Z);
        inner.push(chart::place_of(p));
        loops.eye.push(half.add(Node { lower, lid: 0.0, ..Node::sheet(p) }));
    }
    loops.eye_rings.push(loops.eye.clone());
    for k in 1..=RINGS {
        let f = graded(k, RINGS);
        let mut ring = Vec::with_capacity(EYE_AROUND);
        for (i, &from) in inner.iter().enumerate() {
            let tau = 2.0 * PI * i as f64 / EYE_AROUND as f64;
            // The last ring is an oval around the eye; the bridge of the nose leaves less room on its side.
            let (dx, dy) = (-cos(tau), -sin(tau));
            let reach_x = if dx < 0.0 { 0.225 } else { 0.275 };
            let reach_y = if dy > 0.0 { 0.235 } else { 0.215 };
            let to = Place { phi: centre.phi + 0.012 + reach_x * dx, t: centre.t + reach_y * dy };
            let place = Place { phi: lerp(from.phi, to.phi, f), t: lerp(from.t, to.t, f) };
            let p = chart::point(place);
            ring.push(half.add(Node { lower: i < EYE_AROUND / 2, lid: f, ..Node::sheet(p) }));
            if k == RINGS {
                loops.eye_outline.push(chart::flat(place));
            }
        }
        loops.eye_rings.push(ring);
    }
}

/// Adds the rings around the mouth: through the red of the lips, then out to an oval.
pub fn mouth(half: &mut Half, loops: &mut Loops) {
    const LIP_RINGS: usize = 7;
    const OUTER_RINGS: usize = 8;
    let middle = MOUTH_AROUND / 2;
    for k in 0..=(LIP_RINGS + OUTER_RINGS) {
        let mut ring = Vec::with_capacity(MOUTH_AROUND);
        for i in 0..MOUTH_AROUND {
            let tau = PI * (0.5 - i as f64 / (MOUTH_AROUND - 1) as f64);
            let on_midline = i == 0 || i == MOUTH_AROUND - 1;
            let (u, round) = if on_midline { (0.0, 0.0) } else { (along_lips(i), cos(tau)) };
            let lower = i > middle;
            let line = mouth_line(u);
            // The lips press into each other by a trace: a hair's gap would show as a broken line.
            let gap = if i == middle { 0.0 } else { -0.004 * smooth(0.0, 0.2, 1.0 - u) };
            let slit = DVec2::new(line.x, line.y + if lower { -gap } else { gap });
            let height = if lower { -lower_lip(u) } else { upper_lip(u) };
            let corner = smooth(0.8, 1.0, u);
            let border = DVec2::new(line.x + 0.10 * corner, line.y + if i == middle { 0.0 } else { height });
            let oval = DVec2::new(
                round * (MOUTH_HALF_WIDTH + 1.05),
                MOUTH_Y + sin(tau) * if lower { 1.85 } else { 1.30 },
            );
            let (at, lip) = if k <= LIP_RINGS {
                let f = k as f64 / LIP_RINGS as f64;
                (slit.lerp(border, f), f)
            } else {
                let f = graded(k - LIP_RINGS, OUTER_RINGS);
                (border.lerp(oval, f), 1.0 + f)
            };
            let p = chart::cast(DVec3::new(at.x, at.y, 9.0), DVec3::NEG_Z);
            let even = lerp(mouth_depth(u), p.z, smooth(1.1, 2.0, lip));
            // In the chart the slit stands open: both sides get room, and no triangle can cross it.
            let open = if lower { -0.05 } else { 0.05 } * (1.0 - u * u) * (1.0 - lip).max(0.0);
            let place = chart::place_of(DVec3::new(at.x, at.y + open, even));
            ring.push(half.add(Node { lower, lip, place, ..Node::sheet(p) }));
            if k == LIP_RINGS + OUTER_RINGS {
                loops.mouth_outline.push(chart::flat(place));
            }
        }
        loops.mouth_rings.push(ring);
    }
    loops.mouth = loops.mouth_rings[0].clone();
}

/// Joins the rings with triangles.
pub fn stitch(half: &mut Half, loops: &Loops) {
    for pair in loops.eye_rings.windows(2) {
        half.stitch(&pair[1], &pair[0], true);
    }
    // Rows around the mouth run clockwise; turned around, the lips lie on their left.
    let turned = |row: &[usize]| row.iter().rev().copied().collect::<Vec<_>>();
    for pair in loops.mouth_rings.windows(2) {
        half.stitch(&turned(&pair[1]), &turned(&pair[0]), false);
    }
}

/// Adds the ring where the ear grows out of the head.
pub fn ear(half: &mut Half, loops: &mut Loops) {
    for i in 0..EAR_AROUND {
        let beta = 2.0 * PI * i as f64 / EAR_AROUND as f64;
        let at = ear_root::root(beta);
        let p = chart::cast(DVec3::new(14.0, at.y, at.x), DVec3::NEG_X);
        loops.ear.push(half.add(Node::sheet(p)));
    }
}

/// Adds the bust's lower edge, from the front to the back.
pub fn edge(half: &mut Half, loops: &mut Loops) {
    const COUNT: usize = 48;
    for i in 0..=COUNT {
        let place = chart::edge_place(PI * (i as f64 / COUNT as f64), BUST_EDGE_Y);
        let p = chart::point(place);
        loops.edge.push(half.add(Node::sheet(DVec3::new(p.x, BUST_EDGE_Y, p.z))));
    }
}

/// Adds the neckline of the top, from the front to the back: a row on the skin, and two that rise to the
/// cloth.
pub fn neckline(half: &mut Half) {
    const COUNT: usize = 62;
    const FINE: usize = 400;
    // Even steps along the line: where it runs over the shoulder, even turns would leave wide gaps.
    let turn = |i: usize| PI * (i as f64 / FINE as f64);
    let line: Vec<DVec3> = (0..=FINE).map(|i| chart::point(chart::neckline_place(turn(i), 0.0))).collect();
    let mut run = vec![(0.0, 0.0)];
    for (i, pair) in line.windows(2).enumerate() {
        run.push((run[i].0 + (pair[1] - pair[0]).length(), turn(i + 1)));
    }
    let whole = run[FINE].0;
    // Behind the collarbone rays go past a hollow, and with them several rows: each lies beyond the one
    // before.
    const BEYOND: f64 = 0.0025;
    let mut nearest = vec![f64::INFINITY; COUNT + 1];
    for below in [0.0, 0.5 * HEM_EDGE, HEM_EDGE] {
        for (i, nearest) in nearest.iter_mut().enumerate() {
            let phi = curve(&run, whole * (i as f64 / COUNT as f64));
            let place = chart::neckline_place(phi, below);
            let place = Place { t: place.t.min(*nearest), ..place };
            *nearest = place.t - BEYOND;
            half.add(Node { place, ..Node::sheet(chart::point(place)) });
        }
    }
}

/// Adds a regular cap around the pole of the chart, whose layout would otherwise fold there.
pub fn crown(half: &mut Half) {
    half.add(Node::sheet(chart::point(Place { phi: 0.0, t: 0.5 * PI })));
    for (ring, count) in [(0.075, 5), (0.15, 9), (0.225, 13)] {
        for i in 0..=count {
            let place = Place { phi: PI * (f64::from(i) / f64::from(count)), t: 0.5 * PI - ring };
            half.add(Node::sheet(chart::point(place)));
        }
    }
}
