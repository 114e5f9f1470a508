//! The WGSL programs: text modules joined with constants that Rust owns, so that each fact stands once.

use crate::deformer::DEFORM_WORKGROUP_SIZE;
use crate::frame::LAMP_COUNT;
use crate::material::{COLOR_TEXTURE, GLOSS_TEXTURE, NORMAL_TEXTURE, OCCLUSION_TEXTURE};
use avatar_mesh::MIN_NORMAL_LENGTH;

/// A WGSL program: a pass and the shared modules that it calls.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Program {
    pub(crate) label: &'static str,
    pub(crate) entry: &'static str,
    modules: &'static [&'static str],
}

const AVATAR: &str = include_str!("shaders/shared/avatar.wgsl");
const PART: &str = include_str!("shaders/shared/part.wgsl");
const DEFORM: &str = include_str!("shaders/shared/deform.wgsl");
const FRAME: &str = include_str!("shaders/shared/frame.wgsl");
const VERTEX: &str = include_str!("shaders/shared/vertex.wgsl");
const MATERIAL: &str = include_str!("shaders/shared/material.wgsl");
const LIGHT: &str = include_str!("shaders/shared/light.wgsl");
const OUTPUT: &str = include_str!("shaders/shared/output.wgsl");

/// A program that draws a kind of part.
macro_rules! surface_program {
    ($label:literal, $file:literal, $entry:literal) => {
        Program {
            label: $label,
            entry: $entry,
            modules: &[
                FRAME,
                AVATAR,
                PART,
                DEFORM,
                VERTEX,
                MATERIAL,
                LIGHT,
                OUTPUT,
                include_str!(concat!("shaders/", $file)),
            ],
        }
    };
}

/// Entry point of the vertex stage of every program that draws a part.
pub(crate) const VERTEX_ENTRY: &str = "vertex_main";
/// Name of the pipeline constant that makes fragment stages encode their colours.
pub(crate) const ENCODE_SRGB: &str = "ENCODE_SRGB";

pub(crate) const SKIN: Program = surface_program!("skin", "skin.wgsl", "skin_main");
pub(crate) const SKIN_BACK: Program = surface_program!("skin back", "skin_back.wgsl", "skin_back_main");
pub(crate) const TEETH: Program = surface_program!("teeth", "teeth.wgsl", "teeth_main");
pub(crate) const EYEBALL: Program = surface_program!("eyeball", "eyeball.wgsl", "eyeball_main");
pub(crate) const CORNEA: Program = surface_program!("cornea", "cornea.wgsl", "cornea_main");
pub(crate) const DEFORM_PASS: Program = Program {
    label: "deform",
    entry: "deform_main",
    modules: &[AVATAR, PART, DEFORM, include_str!("shaders/deform_pass.wgsl")],
};

impl Program {
    /// The whole text.
    pub(crate) fn source(&self) -> String {
        let mut source = constants();
        for module in self.modules {
            source.push('\n');
            source.push_str(module);
        }
        source
    }

    pub(crate) fn module(&self, device: &wgpu::Device) -> wgpu::ShaderModule {
        device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some(self.label),
            source: wgpu::ShaderSource::Wgsl(self.source().into()),
        })
    }
}

fn constants() -> String {
    format!(
        "const MIN_NORMAL_LENGTH: f32 = {MIN_NORMAL_LENGTH:e};\n\
         const DEFORM_WORKGROUP_SIZE: u32 = {DEFORM_WORKGROUP_SIZE}u;\n\
         const LAMP_COUNT: u32 = {LAMP_COUNT}u;\n\
         const COLOR_TEXTURE: u32 = {COLOR_TEXTURE}u;\n\
         const OCCLUSION_TEXTURE: u32 = {OCCLUSION_TEXTURE}u;\n\
         const GLOSS_TEXTURE: u32 = {GLOSS_TEXTURE}u;\n\
         const NORMAL_TEXTURE: u32 = {NORMAL_TEXTURE}u;\n"
    )
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    pub(crate) const ALL: [Program; 6] = [SKIN, SKIN_BACK, TEETH, EYEBALL, CORNEA, DEFORM_PASS];

    pub(crate) fn parsed(program: &Program) -> naga::Module {
        let source = program.source();
        match naga::front::wgsl::parse_str(&source) {
            Ok(module) => module,
            Err(error) => panic!("{}: {}", program.label, error.emit_to_string(&source)),
        }
    }

    #[test]
    fn every_program_parses_and_validates_without_optional_capabilities() {
        for program in ALL {
            let module = parsed(&program);
            let mut validator = naga::valid::Validator::new(
                naga::valid::ValidationFlags::all(),
                naga::valid::Capabilities::empty(),
            );
            if let Err(error) = validator.validate(&module) {
                panic!("{}: {}", program.label, error.emit_to_string(&program.source()));
            }
            assert!(module.entry_points.iter().any(|entry| entry.name == program.entry), "{}", program.label);
        }
    }

    #[test]
    fn no_program_needs_more_bindings_than_webgpu_promises() {
        for program in ALL {
            let module = parsed(&program);
            let storage = module
                .global_variables
                .iter()
                .filter(|(_, variable)| matches!(variable.space, naga::AddressSpace::Storage { .. }));
            let groups = module.global_variables.iter().filter_map(|(_, v)| v.binding).map(|b| b.group);
            assert!(storage.count() <= 8, "{}", program.label);
            assert!(groups.max().unwrap_or(0) < 4, "{}", program.label);
        }
    }
}
