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

    /// Whether what this stands before ends with places of wrinkles.
    pub(crate) fn is_wrinkled(&self) -> bool {
        self.weight > 0.0
    }

    /// Elements that the lists of an avatar with so many shapes take at most.
    pub(crate) fn room(shapes: usize) -> usize {
        1 + shapes + Wrinkle::MOST
    }

    /// Writes the lists of an avatar into room for them. Returns how many shapes are active.
    pub(crate) fn list(room: &mut [Self], weights: &[f32], wrinkles: &[Wrinkle]) -> usize {
        let shapes = weights.iter().enumerate().filter(|(_, weight)| **weight != 0.0);
        let shapes = shapes.map(|(shape, &weight)| Self { index: shape as u32, weight });
        let (mut active, mut places) = (0, 0);
        let Some((head, rest)) = room.split_first_mut() else { return 0 };
        for (own, shape) in rest.iter_mut().zip(shapes) {
            *own = shape;
            active += 1;
        }
        for (own, place) in rest.iter_mut().skip(active).zip(Self::wrinkled(wrinkles, weights)) {
            *own = place;
            places += 1;
        }
        *head = Self::head_of(active, places);
        active
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
