//! Which hair the face has: what the command line says over what the pack says.

use crate::numbers::seed;
use avatar_groom::{Hair, Style};
use avatar_look::linear_from_hex;
use clap::builder::PossibleValue;
use clap::{Args, ValueEnum};

#[derive(Clone, Copy, Debug, PartialEq, Args)]
pub(crate) struct HairArgs {
    /// How hair falls, where the pack says that some grows [default: the pack's hair.toml, else off]
    #[arg(long, value_enum)]
    hair: Option<HairName>,
    /// How many strands, by the usual number [default: the pack's hair.toml, else 1]
    #[arg(long, value_parser = factor, allow_hyphen_values = true, value_name = "FACTOR")]
    hair_density: Option<f32>,
    /// Which random numbers [default: the pack's hair.toml, else 1]
    #[arg(long, value_parser = seed, allow_hyphen_values = true, value_name = "NUMBER")]
    hair_seed: Option<u64>,
    /// Colour of scalp and brows: black, dark-brown, brown, light-brown, blond, red, gray, white or #RRGGBB
    /// [default: the style's]
    #[arg(long, value_parser = color, value_name = "COLOR")]
    hair_color: Option<[f32; 3]>,
}

fn color(text: &str) -> Result<[f32; 3], String> {
    let named = Style::COLORS.into_iter().find(|(name, _)| *name == text).map(|(_, color)| color);
    let names = || Style::COLORS.map(|(name, _)| name).join(", ");
    named.or_else(|| linear_from_hex(text)).ok_or_else(|| format!("expected {} or #RRGGBB", names()))
}

/// A place in [`Style::PRESETS`], or off; in the order in which the window goes through them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum HairName {
    Preset(usize),
    Off,
}

impl HairName {
    const ALL: [Self; Style::PRESETS.len() + 1] = {
        let mut all = [Self::Off; Style::PRESETS.len() + 1];
        let mut place = 0;
        while place < Style::PRESETS.len() {
            all[place] = Self::Preset(place);
            place += 1;
        }
        all
    };
}

impl ValueEnum for HairName {
    fn value_variants<'a>() -> &'a [Self] {
        &Self::ALL
    }

    fn to_possible_value(&self) -> Option<PossibleValue> {
        match self {
            Self::Preset(place) => Style::PRESETS.get(*place).map(|(name, _)| PossibleValue::new(*name)),
            Self::Off => Some(PossibleValue::new("off")),
        }
    }
}

fn factor(text: &str) -> Result<f32, String> {
    let number = text.parse().ok().filter(|factor| (0.0..=Hair::MAX_DENSITY).contains(factor));
    number.ok_or_else(|| format!("expected a number from 0 to {}", Hair::MAX_DENSITY))
}

impl HairName {
    fn style(self) -> Option<Style> {
        match self {
            Self::Off => None,
            Self::Preset(place) => Style::PRESETS.get(place).map(|(_, style)| *style),
        }
    }
}

impl HairArgs {
    pub(crate) const OFF: Self =
        Self { hair: Some(HairName::Off), hair_density: None, hair_seed: None, hair_color: None };

    /// The hair, if there is to be some. A preset takes the place of the pack's whole style, tables included;
    /// number and seed stay the pack's unless they are given themselves.
    pub(crate) fn choose(&self, of_pack: Option<&Hair>) -> Option<Hair> {
        let mut hair = of_pack.copied().unwrap_or_default();
        match self.hair {
            None if of_pack.is_none() => return None,
            None => {}
            Some(name) => hair.style = name.style()?,
        }
        hair.density = self.hair_density.unwrap_or(hair.density);
        hair.seed = self.hair_seed.unwrap_or(hair.seed);
        if let Some(color) = self.hair_color {
            hair.style = hair.style.colored(color);
        }
        Some(hair)
    }

    /// The next choice (or the one before): the pack's own hair, where it has any, the presets, and none;
    /// round and round.
    pub(crate) fn next(self, of_pack: Option<&Hair>, backward: bool) -> Self {
        let own = of_pack.map(|_| None);
        let choices: Vec<Option<HairName>> =
            own.into_iter().chain(HairName::value_variants().iter().copied().map(Some)).collect();
        // Without hair of its own a pack looks as switched off.
        let now = self.hair.or_else(|| of_pack.is_none().then_some(HairName::Off));
        let at = choices.iter().position(|choice| *choice == now).unwrap_or(0);
        let step = if backward { choices.len() - 1 } else { 1 };
        Self { hair: choices[(at + step) % choices.len()], ..self }
    }

    /// In words.
    pub(crate) fn name(&self) -> String {
        match self.hair.and_then(|name| name.to_possible_value()) {
            Some(name) => name.get_name().to_owned(),
            None => "the pack's own".to_owned(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const NONE: HairArgs = HairArgs { hair: None, hair_density: None, hair_seed: None, hair_color: None };

    #[test]
    fn options_go_over_the_pack() {
        let pack =
            Hair::from_toml("preset = 'bob'\ndensity = 2\nseed = 5\n[scalp]\nlength = 0.3\n").expect("sound");
        assert_eq!(NONE.choose(None), None);
        assert_eq!(NONE.choose(Some(&pack)), Some(pack));
        assert_eq!(HairArgs::OFF.choose(Some(&pack)), None);
        let short = HairArgs { hair: Some(HairName::Preset(0)), ..NONE };
        assert_eq!(short.choose(Some(&pack)), Some(Hair { style: Style::SHORT, ..pack }));
        assert_eq!(short.choose(None), Some(Hair::default()));
        let seeded = HairArgs { hair_seed: Some(9), hair_density: Some(0.0), ..NONE };
        assert_eq!(seeded.choose(Some(&pack)), Some(Hair { seed: 9, density: 0.0, ..pack }));
        assert_eq!(seeded.choose(None), None, "nothing says that there is hair");
    }

    #[test]
    fn the_names_of_the_options_are_those_of_the_presets() {
        let names = HairName::value_variants()
            .iter()
            .filter_map(|name| Some((name.to_possible_value()?.get_name().to_owned(), name.style()?)));
        let presets = Style::PRESETS.map(|(name, style)| (name.to_owned(), style));
        assert_eq!(names.collect::<Vec<_>>(), presets);
    }

    #[test]
    fn all_choices_come_round_both_ways() {
        let pack = Hair::default();
        let start = HairArgs { hair_seed: Some(3), ..NONE };
        for (of_pack, count) in [(Some(&pack), 8), (None, 7)] {
            for backward in [false, true] {
                let mut seen = vec![start];
                for _ in 1..count {
                    let next = seen[seen.len() - 1].next(of_pack, backward);
                    assert!(!seen.contains(&next), "{next:?}");
                    assert_eq!(
                        next.next(of_pack, !backward).choose(of_pack),
                        seen[seen.len() - 1].choose(of_pack)
                    );
                    seen.push(next);
                }
                let again = seen[seen.len() - 1].next(of_pack, backward);
                assert_eq!(again.choose(of_pack), start.choose(of_pack));
                assert_eq!(again.hair_seed, Some(3));
            }
        }
        assert_eq!(NONE.next(None, false).name(), "short");
        assert_eq!(NONE.next(Some(&pack), true).name(), "off");
        assert_eq!(NONE.name(), "the pack's own");
    }
}
