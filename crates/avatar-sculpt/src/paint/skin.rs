//! Colour, occlusion and gloss of the skin.

use glam::DVec3;

use super::{canvas::Site, hair, marks, relief, rgb};
use crate::{
    anatomy::EYE,
    bake::Baked,
    lids,
    math::{bell, bell3, fbm, lerp, pow, smooth},
    surface::half::Patch,
};

/// Colour of the skin.
#[must_use]
pub fn colour(site: &Site) -> DVec3 {
    match site.node.patch {
        Patch::Mouth => rgb(96, 36, 40)
            .lerp(rgb(128, 56, 56), smooth(0.1, 0.3, site.node.own.x))
            .lerp(rgb(58, 16, 20), smooth(0.3, 0.8, site.node.own.x)),
        Patch::Socket => lid_edge(site),
        Patch::Ear => ear(site),
        Patch::Sheet => sheet(site),
    }
}

/// The bare complexion: warm copper with a trace of green where the skin is thin.
fn complexion(p: DVec3) -> DVec3 {
    let x = p.x.abs();
    let q = DVec3::new(x, p.y, p.z);
    let mut c = rgb(217, 165, 136);
    let blush = bell3(q, DVec3::new(3.8, -2.3, 2.4), DVec3::new(1.8, 1.2, 2.2))
        + 0.45 * bell3(q, DVec3::new(0.0, -3.0, 5.9), DVec3::new(0.8, 0.7, 0.9))
        + 0.25 * bell3(q, DVec3::new(0.0, -8.9, 4.3), DVec3::new(1.3, 0.9, 1.5));
    c = c.lerp(rgb(209, 124, 104), 0.36 * blush.min(1.0));
    c = c.lerp(rgb(224, 180, 146), 0.5 * bell3(q, DVec3::new(0.0, 4.5, 4.0), DVec3::new(3.5, 2.2, 3.0)));
    // Green shimmers at the temples, under the jaw, around eyes and mouth.
    let green = 0.75 * bell3(q, DVec3::new(6.6, 1.8, -0.8), DVec3::new(1.3, 2.6, 2.6))
        + 0.22 * smooth(-9.0, -12.5, p.y)
        + 0.35 * bell3(q, DVec3::new(2.6, -6.5, 3.7), DVec3::new(1.2, 1.3, 1.2))
        + 0.20 * bell3(q, EYE + DVec3::new(-0.6, -1.2, 1.6), DVec3::new(1.5, 0.6, 1.2));
    c = c.lerp(rgb(158, 154, 118), 0.42 * green.min(1.0));
    let mottle = fbm(p * 0.9, 3);
    let fine = fbm(p * 7.0, 2);
    c * (1.0 + 0.05 * mottle + 0.035 * fine) + DVec3::new(0.012, -0.004, -0.006) * fbm(p * 2.2, 2)
}

/// The outer skin with everything drawn on it.
fn sheet(site: &Site) -> DVec3 {
    let p = site.p;
    let mut c = complexion(p) * (1.0 - 0.03 * relief::depth(site));
    c = c.lerp(rgb(112, 116, 92), 0.62 * marks::at(p));
    c = eyes(site, c);
    c = lips(site, c);
    c = c.lerp(rgb(62, 40, 36), 0.86 * hair::brows(p, true));
    let q = DVec3::new(p.x.abs(), p.y, p.z);
    let nostril = bell3(q, DVec3::new(0.45, -3.52, 4.70), DVec3::new(0.24, 0.30, 0.36));
    c = c.lerp(rgb(70, 32, 28), 0.85 * nostril.min(1.0));
    c.lerp(rgb(58, 42, 42), 0.80 * hair::scalp(site))
}

/// Shadow on the lids and the dark line of the lashes.
fn eyes(site: &Site, c: DVec3) -> DVec3 {
    let lid = site.node.lid;
    if lid > 1.0 {
        return c;
    }
    let rel = site.node.p - EYE;
    let s = lids::along(rel);
    if site.node.lower {
        let line = smooth(0.075, 0.0, lid) * lerp(0.25, 0.85, smooth(0.1, 0.9, s));
        let shade = 0.20 * smooth(0.35, 0.05, lid) * smooth(0.2, 1.0, s);
        return c.lerp(rgb(126, 84, 70), shade).lerp(rgb(52, 32, 30), line);
    }
    let shade = 0.55 * smooth(0.62, 0.12, lid) * smooth(-0.1, 0.25, s);
    let wing = smooth(1.0, 1.16, s) * smooth(1.32, 1.16, s) * smooth(0.16, 0.05, lid);
    let line = smooth(lerp(0.07, 0.15, smooth(0.2, 1.0, s)), 0.02, lid).max(0.7 * wing);
    c.lerp(rgb(140, 92, 74), shade).lerp(rgb(34, 22, 22), 0.96 * line)
}

