//! Teeth, gums and tongue share one picture: bands from top to bottom.

use glam::DVec3;

use super::{picture::Picture, rgb};
use crate::math::{fbm, smooth};

/// The picture. Teeth end at 0.48, gums lie between 0.5 and 0.74, the tongue below.
#[must_use]
pub fn picture(width: usize) -> Picture {
    Picture::from_uv(width, |uv| {
        let at = DVec3::new(uv.x, uv.y, 0.0);
        if uv.y < 0.49 {
            let root = smooth(0.16, 0.0, uv.y).max(smooth(0.34, 0.48, uv.y));
            let tooth = rgb(240, 232, 216).lerp(rgb(222, 204, 172), 0.7 * root);
            // A tooth's front lies at both ends of the row, its neighbours' sides at a quarter: little light
            // comes between teeth.
            let between = smooth(0.075, 0.0, (uv.x - 0.25).abs().min((uv.x - 0.75).abs()));
            let tooth = tooth.lerp(rgb(150, 108, 84), 0.75 * between);
            return tooth * (1.0 + 0.02 * fbm(at * 12.0, 2));
        }
        if uv.y < 0.75 {
            return rgb(190, 104, 100) * (1.0 + 0.10 * fbm(at * 22.0, 3));
        }
        rgb(186, 98, 94) * (1.0 + 0.16 * fbm(at * 40.0, 3))
    })
}
