//! The eyeballs: white, iris, pupil.

use glam::{DVec2, DVec3};

use super::{canvas::Picture, rgb};
use crate::{
    math::{atan2, bell, cos, fbm, lerp, pow, sin, smooth},
    parts::eyes::{image_radius, iris_angle},
};

/// The colours of an iris.
#[derive(Clone, Copy, Debug)]
pub struct Iris {
    /// Around the pupil.
    pub inner: [u8; 3],
    /// The main colour.
    pub outer: [u8; 3],
    /// The ring at the edge.
    pub ring: [u8; 3],
}

/// The four irises of the pack.
pub const IRISES: [Iris; 4] = [
    Iris { inner: [222, 164, 70], outer: [72, 142, 116], ring: [18, 48, 46] },
    Iris { inner: [236, 178, 84], outer: [176, 96, 38], ring: [62, 26, 12] },
    Iris { inner: [170, 168, 190], outer: [112, 96, 168], ring: [38, 28, 74] },
    Iris { inner: [150, 104, 62], outer: [84, 50, 30], ring: [26, 14, 10] },
];

/// Radius of the pupil as a share of the iris.
const PUPIL: f64 = 0.36;

/// The eyeball's picture.
#[must_use]
pub fn picture(width: usize, iris: &Iris) -> Picture {
    let edge = image_radius(iris_angle());
    let bytes = |c: [u8; 3]| rgb(c[0], c[1], c[2]);
    Picture::from_uv(width, |uv| {
        let d = uv - DVec2::splat(0.5);
        let r = d.length();
        let turn = atan2(-d.y, d.x);
        // The picture widens the middle; `s` is the true share of the iris's radius.
        let s = pow(r / edge, 1.0 / 0.6);
        let white = sclera(d, s);
        let round = DVec3::new(cos(turn), sin(turn), 0.0);
        let fibres = fbm(round * 13.0 + DVec3::Z * (s * 1.3), 3);
        let coarse = fbm(round * 5.0 + DVec3::new(3.0, 7.0, s), 2);
        let waves = 0.05 * coarse;
        let mut c = bytes(iris.inner).lerp(bytes(iris.outer), smooth(0.42, 0.66, s + waves));
        c *= 1.0 + 0.55 * fibres;
        c = c.lerp(bytes(iris.inner) * 1.1, 0.35 * bell(s - 0.5 - waves, 0.05));
        c = c.lerp(bytes(iris.ring), smooth(0.76, 0.97, s + 0.5 * waves));
        c = c.lerp(rgb(8, 6, 8), smooth(PUPIL + 0.035, PUPIL - 0.02, s));
        c.lerp(white, smooth(0.965, 1.05, s))
    })
}

/// The white: never quite white, redder away from the iris, with faint veins.
fn sclera(d: DVec2, s: f64) -> DVec3 {
    let at = DVec3::new(d.x, d.y, 0.0) * 26.0;
    let vein = 1.0 - smooth(0.0, 0.05, fbm(at + DVec3::Z * 4.0, 3).abs());
    let base = rgb(226, 219, 211).lerp(rgb(204, 150, 134), smooth(1.6, 3.4, s));
    base.lerp(rgb(196, 92, 82), 0.16 * vein * smooth(1.4, 2.6, s)) * lerp(0.90, 1.0, smooth(1.0, 1.3, s))
}