/// The edge of the lids and what lies behind it.
fn lid_edge(site: &Site) -> DVec3 {
    let lid = site.node.lid;
    let s = lids::along(site.node.p - EYE);
    let wet = rgb(205, 130, 118);
    let dark = if site.node.lower { lerp(0.15, 0.6, smooth(0.3, 1.0, s)) } else { 0.92 };
    let edge = wet
        .lerp(rgb(34, 22, 22), dark * smooth(-0.22, -0.05, lid).max(if site.node.lower { 0.0 } else { 0.8 }));
    // The inner corner is moist and red.
    let edge = edge.lerp(rgb(190, 112, 98), 0.95 * smooth(0.15, 0.05, s));
    edge.lerp(rgb(96, 42, 40), smooth(-0.24, -0.5, lid))
}

/// The red of the lips: fuller in the middle, deep at the line between them, soft at the border.
fn lips(site: &Site, c: DVec3) -> DVec3 {
    let lip = site.node.lip;
    if lip > 2.0 {
        return c;
    }
    let p = site.p;
    let red = rgb(182, 95, 88);
    let light = rgb(212, 134, 120);
    let centre = if site.node.lower { bell(p.x, 1.1) * bell(lip - 0.5, 0.35) } else { 0.5 * bell(p.x, 1.3) };
    let lines = fbm(DVec3::new(p.x * 9.0, p.y * 1.5, p.z), 2);
    let tone = red.lerp(light, 0.6 * centre) * (1.0 + 0.09 * lines) * (1.0 - 0.06 * relief::depth(site));
    let tone = tone.lerp(rgb(92, 34, 38), 0.8 * smooth(0.13, 0.0, lip));
    let border = smooth(1.12, 0.90, lip);
    c.lerp(tone, border)
}

/// The ear: redder at the rim, darker in its bowl.
fn ear(site: &Site) -> DVec3 {
    let own = site.node.own.x;
    let base = complexion(site.p);
    let rim = bell(own - 0.40, 0.12);
    base.lerp(rgb(204, 116, 96), 0.16 + 0.22 * rim).lerp(rgb(140, 76, 60), 0.5 * smooth(0.70, 0.92, own))
}

/// Ambient occlusion: light 1, shade 0. Measured on the meshes; what hair-thin parts would add is drawn.
#[must_use]
pub fn occlusion(site: &Site, baked: &Baked) -> DVec3 {
    let open = site.mix(&baked.openness);
    let drawn = match site.node.patch {
        // Bare darkness says less than a mouth that can be seen into.
        Patch::Mouth => open.max(0.2),
        Patch::Socket | Patch::Ear => open,
        // The crease above the wing of the nose is finer than the mesh.
        Patch::Sheet => {
            let q = site.node.p - DVec3::new(1.08, -2.72, 4.15);
            let crease = bell3(q, DVec3::ZERO, DVec3::new(0.34, 0.62, 0.6));
            open * (1.0 - 0.36 * crease) - 0.18 * lash_shade(site)
        }
    };
    // The ear and the neck still see each other: full openness is rare, and should be white.
    DVec3::splat(pow(lerp(0.06, 1.06, drawn), 0.75).clamp(0.05, 1.0))
}

/// Shade of the lashes on the lids' edges.
fn lash_shade(site: &Site) -> f64 {
    if site.node.lid > 1.0 { 0.0 } else { smooth(0.10, 0.0, site.node.lid) }
}

/// Gloss: wet or oily 1, dry 0.
#[must_use]
pub fn gloss(site: &Site) -> DVec3 {
    let p = site.p;
    let q = DVec3::new(p.x.abs(), p.y, p.z);
    let mut g = 0.30 + 0.05 * fbm(p * 6.0, 2);
    g += 0.05 * bell3(q, DVec3::new(0.0, -2.4, 5.6), DVec3::new(0.7, 1.5, 1.2));
    g += 0.10 * bell3(q, DVec3::new(0.0, 4.2, 4.0), DVec3::new(2.5, 1.8, 2.0));
    g += 0.08 * bell3(q, DVec3::new(4.6, -1.4, 2.2), DVec3::new(1.2, 0.8, 1.6));
    // The flank of the nose is seen at grazing angles, where every gloss flares up.
    g -= 0.26 * bell3(q, DVec3::new(1.0, -2.4, 4.3), DVec3::new(0.6, 1.1, 0.8));
    g = lerp(g, 0.18, hair::scalp(site));
    g = match site.node.patch {
        Patch::Mouth => 0.85,
        Patch::Socket => 0.45,
        _ if site.node.lip <= 1.1 => lerp(g, 0.74, smooth(1.1, 0.5, site.node.lip)),
        _ if site.node.lid <= 0.5 => g + 0.06 * smooth(0.5, 0.1, site.node.lid),
        _ => g,
    };
    DVec3::splat(g)
}
