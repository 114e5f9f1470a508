//! Many rigs of one kind, posed together.

use crate::{CrowdError, JointId, Rig, UnknownJoint};
use glam::{Affine3A, DMat3, DQuat, Mat3A, Quat, Vec3, Vec3A};
use lanes::{LANES, Lanes, Simd, Wide, Work, steps};
use std::ops::{Add, Mul, Sub};

/// Local transforms `L` of one joint in [`LANES`] rigs: a rotation, then a translation.
#[derive(Clone, Debug, PartialEq)]
pub struct MotionLanes {
    /// The rotation as a unit quaternion: x, y, z, w.
    pub rotation: [Lanes; 4],
    /// The translation in the frame of the joint at rest: x, y, z.
    pub translation: [Lanes; 3],
}

impl MotionLanes {
    /// No rig moves.
    pub const IDENTITY: Self = Self {
        rotation: [Lanes::splat(0.0), Lanes::splat(0.0), Lanes::splat(0.0), Lanes::splat(1.0)],
        translation: [Lanes::splat(0.0); 3],
    };
}

/// Bone matrices `X` of one joint in [`LANES`] rigs: the columns of the matrix one after the other, three
/// rows each, the translation last (the order of [`Affine3A::to_cols_array`]).
#[derive(Clone, Debug, PartialEq)]
pub struct BoneLanes(pub [Lanes; 12]);

impl BoneLanes {
    const IDENTITY: Self = {
        let mut columns = [Lanes::splat(0.0); 12];
        columns[0] = Lanes::splat(1.0);
        columns[4] = Lanes::splat(1.0);
        columns[8] = Lanes::splat(1.0);
        Self(columns)
    };

    /// The matrix in one lane, which is below [`LANES`].
    fn get(&self, lane: usize) -> Affine3A {
        Affine3A::from_cols_array(&std::array::from_fn(|element| self.0[element][lane]))
    }
}

/// Many rigs of one kind, whose bone matrices are computed together: what [`Rig::update`] does for one, at a
/// fraction of the time for each.
///
/// The numbers of [`LANES`] rigs lie side by side (a *block*), so that a processor computes them at once; the
/// last block may have lanes that belong to no rig. A local transform here is a rotation and a translation,
/// which is what controls make; results are those of [`Rig::update`] to two millionths of their size in rigs
/// of four levels of joints, of which each of both is off by one. Rigs that scale or shear at run time are
/// posed by [`Rig::update`].
///
/// With `p` the origin of a joint at rest, in world space, and `M` the linear part of its `W`:
///
/// ```text
/// X = X_parent · (W · L · W⁻¹)        W · L · W⁻¹ = [ Q ∣ p + M·t − Q·p ]        Q = M · R · M⁻¹
/// ```
///
/// where `L = [R ∣ t]`. If `M` is a rotation, `Q` is the rotation by the same angle about an axis that is
/// fixed in the world, and its quaternion is that of `R` with its axis turned by `M`. `X` of a rig at
/// rest is the identity to the bit.
///
/// ```
/// use glam::{Quat, Vec3};
/// use rig_core::{Rig, RigCrowd};
///
/// let rig = Rig::from_xml(br#"<JointSet><Joint name="NeckJoint">
///     <Matrix>1 0 0 0  0 1 0 2  0 0 1 0  0 0 0 1</Matrix>
/// </Joint></JointSet>"#)?;
/// let neck = rig.joint("NeckJoint").ok_or("no neck")?;
/// let mut crowd = RigCrowd::new(&rig, 1000);
/// for face in 0..crowd.len() {
///     crowd.set(face, neck, Quat::from_rotation_y(face as f32 * 0.001), Vec3::ZERO)?;
/// }
/// crowd.update();
/// let bone = crowd.posed_from_bind(999, neck).ok_or("no such rig")?;
/// assert!(bone.abs_diff_eq(glam::Affine3A::from_rotation_y(0.999), 1e-6));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct RigCrowd {
    joints: Vec<CrowdJoint>,
    rigs: usize,
    /// Block by block, the joints of each.
    motions: Vec<MotionLanes>,
    bones: Vec<BoneLanes>,
}

/// What all rigs of a crowd have in common.
#[derive(Clone, Copy, Debug)]
struct CrowdJoint {
    parent: Option<usize>,
    world_from_bind: Affine3A,
    /// `M` and, where it is no rotation, `M⁻¹`.
    linear: Mat3A,
    inverse: Option<Mat3A>,
}

