//! Reads a face in the raw format and saves a sheet of pictures, or a single large one:
//! `cargo run --release -p avatar-render --example raw_face -- FOLDER OUT.png [NUMBER OF THE PICTURE]`.
#![allow(clippy::disallowed_methods, reason = "a program: it reads files and its arguments")]

use avatar_mesh::{Bounds, FACE_BONES, FACE_PARTS, Follows, Mesh, PartKind, raw};
use avatar_render::headless::{Canvas, GpuOptions, open_blocking};
use avatar_render::{
    AvatarModel, AvatarState, Camera, Image, Light, PartBones, PartDesc, PartTextures, Quality, Scene, Style,
};
use glam::Affine3A;
use rig_core::{Axis, Elementary, JointId, Rig};
use std::error::Error;
use std::path::Path;

/// Joint, local axis, degrees.
type Turn = (&'static str, Axis, f32);

const JAW_OPEN: &[Turn] = &[("JawJoint", Axis::Z, -18.0)];
const LIDS_CLOSED: &[Turn] = &[
    ("LtUpperLidJoint", Axis::Z, -32.0),
    ("RtUpperLidJoint", Axis::Z, -32.0),
    ("LtLowerLidJoint", Axis::Z, 6.0),
    ("RtLowerLidJoint", Axis::Z, 6.0),
];
const LOOK: &[Turn] = &[
    ("HeadJoint", Axis::X, 20.0),
    ("HeadJoint", Axis::Y, -8.0),
    ("LtEyeJoint", Axis::Y, -22.0),
    ("RtEyeJoint", Axis::Y, -22.0),
];

/// Name, yaw and pitch of the camera in degrees, turns, weights of smile and frown.
type Picture = (&'static str, f32, f32, &'static [Turn], [f32; 2]);

const PICTURES: [Picture; 8] = [
    ("front", 0.0, 0.0, &[], [0.0, 0.0]),
    ("three-quarter", 40.0, 10.0, &[], [0.0, 0.0]),
    ("left side", 90.0, 0.0, &[], [0.0, 0.0]),
    ("smile", 15.0, 0.0, &[], [1.0, 0.0]),
    ("jaw open", 10.0, 0.0, JAW_OPEN, [0.0, 0.0]),
    ("lids closed", 0.0, 0.0, LIDS_CLOSED, [0.0, 1.0]),
    ("looking", 0.0, 0.0, LOOK, [0.6, 0.0]),
    ("back, from below", 160.0, -20.0, &[], [0.0, 0.0]),
];

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [folder, out, rest @ ..] = arguments.as_slice() else {
        return Err("usage: raw_face FOLDER OUT.png [NUMBER OF THE PICTURE]".into());
    };
    let folder = Path::new(folder);
    let gpu = open_blocking(GpuOptions::default())?;
    println!("{} ({:?})", gpu.info.name, gpu.info.backend);

    let (rig, palette) = load_rig(folder)?;
    let meshes: Vec<Mesh> =
        FACE_PARTS.iter().map(|part| load_mesh(folder, part.stem, part.kind)).collect::<Result<_, _>>()?;
    let bounds = meshes.iter().filter_map(Mesh::bounds).reduce(Bounds::union).ok_or("no vertices")?;
    let load = |name| load_image(&folder.join(name));
    let (eye_color, teeth_color) = (load("EyeTex_Decal00.png"), load("TeethTex_Decal.png"));
    let (skin_color, skin_occlusion, skin_gloss) =
        (load("SkinTex_Decal.png"), load("SkinTex_AO.png"), load("SkinTex_Gloss.png"));
    let parts: Vec<PartDesc<'_>> = FACE_PARTS
        .iter()
        .zip(&meshes)
        .map(|(part, mesh)| PartDesc {
            label: part.name,
            mesh,
            first_weight: 0,
            kind: part.kind,
            bones: match part.follows {
                Follows::Bones => PartBones::PerVertex,
                Follows::Joint(joint) => {
                    PartBones::Rigid(FACE_BONES.iter().position(|bone| *bone == joint).unwrap_or(0))
                }
            },
            textures: match part.kind {
                PartKind::Skin => PartTextures {
                    color: skin_color.as_ref(),
                    occlusion: skin_occlusion.as_ref(),
                    gloss: skin_gloss.as_ref(),
                    ..PartTextures::default()
                },
                PartKind::Surface => PartTextures { color: teeth_color.as_ref(), ..PartTextures::default() },
                PartKind::Eyeball => PartTextures { color: eye_color.as_ref(), ..PartTextures::default() },
                PartKind::Cornea => PartTextures::default(),
            },
        })
        .collect();
    let model = AvatarModel::new(&gpu.device, &gpu.queue, &parts, FACE_BONES.len())?;
    let mut state = AvatarState::new(&gpu.device, &model);

    let single = rest.first().map(|number| number.parse::<usize>()).transpose()?;
    let size = if single.is_some() { 1000 } else { 480 };
    let canvas = Canvas::new(&gpu, size, size, 4, Quality::of_adapter(&gpu.info).shading(Style::Natural))?;
    let mut pose = rig.pose();
    let mut bones = [Affine3A::IDENTITY; FACE_BONES.len()];
    let mut sheet = image::RgbaImage::new(if single.is_some() { size } else { 4 * size }, 2 * size);
    for (i, (name, yaw, pitch, turns, weights)) in PICTURES.iter().enumerate() {
        if single.is_some_and(|single| single != i) {
            continue;
        }
        let mut locals = rig.locals();
        for (joint, axis, degrees) in *turns {
            let joint = rig.joint(joint).ok_or(*joint)?;
            let turn = Elementary::rotation(*axis, degrees.to_radians()).matrix();
            locals.as_mut_slice()[joint.index()] *= turn;
        }
        rig.update(locals.as_slice(), &mut pose)?;
        pose.gather(&palette, &mut bones)?;
        state.set(&gpu.queue, &bones, weights)?;
        let scene = Scene {
            camera: Camera::frame(bounds, yaw.to_radians(), pitch.to_radians(), 0.45, 1.0),
            background: [0.03, 0.035, 0.045, 1.0],
            light: Light::default(),
        };
        let picture = canvas.render(&gpu, &scene, &[(&model, &state)])?;
        println!("{name}");
        let picture = image::RgbaImage::from_raw(size, size, picture.rgba).ok_or("size")?;
        let at = if single.is_some() { (0, 0) } else { (i as u32 % 4 * size, i as u32 / 4 * size) };
        image::imageops::replace(&mut sheet, &picture, at.0.into(), at.1.into());
    }
    if single.is_some() {
        sheet = image::imageops::crop_imm(&sheet, 0, 0, size, size).to_image();
    }
    sheet.save(out)?;
    Ok(())
}

