use crate::deformer::{GpuDeformedVertex, deformed_layout};
use crate::frame::written_buffer;
use crate::hair::HairState;
use crate::model::ModelPart;
use crate::part::Geometry;
use crate::{AvatarModel, HairDetail};
use avatar_mesh::Bounds;
use bytemuck::Zeroable;
use glam::{Affine3A, Vec3, Vec4};
use wgpu::util::DeviceExt;

/// WGSL `Bone`: the rows of a bone matrix.
#[repr(C)]
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
pub(crate) struct GpuBone {
    pub(crate) rows: [[f32; 4]; 3],
}

/// WGSL `ActiveShapes` up to its array.
#[repr(C)]
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
pub(crate) struct GpuActiveShapesHead {
    pub(crate) count: u32,
}

/// WGSL `ActiveShape`.
#[repr(C)]
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
pub(crate) struct GpuActiveShape {
    pub(crate) index: u32,
    pub(crate) weight: f32,
}

/// What one avatar has for itself: bone matrices and blend weights.
#[derive(Debug)]
pub struct AvatarState {
    bones: Vec<GpuBone>,
    active_shapes: Vec<GpuActiveShape>,
    shape_count: usize,
    /// Also read by eyeballs, which turn the view back to bind pose.
    pub(crate) bone_buffer: wgpu::Buffer,
    shape_buffer: wgpu::Buffer,
    pub(crate) bind_group: wgpu::BindGroup,
    /// What the deform pass makes of each part of the model.
    pub(crate) posed: Vec<PosedPart>,
    /// What the growing pass makes of the model's hair.
    pub(crate) hair: Option<HairState>,
    pub(crate) hair_detail: HairDetail,
}

/// A part in its pose of now, on the GPU.
#[derive(Debug)]
pub(crate) struct PosedPart {
    pub(crate) vertex_count: u32,
    /// [`GpuDeformedVertex`](crate::deformer::GpuDeformedVertex) per vertex.
    pub(crate) vertices: wgpu::Buffer,
    pub(crate) output: wgpu::BindGroup,
}

impl PosedPart {
    fn new(device: &wgpu::Device, layout: &wgpu::BindGroupLayout, part: &ModelPart) -> Self {
        let vertex_count = part.geometry.vertex_count;
        let vertices = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some(&format!("{}: deformed vertices", part.label)),
            // WebGPU binds no empty buffers.
            size: u64::from(vertex_count.max(1)) * size_of::<GpuDeformedVertex>() as u64,
            usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::VERTEX | wgpu::BufferUsages::COPY_SRC,
            mapped_at_creation: false,
        });
        let output = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some(&format!("{}: deformed vertices", part.label)),
            layout,
            entries: &[wgpu::BindGroupEntry { binding: 0, resource: vertices.as_entire_binding() }],
        });
        Self { vertex_count, vertices, output }
    }
}

/// Why a state could not be set.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
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

/// Layout of group 1.
pub(crate) fn avatar_layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    let entry = |binding| wgpu::BindGroupLayoutEntry {
        binding,
        visibility: wgpu::ShaderStages::COMPUTE,
        ty: wgpu::BindingType::Buffer {
            ty: wgpu::BufferBindingType::Storage { read_only: true },
            has_dynamic_offset: false,
            min_binding_size: None,
        },
        count: None,
    };
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("avatar state"),
        entries: &[entry(0), entry(1)],
    })
}

