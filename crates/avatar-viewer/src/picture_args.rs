//! Where the camera stands and what is behind the face, as the command line says it.

use crate::numbers::finite;
use crate::usage;
use anyhow::Result;
use avatar_pack::Pack;
use avatar_stage::{BACKGROUND, Framing, NamedView, SAMPLES, View};
use clap::Args;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use std::fmt;
use std::str::FromStr;

#[derive(Clone, Debug, Args)]
pub(crate) struct PictureArgs {
    /// Where the camera stands; `left` looks at the character's left side
    #[arg(long, value_parser = named_view(), default_value = NamedView::Front.name())]
    view: NamedView,
    /// Camera's angle around the vertical axis in degrees: 90 stands at the character's left [default: the
    /// view's]
    #[arg(long, allow_hyphen_values = true, value_parser = finite, value_name = "DEGREES")]
    yaw: Option<f32>,
    /// Camera's angle above the horizon in degrees [default: 0]
    #[arg(long, allow_hyphen_values = true, value_parser = finite, value_name = "DEGREES")]
    pitch: Option<f32>,
    /// What fills the picture, where it is at rest: the name of a part, `face`, or `whole` for all
    /// of the avatar [default: head and shoulders of a bust, else the whole avatar]
    #[arg(long, value_name = "PART")]
    frame: Option<String>,
    /// Samples per pixel, 1 or 4
    #[arg(long, default_value_t = SAMPLES, value_parser = samples, allow_hyphen_values = true)]
    pub(crate) samples: u32,
    /// `#RRGGBB` in sRGB, or `transparent`
    #[arg(long, default_value_t = Background(BACKGROUND), value_name = "COLOUR")]
    pub(crate) background: Background,
}

impl PictureArgs {
    /// Where the camera stands around this pack.
    pub(crate) fn view(&self, pack: &Pack) -> Result<View> {
        let framing = match self.frame.as_deref() {
            None => Framing::Portrait,
            Some("whole") if pack.part("whole").is_none() => Framing::Whole,
            Some("face") if pack.part("face").is_none() => Framing::Face,
            Some(name) => {
                let place = pack.parts().iter().position(|part| part.name == name);
                let names = pack.parts().iter().map(|part| part.name.as_str()).chain(["face", "whole"]);
                Framing::Part(place.ok_or_else(|| usage::unknown("part", name, names))?)
            }
        };
        let mut view = View { framing, ..self.view.view() };
        view.yaw_degrees = self.yaw.unwrap_or(view.yaw_degrees);
        view.pitch_degrees = self.pitch.unwrap_or(view.pitch_degrees);
        Ok(view)
    }
}

/// Reads the name of a view; the help lists them in this order.
fn named_view() -> impl TypedValueParser<Value = NamedView> {
    use NamedView::{Back, Front, Left, Right, ThreeQuarter};
    let names = [Front, Left, Right, ThreeQuarter, Back].map(NamedView::name);
    PossibleValuesParser::new(names).map(|name| NamedView::from_name(&name).unwrap_or(Front))
}

/// A background in sRGB with straight alpha.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Background(pub(crate) [u8; 4]);

impl FromStr for Background {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        if text.eq_ignore_ascii_case("transparent") {
            return Ok(Self([0; 4]));
        }
        let digits = text.strip_prefix('#').filter(|digits| digits.len() == 6);
        // Not from_str_radix alone: it takes a sign.
        let digits = digits.filter(|digits| digits.bytes().all(|digit| digit.is_ascii_hexdigit()));
        let number = digits.and_then(|digits| u32::from_str_radix(digits, 16).ok());
        let number = number.ok_or("expected #RRGGBB or transparent")?;
        let [_, red, green, blue] = number.to_be_bytes();
        Ok(Self([red, green, blue, 255]))
    }
}

impl fmt::Display for Background {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0 {
            [.., 0] => write!(f, "transparent"),
            [red, green, blue, _] => write!(f, "#{red:02x}{green:02x}{blue:02x}"),
        }
    }
}

fn samples(text: &str) -> Result<u32, String> {
    match text {
        "1" => Ok(1),
        "4" => Ok(4),
        _ => Err("expected 1 or 4".to_owned()),
    }
}
