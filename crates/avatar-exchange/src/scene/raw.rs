use super::material::{Material, SceneImage};
use super::note::Note;
use avatar_mesh::Mesh;
use avatar_mesh::drivers::ShapeRule;
use glam::{Affine3A, DAffine3, DMat4, Quat, Vec3};

/// What a reader makes of a file, editable and unchecked; [`crate::Scene::from_raw`] checks it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RawScene {
    /// Transforms that depend on each other, in the order of the file.
    pub nodes: Vec<Node>,
    /// Meshes at nodes.
    pub parts: Vec<ScenePart>,
    /// Which nodes move the vertices of parts.
    pub skins: Vec<Skin>,
    /// Which shapes are in-betweens of which drivers; nodes that have none are left out.
    pub drivers: Vec<NodeDrivers>,
    /// Motion.
    pub clips: Vec<Clip>,
    /// Looks of parts.
    pub materials: Vec<Material>,
    /// Textures of materials.
    pub images: Vec<SceneImage>,
    /// How the scene differs from its file.
    pub notes: Vec<Note>,
}

/// A transform with a name, relative to its parent.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Node {
    /// Name; may be empty, need not be unique.
    pub name: String,
    /// Position of the parent among the nodes; roots have none.
    pub parent: Option<usize>,
    /// `parent_from_node` at rest.
    pub local: Transform,
    /// Blend weights at rest, one for each shape of the parts at this node.
    pub weights: Vec<f32>,
}

/// How drivers blend the shapes of the parts at a node, for [`avatar_mesh::drivers::ShapeDrivers::new`].
/// Weights of nodes and clips are those of shapes, so that nothing needs these to show a pose of the file:
/// they are for sliders.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct NodeDrivers {
    /// Position of the node.
    pub node: usize,
    /// Names of the drivers: a slider for each.
    pub drivers: Vec<String>,
    /// Values of the drivers at rest, one for each: where they bring about the node's weights.
    pub rest: Vec<f32>,
    /// Names of the shapes, one for each weight of the node.
    pub shapes: Vec<String>,
    /// What the shapes that do not simply have the weight of the driver of their name follow.
    pub rules: Vec<ShapeRule>,
}

/// `parent_from_node`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Transform {
    /// In parts that clips can move.
    Trs(Trs),
    /// A matrix that is no product of translation, rotation and scale. Clips cannot move it.
    Matrix(Affine3A),
}

/// Translation · rotation · scale: scale is applied first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Trs {
    /// In units of the parent.
    pub translation: Vec3,
    /// Of about unit length; it is normalised before it is used.
    pub rotation: Quat,
    /// Factors along the node's axes.
    pub scale: Vec3,
}

impl Default for Trs {
    fn default() -> Self {
        Self { translation: Vec3::ZERO, rotation: Quat::IDENTITY, scale: Vec3::ONE }
    }
}

impl Default for Transform {
    fn default() -> Self {
        Self::Trs(Trs::default())
    }
}

impl Transform {
    /// A product of translation, rotation and scale where the matrix is one to within rounding, else the
    /// matrix.
    pub fn from_matrix(parent_from_node: DMat4) -> Self {
        let affine = DAffine3::from_mat4(parent_from_node);
        let matrix = Self::Matrix(narrow(affine));
        let axes = affine.matrix3;
        // Without three directions there is no rotation to tell.
        if !(axes.determinant().abs() > f64::MIN_POSITIVE && affine.is_finite()) {
            return matrix;
        }
        let (scale, rotation, translation) = affine.to_scale_rotation_translation();
        let trs = Trs {
            translation: translation.as_vec3(),
            rotation: rotation.normalize().as_quat(),
            scale: scale.as_vec3(),
        };
        let again = Self::Trs(trs).affine().matrix3;
        let size = axes.to_cols_array().iter().fold(0.0f64, |most, x| most.max(x.abs()));
        if again.abs_diff_eq(axes, 1e-6 * size) { Self::Trs(trs) } else { matrix }
    }

    /// As a matrix in f64, which is what products along a chain are taken in.
    pub fn affine(&self) -> DAffine3 {
        match self {
            Self::Trs(trs) => {
                let rotation = trs.rotation.as_dquat();
                let length = rotation.length();
                let unit = if length > 0.0 { rotation / length } else { glam::DQuat::IDENTITY };
                let translation = trs.translation.as_dvec3();
                DAffine3::from_scale_rotation_translation(trs.scale.as_dvec3(), unit, translation)
            }
            Self::Matrix(affine) => widen(affine),
        }
    }

