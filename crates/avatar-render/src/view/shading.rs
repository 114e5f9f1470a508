//! How avatars are shaded, and what that costs.

/// How parts are shaded: which programs draw them, and which passes run before.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shading {
    /// Three lamps without shadows, wrapped diffuse, one lobe: the baseline of comparisons, and the cheapest.
    Plain,
    /// Realistic skin, eyes and teeth.
    Natural(Terms),
    /// Bands of colour and outlines.
    Toon,
}

/// What natural shading consists of. Every term can be switched off, for measuring, and for machines that are
/// too slow for it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Terms {
    /// Shadows of the lamps.
    pub shadows: Shadows,
    /// Ambient occlusion, computed from the depth of the picture.
    pub occlusion: bool,
    /// How light spreads below the skin.
    pub scattering: Scattering,
    /// Reflections of the environment, instead of its diffuse light in that direction.
    pub reflections: bool,
    /// The second, sharper lobe of skin.
    pub sharp_lobe: bool,
    /// Pores: fine relief that is not in the textures.
    pub pores: bool,
    /// Light through thin parts.
    pub transmission: bool,
    /// Refraction of the iris, the size of the pupil, the dark ring.
    pub eye_optics: bool,
}

/// Shadows of the lamps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shadows {
    /// None.
    Off,
    /// Of the key lamp, one sample.
    Hard,
    /// Of the key and rim lamps, 3×3 samples.
    Soft,
    /// Of the key and rim lamps, 7×7 samples and a finer map.
    Softer,
}

/// How light spreads below the skin.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scattering {
    /// A formula that softens the edge between light and shade.
    Wrapped,
    /// A table over angle and curvature.
    PreIntegrated,
    /// Blurred in the picture, in two passes.
    Separable,
}

/// A choice of terms that belong together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quality {
    /// The baseline.
    Plain,
    /// For software renderers and old machines.
    Low,
    /// For integrated graphics.
    Medium,
    /// For everything else.
    High,
}

/// The style of a picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Style {
    /// Realistic.
    #[default]
    Natural,
    /// Like a drawing.
    Toon,
}

impl Quality {
    /// The best quality that an adapter of this kind draws smoothly.
    pub fn of_adapter(info: &wgpu::AdapterInfo) -> Self {
        match info.device_type {
            wgpu::DeviceType::Cpu => Self::Low,
            wgpu::DeviceType::DiscreteGpu => Self::High,
            wgpu::DeviceType::IntegratedGpu | wgpu::DeviceType::VirtualGpu | wgpu::DeviceType::Other => {
                Self::Medium
            }
        }
    }

    /// The shading of this quality in this style. Toon shading has one quality.
    pub fn shading(self, style: Style) -> Shading {
        match (style, self) {
            (Style::Toon, _) => Shading::Toon,
            (Style::Natural, Self::Plain) => Shading::Plain,
            (Style::Natural, Self::Low) => Shading::Natural(Terms::LOW),
            (Style::Natural, Self::Medium) => Shading::Natural(Terms::MEDIUM),
            (Style::Natural, Self::High) => Shading::Natural(Terms::HIGH),
        }
    }
}

impl Terms {
    /// Nothing but lamps, environment and one lobe.
    pub const NONE: Self = Self {
        shadows: Shadows::Off,
        occlusion: false,
        scattering: Scattering::Wrapped,
        reflections: false,
        sharp_lobe: false,
        pores: false,
        transmission: false,
        eye_optics: false,
    };
    /// [`Quality::Low`].
    pub const LOW: Self = Self { shadows: Shadows::Hard, eye_optics: true, ..Self::NONE };
    /// [`Quality::Medium`].
    pub const MEDIUM: Self = Self {
        shadows: Shadows::Soft,
        occlusion: true,
        scattering: Scattering::PreIntegrated,
        reflections: true,
        sharp_lobe: true,
        pores: true,
        transmission: true,
        eye_optics: true,
    };
    /// [`Quality::High`].
    pub const HIGH: Self =
        Self { shadows: Shadows::Softer, scattering: Scattering::Separable, ..Self::MEDIUM };
}

impl Terms {
    /// Whether passes need depth and normals ahead of the picture.
    pub(crate) fn prepass(self) -> bool {
        self.occlusion || self.separable()
    }

    /// Whether light under the skin is blurred in the picture.
    pub(crate) fn separable(self) -> bool {
        self.scattering == Scattering::Separable
    }
}

impl Shading {
    /// The terms of this shading.
    pub(crate) fn terms(self) -> Terms {
        match self {
            Self::Plain => Terms::NONE,
            Self::Natural(terms) => terms,
            Self::Toon => Terms { shadows: Shadows::Soft, eye_optics: true, ..Terms::NONE },
        }
    }
}

impl Shadows {
    /// Samples on each side of the middle one; `None` without shadows.
    pub(crate) fn reach(self) -> Option<u32> {
        match self {
            Self::Off => None,
            Self::Hard => Some(0),
            Self::Soft => Some(1),
            Self::Softer => Some(3),
        }
    }

    /// Width and height of a map.
    pub(crate) fn map_size(self) -> u32 {
        match self {
            // It is bound and never read.
            Self::Off => 1,
            Self::Hard => 1024,
            Self::Soft => 1536,
            Self::Softer => 2048,
        }
    }

    /// Width and height of the map of hair.
    pub(crate) fn hair_map_size(self) -> u32 {
        match self {
            // It is bound and never read.
            Self::Off => 1,
            Self::Hard | Self::Soft => 512,
            Self::Softer => 1024,
        }
    }

    /// The most strands of an avatar that cast shadows; if it has more, these stand for all of them.
    pub(crate) fn strands(self) -> f32 {
        match self {
            Self::Off => 0.0,
            Self::Hard => 12_000.0,
            Self::Soft => 24_000.0,
            Self::Softer => 50_000.0,
        }
    }

    /// Lamps that cast shadows.
    pub(crate) fn lamps(self) -> u32 {
        match self {
            Self::Off => 0,
            Self::Hard => 1,
            Self::Soft | Self::Softer => 2,
        }
    }
}
