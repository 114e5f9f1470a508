use crate::{FaceError, Pack};
use glam::Affine3A;
use lanes::{LANES, Lanes};
use pose_anim::PlayerCrowd;
use rig_core::RigCrowd;

/// The way from control values to bone matrices and blend weights for many faces of one pack: what
/// [`crate::FaceState`] is for one. Reused from frame to frame; only making it allocates.
///
/// ```
/// use avatar_pack::{FaceCrowd, MemorySource, Pack};
/// use pose_anim::PlayerCrowd;
/// # fn of(pack: &Pack) -> Result<(), Box<dyn std::error::Error>> {
/// let mut players = PlayerCrowd::new(pack.controls(), 1000);
/// let mut faces = FaceCrowd::new(pack, 1000);
/// let mut bones = vec![glam::Affine3A::IDENTITY; pack.palette().len()];
/// if let Some(smile) = pack.poses().get("smile") {
///     players.press(7, smile)?;
/// }
/// // Each frame:
/// players.advance(1.0 / 60.0)?;
/// faces.pose(pack, &players)?;
/// faces.copy_bones(pack, 7, &mut bones)?;
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug)]
pub struct FaceCrowd {
    /// By block of [`LANES`] faces, one per control.
    effective: Vec<Lanes>,
    rigs: RigCrowd,
    /// By block, one per slider; empty where shapes have none.
    sliders: Vec<Lanes>,
    /// By block, one per shape.
    weights: Vec<Lanes>,
    shapes: usize,
}

impl FaceCrowd {
    /// This many faces of this pack, all at bind pose.
    pub fn new(pack: &Pack, faces: usize) -> Self {
        let rigs = RigCrowd::new(pack.rig(), faces);
        let (blocks, shapes) = (rigs.blocks(), pack.shapes().len());
        let sliders = pack.sliders().map_or(0, |sliders| sliders.names.len());
        let defaults = pack.controls().defaults();
        Self {
            effective: (0..blocks).flat_map(|_| defaults.iter().map(|value| Lanes::splat(*value))).collect(),
            rigs,
            sliders: vec![Lanes::splat(0.0); blocks * sliders],
            weights: vec![Lanes::splat(0.0); blocks * shapes],
            shapes,
        }
    }

    /// Number of faces.
    pub fn len(&self) -> usize {
        self.rigs.len()
    }

    /// Whether there is no face at all.
    pub fn is_empty(&self) -> bool {
        self.rigs.is_empty()
    }

    /// Takes the present values of all players through the couplings to weights and bone matrices, as
    /// [`crate::FaceState::pose`]. For the same values of controls, weights are the same to the bit, and
    /// bones as near as [`RigCrowd`] says.
    ///
    /// # Errors
    /// The players are not as many as the faces, or have other controls than the pack; or the crowd was made
    /// for another pack.
    pub fn pose(&mut self, pack: &Pack, players: &PlayerCrowd) -> Result<(), FaceError> {
        let (expected, found) = (self.effective.len(), players.values().len());
        if expected != found || players.len() != self.len() {
            return Err(FaceError::ValueCount { expected, found });
        }
        pack.binding().couple_crowd(players.values(), &mut self.effective);
        match pack.sliders() {
            None => pack.binding().apply_crowd(&self.effective, &mut self.rigs, &mut self.weights)?,
            Some(sliders) => {
                sliders.mix_crowd(pack.controls(), &mut self.effective);
                pack.binding().apply_crowd(&self.effective, &mut self.rigs, &mut self.sliders)?;
                let count = pack.controls().len();
                sliders.follow_controls_crowd(count, &self.effective, &mut self.sliders);
                sliders.run_crowd(self.rigs.blocks(), &self.sliders, &mut self.weights)?;
            }
        }
        self.rigs.update();
        Ok(())
    }

    /// Writes the bone matrices of one face, in the order of the pack's palette
    /// ([`crate::FaceState::bones`]).
    ///
    /// # Errors
    /// A crowd of another pack, or a face that it does not have.
    pub fn copy_bones(&self, pack: &Pack, face: usize, out: &mut [Affine3A]) -> Result<(), FaceError> {
        for (slot, (bone, is_of_joint)) in out.iter_mut().zip(pack.bones()) {
            let found = match is_of_joint {
                true => self.rigs.posed_from_bind(face, bone.joint),
                false => {
                    let world_from_joint = self.rigs.world_from_joint(face, bone.joint);
                    world_from_joint.map(|world_from_joint| world_from_joint * bone.joint_from_mesh)
                }
            };
            *slot = found.ok_or(FaceError::NoSuchFace { face, faces: self.len() })?;
        }
        Ok(())
    }

    /// Writes the blend weights of one face, in the order of the pack's shapes
    /// ([`crate::FaceState::weights`]); of a face that the crowd does not have, nothing.
    pub fn copy_weights(&self, face: usize, out: &mut [f32]) {
        if face < self.len() {
            let block = self.weights.iter().skip(face / LANES * self.shapes);
            let slots = out.iter_mut().take(self.shapes);
            slots.zip(block).for_each(|(slot, lanes)| *slot = lanes[face % LANES]);
        }
    }

    /// Bone matrices of all joints, by block of [`LANES`] faces.
    pub fn rigs(&self) -> &RigCrowd {
        &self.rigs
    }

    /// Blend weights, by block of [`LANES`] faces, one per shape.
    pub fn weights(&self) -> &[Lanes] {
        &self.weights
    }

    /// Control values after the couplings and mixtures, by block of [`LANES`] faces, one per control.
    pub fn effective(&self) -> &[Lanes] {
        &self.effective
    }
}