    /// Whether all its numbers are finite.
    pub fn is_finite(&self) -> bool {
        match self {
            Self::Trs(trs) => {
                trs.translation.is_finite() && trs.rotation.is_finite() && trs.scale.is_finite()
            }
            Self::Matrix(affine) => affine.is_finite(),
        }
    }
}

/// The same matrix in f64.
pub(crate) fn widen(affine: &Affine3A) -> DAffine3 {
    DAffine3::from_cols_array(&affine.to_cols_array().map(f64::from))
}

/// The nearest matrix in f32.
pub(crate) fn narrow(affine: DAffine3) -> Affine3A {
    Affine3A::from_cols_array(&affine.to_cols_array().map(|x| x as f32))
}

/// One mesh at one node. A mesh of several primitives becomes several parts; a mesh at several nodes, too.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ScenePart {
    /// Name for people; need not be unique.
    pub name: String,
    /// The node that it hangs from, whose weights blend its shapes.
    pub node: usize,
    /// Which primitive of the node's mesh it is, from 0.
    pub primitive: usize,
    /// The mesh in its own space: that of its node, or of its skin's bind pose. Its bones are positions in
    /// [`Skin::joints`]; [`crate::Scene::bones_of`] gives the matrices in the same order.
    pub mesh: Mesh,
    /// Position of its material.
    pub material: Option<usize>,
    /// Position of its skin; a part without is rigid and follows its node.
    pub skin: Option<usize>,
}

impl ScenePart {
    /// A part that follows a node as a whole.
    pub fn rigid(name: &str, node: usize, mesh: Mesh) -> Self {
        Self { name: name.to_owned(), node, mesh, ..Self::default() }
    }

    /// A part whose vertices follow the joints of a skin.
    pub fn skinned(name: &str, node: usize, mesh: Mesh, skin: usize) -> Self {
        Self { skin: Some(skin), ..Self::rigid(name, node, mesh) }
    }
}

/// Nodes that move vertices.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Skin {
    /// Name; may be empty.
    pub name: String,
    /// Positions of nodes.
    pub joints: Vec<usize>,
    /// `joint_from_mesh` at bind pose, one for each joint.
    pub inverse_binds: Vec<Affine3A>,
}

/// Motion of nodes and weights.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Clip {
    /// Name; may be empty.
    pub name: String,
    /// One for each thing that moves; of two for the same thing, the later one counts.
    pub channels: Vec<Channel>,
}

impl Clip {
    /// Time of the last key of all channels, in seconds; 0 without keys.
    pub fn duration_secs(&self) -> f64 {
        self.channels.iter().filter_map(|channel| channel.times.last()).fold(0.0, |most, t| most.max(*t))
    }
}

/// Keys of one property of one node.
#[derive(Clone, Debug, PartialEq)]
pub struct Channel {
    /// Position of the node.
    pub node: usize,
    /// Which property.
    pub target: ChannelTarget,
    /// What is between keys.
    pub interpolation: Interpolation,
    /// Times of keys in seconds, never falling; at least one.
    pub times: Vec<f64>,
    /// For each key, [`ChannelTarget::width`] numbers (for weights: as many as the node has); three times as
    /// many with [`Interpolation::CubicSpline`]: in-tangent, value, out-tangent.
    pub values: Vec<f32>,
}

/// What a channel moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum ChannelTarget {
    /// x, y, z.
    Translation,
    /// A quaternion x, y, z, w.
    Rotation,
    /// x, y, z.
    Scale,
    /// All blend weights of the node.
    Weights,
}

impl ChannelTarget {
    /// Numbers in one value, for a node of so many weights.
    pub fn width(self, weights: usize) -> usize {
        match self {
            Self::Translation | Self::Scale => 3,
            Self::Rotation => 4,
            Self::Weights => weights,
        }
    }
}

/// What is between keys: the three ways of glTF 2.0, appendix C.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Interpolation {
    /// The earlier key.
    Step,
    /// A straight line; for rotations the shorter arc at constant speed.
    #[default]
    Linear,
    /// A Hermite spline with given tangents.
    CubicSpline,
}
