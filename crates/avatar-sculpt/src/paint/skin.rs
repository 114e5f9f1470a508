//! Colour, occlusion and gloss of the skin.

use glam::DVec3;

use super::{Complexion, canvas::Site, hair, marks, relief, rgb, top};
use crate::{
    anatomy::EYE,
    bake::Baked,
    form, lids,
    math::{bell, bell3, fbm, hash01, lerp, pow, smooth},
    surface::half::Patch,
};

/// Colour of the skin.
#[must_use]
pub fn colour(site: &Site, complexion: &Complexion) -> DVec3 {
    match site.node.patch {
        Patch::Mouth => mouth(site),
        Patch::Socket => lid_edge(site),
        Patch::Ear => ear(site),
        Patch::Lash => rgb(15, 11, 10),
        Patch::Sheet => sheet(site, complexion),
    }
}

/// The walls of the mouth: pale and mottled behind the lips, darker toward the throat. A deeper red would be
/// a bare one in the shade.
fn mouth(site: &Site) -> DVec3 {
    let deep = site.node.own.x;
    let wall = rgb(138, 70, 66)
        .lerp(rgb(172, 104, 96), smooth(0.1, 0.3, deep))
        .lerp(rgb(112, 62, 58), smooth(0.4, 0.9, deep));
    let folds = fbm(site.p * DVec3::new(1.2, 3.5, 2.4), 3);
    let blood = fbm(site.p * 1.4 + DVec3::splat(11.0), 3);
    (wall * (1.0 + 0.16 * folds)).lerp(rgb(150, 74, 70), (0.45 * blood).clamp(0.0, 0.4))
}

/// The bare complexion. Faces have zones: yellow over the bone of the forehead, red from ear to ear over the
/// nose, where blood lies near, and cool around the mouth, on the temples and under the eyes.
fn complexion(p: DVec3) -> DVec3 {
    let q = DVec3::new(p.x.abs(), p.y, p.z);
    let mut c = rgb(214, 167, 142);
    let mottle = fbm(p * 0.9, 3);
    let blush = bell3(q, DVec3::new(3.7, -2.5, 2.4), DVec3::new(1.9, 1.3, 2.4))
        + 0.75 * bell3(q, DVec3::new(0.3, -3.0, 5.6), DVec3::new(0.9, 0.8, 1.1))
        + 0.40 * bell3(q, DVec3::new(1.1, -3.2, 4.2), DVec3::new(0.5, 0.5, 0.7))
        + 0.30 * bell3(q, DVec3::new(0.0, -8.9, 4.3), DVec3::new(1.3, 0.9, 1.5));
    // Blood lies in patches.
    let patches = 1.0 + 0.7 * fbm(p * 2.6 + DVec3::splat(3.0), 3);
    c = c.lerp(rgb(203, 116, 101), (0.29 * blush.min(1.1) * patches).clamp(0.0, 1.0));
    c = c.lerp(rgb(224, 184, 146), 0.5 * bell3(q, DVec3::new(0.0, 4.5, 4.0), DVec3::new(3.5, 2.2, 3.0)));
    let cool = 0.70 * bell3(q, DVec3::new(6.6, 1.8, -0.8), DVec3::new(1.3, 2.6, 2.6))
        + 0.30 * smooth(-9.0, -12.5, p.y)
        + 0.45 * bell3(q, DVec3::new(2.4, -6.6, 3.7), DVec3::new(1.4, 1.4, 1.4));
    c = c.lerp(rgb(176, 152, 128), 0.40 * cool.min(1.0));
    let under = bell3(q, EYE + DVec3::new(-0.5, -1.25, 1.6), DVec3::new(1.5, 0.55, 1.2));
    c = c.lerp(rgb(176, 122, 112), 0.12 * under);
    c = c.lerp(rgb(138, 140, 146), 0.13 * veins(q));
    let fine = fbm(p * 7.0, 2);
    c * (1.0 + 0.06 * mottle + 0.045 * fine) + DVec3::new(0.016, -0.005, -0.008) * fbm(p * 2.2, 2)
}

