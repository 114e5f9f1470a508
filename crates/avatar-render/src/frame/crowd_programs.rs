//! The vertex stages of crowds: programs that draw a part of one avatar draw that of many, an avatar an
//! instance, with vertices from the buffer of all.

use crate::deform::crowd_chunk::CROWD_CHUNK;
use crate::deform::reversed::DEFORMED;
use crate::gpu::pipeline::OtherVertices;
use crate::gpu::program::Module;

macro_rules! module {
    ($file:literal) => {
        Module::of(include_str!(concat!("shaders/crowd/", $file, ".wgsl")))
    };
}

const POSED: Module = module!("posed");
const VERTEX: Module = module!("vertex");

/// A stage of passes that draw parts.
macro_rules! of_parts {
    ($entry:literal, $file:literal) => {{
        const MODULES: &[Module] = &[DEFORMED, CROWD_CHUNK, POSED, VERTEX, module!($file)];
        OtherVertices { entry: $entry, modules: MODULES }
    }};
}

/// A stage that reads nothing but positions.
macro_rules! of_shadows {
    ($entry:literal, $file:literal) => {{
        const MODULES: &[Module] = &[DEFORMED, CROWD_CHUNK, POSED, module!($file)];
        OtherVertices { entry: $entry, modules: MODULES }
    }};
}

/// What draws for a crowd what this vertex stage draws for one avatar; `None` if it draws no parts.
pub(crate) fn crowd_vertices(entry: &str) -> Option<OtherVertices> {
    Some(match entry {
        "vertex_main" => of_parts!("crowd_main", "part"),
        "eye_vertex_main" => of_parts!("crowd_eye_main", "eye"),
        "outline_vertex_main" => of_parts!("crowd_outline_main", "outline"),
        "standard_main" => of_parts!("crowd_standard_main", "standard"),
        "standard_extra_main" => of_parts!("crowd_standard_extra_main", "standard"),
        "part_outline_main" => of_parts!("crowd_part_outline_main", "part_outline"),
        "part_outline_extra_main" => of_parts!("crowd_part_outline_extra_main", "part_outline"),
        "shadow_main" => of_shadows!("crowd_shadow_main", "shadow"),
        "cut_shadow_main" => of_shadows!("crowd_cut_shadow_main", "cut_shadow"),
        "cut_shadow_extra_main" => of_shadows!("crowd_cut_shadow_extra_main", "cut_shadow"),
        _ => return None,
    })
}
