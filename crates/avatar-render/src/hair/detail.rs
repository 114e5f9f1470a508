//! How many strands of an avatar are grown and drawn in a view, and how wide that makes them.

use crate::view::shading::Quality;
use avatar_groom::SEGMENTS;
use bytemuck::{Pod, Zeroable};

/// How much of an avatar's hair is grown and drawn. May change from frame to frame: nothing is allocated, and
/// what is not drawn costs nothing. Fewer strands are wider, so that they cover the same area.
///
/// The strands of a model come in a fixed random order, and the first ones of them are drawn: any number of
/// them is a fair sample of the whole. The last of those that are drawn are narrower the nearer they are to
/// the cut, so that strands fade in and out where the number changes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HairDetail {
    /// Share of the model's strands, 0 (bald) to 1; NaN counts as 1. Strands become wider by up to eight
    /// times to make up for those that are missing.
    pub share: f32,
    /// Draws fewer strands where the head is small in the picture: 200 for each pixel of its height, but at
    /// least 1000. The number of strands per pixel, and their width in pixels, are then the same as up close.
    pub is_automatic: bool,
    /// Width in pixels below which a strand fades instead of getting thinner. 1 is right for pictures that
    /// are looked at; 0 draws strands as thin as they are, for pictures that are made larger than needed and
    /// averaged.
    pub least_pixels: f32,
    /// Draws at most this many strands, as much wider as it takes, and coarsely: straight between every third
    /// of their points, and in one pass whatever the samples. For pictures that are seen for a moment, while
    /// something moves, on adapters that draw in software. `None` draws all that the rest of this asks for,
    /// finely. Brows and lashes get no wider than by eight times: there is paint below brows.
    pub draft: Option<u32>,
}

/// WGSL `HairView`: which strands of one avatar a pass draws.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub(crate) struct GpuHairView {
    /// Number of strands, not rounded.
    pub(crate) strands: f32,
    /// How many of the last strands fade.
    pub(crate) fading: f32,
    /// Factor on the widths that strands have if all are drawn.
    pub(crate) width: f32,
    pub(crate) least_pixels: f32,
    /// The same of brows and lashes.
    pub(crate) other_width: f32,
    /// From one drawn point of a strand to the next.
    pub(crate) stride: u32,
    /// Pieces that are drawn from one point of a strand to the next: more than one where strands curl.
    pub(crate) pieces: u32,
    /// Width where strands leave the skin, by what they have further out: that of a strand of the model where
    /// quality takes a share of them. Those of heads far away are not thinner there, since nobody sees single
    /// ones, and what they cover counts.
    pub(crate) root_width: f32,
}

const STRANDS_PER_PIXEL: f32 = 200.0;
const FEWEST_STRANDS: f32 = 1000.0;
/// Share of the strands that fade.
const FADING: f32 = 0.15;
/// The largest factor on widths for a small share.
const WIDEST: f32 = 8.0;
/// From one drawn point of a strand to the next, in drafts.
const DRAFT_STRIDE: u32 = 3;
const _: () = assert!((SEGMENTS as u32).is_multiple_of(DRAFT_STRIDE), "strands end at their tips");

impl Default for HairDetail {
    fn default() -> Self {
        Self { share: 1.0, is_automatic: true, least_pixels: 1.0, draft: None }
    }
}

/// Share of the strands where quality is plain or low.
const LOW_SHARE: f32 = 0.25;

impl HairDetail {
    /// What goes with a quality: fewer and wider strands in those for adapters where each costs much. A
    /// share, so that what a pack says of their number still counts.
    pub fn of_quality(quality: Quality) -> Self {
        let share = match quality {
            Quality::Plain | Quality::Low => LOW_SHARE,
            Quality::Medium | Quality::High => 1.0,
        };
        Self { share, ..Self::default() }
    }

    /// How many of a model's strands are grown and drawn where its head is this many pixels high.
    pub fn strands(self, of: usize, head_pixels: f32) -> usize {
        self.view(of as u32, head_pixels, f32::INFINITY).count()
    }

    /// The same for a pass that draws at most `most` strands.
    pub(crate) fn view(self, of: u32, head_pixels: f32, most: f32) -> GpuHairView {
        let all = of as f32;
        let share = if self.share.is_nan() { 1.0 } else { self.share.clamp(0.0, 1.0) };
        let kept = all * share;
        let needed = match self.is_automatic && head_pixels >= 0.0 {
            true => (head_pixels * STRANDS_PER_PIXEL).max(FEWEST_STRANDS),
            false => f32::INFINITY,
        };
        let most = self.draft.map_or(most, |strands| most.min(strands as f32));
        let strands = kept.min(needed).min(most);
        let fading = (strands * FADING).min(all - strands);
        // The sum of widths: strands that fade are half as wide on average.
        let whole = (strands - 0.5 * fading).max(1.0);
        let for_share = if kept > 0.0 { (all / kept).min(WIDEST) } else { 1.0 };
        let least_pixels = if self.least_pixels >= 0.0 { self.least_pixels.min(16.0) } else { 1.0 };
        let stride = if self.draft.is_some() { DRAFT_STRIDE } else { 1 };
        let width = for_share * kept.max(1.0) / whole;
        // A brow of few strands that are as wide as those of the scalp would be a row of squares.
        let other_width = if self.draft.is_some() { width.min(WIDEST) } else { width };
        let root_width = if self.draft.is_some() { 1.0 } else { 1.0 / for_share };
        GpuHairView { strands, fading, width, least_pixels, other_width, stride, pieces: 1, root_width }
    }
}

