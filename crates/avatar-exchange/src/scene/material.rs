/// How a surface looks, in the metallic-roughness model of glTF 2.0, section 3.9. Textures are positions in
/// [`crate::RawScene::images`] and use the first set of texture coordinates.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// Name; may be empty.
    pub name: String,
    /// Linear colour and opacity; a factor on the texture where there is one.
    pub base_color: [f32; 4],
    /// Colour and opacity, encoded as sRGB.
    pub base_color_texture: Option<usize>,
    /// 0 for dielectrics, 1 for metals.
    pub metallic: f32,
    /// 0 for mirrors, 1 for chalk.
    pub roughness: f32,
    /// Roughness in green and metalness in blue, linear.
    pub metallic_roughness_texture: Option<usize>,
    /// Normals in tangent space.
    pub normal_texture: Option<usize>,
    /// Factor on the slopes of the normal texture.
    pub normal_scale: f32,
    /// Occlusion in red, linear.
    pub occlusion_texture: Option<usize>,
    /// How much of the occlusion counts, 0…1.
    pub occlusion_strength: f32,
    /// Linear colour of the light that the surface gives off.
    pub emissive: [f32; 3],
    /// Its texture, encoded as sRGB.
    pub emissive_texture: Option<usize>,
    /// What opacity means.
    pub alpha_mode: AlphaMode,
    /// Opacity below which [`AlphaMode::Mask`] draws nothing.
    pub alpha_cutoff: f32,
    /// Whether back faces are drawn.
    pub double_sided: bool,
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
        }
    }
}

impl Material {
    /// All its numbers that are not positions.
    pub(crate) fn factors(&self) -> impl Iterator<Item = f32> {
        let single =
            [self.metallic, self.roughness, self.normal_scale, self.occlusion_strength, self.alpha_cutoff];
        self.base_color.into_iter().chain(self.emissive).chain(single)
    }

    /// All textures that it names.
    pub fn textures(&self) -> impl Iterator<Item = usize> {
        [
            self.base_color_texture,
            self.metallic_roughness_texture,
            self.normal_texture,
            self.occlusion_texture,
            self.emissive_texture,
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