impl AvatarState {
    /// An avatar of this model at bind pose, all shapes at rest.
    pub fn new(device: &wgpu::Device, model: &AvatarModel) -> Self {
        let bones = vec![GpuBone::new(&Affine3A::IDENTITY); model.palette_len()];
        // WebGPU binds no empty buffers.
        let no_bones = [GpuBone::zeroed()];
        let initial: &[GpuBone] = if bones.is_empty() { &no_bones } else { &bones };
        let bone_buffer = device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: Some("avatar: bones"),
            contents: bytemuck::cast_slice(initial),
            usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::VERTEX | wgpu::BufferUsages::COPY_DST,
        });
        let output_layout = deformed_layout(device);
        let posed: Vec<_> =
            model.parts.iter().map(|part| PosedPart::new(device, &output_layout, part)).collect();
        let hair = model
            .hair
            .as_ref()
            .and_then(|hair| Some(HairState::new(device, hair, &posed.get(hair.part)?.vertices)));
        let room = model.shape_count().max(1) * size_of::<GpuActiveShape>();
        // Zeros: no active shapes.
        let bytes = (size_of::<GpuActiveShapesHead>() + room) as u64;
        let shape_buffer =
            written_buffer(device, "avatar: active shapes", bytes, wgpu::BufferUsages::STORAGE);
        let bind_group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("avatar"),
            layout: &avatar_layout(device),
            entries: &[
                wgpu::BindGroupEntry { binding: 0, resource: bone_buffer.as_entire_binding() },
                wgpu::BindGroupEntry { binding: 1, resource: shape_buffer.as_entire_binding() },
            ],
        });
        Self {
            bones,
            active_shapes: Vec::with_capacity(model.shape_count()),
            shape_count: model.shape_count(),
            bone_buffer,
            shape_buffer,
            bind_group,
            posed,
            hair,
            hair_detail: HairDetail::default(),
        }
    }

    /// How much of the hair is grown and drawn, from the next frame on.
    pub fn set_hair_detail(&mut self, detail: HairDetail) {
        self.hair_detail = detail;
    }

    /// Lets hair move: as many seconds pass from the last frame to the next one, in which locks lag behind the head, swing
    /// and settle within about a second. Set the pose as well; the order of the two does not matter. Frames of any rate
    /// show the same motion. Seconds below 0, above a half, or that are no number leave hair still where the head is then: after
    /// a pause, or where the avatar is put elsewhere. Until the first call, and after [`AvatarState::still_hair`], hair
    /// hangs still, as pictures want it. A style says how its hair swings
    /// ([`RegionStyle::swing`](avatar_groom::RegionStyle::swing)).
    pub fn advance_hair(&mut self, queue: &wgpu::Queue, seconds: f32) {
        if let Some(hair) = &mut self.hair {
            hair.swing.advance(queue, seconds);
        }
    }

    /// Lets hair hang still, from the next frame on.
    pub fn still_hair(&mut self) {
        if let Some(hair) = &mut self.hair {
            hair.swing.stop();
        }
    }

    /// Takes over a pose, from the next submission on. `bones` are the bone matrices `X` in the palette's order (times a
    /// placement in the world, if there is one, which must not scale where there is hair), `weights` one blend weight per shape; shapes with weight 0 cost
    /// nothing. Allocates nothing here.
    ///
    /// # Errors
    /// Lengths that do not fit the model; the state is unchanged then.
    pub fn set(
        &mut self,
        queue: &wgpu::Queue,
        bones: &[Affine3A],
        weights: &[f32],
    ) -> Result<(), StateError> {
        if bones.len() != self.bones.len() {
            return Err(StateError::BoneCount { expected: self.bones.len(), found: bones.len() });
        }
        if weights.len() != self.shape_count {
            return Err(StateError::WeightCount { expected: self.shape_count, found: weights.len() });
        }
        self.bones.iter_mut().zip(bones).for_each(|(gpu, bone)| *gpu = GpuBone::new(bone));
        self.hair.iter().for_each(|hair| hair.set_pose(queue, bones));
        self.active_shapes.clear();
        let shapes = weights.iter().enumerate().filter(|(_, weight)| **weight != 0.0);
        self.active_shapes.extend(shapes.map(|(k, &weight)| GpuActiveShape { index: k as u32, weight }));
        let head = GpuActiveShapesHead { count: self.active_shapes.len() as u32 };
        if !self.bones.is_empty() {
            queue.write_buffer(&self.bone_buffer, 0, bytemuck::cast_slice(&self.bones));
        }
        queue.write_buffer(&self.shape_buffer, 0, bytemuck::bytes_of(&head));
        if !self.active_shapes.is_empty() {
            let after_head = size_of::<GpuActiveShapesHead>() as u64;
            queue.write_buffer(&self.shape_buffer, after_head, bytemuck::cast_slice(&self.active_shapes));
        }
        Ok(())
    }

    /// Whether this state was made for a model of the same size.
    pub(crate) fn fits(&self, model: &AvatarModel) -> bool {
        let of_state = self.posed.iter().map(|part| part.vertex_count);
        let of_model = model.parts.iter().map(|part| part.geometry.vertex_count);
        self.bones.len() == model.palette_len()
            && self.shape_count == model.shape_count()
            && of_state.eq(of_model)
            && self.hair.as_ref().map(|hair| hair.id) == model.hair.as_ref().map(|hair| hair.id)
    }

    /// A box around the avatar as it is now. What is nowhere, or endless, has none: it must not take the shadows of other
    /// avatars with it.
    pub(crate) fn bounds(&self, model: &AvatarModel) -> Option<Bounds> {
        let boxes = model.parts.iter().flat_map(|ModelPart { geometry, .. }| {
            geometry.bounds.bones().iter().map(|around| (geometry.first_weight, around))
        });
        // Ascending by index.
        let weight = |shape: usize| {
            let found = self.active_shapes.binary_search_by_key(&shape, |active| active.index as usize);
            found.map_or(0.0, |at| self.active_shapes[at].weight)
        };
        boxes
            .filter_map(|(first, around)| {
                let bone = self.bones.get(around.bone())?;
                Some(bone.moved(around.shaped(|shape| [weight(first + shape); 2])))
            })
            .filter(|bounds| bounds.size().is_finite() && bounds.center().is_finite())
            .reduce(Bounds::union)
    }

    /// Where the middle of a part is now, roughly.
    pub(crate) fn center_of(&self, geometry: &Geometry) -> Vec3 {
        let Some(bone) = self.bones.get(geometry.center_bone) else { return geometry.center };
        let point = geometry.center.extend(1.0);
        Vec3::from_array(bone.rows.map(|row| point.dot(row.into())))
    }
}

impl GpuBone {
    /// The box around a box that this bone moves.
    fn moved(&self, bounds: Bounds) -> Bounds {
        let (center, half) = (bounds.center().extend(1.0), (bounds.size() * 0.5).extend(0.0));
        let center = Vec3::from_array(self.rows.map(|row| center.dot(row.into())));
        let half = Vec3::from_array(self.rows.map(|row| half.dot(Vec4::from(row).abs())));
        Bounds { min: center - half, max: center + half }
    }

    pub(crate) fn new(posed_from_bind: &Affine3A) -> Self {
        let columns = posed_from_bind.matrix3.transpose();
        let t = posed_from_bind.translation;
        let row = |axes: glam::Vec3A, t: f32| [axes.x, axes.y, axes.z, t];
        Self { rows: [row(columns.x_axis, t.x), row(columns.y_axis, t.y), row(columns.z_axis, t.z)] }
    }
}
