//! Many avatars of one model.

use crate::avatar::model::AvatarModel;
use crate::deform::crowd_error::CrowdError;
use crate::deform::crowd_pose::{CrowdPose, CrowdWork};
use crate::gpu::identity::Identity;
use glam::Affine3A;

/// Many avatars of one model, each with bones and weights of its own, which are deformed and drawn together:
/// a part of all of them takes one call instead of one for each.
///
/// Their deformed vertices share buffers, as many avatars in each as WebGPU's default limits bind; so the
/// memory of all of them is there from the start: 32 bytes for each vertex of each avatar, on the GPU. What
/// did not move is not deformed again, and what is out of view, or hidden, is neither deformed nor drawn.
///
/// Boxes around avatars are looser than those of an [`AvatarState`](crate::AvatarState) while all weights are
/// from 0 to 1, which saves most of the time of [`AvatarCrowd::set`]; shadow maps, which are fitted around
/// them, are a little coarser then. [`Renderer::draw_crowds`](crate::Renderer::draw_crowds) says in what
/// order blended parts are drawn.
///
/// Avatars of a crowd have no hair and share their materials; near ones that need more are better
/// [`AvatarState`](crate::AvatarState)s, which one frame can draw beside a crowd.
#[derive(Debug)]
pub struct AvatarCrowd {
    model: Identity,
    pub(crate) pose: CrowdPose,
}

impl AvatarCrowd {
    /// So many avatars of this model at bind pose, all in one place, all shapes at rest.
    ///
    /// # Errors
    /// More avatars than the device binds bones or weights of. Too little memory for vertices is an error of
    /// the device.
    pub fn new(device: &wgpu::Device, model: &AvatarModel, avatars: usize) -> Result<Self, CrowdError> {
        let pose = CrowdPose::new(device, &model.parts, model.palette_len(), model.shape_count(), avatars)?;
        Ok(Self { model: model.id, pose })
    }

    /// Number of avatars.
    pub fn len(&self) -> usize {
        self.pose.len()
    }

    /// Whether there are no avatars.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Sets the pose of one avatar, from the next frame on: bones and weights as for
    /// [`AvatarState::set`](crate::AvatarState::set), the bones with its place in the world. `model` is the
    /// one that the crowd was made of. An avatar that is not set keeps its pose and is not deformed again;
    /// neither is one that is set to the pose that it has, bit for bit. The next frame uploads bones and
    /// weights from the first to the last avatar with another pose. Allocates nothing.
    ///
    /// # Errors
    /// No such avatar, another model, another number of bones or weights than the model has, or bones that
    /// mirror; nothing changes then.
    pub fn set(
        &mut self,
        model: &AvatarModel,
        avatar: usize,
        bones: &[Affine3A],
        weights: &[f32],
    ) -> Result<(), CrowdError> {
        if !self.fits(model) {
            return Err(CrowdError::OtherModel);
        }
        self.pose.set(&model.parts, avatar, bones, weights)
    }

    /// Lets the next frame deform all avatars that it shows, whether they moved or not: for a frame that was
    /// recorded but never submitted, whose work the next one takes for done.
    pub fn redo(&mut self) {
        self.pose.redo();
    }

    /// Hides an avatar, or shows it again, from the next frame on. A hidden one casts no shadow.
    ///
    /// # Errors
    /// No such avatar.
    pub fn set_hidden(&mut self, avatar: usize, is_hidden: bool) -> Result<(), CrowdError> {
        self.pose.set_hidden(avatar, is_hidden)
    }

    /// What the last frame did: how many avatars it drew and deformed.
    pub fn work(&self) -> CrowdWork {
        self.pose.work()
    }

    /// Whether this crowd was made of this model.
    pub(crate) fn fits(&self, model: &AvatarModel) -> bool {
        self.model == model.id
    }
}
