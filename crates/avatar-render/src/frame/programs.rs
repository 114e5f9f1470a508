//! The programs that draw parts, and those of the passes before.

use crate::gpu::program::{Module, Program};
use crate::model::material::LOOK;
use crate::view::shaders::{AMBIENT, BRDF, FRAME, HAIR_SHADOW, OUTPUT, SHADOW, SHADOW_MAPS, VIEW};
use crate::view::shading::Shading;

macro_rules! module {
    ($file:literal) => {
        Module::of(include_str!(concat!("shaders/", $file, ".wgsl")))
    };
}

const VERTEX: Module = module!("shared/vertex");
const GROOVE: Module = module!("shared/groove");
const RECOLORED: Module = module!("shared/recolored");
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
            modules: &[FRAME, SHADOW_MAPS, VIEW, LOOK, VERTEX, GROOVE, RECOLORED, SURFACE, BRDF, OUTPUT, $($module,)* module!($file)],
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

const STANDARD_VERTEX: Module = module!("standard/vertex");
const STANDARD_SURFACE: Module = module!("standard/surface");
const NATURAL_STANDARD: Module = module!("standard/natural");
const PLAIN_STANDARD: Module = module!("standard/plain");
const TOON_STANDARD: Module = module!("standard/toon");
const STANDARD_OUTLINE: Module = module!("standard/outline");
const STANDARD_PREPASS: Module = module!("standard/prepass");
const STANDARD_PICTURE: Module = module!("standard/picture");
const STANDARD_SHADOW: Module = module!("standard/shadow");
/// For programs that draw into the picture, whose pixels may have several samples.
const SAMPLED: Module = Module::of("const SAMPLED: bool = true;");
/// For passes before the picture.
const ONE_SAMPLE: Module = Module::of("const SAMPLED: bool = false;");

/// The programs of surfaces of interchange files in one style, each without and with second texture
/// coordinates and colours of vertices.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Standards {
    pub(crate) opaque: [Program; 2],
    pub(crate) cut: [Program; 2],
    pub(crate) blended: [Program; 2],
    pub(crate) outline: [Program; 2],
    pub(crate) cut_prepass: [Program; 2],
    pub(crate) cut_shadow: [Program; 2],
}

impl Standards {
    /// Every program.
    #[cfg(test)]
    pub(crate) fn all(self) -> impl Iterator<Item = Program> {
        let Self { opaque, cut, blended, outline, cut_prepass, cut_shadow } = self;
        [opaque, cut, blended, outline, cut_prepass, cut_shadow].into_iter().flatten()
    }
}

/// Programs with these two vertex stages.
macro_rules! standard_programs {
    ($label:literal, [$($vertex:literal),*], $fragment:literal, $modules:expr) => {
        [$(Program { label: $label, entry: $vertex, fragment: Some($fragment), modules: $modules }),*]
    };
}

macro_rules! standards {
    ([$($light:expr),*]) => {{
        const MODULES: &[Module] = &[
            FRAME, SHADOW_MAPS, VIEW, LOOK, VERTEX, GROOVE, RECOLORED, SURFACE, BRDF, OUTPUT, $($light,)*
            SAMPLED, STANDARD_VERTEX, STANDARD_SURFACE, STANDARD_PICTURE,
        ];
        const VERTICES: &[Module] = &[FRAME, LOOK, VERTEX, OUTPUT, SAMPLED, STANDARD_VERTEX, STANDARD_OUTLINE];
        const NORMALS: &[Module] = &[FRAME, LOOK, VERTEX, ONE_SAMPLE, STANDARD_VERTEX, STANDARD_PREPASS];
        const SHADOWS: &[Module] = &[LOOK, STANDARD_SHADOW];
        Standards {
            opaque: standard_programs!(
                "opaque surface", ["standard_main", "standard_extra_main"], "opaque_main", MODULES),
            cut: standard_programs!(
                "surface with holes", ["standard_main", "standard_extra_main"], "cut_main", MODULES),
            blended: standard_programs!(
                "blended surface", ["standard_main", "standard_extra_main"], "blended_main", MODULES),
            outline: standard_programs!(
                "line around a part", ["part_outline_main", "part_outline_extra_main"], "line_main", VERTICES),
            cut_prepass: standard_programs!(
                "depth and normals of holes", ["standard_main", "standard_extra_main"], "cut_prepass_main",
                NORMALS),
            cut_shadow: standard_programs!(
                "shadow of holes", ["cut_shadow_main", "cut_shadow_extra_main"], "cut_caster_main", SHADOWS),
        }
    }};
}

pub(crate) const PLAIN_STANDARDS: Standards = standards!([PLAIN_LIGHT, PLAIN_STANDARD]);
pub(crate) const NATURAL_STANDARDS: Standards = standards!([SHADOW, HAIR_SHADOW, AMBIENT, NATURAL_STANDARD]);
pub(crate) const TOON_STANDARDS: Standards =
    standards!([SHADOW, HAIR_SHADOW, AMBIENT, TOON_LIGHT, TOON_STANDARD]);

/// The programs of a style.
pub(crate) fn standards(shading: Shading) -> Standards {
    match shading {
        Shading::Plain => PLAIN_STANDARDS,
        Shading::Natural(_) => NATURAL_STANDARDS,
        Shading::Toon => TOON_STANDARDS,
    }
}

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

/// Brings a picture with a transparent background to a surface.
pub(crate) const SEE_THROUGH: Program = Program {
    label: "see through",
    entry: "see_through_vertex",
    fragment: Some("see_through_main"),
    modules: &[FRAME, OUTPUT, module!("passes/see_through")],
};