/// Where veins shine through: on the temples, the lids and the throat.
fn veins(q: DVec3) -> f64 {
    let thin = bell3(q, DVec3::new(6.5, 2.6, -0.4), DVec3::new(1.3, 2.0, 2.2))
        + 0.3 * bell3(q, EYE + DVec3::new(0.4, 1.0, 1.8), DVec3::new(1.4, 0.5, 1.0))
        + 0.6 * bell3(q, DVec3::new(3.0, -13.0, -3.5), DVec3::new(1.6, 3.0, 2.2));
    if thin < 0.02 {
        return 0.0;
    }
    thin.min(1.0) * smooth(0.055, 0.0, fbm(q * DVec3::new(0.8, 0.45, 0.8) + DVec3::splat(5.0), 3).abs())
}

/// Freckles over nose and cheeks, fewer on the forehead and below the neck: 0…1.
fn freckles(p: DVec3) -> f64 {
    const GRID: f64 = 0.30;
    let q = DVec3::new(p.x.abs(), p.y, p.z);
    let share = 0.75 * bell3(q, DVec3::new(2.4, -2.2, 3.4), DVec3::new(2.3, 1.2, 2.2))
        + 0.55 * bell3(q, DVec3::new(0.0, -1.6, 5.0), DVec3::new(1.2, 1.3, 1.6))
        + 0.14 * bell3(q, DVec3::new(1.5, 4.4, 3.6), DVec3::new(3.5, 1.8, 2.5))
        + 0.16 * bell3(q, DVec3::new(4.0, -17.0, -3.5), DVec3::new(6.0, 2.5, 4.0));
    if share < 0.02 {
        return 0.0;
    }
    let at = p / GRID;
    let base = at.floor();
    let mut sum = 0.0_f64;
    for n in 0..27 {
        let cell = base + DVec3::new(f64::from(n % 3 - 1), f64::from(n / 3 % 3 - 1), f64::from(n / 9 - 1));
        let [x, y, z] = cell.to_array().map(|c| (c as i64 as u64) & 0xFFFF);
        let chance = |k: u64| hash01(x | (y << 16) | (z << 32) | (k << 48));
        if chance(1) > 0.9 * share {
            continue;
        }
        let away = cell + DVec3::new(chance(2), chance(3), chance(4)) - at;
        let size = lerp(0.10, 0.26, chance(5) * chance(5));
        let spot = smooth(size * 1.3, size * 0.5, away.length() * (1.0 + 0.25 * fbm(p * 9.0, 2)));
        sum = sum.max(spot * lerp(0.45, 1.0, chance(6)));
    }
    sum
}

/// The outer skin with everything drawn on it.
fn sheet(site: &Site, own: &Complexion) -> DVec3 {
    let p = site.p;
    if site.cloth {
        return top::colour(p);
    }
    let mut c = complexion(p) * (1.0 - 0.03 * relief::depth(site));
    c = c.lerp(rgb(150, 96, 70), 0.60 * own.freckles * freckles(p));
    c = c.lerp(rgb(112, 116, 92), 0.62 * own.marks * marks::at(p));
    c = eyes(site, c);
    c = lips(site, c);
    c = c.lerp(rgb(62, 40, 36), 0.86 * hair::brows(p, true));
    let q = DVec3::new(p.x.abs(), p.y, p.z);
    // The wall of a nostril's hollow, but for its foot on the lip.
    let nostril = smooth(0.10, -0.01, form::nostril(q)) * smooth(-3.78, -3.55, p.y);
    c = c.lerp(rgb(58, 24, 22), 0.92 * nostril);
    // Hair cut to the skin: a shade of many dark points, not a cap.
    let scalp = hair::scalp(site);
    let shorn = scalp * (0.78 + 0.5 * fbm(p * DVec3::new(7.0, 4.0, 5.0), 3));
    let c = c.lerp(rgb(62, 44, 40), (0.82 * shorn).clamp(0.0, 0.9));
    // Behind the hairline roots stand close: where strands part, a pale skin would show every gap between
    // them.
    c.lerp(rgb(48, 32, 24), 0.6 * smooth(0.42, 0.92, scalp))
}

