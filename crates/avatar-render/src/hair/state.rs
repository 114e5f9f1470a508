//! The hair of one avatar.

use crate::deform::posed::GpuDeformedVertex;
use crate::gpu::identity::Identity;
use crate::gpu::vec4_texture::Vec4Texture;
use crate::hair::layouts::{draw_layout, grow_layouts};
use crate::hair::model::HairModel;
use crate::hair::swing::SwingState;
use crate::hair::uniforms::{GpuHairPose, POINT_STRIDE};
use avatar_groom::OTHER_BONES;
use glam::Affine3A;
use std::sync::atomic::{AtomicU32, Ordering};
use wgpu::util::DeviceExt;

/// The hair of one avatar.
#[derive(Debug)]
pub(crate) struct HairState {
    /// The identity of the model's hair for which it was made.
    pub(crate) id: Identity,
    pub(crate) points: wgpu::Buffer,
    pub(crate) guide_count: u32,
    /// The motion of guides; they hang still until time passes.
    pub(crate) swing: SwingState,
    /// Group 0 of the growing pass: of guides, and of all strands.
    pub(crate) grow_guides: wgpu::BindGroup,
    pub(crate) grow: wgpu::BindGroup,
    /// Group 2 of the growing pass: the deformed skin, and the bones that hair moves with.
    pub(crate) skin: wgpu::BindGroup,
    /// The points of guides, their offsets by swinging, and the deformed skin: buffers that passes write, and
    /// the textures from which growth reads them.
    guides: (wgpu::Buffer, Vec4Texture),
    offsets: Vec4Texture,
    vertices: (wgpu::Buffer, Vec4Texture),
    pose: wgpu::Buffer,
    head_bone: u32,
    other_bones: [u32; OTHER_BONES],
    /// Group 2 of the drawing.
    pub(crate) draw: wgpu::BindGroup,
    /// How many strands, from the first on, have grown for the present pose and swing.
    grown: AtomicU32,
}

impl HairState {
    pub(crate) fn new(device: &wgpu::Device, hair: &HairModel, skin: &wgpu::Buffer) -> Self {
        let buffer = |label, strands: u32| {
            device.create_buffer(&wgpu::BufferDescriptor {
                label: Some(label),
                size: u64::from(strands.max(1)) * (POINT_STRIDE * size_of::<[f32; 4]>()) as u64,
                usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC,
                mapped_at_creation: false,
            })
        };
        let points = buffer("hair: points", hair.strand_count);
        let guides = buffer("hair: points of guides", hair.guide_count);
        let guide_texture = Vec4Texture::new(device, "hair: points of guides", &guides);
        let skin_texture = Vec4Texture::new(device, "hair: deformed skin", skin);
        let pose = device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: Some("hair: pose"),
            contents: bytemuck::bytes_of(&GpuHairPose::new(
                Affine3A::IDENTITY,
                [Affine3A::IDENTITY; OTHER_BONES],
            )),
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
        });
        let [grow_layout, skin_layout] = grow_layouts(device);
        let group = |label, layout: &wgpu::BindGroupLayout, resources: &[wgpu::BindingResource<'_>]| {
            let entries: Vec<_> = (0u32..)
                .zip(resources)
                .map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource: resource.clone() })
                .collect();
            device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some(label),
                layout,
                entries: &entries,
            })
        };
        let swing = SwingState::new(device, &guides, hair.guide_count, hair.swing);
        let offset_texture = Vec4Texture::new(device, "hair: offsets of guides", &swing.offsets);
        let grow = |label, roots: &Vec4Texture, points: &wgpu::Buffer| {
            let resources = [
                hair.hair.as_entire_binding(),
                wgpu::BindingResource::TextureView(&roots.view),
                wgpu::BindingResource::TextureView(&hair.field),
                points.as_entire_binding(),
                wgpu::BindingResource::TextureView(&guide_texture.view),
                wgpu::BindingResource::TextureView(&offset_texture.view),
            ];
            group(label, &grow_layout, &resources)
        };
        let drawn = [
            hair.hair.as_entire_binding(),
            wgpu::BindingResource::TextureView(&hair.roots.view),
            points.as_entire_binding(),
        ];
        debug_assert_eq!(skin.size() % size_of::<GpuDeformedVertex>() as u64, 0);
        Self {
            id: hair.id,
            guide_count: hair.guide_count,
            // Guides follow no guides: they do not read the textures of guides that are bound here.
            grow_guides: grow("grow guides of hair", &hair.guide_roots, &guides),
            grow: grow("grow hair", &hair.roots, &points),
            skin: group(
                "deformed skin",
                &skin_layout,
                &[wgpu::BindingResource::TextureView(&skin_texture.view), pose.as_entire_binding()],
            ),
            draw: group("draw hair", &draw_layout(device), &drawn),
            swing,
            points,
            guides: (guides, guide_texture),
            offsets: offset_texture,
            vertices: (skin.clone(), skin_texture),
            pose,
            head_bone: hair.head_bone,
            other_bones: hair.other_bones,
            grown: AtomicU32::new(0),
        }
    }

    /// Whether so many strands must grow before the next pass draws them.
    pub(crate) fn must_grow(&self, strands: u32) -> bool {
        if self.swing.is_due() {
            // Remembered, since growth spends the time that is due.
            self.grow_again();
        }
        self.grown.load(Ordering::Relaxed) < strands
    }

    /// Notes that so many strands have grown for the present pose and swinging.
    pub(crate) fn set_grown(&self, strands: u32) {
        self.grown.store(strands, Ordering::Relaxed);
    }

    /// Lets strands grow before the next pass draws them.
    pub(crate) fn grow_again(&self) {
        self.set_grown(0);
    }

    /// Lets strands grow and swing again as in the last frame, whose work was lost.
    pub(crate) fn redo(&self) {
        self.swing.redo();
        self.grow_again();
    }

    /// Lets strands hang still. Those that do already need not grow again.
    pub(crate) fn hang_still(&mut self) {
        if !self.swing.is_stopped() {
            self.swing.stop();
            self.grow_again();
        }
    }

    /// Records the copy of the deformed skin into the texture that growth reads.
    pub(crate) fn take_skin(&self, encoder: &mut wgpu::CommandEncoder) {
        let (vertices, texture) = &self.vertices;
        texture.fill(encoder, vertices);
    }

    /// Records the copy of the guides into the textures that strands read.
    pub(crate) fn take_guides(&self, encoder: &mut wgpu::CommandEncoder) {
        let (guides, texture) = &self.guides;
        texture.fill(encoder, guides);
        if self.swing.is_moving() {
            self.offsets.fill(encoder, &self.swing.offsets);
        }
    }

    /// Sets the bones of another pose than before.
    pub(crate) fn set_pose(&self, queue: &wgpu::Queue, bones: &[Affine3A]) {
        self.grow_again();
        let Some(head) = bones.get(self.head_bone as usize) else { return };
        let others = self.other_bones.map(|bone| bones.get(bone as usize).copied().unwrap_or(*head));
        queue.write_buffer(&self.pose, 0, bytemuck::bytes_of(&GpuHairPose::new(*head, others)));
    }
}
