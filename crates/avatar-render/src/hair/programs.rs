//! The programs of hair.

use crate::deform::pose::AVATAR;
use crate::gpu::program::{Constant, Module, Program, Value};
use crate::gpu::vec4_texture::VEC4S_PER_ROW;
use crate::hair::uniforms::{GROW_WORKGROUP_SIZE, IS_GUIDE, NO_GUIDE, REGION_COUNT};
use crate::view::shaders::{AMBIENT, BRDF, FRAME, HAIR_SHADOW, OUTPUT, SHADOW, SHADOW_MAPS};
use avatar_groom::{CURL_SHARE, DEEPER, FIRST_SEGMENT, OTHER_BONES, Region, SEGMENTS, STEP_SUM};

const HAIR: Module = Module {
    text: include_str!("shaders/hair.wgsl"),
    constants: || {
        vec![
            ("SEGMENTS", Value::Count(SEGMENTS as u32)),
            ("REGION_COUNT", Value::Count(REGION_COUNT as u32)),
            ("VEC4S_PER_ROW", Value::Count(VEC4S_PER_ROW)),
        ]
    },
};

const GROW: Module = Module { text: include_str!("shaders/grow.wgsl"), constants: growth };

fn growth() -> Vec<Constant> {
    vec![
        ("GROW_WORKGROUP_SIZE", Value::Count(GROW_WORKGROUP_SIZE)),
        ("OTHER_BONES", Value::Count(OTHER_BONES as u32)),
        ("FIRST_SEGMENT", Value::Float(FIRST_SEGMENT)),
        ("STEP_SUM", Value::Float(STEP_SUM as f32)),
        ("CURL_SHARE", Value::Float(CURL_SHARE)),
        ("DEEPER", Value::Float(DEEPER)),
        ("IS_GUIDE", Value::Count(IS_GUIDE)),
        ("NO_GUIDE", Value::Count(NO_GUIDE)),
        ("SCALP", Value::Count(Region::Scalp as u32)),
    ]
}

const SWING: Module = Module {
    text: include_str!("shaders/swing.wgsl"),
    constants: || {
        vec![
            ("SEGMENTS", Value::Count(SEGMENTS as u32)),
            ("GROW_WORKGROUP_SIZE", Value::Count(GROW_WORKGROUP_SIZE)),
        ]
    },
};

const RIBBON: Module = Module {
    text: include_str!("shaders/ribbon.wgsl"),
    constants: || vec![("SCALP", Value::Count(Region::Scalp as u32))],
};
const DRAW: Module = Module::of(include_str!("shaders/draw.wgsl"));
const INPUTS: Module = Module::of(include_str!("shaders/inputs.wgsl"));
const COVERAGE: Module = Module::of(include_str!("shaders/coverage.wgsl"));
const LAYERS: Module = Module::of(include_str!("shaders/layers.wgsl"));
const COMPOSE: Module = Module::of(include_str!("shaders/compose.wgsl"));

/// Whether strands follow guides that swing; otherwise they hang still.
pub(crate) fn swinging(is_swinging: bool) -> Constant {
    ("SWINGING", Value::Flag(is_swinging))
}

pub(crate) const GROW_PASS: Program = Program {
    label: "grow hair",
    entry: "grow_main",
    fragment: None,
    modules: &[
        AVATAR,
        HAIR,
        Module::of(include_str!("shaders/field.wgsl")),
        Module::of(include_str!("shaders/sources.wgsl")),
        Module::of(include_str!("shaders/swung.wgsl")),
        GROW,
    ],
};

pub(crate) const SWING_PASS: Program =
    Program { label: "swing hair", entry: "swing_main", fragment: None, modules: &[SWING] };

/// A program that draws strands: its label, entry points, and what comes after the ribbons.
macro_rules! strand_program {
    ($label:literal, $vertex:literal, $fragment:expr, [$($module:expr),*]) => {
        Program {
            label: $label,
            entry: $vertex,
            fragment: $fragment,
            modules: &[FRAME, SHADOW_MAPS, HAIR_SHADOW, SHADOW, HAIR, RIBBON, $($module),*],
        }
    };
}

/// For several samples per pixel.
pub(crate) const MASKED_STRANDS: Program = strand_program!(
    "hair",
    "strand_main",
    Some("strand_masked_main"),
    [OUTPUT, AMBIENT, BRDF, DRAW, Module::of(include_str!("shaders/masked.wgsl"))]
);

/// For one sample per pixel.
pub(crate) const LAYERED_STRANDS: Program = strand_program!(
    "hair in layers",
    "strand_main",
    Some("strand_layered_main"),
    [OUTPUT, AMBIENT, BRDF, DRAW, INPUTS, COVERAGE, Module::of(include_str!("shaders/layered.wgsl"))]
);

pub(crate) const STRAND_LAYERS: Program = strand_program!(
    "layers of hair",
    "strand_layers_main",
    Some("strand_layers_fragment_main"),
    [COVERAGE, LAYERS]
);

pub(crate) const STRAND_SLICES: Program = strand_program!(
    "slices of hair",
    "strand_layers_main",
    Some("strand_slices_main"),
    [INPUTS, COVERAGE, LAYERS, Module::of(include_str!("shaders/slices.wgsl"))]
);

pub(crate) const HAIR_SHADOW_PASS: Program = strand_program!(
    "shadow of hair",
    "hair_shadow_main",
    Some("hair_shadow_fragment_main"),
    [Module::of(include_str!("shaders/shadow.wgsl"))]
);

pub(crate) const COMPOSE_HAIR: Program = Program {
    label: "hair over the picture",
    entry: "compose_vertex_main",
    fragment: Some("compose_main"),
    modules: &[FRAME, COMPOSE],
};

pub(crate) const COMPOSE_HAIR_DEPTH: Program = Program {
    label: "hair over the picture: depth",
    entry: "compose_vertex_main",
    fragment: Some("compose_depth_main"),
    modules: &[FRAME, COMPOSE, Module::of(include_str!("shaders/compose_depth.wgsl"))],
};
