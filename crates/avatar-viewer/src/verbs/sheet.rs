use crate::cli::{SheetArgs, Size};
use crate::ending;
use crate::face_args::FaceChoice;
use crate::label;
use crate::offscreen::Offscreen;
use crate::output::{Contents, OutputFile};
use crate::picture_file::{self, PictureFormat};
use crate::progress::Progress;
use crate::standard;
use anyhow::Result;
use avatar_stage::{BACKGROUND, Framing, NamedView, SAMPLES, View};
use image::{Rgba, RgbaImage, imageops};

/// A pose's cell: the face from the front and three-quarter, side by side, above the label.
const FACE: Size = Size { width: 240, height: 300 };
const LABEL_HEIGHT: u32 = 34;
const GAP: u32 = 12;
const COLUMNS: u32 = 4;
/// Strands of a head that is as small as here.
const STRANDS: u32 = 4000;
const SHEET_COLOR: [u8; 4] = [0x16, 0x18, 0x1c, 255];
const LABEL_COLOR: [u8; 3] = [0xe6, 0xe2, 0xda];

pub(super) fn run(args: &SheetArgs) -> Result<()> {
    let format = ending::format(&args.out, args.format.as_deref(), PictureFormat::ENDINGS, "")?;
    let out = OutputFile::check(&args.out, Contents::Binary("a picture"))?;
    let files = super::open(&args.pack)?;
    let pack = files.load_pack()?;
    let poses: Vec<_> = pack.poses().iter().collect();
    if poses.is_empty() {
        standard::warn("expected poses to draw, found none: the sheet is empty");
    }
    let rows = (poses.len() as u32).div_ceil(COLUMNS).max(1);
    let (cell_width, cell_height) = (FACE.width * 2, FACE.height + LABEL_HEIGHT);
    let (width, height) = (GAP + COLUMNS * (cell_width + GAP), GAP + rows * (cell_height + GAP));
    format.check([width, height], SHEET_COLOR)?;

    let head = View { framing: Framing::Head, ..View::FRONT };
    let level = args.lod.level(&pack, &args.look, &head, FACE.sides(), 2 * poses.len() as u64);
    let mut offscreen = Offscreen::of_files(&files, &level, FACE, SAMPLES, args.look)?;
    offscreen.sketch_hair(STRANDS);
    let mut progress = Progress::new("pose", poses.len() as u64);
    let mut sheet = RgbaImage::from_pixel(width, height, Rgba(SHEET_COLOR));
    for (index, pose) in poses.into_iter().enumerate() {
        let index = index as u32;
        let left = GAP + index % COLUMNS * (cell_width + GAP);
        let top = GAP + index / COLUMNS * (cell_height + GAP);
        let mut values = pack.controls().defaults();
        pose.values.iter().for_each(|&(control, value)| values[control] = value);
        let face = FaceChoice::of_values(values);

        let cell = RgbaImage::from_pixel(cell_width, cell_height, Rgba(BACKGROUND));
        imageops::replace(&mut sheet, &cell, left.into(), top.into());
        for (place, view) in [NamedView::Front.view(), NamedView::ThreeQuarter.view()].into_iter().enumerate()
        {
            let view = View { framing: Framing::Head, ..view };
            let picture = offscreen.picture(&pack, &face, view, FACE, BACKGROUND)?;
            let x = left + place as u32 * FACE.width;
            imageops::replace(&mut sheet, &picture, x.into(), top.into());
        }
        let baseline = top + FACE.height + LABEL_HEIGHT * 2 / 3;
        let center = left + cell_width / 2;
        label::draw(&mut sheet, &pose.name, center as f32, baseline as f32, 22.0, LABEL_COLOR)?;
        progress.step(u64::from(index) + 1);
    }
    drop(progress);
    picture_file::still(&out, format, &sheet, "")
}
