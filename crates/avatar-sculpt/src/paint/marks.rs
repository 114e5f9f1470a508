//! The markings of her people: two arcs of small freckle-like spots, from the temple over the cheekbone and
//! above the brow toward the middle of the forehead.

use glam::{DVec2, DVec3};

use crate::math::{lerp, smooth};

/// Spots per arc.
const SPOTS: u32 = 9;

/// How much of a mark lies at a place, 0…1.
#[must_use]
pub fn at(p: DVec3) -> f64 {
    if p.z < -3.0 || p.y < -4.0 || p.y > 7.0 {
        return 0.0;
    }
    let x = p.x.abs();
    let mut sum = 0.0_f64;
    for i in 0..SPOTS {
        let s = f64::from(i) / f64::from(SPOTS - 1);
        let cheek = bend(DVec2::new(6.35, 1.3), DVec2::new(5.9, -0.9), DVec2::new(3.7, -1.75), s);
        let forehead = bend(DVec2::new(6.0, 2.9), DVec2::new(4.6, 4.4), DVec2::new(1.3, 4.3), s);
        let size = lerp(0.15, 0.05, s);
        for centre in [cheek, forehead] {
            let d = (DVec2::new(x, p.y) - centre).length();
            sum = sum.max(smooth(size * 1.25, size * 0.55, d));
        }
    }
    for (y, size) in [(4.35, 0.16), (5.0, 0.11), (5.5, 0.07)] {
        sum = sum.max(smooth(size * 1.25, size * 0.55, x.hypot(p.y - y)));
    }
    sum
}

fn bend(a: DVec2, b: DVec2, c: DVec2, s: f64) -> DVec2 {
    a.lerp(b, s).lerp(b.lerp(c, s), s)
}
