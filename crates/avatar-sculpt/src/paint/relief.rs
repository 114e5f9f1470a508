//! Relief finer than the mesh: pores, the grooves of the lips, the grain of the skin; and its picture.

use glam::{DVec2, DVec3};

use super::{canvas::Site, hair, top};
use crate::{
    math::{bell3, fbm, hash01, lerp, noise3, smooth},
    surface::half::Patch,
};

/// Distance between pores.
const PORE_GRID: f64 = 0.085;
/// Edge length of the picture that ribs of cloth must fit.
const PIXELS: f64 = 2048.0;
/// Half the way between two places whose difference is a slope.
const STEP: f64 = 0.004;

/// How strongly each kind of relief shows at a place.
#[derive(Clone, Copy, Debug)]
struct Kinds {
    pores: f64,
    grain: f64,
    grooves: f64,
    stubble: f64,
    cloth: f64,
    knit: f64,
}

fn kinds(site: &Site) -> Kinds {
    let none = Kinds { pores: 0.0, grain: 0.0, grooves: 0.0, stubble: 0.0, cloth: 0.0, knit: 0.0 };
    let node = &site.node;
    match node.patch {
        Patch::Mouth | Patch::Socket | Patch::Lash => return none,
        Patch::Ear => return Kinds { grain: 0.4, ..none },
        Patch::Sheet => {}
    }
    let q = node.p;
    if site.cloth {
        // Where the picture is too coarse for the ribs they would turn into waves of their own.
        let cycles = top::RIBS / (2.0 * std::f64::consts::PI * PIXELS);
        let across = cycles * site.per_uv[0].x.abs().max(site.per_uv[1].x.abs());
        return Kinds { cloth: 1.0, knit: smooth(0.32, 0.14, across), ..none };
    }
    let nose = bell3(q, DVec3::new(0.4, -2.8, 5.0), DVec3::new(1.1, 1.3, 1.4));
    let cheek = bell3(q, DVec3::new(2.6, -2.6, 3.2), DVec3::new(1.8, 1.5, 1.8));
    let chin = bell3(q, DVec3::new(0.0, -8.3, 4.0), DVec3::new(1.6, 1.1, 1.4));
    let forehead = bell3(q, DVec3::new(0.0, 4.0, 3.8), DVec3::new(4.0, 2.4, 3.0));
    let lip = smooth(1.05, 0.85, node.lip);
    let lid = smooth(0.75, 0.25, node.lid);
    let stubble = hair::scalp(site);
    let bald = 1.0 - stubble;
    let face = smooth(-3.0, 1.0, q.z) * smooth(-12.5, -10.5, q.y);
    let region = (0.18 + 0.8 * nose + 0.55 * cheek + 0.4 * chin + 0.35 * forehead).min(1.0) * face;
    Kinds {
        pores: region * (1.0 - lip) * (1.0 - lid) * bald,
        grain: (1.0 - lip) * lerp(1.0, 0.5, lid) * bald * smooth(-10.0, -4.0, q.z),
        grooves: lip * smooth(0.02, 0.25, node.lip),
        stubble,
        ..none
    }
}

/// Nearness to the nearest pore, 0 between pores and 1 at one's bottom.
fn pore(p: DVec3) -> f64 {
    let at = p / PORE_GRID;
    let base = at.floor();
    let mut nearest = 9.0_f64;
    for n in 0..27 {
        let cell = base + DVec3::new(f64::from(n % 3 - 1), f64::from(n / 3 % 3 - 1), f64::from(n / 9 - 1));
        let [x, y, z] = cell.to_array().map(|c| (c as i64 as u64) & 0xFFFF);
        let seed = x | (y << 16) | (z << 32);
        let chance = |k: u64| 0.15 + 0.7 * hash01(seed | (k << 48));
        let d = cell + DVec3::new(chance(1), chance(2), chance(3)) - at;
        nearest = nearest.min(d.length_squared());
    }
    smooth(0.42, 0.05, nearest.sqrt())
}

/// Height of the relief at a place, in head units.
fn height(kinds: Kinds, p: DVec3) -> f64 {
    let mut h = 0.0;
    if kinds.pores > 0.02 {
        h -= 0.0055 * kinds.pores * pore(p);
    }
    if kinds.grain > 0.0 {
        h += 0.0022 * kinds.grain * noise3(p * 10.0);
    }
    if kinds.grooves > 0.0 {
        // Grooves run across the lip and wander a little.
        let x = p.x + 0.10 * noise3(p * 1.7);
        let line = noise3(DVec3::new(x * 9.0, p.y * 0.9, 3.5));
        h += 0.006 * kinds.grooves * (line - 0.5 * line * line);
    }
    if kinds.stubble > 0.0 {
        // Short hair lies down and back, in streaks.
        h += 0.02 * kinds.stubble * fbm(p * DVec3::new(9.0, 3.5, 5.0), 2);
    }
    if kinds.cloth > 0.0 {
        h += kinds.cloth * top::height(p, kinds.knit);
    }
    h
}

/// Darkness in the depth of pores and grooves, for the colour.
#[must_use]
pub fn depth(site: &Site) -> f64 {
    let kinds = kinds(site);
    (-height(kinds, site.p) / 0.0055).clamp(0.0, 1.0)
}

/// The normal in the frame of the picture: x to the right, y up, z outward.
///
/// The renderer takes the gradients of u and −v on the surface for its axes, both over the longer one's
/// length; in these axes the slopes below are exact even where the layout stretches the face.
#[must_use]
pub fn normal(site: &Site) -> DVec3 {
    let kinds = kinds(site);
    let flat = DVec3::Z;
    if kinds.pores + kinds.grain + kinds.grooves + kinds.stubble + kinds.cloth <= 0.0 {
        return encoded(flat);
    }
    let [pu, pv] = site.per_uv;
    let (uu, vv, uv) = (pu.length_squared(), pv.length_squared(), pu.dot(pv));
    let det = uu * vv - uv * uv;
    if det <= 1e-12 {
        return encoded(flat);
    }
    // Lengths of the gradients of u and v, from the inverse of the metric.
    let longest = (uu.max(vv) / det).sqrt();
    let slope = |along: DVec3| {
        let length = along.length();
        let step = along * (STEP / length);
        (height(kinds, site.p + step) - height(kinds, site.p - step)) / (2.0 * STEP) * length
    };
    let tilt = DVec2::new(-slope(pu), slope(pv)) * longest;
    // Slivers of the layout would ask for slopes that mean nothing in eight bits.
    encoded(tilt.clamp_length_max(1.0).extend(1.0).normalize_or_zero())
}

fn encoded(n: DVec3) -> DVec3 {
    n * 0.5 + DVec3::splat(0.5)
}
