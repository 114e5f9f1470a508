use crate::{MotionAt, Pack, PaletteBone, Part};
use avatar_mesh::{DeformError, Deformed, deformed_triangles};
use glam::Affine3A;
use joint_springs::{Constraints, SpringError, Swing};
use rig_core::{JointId, LengthMismatch, Locals, RigPose, UnknownJoint};
use std::borrow::Cow;

/// Why control values could not be turned into a face.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FaceError {
    /// Another number of values than the pack has controls.
    #[error("expected {expected} control values, found {found}")]
    ValueCount {
        /// Number of controls.
        expected: usize,
        /// Number of values.
        found: usize,
    },
    /// The state belongs to another pack.
    #[error(transparent)]
    Joint(#[from] UnknownJoint),
    /// The state belongs to another pack.
    #[error(transparent)]
    Length(#[from] LengthMismatch),
    /// The state belongs to another pack.
    #[error(transparent)]
    Sliders(#[from] avatar_mesh::drivers::LengthError),
    /// The state belongs to another pack.
    #[error(transparent)]
    Springs(#[from] SpringError),
    /// A crowd of another pack, or a face that a crowd does not have.
    #[error("expected a face below {faces}, the number of faces in the crowd, found {face}")]
    NoSuchFace {
        /// The face that was asked for.
        face: usize,
        /// Number of faces.
        faces: usize,
    },
    /// The controls do not fit the rig.
    #[error(transparent)]
    Apply(#[from] pose_anim::ApplyError),
}

/// The way from control values to what a renderer takes: bone matrices and blend weights. Reused from frame
/// to frame; only making it allocates.
#[derive(Clone, Debug)]
pub struct FaceState {
    effective: Vec<f32>,
    locals: Locals,
    /// Values of the pack's sliders; empty where shapes have none.
    sliders: Vec<f32>,
    pose: RigPose,
    bones: Vec<Affine3A>,
    weights: Vec<f32>,
    /// What turns joints with others, and what makes joints swing; most avatars have neither.
    turning: Option<Box<Constraints>>,
    swing: Option<Box<Swing>>,
}

impl FaceState {
    /// A state for this pack, at bind pose.
    pub fn new(pack: &Pack) -> Self {
        let rest = |bone: &PaletteBone| {
            let world_from_joint = pack.rig().world_from_bind().get(bone.joint.index());
            world_from_joint.map_or(Affine3A::IDENTITY, |w| *w * bone.joint_from_mesh)
        };
        Self {
            effective: pack.controls().defaults(),
            locals: pack.rig().locals(),
            sliders: vec![0.0; pack.sliders().map_or(0, |sliders| sliders.names.len())],
            pose: pack.rig().pose(),
            bones: pack.palette().iter().map(rest).collect(),
            weights: vec![0.0; pack.shapes().len()],
            // A pack has been checked for both.
            turning: pack.springs().turning(pack.rig()).ok().flatten().map(Box::new),
            swing: pack.springs().swing(pack.rig()).ok().flatten().map(Box::new),
        }
    }

    /// Takes control values (degrees or weights, in the table's order) through the couplings, then to the
    /// joints. Joints that turn with others ([`crate::Springs::constraints`]) do so; those that swing are
    /// where the pose has them, until [`FaceState::swing`] or [`FaceState::settle`].
    ///
    /// # Errors
    /// The number of values is not the number of controls, or the state was made for another pack.
    pub fn pose(&mut self, pack: &Pack, values: &[f32]) -> Result<(), FaceError> {
        self.pose_with(pack, values, |_| {}, &[])
    }

    /// As [`FaceState::pose`], with a hand on the way: `adjust` may change the values after the couplings
    /// and before the mixtures, and `locals` replaces the `L` of single joints after the controls.
    ///
    /// # Errors
    /// As [`FaceState::pose`].
    pub fn pose_with(
        &mut self,
        pack: &Pack,
        values: &[f32],
        adjust: impl FnOnce(&mut [f32]),
        locals: &[(JointId, Affine3A)],
    ) -> Result<(), FaceError> {
        self.apply(pack, values, adjust)?;
        for &(joint, local) in locals {
            self.locals.set(joint, local)?;
        }
        self.update(pack)
    }

    /// As [`FaceState::pose`], and from there a share of the way to what a clip of the avatar's file sets: 0
    /// is the face of the values, 1 the clip's. Joints are turned on the shortest way. Several calls with a
    /// rising share lead into the clip smoothly.
    ///
    /// # Errors
    /// As [`FaceState::pose`].
    pub fn pose_toward(
        &mut self,
        pack: &Pack,
        values: &[f32],
        clip: &MotionAt,
        share: f32,
    ) -> Result<(), FaceError> {
        let share = if share.is_nan() { 0.0 } else { share.clamp(0.0, 1.0) };
        self.apply(pack, values, |_| {})?;
        let joints = self.locals.as_slice().len();
        for &(joint, local) in &clip.locals {
            let slot = self.locals.as_mut_slice().get_mut(joint.index());
            let slot = slot.ok_or(UnknownJoint { index: joint.index(), joints })?;
            *slot = between(*slot, local, share);
        }
        for &(shape, weight) in &clip.weights {
            if let Some(slot) = self.weights.get_mut(shape) {
                *slot += (weight - *slot) * share;
            }
        }
        self.update(pack)
    }

    /// Control values to `L` and weights. Joints without a control come to rest: something else may have
    /// moved them before.
    fn apply(
        &mut self,
        pack: &Pack,
        values: &[f32],
        adjust: impl FnOnce(&mut [f32]),
    ) -> Result<(), FaceError> {
        let expected = pack.controls().controls().len();
        if values.len() != expected || self.effective.len() != expected {
            return Err(FaceError::ValueCount { expected, found: values.len() });
        }
        pack.binding().couple(values, &mut self.effective);
        adjust(&mut self.effective);
        if let Some(sliders) = pack.sliders() {
            sliders.mix(pack.controls(), &mut self.effective);
        }
        self.locals.as_mut_slice().fill(Affine3A::IDENTITY);
        match pack.sliders() {
            None => pack.binding().apply(&self.effective, &mut self.locals, &mut self.weights)?,
            Some(sliders) => {
                pack.binding().apply(&self.effective, &mut self.locals, &mut self.sliders)?;
                sliders.follow_controls(&self.effective, &mut self.sliders);
                sliders.run(&self.sliders, &mut self.weights)?;
            }
        }
        Ok(())
    }

    /// Lets `dt_secs` pass until the frame that was posed last, and turns the joints that swing
    /// ([`crate::Springs`]). Call it once after each posing; with a time of 0 the joints keep to a pose that
    /// is posed again. The first frame of a state has them where the pose has them. Costs nothing where
    /// nothing swings; allocates nothing.
    ///
    /// # Errors
    /// The state was made for another pack.
    pub fn swing(&mut self, pack: &Pack, dt_secs: f64) -> Result<(), FaceError> {
        let Some(swing) = &mut self.swing else { return Ok(()) };
        pack.rig().repose(&mut self.pose, |world| Ok::<_, FaceError>(swing.advance(dt_secs, world)?))?;
        self.gather(pack)
    }

    /// Turns the joints that swing to where they come to rest in the pose that was posed last, as a picture
    /// of one moment needs it; motion goes on from there. Up to 1200 steps of every spring; none where
    /// nothing swings; allocates nothing.
    ///
    /// # Errors
    /// The state was made for another pack.
    pub fn settle(&mut self, pack: &Pack) -> Result<(), FaceError> {
        let Some(swing) = &mut self.swing else { return Ok(()) };
        pack.rig().repose(&mut self.pose, |world| Ok::<_, FaceError>(swing.settle(world)?))?;
        self.gather(pack)
    }

    /// Whether something still swings by itself.
    pub fn swings(&self) -> bool {
        self.swing.as_ref().is_some_and(|swing| !swing.is_at_rest())
    }

    /// `L` to world and bone matrices.
    fn update(&mut self, pack: &Pack) -> Result<(), FaceError> {
        pack.rig().update(self.locals.as_slice(), &mut self.pose)?;
        if let Some(turning) = &mut self.turning {
            pack.rig().repose(&mut self.pose, |world| Ok::<_, FaceError>(turning.apply(world)?))?;
        }
        self.gather(pack)
    }

    /// World matrices to those of the palette.
    fn gather(&mut self, pack: &Pack) -> Result<(), FaceError> {
        let (joints, of_joints) = (self.pose.world_from_joint(), self.pose.posed_from_bind());
        for (slot, (PaletteBone { joint, joint_from_mesh }, is_of_joint)) in
            self.bones.iter_mut().zip(pack.bones())
        {
            let unknown = UnknownJoint { index: joint.index(), joints: joints.len() };
            *slot = match is_of_joint {
                true => *of_joints.get(joint.index()).ok_or(unknown)?,
                false => *joints.get(joint.index()).ok_or(unknown)? * *joint_from_mesh,
            };
        }
        Ok(())
    }

    /// Replaces weights of shapes, by their places in [`Pack::shapes`]; places out of range are
    /// ignored.
    pub fn set_weights(&mut self, weights: &[(usize, f32)]) {
        for &(shape, weight) in weights {
            if let Some(slot) = self.weights.get_mut(shape) {
                *slot = weight;
            }
        }
    }

    /// A part in this pose, in world space, by the CPU. Allocates.
    ///
    /// # Errors
    /// A part that the pack does not have, or a state of another pack.
    pub fn deform(&self, pack: &Pack, part: usize) -> Result<Deformed, DeformError> {
        let mut deformed = pack.parts().get(part).map(|part| part.mesh.deformed()).unwrap_or_default();
        self.deform_into(pack, part, &mut deformed)?;
        Ok(deformed)
    }

    /// As [`FaceState::deform`], into what [`avatar_mesh::Mesh::deformed`] has made for this part, without
    /// allocating.
    ///
    /// # Errors
    /// As above, or room for another number of vertices.
    pub fn deform_into(&self, pack: &Pack, part: usize, deformed: &mut Deformed) -> Result<(), DeformError> {
        let missing =
            DeformError::VertexCount { what: "the parts", expected: pack.parts().len(), found: part };
        let part = pack.parts().get(part).ok_or(missing)?;
        let mesh = &part.mesh;
        let shapes = part.shapes();
        let (expected, found) = (shapes.end, self.weights.len());
        let weights = match shapes.is_empty() {
            true => &[],
            false => self.weights.get(shapes).ok_or(DeformError::WeightCount { expected, found })?,
        };
        avatar_mesh::deform(mesh, self.bones_of(part), weights, deformed)
    }

    /// The triangles of a part as they run in this pose: those of its mesh, but what bones mirror the other
    /// way around, so that all are counter-clockwise seen from outside
    /// ([`avatar_mesh::deformed_triangles`]). None of a part that the pack does not have.
    pub fn triangles<'a>(&self, pack: &'a Pack, part: usize) -> Cow<'a, [[u32; 3]]> {
        let part = pack.parts().get(part);
        part.map_or(Cow::Borrowed(&[]), |part| deformed_triangles(&part.mesh, self.bones_of(part)))
    }

    /// The bone matrices that the part's mesh means.
    fn bones_of(&self, part: &Part) -> &[Affine3A] {
        match part.bone {
            Some(bone) => self.bones.get(bone..=bone).unwrap_or_default(),
            None => &self.bones,
        }
    }

    /// Bone matrices `X` in the order of the pack's palette.
    pub fn bones(&self) -> &[Affine3A] {
        &self.bones
    }

    /// Blend weights in the order of the pack's shapes.
    pub fn weights(&self) -> &[f32] {
        &self.weights
    }

    /// World and bone matrices of all joints.
    pub fn rig_pose(&self) -> &RigPose {
        &self.pose
    }

    /// Control values after the couplings and mixtures.
    pub fn effective(&self) -> &[f32] {
        &self.effective
    }
}

/// A share of the way from one transform to another: translation and scale in a straight line, rotation on
/// the shortest way.
fn between(from: Affine3A, to: Affine3A, share: f32) -> Affine3A {
    // The ends are exact; a transform with shear is not what its scale and rotation say.
    if share <= 0.0 {
        return from;
    }
    if share >= 1.0 {
        return to;
    }
    let (scale_a, turn_a, place_a) = from.to_scale_rotation_translation();
    let (scale_b, turn_b, place_b) = to.to_scale_rotation_translation();
    Affine3A::from_scale_rotation_translation(
        scale_a.lerp(scale_b, share),
        turn_a.slerp(turn_b, share),
        place_a.lerp(place_b, share),
    )
}