/// Shadow on the lids and the dark line of the lashes.
fn eyes(site: &Site, c: DVec3) -> DVec3 {
    let lid = site.node.lid;
    if lid > 1.0 {
        return c;
    }
    let rel = site.node.p - EYE;
    let s = lids::along(rel);
    // Beyond the outer corner both lids are one skin again.
    let before_end = smooth(1.08, 0.90, s);
    if site.node.lower {
        let line = smooth(0.05, 0.0, lid) * lerp(0.10, 0.55, smooth(0.1, 0.9, s));
        let shade = 0.14 * smooth(0.30, 0.05, lid) * smooth(0.2, 1.0, s);
        return c.lerp(rgb(126, 84, 70), shade * before_end).lerp(rgb(52, 32, 30), line * before_end);
    }
    let shade = 0.55 * smooth(0.62, 0.12, lid) * smooth(-0.1, 0.25, s);
    let line = smooth(lerp(0.05, 0.10, smooth(0.2, 1.0, s)), 0.01, lid) * smooth(-0.05, 0.2, s);
    c.lerp(rgb(150, 100, 84), shade * before_end).lerp(rgb(44, 28, 26), 0.85 * line * before_end)
}

/// The edge of the lids and what lies behind it.
fn lid_edge(site: &Site) -> DVec3 {
    let lid = site.node.lid;
    let s = lids::along(site.node.p - EYE);
    let wet = rgb(205, 130, 118);
    let dark = if site.node.lower { lerp(0.05, 0.35, smooth(0.3, 1.0, s)) } else { 0.80 };
    let edge = wet
        .lerp(rgb(40, 26, 24), dark * smooth(-0.22, -0.05, lid).max(if site.node.lower { 0.0 } else { 0.5 }));
    // The inner corner is moist and red.
    let edge = edge.lerp(rgb(206, 128, 118), 0.95 * smooth(0.15, 0.05, s));
    let deep = rgb(168, 98, 90).lerp(rgb(96, 42, 40), smooth(0.05, 0.25, s));
    edge.lerp(deep, smooth(-0.24, -0.5, lid))
}

/// The red of the lips: fuller in the middle, deep at the line between them, soft at the border.
fn lips(site: &Site, c: DVec3) -> DVec3 {
    let lip = site.node.lip;
    if lip > 2.0 {
        return c;
    }
    let p = site.p;
    let red = rgb(184, 104, 95);
    let light = rgb(210, 138, 122);
    let centre = if site.node.lower { bell(p.x, 1.1) * bell(lip - 0.5, 0.35) } else { 0.5 * bell(p.x, 1.3) };
    let lines = fbm(DVec3::new(p.x * 9.0, p.y * 1.5, p.z), 2);
    let tone = red.lerp(light, 0.6 * centre) * (1.0 + 0.05 * lines) * (1.0 - 0.06 * relief::depth(site));
    let tone = tone.lerp(rgb(92, 34, 38), 0.8 * smooth(0.12, 0.0, lip));
    // The red fades into the skin; it has no drawn edge. Toward the corners it is paler.
    let border = smooth(1.20, 0.72, lip) * lerp(0.92, 0.7, smooth(1.1, 2.1, p.x.abs()));
    c.lerp(tone, border)
}

/// The ear: redder at the rim, darker in its bowl.
fn ear(site: &Site) -> DVec3 {
    let own = site.node.own.x;
    let base = complexion(site.p);
    let rim = bell(own - 0.40, 0.12);
    base.lerp(rgb(204, 122, 100), 0.06 + 0.12 * rim).lerp(rgb(140, 82, 64), 0.42 * smooth(0.70, 0.92, own))
}

