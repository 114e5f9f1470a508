/// How a surface looks, in the metallic-roughness model of glTF 2.0, section 3.9. Transforms of
/// textures are part of the mesh's texture coordinates.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// Name; may be empty.
    pub name: String,
    /// Linear colour and opacity; factors on the texture where there is one, and on the colours of vertices.
    pub base_color: [f32; 4],
    /// Colour and opacity, encoded as sRGB.
    pub base_color_texture: Option<TextureRef>,
    /// 0 for dielectrics, 1 for metals.
    pub metallic: f32,
    /// 0 for mirrors, 1 for chalk.
    pub roughness: f32,
    /// Roughness in green and metalness in blue, linear.
    pub metallic_roughness_texture: Option<TextureRef>,
    /// Normals in tangent space.
    pub normal_texture: Option<TextureRef>,
    /// Factor on the slopes of the normal texture.
    pub normal_scale: f32,
    /// Occlusion in red, linear.
    pub occlusion_texture: Option<TextureRef>,
    /// How much of the occlusion counts, 0…1.
    pub occlusion_strength: f32,
    /// Linear colour of the light that the surface gives off, a factor on its texture; may be above 1.
    pub emissive: [f32; 3],
    /// Its texture, encoded as sRGB.
    pub emissive_texture: Option<TextureRef>,
    /// What opacity means.
    pub alpha_mode: AlphaMode,
    /// Opacity below which [`AlphaMode::Mask`] draws nothing.
    pub alpha_cutoff: f32,
    /// Whether back faces are drawn.
    pub double_sided: bool,
    /// Whether the base colour is seen as it is, whatever the light.
    pub is_unlit: bool,
    /// How it is drawn as a cartoon, where the file says so.
    pub toon: Option<ToonMaterial>,
}

/// A picture on a surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct TextureRef {
    /// Position in [`crate::RawScene::images`].
    pub image: usize,
    /// Which texture coordinates of the mesh it uses.
    pub uvs: UvSet,
    /// What lies beyond the picture along `u` and along `v`.
    pub wrap: [Wrap; 2],
}

/// What is seen where texture coordinates leave a picture, along one of its sides.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Wrap {
    /// The picture again.
    #[default]
    Repeat,
    /// The colours of its edge.
    Clamp,
    /// The picture again, every second one mirrored.
    Mirror,
}

impl From<usize> for TextureRef {
    /// A picture by the first texture coordinates, which repeats.
    fn from(image: usize) -> Self {
        Self { image, uvs: UvSet::First, wrap: [Wrap::Repeat; 2] }
    }
}

/// Texture coordinates of a mesh.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum UvSet {
    /// [`avatar_mesh::Mesh::uvs`].
    #[default]
    First,
    /// [`avatar_mesh::Mesh::uvs_1`].
    Second,
}

/// A cartoon's look: one colour in the light, another in the shade, as VRM's MToon describes it. With
/// `light` the cosine between normal and lamp plus `shading_shift`, the share of the lit colour goes from 0
/// to 1 as `light` goes from `shading_toony - 1` to `1 - shading_toony`.
#[derive(Clone, Debug, PartialEq)]
pub struct ToonMaterial {
    /// Linear colour in the shade, a factor on its texture.
    pub shade_color: [f32; 3],
    /// Its texture, encoded as sRGB.
    pub shade_texture: Option<TextureRef>,
    /// Moves the border between light and shade, -1…1.
    pub shading_shift: f32,
    /// How sharp that border is: 0 for a ramp over everything, 1 for a step.
    pub shading_toony: f32,
    /// Width of the outline in metres; 0 for none.
    pub outline_width: f32,
    /// Linear colour of the outline.
    pub outline_color: [f32; 3],
}

impl Default for ToonMaterial {
    /// The defaults of `VRMC_materials_mtoon` 1.0.
    fn default() -> Self {
        Self {
            shade_color: [1.0; 3],
            shade_texture: None,
            shading_shift: 0.0,
            shading_toony: 0.9,
            outline_width: 0.0,
            outline_color: [0.0; 3],
        }
    }
}

impl Default for Material {
    /// The default material of glTF 2.0.
    fn default() -> Self {
        Self {
            name: String::new(),
            base_color: [1.0; 4],
            base_color_texture: None,
            metallic: 1.0,
            roughness: 1.0,
            metallic_roughness_texture: None,
            normal_texture: None,
            normal_scale: 1.0,
            occlusion_texture: None,
            occlusion_strength: 1.0,
            emissive: [0.0; 3],
            emissive_texture: None,
            alpha_mode: AlphaMode::Opaque,
            alpha_cutoff: 0.5,
            double_sided: false,
            is_unlit: false,
            toon: None,
        }
    }
}

impl Material {
    /// All its numbers that are not positions.
    pub(crate) fn factors(&self) -> impl Iterator<Item = f32> {
        let single =
            [self.metallic, self.roughness, self.normal_scale, self.occlusion_strength, self.alpha_cutoff];
        let toon = self.toon.iter().flat_map(|toon| {
            let single = [toon.shading_shift, toon.shading_toony, toon.outline_width];
            toon.shade_color.into_iter().chain(toon.outline_color).chain(single)
        });
        self.base_color.into_iter().chain(self.emissive).chain(single).chain(toon)
    }

    /// All textures that it names.
    pub fn textures(&self) -> impl Iterator<Item = TextureRef> {
        [
            self.base_color_texture,
            self.metallic_roughness_texture,
            self.normal_texture,
            self.occlusion_texture,
            self.emissive_texture,
            self.toon.as_ref().and_then(|toon| toon.shade_texture),
        ]
        .into_iter()
        .flatten()
    }
}

/// What the opacity of a material means.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum AlphaMode {
    /// Nothing: the surface is opaque.
    #[default]
    Opaque,
    /// A surface with holes where opacity is below a limit.
    Mask,
    /// Coverage: the surface is blended over what is behind.
    Blend,
}

/// A picture as the file carries it: not decoded.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct SceneImage {
    /// Name or address; may be empty.
    pub name: String,
    /// Media type such as `image/png`, where the file says it; may be empty.
    pub mime: String,
    /// The encoded picture; empty where it could not be found, which a note tells.
    pub bytes: Vec<u8>,
}