impl RigCrowd {
    /// This many rigs, all in bind pose.
    pub fn new(rig: &Rig, rigs: usize) -> Self {
        let joint = |id: JointId| {
            let world_from_bind = rig.world_from_bind()[id.index()];
            let linear = world_from_bind.matrix3;
            let gram = linear.transpose() * linear;
            let is_rotation = gram.abs_diff_eq(Mat3A::IDENTITY, 1e-5) && linear.determinant() > 0.0;
            let inverse = (!is_rotation).then(|| rig.bind_from_world()[id.index()].matrix3);
            let parent = rig.parents()[id.index()].map(JointId::index);
            // A rotation that is a product of others in `f32` has lost some of its right angles.
            let linear = match is_rotation {
                true => {
                    Mat3A::from(DMat3::from_quat(DQuat::from_mat3(&linear.as_dmat3()).normalize()).as_mat3())
                }
                false => linear,
            };
            CrowdJoint { parent, world_from_bind, linear, inverse }
        };
        let blocks = rigs.div_ceil(LANES);
        Self {
            joints: rig.joints().map(joint).collect(),
            rigs,
            motions: vec![MotionLanes::IDENTITY; blocks * rig.len()],
            bones: vec![BoneLanes::IDENTITY; blocks * rig.len()],
        }
    }

    /// Number of rigs.
    pub fn len(&self) -> usize {
        self.rigs
    }

    /// Whether there is no rig at all.
    pub fn is_empty(&self) -> bool {
        self.rigs == 0
    }

    /// Number of joints of each rig.
    pub fn joint_count(&self) -> usize {
        self.joints.len()
    }

    /// Number of blocks of [`LANES`] rigs.
    pub fn blocks(&self) -> usize {
        self.rigs.div_ceil(LANES)
    }

    /// Sets `L` of one joint of one rig: a rotation (a unit quaternion), then a translation in the frame of
    /// the joint at rest.
    ///
    /// # Errors
    /// A joint of a larger rig, or a rig that the crowd does not have.
    pub fn set(
        &mut self,
        rig: usize,
        joint: JointId,
        rotation: Quat,
        translation: Vec3,
    ) -> Result<(), CrowdError> {
        let (joints, rigs) = (self.joints.len(), self.rigs);
        if rig >= rigs {
            return Err(CrowdError::UnknownRig { rig, rigs });
        }
        let place = self.place(rig, joint).ok_or(UnknownJoint { index: joint.index(), joints })?;
        let motion = &mut self.motions[place];
        let lane = rig % LANES;
        motion.rotation.iter_mut().zip(rotation.to_array()).for_each(|(slot, value)| slot[lane] = value);
        motion
            .translation
            .iter_mut()
            .zip(translation.to_array())
            .for_each(|(slot, value)| slot[lane] = value);
        Ok(())
    }

    /// `L` of the joints of one block of rigs, by [`JointId::index`], to be changed; empty behind the last
    /// block.
    pub fn motions_mut(&mut self, block: usize) -> &mut [MotionLanes] {
        let joints = self.joints.len();
        self.motions.get_mut(block * joints..(block + 1) * joints).unwrap_or_default()
    }

    /// `X` of the joints of one block of rigs, by [`JointId::index`]; empty behind the last block.
    pub fn bones(&self, block: usize) -> &[BoneLanes] {
        let joints = self.joints.len();
        self.bones.get(block * joints..(block + 1) * joints).unwrap_or_default()
    }

    /// The bone matrix `X` of one joint of one rig, as of the last [`Self::update`]; `None` if there is none.
    pub fn posed_from_bind(&self, rig: usize, joint: JointId) -> Option<Affine3A> {
        Some(self.bones.get(self.place(rig, joint)?)?.get(rig % LANES))
    }

    /// The world matrix `T = X · W` of one joint of one rig; `None` if there is none.
    pub fn world_from_joint(&self, rig: usize, joint: JointId) -> Option<Affine3A> {
        Some(self.posed_from_bind(rig, joint)? * self.joints[joint.index()].world_from_bind)
    }

    fn place(&self, rig: usize, joint: JointId) -> Option<usize> {
        let exists = rig < self.rigs && joint.index() < self.joints.len();
        exists.then(|| rig / LANES * self.joints.len() + joint.index())
    }

    /// Computes `X` of all joints of all rigs. Allocates nothing.
    pub fn update(&mut self) {
        let (joints, motions, bones) = (&self.joints, &self.motions, &mut self.bones);
        lanes::run(Update { joints, motions, bones });
    }
}

/// [`RigCrowd::update`] for vectors of some width.
struct Update<'a> {
    joints: &'a [CrowdJoint],
    motions: &'a [MotionLanes],
    bones: &'a mut [BoneLanes],
}

