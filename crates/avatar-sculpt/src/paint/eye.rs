//! The eyeballs: white, iris, pupil.

use glam::{DVec2, DVec3};

use super::{picture::Picture, rgb};
use crate::{
    math::{atan2, bell, cos, fbm, lerp, noise3, pow, sin, smooth},
    parts::eyes::{image_radius, iris_angle},
};

const PI: f64 = std::f64::consts::PI;

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

/// The four irises of the pack: jade, amber, violet, umber.
pub const IRISES: [Iris; 4] = [
    Iris { inner: [138, 122, 80], outer: [92, 122, 106], ring: [34, 52, 52] },
    Iris { inner: [206, 152, 78], outer: [158, 98, 48], ring: [66, 34, 18] },
    Iris { inner: [156, 150, 172], outer: [110, 102, 150], ring: [44, 38, 72] },
    Iris { inner: [150, 104, 62], outer: [84, 50, 30], ring: [26, 14, 10] },
];

/// Radius of the pupil as a share of the iris.
const PUPIL: f64 = 0.37;

/// From this share of the iris's radius on the ball is behind the lids, wherever it looks: 115° from its
/// axis.
const UNSEEN: f64 = 5.2;

/// Light that the lids leave to the eyeball while it looks ahead, over the eyeball's picture.
#[derive(Clone, Debug)]
pub struct Shade {
    values: Vec<f64>,
}

impl Shade {
    /// Cells per side of the picture.
    const SIDE: usize = 40;

    /// Spreads openness measured at directions from the eye's centre over the picture. The spread is wide on
    /// purpose: the shade turns with the eye, and only a soft one may.
    #[must_use]
    pub fn of(measured: &[(DVec3, f64)]) -> Self {
        let cell = |i: usize| (i as f64 + 0.5) / Self::SIDE as f64;
        let values = (0..Self::SIDE * Self::SIDE).map(|i| {
            let d = DVec2::new(cell(i % Self::SIDE), cell(i / Self::SIDE)) - DVec2::splat(0.5);
            let angle = PI * pow((d.length() / 0.498).min(1.0), 1.0 / 0.6);
            let turn = atan2(-d.y, d.x);
            let toward = DVec3::new(sin(angle) * cos(turn), sin(angle) * sin(turn), cos(angle));
            let (mut sum, mut total) = (0.0, 1e-12);
            for (direction, open) in measured {
                let near = bell((*direction - toward).length(), 0.16);
                sum += near * open;
                total += near;
            }
            sum / total
        });
        Self { values: values.collect() }
    }

    fn at(&self, uv: DVec2) -> f64 {
        let last = Self::SIDE - 1;
        let p = (uv * Self::SIDE as f64 - 0.5).clamp(DVec2::ZERO, DVec2::splat(last as f64 - 1e-6));
        let (x, y) = (p.x as usize, p.y as usize);
        let value = |i: usize, j: usize| self.values[j * Self::SIDE + i];
        let across = |j: usize| lerp(value(x, j), value(x + 1, j), p.x.fract());
        lerp(across(y), across(y + 1), p.y.fract())
    }
}

/// The eyeball's picture.
#[must_use]
pub fn picture(width: usize, iris: &Iris, shade: &Shade) -> Picture {
    let edge = image_radius(iris_angle());
    Picture::from_uv(width, |uv| {
        let d = uv - DVec2::splat(0.5);
        let r = d.length();
        let turn = atan2(-d.y, d.x);
        // The picture widens the middle; `s` is the true share of the iris's radius.
        let s = pow(r / edge, 1.0 / 0.6);
        // The back of the ball is never seen: even, it takes no room in the file.
        if s > UNSEEN {
            return rgb(200, 150, 136);
        }
        let open = shade.at(uv);
        // Little of the shade's depth: the renderer adds some for every eye, and what lids cover at rest is
        // seen when the eye turns.
        let dim = lerp(0.76, 1.0, smooth(0.05, 0.62, open));
        let c = sclera(d, s).lerp(iris_colour(iris, turn, s), smooth(1.07, 0.92, s));
        // Shade on flesh and eyes is warm: light comes back from the lids.
        let warm = DVec3::new(1.0, 0.94, 0.90);
        c * dim * DVec3::ONE.lerp(warm, 1.0 - dim)
    })
}

/// The iris at a turn and a share of its radius.
fn iris_colour(iris: &Iris, turn: f64, s: f64) -> DVec3 {
    let bytes = |c: [u8; 3]| rgb(c[0], c[1], c[2]);
    let round = DVec3::new(cos(turn), sin(turn), 0.0);
    // Fibres run outward from the pupil and part at the collarette.
    let fine = fbm(round * 34.0 + DVec3::Z * (s * 2.2), 2);
    let coarse = fbm(round * 8.0 + DVec3::new(3.0, 7.0, s * 1.2), 2);
    let crypts = smooth(0.25, 0.6, noise3(round * 5.0 + DVec3::Z * (s * 5.0)));
    // The collarette is a ragged line, and its colour runs out along the fibres: a round one is a target.
    let ragged = fbm(round * 5.0 + DVec3::new(9.0, 1.0, 0.0), 3);
    let collarette = 0.50 + 0.16 * ragged + 0.05 * coarse;
    let inner = smooth(collarette + 0.26 + 0.25 * fine, collarette - 0.16, s);
    let mut c = bytes(iris.outer).lerp(bytes(iris.inner), 0.8 * inner);
    c *= 1.0 + 0.62 * fine + 0.30 * coarse;
    c *= 1.0 - 0.40 * crypts * smooth(collarette, collarette + 0.1, s) * smooth(0.95, 0.8, s);
    c = c.lerp(bytes(iris.inner) * 1.2, 0.22 * bell(s - collarette, 0.05));
    c *= lerp(0.72, 1.0, smooth(PUPIL, PUPIL + 0.12, s));
    // Light gathers on the side away from the lamp, as through a lens.
    c *= 1.0 + 0.22 * smooth(0.35, 0.75, s) * -sin(turn);
    c = c.lerp(bytes(iris.ring), 0.75 * smooth(0.74, 1.02, s + 0.07 * coarse + 0.05 * fine));
    c.lerp(rgb(7, 5, 7), smooth(PUPIL + 0.03, PUPIL - 0.02, s + 0.01 * fine))
}

/// The white: never quite white, redder away from the iris, with faint veins.
fn sclera(d: DVec2, s: f64) -> DVec3 {
    let at = DVec3::new(d.x, d.y, 0.0) * 26.0;
    let vein = 1.0 - smooth(0.0, 0.045, fbm(at + DVec3::Z * 4.0, 3).abs());
    let base = rgb(220, 213, 206).lerp(rgb(200, 150, 136), smooth(1.5, 3.3, s));
    let veined = base.lerp(rgb(190, 88, 78), 0.22 * vein * smooth(1.25, 2.4, s));
    veined * lerp(0.80, 1.0, smooth(0.98, 1.28, s))
}
