//! The pictures of the pack, painted as functions of the place on the face rather than of the pixel: the
//! layout of the texture may change without a single stroke moving.

pub mod canvas;
pub mod eye;
pub mod hair;
pub mod marks;
pub mod picture;
pub mod relief;
pub mod skin;
pub mod teeth;
pub mod top;
pub mod wrinkles;

use anyhow::Result;
use glam::DVec3;

use crate::{bake::Baked, skin::Skin};

/// How large the pictures are.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Detail {
    /// 2048² for the skin, 1024² for all else.
    #[default]
    Full,
    /// A quarter of that on each side.
    Draft,
}

impl Detail {
    /// Edge length of the skin's pictures in pixels.
    #[must_use]
    pub fn skin_pixels(self) -> usize {
        match self {
            Self::Full => 2048,
            Self::Draft => 512,
        }
    }

    /// Edge length of all other pictures.
    #[must_use]
    pub fn other_pixels(self) -> usize {
        self.skin_pixels() / 2
    }
}

/// What skins have more or less of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Complexion {
    /// Freckles: 0 none, 1 many.
    pub freckles: f64,
    /// The markings of her people: 0 none, 1 dark.
    pub marks: f64,
}

impl Default for Complexion {
    fn default() -> Self {
        Self { freckles: 0.5, marks: 0.0 }
    }
}

/// A colour from bytes, each channel 0…1.
#[must_use]
pub fn rgb(r: u8, g: u8, b: u8) -> DVec3 {
    DVec3::new(f64::from(r), f64::from(g), f64::from(b)) / 255.0
}

/// All pictures by file name.
///
/// # Errors
///
/// If a picture cannot be encoded.
pub fn all(
    skin: &Skin,
    baked: &Baked,
    detail: Detail,
    complexion: &Complexion,
) -> Result<Vec<(String, Vec<u8>)>> {
    let fine = canvas::Sites::of(skin, detail.skin_pixels());
    let coarse = canvas::Sites::of(skin, detail.other_pixels());
    let (black, white, level) = (DVec3::ZERO, DVec3::ONE, DVec3::new(0.5, 0.5, 1.0));
    let mut files = vec![
        (
            "SkinTex_Decal.png".to_owned(),
            fine.paint(rgb(190, 140, 114), |s| skin::colour(s, complexion)).png()?,
        ),
        ("SkinTex_Normal.png".to_owned(), fine.paint(level, relief::normal).png()?),
        ("SkinTex_AO.png".to_owned(), fine.paint(white, |s| skin::occlusion(s, baked)).png_grey()?),
        ("SkinTex_Gloss.png".to_owned(), fine.paint(DVec3::splat(0.34), skin::gloss).png_grey()?),
        ("SkinTex_Wrinkles.png".to_owned(), coarse.paint(black, wrinkles::depth).png_grey()?),
        ("SkinTex_Thickness.png".to_owned(), coarse.paint(white, |s| skin::thickness(s, baked)).png_grey()?),
        ("HairMap.png".to_owned(), coarse.paint(black, hair::density_colour).png_grey()?),
        ("TeethTex_Decal.png".to_owned(), teeth::picture(detail.other_pixels() / 2).png()?),
    ];
    let shade = eye::Shade::of(&baked.eyeball);
    for (i, iris) in eye::IRISES.iter().enumerate() {
        let name = format!("EyeTex_Decal{i:02}.png");
        files.push((name, eye::picture(detail.other_pixels(), iris, &shade).png()?));
    }
    Ok(files)
}
