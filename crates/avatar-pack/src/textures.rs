use crate::{Source, Warning};
use image::{ImageReader, Limits, RgbaImage};
use std::io::Cursor;

/// A texture of the pack. The names are those of the original's files, without extension.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Texture {
    /// Colour of the skin, sRGB.
    SkinColor,
    /// Ambient occlusion of the skin, linear.
    SkinOcclusion,
    /// Gloss of the skin, linear.
    SkinGloss,
    /// Relief of the skin, a tangent-space normal map, linear. The original has none.
    SkinNormal,
    /// How thick the skin is, linear: black thin, white thick. The original has none.
    SkinThickness,
    /// Colour of an eyeball, sRGB; there are four irises.
    Eye(u8),
    /// Colour of teeth, gums and tongue, sRGB.
    Teeth,
    /// Where hair grows, linear.
    HairDensity,
}

impl Texture {
    /// All textures that a pack may have.
    pub const ALL: [Self; 11] = [
        Self::SkinColor,
        Self::SkinOcclusion,
        Self::SkinGloss,
        Self::SkinNormal,
        Self::SkinThickness,
        Self::Eye(0),
        Self::Eye(1),
        Self::Eye(2),
        Self::Eye(3),
        Self::Teeth,
        Self::HairDensity,
    ];

    /// File name without extension.
    pub fn stem(self) -> String {
        match self {
            Self::SkinColor => "SkinTex_Decal".to_owned(),
            Self::SkinOcclusion => "SkinTex_AO".to_owned(),
            Self::SkinGloss => "SkinTex_Gloss".to_owned(),
            Self::SkinNormal => "SkinTex_Normal".to_owned(),
            Self::SkinThickness => "SkinTex_Thickness".to_owned(),
            Self::Eye(iris) => format!("EyeTex_Decal{iris:02}"),
            Self::Teeth => "TeethTex_Decal".to_owned(),
            Self::HairDensity => "HairMap".to_owned(),
        }
    }

    /// Whether a pack without it is incomplete: these are what drawing needs and the original has.
    fn is_expected(self) -> bool {
        matches!(self, Self::SkinColor | Self::SkinOcclusion | Self::SkinGloss | Self::Eye(0))
    }
}

/// The decoded textures of a pack.
#[derive(Clone, Debug, Default)]
pub struct Textures {
    images: Vec<(Texture, RgbaImage)>,
    /// What is missing or broken.
    pub warnings: Vec<Warning>,
}

/// Larger pictures than this on a side are refused before they are decoded.
const MAX_SIDE: u32 = 16_384;

impl Textures {
    /// Loads all textures that the source has. Nothing fails here: what does not decode is reported.
    pub fn load(source: &impl Source) -> Self {
        let mut textures = Self::default();
        for texture in Texture::ALL {
            textures.load_one(source, texture);
        }
        textures
    }

    /// The texture, if the pack has it and it decodes.
    pub fn get(&self, texture: Texture) -> Option<&RgbaImage> {
        self.images.iter().find(|(other, _)| *other == texture).map(|(_, image)| image)
    }

    fn load_one(&mut self, source: &impl Source, texture: Texture) {
        let names = ["png", "jpg", "jpeg"].map(|extension| format!("{}.{extension}", texture.stem()));
        for name in &names {
            let problem = match source.read(name) {
                Ok(None) => continue,
                Ok(Some(bytes)) => match decode(&bytes) {
                    Ok(image) => {
                        self.images.push((texture, image));
                        return;
                    }
                    Err(error) => format!("expected a PNG or JPEG picture, found: {error}"),
                },
                Err(error) => error.to_string(),
            };
            self.warnings.push(Warning::Texture { file: source.locate(name), problem });
            return;
        }
        if texture.is_expected() {
            let problem = "expected a texture (PNG or JPEG), found no file".to_owned();
            self.warnings.push(Warning::Texture { file: source.locate(&names[0]), problem });
        }
    }
}

fn decode(bytes: &[u8]) -> Result<RgbaImage, image::ImageError> {
    let mut reader = ImageReader::new(Cursor::new(bytes)).with_guessed_format()?;
    let mut limits = Limits::default();
    limits.max_image_width = Some(MAX_SIDE);
    limits.max_image_height = Some(MAX_SIDE);
    reader.limits(limits);
    Ok(reader.decode()?.into_rgba8())
}
