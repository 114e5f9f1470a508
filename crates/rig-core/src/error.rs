use std::fmt;

/// A place in a text: line and column, both from 1, the column in characters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Place {
    /// Line, from 1.
    pub line: usize,
    /// Column in characters, from 1.
    pub column: usize,
}

impl Place {
    /// The place of byte `offset` in `text`; an offset past the end means the end.
    pub(crate) fn of(text: &str, offset: usize) -> Self {
        let mut end = offset.min(text.len());
        while !text.is_char_boundary(end) {
            end -= 1;
        }
        Self { line: 1, column: 1 }.advanced(&text[..end])
    }

    /// The place behind `text`, which starts here.
    pub(crate) fn advanced(self, text: &str) -> Self {
        match text.rfind('\n') {
            None => Self { column: self.column + text.chars().count(), ..self },
            Some(last) => Self {
                line: self.line + text.matches('\n').count(),
                column: text[last + 1..].chars().count() + 1,
            },
        }
    }
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "line {}, column {}", self.line, self.column)
    }
}

/// Why a `Transformations.xml` could not be read, and where.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{place}: {problem}")]
pub struct XmlError {
    /// Where in the text.
    pub place: Place,
    /// What is wrong there.
    pub problem: XmlProblem,
}

/// What is wrong at a place of a `Transformations.xml`.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum XmlProblem {
    /// The bytes are not a text in UTF-8, UTF-16 (with a byte-order mark) or the declared Latin-1.
    #[error("expected XML text, found bytes that are no text ({0})")]
    NotText(String),
    /// The text is not well-formed XML.
    #[error("expected well-formed XML, found: {0}")]
    Malformed(String),
    /// The text ends inside an element.
    #[error("expected </{open}>, found the end of the file")]
    Truncated {
        /// The innermost element that is still open.
        open: String,
    },
    /// An element that does not belong here.
    #[error("expected {expected}, found <{found}>")]
    UnexpectedElement {
        /// Name of the element found.
        found: String,
        /// What may stand here.
        expected: &'static str,
    },
    /// Text where only elements may stand.
    #[error("expected {expected}, found the text {found:?}")]
    UnexpectedText {
        /// The beginning of the text.
        found: String,
        /// What may stand here.
        expected: &'static str,
    },
    /// A joint without `name`, or with an empty one.
    #[error("expected a joint with a name, found <Joint> without one")]
    MissingName,
    /// A name longer than [`crate::MAX_NAME_BYTES`].
    #[error("expected a joint name of at most {limit} bytes, found {found}")]
    NameTooLong {
        /// The limit.
        limit: usize,
        /// Length of the name in bytes.
        found: usize,
    },
    /// Two joints of one name.
    #[error("expected unique joint names, found {name:?} again (first at {first})")]
    DuplicateName {
        /// The name.
        name: String,
        /// Where the first joint of this name stands.
        first: Place,
    },
    /// An attribute whose value is neither `"true"` nor `"false"`.
    #[error("expected {attribute}=\"true\" or \"false\", found {found:?}")]
    NotABoolean {
        /// Name of the attribute.
        attribute: &'static str,
        /// Its value.
        found: String,
    },
    /// A joint without a `<Matrix>`.
    #[error("expected one <Matrix> in joint {joint:?}, found none")]
    MissingMatrix {
        /// Name of the joint.
        joint: String,
    },
    /// A joint with a second `<Matrix>` or `<Children>`.
    #[error("expected one <{element}> in joint {joint:?}, found a second one")]
    Repeated {
        /// Name of the joint.
        joint: String,
        /// `Matrix` or `Children`.
        element: &'static str,
    },
    /// A matrix with more or fewer than 16 numbers.
    #[error("expected 16 numbers in the matrix of joint {joint:?}, found {found}")]
    NumberCount {
        /// Name of the joint.
        joint: String,
        /// How many numbers there are.
        found: usize,
    },
    /// A word in a matrix that is not a finite number.
    #[error("expected a finite number in the matrix of joint {joint:?}, found {found:?}")]
    NotANumber {
        /// Name of the joint.
        joint: String,
        /// The word.
        found: String,
    },
    /// Joints nested deeper than [`crate::MAX_DEPTH`].
    #[error("expected at most {limit} levels of joints, found more")]
    TooDeep {
        /// The limit.
        limit: usize,
    },
    /// A file without any joint.
    #[error("expected at least one <Joint>, found none")]
    NoJoint,
    /// The tree is well-formed, but not a valid rig.
    #[error(transparent)]
    Rig(#[from] RigError),
}

