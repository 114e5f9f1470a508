//! How the picture is to look, as the command line says it.

use crate::hair_args::HairArgs;
use avatar_look::Colors;
use avatar_render::{HairDetail, Light, Quality, Shading, Style, ToneMap};
use clap::builder::PossibleValue;
use clap::{Args, ValueEnum};

#[derive(Clone, Copy, Debug, Args)]
pub(crate) struct LookArgs {
    /// How much care is taken; auto follows the adapter
    #[arg(long, value_enum, default_value = "auto")]
    quality: QualityName,
    /// After nature, or as drawn
    #[arg(long, value_enum, default_value = "natural")]
    style: StyleName,
    /// What lights the face
    #[arg(long, value_enum, default_value_t)]
    light: LightName,
    /// How light becomes colours of a screen
    #[arg(long, value_enum, default_value = "neutral")]
    tone_map: ToneMapName,
    /// Brighter (above 0) or darker, in stops
    #[arg(long, default_value = "0", allow_hyphen_values = true, value_parser = stops, value_name = "STOPS")]
    exposure: f32,
    /// Tone of the skin: pale, fair, olive, tan, brown, dark or #RRGGBB [default: the pack's]
    #[arg(long, value_parser = skin, value_name = "COLOR")]
    skin: Option<[f32; 3]>,
    /// Colour of the irises: brown, hazel, amber, green, blue, gray, violet or #RRGGBB [default: the pack's]
    #[arg(long, value_parser = iris, value_name = "COLOR")]
    iris: Option<[f32; 3]>,
    #[command(flatten)]
    pub(crate) hair: HairArgs,
}

fn skin(text: &str) -> Result<[f32; 3], String> {
    let names = || Colors::SKINS.map(|(name, _)| name).join(", ");
    Colors::skin(text).ok_or_else(|| format!("expected {} or #RRGGBB", names()))
}

fn iris(text: &str) -> Result<[f32; 3], String> {
    let names = || Colors::IRISES.map(|(name, _)| name).join(", ");
    Colors::iris(text).ok_or_else(|| format!("expected {} or #RRGGBB", names()))
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum QualityName {
    Auto,
    Plain,
    Low,
    Medium,
    High,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum StyleName {
    Natural,
    Toon,
}

/// A place in [`Light::PRESETS`]; the first is the default.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct LightName(usize);

impl LightName {
    const ALL: [Self; Light::PRESETS.len()] = {
        let mut all = [Self(0); Light::PRESETS.len()];
        let mut place = 0;
        while place < all.len() {
            all[place] = Self(place);
            place += 1;
        }
        all
    };
}

impl ValueEnum for LightName {
    fn value_variants<'a>() -> &'a [Self] {
        &Self::ALL
    }

    fn to_possible_value(&self) -> Option<PossibleValue> {
        Light::PRESETS.get(self.0).map(|(name, _)| PossibleValue::new(*name))
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum ToneMapName {
    Neutral,
    Agx,
}

/// Beyond this every picture is black or white.
const LARGEST_EXPOSURE: f32 = 10.0;

fn stops(text: &str) -> Result<f32, String> {
    let number = text.parse().ok().filter(|stops: &f32| stops.abs() <= LARGEST_EXPOSURE);
    number.ok_or_else(|| format!("expected a number from -{LARGEST_EXPOSURE} to {LARGEST_EXPOSURE}"))
}

impl Default for LookArgs {
    fn default() -> Self {
        Self {
            quality: QualityName::Auto,
            style: StyleName::Natural,
            light: LightName::default(),
            tone_map: ToneMapName::Neutral,
            exposure: 0.0,
            skin: None,
            iris: None,
            hair: HairArgs::OFF,
        }
    }
}

impl LookArgs {
    /// The defaults, with this hair.
    pub(crate) fn with_hair(hair: HairArgs) -> Self {
        Self { hair, ..Self::default() }
    }

    /// The colours that go over those of the pack.
    pub(crate) fn colors(&self) -> Colors {
        Colors { skin: self.skin, iris: self.iris }
    }

    fn quality(&self, adapter: &wgpu::AdapterInfo) -> Quality {
        match self.quality {
            QualityName::Auto => Quality::of_adapter(adapter),
            QualityName::Plain => Quality::Plain,
            QualityName::Low => Quality::Low,
            QualityName::Medium => Quality::Medium,
            QualityName::High => Quality::High,
        }
    }

    /// The shading on this adapter.
    pub(crate) fn shading(&self, adapter: &wgpu::AdapterInfo) -> Shading {
        self.quality(adapter).shading(match self.style {
            StyleName::Natural => Style::Natural,
            StyleName::Toon => Style::Toon,
        })
    }

    /// How much of the hair is drawn on this adapter.
    pub(crate) fn hair_detail(&self, adapter: &wgpu::AdapterInfo) -> HairDetail {
        HairDetail::of_quality(self.quality(adapter))
    }

    /// The light.
    pub(crate) fn light(&self) -> Light {
        let light = Light::PRESETS.get(self.light.0).map_or_else(Light::default, |(_, light)| light());
        let tone_map = match self.tone_map {
            ToneMapName::Neutral => ToneMap::Neutral,
            ToneMapName::Agx => ToneMap::AgX,
        };
        Light { exposure: light.exposure * self.exposure.exp2(), tone_map, ..light }
    }
}
