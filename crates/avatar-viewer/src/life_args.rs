//! What a face does by itself, as the command line says it.

use crate::numbers::seed;
use crate::usage::usage;
use anyhow::Result;
use avatar_life::{Life, Style};
use avatar_pack::Pack;
use clap::Args;

/// What the face does by itself.
#[derive(Clone, Debug, Default, Args)]
pub(crate) struct LifeArgs {
    /// Blinks, glances, breath and small motions over the face, as somebody calm, lively, tired, nervous or
    /// listening has them; or off
    #[arg(long, value_name = "PRESET", value_parser = preset)]
    life: Option<Preset>,
    /// Which of all lives of that kind
    #[arg(long, value_name = "NUMBER", requires = "life", default_value_t = 0, value_parser = seed, allow_hyphen_values = true)]
    seed: u64,
}

/// A style, or none.
#[derive(Clone, Debug)]
struct Preset(Option<Style>);

fn preset(text: &str) -> Result<Preset, String> {
    let names = || Style::PRESETS.iter().map(|style| style.name);
    match text {
        "off" => Ok(Preset(None)),
        _ => Style::preset(text).map(|style| Preset(Some(style))).ok_or_else(|| {
            let listed = names().collect::<Vec<_>>().join(", ");
            let meant = placed_toml::did_you_mean(placed_toml::nearest(text, names()));
            format!("expected {listed} or off{meant}")
        }),
    }
}

impl LifeArgs {
    /// Whether a life is asked for, or none.
    pub(crate) fn is_given(&self) -> bool {
        self.life.is_some()
    }

    /// The life from its beginning, if one is asked for.
    pub(crate) fn begin(&self, pack: &Pack) -> Option<Living> {
        let style = self.life.as_ref()?.0?;
        Some(Living::new(pack, style, self.seed))
    }
}

/// A life under way.
#[derive(Clone, Debug)]
pub(crate) struct Living {
    life: Life,
    seed: u64,
}

impl Living {
    /// The life of this style and seed from its beginning.
    pub(crate) fn new(pack: &Pack, style: Style, seed: u64) -> Self {
        Self::of(Life::new(pack.controls(), style, seed), seed)
    }

    /// A life that was made with this seed.
    pub(crate) fn of(life: Life, seed: u64) -> Self {
        Self { life, seed }
    }

    /// How it lives.
    pub(crate) fn style(&self) -> Style {
        *self.life.style()
    }

    /// What it was made with.
    pub(crate) fn seed(&self) -> u64 {
        self.seed
    }

    /// The life itself.
    pub(crate) fn into_life(self) -> Life {
        self.life
    }

    /// Goes on to a time, which is not before that of the last call.
    pub(crate) fn go_to(&mut self, secs: f64) -> Result<()> {
        let secs = (secs - self.life.time_secs()).max(0.0);
        self.life.advance(secs).map_err(|error| usage(format!("--time: {error}")))
    }

    /// Lays life over values of all controls.
    pub(crate) fn over(&self, values: &mut [f32]) -> Result<()> {
        Ok(self.life.apply_in_place(values)?)
    }

    /// The life as options of the command line say it.
    pub(crate) fn describe(&self) -> [String; 3] {
        let Self { life, seed } = self;
        [format!("life={}", life.style().name), format!("seed={seed}"), format!("time={}", life.time_secs())]
    }
}
