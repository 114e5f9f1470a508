//! How a part is drawn that looks as an interchange file says.

use avatar_look::{Alpha, Lighting, Material, SOLID, Standard};
use avatar_mesh::PartKind;
use std::sync::atomic::{AtomicU8, Ordering};

/// What of a [`Standard`] decides which pipelines draw the part.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Finish {
    pub(crate) opacity: Opacity,
    pub(crate) is_double_sided: bool,
    pub(crate) has_outline: bool,
}

/// What the opacity of a part means for the order of drawing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Opacity {
    /// Nothing.
    Opaque,
    /// It has holes.
    Cut,
    /// It is blended, but what is wholly opaque of it is drawn like a part with holes first: that hides what
    /// lies behind, whatever the order of triangles.
    Blended,
    /// It is blended, and opaque nowhere.
    Clear,
}

impl Finish {
    /// `None` for parts of faces, which have pipelines by their kinds.
    pub(crate) fn of(kind: PartKind, material: &Material) -> Option<Self> {
        let standard = material.standard.as_ref().filter(|_| kind == PartKind::Surface)?;
        let opacity = match standard.alpha {
            Alpha::Opaque => Opacity::Opaque,
            Alpha::Mask(_) => Opacity::Cut,
            Alpha::Blend if standard.base_color[3] >= SOLID => Opacity::Blended,
            Alpha::Blend => Opacity::Clear,
        };
        let has_outline =
            matches!(standard.lighting, Lighting::Cartoon(cartoon) if cartoon.outline_width > 0.0);
        Some(Self { opacity, is_double_sided: standard.is_double_sided, has_outline })
    }

    /// Whether a part with holes of it is drawn.
    pub(crate) fn is_cut(self) -> bool {
        matches!(self.opacity, Opacity::Cut | Opacity::Blended)
    }

    /// Whether it is blended over what is there.
    pub(crate) fn is_blended(self) -> bool {
        matches!(self.opacity, Opacity::Blended | Opacity::Clear)
    }
}

/// The opacities below which nothing is drawn, and below which no shadow is cast.
pub(crate) fn cutoffs(standard: &Standard) -> [f32; 2] {
    match standard.alpha {
        Alpha::Opaque => [-1.0; 2],
        Alpha::Mask(cutoff) => [cutoff; 2],
        // A shadow is there or not: what hides more than half does cast one.
        Alpha::Blend => [SOLID, 0.5],
    }
}

/// A [`Finish`] that changes while others draw.
#[derive(Debug, Default)]
pub(crate) struct FinishCell(AtomicU8);

const IS_THERE: u8 = 1;
const DOUBLE_SIDED: u8 = 2;
const OUTLINE: u8 = 4;
const OPACITY_SHIFT: u8 = 3;
const ONE_SIDED: u8 = 1 << 5;

impl FinishCell {
    pub(crate) fn set(&self, kind: PartKind, material: &Material) {
        let finish = Finish::of(kind, material);
        let flag = |on: bool, bit: u8| if on { bit } else { 0 };
        let bits = finish.map_or(0, |finish| {
            let opacity: u8 = match finish.opacity {
                Opacity::Opaque => 0,
                Opacity::Cut => 1,
                Opacity::Blended => 2,
                Opacity::Clear => 3,
            };
            IS_THERE
                | flag(finish.is_double_sided, DOUBLE_SIDED)
                | flag(finish.has_outline, OUTLINE)
                | (opacity << OPACITY_SHIFT)
        });
        let is_one_sided = material.standard.as_ref().is_some_and(|standard| !standard.is_double_sided);
        self.0.store(bits | flag(is_one_sided, ONE_SIDED), Ordering::Relaxed);
    }

    /// Whether it can be seen from behind. The material of a file says so; parts without one can.
    pub(crate) fn has_back(&self) -> bool {
        self.0.load(Ordering::Relaxed) & ONE_SIDED == 0
    }

    pub(crate) fn get(&self) -> Option<Finish> {
        let bits = self.0.load(Ordering::Relaxed);
        let opacity = match (bits >> OPACITY_SHIFT) & 3 {
            0 => Opacity::Opaque,
            1 => Opacity::Cut,
            2 => Opacity::Blended,
            _ => Opacity::Clear,
        };
        (bits & IS_THERE != 0).then_some(Finish {
            opacity,
            is_double_sided: bits & DOUBLE_SIDED != 0,
            has_outline: bits & OUTLINE != 0,
        })
    }
}
