//! The functions that fuzzing calls with bytes of any kind, one for each kind of input. None of them may
//! panic, hang, or take more memory than its input is worth; where a text can be written back, it has to say
//! the same.
//!
//! ```text
//!  libFuzzer ─▶ fuzz_targets/NAME.rs ─▶ NAME(bytes) ─▶ a reader ─▶ exercise: pose, import, write, read
//!  corpus, regressions ─▶ tests/tests/fuzz.rs ─┘
//! ```
//!
//! Several files are packed into one input with [`SEPARATOR`] between them, a byte that no text format uses.
#![forbid(unsafe_code)]

mod exercise;
mod hearing;
mod faces;
mod live;
mod mutate;
mod packed;
mod scenes;
mod sound;
mod speech;
mod texts;

pub use faces::faces;
pub use hearing::hearing;
pub use live::live;
pub use mutate::mutate_json;
pub use packed::{SEPARATOR, glb_of};
pub use scenes::{bvh, collada, fbx, glb, gltf, md5, obj, target, vrm};
pub use sound::sound;
pub use speech::speech;
pub use texts::{clips, controls, hair, identity, materials, pack, picture, poses, rig, shapes, springs};

/// What a target does with an input.
pub type Run = fn(&[u8]);

/// All targets by their names, which are also those of their folders in `corpus` and `regressions`.
pub const TARGETS: [(&str, Run); 25] = [
    ("gltf", gltf),
    ("glb", glb),
    ("vrm", vrm),
    ("obj", obj),
    ("target", target),
    ("fbx", fbx),
    ("collada", collada),
    ("md5", md5),
    ("bvh", bvh),
    ("rig", rig),
    ("controls", controls),
    ("poses", poses),
    ("clips", clips),
    ("materials", materials),
    ("hair", hair),
    ("shapes", shapes),
    ("identity", identity),
    ("springs", springs),
    ("pack", pack),
    ("picture", picture),
    ("speech", speech),
    ("faces", faces),
    ("sound", sound),
    ("hearing", hearing),
    ("live", live),
];