/// Ambient occlusion: light 1, shade 0. Measured on the meshes; what hair-thin parts would add is drawn.
#[must_use]
pub fn occlusion(site: &Site, baked: &Baked) -> DVec3 {
    let open = site.mix(&baked.openness);
    let drawn = match site.node.patch {
        // Bare darkness says less than a mouth that can be seen into; the throat stays dark.
        Patch::Mouth => open.max(lerp(0.5, 0.2, smooth(0.58, 0.77, site.node.own.x))),
        Patch::Socket | Patch::Ear => open,
        Patch::Lash => 0.8,
        // The crease above the wing of the nose is finer than the mesh.
        Patch::Sheet => {
            let q = site.node.p - DVec3::new(1.08, -2.72, 4.15);
            let crease = bell3(q, DVec3::ZERO, DVec3::new(0.34, 0.62, 0.6));
            // The hollow below the lower lid is shallow, and light comes to it from the cheek.
            let under = bell3(site.node.p, EYE + DVec3::new(0.0, -1.45, 1.4), DVec3::new(1.9, 0.6, 1.2));
            let open = lerp(open, 1.0, 0.8 * under * smooth(0.06, 0.35, site.node.lid));
            open * (1.0 - 0.36 * crease) - 0.18 * lash_shade(site)
        }
    };
    // The ear and the neck still see each other: full openness is rare, and should be white.
    DVec3::splat(pow(lerp(0.06, 1.06, drawn), 0.75).clamp(0.05, 1.0))
}

/// Thickness of the flesh: 0 thin, 1 thick. Neither cloth nor lashes let light through.
#[must_use]
pub fn thickness(site: &Site, baked: &Baked) -> DVec3 {
    let opaque = site.cloth || site.node.patch == Patch::Lash;
    DVec3::splat(if opaque { 1.0 } else { site.mix(&baked.thickness) })
}

/// Shade of the lashes on the lids' edges.
fn lash_shade(site: &Site) -> f64 {
    if site.node.lid > 1.0 { 0.0 } else { smooth(0.10, 0.0, site.node.lid) }
}

/// Gloss: wet or oily 1, dry 0.
#[must_use]
pub fn gloss(site: &Site) -> DVec3 {
    if site.cloth {
        return DVec3::ZERO;
    }
    let p = site.p;
    let q = DVec3::new(p.x.abs(), p.y, p.z);
    let mut g = 0.30 + 0.05 * fbm(p * 6.0, 2);
    g += 0.05 * bell3(q, DVec3::new(0.0, -2.4, 5.6), DVec3::new(0.7, 1.5, 1.2));
    g += 0.10 * bell3(q, DVec3::new(0.0, 4.2, 4.0), DVec3::new(2.5, 1.8, 2.0));
    g += 0.08 * bell3(q, DVec3::new(4.6, -1.4, 2.2), DVec3::new(1.2, 0.8, 1.6));
    g -= 0.22 * smooth(-10.0, -13.0, p.y);
    // The flank of the nose is seen at grazing angles, where every gloss flares up.
    g -= 0.26 * bell3(q, DVec3::new(1.0, -2.4, 4.3), DVec3::new(0.6, 1.1, 0.8));
    // Tears stand along the edge of the lower lid and in the inner corner.
    let tears = |lid: f64, s: f64| {
        let rim = smooth(-0.30, -0.20, lid) * smooth(-0.08, -0.16, lid);
        if site.node.lower { rim.max(smooth(0.12, 0.04, s)) } else { smooth(0.12, 0.04, s) }
    };
    g = match site.node.patch {
        // Lips are wet on their inner side, too. Farther back every shine would be that of a lamp which the
        // cheek keeps off in truth: a white spot in the dark.
        Patch::Mouth => lerp(0.85, -0.7, smooth(0.18, 0.45, site.node.own.x)),
        Patch::Socket => lerp(0.45, 1.5, tears(site.node.lid, lids::along(site.node.p - EYE))),
        Patch::Lash => -0.83,
        _ if site.node.lip <= 1.1 => lerp(g, 0.74, smooth(1.1, 0.5, site.node.lip)),
        _ if site.node.lid <= 0.5 => g + 0.06 * smooth(0.5, 0.1, site.node.lid),
        _ => g,
    };
    // Skin is rough by 0.65 where it is dry; `materials.toml` says what black (0.9) and white (0.2) are.
    // Cloth and short hair are rougher than any skin.
    let rough = 0.65 - 0.30 * g;
    let skin = (0.9 - rough) / 0.7 * (1.0 - hair::scalp(site).max(hair::brows(p, false)));
    DVec3::splat(skin)
}
