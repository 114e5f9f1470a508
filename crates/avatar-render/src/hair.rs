//! Hair on the GPU: strands grow on the deformed skin every frame, and are drawn from where they grew.

use crate::deformer::GpuDeformedVertex;
use avatar_groom::{Groom, MARGIN, RegionStyle, SEGMENTS, TUFT_TRIANGLES};
use avatar_mesh::Mesh;
use bytemuck::{Pod, Zeroable};
use wgpu::util::DeviceExt;

/// Strands per workgroup.
pub(crate) const GROW_WORKGROUP_SIZE: u32 = 64;
/// Scalp, brows, lashes.
pub(crate) const REGION_COUNT: usize = 3;
/// Elements per strand in the buffer of points: the points, and the normal at the root.
pub(crate) const POINT_STRIDE: usize = SEGMENTS + 2;
/// The number of strands that styles give their radii for; fewer are wider in proportion.
const REFERENCE_STRANDS: f32 = 100_000.0;
const WIDEST: f32 = 5.0;

/// WGSL `HairRegion`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct GpuHairRegion {
    pub(crate) root_color: [f32; 3],
    pub(crate) length: f32,
    pub(crate) tip_color: [f32; 3],
    pub(crate) length_variation: f32,
    pub(crate) root_radius: f32,
    pub(crate) tip_radius: f32,
    pub(crate) color_variation: f32,
    pub(crate) bend: f32,
    pub(crate) gravity: f32,
    pub(crate) curl_radius: f32,
    pub(crate) curl_turns: f32,
    pub(crate) clump: f32,
    pub(crate) noise: f32,
    pub(crate) pad: [f32; 3],
}

/// WGSL `Hair`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct GpuHair {
    pub(crate) regions: [GpuHairRegion; REGION_COUNT],
    pub(crate) hull_center: [f32; 3],
    pub(crate) margin: f32,
    pub(crate) head_bone: u32,
    pub(crate) strand_count: u32,
    pub(crate) width_factor: f32,
    pub(crate) pad: f32,
}

/// WGSL `Root`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct GpuRoot {
    pub(crate) corners: [u32; 3],
    pub(crate) region: u32,
    pub(crate) barycentric: [f32; 3],
    pub(crate) tuft: u32,
    pub(crate) random: [f32; 4],
    pub(crate) comb: [f32; 3],
    pub(crate) pad: f32,
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
    /// The part that it grows on.
    pub(crate) part: usize,
    pub(crate) strand_count: u32,
    hair: wgpu::Buffer,
    roots: wgpu::Buffer,
    hull: wgpu::Buffer,
}

/// The hair of one avatar.
#[derive(Debug)]
pub(crate) struct HairState {
    pub(crate) points: wgpu::Buffer,
    /// Group 0 of the growing pass, and group 2: the deformed skin.
    pub(crate) grow: [wgpu::BindGroup; 2],
    /// Group 2 of the drawing.
    pub(crate) draw: wgpu::BindGroup,
}

impl HairModel {
    pub(crate) fn new(
        device: &wgpu::Device,
        part: usize,
        vertices: u32,
        skin: &Mesh,
        groom: &Groom,
    ) -> Result<Self, HairError> {
        let limits = device.limits();
        let binding = limits.max_storage_buffer_binding_size.min(limits.max_buffer_size);
        let per_strand = (POINT_STRIDE * size_of::<[f32; 4]>()).max(size_of::<GpuRoot>()) as u64;
        let groups = limits.max_compute_workgroups_per_dimension as usize * GROW_WORKGROUP_SIZE as usize;
        let limit = ((binding / per_strand) as usize).min(groups);
        let found = groom.roots.len();
        if found > limit {
            return Err(HairError::TooMany { found, limit });
        }
        let mut roots = Vec::with_capacity(found);
        for (strand, (root, comb)) in groom.roots.iter().zip(&groom.combs).enumerate() {
            if let Some(&found) = root.corners.iter().find(|corner| **corner >= vertices) {
                return Err(HairError::Corner { strand, found, vertices });
            }
            roots.push(GpuRoot {
                corners: root.corners,
                region: root.region as u32,
                barycentric: root.barycentric,
                tuft: root.triangle / TUFT_TRIANGLES,
                random: root.random,
                comb: comb.to_array(),
                pad: 0.0,
            });
        }
        let strand_count = roots.len() as u32;
        if roots.is_empty() {
            // WebGPU binds no empty buffers.
            roots.push(GpuRoot::zeroed());
        }
        let region = |style: &RegionStyle| GpuHairRegion::new(style, groom.height);
        let hair = GpuHair {
            regions: [region(&groom.style.scalp), region(&groom.style.brows), region(&groom.style.lashes)],
            hull_center: groom.hull.center.to_array(),
            margin: MARGIN * groom.height,
            head_bone: head_bone(skin, groom),
            strand_count,
            width_factor: (REFERENCE_STRANDS / strand_count.max(1) as f32).clamp(0.5, WIDEST),
            pad: 0.0,
        };
        let buffer = |label, contents: &[u8], usage| {
            device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
                label: Some(label),
                contents,
                usage,
            })
        };
        let storage = wgpu::BufferUsages::STORAGE;
        Ok(Self {
            part,
            strand_count,
            hair: buffer("hair", bytemuck::bytes_of(&hair), wgpu::BufferUsages::UNIFORM),
            roots: buffer("hair: roots", bytemuck::cast_slice(&roots), storage),
            hull: buffer("hair: hull", bytemuck::cast_slice(&groom.hull.radii), storage),
        })
    }
}

