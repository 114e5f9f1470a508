//! Vertices for the rest of the skin: dense where the form is fine, wide on the scalp.

use glam::{DVec2, DVec3};

use super::{
    chart::{self, Place},
    half::{Half, Node},
    rings::Loops,
};
use crate::math::{bell3, lerp, smooth};

const PI: f64 = std::f64::consts::PI;

/// Wanted distance between neighbours at a point of the skin.
#[must_use]
pub fn spacing(p: DVec3) -> f64 {
    let face = smooth(-4.5, 1.0, p.z) * smooth(-11.5, -10.0, p.y) * smooth(7.0, 4.0, p.y);
    let h = lerp(0.88, 0.30, face);
    let nose = bell3(p, DVec3::new(0.5, -3.3, 5.0), DVec3::new(1.6, 1.3, 1.7));
    let bridge = bell3(p, DVec3::new(0.4, -0.8, 4.2), DVec3::new(1.3, 2.4, 1.7));
    let nose = nose.max(0.75 * bridge);
    let brow = bell3(p, DVec3::new(2.6, 1.9, 3.6), DVec3::new(2.6, 0.9, 1.8));
    let nose = nose.max(0.6 * brow);
    // The cheek folds here when she smiles.
    let fold = bell3(p, DVec3::new(2.15, -3.75, 3.7), DVec3::new(0.75, 0.9, 1.2));
    let h = lerp(h, 0.2, fold);
    let ear = bell3(p, DVec3::new(7.0, -1.5, -5.3), DVec3::new(2.0, 3.0, 2.0));
    let throat = smooth(-5.0, -8.0, p.y) * smooth(-13.0, -11.5, p.y) * smooth(-9.0, -6.5, p.z);
    let h = h.min(lerp(h, 0.31, throat));
    // The corner of the jaw is an outline that one sees.
    let jaw = bell3(p, DVec3::new(4.6, -7.0, -2.8), DVec3::new(1.4, 2.0, 2.2));
    let h = h.min(lerp(h, 0.40, jaw));
    let h = lerp(h, 0.62, smooth(-11.0, -13.0, p.y));
    let below = smooth(-17.5, -20.5, p.y).max(smooth(6.5, 10.0, p.x) * smooth(-11.0, -13.0, p.y));
    let h = lerp(h, 0.86, below);
    let bone = bell3(p, DVec3::new(4.2, -17.0, -3.0), DVec3::new(4.5, 1.5, 2.6));
    let h = lerp(h, 0.42, bone);
    lerp(lerp(h, 0.115, nose.min(1.0)), 0.3, ear)
}

/// Buckets of points for quick neighbour checks.
struct Buckets {
    cells: Vec<Vec<DVec3>>,
}

impl Buckets {
    const SIDE: usize = 48;

    fn new() -> Self {
        Self { cells: vec![Vec::new(); Self::SIDE * Self::SIDE * Self::SIDE] }
    }

    fn cell(p: DVec3) -> [usize; 3] {
        let at = (p + DVec3::new(4.0, 26.0, 18.0)).max(DVec3::ZERO).min(DVec3::splat(46.0));
        [at.x as usize, at.y as usize, at.z as usize]
    }

    fn add(&mut self, p: DVec3) {
        let [x, y, z] = Self::cell(p);
        self.cells[(z * Self::SIDE + y) * Self::SIDE + x].push(p);
    }

    fn is_free(&self, p: DVec3, radius: f64) -> bool {
        let [x, y, z] = Self::cell(p);
        for k in z.saturating_sub(1)..=(z + 1).min(Self::SIDE - 1) {
            for j in y.saturating_sub(1)..=(y + 1).min(Self::SIDE - 1) {
                for i in x.saturating_sub(1)..=(x + 1).min(Self::SIDE - 1) {
                    let cell = &self.cells[(k * Self::SIDE + j) * Self::SIDE + i];
                    if cell.iter().any(|q| (*q - p).length_squared() < radius * radius) {
                        return false;
                    }
                }
            }
        }
        true
    }
}

