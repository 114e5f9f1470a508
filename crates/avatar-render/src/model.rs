use crate::eye::{EyeShape, eye_shape};
use crate::hair::{HairError, HairModel};
use crate::material::{
    COLOR_TEXTURE, GLOSS_TEXTURE, GpuMaterial, NORMAL_TEXTURE, OCCLUSION_TEXTURE, THICKNESS_TEXTURE,
};
use crate::part::Geometry;
use crate::state;
use crate::texture::{TextureUse, upload};
use crate::{Image, ImageSizeError};
use avatar_groom::Groom;
use avatar_look::Material;
use avatar_mesh::{Bounds, Mesh, PartKind};
use wgpu::util::DeviceExt;

/// A part to be drawn.
#[derive(Clone, Copy, Debug)]
pub struct PartDesc<'a> {
    /// Name in graphics debuggers and messages.
    pub label: &'a str,
    /// The undeformed mesh. Its k-th shape follows the avatar's weight number `first_weight + k`.
    pub mesh: &'a Mesh,
    /// The weight that the first shape of the mesh follows: 0 where all parts share their shapes, else where the part's own
    /// begin in the list of all.
    pub first_weight: usize,
    /// How it is drawn.
    pub kind: PartKind,
    /// What moves it.
    pub bones: PartBones,
    /// Its pictures.
    pub textures: PartTextures<'a>,
}

/// What moves a part.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PartBones {
    /// Every vertex names up to four bones of the palette ([`avatar_mesh::Skinning`]).
    PerVertex,
    /// The whole part follows the bone at this position in the palette.
    Rigid(usize),
}

/// The pictures of a part; each may have its own size. `None` leaves the visible default of the kind.
#[derive(Clone, Copy, Debug, Default)]
pub struct PartTextures<'a> {
    /// Colour in sRGB; where it is transparent, the material's own colour shows.
    pub color: Option<&'a Image>,
    /// Share of the ambient light that arrives: the red channel, linear.
    pub occlusion: Option<&'a Image>,
    /// 0 matte, 1 glossy: the red channel, linear.
    pub gloss: Option<&'a Image>,
    /// Normals in tangent space, green up, linear.
    pub normal: Option<&'a Image>,
    /// How thick the part is behind each point, black thin, white as thick as the material says: the red channel, linear.
    pub thickness: Option<&'a Image>,
}

/// Why a model could not be built.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ModelError {
    /// Something is wrong with a part.
    #[error("part {label:?}: {problem}")]
    Part {
        /// The part's label.
        label: String,
        /// What is wrong.
        problem: PartProblem,
    },
    /// More bones than a binding holds.
    #[error("expected at most {limit} bones, found {found}")]
    PaletteTooLarge {
        /// Number of bones.
        found: usize,
        /// What the device allows.
        limit: u64,
    },
}

/// What is wrong with a part.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum PartProblem {
    /// An array that is not as long as the mesh has vertices.
    #[error("expected {expected} {what}, found {found}")]
    Count {
        /// Which array.
        what: &'static str,
        /// Number of vertices.
        expected: usize,
        /// Its length.
        found: usize,
    },
    /// A triangle names a vertex that is not there.
    #[error("triangle {triangle}: expected a vertex below {vertices}, found {found}")]
    Index {
        /// The triangle.
        triangle: usize,
        /// The index.
        found: u32,
        /// Number of vertices.
        vertices: usize,
    },
    /// A part with bones per vertex whose mesh has none.
    #[error("expected bones per vertex, found none in the mesh")]
    NoVertexBones,
    /// A vertex names a bone that is not there.
    #[error("vertex {vertex}: expected a bone below {palette_len}, found {found}")]
    VertexBone {
        /// The vertex.
        vertex: usize,
        /// Its bone.
        found: usize,
        /// Length of the palette.
        palette_len: usize,
    },
    /// A rigid part follows a bone that is not there.
    #[error("expected a bone below {palette_len}, found {found}")]
    RigidBone {
        /// The bone.
        found: usize,
        /// Length of the palette.
        palette_len: usize,
    },
    /// More data than a binding of the device holds.
    #[error("expected at most {limit} bytes of {what}, found {bytes} ({count} elements)")]
    TooLarge {
        /// What is too large.
        what: &'static str,
        /// Number of elements.
        count: usize,
        /// Their size.
        bytes: u64,
        /// What the device allows.
        limit: u64,
    },
    /// A picture whose bytes do not fit its size.
    #[error("{which} texture: {error}")]
    Texture {
        /// Which of the part's pictures.
        which: &'static str,
        /// Both numbers.
        error: ImageSizeError,
    },
}

