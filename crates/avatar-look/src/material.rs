use crate::Standard;
use avatar_mesh::PartKind;

/// The looks of a part: plain data, with defaults per kind. Colours are linear, lengths are fractions of the
/// height of the skin (0.01 is about 2.5 mm on a grown-up).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Material {
    /// Colour where no texture covers it; `standard` has another one.
    pub color: [f32; 3],
    /// 1 hides what lies behind; read for corneas only.
    pub opacity: f32,
    /// Share of light reflected at normal incidence.
    pub reflectance: f32,
    /// Perceptual roughness where the gloss texture is black; without a texture the mean of both counts.
    pub roughness_matte: f32,
    /// Perceptual roughness where the gloss texture is white.
    pub roughness_glossy: f32,
    /// Factor on the tilt of the normal texture.
    pub normal_strength: f32,
    /// How far diffuse light reaches around the terminator, per channel, 0 (not at all) to 1; the quality
    /// levels plain and low, and parts that are not skin.
    pub wrap: [f32; 3],
    /// Diffuse mean free path below the surface, per channel: skin from medium quality on.
    pub scatter: [f32; 3],
    /// Strength of the second, sharper specular lobe, 0 (one lobe) to 1.
    pub sharp_share: f32,
    /// Roughness of the sharp lobe as a factor on that of the first.
    pub sharp_roughness: f32,
    /// Strength of light that comes through thin parts from behind.
    pub transmission: f32,
    /// The thickness that white means in the thickness texture.
    pub thickness: f32,
    /// Tilt of the fine relief that no texture holds: pores.
    pub pore_strength: f32,
    /// How often that relief repeats over the height of the skin.
    pub pore_density: f32,
    /// Depth of wrinkles that shapes bring in, where the texture of wrinkles is white.
    pub wrinkle_depth: f32,
    /// A clear wet film on top, 0 (dry) to 1: eyeballs, corneas, teeth, tongue.
    pub wetness: f32,
    /// Perceptual roughness of that film.
    pub film_roughness: f32,
    /// Share of the ambient light that is left at the back of the part: mouths and eye sockets are dark
    /// inside.
    pub back_light: f32,
    /// The tone of skin; read for skins only.
    pub tone: Tone,
    /// Iris and pupil; read for eyeballs only.
    pub iris: Iris,
    /// What a file of an interchange format says of the surface; `None` for parts of faces as packs have
    /// them, whose textures lie over the material's own colour. No key of `materials.toml`.
    pub standard: Option<Standard>,
}

/// Which tone a skin has, and which one its texture is painted in. Where both are equal the texture is shown
/// as it is. Colours are linear, those of bare skin that is neither blushed nor marked.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tone {
    /// What is shown instead of `painted`. Lips and the inside of the mouth, which are redder than skin,
    /// follow less; what is not red at all, such as cloth, not at all.
    pub color: [f32; 3],
    /// The tone of bare skin in the texture.
    pub painted: [f32; 3],
}

impl Tone {
    /// Fair skin, as it is.
    pub const DEFAULT: Self = Self { color: FAIR, painted: FAIR };
}

/// Linear colour of fair skin.
const FAIR: [f32; 3] = [0.60, 0.36, 0.26];

/// What makes an eye of a ball. The iris lies behind the cornea, in its middle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Iris {
    /// Refractive index of the cornea; 1 does not bend light.
    pub refractive_index: f32,
    /// How deep the iris lies behind the surface of the eyeball, as a fraction of the cornea's radius.
    pub depth: f32,
    /// Radius of the pupil as a fraction of the iris's radius, 0 to 1.
    pub pupil: f32,
    /// The same in the texture: what is painted there is stretched to `pupil`.
    pub painted_pupil: f32,
    /// Radius of the iris as a fraction of the cornea's radius.
    pub radius: f32,
    /// Width of the dark ring around the iris, as a fraction of its radius.
    pub limbal_width: f32,
    /// Darkness of that ring, 0 (none) to 1 (black).
    pub limbal_darkness: f32,
    /// Linear colour of the iris on the whole, shown instead of `painted_color`.
    pub color: [f32; 3],
    /// The same in the texture. Where both are equal the texture is shown as it is.
    pub painted_color: [f32; 3],
}

impl Iris {
    /// A human eye in indoor light.
    pub const DEFAULT: Self = Self {
        // Cornea and aqueous humour: 1.336 (Gullstrand's schematic eye, 1909).
        refractive_index: 1.336,
        depth: 0.12,
        pupil: 0.38,
        painted_pupil: 0.38,
        radius: 0.8,
        limbal_width: 0.18,
        limbal_darkness: 0.6,
        color: [0.15, 0.15, 0.13],
        painted_color: [0.15, 0.15, 0.13],
    };
}

impl Material {
    /// The default of a kind, visible without any texture.
    pub fn of(kind: PartKind) -> Self {
        let matte = Self {
            color: [0.8; 3],
            opacity: 1.0,
            reflectance: 0.04,
            roughness_matte: 0.7,
            roughness_glossy: 0.3,
            normal_strength: 1.0,
            wrap: [0.0; 3],
            scatter: [0.0; 3],
            sharp_share: 0.0,
            sharp_roughness: 0.5,
            transmission: 0.0,
            thickness: 0.1,
            pore_strength: 0.0,
            pore_density: 0.0,
            wrinkle_depth: 0.0,
            wetness: 0.0,
            film_roughness: 0.15,
            back_light: 1.0,
            tone: Tone::DEFAULT,
            iris: Iris::DEFAULT,
            standard: None,
        };
        match kind {
            // Reflectance: E. d'Eon and D. Luebke, "Advanced Techniques for Realistic Real-Time Skin
            // Rendering", 2007.
            PartKind::Skin => Self {
                color: FAIR,
                reflectance: 0.028,
                roughness_matte: 0.65,
                roughness_glossy: 0.35,
                wrap: [0.28, 0.14, 0.09],
                // 3.7, 1.4 and 0.7 mm: H. W. Jensen et al., "A Practical Model for Subsurface Light
                // Transport", 2001.
                scatter: [0.0138, 0.0052, 0.0026],
                sharp_share: 0.25,
                sharp_roughness: 0.55,
                transmission: 1.0,
                thickness: 0.09,
                pore_strength: 0.08,
                pore_density: 50.0,
                wrinkle_depth: 0.003,
                ..matte
            },
            PartKind::Surface => Self {
                color: [0.78, 0.70, 0.56],
                wrap: [0.2, 0.18, 0.15],
                roughness_matte: 0.4,
                roughness_glossy: 0.15,
                wetness: 0.8,
                back_light: 0.3,
                ..matte
            },
            PartKind::Eyeball => Self {
                color: [0.82, 0.80, 0.77],
                wrap: [0.25, 0.2, 0.2],
                reflectance: 0.02,
                roughness_matte: 0.6,
                roughness_glossy: 0.4,
                wetness: 1.0,
                back_light: 0.4,
                ..matte
            },
            // Reflectance of water, refractive index 1.33.
            PartKind::Cornea => Self {
                color: [0.8, 0.85, 0.9],
                opacity: 0.03,
                reflectance: 0.02,
                roughness_matte: 0.3,
                roughness_glossy: 0.2,
                wetness: 1.0,
                film_roughness: 0.09,
                ..matte
            },
        }
    }
}
