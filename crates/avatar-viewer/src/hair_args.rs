//! Which hair the face has, as the command line says it.

use avatar_groom::{DensityMap, Groom, Style};
use avatar_mesh::{Bounds, PartKind};
use avatar_pack::{Pack, Texture, Textures};
use clap::{Args, ValueEnum};

#[derive(Clone, Copy, Debug, Args)]
pub(crate) struct HairArgs {
    /// How hair falls, where the pack says that some grows
    #[arg(long, value_enum, default_value = "off")]
    hair: HairName,
    /// How many strands, by the usual number
    #[arg(long, default_value = "1", value_parser = factor, value_name = "FACTOR")]
    hair_density: f32,
    /// Which random numbers
    #[arg(long, default_value = "1", value_name = "NUMBER")]
    hair_seed: u64,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum HairName {
    Off,
    Short,
    Bob,
    Long,
    Curly,
    Mohawk,
    Bald,
}

/// Strands over a square of the skin's height: some 40,000 on the built-in head.
const STRANDS: f32 = 100_000.0;
const LARGEST_FACTOR: f32 = 10.0;

fn factor(text: &str) -> Result<f32, String> {
    let number = text.parse().ok().filter(|factor| (0.0..=LARGEST_FACTOR).contains(factor));
    number.ok_or_else(|| format!("expected a number from 0 to {LARGEST_FACTOR}"))
}

impl HairArgs {
    pub(crate) const OFF: Self = Self { hair: HairName::Off, hair_density: 1.0, hair_seed: 1 };

    /// Place of the skin, and the hair that grows on it; `None` where the pack has no map of where hair grows.
    pub(crate) fn groom(&self, pack: &Pack, textures: &Textures) -> Option<(usize, Groom)> {
        let style = match self.hair {
            HairName::Off => return None,
            HairName::Short => Style::SHORT,
            HairName::Bob => Style::BOB,
            HairName::Long => Style::LONG,
            HairName::Curly => Style::CURLY,
            HairName::Mohawk => Style::MOHAWK,
            HairName::Bald => Style::BALD,
        };
        let image = textures.get(Texture::HairDensity)?;
        let reds = image.as_raw().iter().copied().step_by(4).collect();
        let density = DensityMap::new(image.width(), image.height(), reds)?;
        let skin = pack.parts.iter().position(|part| part.spec.kind == PartKind::Skin)?;
        let eyes: Vec<Bounds> = (pack.parts.iter())
            .filter(|part| part.spec.kind == PartKind::Eyeball)
            .filter_map(|part| part.mesh.bounds())
            .collect();
        let strands = STRANDS * self.hair_density;
        Some((skin, Groom::new(&pack.parts[skin].mesh, &density, &eyes, style, strands, self.hair_seed)))
    }
}
