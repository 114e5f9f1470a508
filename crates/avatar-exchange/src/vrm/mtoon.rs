//! Cartoon looks: the extension `VRMC_materials_mtoon` 1.0,
//! <https://github.com/vrm-c/vrm-specification/tree/master/specification/VRMC_materials_mtoon-1.0>.

use super::note;
use super::place::Place;
use crate::scene::{Finding, ImportError, RawScene, TextureRef, ToonMaterial};
use serde_json::{Map, Value};

/// The name of the extension.
pub(super) const EXTENSION: &str = "VRMC_materials_mtoon";

/// The one texture of the extension that is read, whose coordinates the reader of glTF has to keep.
pub(super) const SHADE_TEXTURE: (&str, &str) = (EXTENSION, "shadeMultiplyTexture");

/// An extension of betas of VRM 1.0: a factor on the light that a surface gives off.
pub(super) const EMISSION: &str = "VRMC_materials_hdr_emissiveMultiplier";

/// What the extension can say and [`ToonMaterial`] does not hold, each with the value at which it changes
/// nothing.
const OTHERS: [(&str, &str); 13] = [
    ("shadingShiftTexture", "null"),
    ("matcapTexture", "null"),
    ("parametricRimColorFactor", "[0.0,0.0,0.0]"),
    ("rimMultiplyTexture", "null"),
    ("outlineWidthMultiplyTexture", "null"),
    ("outlineLightingMixFactor", "0.0"),
    ("uvAnimationMaskTexture", "null"),
    ("uvAnimationScrollXSpeedFactor", "0.0"),
    ("uvAnimationScrollYSpeedFactor", "0.0"),
    ("uvAnimationRotationSpeedFactor", "0.0"),
    ("transparentWithZWrite", "false"),
    ("renderQueueOffsetNumber", "0.0"),
    ("giEqualizationFactor", "0.9"),
];

/// Fills in [`crate::scene::Material::toon`]. `extensions` are those of each material, `textures` the image
/// of each texture, `shades` the texture of each material's shade.
pub(super) fn read(
    extensions: &[Map<String, Value>],
    textures: &[Option<usize>],
    shades: &[Option<TextureRef>],
    raw: &mut RawScene,
) -> Result<(), ImportError> {
    for (material, extension) in extensions.iter().enumerate().take(raw.materials.len()) {
        if let Some(value) = extension.get(EMISSION) {
            let place = Place::new(value, &format!("material {material}, {EMISSION}"));
            let factor = place.clamped("emissiveMultiplier", 1.0, 0.0..=f32::MAX, raw)?;
            let brighter = raw.materials[material].emissive.map(|light| light * factor);
            if !brighter.iter().all(|light| light.is_finite()) {
                return Err(place.wrong("a factor that leaves a finite light"));
            }
            raw.materials[material].emissive = brighter;
        }
        let Some(value) = extension.get(EXTENSION) else { continue };
        let place = Place::new(value, &format!("material {material}, {EXTENSION}"));
        let shade = shades.get(material).copied().flatten();
        let toon = toon(&place, textures.len(), shade, raw)?;
        raw.materials[material].toon = Some(toon);
        // It stands there for programs that do not know the extension.
        raw.materials[material].is_unlit = false;
    }
    Ok(())
}

fn toon(
    place: &Place<'_>,
    textures: usize,
    shade_texture: Option<TextureRef>,
    raw: &mut RawScene,
) -> Result<ToonMaterial, ImportError> {
    place.version_1("specVersion")?;
    let rest = ToonMaterial::default();
    let width = place.clamped("outlineWidthFactor", rest.outline_width, 0.0..=f32::MAX, raw)?;
    let mode = place.text("outlineWidthMode")?;
    let outline_width = match mode.as_str() {
        "" | "none" => 0.0,
        "worldCoordinates" => width,
        "screenCoordinates" => {
            if width > 0.0 {
                let text = "an outline of constant width on the screen is not represented";
                note(raw, place.path(), Finding::left_out(text));
            }
            0.0
        }
        _ => {
            let expected = "none, worldCoordinates or screenCoordinates";
            return Err(place.need("outlineWidthMode")?.wrong(expected));
        }
    };
    if let Some(used) = place.get(SHADE_TEXTURE.1)? {
        check_texture(&used, textures)?;
    }
    note_the_rest(place, outline_width, raw)?;
    Ok(ToonMaterial {
        shade_color: place.floats_or("shadeColorFactor", rest.shade_color)?,
        shade_texture,
        shading_shift: place.clamped("shadingShiftFactor", rest.shading_shift, -1.0..=1.0, raw)?,
        shading_toony: place.clamped("shadingToonyFactor", rest.shading_toony, 0.0..=1.0, raw)?,
        outline_width,
        outline_color: place.floats_or("outlineColorFactor", rest.outline_color)?,
    })
}

/// A texture is named as glTF's materials name them, in a file with so many.
fn check_texture(place: &Place<'_>, textures: usize) -> Result<(), ImportError> {
    place.need("index")?.index("a texture", textures)?;
    place.float_or("texCoord", 0.0)?;
    if let Some(extensions) = place.get("extensions")? {
        extensions.all_members()?;
    }
    Ok(())
}

/// One note for all that is left out.
fn note_the_rest(place: &Place<'_>, outline_width: f32, raw: &mut RawScene) -> Result<(), ImportError> {
    let mut left_out = Vec::new();
    for (key, neutral) in OTHERS {
        let Some(found) = place.get(key)? else { continue };
        // Without an outline, nothing about one counts.
        let counts = outline_width > 0.0 || !key.starts_with("outline");
        if counts && !found.is(neutral) {
            left_out.push(key);
        }
    }
    if !left_out.is_empty() {
        let text = format!("{} are not represented", left_out.join(", "));
        note(raw, place.path(), Finding::LeftOut(text));
    }
    Ok(())
}
