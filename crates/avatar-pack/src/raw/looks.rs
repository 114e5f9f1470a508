use super::RawError;
use super::parts::Parts;
use crate::{Pack, Texture, Textures};
use avatar_look::{Alpha, Lighting, Materials, Standard};
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
    for (texture, picture, tint) in &chosen {
        let file = format!("{}.png", texture.stem());
        let mut bytes = Cursor::new(Vec::new());
        let written = match tint {
            Some(tint) => tinted((*picture).clone(), *tint).write_to(&mut bytes, ImageFormat::Png),
            None => picture.write_to(&mut bytes, ImageFormat::Png),
        };
        written.map_err(|error| RawError::Picture { file: file.clone(), problem: error.to_string() })?;
        files.push((file, bytes.into_inner()));
    }
    for (index, part) in pack.parts().iter().enumerate() {
        let of_part = textures.of_part(index, part.kind);
        let named = [
            ("colour", of_part.color),
            ("relief", of_part.normal),
            ("occlusion", of_part.occlusion),
            ("roughness and metalness", of_part.metallic_roughness),
            ("light that it gives off", of_part.emissive),
            ("shade", of_part.shade),
        ];
        for (what, picture) in named.into_iter().filter_map(|(what, picture)| Some((what, picture?))) {
            if !chosen.iter().any(|(_, other, _)| std::ptr::eq(*other, picture)) {
                notes.push(format!("part {:?}: the picture of its {what} is left out", part.name));
            }
        }
        let standard = pack.material(index).standard;
        for left_out in standard.iter().flat_map(left_out) {
            notes.push(format!("part {:?}: {left_out} left out", part.name));
        }
    }
    Ok(())
}

/// What the raw format has no words for.
fn left_out(look: &Standard) -> impl Iterator<Item = &'static str> {
    let said = [
        (look.alpha != Alpha::Opaque, "its transparency is"),
        (look.metallic > 0.5, "that it is a metal is"),
        (look.emissive != [0.0; 3], "the light that it gives off is"),
        (look.lighting != Lighting::Lit, "that it is drawn without shades, or as a cartoon, is"),
    ];
    said.into_iter().filter_map(|(is_said, what)| is_said.then_some(what))
}

/// The picture times a colour, both in linear light, and opaque: textures of the raw format lie over the
/// material's colour.
fn tinted(mut image: RgbaImage, [r, g, b, _]: [f32; 4]) -> RgbaImage {
    for (channel, factor) in
        [r, g, b].into_iter().enumerate().filter(|(_, factor)| (factor - 1.0).abs() > 1e-3)
    {
        // The encoded product to within what eight bits tell: sRGB is nearly a power of 2.2.
        let encoded = factor.max(0.0).powf(1.0 / 2.2);
        image.pixels_mut().for_each(|pixel| {
            pixel.0[channel] = (f32::from(pixel.0[channel]) * encoded).round().min(255.0) as u8;
        });
    }
    image.pixels_mut().for_each(|pixel| pixel.0[3] = 255);
    image
}

/// A texture, its picture, and the colour that it is multiplied by.
type Chosen<'a> = (Texture, &'a RgbaImage, Option<[f32; 4]>);

/// Each texture that there is: of a pack in the raw format its own, of any other avatar those of the parts
/// that give the looks.
fn chosen<'a>(pack: &Pack, textures: &'a Textures, parts: &Parts) -> Vec<Chosen<'a>> {
    let mut chosen: Vec<Chosen<'_>> = Vec::new();
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
        let standard = pack.material(part.0).standard;
        let tint = |texture| standard.filter(|_| texture == color).map(|look| look.base_color);
        for (texture, picture) in [
            (color, of_part.color),
            (of_skin(Texture::SkinOcclusion), of_part.occlusion),
            (of_skin(Texture::SkinGloss), of_part.gloss),
            (of_skin(Texture::SkinNormal), of_part.normal),
            (of_skin(Texture::SkinThickness), of_part.thickness),
        ] {
            let tint = tint(texture);
            let (Some(texture), Some(picture)) = (texture, picture) else { continue };
            if chosen.iter().all(|(other, ..)| *other != texture) {
                chosen.push((texture, picture, tint));
            }
        }
    }
    for texture in Texture::ALL {
        let is_new = chosen.iter().all(|(other, ..)| *other != texture);
        chosen.extend(textures.get(texture).filter(|_| is_new).map(|picture| (texture, picture, None)));
    }
    chosen
}