/// A part that a model does not have.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("expected a part below {parts}, found {found}")]
pub struct NoSuchPart {
    /// Number of parts.
    pub parts: usize,
    /// The part that was asked for, from 0.
    pub found: usize,
}

/// What many avatars share: vertices, triangles, shapes, textures and materials.
#[derive(Debug)]
pub struct AvatarModel {
    pub(crate) parts: Vec<ModelPart>,
    palette_len: usize,
    shape_count: usize,
    /// Height of the skin at bind pose: what materials are measured by, and softness of shadows and reach of occlusion where
    /// this avatar looks largest.
    pub(crate) height: f32,
    pub(crate) hair: Option<HairModel>,
}

/// A part on the GPU.
#[derive(Debug)]
pub(crate) struct ModelPart {
    pub(crate) label: String,
    pub(crate) kind: PartKind,
    pub(crate) geometry: Geometry,
    pub(crate) look: wgpu::BindGroup,
    material: wgpu::Buffer,
    textures: u32,
    eye: Option<EyeShape>,
}

impl AvatarModel {
    /// Uploads parts whose bones are positions in a palette of `palette_len` matrices. Needs no renderer: a model can be
    /// drawn by any renderer of the device, and deformed without one.
    ///
    /// # Errors
    /// A mesh that contradicts itself or the palette, a picture with the wrong number of bytes, or more data than the
    /// device binds. A picture that is only too large is halved until it fits.
    pub fn new(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        parts: &[PartDesc<'_>],
        palette_len: usize,
    ) -> Result<Self, ModelError> {
        let limit = device.limits().max_storage_buffer_binding_size / size_of::<state::GpuBone>() as u64;
        if palette_len as u64 > limit {
            return Err(ModelError::PaletteTooLarge { found: palette_len, limit });
        }
        let geometry_layout = Geometry::layout(device);
        let look_layout = look_layout(device);
        let height = height(parts);
        let upload_part = |desc: &PartDesc<'_>| {
            let geometry = Geometry::new(device, &geometry_layout, desc, palette_len)?;
            let eye = cornea_of(desc, parts).and_then(|cornea| eye_shape(cornea.mesh, desc.mesh));
            ModelPart::new(device, queue, &look_layout, desc, geometry, eye, height)
        };
        let last_shapes = parts.iter().filter(|desc| !desc.mesh.shapes.is_empty());
        let shape_count = last_shapes
            .map(|desc| desc.first_weight.saturating_add(desc.mesh.shapes.len()))
            .max()
            .unwrap_or(0);
        let parts: Result<Vec<_>, _> = parts
            .iter()
            .map(|desc| {
                upload_part(desc)
                    .map_err(|problem| ModelError::Part { label: desc.label.to_owned(), problem })
            })
            .collect();
        Ok(Self { parts: parts?, palette_len, shape_count, height, hair: None })
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

    /// The parts of a kind that have triangles, with their places.
    pub(crate) fn parts_of(&self, kind: PartKind) -> impl Iterator<Item = (usize, &ModelPart)> {
        let seen = move |part: &ModelPart| part.kind == kind && part.geometry.index_count > 0;
        self.parts.iter().enumerate().filter(move |(_, part)| seen(part))
    }

    /// Plants hair on a part, or takes it away: `groom` was made from the part's mesh. States that were made
    /// before have no room for it; make them anew.
    ///
    /// # Errors
    /// No such part, roots that do not belong to it, or more strands than the device binds; nothing changes then.
    pub fn set_hair(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        part: usize,
        groom: Option<&Groom>,
    ) -> Result<(), HairError> {
        let missing = HairError::NoSuchPart { parts: self.parts.len(), found: part };
        let vertices = self.parts.get(part).ok_or(missing)?.geometry.vertex_count;
        let hair = groom
            .map(|groom| HairModel::new(device, queue, part, vertices, self.palette_len as u32, groom))
            .transpose()?;
        self.hair = hair.filter(|hair| hair.strand_count > 0);
        Ok(())
    }

    /// Number of strands.
    pub fn strand_count(&self) -> usize {
        self.hair.as_ref().map_or(0, |hair| hair.strand_count as usize)
    }

    /// Replaces the looks of a part in all avatars of this model, from the next submission on. `part` is its place among
    /// the parts that the model was made of.
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
        let gpu = GpuMaterial::new(material, &part.geometry, part.eye.as_ref(), self.height, part.textures);
        queue.write_buffer(&part.material, 0, bytemuck::bytes_of(&gpu));
        Ok(())
    }
}

