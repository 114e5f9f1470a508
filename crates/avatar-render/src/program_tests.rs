//! Every program is parsed and validated, without a GPU.

use crate::deform::deformer::{Ability, DEFORM_CROWD_PASS, DEFORM_PASS};
use crate::deform::reversed::REVERSE_PASS;
use crate::frame::crowd_programs::crowd_vertices;
use crate::frame::programs::{
    NATURAL, NATURAL_STANDARDS, OCCLUSION_PASS, OUTLINE, PLAIN, PLAIN_STANDARDS, PREPASS, Programs,
    SCATTER_PASS, SEE_THROUGH, SHADOW_PASS, SKIN_LIGHT_PASS, Standards, TOON, TOON_STANDARDS,
};
use crate::frame::see_through::see_through_choices;
use crate::gpu::pipeline::OtherVertices;
use crate::gpu::program::{Constant, Program};
use crate::hair::programs::{
    COMPOSE_HAIR, COMPOSE_HAIR_DEPTH, GROW_PASS, HAIR_SHADOW_PASS, LAYERED_STRANDS, MASKED_STRANDS,
    STRAND_LAYERS, STRAND_SLICES, SWING_PASS, swinging,
};
use crate::model::effects::Effects;
use crate::view::config::RendererConfig;
use crate::view::shading::{Shading, Terms};

/// Every program.
fn all() -> Vec<Program> {
    let styles = [PLAIN, NATURAL, TOON];
    let of_style = |p: Programs| [p.skin, p.teeth, p.eyeball, p.skin_back, p.cornea];
    let passes = [
        OUTLINE,
        DEFORM_PASS,
        DEFORM_CROWD_PASS,
        REVERSE_PASS,
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
        SEE_THROUGH,
    ];
    let standards = [PLAIN_STANDARDS, NATURAL_STANDARDS, TOON_STANDARDS].into_iter().flat_map(Standards::all);
    styles.into_iter().flat_map(of_style).chain(passes).chain(standards).collect()
}

/// What a renderer of this shading and number of samples chooses for parts with these effects.
pub(crate) fn choices(shading: Shading, samples: u32, effects: Effects) -> Vec<Constant> {
    // One that encodes by itself, and one that does not.
    let color_format = match samples {
        1 => wgpu::TextureFormat::Rgba8Unorm,
        _ => wgpu::TextureFormat::Rgba8UnormSrgb,
    };
    let mut choices = RendererConfig { color_format, samples, shading }.choices();
    choices.extend(effects.choices());
    choices.push(swinging(samples == 1));
    choices.extend(see_through_choices(samples == 1, samples == 4));
    choices.extend(Ability { has_further_bones: samples == 4, is_uneven: samples == 4 }.choices());
    choices
}

/// Every program, and those that draw parts once more with the vertices of a crowd.
pub(crate) fn all_stages() -> impl Iterator<Item = (Program, OtherVertices)> {
    all().into_iter().flat_map(|program| {
        let own = OtherVertices { entry: program.entry, modules: &[] };
        [Some(own), crowd_vertices(program.entry)].into_iter().flatten().map(move |stage| (program, stage))
    })
}

/// The program with this vertex stage.
pub(crate) fn parsed(program: &Program, stage: OtherVertices, choices: &[Constant]) -> naga::Module {
    let source = program.source_with(choices, stage.modules);
    match naga::front::wgsl::parse_str(&source) {
        Ok(module) => module,
        Err(error) => panic!("{}: {}", program.label, error.emit_to_string(&source)),
    }
}

#[test]
fn every_program_parses_and_validates_without_optional_capabilities() {
    let natural = [Terms::NONE, Terms::LOW, Terms::MEDIUM, Terms::HIGH].map(Shading::Natural);
    for shading in natural.into_iter().chain([Shading::Plain, Shading::Toon]) {
        let grooves = Effects { is_recolored: false, ..Effects::ALL };
        let variants = [(1, Effects::NONE), (4, grooves), (1, Effects::COLORS), (4, Effects::ALL)];
        for choices in variants.map(|(samples, effects)| choices(shading, samples, effects)) {
            for (program, stage) in all_stages() {
                let module = parsed(&program, stage, &choices);
                let mut validator = naga::valid::Validator::new(
                    naga::valid::ValidationFlags::all(),
                    naga::valid::Capabilities::empty(),
                );
                if let Err(error) = validator.validate(&module) {
                    panic!(
                        "{}: {}",
                        program.label,
                        error.emit_to_string(&program.source_with(&choices, stage.modules))
                    );
                }
                for entry in [Some(stage.entry), program.fragment].into_iter().flatten() {
                    assert!(module.entry_points.iter().any(|e| e.name == entry), "{}", program.label);
                }
            }
        }
    }
}

#[test]
fn no_program_needs_more_bindings_than_webgpu_promises() {
    for (program, stage) in all_stages() {
        let module = parsed(&program, stage, &choices(Shading::Natural(Terms::HIGH), 1, Effects::ALL));
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
    for (program, stage) in all_stages() {
        for module in program.modules.iter().chain(stage.modules) {
            assert!(module.text.lines().count() <= 160, "{}: {:.60}", program.label, module.text);
        }
    }
}
