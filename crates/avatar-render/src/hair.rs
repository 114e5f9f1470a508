//! Hair on the GPU: strands grow on the deformed skin every frame, and are drawn from where they grew.

use crate::deformer::GpuDeformedVertex;
use crate::state::GpuBone;
use crate::swing::{GpuMote, SwingState};
use crate::vec4_texture::Vec4Texture;
use avatar_groom::offset_from_head;
use avatar_groom::{
    COMBED_REACH, Field, Groom, LOCK_REACH, MARGIN, NO_GUIDE, OTHER_BONES, RegionStyle, SEGMENTS,
};
use bytemuck::{Pod, Zeroable};
use glam::Affine3A;
use std::sync::atomic::{AtomicU64, Ordering};
use wgpu::util::DeviceExt;

/// Strands per workgroup.
pub(crate) const GROW_WORKGROUP_SIZE: u32 = 64;
/// The number of a guide's own guide: it has none, and no curls.
pub(crate) const IS_GUIDE: u32 = NO_GUIDE - 1;
/// Scalp, brows, lashes.
pub(crate) const REGION_COUNT: usize = 3;
/// Elements per strand in the buffer of points: the points, and the normal at the root.
pub(crate) const POINT_STRIDE: usize = SEGMENTS + 2;
/// Strands over a square of the skin's height that styles give their radii for; fewer are wider in proportion.
const REFERENCE_STRANDS: f32 = 100_000.0;
const WIDEST: f32 = 5.0;
const VEC4S_PER_VERTEX: usize = size_of::<GpuDeformedVertex>() / size_of::<[f32; 4]>();

/// WGSL `HairRegion`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct GpuHairRegion {
    pub(crate) root_color: [f32; 3],
    pub(crate) root_radius: f32,
    pub(crate) tip_color: [f32; 3],
    pub(crate) tip_radius: f32,
    pub(crate) color_variation: f32,
    pub(crate) bend: f32,
    pub(crate) gravity: f32,
    pub(crate) curl_radius: f32,
    pub(crate) curl_turn: [f32; 2],
    pub(crate) clump: f32,
    pub(crate) noise: f32,
    pub(crate) volume: f32,
    pub(crate) hold: f32,
    pub(crate) pad: [f32; 2],
}

/// WGSL `Hair`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct GpuHair {
    pub(crate) regions: [GpuHairRegion; REGION_COUNT],
    pub(crate) field_origin: [f32; 3],
    pub(crate) field_cell: f32,
    pub(crate) field_size: [u32; 3],
    pub(crate) margin: f32,
    pub(crate) per_combed_reach: f32,
    pub(crate) per_lock_reach: f32,
    pub(crate) strand_count: u32,
    pub(crate) width_factor: f32,
    pub(crate) field_range: f32,
    pub(crate) field_cells: f32,
    pub(crate) pad: [f32; 2],
}

/// WGSL `HairPose`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct GpuHairPose {
    pub(crate) head: GpuBone,
    pub(crate) others: [GpuBone; OTHER_BONES],
}

/// A root as four texels; WGSL `Root` has the same fields in the same order.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct GpuRoot {
    pub(crate) corners: [u32; 3],
    pub(crate) region: u32,
    pub(crate) barycentric: [f32; 3],
    pub(crate) guide: u32,
    pub(crate) comb: [f32; 3],
    pub(crate) length: f32,
    pub(crate) random: [f32; 3],
    pub(crate) phase: f32,
}

/// Why a head can have no such hair.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum HairError {
    /// The model has no such part.
    #[error("expected a part below {parts}, found {found}")]
    NoSuchPart {
        /// Number of parts.
        parts: usize,
        /// The part.
        found: usize,
    },
    /// A root on a vertex that the part does not have.
    #[error("strand {strand}: expected a vertex below {vertices}, found {found}")]
    Corner {
        /// The strand.
        strand: usize,
        /// The vertex.
        found: u32,
        /// Number of vertices of the part.
        vertices: u32,
    },
    /// A groom whose lists have different lengths.
    #[error(
        "strand {strand}: expected a comb, a length, a phase and a guide, found fewer of them than roots"
    )]
    Incomplete {
        /// The strand.
        strand: usize,
    },
    /// A guide that is no strand.
    #[error("expected guides below {strands}, found {found}")]
    Guide {
        /// The guide.
        found: u32,
        /// Number of strands.
        strands: usize,
    },
    /// More guides than a binding of the device holds.
    #[error("expected at most {limit} guides, found {found}")]
    TooManyGuides {
        /// Number of guides.
        found: usize,
        /// What the device allows.
        limit: usize,
    },
    /// Hair that moves with a bone that the model does not have.
    #[error("expected a bone below {bones}, found {found}")]
    Bone {
        /// The bone.
        found: u32,
        /// Number of bones of the model.
        bones: u32,
    },
    /// A field of distances that does not fill its grid.
    #[error("expected distances for a grid of {} × {} × {}, found {found}", expected[0], expected[1], expected[2])]
    Field {
        /// Size of the grid.
        expected: [u32; 3],
        /// Number of distances.
        found: usize,
    },
    /// A field that is larger than a texture of the device.
    #[error("expected at most {limit} places along each side of the field, found {} × {} × {}", found[0], found[1], found[2])]
    FieldSize {
        /// Size of the grid.
        found: [u32; 3],
        /// What the device allows.
        limit: u32,
    },
    /// A skin that is larger than a texture of the device.
    #[error("expected at most {limit} vertices of the part, found {found}")]
    SkinSize {
        /// Number of vertices.
        found: u32,
        /// What the device allows.
        limit: usize,
    },
    /// More strands than a binding of the device holds.
    #[error("expected at most {limit} strands, found {found}")]
    TooMany {
        /// Number of strands.
        found: usize,
        /// What the device allows.
        limit: usize,
    },
}

