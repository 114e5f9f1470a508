//! From a pack to what the renderer takes, the same for pictures and for the window.

use anyhow::{Result, anyhow};
use avatar_groom::Hair;
use avatar_mesh::{Bounds, PartKind};
use avatar_pack::{Pack, PartImages, Textures};
use avatar_render::{
    AvatarModel, Camera, HairError, Image, Light, PartBones, PartDesc, PartTextures, Scene, linear_from_srgb8,
};
use image::RgbaImage;

/// Samples per pixel, unless said otherwise.
pub(crate) const SAMPLES: u32 = 4;
/// Background in sRGB, opaque, unless said otherwise.
pub(crate) const BACKGROUND: [u8; 4] = [0x23, 0x27, 0x2e, 255];
/// Angle of view from top to bottom: long enough a lens not to distort a face.
const VERTICAL_FOV_DEGREES: f32 = 24.0;

/// At this share of the distance that shows a head its face fills the picture.
const FACE_DISTANCE: f32 = 0.7;

/// How much of the box's depth is taken into account where the distance is chosen.
const ROUNDNESS: f32 = 0.4;

/// Where the camera stands around the face.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct View {
    /// Around the vertical axis; 90 stands at the character's left.
    pub(crate) yaw_degrees: f32,
    /// Above the horizon.
    pub(crate) pitch_degrees: f32,
    /// Distance as a multiple of the one that shows what is framed.
    pub(crate) distance: f32,
    /// By how much the head is moved in the picture, to the right and up, in heights of the picture that shows what is framed.
    pub(crate) pan: [f32; 2],
    pub(crate) frame: Frame,
}

/// What fills the picture, where it is at bind pose.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Frame {
    Whole,
    /// The whole where the avatar is but a face with hair and neck.
    FaceOfBody,
    /// Near enough to see nothing else.
    Face,
    Part(usize),
}

impl View {
    pub(crate) const FRONT: Self =
        Self { yaw_degrees: 0.0, pitch_degrees: 0.0, distance: 1.0, pan: [0.0; 2], frame: Frame::Whole };
    pub(crate) const THREE_QUARTER: Self = Self { yaw_degrees: 35.0, ..Self::FRONT };
}

/// The picture's camera, light and background. `background` is sRGB with straight alpha.
pub(crate) fn scene(
    pack: &Pack,
    view: View,
    width: u32,
    height: u32,
    background: [u8; 4],
    light: Light,
) -> Scene {
    let (framed, nearer) = match (view.frame, pack.face()) {
        (Frame::Whole, _) | (Frame::FaceOfBody, None) => (None, 1.0),
        (Frame::FaceOfBody | Frame::Face, Some(face)) => (Some(face), 1.0),
        (Frame::Face, None) => (None, FACE_DISTANCE),
        (Frame::Part(part), _) => (pack.parts().get(part).and_then(|part| part.bounds), 1.0),
    };
    let bounds =
        framed.or_else(|| pack.bounds()).unwrap_or(Bounds { min: glam::Vec3::NEG_ONE, max: glam::Vec3::ONE });
    let aspect = width.max(1) as f32 / height.max(1) as f32;
    let fov = VERTICAL_FOV_DEGREES.to_radians();
    // The distance is that of the front view, so that the head does not grow and shrink as the camera goes round.
    let across = bounds.size().x.max(bounds.size().z);
    // A head is round: the corners of its box that are nearest to the camera are empty. Other files hold anything.
    let is_head = pack.motion().is_none() || framed == pack.face() && framed.is_some();
    let roundness = if is_head { ROUNDNESS } else { 1.0 };
    let half = glam::Vec3::new(across, bounds.size().y, across * roundness) / 2.0;
    let round = Bounds { min: bounds.center() - half, max: bounds.center() + half };
    let whole_head = nearer * Camera::frame(round, 0.0, 0.0, fov, aspect).eye().distance(bounds.center());
    let (yaw, pitch) = (view.yaw_degrees.to_radians(), view.pitch_degrees.to_radians());
    let straight = Camera::orbit(bounds.center(), whole_head * view.distance, yaw, pitch, fov, aspect);
    // What lies at the head's distance moves by these shares of the picture.
    let height = 2.0 * whole_head * (fov / 2.0).tan();
    let [right, up] = view.pan.map(|share| share * height);
    let aside = straight.world_from_camera.transform_vector3(glam::Vec3::new(right, up, 0.0));
    let camera = Camera::orbit(bounds.center() - aside, whole_head * view.distance, yaw, pitch, fov, aspect);
    Scene { camera, background: linear_from_srgb8(background), light }
}

/// Uploads the pack's meshes and textures, and plants this hair.
pub(crate) fn upload(
    pack: &Pack,
    textures: &Textures,
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    hair: Option<Hair>,
) -> Result<AvatarModel> {
    let image = |image: &RgbaImage| Image {
        width: image.width(),
        height: image.height(),
        rgba: image.as_raw().clone(),
    };
    let images: Vec<[Option<Image>; 5]> = (pack.parts().iter().enumerate())
        .map(|(index, part)| {
            let PartImages { color, occlusion, gloss, normal, thickness } =
                textures.of_part(index, part.kind);
            [color, occlusion, gloss, normal, thickness].map(|of| of.map(image))
        })
        .collect();
    let parts: Vec<PartDesc<'_>> = (pack.parts().iter().zip(&images))
        .map(|(part, [color, occlusion, gloss, normal, thickness])| PartDesc {
            label: &part.name,
            mesh: &part.mesh,
            first_weight: part.first_shape,
            kind: part.kind,
            bones: part.bone.map_or(PartBones::PerVertex, PartBones::Rigid),
            textures: PartTextures {
                color: color.as_ref(),
                occlusion: occlusion.as_ref(),
                gloss: gloss.as_ref(),
                normal: normal.as_ref(),
                thickness: thickness.as_ref(),
            },
        })
        .collect();
    let mut model = AvatarModel::new(device, queue, &parts, pack.palette().len())?;
    set_hair(pack, textures, &mut model, device, queue, hair)?;
    set_materials(pack, &model, queue)?;
    Ok(model)
}

/// Plants this hair, or takes it away. States of the model have to be made anew.
pub(crate) fn set_hair(
    pack: &Pack,
    textures: &Textures,
    model: &mut AvatarModel,
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    hair: Option<Hair>,
) -> Result<()> {
    let groom = hair.and_then(|hair| pack.groom(textures, &hair));
    let Some(skin) = pack.parts().iter().position(|part| part.kind == PartKind::Skin) else {
        return Ok(());
    };
    let density = hair.map_or(0.0, |hair| hair.density);
    model.set_hair(device, queue, skin, groom.as_ref().map(|(_, groom)| groom)).map_err(|error| match error {
        HairError::TooMany { found, limit } => anyhow!(
            "density of hair: expected a number from 0 to {:.2}, found {density}: {error}",
            density * limit as f32 / found.max(1) as f32
        ),
        other => other.into(),
    })
}

/// Gives the parts their looks.
///
/// # Errors
/// A model with fewer parts than the pack has.
pub(crate) fn set_materials(pack: &Pack, model: &AvatarModel, queue: &wgpu::Queue) -> Result<()> {
    for index in 0..pack.parts().len() {
        model.set_material(queue, index, &pack.material(index))?;
    }
    Ok(())
}
