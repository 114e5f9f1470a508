use crate::WebError;
use avatar_groom::{Hair, Style as HairStyle};
use avatar_life::Style as Life;
use avatar_look::{Colors, linear_from_hex};
use avatar_render::wgpu::{AdapterInfo, DeviceType, SurfaceTarget};
use avatar_render::{HairDetail, Light, Quality, Shading, Style, ToneMap};
use avatar_stage::{BACKGROUND, Screen};

/// No hair, where one can choose.
const NO_HAIR: &str = "off";
/// Qualities by name; without one it follows the adapter.
const QUALITIES: [(&str, Quality); 4] =
    [("plain", Quality::Plain), ("low", Quality::Low), ("medium", Quality::Medium), ("high", Quality::High)];
const STYLES: [(&str, Style); 2] = [("natural", Style::Natural), ("toon", Style::Toon)];
const TONE_MAPS: [(&str, ToneMap); 2] = [("neutral", ToneMap::Neutral), ("agx", ToneMap::AgX)];
/// What leaves a choice to the avatar or to the adapter.
const AUTO: &str = "auto";
/// Beyond this every picture is black or white.
const LARGEST_EXPOSURE: f32 = 10.0;

/// How the face is shown, word by word, as `avatar-viewer`'s options of the same names say it.
#[derive(Clone, Debug, PartialEq)]
pub struct Look {
    quality: Option<Quality>,
    style: Style,
    light: &'static str,
    tone_map: ToneMap,
    exposure: f32,
    /// None: the avatar's own.
    hair: Option<Option<HairStyle>>,
    hair_color: Option<[f32; 3]>,
    hair_density: Option<f32>,
    colors: Colors,
    /// sRGB with straight alpha.
    background: [u8; 4],
    /// What was said, in the order of [`Look::OPTIONS`]; what was not is empty.
    said: [String; Look::OPTIONS.len()],
}

impl Default for Look {
    fn default() -> Self {
        Self {
            quality: None,
            style: Style::Natural,
            light: Light::PRESETS[0].0,
            tone_map: ToneMap::Neutral,
            exposure: 0.0,
            hair: None,
            hair_color: None,
            hair_density: None,
            colors: Colors::default(),
            background: BACKGROUND,
            said: Default::default(),
        }
    }
}

impl Look {
    /// Everything that can be said.
    pub const OPTIONS: [&str; 11] = [
        "quality",
        "style",
        "light",
        "tone-map",
        "exposure",
        "hair",
        "hair-color",
        "hair-density",
        "skin",
        "iris",
        "background",
    ];

    /// Sets one option to a word; `auto` takes it back.
    ///
    /// # Errors
    /// An option or a word that does not exist, with the one that is probably meant; nothing changes then.
    pub fn set(&mut self, option: &str, word: &str) -> Result<(), WebError> {
        let unknown = || WebError::word("look", option, Self::OPTIONS, "");
        let place = Self::OPTIONS.iter().position(|known| *known == option).ok_or_else(unknown)?;
        let is_auto = word == AUTO || word.is_empty();
        let new = Self::default();
        match option {
            "quality" if is_auto => self.quality = None,
            "quality" => self.quality = Some(named(option, word, &QUALITIES)?),
            "style" if is_auto => self.style = new.style,
            "style" => self.style = named(option, word, &STYLES)?,
            "light" if is_auto => self.light = new.light,
            "light" => {
                let names = || Light::PRESETS.iter().map(|(name, _)| *name);
                let found = names().find(|name| *name == word);
                let names: Vec<&str> = names().collect();
                self.light = found.ok_or_else(|| WebError::word(option, word, names, " or auto"))?;
            }
            "tone-map" if is_auto => self.tone_map = new.tone_map,
            "tone-map" => self.tone_map = named(option, word, &TONE_MAPS)?,
            "exposure" if is_auto => self.exposure = 0.0,
            "exposure" => self.exposure = number(option, word, -LARGEST_EXPOSURE, LARGEST_EXPOSURE)?,
            "hair" if is_auto => self.hair = None,
            "hair" if word == NO_HAIR => self.hair = Some(None),
            "hair" => self.hair = Some(Some(named(option, word, &HairStyle::PRESETS)?)),
            "hair-color" if is_auto => self.hair_color = None,
            "hair-color" => {
                let hex = linear_from_hex(word).map(Ok);
                self.hair_color = Some(hex.unwrap_or_else(|| named(option, word, &HairStyle::COLORS))?);
            }
            "hair-density" if is_auto => self.hair_density = None,
            "hair-density" => self.hair_density = Some(number(option, word, 0.0, Hair::MAX_DENSITY)?),
            "skin" if is_auto => self.colors.skin = None,
            "skin" => {
                let names = Colors::SKINS.map(|(name, _)| name);
                let unknown = || WebError::word(option, word, names, ", #RRGGBB or auto");
                self.colors.skin = Some(Colors::skin(word).ok_or_else(unknown)?);
            }
            "iris" if is_auto => self.colors.iris = None,
            "iris" => {
                let names = Colors::IRISES.map(|(name, _)| name);
                let unknown = || WebError::word(option, word, names, ", #RRGGBB or auto");
                self.colors.iris = Some(Colors::iris(word).ok_or_else(unknown)?);
            }
            _ if is_auto => self.background = new.background,
            _ => self.background = background(option, word)?,
        }
        let said = if is_auto { String::new() } else { word.to_owned() };
        if let Some(slot) = self.said.get_mut(place) {
            *slot = said;
        }
        Ok(())
    }

