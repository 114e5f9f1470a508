use glam::{Affine3A, Quat, Vec3};

/// A coordinate axis of a joint's own frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Axis {
    /// Local x.
    X,
    /// Local y.
    Y,
    /// Local z.
    Z,
}

impl Axis {
    /// The axis as a unit vector.
    pub const fn unit(self) -> Vec3 {
        match self {
            Self::X => Vec3::X,
            Self::Y => Vec3::Y,
            Self::Z => Vec3::Z,
        }
    }
}

/// One elementary transformation `M`, a factor of a joint's local transform `L`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Elementary {
    /// Right-handed rotation about `axis` through the joint's origin.
    Rotation {
        /// Unit vector in the joint's frame.
        axis: Vec3,
        /// Angle in radians.
        angle_rad: f32,
    },
    /// Translation in the joint's frame, in the file's units.
    Translation(Vec3),
}

impl Elementary {
    /// Rotation about a coordinate axis by `angle_rad` radians.
    pub const fn rotation(axis: Axis, angle_rad: f32) -> Self {
        Self::Rotation { axis: axis.unit(), angle_rad }
    }

    /// The matrix of this transformation. A rotation whose axis has no length is the identity.
    pub fn matrix(self) -> Affine3A {
        match self {
            Self::Rotation { axis, angle_rad } => match axis.try_normalize() {
                Some(axis) => Affine3A::from_quat(Quat::from_axis_angle(axis, angle_rad)),
                None => Affine3A::IDENTITY,
            },
            Self::Translation(offset) => Affine3A::from_translation(offset),
        }
    }
}

/// `L = M₀ · M₁ · …`, left to right: the last factor acts on a point first.
pub fn product(factors: &[Elementary]) -> Affine3A {
    factors.iter().fold(Affine3A::IDENTITY, |left, factor| left * factor.matrix())
}
