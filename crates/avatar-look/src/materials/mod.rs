mod fields;
mod text;

use crate::{LookError, Material};
use avatar_mesh::{FACE_PARTS, PartKind};

/// The kinds of parts, by the names of their tables.
pub(crate) const KINDS: [(&str, PartKind); 4] = [
    ("skin", PartKind::Skin),
    ("teeth", PartKind::Surface),
    ("eyeball", PartKind::Eyeball),
    ("cornea", PartKind::Cornea),
];

/// The looks of all parts of a face: the content of a `materials.toml`.
///
/// Each value is the default of the kind ([`Material::of`]) unless the kind's table sets it, and that unless
/// the part's table sets it. [`Materials::EXAMPLE`] lists all keys.
///
/// ```
/// use avatar_look::{Material, Materials};
/// use avatar_mesh::PartKind;
///
/// let materials = Materials::from_toml(
///     r#"
///     [teeth]
///     color = [0.9, 0.85, 0.7]
///
///     [lower-jaw]
///     wetness = 0.5
///
///     [left-eyeball.iris]
///     pupil = 0.6
///     "#,
/// )?;
/// let upper = materials.of("upper-jaw", PartKind::Surface);
/// let lower = materials.of("lower-jaw", PartKind::Surface);
/// assert_eq!((upper.color, upper.wetness), ([0.9, 0.85, 0.7], 0.8));
/// assert_eq!((lower.color, lower.wetness), ([0.9, 0.85, 0.7], 0.5));
/// assert_eq!(materials.of("left-eyeball", PartKind::Eyeball).iris.pupil, 0.6);
/// assert_eq!(materials.of("skin", PartKind::Skin), Material::of(PartKind::Skin));
///
/// let error = Materials::from_toml("[teeth]\ncolour = [1, 1, 1]").unwrap_err();
/// assert_eq!((error.line, error.column, error.nearest.as_deref()), (2, 1, Some("color")));
/// # Ok::<(), avatar_look::LookError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Materials {
    /// In the order of [`KINDS`].
    pub(crate) kinds: [Material; KINDS.len()],
    /// In the order of [`FACE_PARTS`]: the kind's material with the part's own values.
    pub(crate) parts: [Material; FACE_PARTS.len()],
}

impl Default for Materials {
    /// [`Material::of`] its kind for each part.
    fn default() -> Self {
        Self {
            kinds: KINDS.map(|(_, kind)| Material::of(kind)),
            parts: FACE_PARTS.map(|part| Material::of(part.kind)),
        }
    }
}

impl Materials {
    /// A `materials.toml` with all keys, their meaning, and the defaults as values:
    ///
    #[doc = concat!("```toml\n", include_str!("../materials.toml"), "```")]
    ///
    /// ```
    /// use avatar_look::Materials;
    /// assert_eq!(Materials::from_toml(Materials::EXAMPLE)?, Materials::default());
    /// # Ok::<(), avatar_look::LookError>(())
    /// ```
    pub const EXAMPLE: &str = include_str!("../materials.toml");

    /// Reads a `materials.toml`; an empty one means the defaults.
    ///
    /// # Errors
    ///
    /// A text that is not TOML, names that do not exist, values out of range: with the place, what would
    /// be right there, what stands there, and the name that is probably meant.
    pub fn from_toml(text: &str) -> Result<Self, LookError> {
        text::read(text)
    }

    /// The material of a part. A part that is none of [`FACE_PARTS`], or of another kind there, has its
    /// kind's.
    pub fn of(&self, part_name: &str, kind: PartKind) -> Material {
        let is_meant = |part: &avatar_mesh::PartSpec| part.name == part_name && part.kind == kind;
        match FACE_PARTS.iter().position(is_meant) {
            Some(index) => self.parts[index],
            None => self.kinds[kind_index(kind)],
        }
    }

    /// Gives one of [`FACE_PARTS`] looks of its own, with numbers taken into the ranges of `materials.toml`
    /// and without [`Material::standard`]; other names change nothing. The skin's are also those of its kind.
    pub fn set(&mut self, part_name: &str, material: Material) {
        let Some(index) = FACE_PARTS.iter().position(|part| part.name == part_name) else { return };
        let material = Material { standard: None, ..fields::in_range(material) };
        self.parts[index] = material;
        if let Some(kind) = KINDS.iter().position(|(name, _)| *name == part_name) {
            self.kinds[kind] = material;
        }
    }

    /// A text that [`Materials::from_toml`] reads as exactly these materials: all values of the kinds, and of
    /// the parts those that differ.
    pub fn to_toml(&self) -> String {
        text::write(self)
    }
}

pub(crate) fn kind_index(kind: PartKind) -> usize {
    match kind {
        PartKind::Skin => 0,
        PartKind::Surface => 1,
        PartKind::Eyeball => 2,
        PartKind::Cornea => 3,
    }
}
