/// How a surface looks, as files of interchange formats say it: the metallic-roughness model of glTF 2.0,
/// section 3.9. Colours are linear; each is a factor on its texture where there is one.
///
/// Parts of the kind [`avatar_mesh::PartKind::Surface`] are drawn by all of it. Of other kinds, only
/// `base_color` and `occlusion_strength` are read, as factors on the textures.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Standard {
    /// Colour and opacity; factors on the texture and on the colours of vertices.
    pub base_color: [f32; 4],
    /// What opacity means.
    pub alpha: Alpha,
    /// 0 for dielectrics, 1 for metals; a factor on the blue of its texture.
    pub metallic: f32,
    /// Perceptual roughness; a factor on the green of its texture.
    pub roughness: f32,
    /// How much of the occlusion counts, 0 to 1.
    pub occlusion_strength: f32,
    /// Light that the surface gives off: 1 is as bright as a white matte surface that faces a lamp of
    /// radiance 1.
    pub emissive: [f32; 3],
    /// Whether back sides are drawn.
    pub is_double_sided: bool,
    /// How light makes colour of it.
    pub lighting: Lighting,
    /// Which textures lie by the second texture coordinates of the mesh; the others by the first.
    pub second_uvs: SecondUvs,
}

/// From this opacity on, what is blended counts as opaque, since nothing can be seen through it: the last
/// step of eight bits.
pub const SOLID: f32 = 0.998;

/// What the opacity of a surface means: glTF 2.0, section 3.9.4.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Alpha {
    /// Nothing: the surface is opaque.
    #[default]
    Opaque,
    /// Holes where opacity is below this number.
    Mask(f32),
    /// Coverage: the surface is blended over what is behind.
    Blend,
}

/// How light makes colour of a surface.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Lighting {
    /// It reflects light.
    #[default]
    Lit,
    /// The base colour is seen as it is, whatever the light: `KHR_materials_unlit`.
    Unlit,
    /// It is drawn as a cartoon.
    Cartoon(Cartoon),
}

/// One colour in the light, another in the shade: VRM's MToon 1.0. With `x` the cosine between normal and
/// lamp plus `shading_shift`, the share of the lit colour goes from 0 to 1 as `x` goes from
/// `shading_toony - 1` to `1 - shading_toony`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cartoon {
    /// Colour in the shade, a factor on its texture.
    pub shade_color: [f32; 3],
    /// Moves the border between light and shade.
    pub shading_shift: f32,
    /// How sharp that border is: 0 for a ramp over everything, 1 for a step.
    pub shading_toony: f32,
    /// Width of the outline in the world's units; 0 for none.
    pub outline_width: f32,
    /// Colour of the outline.
    pub outline_color: [f32; 3],
}

/// Textures that lie by the second texture coordinates.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SecondUvs {
    /// That of the base colour.
    pub color: bool,
    /// That of the occlusion.
    pub occlusion: bool,
    /// That of roughness and metalness.
    pub metallic_roughness: bool,
    /// That of the normals.
    pub normal: bool,
    /// That of the emitted light.
    pub emissive: bool,
    /// That of the colour in the shade.
    pub shade: bool,
}

/// What a texture shows beyond its edges: glTF 2.0, section 5.26.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Wrap {
    /// The texture again.
    #[default]
    Repeat,
    /// The colour of its edge.
    Clamp,
    /// The texture again, every other time mirrored.
    Mirror,
}

/// What textures show beyond their edges, in the directions of the first and the second coordinate.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Wraps {
    /// That of the base colour.
    pub color: [Wrap; 2],
    /// That of the occlusion.
    pub occlusion: [Wrap; 2],
    /// That of roughness and metalness.
    pub metallic_roughness: [Wrap; 2],
    /// That of the normals.
    pub normal: [Wrap; 2],
    /// That of the emitted light.
    pub emissive: [Wrap; 2],
    /// That of the colour in the shade.
    pub shade: [Wrap; 2],
}

impl Default for Standard {
    /// White, opaque, matte, seen from its front.
    fn default() -> Self {
        Self {
            base_color: [1.0; 4],
            alpha: Alpha::Opaque,
            metallic: 0.0,
            roughness: 1.0,
            occlusion_strength: 1.0,
            emissive: [0.0; 3],
            is_double_sided: false,
            lighting: Lighting::Lit,
            second_uvs: SecondUvs::default(),
        }
    }
}
