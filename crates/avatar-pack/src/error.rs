use crate::SourceError;
use avatar_look::LookError;
use avatar_mesh::drivers::DriversError;
use avatar_mesh::raw_shapes::RawShapesError;
use avatar_mesh::{MeshError, MeshWarning};
use joint_springs::SpringError;
use pose_anim::{BindError, ControlError, TomlError};
use rig_core::XmlError;
use std::fmt;

/// Why a pack could not be loaded, and which of its files is to blame.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{file}: {problem}")]
pub struct PackError {
    /// The file, as [`crate::Source::locate`] names it.
    pub file: String,
    /// What is wrong with it; boxed, so that results stay small.
    pub problem: Box<PackProblem>,
}

/// What is wrong with a file of a pack.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PackProblem {
    /// A file that every pack needs is missing.
    #[error("expected the file {0}, found none")]
    Missing(String),
    /// The file could not be read.
    #[error("{0}")]
    Unreadable(SourceError),
    /// The rig's XML is not as the format demands.
    #[error("{0}")]
    Rig(XmlError),
    /// The rig lacks a joint that the parts follow.
    #[error("expected a joint named {joint:?}, found only {}", found.join(", "))]
    MissingJoint {
        /// The joint that is missing.
        joint: String,
        /// The joints that there are.
        found: Vec<String>,
    },
    /// A vertex or index buffer is not as the format demands.
    #[error("{0}")]
    Mesh(MeshError),
    /// `shapes.raw` is not as the format and `shapes.toml` demand.
    #[error("{0}")]
    RawShapes(RawShapesError),
    /// The controls of shapes and mixtures do not fit those of `controls.toml`.
    #[error("{0}")]
    Controls(ControlError),
    /// Rules of shapes that cannot be followed.
    #[error("{0}")]
    Drivers(DriversError),
    /// A text file that is not UTF-8.
    #[error("expected UTF-8 text, found a bad byte at offset {offset}")]
    NotText {
        /// Offset of the first bad byte.
        offset: usize,
    },
    /// `controls.toml`, `shapes.toml`, `identity.toml`, `springs.toml`, `poses.toml` or `clips.toml` is not
    /// as its format demands.
    #[error("{0}")]
    Toml(TomlError),
    /// `materials.toml` is not as its format demands.
    #[error("{0}")]
    Look(LookError),
    /// `hair.toml` is not as its format demands.
    #[error("{0}")]
    Hair(avatar_groom::TomlError),
    /// A control names a joint or shape that the pack does not have.
    #[error("{0}")]
    Bind(BindError),
    /// What the files say does not agree.
    #[error("{0}")]
    Contents(ContentsError),
}

/// Why the contents of a pack do not agree.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ContentsError {
    /// A control of a joint, slider or shape that the pack does not have.
    #[error(transparent)]
    Bind(#[from] BindError),
    /// Springs or constraints of joints that cannot be followed.
    #[error("the springs: {0}")]
    Springs(#[from] SpringError),
    /// An index that is out of range.
    #[error("{place}: expected the index of one of {count} {what}, found {found}")]
    Index {
        /// Where it stands, such as `part "skin"`.
        place: String,
        /// What it counts: `joints`, `bones`, `shapes`, `sliders` or `controls`.
        what: &'static str,
        /// How many of these there are.
        count: usize,
        /// The index.
        found: usize,
    },
    /// A list that does not have one entry for each of something.
    #[error("{place}: expected {expected} {what}, found {found}")]
    Count {
        /// Where it stands.
        place: String,
        /// What is counted.
        what: &'static str,
        /// How many there must be.
        expected: usize,
        /// How many there are.
        found: usize,
    },
}

/// Something that was mended or replaced while a pack was loaded; the face can be shown all the same.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Warning {
    /// A mesh was mended, or has nothing to show.
    Mesh {
        /// The file.
        file: String,
        /// What it is.
        warning: MeshWarning,
    },
    /// Most triangles of a part contradict their normals; it is turned around for drawing.
    InsideOut {
        /// Name of the part.
        part: String,
        /// Triangles that contradict their normals.
        contradicting: usize,
        /// All triangles.
        triangles: usize,
    },
    /// Something of an interchange file that is not represented.
    Import(String),
    /// A texture is missing or does not decode; a plain default takes its place.
    Texture {
        /// The file.
        file: String,
        /// What is wrong.
        problem: String,
    },
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Import(note) => f.write_str(note),
            Self::Mesh { file, warning } => write!(f, "{file}: {warning}"),
            Self::InsideOut { part, contradicting, triangles } => write!(
                f,
                "{part}: expected triangles that agree with their normals, found {contradicting} of {triangles} \
                 against them: turned around for drawing"
            ),
            Self::Texture { file, problem } => {
                write!(f, "{file}: {problem}: a plain default takes its place")
            }
        }
    }
}