fn load_rig(folder: &Path) -> Result<(Rig, Vec<JointId>), Box<dyn Error>> {
    let names = ["Transformations.xml", "Transformationen.xml"].map(|name| folder.join(name));
    let path = names.iter().find(|path| path.exists()).ok_or("no Transformations.xml")?;
    let rig = Rig::from_xml(&std::fs::read(path)?)?;
    let palette: Option<Vec<_>> = FACE_BONES.iter().map(|name| rig.joint(name)).collect();
    Ok((rig, palette.ok_or("a joint is missing")?))
}

fn load_mesh(folder: &Path, stem: &str, kind: PartKind) -> Result<Mesh, Box<dyn Error>> {
    let vertices = std::fs::read(folder.join(format!("{stem}_VB.raw")))?;
    let indices = std::fs::read(folder.join(format!("{stem}_IB.raw")))?;
    let mut mesh = match kind {
        PartKind::Skin => raw::read_skin(&vertices, &indices)?,
        _ => raw::read_rigid(&vertices, &indices)?,
    };
    mesh.validate(FACE_BONES.len())?;
    Ok(mesh)
}

fn load_image(path: &Path) -> Option<Image> {
    let picture = image::open(path).ok()?.to_rgba8();
    Some(Image { width: picture.width(), height: picture.height(), rgba: picture.into_raw() })
}
