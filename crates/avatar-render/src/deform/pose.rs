//! The pose of one avatar: bone matrices and blend weights.

use crate::deform::posed::{PosedPart, Turn, deformed_layout};
use crate::gpu::bindings::storage_entry;
use crate::gpu::buffers::written_buffer;
use crate::gpu::program::{Constant, Module, Value};
use crate::model::bone::GpuBone;
use crate::model::geometry::Geometry;
use crate::model::part::ModelPart;
use crate::model::weights::{self, HEAD_ROOM, WORD_ROOM};
use avatar_look::Wrinkle;
use avatar_mesh::Bounds;
use bytemuck::Zeroable;
use glam::{Affine3A, Vec3};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, OnceLock};
use wgpu::util::DeviceExt;

/// WGSL of a pose.
pub(crate) const AVATAR: Module = Module { text: include_str!("shaders/avatar.wgsl"), constants };

fn constants() -> Vec<Constant> {
    vec![("HEAD_ROOM", Value::Count(HEAD_ROOM as u32)), ("WORD_ROOM", Value::Count(WORD_ROOM as u32))]
}

/// Why a state could not be set.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum StateError {
    /// Another number of bone matrices than the model's palette has.
    #[error("expected {expected} bone matrices, found {found}")]
    BoneCount {
        /// Length of the palette.
        expected: usize,
        /// Number of matrices.
        found: usize,
    },
    /// Another number of weights than the model has shapes.
    #[error("expected {expected} blend weights, found {found}")]
    WeightCount {
        /// Number of shapes.
        expected: usize,
        /// Number of weights.
        found: usize,
    },
}

/// What one avatar has for itself: bone matrices, blend weights, and the vertices that they make.
#[derive(Debug)]
pub(crate) struct Pose {
    bones: Vec<GpuBone>,
    /// As [`weights::write`] writes them.
    weights: Vec<u32>,
    shape_count: usize,
    wrinkles: Arc<[Wrinkle]>,
    /// Also a vertex buffer of eyeballs, whose shader turns the view back to bind pose.
    pub(crate) bone_buffer: wgpu::Buffer,
    weight_buffer: wgpu::Buffer,
    pub(crate) bind_group: wgpu::BindGroup,
    /// What the deform pass makes of each part of the model.
    pub(crate) parts: Vec<PosedPart>,
    /// What each bone does to normals and fronts.
    turns: Vec<Turn>,
    /// Makes room for parts that bones mirror.
    device: wgpu::Device,
    /// Whether bones and weights are newer than the deformed vertices.
    has_moved: AtomicBool,
    /// The box around all parts, once it was asked for.
    bounds: OnceLock<Option<Bounds>>,
}

/// Layout of group 1 of the passes that deform and grow.
pub(crate) fn avatar_layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    let compute = wgpu::ShaderStages::COMPUTE;
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("avatar state"),
        entries: &[storage_entry(0, compute, true), storage_entry(1, compute, true)],
    })
}

