//! Parts as callers describe them.

use crate::gpu::image::Image;
use avatar_look::{Wraps, Wrinkle};
use avatar_mesh::{Mesh, PartKind};

/// A part to be drawn.
#[derive(Clone, Copy, Debug)]
pub struct PartDesc<'a> {
    /// Name in graphics debuggers and messages.
    pub label: &'a str,
    /// The undeformed mesh. Its k-th shape follows the avatar's weight number `first_weight + k`.
    pub mesh: &'a Mesh,
    /// The weight that the first shape of the mesh follows: 0 where all parts share their shapes, else where
    /// the part's own begin in the list of all.
    pub first_weight: usize,
    /// How it is drawn.
    pub kind: PartKind,
    /// What moves it.
    pub bones: PartBones,
    /// Its pictures.
    pub textures: PartTextures<'a>,
}

/// What moves a part.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PartBones {
    /// Every vertex names up to eight bones of the palette ([`avatar_mesh::Skinning`]).
    PerVertex,
    /// The whole part follows the bone at this position in the palette.
    Rigid(usize),
}

/// The wrinkles of a part.
#[derive(Clone, Copy, Debug)]
pub struct Wrinkles<'a> {
    /// How deep each groove is: its red, linear.
    pub depths: &'a Image,
    /// Where which shapes bring them in; the first [`Wrinkle::MOST`] count.
    pub places: &'a [Wrinkle],
}

/// The pictures of a part; each may have its own size. Without one, the default of the part's kind shows.
/// The last three are read where the material has [`Material::standard`](avatar_look::Material::standard).
#[derive(Clone, Copy, Debug, Default)]
pub struct PartTextures<'a> {
    /// Colour in sRGB; where it is transparent, the material's own colour shows. With
    /// [`Material::standard`](avatar_look::Material::standard), base colour and opacity.
    pub color: Option<&'a Image>,
    /// Share of the ambient light that arrives: the red channel, linear.
    pub occlusion: Option<&'a Image>,
    /// 0 matte, 1 glossy: the red channel, linear.
    pub gloss: Option<&'a Image>,
    /// Normals in tangent space, green up, linear.
    pub normal: Option<&'a Image>,
    /// Thickness of the part behind each point, from 0 (black) to that of the material (white): the red
    /// channel, linear.
    pub thickness: Option<&'a Image>,
    /// Roughness in green and metalness in blue, linear; in the place of `gloss`.
    pub metallic_roughness: Option<&'a Image>,
    /// Light that the surface gives off, sRGB; in the place of `thickness`.
    pub emissive: Option<&'a Image>,
    /// Colour of a cartoon in the shade, sRGB; in the place of `gloss` and `metallic_roughness`.
    pub shade: Option<&'a Image>,
    /// What lies beyond their edges. Gloss and thickness, which files do not have, take the fields of those
    /// in whose place they are.
    pub wraps: Wraps,
    /// Wrinkles that shapes bring in. One part of a model may have some: the first that does.
    pub wrinkles: Option<Wrinkles<'a>>,
}
