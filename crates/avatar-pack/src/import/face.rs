//! Where the face of a body is.

use crate::{Pack, Part};
use avatar_mesh::Bounds;
use glam::Vec3;
use rig_core::JointId;

/// A face that is higher than this share of the whole avatar is the whole avatar, not a part of a body.
const MOST: f32 = 0.6;
/// A vertex counts as moved by a shape from this share of the shape's greatest offset on.
const MOVED: f32 = 0.1;
/// How much higher a head is than what expressions move in it, above and below, as a share of that.
const AROUND: f32 = 0.35;

/// Takes in the parts of an avatar one by one.
pub(super) struct Measure {
    /// Per matrix of the palette: whether it belongs to the head. Empty without a head.
    is_head: Vec<bool>,
    found: Option<Bounds>,
}

impl Measure {
    pub(super) fn new(pack: &Pack, head: Option<JointId>) -> Self {
        let parents = pack.rig().parents();
        // A rig has its parents before their children, so that this ends.
        let below = |joint: JointId| {
            std::iter::successors(Some(joint), |joint| parents.get(joint.index()).copied().flatten())
                .any(|joint| Some(joint) == head)
        };
        let is_head = match head {
            Some(_) => pack.palette().iter().map(|bone| below(bone.joint)).collect(),
            None => Vec::new(),
        };
        Self { is_head, found: None }
    }

    /// A part and its vertices at rest.
    pub(super) fn add(&mut self, part: &Part, positions: &[Vec3]) {
        let of_face: Vec<Vec3> = if self.is_head.is_empty() {
            let is_moved = moved_by_shapes(part);
            positions
                .iter()
                .zip(is_moved)
                .filter(|(_, moved)| *moved)
                .map(|(position, _)| *position)
                .collect()
        } else {
            let of_vertex = |vertex: usize| self.share(part, vertex) > 0.5;
            let vertices = positions.iter().enumerate();
            vertices.filter(|(vertex, _)| of_vertex(*vertex)).map(|(_, position)| *position).collect()
        };
        self.found = self.found.into_iter().chain(Bounds::of(&of_face)).reduce(Bounds::union);
    }

    /// How much of a vertex follows the head.
    fn share(&self, part: &Part, vertex: usize) -> f32 {
        let is_head = |bone: usize| self.is_head.get(bone).copied().unwrap_or(false);
        match (part.bone, &part.mesh.skinning) {
            (Some(bone), _) => f32::from(u8::from(is_head(bone))),
            (None, Some(skinning)) => {
                let of_head = skinning.influences(vertex).filter(|(bone, _)| is_head(usize::from(*bone)));
                of_head.map(|(_, weight)| weight).sum()
            }
            (None, None) => 0.0,
        }
    }

    /// The box, where there is more than that.
    pub(super) fn finish(self, whole: Option<Bounds>) -> Option<Bounds> {
        let (mut found, whole) = (self.found?, whole?);
        if self.is_head.is_empty() {
            let more = Vec3::splat(found.size().y * AROUND);
            found = Bounds { min: (found.min - more).max(whole.min), max: (found.max + more).min(whole.max) };
        }
        let height = found.size().y;
        (height > 0.0 && height < MOST * whole.size().y).then_some(found)
    }
}

fn moved_by_shapes(part: &Part) -> Vec<bool> {
    let mut is_moved = vec![false; part.mesh.positions.len()];
    for shape in &part.mesh.shapes {
        let most = shape.positions.iter().map(|(_, offset)| offset.length()).fold(0.0, f32::max);
        for (vertex, _) in shape.positions.iter().filter(|(_, offset)| offset.length() > MOVED * most) {
            is_moved.get_mut(vertex).into_iter().for_each(|moved| *moved = true);
        }
    }
    is_moved
}
