//! The poses of a crowd: bone matrices and blend weights of all its avatars, and which of them the next frame
//! deforms and draws.

use crate::deform::crowd_chunk::{Chunk, CrowdBuffers, GpuCrowdChunk, bytes_of};
use crate::deform::crowd_error::CrowdError;
use crate::deform::pose::{StateError, are_set, avatar_layout, bounds, is_somewhere, widened, wrinkles_of};
use crate::gpu::buffers::written_buffer;
use crate::model::bone::GpuBone;
use crate::model::part::ModelPart;
use crate::model::weights;
use avatar_look::Wrinkle;
use avatar_mesh::{Bounds, mirrors, turns_evenly};
use glam::{Affine3A, Vec3};
use std::ops::Range;
use std::sync::Arc;

/// What the last frame of a crowd did.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct CrowdWork {
    /// Avatars that it drew into the picture.
    pub drawn: usize,
    /// Avatars that are in view or may cast shadows into it, the drawn ones among them.
    pub casting: usize,
    /// Avatars that it deformed.
    pub deformed: usize,
}

/// The deformed vertices of a part in one buffer: as many bytes as WebGPU's default limits bind, so that a
/// crowd is cut in the same way everywhere.
const CHUNK_BYTES: u64 = 128 << 20;

/// What one avatar of a crowd is at present.
#[derive(Clone, Copy, Debug, Default)]
struct Place {
    /// A box around it, if it is somewhere and to be seen.
    bounds: Option<Bounds>,
    is_hidden: bool,
    /// Whether its pose is newer than its deformed vertices.
    has_moved: bool,
    /// Whether its bones scale unevenly or shear.
    is_uneven: bool,
}

/// The poses of a crowd.
#[derive(Debug)]
pub(crate) struct CrowdPose {
    bone_count: usize,
    shape_count: usize,
    bones: Vec<GpuBone>,
    /// As [`weights::write`] writes them, of each avatar.
    weights: Vec<u32>,
    wrinkles: Arc<[Wrinkle]>,
    places: Vec<Place>,
    /// Avatars whose bones and shapes the GPU does not know yet.
    unwritten: Range<usize>,
    /// How many avatars have uneven bones.
    uneven: usize,
    /// Boxes around what each bone moves, with all weights from 0 to 1.
    boxes: Vec<(usize, Bounds)>,
    /// How far bone weights carry vertices out of boxes; see [`widened`].
    excess: [f32; 2],
    buffers: CrowdBuffers,
    /// Group 1 of the deform pass.
    pub(crate) bind_group: wgpu::BindGroup,
    pub(crate) chunks: Vec<Chunk>,
    /// Memory for lists of avatars, at the place of their chunks.
    drawn: Vec<u32>,
    blended: Vec<u32>,
    casting: Vec<u32>,
    moved: Vec<u32>,
    /// Memory for distances.
    distances: Vec<(f32, u32)>,
}

