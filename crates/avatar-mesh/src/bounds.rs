use glam::Vec3;

/// An axis-aligned box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Smallest coordinates.
    pub min: Vec3,
    /// Largest coordinates.
    pub max: Vec3,
}

impl Bounds {
    /// The smallest box around all points; `None` without points.
    pub fn of(points: &[Vec3]) -> Option<Self> {
        let first = *points.first()?;
        let start = Self { min: first, max: first };
        // Four points at a time: twelve coordinates fill registers.
        let (fours, rest) = points.as_chunks::<4>();
        let (mut least, mut most) = ([first; 4], [first; 4]);
        let (low, high): (&mut [f32; 12], &mut [f32; 12]) =
            (bytemuck::cast_mut(&mut least), bytemuck::cast_mut(&mut most));
        for four in fours {
            let coordinates: &[f32; 12] = bytemuck::cast_ref(four);
            for (i, &x) in coordinates.iter().enumerate() {
                low[i] = if low[i] < x { low[i] } else { x };
                high[i] = if high[i] > x { high[i] } else { x };
            }
        }
        let of_fours = least.into_iter().zip(most).map(|(min, max)| Self { min, max });
        let of_rest = rest.iter().map(|&p| Self { min: p, max: p });
        Some(of_fours.chain(of_rest).fold(start, Self::union))
    }

    /// The smallest box around two boxes.
    #[must_use]
    pub fn union(self, other: Self) -> Self {
        Self { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    /// The middle.
    pub fn center(self) -> Vec3 {
        (self.min + self.max) * 0.5
    }

    /// Edge lengths.
    pub fn size(self) -> Vec3 {
        self.max - self.min
    }
}