impl GpuHairView {
    /// Strands to draw.
    pub(crate) fn count(self) -> usize {
        self.strands.ceil() as usize
    }

    /// With so many pieces between the points of a strand, where it is drawn finely.
    pub(crate) fn with_pieces(self, pieces: u32) -> Self {
        if self.is_draft() { self } else { Self { pieces, ..self } }
    }

    /// Corners of a strand's ribbon: two at each point that is drawn.
    pub(crate) fn corners(self) -> u32 {
        2 * (SEGMENTS as u32 / self.stride.max(1) * self.pieces + 1)
    }

    /// Whether strands are drawn coarsely.
    pub(crate) fn is_draft(self) -> bool {
        self.stride > 1
    }

    /// Whether strands are drawn finely.
    pub(crate) fn is_fine(self) -> bool {
        !self.is_draft()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// The widths of all strands as the shader has them, added up; 1 is that of a strand of the model.
    fn area(view: GpuHairView) -> f64 {
        let share = |strand: usize| ((view.strands - strand as f32) / view.fading.max(1e-3)).clamp(0.0, 1.0);
        (0..view.count()).map(|strand| f64::from(share(strand) * view.width)).sum()
    }

    proptest! {
        #[test]
        fn any_number_of_strands_covers_as_much(of in 20_000u32..160_000, pixels in 0.0f32..1200.0, share in 0.2f32..1.0) {
            let view = HairDetail { share, ..HairDetail::default() }.view(of, pixels, f32::INFINITY);
            prop_assert!(view.count() <= of as usize);
            let off = area(view) / f64::from(of) - 1.0;
            prop_assert!(off.abs() < 2e-3, "{view:?}: {off}");
        }

        #[test]
        fn anything_is_a_number_of_strands(of in 0u32..1000, pixels in any::<f32>(), share in any::<f32>(), least in any::<f32>(), draft in any::<Option<u32>>()) {
            for is_automatic in [false, true] {
                let view = HairDetail { share, is_automatic, least_pixels: least, draft }.view(of, pixels, f32::INFINITY);
                prop_assert!(view.count() <= of as usize && view.width.is_finite() && view.width >= 0.0, "{view:?}");
                prop_assert!(view.other_width.is_finite() && view.other_width <= view.width, "{view:?}");
                prop_assert!((0.0..=16.0).contains(&view.least_pixels) && view.fading >= 0.0, "{view:?}");
            }
        }

        #[test]
        fn drafts_cover_as_much_with_few_strands(of in 20_000u32..160_000, pixels in 0.0f32..1200.0, draft in 500u32..5000) {
            let view = HairDetail { draft: Some(draft), ..HairDetail::default() }.view(of, pixels, f32::INFINITY);
            prop_assert!(view.count() <= draft as usize && view.is_draft() && view.other_width <= WIDEST, "{view:?}");
            let off = area(view) / f64::from(of) - 1.0;
            prop_assert!(off.abs() < 2e-3, "{view:?}: {off}");
        }

        #[test]
        fn strands_do_not_pop(of in 50_000u32..150_000, pixels in 20.0f32..700.0) {
            let detail = HairDetail::default();
            let [one, other] = [pixels, pixels * 1.001].map(|pixels| detail.view(of, pixels, f32::INFINITY));
            let width = |view: GpuHairView, strand: usize| {
                ((view.strands - strand as f32) / view.fading.max(1e-3)).clamp(0.0, 1.0) * view.width
            };
            let (mut change, mut all) = (0.0, 0.0);
            for strand in (0..of as usize).step_by(31) {
                let (a, b) = (width(one, strand), width(other, strand));
                change += (a - b).abs();
                all += a;
            }
            prop_assert!(change <= 0.005 * all, "{change} of {all}");
        }
    }

    #[test]
    fn far_heads_have_fewer_strands_and_no_share_has_none() {
        let detail = HairDetail::default();
        assert_eq!(detail.strands(100_000, 500.0), 100_000);
        assert_eq!(detail.strands(100_000, 100.0), 20_000);
        assert_eq!(detail.strands(100_000, 1.0), 1000);
        assert_eq!(HairDetail { is_automatic: false, ..detail }.strands(100_000, 1.0), 100_000);
        assert_eq!(HairDetail { share: 0.0, ..detail }.strands(100_000, 500.0), 0);
    }
}
