use super::RawError;
use super::parts::Parts;
use crate::{Pack, Texture, Textures};
use avatar_look::Materials;
use avatar_mesh::{FACE_PARTS, PartKind};
use image::{ImageFormat, RgbaImage};
use std::io::Cursor;

/// The looks of the avatar's parts at the parts that they became.
pub(super) fn materials(pack: &Pack, parts: &Parts) -> Materials {
    let mut materials = pack.materials().clone();
    for (spec, look) in FACE_PARTS.iter().zip(&parts.looks) {
        let Some(index) = look else { continue };
        let part = &pack.parts()[*index];
        // Looks of a kind that it was not meant for would show what is not there.
        match part.material {
            Some(material) => materials.set(spec.name, material),
            None if part.name != spec.name => materials.set(spec.name, pack.material(*index)),
            None => {}
        }
    }
    materials
}

/// Adds the pictures as PNG.
pub(super) fn pictures(
    pack: &Pack,
    textures: &Textures,
    parts: &Parts,
    files: &mut Vec<(String, Vec<u8>)>,
    notes: &mut Vec<String>,
) -> Result<(), RawError> {
    let chosen = chosen(pack, textures, parts);
    for (texture, picture) in &chosen {
        let file = format!("{}.png", texture.stem());
        let mut bytes = Cursor::new(Vec::new());
        let written = picture.write_to(&mut bytes, ImageFormat::Png);
        written.map_err(|error| RawError::Picture { file: file.clone(), problem: error.to_string() })?;
        files.push((file, bytes.into_inner()));
    }
    for (index, part) in pack.parts().iter().enumerate() {
        let of_part = textures.of_part(index, part.kind);
        let named = [("colour", of_part.color), ("relief", of_part.normal), ("occlusion", of_part.occlusion)];
        for (what, picture) in named.into_iter().filter_map(|(what, picture)| Some((what, picture?))) {
            if !chosen.iter().any(|(_, other)| std::ptr::eq(*other, picture)) {
                notes.push(format!("part {:?}: the picture of its {what} is left out", part.name));
            }
        }
    }
    Ok(())
}

/// Each texture that there is: of a pack in the raw format its own, of any other avatar those of the parts
/// that give the looks.
fn chosen<'a>(pack: &Pack, textures: &'a Textures, parts: &Parts) -> Vec<(Texture, &'a RgbaImage)> {
    let mut chosen: Vec<(Texture, &RgbaImage)> = Vec::new();
    for (spec, look) in FACE_PARTS.iter().zip(&parts.looks) {
        let Some(part) = look.and_then(|index| Some((index, pack.parts().get(index)?))) else { continue };
        let of_part = textures.of_part(part.0, part.1.kind);
        let skin = spec.kind == PartKind::Skin;
        let color = match spec.kind {
            PartKind::Skin => Some(Texture::SkinColor),
            PartKind::Surface => Some(Texture::Teeth),
            PartKind::Eyeball => Some(Texture::Eye(0)),
            PartKind::Cornea => None,
        };
        let of_skin = |texture| skin.then_some(texture);
        for (texture, picture) in [
            (color, of_part.color),
            (of_skin(Texture::SkinOcclusion), of_part.occlusion),
            (of_skin(Texture::SkinGloss), of_part.gloss),
            (of_skin(Texture::SkinNormal), of_part.normal),
            (of_skin(Texture::SkinThickness), of_part.thickness),
        ] {
            let (Some(texture), Some(picture)) = (texture, picture) else { continue };
            if chosen.iter().all(|(other, _)| *other != texture) {
                chosen.push((texture, picture));
            }
        }
    }
    for texture in Texture::ALL {
        let is_new = chosen.iter().all(|(other, _)| *other != texture);
        chosen.extend(textures.get(texture).filter(|_| is_new).map(|picture| (texture, picture)));
    }
    chosen
}