/// The hair that all avatars of a model share.
#[derive(Debug)]
pub(crate) struct HairModel {
    /// Tells hair apart that other hair was planted in the place of.
    pub(crate) id: u64,
    /// The part that it grows on.
    pub(crate) part: usize,
    pub(crate) strand_count: u32,
    pub(crate) guide_count: u32,
    /// Swings a second of the tips of guides.
    swing: f32,
    hair: wgpu::Buffer,
    roots: Vec4Texture,
    /// The roots of the guides once more, without guides of their own.
    guide_roots: Vec4Texture,
    field: wgpu::TextureView,
    head_bone: u32,
    other_bones: [u32; OTHER_BONES],
}

/// The hair of one avatar.
#[derive(Debug)]
pub(crate) struct HairState {
    /// That of the model's hair.
    pub(crate) id: u64,
    pub(crate) points: wgpu::Buffer,
    pub(crate) guide_count: u32,
    /// How guides swing; still until time passes.
    pub(crate) swing: SwingState,
    /// Group 0 of the growing pass: of guides, and of all strands.
    pub(crate) grow_guides: wgpu::BindGroup,
    pub(crate) grow: wgpu::BindGroup,
    /// Group 2 of the growing pass: the deformed skin, and the bones that hair moves with.
    pub(crate) skin: wgpu::BindGroup,
    /// What the guides' growth writes, how far they swing from there, the deformed skin; and where strands read that.
    guides: (wgpu::Buffer, Vec4Texture),
    offsets: Vec4Texture,
    vertices: (wgpu::Buffer, Vec4Texture),
    pose: wgpu::Buffer,
    head_bone: u32,
    other_bones: [u32; OTHER_BONES],
    /// Group 2 of the drawing.
    pub(crate) draw: wgpu::BindGroup,
}

