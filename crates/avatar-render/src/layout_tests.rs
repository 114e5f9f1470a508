//! Every struct that Rust writes and WGSL reads must lie in memory alike: naga's offsets against
//! `offset_of!`.

use crate::deform::crowd_chunk::GpuCrowdChunk;
use crate::deform::posed::GpuDeformedVertex;
use crate::hair::detail::GpuHairView;
use crate::hair::swing::{GpuMote, GpuSwing};
use crate::hair::uniforms::{GpuHair, GpuHairPose, GpuHairRegion};
use crate::model::bone::GpuBone;
use crate::model::effects::Effects;
use crate::model::geometry::{GpuPart, GpuVertex, GpuVertexBones};
use crate::model::material::{GpuIris, GpuMaterial};
use crate::model::shape_blocks::GpuShapeOffset;
use crate::program_tests::{all_stages, choices, parsed};
use crate::view::lamps::GpuLamp;
use crate::view::shading::{Shading, Terms};
use crate::view::shadows::GpuShadowView;
use crate::view::uniforms::GpuFrame;
use naga::{AddressSpace, Handle, Module, Type, TypeInner};
use std::collections::BTreeSet;
use std::mem::offset_of;

/// A struct of Rust: its name in WGSL, its size, and the offsets of its members by their names in WGSL.
struct Layout {
    name: &'static str,
    size: usize,
    members: Vec<(&'static str, usize)>,
}

macro_rules! layout {
    ($name:literal, $rust:ty, $($member:ident),+) => {
        Layout {
            name: $name,
            size: size_of::<$rust>(),
            members: vec![$((stringify!($member), offset_of!($rust, $member))),+],
        }
    };
}

fn layouts() -> Vec<Layout> {
    let (position, normal) = (offset_of!(GpuShapeOffset, position), offset_of!(GpuShapeOffset, normal));
    vec![
        layout!(
            "Part",
            GpuPart,
            vertex_count,
            first_word,
            word_count,
            rigid_bone,
            has_vertex_bones,
            wrinkles
        ),
        layout!("Vertex", GpuVertex, position, u, normal, v),
        layout!("VertexBones", GpuVertexBones, indices, weights),
        Layout {
            name: "ShapeOffset",
            size: size_of::<GpuShapeOffset>(),
            members: vec![
                ("position_x", position),
                ("position_y", position + 4),
                ("position_z", position + 8),
                ("normal_x", normal),
                ("normal_y", normal + 4),
                ("normal_z", normal + 8),
            ],
        },
        layout!(
            "CrowdChunk",
            GpuCrowdChunk,
            first_avatar,
            vertex_count,
            bone_count,
            weight_stride,
            rigid_bone
        ),
        layout!("DeformedVertex", GpuDeformedVertex, position, is_mirrored, normal, wrinkled),
        layout!("Lamp", GpuLamp, direction_world, radiance),
        layout!(
            "HairRegion",
            GpuHairRegion,
            root_color,
            root_radius,
            tip_color,
            tip_radius,
            color_variation,
            bend,
            gravity,
            curl_radius,
            curl_turn,
            clump,
            noise,
            volume,
            hold,
            tuck
        ),
        layout!(
            "Hair",
            GpuHair,
            regions,
            field_origin,
            field_cell,
            field_size,
            margin,
            per_combed_reach,
            per_lock_reach,
            strand_count,
            width_factor,
            field_range,
            field_cells
        ),
        layout!("HairPose", GpuHairPose, head, others),
        layout!("Swing", GpuSwing, ticks, first, step, rest, tick, is_still, oscillators),
        layout!("Mote", GpuMote, position, velocity, held, held_at_frame),
        layout!(
            "HairView",
            GpuHairView,
            strands,
            fading,
            width,
            least_pixels,
            other_width,
            stride,
            pieces,
            root_width
        ),
        layout!("ShadowView", GpuShadowView, shadow_from_world),
        layout!(
            "Frame",
            GpuFrame,
            clip_from_world,
            world_from_clip,
            eye_world,
            exposure,
            lamps,
            sky,
            tone_map,
            ground,
            near,
            irradiance,
            shadow_from_world,
            shadow_depth,
            shadow_texel,
            pixels,
            pixels_per_unit,
            occlusion_radius,
            shadow_softness,
            reflection_levels,
            hair_shadow,
            hair_far,
            hair_per_depth,
            pre_exposure
        ),
        layout!(
            "Iris",
            GpuIris,
            cornea_center,
            cornea_radius,
            uv_center,
            uv_from_x,
            uv_from_y,
            profile_reach,
            plane_z,
            profile,
            radius,
            refractive_index,
            pupil,
            painted_pupil,
            limbal_width,
            limbal_darkness,
            color,
            uv_radius,
            painted_color
        ),
        layout!(
            "Material",
            GpuMaterial,
            color,
            opacity,
            wrap,
            reflectance,
            scatter,
            roughness_matte,
            roughness_glossy,
            normal_strength,
            sharp_share,
            sharp_roughness,
            transmission,
            thickness,
            pore_strength,
            pore_density,
            pores_per_length,
            wetness,
            film_roughness,
            back_light,
            front_z,
            per_depth,
            textures,
            second_uvs,
            shade_color,
            alpha_cutoff,
            emissive,
            metallic,
            outline_color,
            outline_width,
            occlusion_strength,
            shading_shift,
            shading_toony,
            shadow_cutoff,
            tone,
            bare_green,
            wrinkle_depth,
            iris
        ),
    ]
}

/// All types that buffers are made of.
fn buffer_types(module: &Module) -> Vec<Handle<Type>> {
    let mut found: Vec<Handle<Type>> = module
        .global_variables
        .iter()
        .filter(|(_, v)| matches!(v.space, AddressSpace::Uniform | AddressSpace::Storage { .. }))
        .map(|(_, v)| v.ty)
        .collect();
    let mut next = 0;
    while let Some(&handle) = found.get(next) {
        match &module.types[handle].inner {
            TypeInner::Struct { members, .. } => found.extend(members.iter().map(|member| member.ty)),
            TypeInner::Array { base, .. } => found.push(*base),
            _ => {}
        }
        next += 1;
    }
    found
}

#[test]
fn every_struct_in_a_buffer_lies_in_rust_as_in_wgsl() {
    let layouts = layouts();
    let mut seen = BTreeSet::new();
    for (program, stage) in all_stages() {
        let module = parsed(&program, stage, &choices(Shading::Natural(Terms::HIGH), 1, Effects::ALL));
        for handle in buffer_types(&module) {
            let ty = &module.types[handle];
            let TypeInner::Struct { members, span } = &ty.inner else { continue };
            let name = ty.name.as_deref().expect("structs have names");
            let layout = layouts.iter().find(|layout| layout.name == name);
            let layout = layout.unwrap_or_else(|| panic!("{name} is in a buffer but not in this test"));
            let wgsl: Vec<(&str, usize)> = members
                .iter()
                .map(|member| (member.name.as_deref().expect("members have names"), member.offset as usize))
                .collect();
            assert_eq!(wgsl, layout.members, "{name} in {}", program.label);
            assert_eq!(*span as usize, layout.size, "{name} in {}", program.label);
            seen.insert(layout.name);
        }
    }
    assert_eq!(seen.len(), layouts.len(), "only {seen:?} are in buffers");
}

#[test]
fn arrays_step_from_element_to_element_as_in_rust() {
    let sizes = [
        ("posed_from_bind", size_of::<GpuBone>()),
        ("avatar_weights", size_of::<u32>()),
        ("crowd_bones", size_of::<GpuBone>()),
        ("drawn", size_of::<u32>()),
        ("moved", size_of::<u32>()),
        ("vertices", size_of::<GpuVertex>()),
        ("vertex_bones", size_of::<GpuVertexBones>()),
        ("block_shapes", size_of::<u32>()),
        ("shape_offsets", size_of::<GpuShapeOffset>()),
        ("deformed", size_of::<GpuDeformedVertex>()),
        ("corners", size_of::<u32>()),
        ("turned_corners", size_of::<u32>()),
        ("points", size_of::<[f32; 4]>()),
        ("guides", size_of::<[f32; 4]>()),
        ("offsets", size_of::<[f32; 4]>()),
        ("motes", size_of::<GpuMote>()),
    ];
    let mut seen = BTreeSet::new();
    for (program, stage) in all_stages() {
        let module = parsed(&program, stage, &choices(Shading::Natural(Terms::HIGH), 1, Effects::ALL));
        for (_, variable) in module.global_variables.iter() {
            let TypeInner::Array { stride, .. } = module.types[variable.ty].inner else { continue };
            let name = variable.name.as_deref().expect("variables have names");
            let (name, size) = *sizes
                .iter()
                .find(|(known, _)| *known == name)
                .unwrap_or_else(|| panic!("the array {name} is not in this test"));
            assert_eq!(stride as usize, size, "{name} in {}", program.label);
            seen.insert(name);
        }
    }
    assert_eq!(seen.len(), sizes.len(), "only {seen:?} are arrays");
}