/// Whether a point of the flat chart lies inside a closed outline.
#[must_use]
pub fn inside(outline: &[DVec2], p: DVec2) -> bool {
    let mut odd = false;
    for (i, a) in outline.iter().enumerate() {
        let b = outline[(i + 1) % outline.len()];
        if (a.y > p.y) != (b.y > p.y) && p.x < (b.x - a.x) * (p.y - a.y) / (b.y - a.y) + a.x {
            odd = !odd;
        }
    }
    odd
}

/// Fills the chart between the rings. Returns the numbers of the vertices that may still move.
pub fn fill(half: &mut Half, loops: &Loops) -> Vec<usize> {
    let mut buckets = Buckets::new();
    for node in &half.nodes {
        buckets.add(node.p);
    }
    let ear: Vec<DVec2> = loops.ear.iter().map(|&i| chart::flat(chart::place_of(half.nodes[i].p))).collect();
    let edge: Vec<Place> = loops.edge.iter().map(|&i| chart::place_of(half.nodes[i].p)).collect();
    let blocked = |place: Place| {
        let flat = chart::flat(place);
        inside(&loops.eye_outline, flat)
            || inside(&ear, flat)
            || (flat.x >= 0.0 && inside(&loops.mouth_outline, flat))
    };
    let lowest = |phi: f64| {
        let at = phi / PI * (edge.len() - 1) as f64;
        let i = (at as usize).min(edge.len() - 2);
        lerp(edge[i].t, edge[i + 1].t, at - i as f64)
    };

    midline(half, &mut buckets, loops, lowest(0.0), lowest(PI));

    let mut free = Vec::new();
    let areas = [
        (0.0, 0.30, -0.42, 0.02, 9000),
        (0.0, 1.15, -0.95, 0.75, 26000),
        (0.0, PI, -2.6, 1.3, 30000),
        (0.0, PI, -5.5, -2.4, 12000),
    ];
    for (phi0, phi1, t0, t1, count) in areas {
        for i in 1..=count {
            // The R2 sequence (Roberts): evenly spread, without rows.
            let k = f64::from(i);
            let place = Place {
                phi: lerp(phi0, phi1, (k * 0.754_877_666_246_692_7).fract()),
                t: lerp(t0, t1, (k * 0.569_840_290_998_053_2).fract()),
            };
            if blocked(place) || place.t < lowest(place.phi) + 0.01 {
                continue;
            }
            let p = chart::point(place);
            let h = spacing(p);
            // Next to the midline a whole step must stay free, or the mirrored twin comes too close.
            if p.x > 0.6 * h && p.y > crate::anatomy::BUST_EDGE_Y + 0.5 * h && buckets.is_free(p, 0.86 * h) {
                buckets.add(p);
                free.push(half.add(Node::sheet(p)));
            }
        }
    }
    free
}

/// Vertices on the midline, front and back.
fn midline(half: &mut Half, buckets: &mut Buckets, loops: &Loops, front_end: f64, back_end: f64) {
    let mouth: Vec<f64> = loops.mouth_outline.iter().map(|p| -p.y).collect();
    let (mouth_top, mouth_foot) = (mouth[0], mouth[mouth.len() - 1]);
    for (phi, end) in [(0.0, front_end), (PI, back_end)] {
        const STEPS: u32 = 6000;
        for i in 0..=STEPS {
            let t = lerp(1.3, end, f64::from(i) / f64::from(STEPS));
            let flat = chart::flat(Place { phi, t });
            if phi == 0.0 && -flat.y > mouth_top && -flat.y < mouth_foot {
                continue;
            }
            let p = chart::point(Place { phi, t });
            if buckets.is_free(p, 0.93 * spacing(p)) {
                buckets.add(p);
                half.add(Node::sheet(p));
            }
        }
    }
}
