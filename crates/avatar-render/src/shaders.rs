//! The WGSL programs: text modules joined with constants that Rust owns, so that each fact stands once.

use crate::deformer::DEFORM_WORKGROUP_SIZE;
use crate::eye::PROFILE_LEN;
use crate::frame::{KEY_LAMP, LAMP_COUNT, RIM_LAMP, SHADOW_COUNT, TONE_AGX, TONE_NEUTRAL};
use crate::hair::{GROW_WORKGROUP_SIZE, IS_GUIDE, REGION_COUNT};
use crate::material::{
    COLOR_TEXTURE, GLOSS_TEXTURE, NORMAL_TEXTURE, OCCLUSION_TEXTURE, SKIN_ALBEDO, THICKNESS_TEXTURE,
};
use crate::pores::PORE_CELLS;
use crate::shape_blocks::{RESTING_BLOCK, SHAPE_BLOCK};
use crate::vec4_texture::VEC4S_PER_ROW;
use crate::{RendererConfig, Scattering, Shading, Terms};
use avatar_groom::{CURL_SHARE, FIRST_SEGMENT, NO_GUIDE, OTHER_BONES, Region, SEGMENTS, STEP_SUM};
use avatar_look::optics::diffusion_distance;
use avatar_mesh::MIN_NORMAL_LENGTH;

/// A WGSL program: a pass and the shared modules that it calls.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Program {
    pub(crate) label: &'static str,
    /// Entry point of the vertex or compute stage.
    pub(crate) entry: &'static str,
    /// Entry point of the fragment stage, if there is one.
    pub(crate) fragment: Option<&'static str>,
    modules: &'static [&'static str],
}

/// What of a program depends on how the picture is to look: written into its text.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Constants {
    pub(crate) terms: Terms,
    /// Whether fragments encode their colours because the target does not.
    pub(crate) encode_srgb: bool,
    /// Whether thin strands cover some of a pixel's samples, instead of being blended.
    pub(crate) coverage_mask: bool,
    /// Whether strands are lit in bands.
    pub(crate) toon: bool,
    /// Whether strands go with guides that swing.
    pub(crate) swinging: bool,
}

impl Default for Constants {
    fn default() -> Self {
        Self { terms: Terms::NONE, encode_srgb: false, coverage_mask: false, toon: false, swinging: false }
    }
}

impl Constants {
    /// Those of all programs of a renderer.
    pub(crate) fn of(config: RendererConfig) -> Self {
        Self {
            terms: config.shading.terms(),
            encode_srgb: config.encodes_in_shader(),
            coverage_mask: config.samples > 1,
            toon: config.shading == Shading::Toon,
            ..Self::default()
        }
    }
}

macro_rules! module {
    ($file:literal) => {
        include_str!(concat!("shaders/", $file, ".wgsl"))
    };
}

const AVATAR: &str = module!("shared/avatar");
const PART: &str = module!("shared/part");
const DEFORM: &str = module!("shared/deform");
const FRAME: &str = module!("shared/frame");
const VIEW: &str = module!("shared/view");
const LOOK: &str = module!("shared/look");
const VERTEX: &str = module!("shared/vertex");
const SURFACE: &str = module!("shared/surface");
const BRDF: &str = module!("shared/brdf");
const OUTPUT: &str = module!("shared/output");
const SHADOW: &str = module!("shared/shadow");
const HAIR_SHADOW: &str = module!("shared/hair_shadow");
const AMBIENT: &str = module!("shared/ambient");
const MATTE: &str = module!("shared/matte");
const SKIN_DIFFUSE: &str = module!("shared/skin_diffuse");
const NATURAL_LIGHT: &str = module!("shared/natural_light");
const SCATTER: &str = module!("shared/scatter");
const EYE: &str = module!("shared/eye");
const PLAIN_LIGHT: &str = module!("plain/light");
const TOON_LIGHT: &str = module!("toon/toon");

