use crate::{RawRig, RigError, XmlError, XmlProblem};
use glam::{Affine3A, Mat3A, Mat4, Vec4};

/// How far a bind matrix may be from rigid: files print six digits. Applies to every element of `RᵀR − 1`, to
/// `det R − 1` and to the last row.
pub const RIGID_TOLERANCE: f32 = 1e-3;

/// How far a bind matrix may move a joint along each axis: sums and rotations of such numbers stay finite.
pub const TRANSLATION_LIMIT: f32 = 1e18;

/// A matrix that is this near to a rotation is one that was rounded to `f32`: it keeps its bits.
const ROUNDED: f32 = 1e-6;

/// A joint of a [`Rig`]: its position in the parents-first arrays.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct JointId(usize);

impl JointId {
    /// Position in every array of the rig.
    pub const fn index(self) -> usize {
        self.0
    }
}

/// A frozen rig: arrays over joints in which no joint precedes its parent.
#[derive(Clone, Debug)]
pub struct Rig {
    names: Vec<String>,
    /// All joints in the order of their names.
    by_name: Vec<JointId>,
    parents: Vec<Option<JointId>>,
    parent_from_joint: Vec<Affine3A>,
    world_from_bind: Vec<Affine3A>,
    bind_from_world: Vec<Affine3A>,
}

impl Rig {
    /// Freezes an edited rig.
    ///
    /// Files print few digits, so a rotation in them may be off by up to [`RIGID_TOLERANCE`]. The rotation
    /// part of such a `B` is replaced by the nearest rotation, once and in `f64`; translations stay, and so
    /// does every bit of a `B` that is a rotation up to the rounding of `f32`. Thus `[Rᵀ ∣ −Rᵀt]` is the
    /// inverse of `W` up to rounding, and `X` of the undeformed rig the identity. [`RawRig`] keeps what the
    /// file says.
    ///
    /// # Errors
    /// Names that are not unique, parents that are missing or form a cycle, matrices that are not rigid.
    pub fn from_raw(raw: &RawRig) -> Result<Self, RigError> {
        Self::freeze(raw, rigid, rigid_inverse)
    }

    /// Freezes a rig whose bind matrices may scale and shear, as nodes of interchange formats do: all
    /// formulas stay, but that `W⁻¹` is a general inverse.
    ///
    /// # Errors
    /// As [`Rig::from_raw`], with matrices that have no inverse in the place of those that are not rigid.
    pub fn from_raw_affine(raw: &RawRig) -> Result<Self, RigError> {
        let rig = Self::freeze(raw, affine, |world_from_bind| world_from_bind.inverse())?;
        match rig.bind_from_world.iter().position(|inverse| !inverse.is_finite()) {
            Some(index) => Err(RigError::Singular { joint: rig.names[index].clone() }),
            None => Ok(rig),
        }
    }

    fn freeze(
        raw: &RawRig,
        check: fn(&str, Mat4) -> Result<Affine3A, RigError>,
        inverse: fn(Affine3A) -> Affine3A,
    ) -> Result<Self, RigError> {
        let (order, raw_parents) = raw.parents_first()?;
        let mut frozen_index = vec![0; order.len()];
        order.iter().enumerate().for_each(|(frozen, &index)| frozen_index[index] = frozen);

        let mut rig = Self {
            names: Vec::with_capacity(order.len()),
            by_name: (0..order.len()).map(JointId).collect(),
            parents: Vec::with_capacity(order.len()),
            parent_from_joint: Vec::with_capacity(order.len()),
            world_from_bind: Vec::with_capacity(order.len()),
            bind_from_world: Vec::with_capacity(order.len()),
        };
        for &index in &order {
            let joint = &raw.joints[index];
            let parent_from_joint = check(&joint.name, joint.parent_from_joint)?;
            let parent = raw_parents[index].map(|parent| JointId(frozen_index[parent]));
            let world_from_bind = match parent {
                Some(parent) => rig.world_from_bind[parent.0] * parent_from_joint,
                None => parent_from_joint,
            };
            rig.names.push(joint.name.clone());
            rig.parents.push(parent);
            rig.parent_from_joint.push(parent_from_joint);
            rig.world_from_bind.push(world_from_bind);
            rig.bind_from_world.push(inverse(world_from_bind));
        }
        rig.by_name.sort_unstable_by(|a, b| rig.names[a.0].cmp(&rig.names[b.0]));
        Ok(rig)
    }

    /// Reads and freezes a `Transformations.xml`.
    ///
    /// # Errors
    /// As [`RawRig::from_xml`] and [`Rig::from_raw`]; the latter with the place of the joint.
    pub fn from_xml(bytes: &[u8]) -> Result<Self, XmlError> {
        let raw = RawRig::from_xml(bytes)?;
        Self::from_raw(&raw).map_err(|error| {
            let joint = raw.joints.iter().find(|joint| joint.name == error.joint());
            let start = crate::Place { line: 1, column: 1 };
            let place = joint.and_then(|joint| joint.place).unwrap_or(start);
            XmlError { place, problem: XmlProblem::Rig(error) }
        })
    }

