//! Colours in which people of one face differ.

use crate::Material;
use avatar_mesh::PartKind;

/// Colours in which people of one face differ, over what materials say. Linear.
///
/// ```
/// use avatar_look::{Colors, Material};
/// use avatar_mesh::PartKind;
///
/// let colors = Colors { skin: Colors::skin("brown"), iris: Colors::iris("#5a8ac8") };
/// let skin = colors.over(PartKind::Skin, Material::of(PartKind::Skin));
/// assert_eq!(Some(skin.tone.color), colors.skin);
/// assert_eq!(Colors::skin("plaid"), None);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Colors {
    /// Tone of bare skin; `None` for that of the materials.
    pub skin: Option<[f32; 3]>,
    /// Colour of the irises on the whole; `None` for that of the materials.
    pub iris: Option<[f32; 3]>,
}

impl Colors {
    /// Tones of skin by name, with the melanin that [`Colors::skin_with`] takes.
    pub const SKINS: [(&str, f32); 6] =
        [("pale", 0.03), ("fair", 0.11), ("olive", 0.27), ("tan", 0.5), ("brown", 0.95), ("dark", 1.9)];

    /// Irises by name.
    pub const IRISES: [(&str, [f32; 3]); 7] = [
        ("brown", [0.13, 0.055, 0.022]),
        ("hazel", [0.22, 0.14, 0.045]),
        ("amber", [0.31, 0.13, 0.034]),
        ("green", [0.115, 0.165, 0.085]),
        ("blue", [0.115, 0.19, 0.30]),
        ("gray", [0.21, 0.235, 0.25]),
        ("violet", [0.20, 0.17, 0.34]),
    ];

    /// The tone of bare skin with so much melanin: 0 (none) to 3. Light passes the melanin of the epidermis
    /// on its way in and out, which absorbs as the wavelength to the power of −3.33 (S. Jacques, "Skin
    /// Optics", 1998), here at 600, 550 and 490 nm; a little comes back from above it. Numbers out of range
    /// and NaN count as the nearest one.
    #[expect(clippy::manual_clamp, reason = "NaN becomes a number")]
    pub fn skin_with(melanin: f32) -> [f32; 3] {
        // Skin without melanin, the share that never reaches it, and absorption relative to red.
        let (bare, above, absorption) = ([0.73, 0.44, 0.325], [0.038, 0.027, 0.021], [1.0, 1.336, 1.963]);
        let melanin = melanin.max(0.0).min(3.0);
        std::array::from_fn(|k| above[k] + (bare[k] - above[k]) * libm::expf(-melanin * absorption[k]))
    }

    /// A tone of [`Colors::SKINS`], or `#RRGGBB`.
    pub fn skin(text: &str) -> Option<[f32; 3]> {
        let named = Self::SKINS.into_iter().find(|(name, _)| *name == text);
        named.map(|(_, melanin)| Self::skin_with(melanin)).or_else(|| linear_from_hex(text))
    }

    /// A colour of [`Colors::IRISES`], or `#RRGGBB`.
    pub fn iris(text: &str) -> Option<[f32; 3]> {
        let named = Self::IRISES.into_iter().find(|(name, _)| *name == text);
        named.map(|(_, color)| color).or_else(|| linear_from_hex(text))
    }

    /// The material of a part of this kind with these colours.
    pub fn over(&self, kind: PartKind, mut material: Material) -> Material {
        match kind {
            PartKind::Skin => material.tone.color = self.skin.unwrap_or(material.tone.color),
            PartKind::Eyeball => material.iris.color = self.iris.unwrap_or(material.iris.color),
            PartKind::Surface | PartKind::Cornea => {}
        }
        material
    }
}

/// The linear colour of `#RRGGBB`, whose bytes are sRGB (IEC 61966-2-1); `None` for any other text.
///
/// ```
/// use avatar_look::linear_from_hex;
/// assert_eq!(linear_from_hex("#ff0000"), Some([1.0, 0.0, 0.0]));
/// assert_eq!(linear_from_hex("ff0000"), None);
/// ```
pub fn linear_from_hex(text: &str) -> Option<[f32; 3]> {
    let digits = text.strip_prefix('#').filter(|digits| digits.len() == 6 && digits.is_ascii())?;
    if digits.bytes().any(|digit| !digit.is_ascii_hexdigit()) {
        return None;
    }
    let number = u32::from_str_radix(digits, 16).ok()?;
    Some([16, 8, 0].map(|shift| linear((number >> shift & 255) as f32 / 255.0)))
}

fn linear(encoded: f32) -> f32 {
    if encoded <= 0.04045 { encoded / 12.92 } else { libm::powf((encoded + 0.055) / 1.055, 2.4) }
}