impl CrowdPose {
    /// So many avatars at bind pose, all shapes at rest.
    ///
    /// # Errors
    /// More than the device binds.
    pub(crate) fn new(
        device: &wgpu::Device,
        parts: &[ModelPart],
        bone_count: usize,
        shape_count: usize,
        count: usize,
    ) -> Result<Self, CrowdError> {
        let limits = device.limits();
        let binding = limits.max_storage_buffer_binding_size.min(limits.max_buffer_size);
        let bone_bytes = (bone_count * size_of::<GpuBone>()).max(1);
        let weight_stride = weights::room(shape_count);
        let most = |bytes: usize| (binding / bytes as u64) as usize;
        let limit = most(bone_bytes).min(most(weight_stride * size_of::<u32>()));
        if count > limit {
            return Err(CrowdError::TooMany { found: count, limit });
        }
        let usage = wgpu::BufferUsages::STORAGE;
        // WebGPU binds no empty buffers.
        let room =
            |label, each: usize| written_buffer(device, label, (count.max(1) * each.max(1)) as u64, usage);
        let buffers = CrowdBuffers {
            bones: room("crowd: bones", bone_bytes.max(size_of::<GpuBone>())),
            weights: room("crowd: weights", weight_stride * size_of::<u32>()),
            drawn: room("crowd: drawn", size_of::<u32>()),
            blended: room("crowd: blended", size_of::<u32>()),
            casting: room("crowd: casting shadows", size_of::<u32>()),
            moved: room("crowd: moved", size_of::<u32>()),
        };
        let bind_group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("crowd"),
            layout: &avatar_layout(device),
            entries: &[
                wgpu::BindGroupEntry { binding: 0, resource: buffers.bones.as_entire_binding() },
                wgpu::BindGroupEntry { binding: 1, resource: buffers.weights.as_entire_binding() },
            ],
        });
        let largest = parts.iter().map(bytes_of).max().unwrap_or(1).max(1);
        // A row of workgroups for each avatar.
        let rows = limits.max_compute_workgroups_per_dimension as usize;
        let per_chunk = ((binding.min(CHUNK_BYTES) / largest) as usize).clamp(1, rows.max(1));
        let head = GpuCrowdChunk {
            first_avatar: 0,
            vertex_count: 0,
            bone_count: bone_count as u32,
            weight_stride: weight_stride as u32,
            rigid_bone: 0,
        };
        let chunk =
            |first: usize| Chunk::new(device, parts, &buffers, [first, per_chunk.min(count - first)], head);
        let chunks = (0..count).step_by(per_chunk).map(chunk).collect();
        let boxes = boxes(parts, bone_count);
        let excess = parts.iter().map(|part| part.geometry.bounds.excess());
        let excess = excess.fold([0.0f32; 2], |a, b| [a[0].max(b[0]), a[1].max(b[1])]);
        let bones = vec![GpuBone::new(&Affine3A::IDENTITY); bone_count * count];
        let place = Place { bounds: around(&boxes, excess, &bones), has_moved: true, ..Place::default() };
        Ok(Self {
            bone_count,
            shape_count,
            bones,
            weights: vec![0; weight_stride * count],
            wrinkles: wrinkles_of(parts),
            places: vec![place; count],
            unwritten: 0..count,
            uneven: 0,
            boxes,
            excess,
            buffers,
            bind_group,
            chunks,
            drawn: vec![0; count],
            blended: vec![0; count],
            casting: vec![0; count],
            moved: vec![0; count],
            distances: Vec::with_capacity(count),
        })
    }

    pub(crate) fn len(&self) -> usize {
        self.places.len()
    }

    /// Sets the pose of one avatar.
    ///
    /// # Errors
    /// As [`AvatarCrowd::set`](crate::AvatarCrowd::set).
    pub(crate) fn set(
        &mut self,
        parts: &[ModelPart],
        avatar: usize,
        bones: &[Affine3A],
        weights: &[f32],
    ) -> Result<(), CrowdError> {
        let avatars = self.places.len();
        let Some(place) = self.places.get_mut(avatar) else {
            return Err(CrowdError::NoSuchAvatar { avatars, found: avatar });
        };
        let (bone_count, shape_count) = (self.bone_count, self.shape_count);
        if bones.len() != bone_count {
            return Err(StateError::BoneCount { expected: bone_count, found: bones.len() }.into());
        }
        if weights.len() != shape_count {
            return Err(StateError::WeightCount { expected: shape_count, found: weights.len() }.into());
        }
        let own_bones = &mut self.bones[avatar * bone_count..][..bone_count];
        let weight_stride = weights::room(shape_count);
        let own_weights = &mut self.weights[avatar * weight_stride..][..weight_stride];
        if are_set(own_bones, bones) && weights::are_written(own_weights, weights) {
            return Ok(());
        }
        let is_uneven = bones.iter().any(|bone| !turns_evenly(bone));
        if is_uneven && let Some(bone) = bones.iter().position(|bone| !turns_evenly(bone) && mirrors(bone)) {
            return Err(CrowdError::Mirrored { bone });
        }
        own_bones.iter_mut().zip(bones).for_each(|(gpu, bone)| *gpu = GpuBone::new(bone));
        weights::write(own_weights, weights, &self.wrinkles);
        let is_usual = weights.iter().all(|weight| (0.0..=1.0).contains(weight));
        place.bounds = match is_usual {
            true => around(&self.boxes, self.excess, own_bones),
            false => bounds(parts, own_bones, own_weights),
        };
        self.uneven = self.uneven - usize::from(place.is_uneven) + usize::from(is_uneven);
        (place.is_uneven, place.has_moved) = (is_uneven, true);
        self.unwritten = match self.unwritten.is_empty() {
            true => avatar..avatar + 1,
            false => self.unwritten.start.min(avatar)..self.unwritten.end.max(avatar + 1),
        };
        Ok(())
    }

    /// Lets the next frame write and deform all avatars.
    pub(crate) fn redo(&mut self) {
        self.places.iter_mut().for_each(|place| place.has_moved = true);
        self.unwritten = 0..self.places.len();
    }

    /// Hides or shows one avatar.
    ///
    /// # Errors
    /// No such avatar.
    pub(crate) fn set_hidden(&mut self, avatar: usize, is_hidden: bool) -> Result<(), CrowdError> {
        let avatars = self.places.len();
        let missing = CrowdError::NoSuchAvatar { avatars, found: avatar };
        self.places.get_mut(avatar).ok_or(missing)?.is_hidden = is_hidden;
        Ok(())
    }

    /// Boxes around the avatars that are to be seen.
    pub(crate) fn bounds(&self) -> impl Iterator<Item = Bounds> + Clone {
        self.places.iter().filter(|place| !place.is_hidden).filter_map(|place| place.bounds)
    }

    /// What was chosen last.
    pub(crate) fn work(&self) -> CrowdWork {
        self.chunks.iter().fold(CrowdWork::default(), |sum, chunk| CrowdWork {
            drawn: sum.drawn + chunk.drawn as usize,
            casting: sum.casting + chunk.casting as usize,
            deformed: sum.deformed + chunk.moved as usize,
        })
    }

    /// Whether the deform pass needs the program for uneven bones.
    pub(crate) fn is_uneven(&self) -> bool {
        self.uneven > 0
    }

    /// Chooses what the next frame draws, and writes what the GPU does not know yet. `is_in_view` and `casts`
    /// tell of a box whether the picture may show it, and whether its shadow may fall into the picture.
    /// Drawn ones are listed by their distance. Allocates nothing.
    pub(crate) fn choose(
        &mut self,
        queue: &wgpu::Queue,
        eye: Vec3,
        is_in_view: impl Fn(Bounds) -> bool,
        casts: impl Fn(Bounds) -> bool,
    ) {
        for chunk in &mut self.chunks {
            let own = chunk.first..chunk.first + chunk.len;
            self.distances.clear();
            (chunk.casting, chunk.moved, chunk.is_wrinkled) = (0, 0, false);
            for avatar in own.clone() {
                let place = &mut self.places[avatar];
                let Some(bounds) = place.bounds.filter(|_| !place.is_hidden) else { continue };
                let is_in_view = is_in_view(bounds);
                if is_in_view {
                    let own = self.weights.get(avatar * weights::room(self.shape_count)..);
                    chunk.is_wrinkled |= own.is_some_and(weights::are_wrinkling);
                    self.distances.push((bounds.center().distance_squared(eye), avatar as u32));
                }
                if is_in_view || casts(bounds) {
                    self.casting[chunk.first + chunk.casting as usize] = avatar as u32;
                    chunk.casting += 1;
                    if place.has_moved {
                        self.moved[chunk.first + chunk.moved as usize] = avatar as u32;
                        chunk.moved += 1;
                        place.has_moved = false;
                    }
                }
            }
            // What is near hides what is far. Of equals the first is drawn first, and blended last.
            self.distances.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
            chunk.drawn = self.distances.len() as u32;
            let drawn = self.distances.iter().map(|(_, avatar)| *avatar);
            let far_to_near = drawn.clone().rev();
            self.blended[own.clone()].iter_mut().zip(far_to_near).for_each(|(place, avatar)| *place = avatar);
            self.drawn[own].iter_mut().zip(drawn).for_each(|(place, avatar)| *place = avatar);
        }
        let unwritten = std::mem::take(&mut self.unwritten);
        write(queue, &self.buffers.bones, &self.bones, &unwritten, self.bone_count);
        write(queue, &self.buffers.weights, &self.weights, &unwritten, weights::room(self.shape_count));
        let all = 0..self.places.len();
        write(queue, &self.buffers.drawn, &self.drawn, &all, 1);
        write(queue, &self.buffers.blended, &self.blended, &all, 1);
        write(queue, &self.buffers.casting, &self.casting, &all, 1);
        if self.chunks.iter().any(|chunk| chunk.moved > 0) {
            write(queue, &self.buffers.moved, &self.moved, &all, 1);
        }
    }
}