    /// Number of joints.
    pub fn len(&self) -> usize {
        self.names.len()
    }

    /// Whether there is no joint at all.
    pub fn is_empty(&self) -> bool {
        self.names.is_empty()
    }

    /// All joints, parents before children; reversed (`.rev()`) children before parents.
    pub fn joints(&self) -> impl DoubleEndedIterator<Item = JointId> + ExactSizeIterator + use<> {
        (0..self.names.len()).map(JointId)
    }

    /// The joint of this name. Takes time that grows with the logarithm of the number of joints.
    pub fn joint(&self, name: &str) -> Option<JointId> {
        let found = self.by_name.binary_search_by(|joint| self.names[joint.0].as_str().cmp(name));
        found.ok().map(|at| self.by_name[at])
    }

    /// Names, by [`JointId::index`].
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// Parents, by [`JointId::index`]; `None` at a root.
    pub fn parents(&self) -> &[Option<JointId>] {
        &self.parents
    }

    /// Bind matrices `B` relative to the parent: the file's, with rotations as [`Rig::from_raw`] leaves them.
    pub fn parent_from_joint(&self) -> &[Affine3A] {
        &self.parent_from_joint
    }

    /// World bind matrices `W`.
    pub fn world_from_bind(&self) -> &[Affine3A] {
        &self.world_from_bind
    }

    /// Inverses of the world bind matrices, `W⁻¹`.
    pub fn bind_from_world(&self) -> &[Affine3A] {
        &self.bind_from_world
    }
}

/// `[Rᵀ ∣ −Rᵀt]`: the inverse of a rigid matrix, without dividing.
fn rigid_inverse(a_from_b: Affine3A) -> Affine3A {
    let transposed = a_from_b.matrix3.transpose();
    Affine3A { matrix3: transposed, translation: -(transposed * a_from_b.translation) }
}

/// The matrix as an affine one, if it is affine and has an inverse.
fn affine(joint: &str, matrix: Mat4) -> Result<Affine3A, RigError> {
    if !matrix.is_finite() {
        return Err(RigError::NotFinite { joint: joint.to_owned() });
    }
    let affine = Affine3A::from_mat4(matrix);
    let is_affine = (matrix.row(3) - Vec4::W).abs().max_element() <= RIGID_TOLERANCE;
    if !is_affine || !affine.inverse().is_finite() {
        return Err(RigError::Singular { joint: joint.to_owned() });
    }
    near(joint, affine)
}

/// The matrix as a rotation and a translation, if it is rigid within [`RIGID_TOLERANCE`].
fn rigid(joint: &str, matrix: Mat4) -> Result<Affine3A, RigError> {
    if !matrix.is_finite() {
        return Err(RigError::NotFinite { joint: joint.to_owned() });
    }
    let affine = Affine3A::from_mat4(matrix);
    let gram = affine.matrix3.transpose() * affine.matrix3;
    let off_identity = (gram - Mat3A::IDENTITY).to_cols_array();
    let largest = |values: &[f32]| values.iter().fold(0.0f32, |most, value| most.max(value.abs()));
    let checks = [
        ("the last row", largest(&(matrix.row(3) - Vec4::W).to_array())),
        ("the lengths and right angles of the axes", largest(&off_identity)),
        ("the handedness (determinant)", (affine.matrix3.determinant() - 1.0).abs()),
    ];
    for (what, deviation) in checks {
        // Numbers near the limit of f32 overflow to infinity, and their differences to NaN.
        if deviation > RIGID_TOLERANCE || deviation.is_nan() {
            let tolerance = RIGID_TOLERANCE;
            return Err(RigError::NotRigid { joint: joint.to_owned(), what, deviation, tolerance });
        }
    }
    let rotation =
        if largest(&off_identity) > ROUNDED { nearest_rotation(affine.matrix3) } else { affine.matrix3 };
    near(joint, Affine3A { matrix3: rotation, ..affine })
}

/// The rotation that is nearest to a matrix which is nearly one: that of its polar decomposition, by Newton's
/// iteration `R ← (R + R⁻ᵀ)/2` (N. J. Higham, *Computing the Polar Decomposition — with Applications*, 1986,
/// eq. 3.3). Each step squares the error, so three of them take it from a thousandth to below the rounding of
/// `f64`.
fn nearest_rotation(matrix: Mat3A) -> Mat3A {
    let mut rotation = matrix.as_dmat3();
    for _ in 0..3 {
        rotation = (rotation + rotation.inverse().transpose()) * 0.5;
    }
    Mat3A::from(rotation.as_mat3())
}

fn near(joint: &str, affine: Affine3A) -> Result<Affine3A, RigError> {
    let far = affine.translation.to_array().into_iter().find(|x| x.abs() > TRANSLATION_LIMIT);
    match far {
        Some(found) => Err(RigError::TooFar { joint: joint.to_owned(), found, limit: TRANSLATION_LIMIT }),
        None => Ok(affine),
    }
}