impl GpuHairRegion {
    fn new(style: &RegionStyle, height: f32) -> Self {
        Self {
            root_color: style.root_color,
            length: style.length * height,
            tip_color: style.tip_color,
            length_variation: style.length_variation,
            root_radius: style.root_radius * height,
            tip_radius: style.tip_radius * height,
            color_variation: style.color_variation,
            bend: style.bend,
            gravity: style.gravity,
            curl_radius: style.curl_radius * height,
            curl_turns: style.curl_turns,
            clump: style.clump,
            noise: style.noise,
            pad: [0.0; 3],
        }
    }
}

/// The bone that moves most of the hair.
fn head_bone(skin: &Mesh, groom: &Groom) -> u32 {
    let Some(skinning) = &skin.skinning else { return 0 };
    let mut weights: Vec<f32> = Vec::new();
    for root in &groom.roots {
        let vertex = root.corners[0] as usize;
        let Some((bones, shares)) = skinning.bones.get(vertex).zip(skinning.weights.get(vertex)) else {
            continue;
        };
        for (bone, share) in bones.iter().zip(shares) {
            let bone = usize::from(*bone);
            if weights.len() <= bone {
                weights.resize(bone + 1, 0.0);
            }
            weights[bone] += share;
        }
    }
    let most = weights.iter().enumerate().max_by(|(_, a), (_, b)| a.total_cmp(b));
    most.map_or(0, |(bone, _)| bone as u32)
}

fn storage_entry(
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

fn uniform_entry(visibility: wgpu::ShaderStages) -> wgpu::BindGroupLayoutEntry {
    wgpu::BindGroupLayoutEntry {
        binding: 0,
        visibility,
        ty: wgpu::BindingType::Buffer {
            ty: wgpu::BufferBindingType::Uniform,
            has_dynamic_offset: false,
            min_binding_size: None,
        },
        count: None,
    }
}

/// Layouts of the growing pass: group 0 hair, group 2 the deformed skin.
pub(crate) fn grow_layouts(device: &wgpu::Device) -> [wgpu::BindGroupLayout; 2] {
    let compute = wgpu::ShaderStages::COMPUTE;
    [
        device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("grow hair"),
            entries: &[
                uniform_entry(compute),
                storage_entry(1, compute, true),
                storage_entry(2, compute, true),
                storage_entry(3, compute, false),
            ],
        }),
        device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("deformed skin"),
            entries: &[storage_entry(0, compute, true)],
        }),
    ]
}

/// Layout of group 2 of the drawing.
pub(crate) fn draw_layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    let vertex = wgpu::ShaderStages::VERTEX;
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("draw hair"),
        entries: &[
            uniform_entry(wgpu::ShaderStages::VERTEX_FRAGMENT),
            storage_entry(1, vertex, true),
            storage_entry(2, vertex, true),
        ],
    })
}

impl HairState {
    pub(crate) fn new(device: &wgpu::Device, hair: &HairModel, skin: &wgpu::Buffer) -> Self {
        let strands = u64::from(hair.strand_count.max(1));
        let points = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("hair: points"),
            size: strands * (POINT_STRIDE * size_of::<[f32; 4]>()) as u64,
            usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC,
            mapped_at_creation: false,
        });
        let [grow_layout, skin_layout] = grow_layouts(device);
        let group = |label, layout: &wgpu::BindGroupLayout, buffers: &[&wgpu::Buffer]| {
            let entries: Vec<_> = (0u32..)
                .zip(buffers)
                .map(|(binding, buffer)| wgpu::BindGroupEntry {
                    binding,
                    resource: buffer.as_entire_binding(),
                })
                .collect();
            device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some(label),
                layout,
                entries: &entries,
            })
        };
        debug_assert_eq!(skin.size() % size_of::<GpuDeformedVertex>() as u64, 0);
        Self {
            grow: [
                group("grow hair", &grow_layout, &[&hair.hair, &hair.roots, &hair.hull, &points]),
                group("deformed skin", &skin_layout, &[skin]),
            ],
            draw: group("draw hair", &draw_layout(device), &[&hair.hair, &hair.roots, &points]),
            points,
        }
    }
}