/// Writes the values of some avatars, each of which has so many.
fn write<T: bytemuck::Pod>(
    queue: &wgpu::Queue,
    buffer: &wgpu::Buffer,
    values: &[T],
    avatars: &Range<usize>,
    each: usize,
) {
    let values = values.get(avatars.start * each..avatars.end * each).unwrap_or_default();
    if !values.is_empty() {
        let offset = avatars.start * each * size_of::<T>();
        queue.write_buffer(buffer, offset as u64, bytemuck::cast_slice(values));
    }
}

/// One box for each bone, around all that it moves with weights of shapes from 0 to 1.
fn boxes(parts: &[ModelPart], bone_count: usize) -> Vec<(usize, Bounds)> {
    let mut boxes: Vec<Option<Bounds>> = vec![None; bone_count];
    for cell in parts.iter().flat_map(|part| part.geometry.bounds.bones()) {
        let shaped = cell.shaped(|_| [0.0, 1.0]);
        if let Some(known) = boxes.get_mut(cell.bone()).filter(|_| is_somewhere(&shaped)) {
            *known = Some(known.map_or(shaped, |known| known.union(shaped)));
        }
    }
    boxes.into_iter().enumerate().filter_map(|(bone, found)| Some((bone, found?))).collect()
}

fn around(boxes: &[(usize, Bounds)], excess: [f32; 2], bones: &[GpuBone]) -> Option<Bounds> {
    let moved = boxes.iter().filter_map(|(bone, around)| Some(bones.get(*bone)?.moved(*around)));
    let union = moved.filter(is_somewhere).reduce(Bounds::union)?;
    Some(widened(union, excess)).filter(is_somewhere)
}

