//! The programs that draw parts, and those of the passes before.

use crate::gpu::program::{Module, Program};
use crate::model::material::LOOK;
use crate::view::shaders::{AMBIENT, BRDF, FRAME, HAIR_SHADOW, OUTPUT, SHADOW, SHADOW_MAPS, VIEW};

macro_rules! module {
    ($file:literal) => {
        Module::of(include_str!(concat!("shaders/", $file, ".wgsl")))
    };
}

const VERTEX: Module = module!("shared/vertex");
const SURFACE: Module = module!("shared/surface");
const MATTE: Module = module!("shared/matte");
const SKIN_DIFFUSE: Module = module!("shared/skin_diffuse");
const NATURAL_LIGHT: Module = module!("shared/natural_light");
const SCATTER: Module = module!("shared/scatter");
const EYE: Module = module!("shared/eye");
const PLAIN_LIGHT: Module = module!("plain/light");
const TOON_LIGHT: Module = module!("toon/toon");

/// A program that draws parts: its label, entry points, what lights it, and its own file.
macro_rules! surface_program {
    ($label:literal, $vertex:literal, $fragment:literal, [$($module:expr),*], $file:literal) => {
        Program {
            label: $label,
            entry: $vertex,
            fragment: Some($fragment),
            modules: &[FRAME, SHADOW_MAPS, VIEW, LOOK, VERTEX, SURFACE, BRDF, OUTPUT, $($module,)* module!($file)],
        }
    };
}

/// The programs of one style.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Programs {
    pub(crate) skin: Program,
    pub(crate) teeth: Program,
    pub(crate) eyeball: Program,
    pub(crate) skin_back: Program,
    pub(crate) cornea: Program,
}

pub(crate) const PLAIN: Programs = Programs {
    skin: surface_program!("skin (plain)", "vertex_main", "skin_main", [PLAIN_LIGHT], "plain/skin"),
    teeth: surface_program!("teeth (plain)", "vertex_main", "teeth_main", [PLAIN_LIGHT], "plain/teeth"),
    eyeball: surface_program!(
        "eyeball (plain)",
        "vertex_main",
        "eyeball_main",
        [PLAIN_LIGHT],
        "plain/eyeball"
    ),
    skin_back: surface_program!(
        "skin back (plain)",
        "vertex_main",
        "skin_back_main",
        [PLAIN_LIGHT],
        "plain/skin_back"
    ),
    cornea: surface_program!("cornea (plain)", "vertex_main", "cornea_main", [PLAIN_LIGHT], "plain/cornea"),
};

pub(crate) const NATURAL: Programs = Programs {
    skin: surface_program!(
        "skin",
        "vertex_main",
        "skin_main",
        [SHADOW, HAIR_SHADOW, AMBIENT, SKIN_DIFFUSE, NATURAL_LIGHT, SCATTER],
        "natural/skin"
    ),
    teeth: surface_program!(
        "teeth",
        "vertex_main",
        "teeth_main",
        [SHADOW, HAIR_SHADOW, AMBIENT, MATTE, NATURAL_LIGHT],
        "natural/teeth"
    ),
    eyeball: surface_program!(
        "eyeball",
        "eye_vertex_main",
        "eyeball_main",
        [SHADOW, HAIR_SHADOW, AMBIENT, MATTE, NATURAL_LIGHT, EYE],
        "natural/eyeball"
    ),
    skin_back: surface_program!("skin back", "vertex_main", "skin_back_main", [AMBIENT], "natural/skin_back"),
    cornea: surface_program!(
        "cornea",
        "vertex_main",
        "cornea_main",
        [SHADOW, HAIR_SHADOW, AMBIENT, MATTE, NATURAL_LIGHT],
        "natural/cornea"
    ),
};

pub(crate) const TOON: Programs = Programs {
    skin: surface_program!(
        "skin (toon)",
        "vertex_main",
        "skin_main",
        [SHADOW, HAIR_SHADOW, AMBIENT, TOON_LIGHT],
        "toon/skin"
    ),
    teeth: surface_program!(
        "teeth (toon)",
        "vertex_main",
        "teeth_main",
        [SHADOW, HAIR_SHADOW, AMBIENT, TOON_LIGHT],
        "toon/teeth"
    ),
    eyeball: surface_program!(
        "eyeball (toon)",
        "eye_vertex_main",
        "eyeball_main",
        [SHADOW, HAIR_SHADOW, AMBIENT, TOON_LIGHT, EYE],
        "toon/eyeball"
    ),
    cornea: surface_program!(
        "cornea (toon)",
        "vertex_main",
        "cornea_main",
        [SHADOW, HAIR_SHADOW, AMBIENT, TOON_LIGHT],
        "toon/cornea"
    ),
    ..NATURAL
};

pub(crate) const OUTLINE: Program = Program {
    label: "outline",
    entry: "outline_vertex_main",
    fragment: Some("outline_main"),
    modules: &[FRAME, LOOK, VERTEX, OUTPUT, module!("toon/outline")],
};

pub(crate) const SHADOW_PASS: Program =
    Program { label: "shadow", entry: "shadow_main", fragment: None, modules: &[module!("passes/shadow")] };

pub(crate) const PREPASS: Program = Program {
    label: "depth and normals",
    entry: "vertex_main",
    fragment: Some("prepass_main"),
    modules: &[FRAME, LOOK, VERTEX, module!("passes/prepass")],
};

pub(crate) const OCCLUSION_PASS: Program = Program {
    label: "ambient occlusion",
    entry: "picture_main",
    fragment: Some("occlusion_main"),
    modules: &[FRAME, VIEW, module!("passes/occlusion")],
};

pub(crate) const SKIN_LIGHT_PASS: Program = surface_program!(
    "light on skin",
    "vertex_main",
    "skin_light_main",
    [SHADOW, HAIR_SHADOW, AMBIENT, SKIN_DIFFUSE, NATURAL_LIGHT],
    "passes/skin_light"
);

pub(crate) const SCATTER_PASS: Program = Program {
    label: "scatter across",
    entry: "vertex_main",
    fragment: Some("scatter_across_main"),
    modules: &[FRAME, VIEW, LOOK, VERTEX, SCATTER, module!("passes/scatter_across")],
};
