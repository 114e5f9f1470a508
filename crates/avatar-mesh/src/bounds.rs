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
        let (&first, rest) = points.split_first()?;
        let start = Self { min: first, max: first };
        Some(rest.iter().fold(start, |b, &p| Self { min: b.min.min(p), max: b.max.max(p) }))
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
