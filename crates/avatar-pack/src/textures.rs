use crate::{Source, Warning};
use avatar_exchange::memory;
use avatar_look::Wraps;
use avatar_mesh::PartKind;
use image::error::{LimitError, LimitErrorKind};
use image::{ColorType, DynamicImage, ImageDecoder, ImageError, ImageFormat, ImageReader, Limits, RgbaImage};
use std::borrow::Cow;
use std::io::Cursor;
use std::sync::OnceLock;

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
    /// How deep wrinkles are that shapes bring in, linear: white deep. The original has none.
    SkinWrinkles,
    /// Colour of an eyeball, sRGB; there are four irises.
    Eye(u8),
    /// Colour of teeth, gums and tongue, sRGB.
    Teeth,
    /// Where hair grows, linear.
    HairDensity,
}

impl Texture {
    /// All textures that a pack may have.
    pub const ALL: [Self; 12] = [
        Self::SkinColor,
        Self::SkinOcclusion,
        Self::SkinGloss,
        Self::SkinNormal,
        Self::SkinThickness,
        Self::SkinWrinkles,
        Self::Eye(0),
        Self::Eye(1),
        Self::Eye(2),
        Self::Eye(3),
        Self::Teeth,
        Self::HairDensity,
    ];

    /// Those that a face is drawn with, and that its hair is planted by: eyeballs have the first iris.
    pub const DRAWN: [Self; 9] = [
        Self::SkinColor,
        Self::SkinOcclusion,
        Self::SkinGloss,
        Self::SkinNormal,
        Self::SkinThickness,
        Self::SkinWrinkles,
        Self::Eye(0),
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
            Self::SkinWrinkles => "SkinTex_Wrinkles".to_owned(),
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
    /// How deep wrinkles are, linear.
    pub wrinkles: Option<&'a RgbaImage>,
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
        Self::load_by(source, &Texture::ALL, |count, decode| (0..count).for_each(decode))
    }

    /// As [`Textures::load`], these textures alone, and decoded by whom the caller chooses: this library has
    /// no threads. `run` is given a number of pictures and a function that decodes one of them, by its place,
    /// on any thread and in any order; what it leaves out is decoded afterwards.
    ///
    /// Pictures that are decoded at the same time take what each of them needs for it at the same time.
    pub fn load_by(
        source: &impl Source,
        wanted: &[Texture],
        run: impl FnOnce(usize, &(dyn Fn(usize) + Sync)),
    ) -> Self {
        let mut room = FREE_BYTES;
        let mut textures = Self::default();
        let mut found = Vec::new();
        for texture in wanted {
            match find(source, *texture, &mut room) {
                Ok(None) => {}
                // Warnings come in the order of the textures, so a place is kept for them.
                Ok(Some(picture)) => found.push((textures.warnings.len(), picture)),
                Err(warning) => textures.warnings.push(warning),
            }
        }
        let decoded: Vec<OnceLock<Result<RgbaImage, ImageError>>> =
            found.iter().map(|_| OnceLock::new()).collect();
        let decode = |place: usize| {
            if let (Some((_, picture)), Some(slot)) = (found.get(place), decoded.get(place)) {
                slot.get_or_init(|| picture.decode());
            }
        };
        run(found.len(), &decode);
        (0..found.len()).for_each(decode);
        let mut late = 0;
        for ((place, picture), decoded) in found.into_iter().zip(decoded) {
            match decoded.into_inner() {
                Some(Ok(image)) => textures.images.push((picture.texture, image)),
                Some(Err(error)) => {
                    textures.warnings.insert(place + late, undecoded(source, &picture.name, &error));
                    late += 1;
                }
                None => {}
            }
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
                wrinkles: self.get(Texture::SkinWrinkles),
                ..PartImages::default()
            },
            PartKind::Surface => PartImages { color: self.get(Texture::Teeth), ..PartImages::default() },
            PartKind::Eyeball => PartImages { color: self.get(Texture::Eye(0)), ..PartImages::default() },
            PartKind::Cornea => PartImages::default(),
        }
    }
}

/// A picture of a source that is not decoded yet.
struct Encoded<'a> {
    texture: Texture,
    name: String,
    bytes: Cow<'a, [u8]>,
}

impl Encoded<'_> {
    fn decode(&self) -> Result<RgbaImage, ImageError> {
        rgba(decoder(&self.name, &self.bytes)?)
    }
}

/// The file of a texture, if there is one; `room` is what is left for pictures.
fn find<'a>(
    source: &'a impl Source,
    texture: Texture,
    room: &mut u64,
) -> Result<Option<Encoded<'a>>, Warning> {
    let names = ["png", "jpg", "jpeg"].map(|extension| format!("{}.{extension}", texture.stem()));
    for name in &names {
        let bytes = match source.read(name) {
            Ok(None) => continue,
            Ok(Some(bytes)) => bytes,
            Err(error) => {
                return Err(Warning::Texture { file: source.locate(name), problem: error.to_string() });
            }
        };
        take_room(name, &bytes, room).map_err(|error| undecoded(source, name, &error))?;
        return Ok(Some(Encoded { texture, name: name.clone(), bytes }));
    }
    match texture.is_expected() {
        true => {
            let problem = "expected a texture (PNG or JPEG), found no file".to_owned();
            Err(Warning::Texture { file: source.locate(&names[0]), problem })
        }
        false => Ok(None),
    }
}

fn undecoded(source: &impl Source, name: &str, error: &ImageError) -> Warning {
    let problem = format!("expected a PNG or JPEG picture, found: {error}");
    Warning::Texture { file: source.locate(name), problem }
}

/// A picture by itself, whatever others there are.
pub(crate) fn decode(name: &str, bytes: &[u8]) -> Result<RgbaImage, ImageError> {
    take_room(name, bytes, &mut { FREE_BYTES })?;
    rgba(decoder(name, bytes)?)
}

/// `room` is what is left for pictures; this one adds what its own bytes allow, and takes what it keeps.
fn take_room(name: &str, bytes: &[u8], room: &mut u64) -> Result<(), ImageError> {
    *room = room.saturating_add(PER_ENCODED_BYTE.saturating_mul(bytes.len() as u64));
    let decoder = decoder(name, bytes)?;
    if bytes_while_decoding(&decoder) > *room {
        return Err(ImageError::Limits(LimitError::from_kind(LimitErrorKind::InsufficientMemory)));
    }
    *room -= kept_bytes(&decoder);
    Ok(())
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

/// The picture with four bytes a pixel.
pub(crate) fn rgba(decoder: impl ImageDecoder) -> Result<RgbaImage, ImageError> {
    let color = decoder.color_type();
    if !matches!(color, ColorType::L8 | ColorType::Rgb8) {
        return Ok(DynamicImage::from_decoder(decoder)?.into_rgba8());
    }
    // The usual kinds of texture: `into_rgba8` takes as long for them as decoding does.
    let (width, height) = decoder.dimensions();
    let too_large = || ImageError::Limits(LimitError::from_kind(LimitErrorKind::InsufficientMemory));
    let mut samples = vec![0; usize::try_from(decoder.total_bytes()).map_err(|_| too_large())?];
    decoder.read_image(&mut samples)?;
    let pixels: Vec<[u8; 4]> = match color {
        ColorType::L8 => samples.iter().map(|v| [*v, *v, *v, 255]).collect(),
        _ => samples.as_chunks::<3>().0.iter().map(|[r, g, b]| [*r, *g, *b, 255]).collect(),
    };
    RgbaImage::from_raw(width, height, pixels.into_flattened()).ok_or_else(too_large)
}