/// A program that draws parts: its label, entry points, what lights it, and its own file.
macro_rules! surface_program {
    ($label:literal, $vertex:literal, $fragment:literal, [$($module:expr),*], $file:literal) => {
        Program {
            label: $label,
            entry: $vertex,
            fragment: Some($fragment),
            modules: &[FRAME, VIEW, LOOK, VERTEX, SURFACE, BRDF, OUTPUT, $($module,)* module!($file)],
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

pub(crate) const DEFORM_PASS: Program = Program {
    label: "deform",
    entry: "deform_main",
    fragment: None,
    modules: &[AVATAR, PART, DEFORM, module!("passes/deform")],
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

const HAIR: &str = module!("strands/hair");

pub(crate) const GROW_PASS: Program = Program {
    label: "grow hair",
    entry: "grow_main",
    fragment: None,
    modules: &[
        AVATAR,
        HAIR,
        module!("strands/field"),
        module!("strands/sources"),
        module!("strands/swung"),
        module!("strands/grow"),
    ],
};

pub(crate) const SWING_PASS: Program = Program {
    label: "swing hair",
    entry: "swing_main",
    fragment: None,
    modules: &[module!("strands/swing")],
};

/// A program that draws strands: its label, entry points, and what comes after the ribbons.
macro_rules! strand_program {
    ($label:literal, $vertex:literal, $fragment:expr, [$($module:expr),*]) => {
        Program {
            label: $label,
            entry: $vertex,
            fragment: $fragment,
            modules: &[FRAME, VIEW, HAIR_SHADOW, SHADOW, HAIR, module!("strands/ribbon"), $($module),*],
        }
    };
}

/// Where pixels have several samples.
pub(crate) const MASKED_STRANDS: Program = strand_program!(
    "hair",
    "strand_main",
    Some("strand_masked_main"),
    [OUTPUT, AMBIENT, BRDF, module!("strands/draw"), module!("strands/masked")]
);

/// Where they have one.
pub(crate) const LAYERED_STRANDS: Program = strand_program!(
    "hair in layers",
    "strand_main",
    Some("strand_layered_main"),
    [OUTPUT, AMBIENT, BRDF, module!("strands/draw"), module!("strands/coverage"), module!("strands/layered")]
);

pub(crate) const STRAND_LAYERS: Program = strand_program!(
    "layers of hair",
    "strand_layers_main",
    Some("strand_layers_fragment_main"),
    [module!("strands/coverage"), module!("strands/layers")]
);

pub(crate) const STRAND_SLICES: Program = strand_program!(
    "slices of hair",
    "strand_layers_main",
    Some("strand_slices_main"),
    [module!("strands/coverage"), module!("strands/layers"), module!("strands/slices")]
);

pub(crate) const HAIR_SHADOW_PASS: Program = strand_program!(
    "shadow of hair",
    "hair_shadow_main",
    Some("hair_shadow_fragment_main"),
    [module!("strands/shadow")]
);

pub(crate) const COMPOSE_HAIR: Program = Program {
    label: "hair over the picture",
    entry: "compose_vertex_main",
    fragment: Some("compose_main"),
    modules: &[FRAME, VIEW, module!("strands/compose")],
};

pub(crate) const COMPOSE_HAIR_DEPTH: Program = Program {
    label: "hair over the picture: depth",
    entry: "compose_vertex_main",
    fragment: Some("compose_depth_main"),
    modules: &[FRAME, VIEW, module!("strands/compose"), module!("strands/compose_depth")],
};

impl Program {
    /// The whole text.
    pub(crate) fn source(&self, constants: &Constants) -> String {
        let mut source = constants.text();
        for module in self.modules {
            source.push('\n');
            source.push_str(module);
        }
        source
    }

    pub(crate) fn module(&self, device: &wgpu::Device, constants: &Constants) -> wgpu::ShaderModule {
        device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some(self.label),
            source: wgpu::ShaderSource::Wgsl(self.source(constants).into()),
        })
    }
}

impl Constants {
    fn text(&self) -> String {
        let Self { terms, encode_srgb, coverage_mask, toon, swinging } = self;
        let reach = terms.shadows.reach().map_or(-1, |reach| reach as i32);
        let flag = |name: &str, on: bool| format!("const {name}: bool = {on};\n");
        let number = |name: &str, value: u32| format!("const {name}: u32 = {value}u;\n");
        let float = |name: &str, value: f32| format!("const {name}: f32 = {value:e};\n");
        [
            float("MIN_NORMAL_LENGTH", MIN_NORMAL_LENGTH),
            number("DEFORM_WORKGROUP_SIZE", DEFORM_WORKGROUP_SIZE),
            number("SHAPE_BLOCK", SHAPE_BLOCK),
            number("RESTING_BLOCK", RESTING_BLOCK),
            number("LAMP_COUNT", LAMP_COUNT as u32),
            number("KEY_LAMP", KEY_LAMP as u32),
            number("RIM_LAMP", RIM_LAMP as u32),
            number("COLOR_TEXTURE", COLOR_TEXTURE),
            number("OCCLUSION_TEXTURE", OCCLUSION_TEXTURE),
            number("GLOSS_TEXTURE", GLOSS_TEXTURE),
            number("NORMAL_TEXTURE", NORMAL_TEXTURE),
            number("THICKNESS_TEXTURE", THICKNESS_TEXTURE),
            number("TONE_NEUTRAL", TONE_NEUTRAL),
            number("TONE_AGX", TONE_AGX),
            number("SHADOW_COUNT", SHADOW_COUNT as u32),
            number("SHADOW_COUNT_USED", terms.shadows.lamps()),
            format!("const SHADOW_REACH: i32 = {reach};\n"),
            float("SHADOW_SIZE", terms.shadows.map_size() as f32),
            float("HAIR_MAP_SIZE", terms.shadows.hair_map_size() as f32),
            number("PROFILE_ROWS", PROFILE_LEN as u32 / 4),
            float("PATH_PER_DISTANCE", 1.0 / diffusion_distance(1.0, SKIN_ALBEDO)),
            number("WRAPPED", Scattering::Wrapped as u32),
            number("PRE_INTEGRATED", Scattering::PreIntegrated as u32),
            number("SEPARABLE", Scattering::Separable as u32),
            number("SCATTERING", terms.scattering as u32),
            flag("OCCLUSION_VIEW", terms.occlusion),
            flag("REFLECTIONS", terms.reflections),
            flag("SHARP_LOBE", terms.sharp_lobe),
            flag("PORES", terms.pores),
            float("PORE_CELLS", PORE_CELLS as f32),
            flag("TRANSMISSION", terms.transmission),
            flag("EYE_OPTICS", terms.eye_optics),
            flag("ENCODE_SRGB", *encode_srgb),
            flag("COVERAGE_MASK", *coverage_mask),
            flag("TOON", *toon),
            flag("SWINGING", *swinging),
            number("SEGMENTS", SEGMENTS as u32),
            float("FIRST_SEGMENT", FIRST_SEGMENT),
            number("NO_GUIDE", NO_GUIDE),
            number("IS_GUIDE", IS_GUIDE),
            float("CURL_SHARE", CURL_SHARE),
            float("STEP_SUM", STEP_SUM as f32),
            number("REGION_COUNT", REGION_COUNT as u32),
            number("VEC4S_PER_ROW", VEC4S_PER_ROW),
            number("OTHER_BONES", OTHER_BONES as u32),
            number("SCALP", Region::Scalp as u32),
            number("GROW_WORKGROUP_SIZE", GROW_WORKGROUP_SIZE),
        ]
        .concat()
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    /// Every program.
    pub(crate) fn all() -> Vec<Program> {
        let styles = [PLAIN, NATURAL, TOON];
        let of_style = |p: Programs| [p.skin, p.teeth, p.eyeball, p.skin_back, p.cornea];
        let passes = [
            OUTLINE,
            DEFORM_PASS,
            SHADOW_PASS,
            PREPASS,
            OCCLUSION_PASS,
            SKIN_LIGHT_PASS,
            SCATTER_PASS,
            GROW_PASS,
            SWING_PASS,
            MASKED_STRANDS,
            LAYERED_STRANDS,
            STRAND_LAYERS,
            STRAND_SLICES,
            HAIR_SHADOW_PASS,
            COMPOSE_HAIR,
            COMPOSE_HAIR_DEPTH,
        ];
        styles.into_iter().flat_map(of_style).chain(passes).collect()
    }

    pub(crate) fn parsed(program: &Program, constants: &Constants) -> naga::Module {
        let source = program.source(constants);
        match naga::front::wgsl::parse_str(&source) {
            Ok(module) => module,
            Err(error) => panic!("{}: {}", program.label, error.emit_to_string(&source)),
        }
    }

    #[test]
    fn every_program_parses_and_validates_without_optional_capabilities() {
        for terms in [Terms::NONE, Terms::LOW, Terms::MEDIUM, Terms::HIGH] {
            let plain = terms == Terms::NONE;
            let constants =
                Constants { terms, encode_srgb: plain, coverage_mask: !plain, toon: plain, swinging: plain };
            for program in all() {
                let module = parsed(&program, &constants);
                let mut validator = naga::valid::Validator::new(
                    naga::valid::ValidationFlags::all(),
                    naga::valid::Capabilities::empty(),
                );
                if let Err(error) = validator.validate(&module) {
                    panic!("{}: {}", program.label, error.emit_to_string(&program.source(&constants)));
                }
                for entry in [Some(program.entry), program.fragment].into_iter().flatten() {
                    assert!(module.entry_points.iter().any(|e| e.name == entry), "{}", program.label);
                }
            }
        }
    }

    #[test]
    fn no_program_needs_more_bindings_than_webgpu_promises() {
        for program in all() {
            let module = parsed(&program, &Constants { terms: Terms::HIGH, ..Constants::default() });
            let count = |wanted: &dyn Fn(&naga::TypeInner, naga::AddressSpace) -> bool| {
                let variables = module.global_variables.iter();
                variables.filter(|(_, v)| wanted(&module.types[v.ty].inner, v.space)).count()
            };
            let storage = count(&|_, space| matches!(space, naga::AddressSpace::Storage { .. }));
            let textures = count(&|inner, _| matches!(inner, naga::TypeInner::Image { .. }));
            let samplers = count(&|inner, _| matches!(inner, naga::TypeInner::Sampler { .. }));
            let groups = module.global_variables.iter().filter_map(|(_, v)| v.binding).map(|b| b.group);
            assert!(storage <= 8, "{}", program.label);
            assert!(textures <= 16 && samplers <= 16, "{}", program.label);
            assert!(groups.max().unwrap_or(0) < 4, "{}", program.label);
        }
    }

    #[test]
    fn no_shader_is_longer_than_a_few_screens() {
        for program in all() {
            for module in program.modules {
                assert!(module.lines().count() <= 160, "{}: {:.60}", program.label, module);
            }
        }
    }
}