#[cfg(test)]
#[allow(clippy::expect_used, reason = "tests stop at the first surprise")]
mod tests {
    use super::*;
    use crate::gpu::device::gpu_for_tests;
    use crate::gpu::texture::Textures;
    use crate::model::desc::{PartBones, PartDesc, PartTextures};
    use crate::model::part::PartLayouts;
    use avatar_mesh::{Mesh, PartKind, Shape, Skinning};

    /// The boxes of usual weights, of unusual ones, and of bone weights that do not add up to 1, against the
    /// vertices that the CPU deforms.
    #[test]
    fn boxes_hold_all_vertices_with_any_weights() {
        let Some(gpu) = gpu_for_tests() else { return };
        let positions: Vec<Vec3> = (0..24u8)
            .map(|k| Vec3::new(f32::from(k % 4) - 1.5, f32::from(k / 4) - 2.5, 0.3 * f32::from(k % 3)))
            .collect();
        let count = positions.len();
        let push = |along: Vec3| positions.iter().map(|p| along * (p.y + 3.0)).collect::<Vec<_>>();
        for off in [0.0, 0.25] {
            let mesh = Mesh {
                normals: vec![Vec3::Y; count],
                uvs: vec![glam::Vec2::ZERO; count],
                triangles: vec![[0, 1, 2]],
                skinning: Some(Skinning {
                    bones: vec![[0, 1, 0, 0]; count],
                    weights: (0..count)
                        .map(|k| [0.04 * k as f32, 1.0 - 0.04 * k as f32 - off, 0.0, 0.0])
                        .collect(),
                    ..Skinning::default()
                }),
                shapes: vec![
                    Shape::new("out", push(Vec3::X)),
                    Shape::new("up", push(Vec3::new(-0.5, 1.0, 0.0))),
                ],
                positions: positions.clone(),
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
            let known = &mut Textures::default();
            let part = ModelPart::new(&gpu.device, &gpu.queue, &layouts, known, &desc, &[desc], 2, 1.0);
            let parts = [part.expect("a part")];
            let mut pose = CrowdPose::new(&gpu.device, &parts, 2, 2, 2).expect("room");
            for weights in [[0.0, 0.0], [0.5, 1.0], [1.0, 1.0], [0.3, 0.0], [-0.5, 0.2], [1.7, -1.0]] {
                let bones = [Affine3A::from_translation(Vec3::X * 3.0), Affine3A::from_rotation_z(0.7)];
                pose.set(&parts, 1, &bones, &weights).expect("two bones, two weights");
                let bounds = pose.places[1].bounds.expect("a box");
                let mut deformed = mesh.deformed();
                avatar_mesh::deform(&mesh, &bones, &weights, &mut deformed).expect("a mesh that fits");
                for position in deformed.positions {
                    let off = (bounds.min - position).max(position - bounds.max).max_element();
                    assert!(off < 1e-5, "{weights:?}: {position} is outside of {bounds:?} by {off}");
                }
            }
        }
    }
}
