//! With how many triangles the face is drawn, as the command line says it.

use crate::look_args::LookArgs;
use avatar_pack::{Level, Pack};
use avatar_stage::View;
use clap::Args;
use std::borrow::Cow;

/// From so many pictures on a level is made for them: making one takes about as long as it saves in 30 frames
/// of a picture 180 pixels high, by software on two processors.
const FRAMES_THAT_PAY: u64 = 40;

#[derive(Clone, Copy, Debug, Args)]
pub(crate) struct LodArgs {
    /// Level of detail: 0 is the whole face, 4 has the fewest triangles; auto goes by the height of the face
    /// in the picture, where so many pictures are drawn that making a level pays
    #[arg(long, default_value = "auto", value_parser = lod, value_name = "LEVEL")]
    lod: Lod,
}

/// Which level of detail.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Lod {
    Auto,
    Level(usize),
}

fn lod(text: &str) -> Result<Lod, String> {
    let last = Level::HEIGHTS.len();
    match text {
        "auto" => Ok(Lod::Auto),
        _ => (text.parse().ok().filter(|level| *level <= last).map(Lod::Level))
            .ok_or_else(|| format!("expected auto or a level from 0 to {last}")),
    }
}

impl LodArgs {
    /// The avatar as it is drawn in so many pictures of this width and height and from this view.
    pub(crate) fn level<'a>(
        &self,
        pack: &'a Pack,
        look: &LookArgs,
        view: &View,
        [width, height]: [u32; 2],
        frames: u64,
    ) -> Cow<'a, Pack> {
        let level = match self.lod {
            Lod::Level(level) => level,
            Lod::Auto if frames >= FRAMES_THAT_PAY => {
                Level::for_pixels(pack, view.pixels_per_unit(pack, [width, height]))
            }
            Lod::Auto => 0,
        };
        match level {
            0 => Cow::Borrowed(pack),
            _ => Cow::Owned(Level::new(pack, level, look.hair.choose(pack.hair()).is_some()).pack),
        }
    }
}
