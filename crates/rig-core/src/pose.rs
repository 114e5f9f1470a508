use crate::{Elementary, JointId, LengthMismatch, Rig, UnknownJoint, product};
use glam::Affine3A;

/// Local transforms `L`, one per joint of a rig.
#[derive(Clone, Debug, PartialEq)]
pub struct Locals {
    locals: Vec<Affine3A>,
}

impl Locals {
    pub(crate) fn identity(joints: usize) -> Self {
        Self { locals: vec![Affine3A::IDENTITY; joints] }
    }

    /// Back to bind pose.
    pub fn reset(&mut self) {
        self.locals.fill(Affine3A::IDENTITY);
    }

    /// Sets `L` of one joint to a matrix.
    ///
    /// # Errors
    /// The joint belongs to a larger rig.
    pub fn set(&mut self, joint: JointId, local: Affine3A) -> Result<(), UnknownJoint> {
        let joints = self.locals.len();
        let slot = self.locals.get_mut(joint.index());
        *slot.ok_or(UnknownJoint { index: joint.index(), joints })? = local;
        Ok(())
    }

    /// Sets `L` of one joint to a product of elementary transformations, left to right.
    ///
    /// # Errors
    /// The joint belongs to a larger rig.
    pub fn set_product(&mut self, joint: JointId, factors: &[Elementary]) -> Result<(), UnknownJoint> {
        self.set(joint, product(factors))
    }

    /// `L` by [`JointId::index`].
    pub fn as_slice(&self) -> &[Affine3A] {
        &self.locals
    }

    /// `L` by [`JointId::index`], to be changed.
    pub fn as_mut_slice(&mut self) -> &mut [Affine3A] {
        &mut self.locals
    }
}

/// The result of [`Rig::update`].
#[derive(Clone, Debug, PartialEq)]
pub struct RigPose {
    world_from_joint: Vec<Affine3A>,
    posed_from_bind: Vec<Affine3A>,
}

impl RigPose {
    pub(crate) fn in_bind(rig: &Rig) -> Self {
        Self {
            world_from_joint: rig.world_from_bind().to_vec(),
            posed_from_bind: vec![Affine3A::IDENTITY; rig.len()],
        }
    }

    /// World matrices `T` by [`JointId::index`].
    pub fn world_from_joint(&self) -> &[Affine3A] {
        &self.world_from_joint
    }

    /// Bone matrices `X = T · W⁻¹` by [`JointId::index`]: from the bind pose to this pose, both in world
    /// space.
    pub fn posed_from_bind(&self) -> &[Affine3A] {
        &self.posed_from_bind
    }

    /// Copies bone matrices in a palette's order: `out[i] = X[palette[i]]`. Meshes number their bones as they
    /// like, independent of the order of the joints in the file.
    ///
    /// # Errors
    /// A joint that belongs to a larger rig; `out` keeps the matrices before it.
    pub fn gather(&self, palette: &[JointId], out: &mut [Affine3A]) -> Result<(), UnknownJoint> {
        for (slot, joint) in out.iter_mut().zip(palette) {
            let unknown = UnknownJoint { index: joint.index(), joints: self.posed_from_bind.len() };
            *slot = *self.posed_from_bind.get(joint.index()).ok_or(unknown)?;
        }
        Ok(())
    }
}

impl Rig {
    /// Local transforms of this rig, all identity.
    pub fn locals(&self) -> Locals {
        Locals::identity(self.len())
    }

    /// Room for the result of [`Rig::update`], in bind pose.
    pub fn pose(&self) -> RigPose {
        RigPose::in_bind(self)
    }

    /// Lets `change` move the world matrices `T` of a pose, by [`JointId::index`], then computes `X = T ·
    /// W⁻¹` of all joints anew: for what moves joints after the local transforms, such as springs. Allocates
    /// nothing.
    ///
    /// # Errors
    /// `pose` has another number of joints, or what `change` returns; then `X` stays as it was.
    pub fn repose<E: From<LengthMismatch>>(
        &self,
        pose: &mut RigPose,
        change: impl FnOnce(&mut [Affine3A]) -> Result<(), E>,
    ) -> Result<(), E> {
        let found = pose.world_from_joint.len();
        if found != self.len() {
            return Err(LengthMismatch { what: "the pose", expected: self.len(), found }.into());
        }
        change(&mut pose.world_from_joint)?;
        let matrices = pose.world_from_joint.iter().zip(self.bind_from_world());
        for (slot, (world_from_joint, bind_from_world)) in pose.posed_from_bind.iter_mut().zip(matrices) {
            *slot = *world_from_joint * *bind_from_world;
        }
        Ok(())
    }

    /// Computes `T = T_parent · B · L` and `X = T · W⁻¹` for all joints in one forward pass. Allocates
    /// nothing.
    ///
    /// # Errors
    /// `locals` or `pose` has another number of joints.
    pub fn update(&self, locals: &[Affine3A], pose: &mut RigPose) -> Result<(), LengthMismatch> {
        let lengths = [("the local transforms", locals.len()), ("the pose", pose.world_from_joint.len())];
        for (what, found) in lengths {
            if found != self.len() {
                return Err(LengthMismatch { what, expected: self.len(), found });
            }
        }
        for (index, local) in locals.iter().enumerate() {
            let parent_from_posed = self.parent_from_joint()[index] * *local;
            let world_from_joint = match self.parents()[index] {
                Some(parent) => pose.world_from_joint[parent.index()] * parent_from_posed,
                None => parent_from_posed,
            };
            pose.world_from_joint[index] = world_from_joint;
            pose.posed_from_bind[index] = world_from_joint * self.bind_from_world()[index];
        }
        Ok(())
    }
}
