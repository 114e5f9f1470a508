//! `materialProperties` of VRM 0.x: values of Unity's shaders, as the materials of VRM 1.0 say the same.
//!
//! ```text
//!  the border between light and shade of 0.x, in the cosine between normal and lamp:
//!  from shift to 1 + (shift − 1) · toony
//!  shading_toony = 1 − half its width         shading_shift = −its middle
//!  colours of 0.x are encoded as sRGB, but for that of the light that a surface gives off
//!  widths of outlines are centimetres
//! ```

use super::note;
use super::place::Place;
use crate::build::srgb::linear;
use crate::scene::{AlphaMode, Finding, ImportError, Material, RawScene, TextureRef, ToonMaterial};

/// Properties that [`Material`] and [`ToonMaterial`] do not hold, each with the value at which it changes
/// nothing: numbers, colours and textures.
const OTHER_FLOATS: [(&str, f32); 5] = [
    ("_UvAnimScrollX", 0.0),
    ("_UvAnimScrollY", 0.0),
    ("_UvAnimRotation", 0.0),
    ("_ReceiveShadowRate", 1.0),
    ("_ShadingGradeRate", 1.0),
];
const OTHER_TEXTURES: [&str; 6] = [
    "_SphereAdd",
    "_RimTexture",
    "_OutlineWidthTexture",
    "_UvAnimMaskTexture",
    "_ReceiveShadowTexture",
    "_ShadingGradeTexture",
];

/// The properties of a material.
struct Properties<'v> {
    place: Place<'v>,
    textures: &'v [Option<usize>],
}

/// Changes the materials of the scene to what their properties say. `textures` are the image of each texture.
pub(super) fn read(
    vrm: &Place<'_>,
    textures: &[Option<usize>],
    raw: &mut RawScene,
) -> Result<(), ImportError> {
    for (number, place) in vrm.list("materialProperties")?.into_iter().enumerate() {
        let Some(mut material) = raw.materials.get(number).cloned() else {
            note(raw, place.path(), Finding::left_out("is left out: there is no material for it"));
            continue;
        };
        let shader = place.text("shader")?;
        let properties = Properties { place, textures };
        match shader.as_str() {
            "VRM/MToon" => properties.mtoon(&mut material, raw)?,
            "VRM/UnlitTexture" => properties.unlit(&mut material, AlphaMode::Opaque)?,
            "VRM/UnlitCutout" => properties.unlit(&mut material, AlphaMode::Mask)?,
            "VRM/UnlitTransparent" | "VRM/UnlitTransparentZWrite" => {
                properties.unlit(&mut material, AlphaMode::Blend)?;
            }
            "" | "VRM_USE_GLTFSHADER" | "Standard" => {}
            _ => {
                let shader: String = shader.chars().take(60).collect();
                let text = format!("the shader '{shader}' is not represented");
                note(raw, properties.place.path(), Finding::LeftOut(text));
            }
        }
        raw.materials[number] = material;
    }
    Ok(())
}

