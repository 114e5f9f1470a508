//! The hair of a model on the GPU.

use crate::deform::posed::GpuDeformedVertex;
use crate::gpu::identity::Identity;
use crate::gpu::vec4_texture::Vec4Texture;
use crate::hair::error::HairError;
use crate::hair::layouts::FIELD_FORMAT;
use crate::hair::uniforms::{
    GROW_WORKGROUP_SIZE, GpuHair, GpuHairRegion, GpuRoot, IS_GUIDE, NO_GUIDE, POINT_STRIDE,
};
use crate::model::geometry::Geometry;
use avatar_groom::{COMBED_REACH, Field, Groom, LOCK_REACH, MARGIN, OTHER_BONES, PlantedStrand, RegionStyle};
use bytemuck::Zeroable;
use wgpu::util::DeviceExt;

/// The radii of styles are for this many strands in a square whose side is the skin's height; fewer are wider
/// in proportion.
const REFERENCE_STRANDS: f32 = 100_000.0;
const WIDEST: f32 = 5.0;
/// Pieces between two points of a strand that curls: a turn of tight curls has three points.
const CURLED_PIECES: u32 = 4;
const VEC4S_PER_VERTEX: usize = size_of::<GpuDeformedVertex>() / size_of::<[f32; 4]>();

/// The hair that all avatars of a model share.
#[derive(Debug)]
pub(crate) struct HairModel {
    /// Differs from that of hair which was planted before or after it.
    pub(crate) id: Identity,
    /// The part that it grows on.
    pub(crate) part: usize,
    pub(crate) strand_count: u32,
    pub(crate) guide_count: u32,
    /// The longest strand: how far hair reaches beyond the skin at most, up to its swinging.
    pub(crate) reach: f32,
    /// How high it reaches at bind pose, in the world.
    pub(crate) top: Option<f32>,
    /// Swings per second of the tips of guides.
    pub(crate) swing: f32,
    /// Pieces that are drawn from one point of a strand to the next.
    pub(crate) pieces: u32,
    pub(crate) hair: wgpu::Buffer,
    pub(crate) roots: Vec4Texture,
    /// The roots of guides once more, marked as guides.
    pub(crate) guide_roots: Vec4Texture,
    pub(crate) field: wgpu::TextureView,
    pub(crate) head_bone: u32,
    pub(crate) other_bones: [u32; OTHER_BONES],
}

