use avatar_look::{Alpha, Colors};
use avatar_pack::{Pack, PartImages, Textures};
use avatar_render::avatar_groom::{Groom, Hair};
use avatar_render::avatar_mesh::PartKind;
use avatar_render::{
    AvatarModel, HairError, Image, ModelError, NoSuchPart, PartBones, PartDesc, PartTextures, Wrinkles, wgpu,
};
use image::RgbaImage;

/// Why a pack cannot be uploaded.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum UploadError {
    /// A part, a picture or the number of bones is not what the renderer takes.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// More strands of hair than the device can hold.
    #[error("density of hair: expected a number from 0 to {most:.2}, found {found}: {error}")]
    HairDensity {
        /// The density that the device can hold, about.
        most: f32,
        /// The density that was asked for.
        found: f32,
        /// What the renderer says of it.
        error: HairError,
    },
    /// Another reason why the hair cannot be planted.
    #[error(transparent)]
    Hair(#[from] HairError),
    /// The model has fewer parts than the pack: it was made from another one.
    #[error(transparent)]
    Part(#[from] NoSuchPart),
}

/// Uploads the pack's meshes, textures and materials, and plants its hair where it has some ([`Pack::hair`]).
/// The model serves any number of faces.
///
/// # Errors
/// Meshes, textures or hair that this device cannot hold.
pub fn upload(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    pack: &Pack,
    textures: &Textures,
) -> Result<AvatarModel, UploadError> {
    upload_with_hair(device, queue, pack, textures, pack.hair())
}

/// As [`upload`], with this hair instead of the pack's own; `None` for a bald head.
///
/// # Errors
/// As [`upload`].
pub fn upload_with_hair(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    pack: &Pack,
    textures: &Textures,
    hair: Option<&Hair>,
) -> Result<AvatarModel, UploadError> {
    // Several parts may share a picture, which is copied once; twice where some of them ignore its alpha.
    let mut images = Images::default();
    let places = pack.wrinkles();
    let of_parts: Vec<[Option<usize>; 9]> = (pack.parts().iter().enumerate())
        .map(|(index, part)| {
            let pictures = textures.of_part(index, part.kind);
            let is_opaque = pack.material(index).standard.is_some_and(|look| look.alpha == Alpha::Opaque);
            let color = pictures.color.map(|picture| images.take(picture, is_opaque));
            let PartImages {
                occlusion,
                gloss,
                normal,
                thickness,
                wrinkles,
                metallic_roughness,
                emissive,
                shade,
                ..
            } = pictures;
            let others = [occlusion, gloss, normal, thickness, wrinkles, metallic_roughness, emissive, shade];
            let [occlusion, gloss, normal, thickness, wrinkles, metallic_roughness, emissive, shade] =
                others.map(|picture| picture.map(|picture| images.take(picture, false)));
            [color, occlusion, gloss, normal, thickness, wrinkles, metallic_roughness, emissive, shade]
        })
        .collect();
    let parts: Vec<PartDesc<'_>> = (pack.parts().iter().zip(&of_parts).enumerate())
        .map(|(index, (part, pictures))| {
            let [color, occlusion, gloss, normal, thickness, wrinkles, metallic_roughness, emissive, shade] =
                pictures.map(|place| place.and_then(|place| images.copies.get(place)));
            PartDesc {
                label: &part.name,
                mesh: &part.mesh,
                first_weight: part.first_shape,
                kind: part.kind,
                bones: part.bone.map_or(PartBones::PerVertex, PartBones::Rigid),
                textures: PartTextures {
                    color,
                    occlusion,
                    gloss,
                    normal,
                    thickness,
                    wrinkles: wrinkles.map(|depths| Wrinkles { depths, places: &places }),
                    metallic_roughness,
                    emissive,
                    shade,
                    wraps: textures.of_part(index, part.kind).wraps,
                },
            }
        })
        .collect();
    let mut model = AvatarModel::new(device, queue, &parts, pack.palette().len())?;
    if let Some(head) = pack.head() {
        model.set_height(head.size().y);
    }
    set_hair(device, queue, pack, textures, &mut model, hair)?;
    set_materials(queue, pack, &model)?;
    Ok(model)
}

/// Pictures as the renderer takes them.
#[derive(Default)]
struct Images<'a> {
    /// Of each copy the picture, and whether its alpha was taken away.
    sources: Vec<(&'a RgbaImage, bool)>,
    copies: Vec<Image>,
}

impl<'a> Images<'a> {
    /// The place of a picture's copy. `is_opaque` takes away its alpha: what is ignored there must not weight
    /// colours either where the picture is seen from far away.
    fn take(&mut self, picture: &'a RgbaImage, is_opaque: bool) -> usize {
        let is_changed = is_opaque && picture.pixels().any(|pixel| pixel.0[3] < 255);
        let same = |source: &(&RgbaImage, bool)| std::ptr::eq(source.0, picture) && source.1 == is_changed;
        if let Some(known) = self.sources.iter().position(same) {
            return known;
        }
        let mut rgba = picture.as_raw().clone();
        if is_changed {
            rgba.iter_mut().skip(3).step_by(4).for_each(|alpha| *alpha = 255);
        }
        self.sources.push((picture, is_changed));
        self.copies.push(Image { width: picture.width(), height: picture.height(), rgba });
        self.copies.len() - 1
    }
}

/// Plants this hair, or takes it away. An [`avatar_render::AvatarState`] that was made before does not fit
/// the model any more: make it anew.
///
/// # Errors
/// More strands than the device can hold; the model keeps its hair then.
pub fn set_hair(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    pack: &Pack,
    textures: &Textures,
    model: &mut AvatarModel,
    hair: Option<&Hair>,
) -> Result<(), UploadError> {
    let groom = hair.and_then(|hair| pack.groom(textures, hair));
    set_groom(device, queue, pack, model, hair, groom.as_ref().map(|(_, groom)| groom))
}

/// As [`set_hair`], with what [`Pack::groom`] has planted of this hair: on another thread, for example, while
/// the model is uploaded.
///
/// # Errors
/// As [`set_hair`].
pub fn set_groom(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    pack: &Pack,
    model: &mut AvatarModel,
    hair: Option<&Hair>,
    groom: Option<&Groom>,
) -> Result<(), UploadError> {
    let Some(skin) = pack.parts().iter().position(|part| part.kind == PartKind::Skin) else {
        return Ok(());
    };
    let density = hair.map_or(0.0, |hair| hair.density);
    model.set_hair(device, queue, skin, groom).map_err(|error| match error {
        HairError::TooMany { found, limit } => UploadError::HairDensity {
            most: density * limit as f32 / found.max(1) as f32,
            found: density,
            error,
        },
        other => other.into(),
    })
}

/// Gives the parts the materials that the pack has now.
///
/// # Errors
/// A model with fewer parts than the pack has.
pub fn set_materials(queue: &wgpu::Queue, pack: &Pack, model: &AvatarModel) -> Result<(), UploadError> {
    set_colors(queue, pack, model, &Colors::default())
}

/// Gives the parts the materials that the pack has now, in these colours.
///
/// # Errors
/// A model with fewer parts than the pack has.
pub fn set_colors(
    queue: &wgpu::Queue,
    pack: &Pack,
    model: &AvatarModel,
    colors: &Colors,
) -> Result<(), UploadError> {
    for (index, part) in pack.parts().iter().enumerate() {
        model.set_material(queue, index, &colors.over(part.kind, pack.material(index)))?;
    }
    Ok(())
}