/// The cornea that moves with an eyeball.
fn cornea_of<'a, 'b>(ball: &PartDesc<'b>, parts: &'a [PartDesc<'b>]) -> Option<&'a PartDesc<'b>> {
    let is_its_cornea = |part: &&PartDesc<'_>| part.kind == PartKind::Cornea && part.bones == ball.bones;
    let center = ball.mesh.bounds()?.center();
    let distance = |part: &PartDesc<'_>| {
        part.mesh.bounds().map_or(f32::INFINITY, |bounds| bounds.center().distance(center))
    };
    match (ball.kind, ball.bones) {
        // The view is turned back to bind pose by one bone: eyes with bones per vertex are drawn as they are.
        (PartKind::Eyeball, PartBones::Rigid(_)) => {
            parts.iter().filter(is_its_cornea).min_by(|a, b| distance(a).total_cmp(&distance(b)))
        }
        _ => None,
    }
}

/// The height of the skin, or of everything where there is no skin; never 0.
fn height(parts: &[PartDesc<'_>]) -> f32 {
    let bounds = |skin_only: bool| {
        parts
            .iter()
            .filter(|part| !skin_only || part.kind == PartKind::Skin)
            .filter_map(|part| part.mesh.bounds())
            .reduce(Bounds::union)
    };
    let height = bounds(true).or_else(|| bounds(false)).map_or(0.0, |bounds| bounds.size().y);
    if height > 0.0 { height } else { 1.0 }
}

/// Layout of group 2, the looks of a part.
pub(crate) fn look_layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    let entry = |binding, ty| wgpu::BindGroupLayoutEntry {
        binding,
        visibility: match binding {
            0 => wgpu::ShaderStages::VERTEX_FRAGMENT,
            _ => wgpu::ShaderStages::FRAGMENT,
        },
        ty,
        count: None,
    };
    let uniform = wgpu::BindingType::Buffer {
        ty: wgpu::BufferBindingType::Uniform,
        has_dynamic_offset: false,
        min_binding_size: None,
    };
    let texture = wgpu::BindingType::Texture {
        sample_type: wgpu::TextureSampleType::Float { filterable: true },
        view_dimension: wgpu::TextureViewDimension::D2,
        multisampled: false,
    };
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("part looks"),
        entries: &[
            entry(0, uniform),
            entry(1, texture),
            entry(2, texture),
            entry(3, texture),
            entry(4, texture),
            entry(5, texture),
        ],
    })
}

impl ModelPart {
    fn new(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        layout: &wgpu::BindGroupLayout,
        desc: &PartDesc<'_>,
        geometry: Geometry,
        eye: Option<EyeShape>,
        height: f32,
    ) -> Result<Self, PartProblem> {
        let label = desc.label;
        // Bound where there is no texture, and never sampled there.
        let blank = Image { width: 1, height: 1, rgba: vec![255; 4] };
        let mut textures = 0;
        let mut view = |bit: u32, which: &'static str, image: Option<&Image>, usage: TextureUse| {
            textures |= if image.is_some() { bit } else { 0 };
            let label = format!("{label}: {which}");
            upload(device, queue, &label, image.unwrap_or(&blank), usage)
                .map_err(|error| PartProblem::Texture { which, error })
        };
        let views = [
            view(COLOR_TEXTURE, "color", desc.textures.color, TextureUse::Color)?,
            view(OCCLUSION_TEXTURE, "occlusion", desc.textures.occlusion, TextureUse::Value)?,
            view(GLOSS_TEXTURE, "gloss", desc.textures.gloss, TextureUse::Value)?,
            view(NORMAL_TEXTURE, "normal", desc.textures.normal, TextureUse::Normal)?,
            view(THICKNESS_TEXTURE, "thickness", desc.textures.thickness, TextureUse::Value)?,
        ];
        let gpu_material =
            GpuMaterial::new(&Material::of(desc.kind), &geometry, eye.as_ref(), height, textures);
        let material = device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: Some(&format!("{label}: material")),
            contents: bytemuck::bytes_of(&gpu_material),
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
        });
        let texture = |binding: u32, view| wgpu::BindGroupEntry {
            binding,
            resource: wgpu::BindingResource::TextureView(view),
        };
        let look = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some(&format!("{label}: looks")),
            layout,
            entries: &[
                wgpu::BindGroupEntry { binding: 0, resource: material.as_entire_binding() },
                texture(1, &views[0]),
                texture(2, &views[1]),
                texture(3, &views[2]),
                texture(4, &views[3]),
                texture(5, &views[4]),
            ],
        });
        Ok(Self { label: label.to_owned(), kind: desc.kind, geometry, look, material, textures, eye })
    }
}