impl HairModel {
    pub(crate) fn new(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        part: usize,
        vertices: u32,
        bones: u32,
        groom: &Groom,
    ) -> Result<Self, HairError> {
        let limits = device.limits();
        let binding = limits.max_storage_buffer_binding_size.min(limits.max_buffer_size);
        let per_strand = (POINT_STRIDE * size_of::<[f32; 4]>()) as u64;
        let groups = limits.max_compute_workgroups_per_dimension as usize * GROW_WORKGROUP_SIZE as usize;
        let most_roots = Vec4Texture::most(&limits) / (size_of::<GpuRoot>() / size_of::<[f32; 4]>());
        let limit = ((binding / per_strand) as usize).min(groups).min(most_roots);
        let found = groom.roots.len();
        if found > limit {
            return Err(HairError::TooMany { found, limit });
        }
        let mut roots = Vec::with_capacity(found);
        for (strand, root) in groom.roots.iter().enumerate() {
            if let Some(&found) = root.corners.iter().find(|corner| **corner >= vertices) {
                return Err(HairError::Corner { strand, found, vertices });
            }
            roots.push(gpu_root(groom, strand).ok_or(HairError::Incomplete { strand })?);
        }
        if let Some(&found) = groom.guides.iter().find(|guide| **guide as usize >= groom.roots.len()) {
            return Err(HairError::Guide { found, strands: groom.roots.len() });
        }
        let most_guides = (binding / (POINT_STRIDE * size_of::<GpuMote>()) as u64) as usize;
        if groom.guides.len() > most_guides {
            return Err(HairError::TooManyGuides { found: groom.guides.len(), limit: most_guides });
        }
        let guide_root =
            |strand: &u32| roots.get(*strand as usize).map(|root| GpuRoot { guide: IS_GUIDE, ..*root });
        let mut guide_roots: Vec<GpuRoot> = groom.guides.iter().filter_map(guide_root).collect();
        let (strand_count, guide_count) = (roots.len() as u32, guide_roots.len() as u32);
        // WebGPU binds no empty buffers.
        for roots in [&mut roots, &mut guide_roots].into_iter().filter(|roots| roots.is_empty()) {
            roots.push(GpuRoot::zeroed());
        }
        let field = &groom.field;
        let places = field.size.iter().map(|n| u64::from(*n)).product::<u64>();
        let known = field.distances.len().min(field.shares.len()).min(field.slopes.len());
        if field.size.iter().any(|n| *n < 2) || known as u64 != places {
            return Err(HairError::Field { expected: field.size, found: known });
        }
        if let Some(&found) = field.bones.iter().chain([&groom.head_bone]).find(|bone| **bone >= bones) {
            return Err(HairError::Bone { found, bones });
        }
        if field.size.iter().any(|n| *n > limits.max_texture_dimension_3d) {
            return Err(HairError::FieldSize { found: field.size, limit: limits.max_texture_dimension_3d });
        }
        if guide_roots.len() > Vec4Texture::most(&limits) / POINT_STRIDE {
            return Err(HairError::TooMany { found, limit: Vec4Texture::most(&limits) / POINT_STRIDE });
        }
        let most = Vec4Texture::most(&limits) / VEC4S_PER_VERTEX;
        if vertices as usize > most {
            return Err(HairError::SkinSize { found: vertices, limit: most });
        }
        let region = |style: &RegionStyle| GpuHairRegion::new(style, groom.height);
        let hair = GpuHair {
            regions: [region(&groom.style.scalp), region(&groom.style.brows), region(&groom.style.lashes)],
            field_origin: field.origin.to_array(),
            field_cell: field.cell,
            field_size: field.size,
            margin: MARGIN * groom.height,
            per_combed_reach: 1.0 / (COMBED_REACH * groom.height),
            per_lock_reach: 1.0 / (LOCK_REACH * groom.height),
            strand_count,
            width_factor: (REFERENCE_STRANDS / groom.strands.max(1.0)).clamp(0.5, WIDEST),
            field_range: field.range(),
            field_cells: 1.0 / field.cell,
            pad: [0.0; 2],
        };
        let list =
            |label, roots: &[GpuRoot]| Vec4Texture::with(device, queue, label, bytemuck::cast_slice(roots));
        static NEXT: AtomicU64 = AtomicU64::new(0);
        Ok(Self {
            id: NEXT.fetch_add(1, Ordering::Relaxed),
            part,
            strand_count,
            guide_count,
            swing: groom.style.scalp.swing,
            hair: device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
                label: Some("hair"),
                contents: bytemuck::bytes_of(&hair),
                usage: wgpu::BufferUsages::UNIFORM,
            }),
            roots: list("hair: roots", &roots),
            guide_roots: list("hair: roots of guides", &guide_roots),
            field: field_texture(device, queue, field),
            head_bone: groom.head_bone,
            other_bones: field.bones,
        })
    }
}

fn field_texture(device: &wgpu::Device, queue: &wgpu::Queue, field: &Field) -> wgpu::TextureView {
    let [width, height, depth_or_array_layers] = field.size;
    let label = Some("hair: distances from the skin");
    let descriptor = wgpu::TextureDescriptor {
        label,
        size: wgpu::Extent3d { width, height, depth_or_array_layers },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D3,
        format: wgpu::TextureFormat::Rg32Uint,
        usage: wgpu::TextureUsages::TEXTURE_BINDING,
        view_formats: &[],
    };
    let texels = field.texels();
    let order = wgpu::util::TextureDataOrder::LayerMajor;
    let texture = device.create_texture_with_data(queue, &descriptor, order, bytemuck::cast_slice(&texels));
    texture.create_view(&wgpu::TextureViewDescriptor { label, ..Default::default() })
}

fn gpu_root(groom: &Groom, strand: usize) -> Option<GpuRoot> {
    let root = groom.roots.get(strand)?;
    let [x, y, z, _] = root.random;
    let guide = *groom.guide_of.get(strand)?;
    Some(GpuRoot {
        corners: root.corners,
        region: root.region as u32,
        barycentric: root.barycentric,
        // A guide that does not exist leads nobody.
        guide: if (guide as usize) < groom.guides.len() { guide } else { NO_GUIDE },
        comb: groom.combs.get(strand)?.to_array(),
        length: *groom.lengths.get(strand)?,
        random: [x, y, z],
        phase: *groom.phases.get(strand)?,
    })
}