impl HairModel {
    pub(crate) fn new(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        part: usize,
        skin: &Geometry,
        bones: u32,
        groom: &Groom,
    ) -> Result<Self, HairError> {
        let limits = device.limits();
        let binding = limits.max_storage_buffer_binding_size.min(limits.max_buffer_size);
        let per_strand = (POINT_STRIDE * size_of::<[f32; 4]>()) as u64;
        let groups = limits.max_compute_workgroups_per_dimension as usize * GROW_WORKGROUP_SIZE as usize;
        let most_roots = Vec4Texture::most(&limits) / (size_of::<GpuRoot>() / size_of::<[f32; 4]>());
        let limit = ((binding / per_strand) as usize).min(groups).min(most_roots);
        let found = groom.strands().len();
        if found > limit {
            return Err(HairError::TooMany { found, limit });
        }
        let mut roots = Vec::with_capacity(found);
        for (strand, planted) in groom.strands().iter().enumerate() {
            let corners = planted.root.corners.map(|corner| skin.places.get(corner).ok_or(corner));
            if let Some(found) = corners.iter().find_map(|corner| corner.err()) {
                return Err(HairError::Corner { strand, found, vertices: skin.places.mesh_vertex_count() });
            }
            roots.push(gpu_root(planted, corners.map(Result::unwrap_or_default)));
        }
        let guide_root =
            |strand: &u32| roots.get(*strand as usize).map(|root| GpuRoot { guide: IS_GUIDE, ..*root });
        let mut guide_roots: Vec<GpuRoot> = groom.guides().iter().filter_map(guide_root).collect();
        let (strand_count, guide_count) = (roots.len() as u32, guide_roots.len() as u32);
        // WebGPU binds no empty buffers.
        for roots in [&mut roots, &mut guide_roots].into_iter().filter(|roots| roots.is_empty()) {
            roots.push(GpuRoot::zeroed());
        }
        let field = groom.field();
        if let Some(&found) = field.bones.iter().chain([&groom.head_bone()]).find(|bone| **bone >= bones) {
            return Err(HairError::Bone { found, bones });
        }
        if field.size.iter().any(|n| *n > limits.max_texture_dimension_3d) {
            return Err(HairError::FieldSize { found: field.size, limit: limits.max_texture_dimension_3d });
        }
        if guide_roots.len() > Vec4Texture::most(&limits) / POINT_STRIDE {
            return Err(HairError::TooMany { found, limit: Vec4Texture::most(&limits) / POINT_STRIDE });
        }
        let most = Vec4Texture::most(&limits) / VEC4S_PER_VERTEX;
        if skin.vertex_count as usize > most {
            return Err(HairError::SkinSize { found: skin.vertex_count, limit: most });
        }
        let region = |style: &RegionStyle| GpuHairRegion::new(style, groom.height());
        let hair = GpuHair {
            regions: [
                region(&groom.style().scalp),
                region(&groom.style().brows),
                region(&groom.style().lashes),
            ],
            field_origin: field.origin.to_array(),
            field_cell: field.cell,
            field_size: field.size,
            margin: MARGIN * groom.height(),
            per_combed_reach: 1.0 / (COMBED_REACH * groom.height()),
            per_lock_reach: 1.0 / (LOCK_REACH * groom.height()),
            strand_count,
            width_factor: (REFERENCE_STRANDS / groom.strands_per_square().max(1.0)).clamp(0.5, WIDEST),
            field_range: field.range(),
            field_cells: 1.0 / field.cell,
            pad: [0.0; 2],
        };
        let list =
            |label, roots: &[GpuRoot]| Vec4Texture::with(device, queue, label, bytemuck::cast_slice(roots));
        Ok(Self {
            id: Identity::new(),
            part,
            strand_count,
            guide_count,
            reach: groom.strands().iter().map(|planted| planted.length).fold(0.0, f32::max),
            top: groom.top(),
            swing: groom.style().scalp.swing,
            pieces: if curls(&groom.style().scalp) { CURLED_PIECES } else { 1 },
            hair: device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
                label: Some("hair"),
                contents: bytemuck::bytes_of(&hair),
                usage: wgpu::BufferUsages::UNIFORM,
            }),
            roots: list("hair: roots", &roots),
            guide_roots: list("hair: roots of guides", &guide_roots),
            field: field_texture(device, queue, field),
            head_bone: groom.head_bone(),
            other_bones: field.bones,
        })
    }
}

fn curls(style: &RegionStyle) -> bool {
    style.curl_radius > 0.0 && style.curl_turns > 0.0
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
        format: FIELD_FORMAT,
        usage: wgpu::TextureUsages::STORAGE_BINDING,
        view_formats: &[],
    };
    let texels = field.texels();
    let order = wgpu::util::TextureDataOrder::LayerMajor;
    let texture = device.create_texture_with_data(queue, &descriptor, order, bytemuck::cast_slice(&texels));
    texture.create_view(&wgpu::TextureViewDescriptor { label, ..Default::default() })
}

/// `corners` are the vertices of its triangle on the GPU.
fn gpu_root(planted: &PlantedStrand, corners: [u32; 3]) -> GpuRoot {
    let PlantedStrand { root, comb, length, thickness, phase, guide } = planted;
    let [x, y, z, _] = root.random;
    let thickness = (thickness.clamp(0.0, 1.0) * 255.0).round() as u32;
    GpuRoot {
        corners,
        region: root.region as u32 | thickness << 8,
        barycentric: root.barycentric,
        guide: guide.unwrap_or(NO_GUIDE),
        comb: comb.to_array(),
        length: *length,
        random: [x, y, z],
        phase: *phase,
    }
}
