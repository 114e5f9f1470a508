use crate::{Field, Root, Style};
use glam::Vec3;

/// A strand in its place: what stays the same in all poses of the head.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlantedStrand {
    /// Where it grows.
    pub root: Root,
    /// The direction in which it is combed, in the frame of its triangle at bind pose.
    pub comb: Vec3,
    /// Its length in the world.
    pub length: f32,
    /// Its width by that of its style: hairlines begin with finer hair.
    pub thickness: f32,
    /// Where curls begin around it, in radians from −π to π.
    pub phase: f32,
    /// The place in [`Groom::guides`] of the strand that it follows.
    pub guide: Option<u32>,
}

/// The hair of one head: planted strands, how they fall, and what they stay outside of.
///
/// It holds together: guides are strands of it, and each strand follows one of them or none.
#[derive(Clone, Debug, PartialEq)]
pub struct Groom {
    pub(crate) strands: Vec<PlantedStrand>,
    pub(crate) guides: Vec<u32>,
    pub(crate) style: Style,
    pub(crate) field: Field,
    pub(crate) strands_per_square: f32,
    pub(crate) head_bone: u32,
    pub(crate) height: f32,
    pub(crate) top: Option<f32>,
}

impl Groom {
    /// The strands, in the order of drawing: the first ones are a fair sample of all.
    pub fn strands(&self) -> &[PlantedStrand] {
        &self.strands
    }

    /// The strands that others follow, as indices to [`Groom::strands`].
    pub fn guides(&self) -> &[u32] {
        &self.guides
    }

    /// The strand that a strand follows, as an index to [`Groom::strands`].
    pub fn guide(&self, strand: usize) -> Option<usize> {
        let guide = self.strands.get(strand)?.guide?;
        self.guides.get(guide as usize).map(|strand| *strand as usize)
    }

    /// How the hair looks and falls.
    pub fn style(&self) -> &Style {
        &self.style
    }

    /// What strands stay outside of.
    pub fn field(&self) -> &Field {
        &self.field
    }

    /// Strands that were asked for, over a square of the skin's height: how densely they stand, and so how
    /// wide they are.
    pub fn strands_per_square(&self) -> f32 {
        self.strands_per_square
    }

    /// The bone that moves most of the hair.
    pub fn head_bone(&self) -> u32 {
        self.head_bone
    }

    /// How high the hair of the scalp reaches at bind pose, in the world: the highest point of its guides
    /// with their curls. `None` without guides.
    pub fn top(&self) -> Option<f32> {
        self.top
    }

    /// Height of the skin: what lengths of the style are measured by.
    pub fn height(&self) -> f32 {
        self.height
    }
}