/// Why a [`crate::RawRig`] could not be frozen into a [`crate::Rig`] or written.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RigError {
    /// Two joints of one name.
    #[error("expected unique joint names, found {joint:?} twice")]
    DuplicateJoint {
        /// The name.
        joint: String,
    },
    /// A joint whose parent is not in the rig.
    #[error("joint {joint:?}: expected the name of a joint as parent, found {parent:?}")]
    UnknownParent {
        /// Name of the joint.
        joint: String,
        /// Name of the parent that is missing.
        parent: String,
    },
    /// A joint that is its own ancestor.
    #[error("joint {joint:?}: expected a path to a root, found a cycle of parents")]
    Cycle {
        /// Name of a joint on the cycle.
        joint: String,
    },
    /// A bind matrix that is not rigid.
    #[error(
        "joint {joint:?}: expected a rigid bind matrix (within {tolerance}), found {what} off by {deviation}"
    )]
    NotRigid {
        /// Name of the joint.
        joint: String,
        /// Which property fails.
        what: &'static str,
        /// By how much.
        deviation: f32,
        /// [`crate::RIGID_TOLERANCE`].
        tolerance: f32,
    },
    /// A bind matrix without an inverse.
    #[error(
        "joint {joint:?}: expected a bind matrix with an inverse, found one that flattens space or is no affine map"
    )]
    Singular {
        /// Name of the joint.
        joint: String,
    },
    /// A bind matrix whose translation leaves no room for products: W would become infinite further down.
    #[error("joint {joint:?}: expected a translation of at most {limit} along each axis, found {found}")]
    TooFar {
        /// Name of the joint.
        joint: String,
        /// The coordinate.
        found: f32,
        /// [`crate::TRANSLATION_LIMIT`].
        limit: f32,
    },
    /// A name that the text format cannot hold: empty, blank, longer than [`crate::MAX_NAME_BYTES`], or with
    /// a character that XML 1.0 forbids.
    #[error("joint {joint:?}: expected a name of 1 to {limit} bytes in characters that XML allows")]
    UnwritableName {
        /// The name.
        joint: String,
        /// [`crate::MAX_NAME_BYTES`].
        limit: usize,
    },
    /// A joint too deep in the tree to be written: the reader would refuse the file.
    #[error("joint {joint:?}: expected at most {limit} levels of joints, found more")]
    TooDeep {
        /// Name of the joint.
        joint: String,
        /// [`crate::MAX_DEPTH`].
        limit: usize,
    },
    /// A bind matrix with NaN or infinity.
    #[error("joint {joint:?}: expected 16 finite numbers, found NaN or infinity")]
    NotFinite {
        /// Name of the joint.
        joint: String,
    },
}

impl RigError {
    /// The joint that the error is about.
    pub fn joint(&self) -> &str {
        match self {
            Self::DuplicateJoint { joint }
            | Self::UnknownParent { joint, .. }
            | Self::Cycle { joint }
            | Self::NotRigid { joint, .. }
            | Self::Singular { joint }
            | Self::TooFar { joint, .. }
            | Self::UnwritableName { joint, .. }
            | Self::TooDeep { joint, .. }
            | Self::NotFinite { joint } => joint,
        }
    }
}

/// A slice whose length is not the number of joints.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("expected {expected} joints in {what}, found {found}")]
pub struct LengthMismatch {
    /// Which slice.
    pub what: &'static str,
    /// Number of joints of the rig.
    pub expected: usize,
    /// Length of the slice.
    pub found: usize,
}

/// A [`crate::JointId`] that does not belong to this rig.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("expected a joint index below {joints}, found {index}")]
pub struct UnknownJoint {
    /// The index.
    pub index: usize,
    /// Number of joints.
    pub joints: usize,
}

/// Why a joint of a crowd could not be set.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum CrowdError {
    /// The joint belongs to a larger rig.
    #[error(transparent)]
    Joint(#[from] UnknownJoint),
    /// A rig that the crowd does not have.
    #[error("expected a rig below {rigs}, the number of rigs in the crowd, found {rig}")]
    UnknownRig {
        /// The rig that was asked for.
        rig: usize,
        /// Number of rigs.
        rigs: usize,
    },
}
