//! Readers of interchange formats.

use crate::exercise::{exercise, within_memory};
use crate::packed::{PIXEL, files, glb_of, text_and_bytes};
use avatar_exchange::vrm::{Gaze, LookAtKind, expression_weights};
use avatar_exchange::{ImportError, Resolve, Scene, TextFile, read};
use avatar_pack::{Import, gaze_values};

/// What names of pictures end in.
const PICTURES: [&str; 6] = [".png", ".jpg", ".jpeg", ".tga", ".bmp", ".webp"];

fn resolver<'a>(other: &'a [u8]) -> impl FnMut(&str) -> Result<Vec<u8>, String> + 'a {
    move |name| {
        let is_picture = PICTURES.iter().any(|ending| name.ends_with(ending));
        Ok(if is_picture { PIXEL.to_vec() } else { other.to_vec() })
    }
}

fn check(result: Result<Scene, ImportError>, input: usize) {
    match result {
        Ok(scene) => exercise(scene, input),
        Err(error) => check_error(&error),
    }
}

/// An error says where, what and what instead, and is no longer than one wants to read.
fn check_error(error: &ImportError) {
    let texts = [&error.file, &error.place, &error.expected, &error.found];
    assert!(texts.iter().all(|text| !text.is_empty()), "an error without a place: {error:?}");
    let length = error.to_string().chars().count();
    assert!(length < 4096, "an error of {length} characters");
}

fn read_any(name: &str, bytes: &[u8], further: &[TextFile<'_>], resolve: &mut Resolve<'_>, input: usize) {
    check(within_memory(input, "the reader", || read(name, bytes, further, resolve)), input);
}

/// glTF as JSON; whatever it refers to has the bytes behind the separator.
pub fn gltf(data: &[u8]) {
    let (json, bin) = text_and_bytes(data);
    read_any("a.gltf", json, &[], &mut resolver(bin), data.len());
}

/// GLB: JSON, separator, the other chunk. The lengths are put right here. An input that begins as a GLB is
/// taken as it is.
pub fn glb(data: &[u8]) {
    if data.starts_with(b"glTF") {
        return read_any("a.glb", data, &[], &mut resolver(&[]), data.len());
    }
    let (json, bin) = text_and_bytes(data);
    read_any("a.glb", &glb_of(json, bin), &[], &mut resolver(&[]), data.len());
}

/// VRM, packed as for [`glb`]: also its expressions and its gaze.
pub fn vrm(data: &[u8]) {
    let (json, bin) = text_and_bytes(data);
    let bytes = glb_of(json, bin);
    let model = within_memory(data.len(), "the reader", || {
        avatar_exchange::vrm::read("a.vrm", &bytes, &mut resolver(&[]))
    });
    let model = match model {
        Ok(model) => model,
        Err(error) => return check_error(&error),
    };
    let names: Vec<(&str, f32)> =
        model.vrm.expressions.iter().map(|expression| (expression.name.as_str(), 0.75)).collect();
    expression_weights(&model.vrm, &names).apply(&mut model.scene.rest());
    for (yaw_deg, pitch_deg) in [(0.0, 0.0), (200.0, -95.0), (f32::NAN, f32::INFINITY)] {
        let gaze = Gaze { yaw_deg, pitch_deg };
        if let Some(look_at) = &model.vrm.look_at {
            let _ = look_at.eyes(gaze).left.rotation();
            match look_at.kind {
                LookAtKind::Expression => drop(look_at.expressions(gaze)),
                _ => drop(gaze_values(look_at, gaze)),
            }
        }
    }
    let scene = model.scene.clone();
    if let Ok(import) = within_memory(data.len(), "the import", || Import::from_vrm(model)) {
        crate::exercise::act(&import.pack, &import.textures);
    }
    exercise(scene, data.len());
}

/// OBJ, its MTL, and further OBJ files: the next frames of a sequence.
pub fn obj(data: &[u8]) {
    let mut files = files(data);
    let first = files.next().unwrap_or_default();
    let materials = files.next().unwrap_or_default();
    let frames: Vec<_> = files.map(|bytes| TextFile { file: "b.obj", bytes }).collect();
    read_any("a.obj", first, &frames, &mut resolver(materials), data.len());
}

/// OBJ and MakeHuman targets of it.
pub fn target(data: &[u8]) {
    let mut files = files(data);
    let first = files.next().unwrap_or_default();
    let targets: Vec<_> = files.map(|bytes| TextFile { file: "b.target", bytes }).collect();
    read_any("a.obj", first, &targets, &mut resolver(&[]), data.len());
}

/// FBX, binary or text.
pub fn fbx(data: &[u8]) {
    read_any("a.fbx", data, &[], &mut resolver(&[]), data.len());
}

/// COLLADA.
pub fn collada(data: &[u8]) {
    read_any("a.dae", data, &[], &mut resolver(&[]), data.len());
}

/// MD5 mesh and its animations.
pub fn md5(data: &[u8]) {
    let mut files = files(data);
    let first = files.next().unwrap_or_default();
    let animations: Vec<_> = files.map(|bytes| TextFile { file: "b.md5anim", bytes }).collect();
    read_any("a.md5mesh", first, &animations, &mut resolver(&[]), data.len());
}

/// Biovision hierarchies.
pub fn bvh(data: &[u8]) {
    read_any("a.bvh", data, &[], &mut resolver(&[]), data.len());
}
