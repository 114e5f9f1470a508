use crate::{Source, Warning};
use avatar_exchange::memory;
use avatar_look::Wraps;
use avatar_mesh::PartKind;
use image::error::{LimitError, LimitErrorKind};
use image::{DynamicImage, ImageDecoder, ImageError, ImageFormat, ImageReader, Limits, RgbaImage};
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

/// The pictures that a part is drawn with.
#[derive(Clone, Copy, Debug, Default)]
pub struct PartImages<'a> {
    /// Colour, sRGB.
    pub color: Option<&'a RgbaImage>,
    /// Ambient occlusion, linear.
    pub occlusion: Option<&'a RgbaImage>,
    /// Gloss, linear.
    pub gloss: Option<&'a RgbaImage>,
    /// Relief, a tangent-space normal map, linear.
    pub normal: Option<&'a RgbaImage>,
    /// How thick it is, linear.
    pub thickness: Option<&'a RgbaImage>,
    /// Roughness in green and metalness in blue, linear.
    pub metallic_roughness: Option<&'a RgbaImage>,
    /// Light that it gives off, sRGB.
    pub emissive: Option<&'a RgbaImage>,
    /// Colour of a cartoon in the shade, sRGB.
    pub shade: Option<&'a RgbaImage>,
    /// What lies beyond their edges.
    pub wraps: Wraps,
}

/// The decoded textures of a pack.
#[derive(Clone, Debug, Default)]
pub struct Textures {
    images: Vec<(Texture, RgbaImage)>,
    /// Pictures of an interchange file, and per part which of them is its colour and its relief.
    own: Option<OwnImages>,
    /// What is missing or broken.
    pub warnings: Vec<Warning>,
}

/// Pictures that no names of the raw format stand for.
#[derive(Clone, Debug, Default)]
pub(crate) struct OwnImages {
    pub(crate) images: Vec<Option<RgbaImage>>,
    /// Per part of the pack.
    pub(crate) color: Vec<Option<usize>>,
    pub(crate) normal: Vec<Option<usize>>,
    pub(crate) occlusion: Vec<Option<usize>>,
    pub(crate) metallic_roughness: Vec<Option<usize>>,
    pub(crate) emissive: Vec<Option<usize>>,
    pub(crate) shade: Vec<Option<usize>>,
    pub(crate) wraps: Vec<Wraps>,
}

/// Larger pictures than this on a side are refused before they are decoded.
const MAX_SIDE: u32 = 16_384;

/// Bytes that the pictures of any pack may take, and in addition for each byte that they have in their files.
const FREE_BYTES: u64 = memory::BASE;
const PER_ENCODED_BYTE: u64 = memory::PER_BYTE;

impl Textures {
    /// Loads all textures that the source has. Nothing fails here: what does not decode is reported.
    pub fn load(source: &impl Source) -> Self {
        let mut textures = Self::default();
        let mut room = FREE_BYTES;
        for texture in Texture::ALL {
            textures.load_one(source, texture, &mut room);
        }
        textures
    }

    /// The texture, if the pack has it and it decodes.
    pub fn get(&self, texture: Texture) -> Option<&RgbaImage> {
        self.images.iter().find(|(other, _)| *other == texture).map(|(_, image)| image)
    }

    pub(crate) fn of_own(own: OwnImages, warnings: Vec<Warning>) -> Self {
        Self { images: Vec::new(), own: Some(own), warnings }
    }

    /// What the part of this index and kind is drawn with.
    pub fn of_part(&self, part: usize, kind: PartKind) -> PartImages<'_> {
        if let Some(own) = &self.own {
            let get = |list: &[Option<usize>]| own.images.get((*list.get(part)?)?)?.as_ref();
            return PartImages {
                color: get(&own.color),
                normal: get(&own.normal),
                occlusion: get(&own.occlusion),
                metallic_roughness: get(&own.metallic_roughness),
                emissive: get(&own.emissive),
                shade: get(&own.shade),
                wraps: own.wraps.get(part).copied().unwrap_or_default(),
                ..PartImages::default()
            };
        }
        match kind {
            PartKind::Skin => PartImages {
                color: self.get(Texture::SkinColor),
                occlusion: self.get(Texture::SkinOcclusion),
                gloss: self.get(Texture::SkinGloss),
                normal: self.get(Texture::SkinNormal),
                thickness: self.get(Texture::SkinThickness),
                ..PartImages::default()
            },
            PartKind::Surface => PartImages { color: self.get(Texture::Teeth), ..PartImages::default() },
            PartKind::Eyeball => PartImages { color: self.get(Texture::Eye(0)), ..PartImages::default() },
            PartKind::Cornea => PartImages::default(),
        }
    }

    /// `room` is what is left for pictures.
    fn load_one(&mut self, source: &impl Source, texture: Texture, room: &mut u64) {
        let names = ["png", "jpg", "jpeg"].map(|extension| format!("{}.{extension}", texture.stem()));
        for name in &names {
            let problem = match source.read(name) {
                Ok(None) => continue,
                Ok(Some(bytes)) => match decode_within(name, &bytes, room) {
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

/// A picture by itself, whatever others there are.
pub(crate) fn decode(name: &str, bytes: &[u8]) -> Result<RgbaImage, ImageError> {
    decode_within(name, bytes, &mut { FREE_BYTES })
}

/// `room` is what is left for pictures; this one adds what its own bytes allow, and takes what it keeps.
fn decode_within(name: &str, bytes: &[u8], room: &mut u64) -> Result<RgbaImage, ImageError> {
    *room = room.saturating_add(PER_ENCODED_BYTE.saturating_mul(bytes.len() as u64));
    let decoder = decoder(name, bytes)?;
    let kept = kept_bytes(&decoder);
    if bytes_while_decoding(&decoder) > *room {
        return Err(ImageError::Limits(LimitError::from_kind(LimitErrorKind::InsufficientMemory)));
    }
    let picture = rgba(decoder)?;
    *room -= kept;
    Ok(picture)
}

/// What the decoded picture takes.
pub(crate) fn kept_bytes(decoder: &impl ImageDecoder) -> u64 {
    let (width, height) = decoder.dimensions();
    u64::from(width) * u64::from(height) * 4
}

/// While a picture is decoded, its samples are there, and as much again of what the decoder needs.
pub(crate) fn bytes_while_decoding(decoder: &impl ImageDecoder) -> u64 {
    kept_bytes(decoder).saturating_add(decoder.total_bytes().saturating_mul(2))
}

/// What decodes a picture: knows its size already.
pub(crate) fn decoder<'a>(name: &str, bytes: &'a [u8]) -> Result<impl ImageDecoder + 'a, ImageError> {
    let mut reader = ImageReader::new(Cursor::new(bytes)).with_guessed_format()?;
    // TGA does not begin with anything of its own: the name has to say it.
    if reader.format().is_none()
        && let Ok(format) = ImageFormat::from_path(name)
    {
        reader.set_format(format);
    }
    let mut limits = Limits::default();
    limits.max_image_width = Some(MAX_SIDE);
    limits.max_image_height = Some(MAX_SIDE);
    reader.limits(limits);
    let decoder = reader.into_decoder()?;
    Limits::default().reserve(decoder.total_bytes())?;
    Ok(decoder)
}

pub(crate) fn rgba(decoder: impl ImageDecoder) -> Result<RgbaImage, ImageError> {
    Ok(DynamicImage::from_decoder(decoder)?.into_rgba8())
}