    /// What was said, and is not taken back.
    pub fn said(&self) -> impl Iterator<Item = (&'static str, &str)> {
        let said = self.said.iter().map(String::as_str);
        Self::OPTIONS.into_iter().zip(said).filter(|(_, word)| !word.is_empty())
    }

    /// The words that an option knows; those of colours besides `#RRGGBB`. Numbers have none.
    pub fn words(option: &str) -> Vec<&'static str> {
        fn names<T: Copy, const N: usize>(of: [(&'static str, T); N]) -> Vec<&'static str> {
            of.map(|(name, _)| name).to_vec()
        }
        match option {
            "quality" => names(QUALITIES),
            "style" => names(STYLES),
            "light" => Light::PRESETS.iter().map(|(name, _)| *name).collect(),
            "tone-map" => names(TONE_MAPS),
            "hair" => names(HairStyle::PRESETS).into_iter().chain([NO_HAIR]).collect(),
            "hair-color" => names(HairStyle::COLORS),
            "skin" => names(Colors::SKINS),
            "iris" => names(Colors::IRISES),
            "life" => Life::PRESETS.iter().map(|style| style.name).chain(["off"]).collect(),
            "background" => vec!["transparent"],
            _ => Vec::new(),
        }
    }

    /// Opens a device for a canvas or window of this size in pixels, to draw with this look.
    ///
    /// # Errors
    /// No device that shows pictures there.
    pub async fn open(
        &self,
        window: impl Into<SurfaceTarget<'static>>,
        (width, height): (u32, u32),
    ) -> Result<Screen, WebError> {
        Ok(Screen::open_as(window, width, height, |info| self.shading(info)).await?)
    }

    /// The quality on this adapter.
    pub fn quality(&self, adapter: &AdapterInfo) -> Quality {
        self.quality.unwrap_or_else(|| match is_software(adapter) {
            true => Quality::Low,
            false => Quality::of_adapter(adapter),
        })
    }

    /// The shading on this adapter.
    pub fn shading(&self, adapter: &AdapterInfo) -> Shading {
        self.quality(adapter).shading(self.style)
    }

    /// How much of the hair is drawn on this adapter.
    pub fn hair_detail(&self, adapter: &AdapterInfo) -> HairDetail {
        HairDetail::of_quality(self.quality(adapter))
    }

    /// The light.
    pub fn light(&self) -> Light {
        let preset = Light::PRESETS.iter().find(|(name, _)| *name == self.light);
        let light = preset.map_or_else(Light::default, |(_, light)| light());
        Light { exposure: light.exposure * self.exposure.exp2(), tone_map: self.tone_map, ..light }
    }

    /// The hair, where there is to be some.
    pub fn hair(&self, own: Option<&Hair>) -> Option<Hair> {
        let mut hair = own.copied().unwrap_or_default();
        match self.hair {
            None if own.is_none() => return None,
            None => {}
            Some(style) => hair.style = style?,
        }
        hair.density = self.hair_density.unwrap_or(hair.density);
        if let Some(color) = self.hair_color {
            hair.style = hair.style.colored(color);
        }
        Some(hair)
    }

    /// Colours over those of the avatar.
    pub fn colors(&self) -> Colors {
        self.colors
    }

    /// What is behind the face: sRGB with straight alpha.
    pub fn background(&self) -> [u8; 4] {
        self.background
    }
}

/// Whether an adapter is software: browsers do not say it in the kind of an adapter, but in its name.
pub(crate) fn is_software(adapter: &AdapterInfo) -> bool {
    let says = |text: &str| {
        let text = text.to_ascii_lowercase();
        ["swiftshader", "llvmpipe", "lavapipe", "basic render"].iter().any(|name| text.contains(name))
    };
    adapter.device_type == DeviceType::Cpu
        || says(&adapter.name)
        || says(&adapter.driver)
        || says(&adapter.driver_info)
}

fn named<T: Copy>(option: &str, word: &str, known: &[(&'static str, T)]) -> Result<T, WebError> {
    let found = known.iter().find(|(name, _)| *name == word).map(|(_, value)| *value);
    let names: Vec<&str> = known.iter().map(|(name, _)| *name).collect();
    let beside = match option {
        "hair" => ", off or auto",
        "hair-color" => ", #RRGGBB or auto",
        _ => " or auto",
    };
    found.ok_or_else(|| WebError::word(option, word, names, beside))
}

fn number(option: &str, word: &str, least: f32, most: f32) -> Result<f32, WebError> {
    let number = word.parse().ok().filter(|number: &f32| (least..=most).contains(number));
    number.ok_or_else(|| WebError::number(option, format!("a number from {least} to {most}"), word))
}

fn background(option: &str, word: &str) -> Result<[u8; 4], WebError> {
    if word == "transparent" {
        return Ok([0; 4]);
    }
    let digits = word.strip_prefix('#').filter(|digits| digits.len() == 6);
    let digits = digits.filter(|digits| digits.bytes().all(|digit| digit.is_ascii_hexdigit()));
    let number = digits.and_then(|digits| u32::from_str_radix(digits, 16).ok());
    let number = number.ok_or_else(|| WebError::number(option, "#RRGGBB, transparent or auto", word))?;
    let [_, red, green, blue] = number.to_be_bytes();
    Ok([red, green, blue, 255])
}
