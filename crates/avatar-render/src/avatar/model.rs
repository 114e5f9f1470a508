//! What many avatars share.

use crate::gpu::identity::Identity;
use crate::gpu::texture::Textures;
use crate::hair::error::HairError;
use crate::hair::model::HairModel;
use crate::model::bone::GpuBone;
use crate::model::desc::PartDesc;
use crate::model::error::{ModelError, NoSuchPart};
use crate::model::part::{ModelPart, PartLayouts, height};
use avatar_groom::Groom;
use avatar_look::Material;

/// What many avatars share: vertices, triangles, shapes, textures and materials.
#[derive(Debug)]
pub struct AvatarModel {
    /// States remember the identity of the model that they were made for.
    pub(crate) id: Identity,
    pub(crate) parts: Vec<ModelPart>,
    palette_len: usize,
    shape_count: usize,
    /// Height of the skin, or of the head where it has shoulders, at bind pose: the unit of lengths in
    /// materials and, if this avatar looks largest, of the softness of shadows and the reach of ambient
    /// occlusion.
    pub(crate) height: f32,
    pub(crate) hair: Option<HairModel>,
}

impl AvatarModel {
    /// Uploads parts whose bones are positions in a palette of `palette_len` matrices. Needs no renderer: a
    /// model can be drawn by any renderer of the device, and deformed without one.
    ///
    /// # Errors
    /// A mesh that contradicts itself or the palette, a picture with the wrong number of bytes, or more data
    /// than the device binds. A picture that is only too large is halved until it fits.
    pub fn new(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        parts: &[PartDesc<'_>],
        palette_len: usize,
    ) -> Result<Self, ModelError> {
        let limit = device.limits().max_storage_buffer_binding_size / size_of::<GpuBone>() as u64;
        if palette_len as u64 > limit {
            return Err(ModelError::PaletteTooLarge { found: palette_len, limit });
        }
        let layouts = PartLayouts::new(device);
        let height = height(parts);
        let mut textures = Textures::default();
        let last_shapes = parts.iter().filter(|desc| !desc.mesh.shapes.is_empty());
        let shape_count = last_shapes
            .map(|desc| desc.first_weight.saturating_add(desc.mesh.shapes.len()))
            .max()
            .unwrap_or(0);
        let wrinkled = parts.iter().position(|desc| desc.textures.wrinkles.is_some());
        let parts: Result<Vec<_>, _> = (parts.iter().enumerate())
            .map(|(index, desc)| {
                let mut desc = *desc;
                desc.textures.wrinkles = desc.textures.wrinkles.filter(|_| wrinkled == Some(index));
                ModelPart::new(device, queue, &layouts, &mut textures, &desc, parts, palette_len, height)
                    .map_err(|problem| ModelError::Part { label: desc.label.to_owned(), problem })
            })
            .collect();
        Ok(Self { id: Identity::new(), parts: parts?, palette_len, shape_count, height, hair: None })
    }

    /// Number of bone matrices that an avatar of this model needs.
    pub fn palette_len(&self) -> usize {
        self.palette_len
    }

    /// Number of weights that an avatar of this model needs: all up to the last one that a shape follows.
    pub fn shape_count(&self) -> usize {
        self.shape_count
    }

    /// Labels of the parts, in the order in which they were given.
    pub fn part_labels(&self) -> impl ExactSizeIterator<Item = &str> {
        self.parts.iter().map(|part| part.label.as_str())
    }

    /// The parts that have triangles, with their places.
    pub(crate) fn parts_with_triangles(&self) -> impl Iterator<Item = (usize, &ModelPart)> {
        self.parts.iter().enumerate().filter(|(_, part)| part.geometry.index_count > 0)
    }

    /// Plants hair on a part, or removes it (`None`). `groom` must have been made from the part's mesh.
    /// States that were made before do not fit the model any more: make new ones.
    ///
    /// # Errors
    /// No such part, roots that do not belong to it, or more strands than the device binds; nothing changes
    /// then.
    pub fn set_hair(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        part: usize,
        groom: Option<&Groom>,
    ) -> Result<(), HairError> {
        let missing = HairError::NoSuchPart { parts: self.parts.len(), found: part };
        let geometry = &self.parts.get(part).ok_or(missing)?.geometry;
        let hair = groom
            .map(|groom| HairModel::new(device, queue, part, geometry, self.palette_len as u32, groom))
            .transpose()?;
        self.hair = hair.filter(|hair| hair.strand_count > 0);
        Ok(())
    }

    /// Number of strands.
    pub fn strand_count(&self) -> usize {
        self.hair.as_ref().map_or(0, |hair| hair.strand_count as usize)
    }

    /// How high the hair reaches at bind pose, in the world; `None` without hair on the scalp.
    pub fn hair_top(&self) -> Option<f32> {
        self.hair.as_ref()?.top
    }

    /// Sets the height of the head where the skin is more than a head. Call it before
    /// [`Self::set_material`]: looks that are there already keep the lengths that they have.
    pub fn set_height(&mut self, height: f32) {
        if height > 0.0 && height.is_finite() {
            self.height = height;
        }
    }

    /// Replaces the looks of a part in all avatars of this model, from the next submission on; another tone
    /// of skin or iris, and another way of drawing the part, from the next frame on. `part` is its place
    /// among the parts that the model was made of.
    ///
    /// # Errors
    /// No such part; nothing changes then.
    pub fn set_material(
        &self,
        queue: &wgpu::Queue,
        part: usize,
        material: &Material,
    ) -> Result<(), NoSuchPart> {
        let missing = NoSuchPart { parts: self.parts.len(), found: part };
        let part = self.parts.get(part).ok_or(missing)?;
        part.set_material(queue, material, self.height);
        Ok(())
    }
}
