//! The structs of hair that Rust writes and WGSL reads.

use crate::model::bone::GpuBone;
use avatar_groom::{OTHER_BONES, RegionStyle, SEGMENTS, offset_from_head};
use bytemuck::{Pod, Zeroable};
use glam::Affine3A;

/// Strands per workgroup.
pub(crate) const GROW_WORKGROUP_SIZE: u32 = 64;
/// The number of a strand's guide where it follows none.
pub(crate) const NO_GUIDE: u32 = u32::MAX;
/// The number of a guide's own guide: it has none, and no curls.
pub(crate) const IS_GUIDE: u32 = NO_GUIDE - 1;
/// Scalp, brows, lashes.
pub(crate) const REGION_COUNT: usize = 3;
/// Elements per strand in the buffer of points: the points, and the normal at the root.
pub(crate) const POINT_STRIDE: usize = SEGMENTS + 2;

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
    pub(crate) tuck: f32,
    pub(crate) pad: f32,
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
    /// The number of its region, and its thickness in 255ths in the next eight bits.
    pub(crate) region: u32,
    pub(crate) barycentric: [f32; 3],
    pub(crate) guide: u32,
    pub(crate) comb: [f32; 3],
    pub(crate) length: f32,
    pub(crate) random: [f32; 3],
    pub(crate) phase: f32,
}

impl GpuHairRegion {
    /// From a style, whose lengths are shares of the skin's height.
    pub(crate) fn new(style: &RegionStyle, height: f32) -> Self {
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
            tuck: style.tuck,
            pad: 0.0,
        }
    }
}

impl GpuHairPose {
    pub(crate) fn new(head: Affine3A, others: [Affine3A; OTHER_BONES]) -> Self {
        let others = others.map(|other| GpuBone::new(&offset_from_head(head, other)));
        Self { head: GpuBone::new(&head), others }
    }
}