impl Pose {
    /// Bind pose, all shapes at rest.
    pub(crate) fn new(
        device: &wgpu::Device,
        parts: &[ModelPart],
        palette_len: usize,
        shape_count: usize,
    ) -> Self {
        let bones = vec![GpuBone::new(&Affine3A::IDENTITY); palette_len];
        // WebGPU binds no empty buffers.
        let no_bones = [GpuBone::zeroed()];
        let initial: &[GpuBone] = if bones.is_empty() { &no_bones } else { &bones };
        let bone_buffer = device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: Some("avatar: bones"),
            contents: bytemuck::cast_slice(initial),
            usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::VERTEX | wgpu::BufferUsages::COPY_DST,
        });
        let output_layout = deformed_layout(device);
        // Zeros: all shapes at rest.
        let weights = vec![0; weights::room(shape_count)];
        let bytes = size_of_val(weights.as_slice()) as u64;
        let weight_buffer = written_buffer(device, "avatar: weights", bytes, wgpu::BufferUsages::STORAGE);
        let bind_group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("avatar"),
            layout: &avatar_layout(device),
            entries: &[
                wgpu::BindGroupEntry { binding: 0, resource: bone_buffer.as_entire_binding() },
                wgpu::BindGroupEntry { binding: 1, resource: weight_buffer.as_entire_binding() },
            ],
        });
        Self {
            turns: vec![Turn::Even; bones.len()],
            device: device.clone(),
            has_moved: AtomicBool::new(true),
            bounds: OnceLock::new(),
            bones,
            weights,
            shape_count,
            wrinkles: wrinkles_of(parts),
            bone_buffer,
            weight_buffer,
            bind_group,
            parts: parts.iter().map(|part| PosedPart::new(device, &output_layout, part)).collect(),
        }
    }

    /// Sets the pose as [`AvatarState::set`](crate::AvatarState::set) tells. Returns whether it is another
    /// one than before: the same bones and weights, bit for bit, are neither written nor deformed again.
    ///
    /// # Errors
    /// Another number of bones or weights than the model has; the pose is unchanged then.
    pub(crate) fn set(
        &mut self,
        queue: &wgpu::Queue,
        bones: &[Affine3A],
        weights: &[f32],
    ) -> Result<bool, StateError> {
        if bones.len() != self.bones.len() {
            return Err(StateError::BoneCount { expected: self.bones.len(), found: bones.len() });
        }
        if weights.len() != self.shape_count {
            return Err(StateError::WeightCount { expected: self.shape_count, found: weights.len() });
        }
        if are_set(&self.bones, bones) && weights::are_written(&self.weights, weights) {
            return Ok(false);
        }
        self.has_moved = AtomicBool::new(true);
        self.bounds = OnceLock::new();
        self.bones.iter_mut().zip(bones).for_each(|(gpu, bone)| *gpu = GpuBone::new(bone));
        self.turns.iter_mut().zip(bones).for_each(|(turn, bone)| *turn = Turn::of(bone));
        self.parts.iter_mut().for_each(|part| part.set_turns(&self.device, &self.turns));
        weights::write(&mut self.weights, weights, &self.wrinkles);
        if !self.bones.is_empty() {
            queue.write_buffer(&self.bone_buffer, 0, bytemuck::cast_slice(&self.bones));
        }
        queue.write_buffer(&self.weight_buffer, 0, bytemuck::cast_slice(&self.weights));
        Ok(true)
    }

    /// A box around all parts as they are now. Boxes that are not finite are ignored, so that they cannot
    /// take the shadows of other avatars away. Rounding in f32 is not added: shadow maps leave more room
    /// around avatars.
    pub(crate) fn bounds(&self, parts: &[ModelPart]) -> Option<Bounds> {
        *self.bounds.get_or_init(|| bounds(parts, &self.bones, &self.weights))
    }

    /// Lets the next pass deform the vertices, whether they have moved or not.
    pub(crate) fn deform_again(&self) {
        self.has_moved.store(true, Ordering::Relaxed);
    }

    /// Whether the vertices must be deformed before the next pass draws them; from then on they are taken for
    /// deformed.
    pub(crate) fn take_moved(&self) -> bool {
        self.has_moved.swap(false, Ordering::Relaxed)
    }

    /// Whether shapes wrinkle the skin somewhere.
    pub(crate) fn is_wrinkled(&self) -> bool {
        weights::are_wrinkling(&self.weights)
    }

    /// Where the middle of a part is now, roughly.
    pub(crate) fn center_of(&self, geometry: &Geometry) -> Vec3 {
        let Some(bone) = self.bones.get(geometry.center_bone) else { return geometry.center };
        let point = geometry.center.extend(1.0);
        Vec3::from_array(bone.rows.map(|row| point.dot(row.into())))
    }
}

/// The wrinkles of a model.
pub(crate) fn wrinkles_of(parts: &[ModelPart]) -> Arc<[Wrinkle]> {
    let first = parts.iter().find(|part| !part.wrinkles.is_empty());
    first.map_or_else(Default::default, |part| part.wrinkles.clone())
}

/// Whether these bones are written already, bit for bit.
pub(crate) fn are_set(written: &[GpuBone], bones: &[Affine3A]) -> bool {
    let is_set = |(gpu, bone)| bytemuck::bytes_of::<GpuBone>(gpu) == bytemuck::bytes_of(&GpuBone::new(bone));
    written.iter().zip(bones).all(is_set)
}

