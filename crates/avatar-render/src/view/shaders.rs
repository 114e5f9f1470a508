//! WGSL modules that the programs of hair and of parts share.

use crate::gpu::program::{Module, Value};
use crate::view::lamps::{KEY_LAMP, LAMP_COUNT, RIM_LAMP, SHADOW_COUNT};
use crate::view::pores::PORE_CELLS;
use crate::view::uniforms::{TONE_AGX, TONE_NEUTRAL};

/// Group 0: what all avatars of a frame share.
pub(crate) const FRAME: Module = Module {
    text: include_str!("shaders/frame.wgsl"),
    constants: || {
        vec![
            ("LAMP_COUNT", Value::Count(LAMP_COUNT as u32)),
            ("KEY_LAMP", Value::Count(KEY_LAMP as u32)),
            ("RIM_LAMP", Value::Count(RIM_LAMP as u32)),
            ("SHADOW_COUNT", Value::Count(SHADOW_COUNT as u32)),
            ("PORE_CELLS", Value::Float(PORE_CELLS as f32)),
        ]
    },
};

/// Group 1 of all lit programs: shadow maps.
pub(crate) const SHADOW_MAPS: Module = Module::of(include_str!("shaders/shadow_maps.wgsl"));
/// Group 1 of programs that draw parts: the results of earlier passes.
pub(crate) const VIEW: Module = Module::of(include_str!("shaders/view.wgsl"));
/// Shadows of everything but hair.
pub(crate) const SHADOW: Module = Module::of(include_str!("shaders/shadow.wgsl"));
/// Shadows of hair.
pub(crate) const HAIR_SHADOW: Module = Module::of(include_str!("shaders/hair_shadow.wgsl"));
/// Light from the environment.
pub(crate) const AMBIENT: Module = Module::of(include_str!("shaders/ambient.wgsl"));
/// How surfaces reflect.
pub(crate) const BRDF: Module = Module::of(include_str!("shaders/brdf.wgsl"));

/// From light to the values of the target.
pub(crate) const OUTPUT: Module = Module {
    text: include_str!("shaders/output.wgsl"),
    constants: || vec![("TONE_NEUTRAL", Value::Count(TONE_NEUTRAL)), ("TONE_AGX", Value::Count(TONE_AGX))],
};
