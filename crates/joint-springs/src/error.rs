use thiserror::Error;

/// Why a skeleton, a spring or a constraint cannot be used.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum SpringError {
    /// A parent does not stand before its child.
    #[error("joint {joint} has the parent {parent}: a parent has to stand before its children")]
    ParentAfter {
        /// The child.
        joint: usize,
        /// Its parent.
        parent: usize,
    },
    /// A number of a joint that does not exist.
    #[error("{what} names joint {found}, but there are {joints}")]
    UnknownJoint {
        /// Who names it.
        what: &'static str,
        /// The number.
        found: usize,
        /// How many joints there are.
        joints: usize,
    },
    /// A number of a collider that does not exist.
    #[error("the spring of joint {joint} names collider {found}, but there are {colliders}")]
    UnknownCollider {
        /// The joint that swings.
        joint: usize,
        /// The number.
        found: usize,
        /// How many colliders there are.
        colliders: usize,
    },
    /// Two springs or two constraints move the same joint.
    #[error("joint {joint} has two {what}")]
    Twice {
        /// Springs or constraints.
        what: &'static str,
        /// The joint.
        joint: usize,
    },
    /// A constraint waits for itself, perhaps by way of others.
    #[error("the constraint of joint {joint} follows itself")]
    Circle {
        /// The joint, whose constraint makes the circle: without it there is one less.
        joint: usize,
    },
    /// A slice has another number of joints than the skeleton.
    #[error("expected the matrices of {expected} joints, found {found}")]
    Length {
        /// Joints of the skeleton.
        expected: usize,
        /// Matrices that were given.
        found: usize,
    },
}