/// A box around all parts with these bones and written weights; see [`Pose::bounds`].
pub(crate) fn bounds(parts: &[ModelPart], bones: &[GpuBone], written: &[u32]) -> Option<Bounds> {
    let around = |ModelPart { geometry, .. }: &ModelPart| {
        let range = |shape: usize| [weights::weight(written, geometry.first_weight + shape); 2];
        let cells = geometry.bounds.bones().iter();
        let moved = cells.filter_map(|cell| Some(bones.get(cell.bone())?.moved(cell.shaped(range))));
        let union = moved.filter(is_somewhere).reduce(Bounds::union)?;
        Some(widened(union, geometry.bounds.excess()))
    };
    parts.iter().filter_map(around).filter(is_somewhere).reduce(Bounds::union)
}

pub(crate) fn is_somewhere(bounds: &Bounds) -> bool {
    bounds.size().is_finite() && bounds.center().is_finite()
}

/// Smaller errors of bone weights are ignored: shadow maps leave more room around avatars than they move a
/// vertex.
const NEGLIGIBLE_EXCESS: f32 = 1e-3;

/// The union of the boxes that bones move, enlarged by how far weights below 0 and sums of weights other than
/// 1 carry vertices out of it; see [`DeformBounds::excess`](avatar_mesh::DeformBounds::excess).
pub(crate) fn widened(union: Bounds, excess: [f32; 2]) -> Bounds {
    let [overshoot, sum_off] = excess.map(|excess| if excess > NEGLIGIBLE_EXCESS { excess } else { 0.0 });
    let furthest = union.min.abs().max(union.max.abs());
    let wider = overshoot * union.size() + sum_off * furthest;
    Bounds { min: union.min - wider, max: union.max + wider }
}

#[cfg(test)]
#[allow(clippy::expect_used, reason = "tests stop at the first surprise")]
mod tests {
    use super::*;
    use crate::gpu::device::gpu_for_tests;
    use crate::gpu::texture::Textures;
    use crate::model::desc::{PartBones, PartDesc, PartTextures};
    use crate::model::part::PartLayouts;
    use avatar_mesh::{Mesh, PartKind, Skinning};

    #[test]
    fn bounds_hold_what_weights_carry_out_of_the_boxes_of_bones() {
        let Some(gpu) = gpu_for_tests() else { return };
        let bones = [Affine3A::from_translation(Vec3::X * 3.0), Affine3A::from_rotation_z(0.7)];
        for weights in [[0.5, 0.5], [1.5, -0.5], [2.0, 0.0], [0.25, 0.25], [0.0, 0.0]] {
            let mesh = Mesh {
                positions: (0..8u8).map(|k| Vec3::new(1.0, 2.0, 0.1 * f32::from(k))).collect(),
                normals: vec![Vec3::Y; 8],
                uvs: vec![glam::Vec2::ZERO; 8],
                triangles: vec![[0, 1, 2]],
                skinning: Some(Skinning {
                    bones: vec![[0, 1, 0, 0]; 8],
                    weights: vec![[weights[0], weights[1], 0.0, 0.0]; 8],
                    ..Skinning::default()
                }),
                ..Mesh::default()
            };
            let desc = PartDesc {
                label: "part",
                mesh: &mesh,
                first_weight: 0,
                kind: PartKind::Skin,
                bones: PartBones::PerVertex,
                textures: PartTextures::default(),
            };
            let layouts = PartLayouts::new(&gpu.device);
            let part = ModelPart::new(
                &gpu.device,
                &gpu.queue,
                &layouts,
                &mut Textures::default(),
                &desc,
                &[desc],
                2,
                1.0,
            );
            let parts = [part.expect("a part")];
            let mut pose = Pose::new(&gpu.device, &parts, 2, 0);
            pose.set(&gpu.queue, &bones, &[]).expect("lengths fit");
            let bounds = pose.bounds(&parts).expect("a box");
            let mut deformed = mesh.deformed();
            avatar_mesh::deform(&mesh, &bones, &[], &mut deformed).expect("a mesh that fits");
            for position in deformed.positions {
                let off = (bounds.min - position).max(position - bounds.max).max_element();
                assert!(off < 1e-5, "{weights:?}: {position} is outside of {bounds:?} by {off}");
            }
        }
    }
}