impl Properties<'_> {
    fn float(&self, name: &str) -> Result<Option<f32>, ImportError> {
        let Some(floats) = self.place.get("floatProperties")? else { return Ok(None) };
        floats.get(name)?.map(|number| number.float()).transpose()
    }

    fn vector(&self, name: &str) -> Result<Option<[f32; 4]>, ImportError> {
        let Some(vectors) = self.place.get("vectorProperties")? else { return Ok(None) };
        // Some colours come without opacity.
        let numbers = vectors.list(name)?;
        match &numbers[..] {
            [] => Ok(None),
            [x, y, z] => Ok(Some([x.float()?, y.float()?, z.float()?, 1.0])),
            _ => Ok(Some(vectors.floats_or(name, [0.0; 4])?)),
        }
    }

    fn texture(&self, name: &str) -> Result<Option<TextureRef>, ImportError> {
        let Some(textures) = self.place.get("textureProperties")? else { return Ok(None) };
        let Some(index) = textures.get(name)? else { return Ok(None) };
        let index = index.index_or_none("a texture", self.textures.len())?;
        Ok(index.and_then(|index| self.textures[index]).map(TextureRef::from))
    }

    /// What both kinds of shader have in common.
    fn base(&self, material: &mut Material) -> Result<(), ImportError> {
        if let Some([red, green, blue, opacity]) = self.vector("_Color")? {
            let [red, green, blue] = linear([red, green, blue]);
            material.base_color = [red, green, blue, opacity];
        }
        if let Some(texture) = self.texture("_MainTex")? {
            material.base_color_texture = Some(same_place(texture, material.base_color_texture));
        }
        if let Some(cutoff) = self.float("_Cutoff")? {
            material.alpha_cutoff = cutoff;
        }
        Ok(())
    }

    fn unlit(&self, material: &mut Material, alpha_mode: AlphaMode) -> Result<(), ImportError> {
        self.base(material)?;
        material.alpha_mode = alpha_mode;
        material.is_unlit = true;
        Ok(())
    }

    fn mtoon(&self, material: &mut Material, raw: &mut RawScene) -> Result<(), ImportError> {
        self.base(material)?;
        material.alpha_mode = match self.float("_BlendMode")? {
            Some(1.0) => AlphaMode::Mask,
            Some(2.0 | 3.0) => AlphaMode::Blend,
            Some(_) => AlphaMode::Opaque,
            None => material.alpha_mode,
        };
        // 0 draws both sides, 1 the back alone, 2 the front alone.
        if let Some(cull) = self.float("_CullMode")? {
            material.double_sided = cull == 0.0;
            if cull == 1.0 {
                let text = "back faces alone are not represented: front faces are drawn";
                note(raw, self.place.path(), Finding::left_out(text));
            }
        }
        if let Some(normals) = self.texture("_BumpMap")? {
            material.normal_texture = Some(same_place(normals, material.normal_texture));
            material.normal_scale = self.float("_BumpScale")?.unwrap_or(1.0);
        }
        if let Some([red, green, blue, _]) = self.vector("_EmissionColor")? {
            material.emissive = [red, green, blue];
        }
        if let Some(texture) = self.texture("_EmissionMap")? {
            material.emissive_texture = Some(same_place(texture, material.emissive_texture));
        }
        material.is_unlit = false;
        material.toon = Some(self.toon(material.base_color_texture, raw)?);
        self.note_the_rest(raw)
    }

    fn toon(&self, base: Option<TextureRef>, raw: &mut RawScene) -> Result<ToonMaterial, ImportError> {
        let shift = self.float("_ShadeShift")?.unwrap_or(0.0).clamp(-1.0, 1.0);
        let toony = self.float("_ShadeToony")?.unwrap_or(0.9).clamp(0.0, 1.0);
        let (from, to) = (shift, 1.0 + (shift - 1.0) * toony);
        let width = self.float("_OutlineWidth")?.unwrap_or(0.0).max(0.0) / 100.0;
        let outline_width = match self.float("_OutlineWidthMode")?.unwrap_or(0.0) {
            1.0 => width,
            2.0 if width > 0.0 => {
                let text = "an outline of constant width on the screen is not represented";
                note(raw, self.place.path(), Finding::left_out(text));
                0.0
            }
            _ => 0.0,
        };
        // The default of the shader, a skin in the shade.
        let shade = self.vector("_ShadeColor")?.unwrap_or([0.97, 0.81, 0.86, 1.0]);
        let outline = self.vector("_OutlineColor")?.unwrap_or([0.0; 4]);
        Ok(ToonMaterial {
            shade_color: linear([shade[0], shade[1], shade[2]]),
            shade_texture: self.texture("_ShadeTexture")?.map(|texture| same_place(texture, base)),
            shading_shift: (-(from + to) / 2.0).clamp(-1.0, 1.0),
            shading_toony: (1.0 - (to - from) / 2.0).clamp(0.0, 1.0),
            outline_width,
            outline_color: linear([outline[0], outline[1], outline[2]]),
        })
    }

    /// One note for all that is left out.
    fn note_the_rest(&self, raw: &mut RawScene) -> Result<(), ImportError> {
        let mut left_out = Vec::new();
        for (name, neutral) in OTHER_FLOATS {
            left_out.extend(self.float(name)?.filter(|value| *value != neutral).map(|_| name));
        }
        for name in OTHER_TEXTURES {
            left_out.extend(self.texture(name)?.map(|_| name));
        }
        let rim = self.vector("_RimColor")?.filter(|rim| rim[..3] != [0.0; 3]);
        left_out.extend(rim.map(|_| "_RimColor"));
        let transform = self.vector("_MainTex")?.filter(|transform| *transform != [0.0, 0.0, 1.0, 1.0]);
        left_out.extend(transform.map(|_| "the transform of _MainTex"));
        if !left_out.is_empty() {
            let text = format!("{} are not represented", left_out.join(", "));
            note(raw, self.place.path(), Finding::LeftOut(text));
        }
        Ok(())
    }
}

/// A texture at the coordinates of another one: the properties say none, the file's own material may.
fn same_place(texture: TextureRef, other: Option<TextureRef>) -> TextureRef {
    let other = other.unwrap_or(texture);
    TextureRef { uvs: other.uvs, wrap: other.wrap, ..texture }
}
