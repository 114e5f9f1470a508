//! Which person is made of an avatar, as the command line says it.

use crate::numbers::finite;
use crate::usage::{unknown, usage};
use anyhow::Result;
use avatar_pack::{IdentityError, Pack};
use std::str::FromStr;

/// `AXIS=VALUE` or `seed:NUMBER`
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum IdentityArg {
    /// All axes, and colours, as this number draws them.
    Seed(u64),
    /// One axis.
    Axis { name: String, value: f32 },
}

impl FromStr for IdentityArg {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        if let Some(seed) = text.strip_prefix("seed:") {
            let number = seed.trim().parse();
            return number
                .map(Self::Seed)
                .map_err(|_| format!("expected a whole number after \"seed:\", found {seed:?}"));
        }
        let form = "expected AXIS=VALUE or seed:NUMBER, as in jaw=0.5 or seed:7";
        let (name, value) = text.rsplit_once('=').ok_or(form)?;
        let number = finite(value).map_err(|expected| format!("{expected}, found {value:?}"))?;
        Ok(Self::Axis { name: name.trim().to_owned(), value: number })
    }
}

/// The avatar as this person; itself where nothing is said.
pub(crate) fn person(pack: Pack, args: &[IdentityArg]) -> Result<Pack> {
    if args.is_empty() {
        return Ok(pack);
    }
    let identity = pack.identity().ok_or_else(|| usage(format!("--identity: {}", IdentityError::NoAxes)))?;
    let mut values = vec![0.0; identity.axes.len()];
    let mut drawn = None;
    for arg in args {
        match arg {
            IdentityArg::Seed(seed) => {
                values = identity.draw(*seed);
                drawn = Some(*seed);
            }
            IdentityArg::Axis { name, value } => {
                let axis =
                    identity.index(name).ok_or_else(|| unknown("face axis", name, identity.names()))?;
                if !(-1.0..=1.0).contains(value) {
                    let range = format!("--identity {name}: expected a number from -1 to 1, found {value}");
                    return Err(usage(range));
                }
                values[axis] = *value;
            }
        }
    }
    let mut person = pack.with_identity(&values)?;
    drawn.into_iter().for_each(|seed| person.draw_colors(seed));
    Ok(person)
}
