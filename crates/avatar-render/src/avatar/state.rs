//! What one avatar has for itself.

use crate::avatar::model::AvatarModel;
use crate::deform::pose::{Pose, StateError};
use crate::gpu::identity::Identity;
use crate::hair::detail::HairDetail;
use crate::hair::state::HairState;
use crate::model::part::ModelPart;
use avatar_mesh::Bounds;
use glam::Affine3A;

/// What one avatar has for itself: bone matrices and blend weights.
#[derive(Debug)]
pub struct AvatarState {
    model: Identity,
    pub(crate) pose: Pose,
    /// What the growing pass makes of the model's hair.
    pub(crate) hair: Option<HairState>,
    pub(crate) hair_detail: HairDetail,
}

impl AvatarState {
    /// An avatar of this model at bind pose, all shapes at rest.
    pub fn new(device: &wgpu::Device, model: &AvatarModel) -> Self {
        let pose = Pose::new(device, &model.parts, model.palette_len(), model.shape_count());
        let hair = model
            .hair
            .as_ref()
            .and_then(|hair| Some(HairState::new(device, hair, &pose.parts.get(hair.part)?.vertices)));
        Self { model: model.id, pose, hair, hair_detail: HairDetail::default() }
    }

    /// How much of the hair is grown and drawn, from the next frame on.
    pub fn set_hair_detail(&mut self, detail: HairDetail) {
        self.hair_detail = detail;
    }

    /// Lets hair move: `dt_secs` seconds pass from the last frame to the next one. Locks lag behind the head,
    /// swing, and settle within about a second. Set the pose as well, before or after this call. Frames of
    /// any rate show the same motion. If `dt_secs` is negative, above 0.5 or NaN, hair hangs still where the
    /// head is then; use that after a pause, or when the avatar is put elsewhere. Until the first call, and
    /// after [`AvatarState::still_hair`], hair hangs still, as single pictures need it. A style says how its
    /// hair swings ([`RegionStyle::swing`](avatar_groom::RegionStyle::swing)).
    pub fn advance_hair(&mut self, queue: &wgpu::Queue, dt_secs: f64) {
        if let Some(hair) = &mut self.hair {
            hair.swing.advance(queue, dt_secs);
        }
    }

    /// Stops the motion of hair, from the next frame on.
    pub fn still_hair(&mut self) {
        if let Some(hair) = &mut self.hair {
            hair.hang_still();
        }
    }

    /// Sets the pose for the next frame, and for frames that are recorded but not submitted yet, which show
    /// wrinkles only if the pose had some when they were recorded. `bones` are the bone matrices `X` in the
    /// palette's order; they may include a placement in the world, which must not scale if the model has
    /// hair. `weights` has one blend weight per shape; shapes with weight 0 cost nothing. Bones may scale
    /// unevenly, shear and mirror: normals stay normals, and fronts fronts. The pose that it has already, bit
    /// for bit, costs nothing: it is neither written nor deformed again. Allocates nothing, but for a part
    /// that bones mirror for the first time.
    ///
    /// # Errors
    /// Another number of bones or weights than the model has; the state is unchanged then.
    pub fn set(
        &mut self,
        queue: &wgpu::Queue,
        bones: &[Affine3A],
        weights: &[f32],
    ) -> Result<(), StateError> {
        if self.pose.set(queue, bones, weights)? {
            self.hair.iter().for_each(|hair| hair.set_pose(queue, bones));
        }
        Ok(())
    }

    /// Lets the next frame deform the avatar and grow its hair, whether it moved or not: for a frame that was
    /// recorded but never submitted, whose work the next one takes for done.
    pub fn redo(&self) {
        self.pose.deform_again();
        self.hair.iter().for_each(HairState::redo);
    }

    /// Whether this state was made for this model with the hair that it has now.
    pub(crate) fn fits(&self, model: &AvatarModel) -> bool {
        let hair = (self.hair.as_ref().map(|hair| hair.id), model.hair.as_ref().map(|hair| hair.id));
        self.model == model.id && hair.0 == hair.1
    }

    /// The input of the deform pass.
    pub(crate) fn deforming<'a>(&'a self, model: &'a AvatarModel) -> (&'a [ModelPart], &'a Pose) {
        (&model.parts, &self.pose)
    }

    /// The input of the growing pass, for all strands.
    pub(crate) fn growing_all(&self, model: &AvatarModel) -> Option<(&Pose, &HairState, u32)> {
        let strands = u32::try_from(model.strand_count()).unwrap_or(u32::MAX);
        Some((&self.pose, self.hair.as_ref()?, strands))
    }

    /// A box around the avatar with its hair; `None` if no part has a finite one.
    pub(crate) fn bounds_with_hair(&self, model: &AvatarModel) -> Option<Bounds> {
        let bounds = self.bounds(model)?;
        let reach = model.hair.as_ref().filter(|_| self.hair.is_some()).map_or(0.0, |hair| hair.reach);
        Some(Bounds { min: bounds.min - reach, max: bounds.max + reach })
    }

    /// A box around the avatar without hair, as it is now; `None` if no part has a finite one.
    pub(crate) fn bounds(&self, model: &AvatarModel) -> Option<Bounds> {
        self.pose.bounds(&model.parts)
    }
}
