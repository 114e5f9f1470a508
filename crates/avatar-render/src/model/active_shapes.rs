//! Blend shapes that are not at rest, on the GPU.

use avatar_look::Wrinkle;

/// WGSL `ActiveShape`.
#[repr(C)]
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
pub(crate) struct GpuActiveShape {
    pub(crate) index: u32,
    pub(crate) weight: f32,
}

impl GpuActiveShape {
    /// What stands before so many shapes of an avatar, without wrinkles.
    pub(crate) fn head(count: usize) -> Self {
        Self { index: count as u32, weight: 0.0 }
    }

    /// What stands before so many shapes and so many places of wrinkles behind them.
    pub(crate) fn head_of(shapes: usize, wrinkles: usize) -> Self {
        Self { index: shapes as u32, weight: wrinkles as f32 }
    }

    /// The places that are wrinkled with these weights of shapes, with how strongly each is.
    pub(crate) fn wrinkled<'a>(
        wrinkles: &'a [Wrinkle],
        weights: &'a [f32],
    ) -> impl Iterator<Item = Self> + 'a {
        let weighted = |(place, wrinkle): (usize, &Wrinkle)| Self {
            index: place as u32,
            weight: wrinkle.weight(weights),
        };
        wrinkles.iter().enumerate().map(weighted).filter(|place| place.weight > 0.0)
    }
}