impl GpuHairRegion {
    fn new(style: &RegionStyle, height: f32) -> Self {
        Self {
            root_color: style.root_color,
            root_radius: style.root_radius * height,
            tip_color: style.tip_color,
            tip_radius: style.tip_radius * height,
            color_variation: style.color_variation,
            bend: style.bend,
            gravity: style.gravity,
            curl_radius: style.curl_radius * height,
            curl_turn: style.curl_turn().to_array(),
            clump: style.clump,
            noise: style.noise,
            volume: style.volume * height,
            hold: style.hold,
            pad: [0.0; 2],
        }
    }
}

pub(crate) fn storage_entry(
    binding: u32,
    visibility: wgpu::ShaderStages,
    read_only: bool,
) -> wgpu::BindGroupLayoutEntry {
    wgpu::BindGroupLayoutEntry {
        binding,
        visibility,
        ty: wgpu::BindingType::Buffer {
            ty: wgpu::BufferBindingType::Storage { read_only },
            has_dynamic_offset: false,
            min_binding_size: None,
        },
        count: None,
    }
}

pub(crate) fn uniform_entry(binding: u32, visibility: wgpu::ShaderStages) -> wgpu::BindGroupLayoutEntry {
    wgpu::BindGroupLayoutEntry {
        binding,
        visibility,
        ty: wgpu::BindingType::Buffer {
            ty: wgpu::BufferBindingType::Uniform,
            has_dynamic_offset: false,
            min_binding_size: None,
        },
        count: None,
    }
}

fn texture_entry(
    binding: u32,
    visibility: wgpu::ShaderStages,
    sample_type: wgpu::TextureSampleType,
    view_dimension: wgpu::TextureViewDimension,
) -> wgpu::BindGroupLayoutEntry {
    wgpu::BindGroupLayoutEntry {
        binding,
        visibility,
        ty: wgpu::BindingType::Texture { sample_type, view_dimension, multisampled: false },
        count: None,
    }
}

/// Layouts of the growing pass: group 0 hair, group 2 the deformed skin.
pub(crate) fn grow_layouts(device: &wgpu::Device) -> [wgpu::BindGroupLayout; 2] {
    let compute = wgpu::ShaderStages::COMPUTE;
    let float = wgpu::TextureSampleType::Float { filterable: false };
    let flat = wgpu::TextureViewDimension::D2;
    [
        device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("grow hair"),
            entries: &[
                uniform_entry(0, compute),
                texture_entry(1, compute, wgpu::TextureSampleType::Uint, flat),
                texture_entry(2, compute, wgpu::TextureSampleType::Uint, wgpu::TextureViewDimension::D3),
                storage_entry(3, compute, false),
                texture_entry(4, compute, float, flat),
                texture_entry(5, compute, float, flat),
            ],
        }),
        device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("deformed skin"),
            entries: &[texture_entry(0, compute, float, flat), uniform_entry(1, compute)],
        }),
    ]
}

/// Layout of group 2 of the drawing.
pub(crate) fn draw_layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    let vertex = wgpu::ShaderStages::VERTEX;
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("draw hair"),
        entries: &[
            uniform_entry(0, wgpu::ShaderStages::VERTEX_FRAGMENT),
            texture_entry(1, vertex, wgpu::TextureSampleType::Uint, wgpu::TextureViewDimension::D2),
            storage_entry(2, vertex, true),
        ],
    })
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
            // Guides follow no guides: they do not read what is bound for the strands.
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
        }
    }

    /// Records the copy of the deformed skin to where growth reads it.
    pub(crate) fn take_skin(&self, encoder: &mut wgpu::CommandEncoder) {
        let (vertices, texture) = &self.vertices;
        texture.fill(encoder, vertices);
    }

    /// Records the copy of the guides to where strands read them.
    pub(crate) fn take_guides(&self, encoder: &mut wgpu::CommandEncoder) {
        let (guides, texture) = &self.guides;
        texture.fill(encoder, guides);
        if self.swing.is_moving() {
            self.offsets.fill(encoder, &self.swing.offsets);
        }
    }

    /// Takes over the bones of a pose.
    pub(crate) fn set_pose(&self, queue: &wgpu::Queue, bones: &[Affine3A]) {
        let Some(head) = bones.get(self.head_bone as usize) else { return };
        let others = self.other_bones.map(|bone| bones.get(bone as usize).copied().unwrap_or(*head));
        queue.write_buffer(&self.pose, 0, bytemuck::bytes_of(&GpuHairPose::new(*head, others)));
    }
}

impl GpuHairPose {
    fn new(head: Affine3A, others: [Affine3A; OTHER_BONES]) -> Self {
        let others = others.map(|other| GpuBone::new(&offset_from_head(head, other)));
        Self { head: GpuBone::new(&head), others }
    }
}