impl Work for Update<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let count = self.joints.len().max(1);
        for (motions, bones) in self.motions.chunks_exact(count).zip(self.bones.chunks_exact_mut(count)) {
            for (index, (joint, motion)) in self.joints.iter().zip(motions).enumerate() {
                let (before, rest) = bones.split_at_mut(index);
                let parent = joint.parent.and_then(|parent| before.get(parent));
                let Some(bone) = rest.first_mut() else { continue };
                match joint.inverse {
                    None => pose_rigid(simd, joint, motion, parent, bone),
                    Some(inverse) => pose_affine(joint, inverse, motion, parent, bone),
                }
            }
        }
    }
}

/// The elements of a matrix of three columns.
type Linear<N> = [N; 9];

/// The matrix of a unit quaternion x, y, z, w.
#[inline(always)]
fn matrix_of<N>(one: N, [x, y, z, w]: [N; 4]) -> Linear<N>
where
    N: Copy + Add<Output = N> + Sub<Output = N> + Mul<Output = N>,
{
    let (x2, y2, z2) = (x + x, y + y, z + z);
    let (xx, yy, zz) = (x * x2, y * y2, z * z2);
    let (xy, xz, yz) = (x * y2, x * z2, y * z2);
    let (wx, wy, wz) = (w * x2, w * y2, w * z2);
    [one - (yy + zz), xy + wz, xz - wy, xy - wz, one - (xx + zz), yz + wx, xz + wy, yz - wx, one - (xx + yy)]
}

/// Matrix times vector.
#[inline(always)]
fn times<S: Simd>(m: &Linear<Wide<S>>, [x, y, z]: [Wide<S>; 3]) -> [Wide<S>; 3] {
    [m[0] * x + m[3] * y + m[6] * z, m[1] * x + m[4] * y + m[7] * z, m[2] * x + m[5] * y + m[8] * z]
}

/// `X` of a joint whose `W` is rigid.
#[inline(always)]
fn pose_rigid<S: Simd>(
    simd: S,
    joint: &CrowdJoint,
    motion: &MotionLanes,
    parent: Option<&BoneLanes>,
    bone: &mut BoneLanes,
) {
    let splat = |value| Wide::splat(simd, value);
    let (one, linear) = (splat(1.0), joint.linear.to_cols_array().map(splat));
    let origin = joint.world_from_bind.translation.to_array().map(splat);
    for step in 0..steps::<S>() {
        let load = |lanes: &Lanes| Wide::load(simd, lanes, step);
        let [x, y, z, w] = &motion.rotation;
        let [ax, ay, az] = times(&linear, [load(x), load(y), load(z)]);
        let turn = matrix_of(one, [ax, ay, az, load(w)]);
        let [tx, ty, tz] = &motion.translation;
        let moved = times(&linear, [load(tx), load(ty), load(tz)]);
        let turned = times(&turn, origin);
        let shift = [0, 1, 2].map(|i| moved[i] + (origin[i] - turned[i]));
        let columns =
            [[turn[0], turn[1], turn[2]], [turn[3], turn[4], turn[5]], [turn[6], turn[7], turn[8]], shift];
        match parent {
            None => store(columns, step, bone),
            Some(parent) => {
                let p: [Wide<S>; 9] = std::array::from_fn(|element| load(&parent.0[element]));
                let [a, b, c, t] = columns;
                let t = times(&p, t);
                let t = [0, 1, 2].map(|i| t[i] + load(&parent.0[9 + i]));
                store([times(&p, a), times(&p, b), times(&p, c), t], step, bone);
            }
        }
    }
}

#[inline(always)]
fn store<S: Simd>(columns: [[Wide<S>; 3]; 4], step: usize, bone: &mut BoneLanes) {
    for (column, numbers) in columns.into_iter().enumerate() {
        for (row, number) in numbers.into_iter().enumerate() {
            number.store(&mut bone.0[3 * column + row], step);
        }
    }
}

/// The rare case of a `W` that scales, shears or mirrors, one rig at a time.
fn pose_affine(
    joint: &CrowdJoint,
    inverse: Mat3A,
    motion: &MotionLanes,
    parent: Option<&BoneLanes>,
    bone: &mut BoneLanes,
) {
    let origin = joint.world_from_bind.translation;
    for lane in 0..LANES {
        let [x, y, z, w] = [0, 1, 2, 3].map(|part| motion.rotation[part][lane]);
        let offset = Vec3A::from([0, 1, 2].map(|part| motion.translation[part][lane]));
        let local = Mat3A::from_cols_array(&matrix_of(1.0, [x, y, z, w]));
        let matrix3 = joint.linear * local * inverse;
        let translation = joint.linear * offset + (origin - matrix3 * origin);
        let y = Affine3A { matrix3, translation };
        let posed = parent.map_or(y, |parent| parent.get(lane) * y);
        bone.0.iter_mut().zip(posed.to_cols_array()).for_each(|(slot, value)| slot[lane] = value);
    }
}
