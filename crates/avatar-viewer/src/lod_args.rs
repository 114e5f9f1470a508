//! With how many triangles the face is drawn, as the command line says it.

use crate::look_args::LookArgs;
use avatar_pack::{Level, Pack};
use avatar_render::headless::{GpuOptions, open_blocking};
use avatar_stage::View;
use clap::Args;
use std::borrow::Cow;

/// From so many pictures on a level is made for them: making one takes about as long as it saves in 50 frames
/// of a picture 180 pixels high, by software on two processors.
const FRAMES_THAT_PAY: u64 = 60;
/// The last level with which pictures of its height have a likeness (SSIM) of 0.995 and more to the whole
/// face's.
const MOST_ALIKE: usize = 3;

#[derive(Clone, Copy, Debug, Args)]
pub(crate) struct LodArgs {
    /// Level of detail: 0 is the whole face, 4 has the fewest triangles; auto goes by the height of the face
    /// in the picture, where software draws so many pictures without hair that making a level pays
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
        let is_haired = look.hair.choose(pack.hair()).is_some();
        let level = match self.lod {
            Lod::Level(level) => level,
            Lod::Auto if frames >= FRAMES_THAT_PAY && !is_haired => {
                Level::for_pixels(pack, view.pixels_per_unit(pack, [width, height])).min(MOST_ALIKE)
            }
            Lod::Auto => 0,
        };
        match level {
            0 => Cow::Borrowed(pack),
            // A graphics card draws the whole face about as fast.
            _ if self.lod == Lod::Auto && !draws_in_software() => Cow::Borrowed(pack),
            _ => Cow::Owned(Level::new(pack, level, is_haired).pack),
        }
    }
}

/// Whether the best adapter is the processor. Without one, drawing fails a little later, and says why.
fn draws_in_software() -> bool {
    let opened = open_blocking(GpuOptions::default());
    opened.is_ok_and(|gpu| gpu.info.device_type == wgpu::DeviceType::Cpu)
}
