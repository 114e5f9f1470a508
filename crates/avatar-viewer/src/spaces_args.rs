//! Spaces of names, as the command line says them.

use clap::Args;
use face_space::Standard;
use std::path::PathBuf;

/// Which space, or which way between two.
#[derive(Debug, Args)]
pub(crate) struct WayArgs {
    /// The space to list, or the one that a map begins with [default: a list of all]
    #[arg(long, value_name = "SPACE", value_parser = space)]
    pub(crate) from: Option<Standard>,
    /// The space that the map leads to
    #[arg(long, value_name = "SPACE", value_parser = space, requires = "from")]
    pub(crate) to: Option<Standard>,
    /// Say what becomes of each name on the way there and back
    #[arg(long, requires = "to")]
    pub(crate) report: bool,
    /// A recording of Live Link Face (.csv): say also how far that way moves vertices of the face
    #[arg(long, value_name = "FILE", requires = "report")]
    pub(crate) over: Option<PathBuf>,
}

/// A space; `vrm` and `visemes` are short for two of them.
pub(crate) fn shapes(text: &str) -> Result<Standard, String> {
    match text {
        "vrm" => Ok(Standard::Vrm1),
        "visemes" => Ok(Standard::Oculus),
        _ => space(text),
    }
}

fn space(text: &str) -> Result<Standard, String> {
    Standard::of_key(text).ok_or_else(|| {
        let keys = || Standard::ALL.into_iter().map(Standard::key);
        let listed = keys().collect::<Vec<_>>().join(", ");
        let meant = placed_toml::did_you_mean(placed_toml::nearest(text, keys()));
        format!("expected one of {listed}{meant}")
    })
}
