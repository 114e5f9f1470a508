mod text;

use crate::{Style, TomlError};

/// Which hair a head has: the content of a `hair.toml`.
///
/// The style is that of a preset, with the values of the tables over it.
///
/// ```
/// use avatar_groom::{Hair, Style};
///
/// let hair = Hair::from_toml("preset = \"bob\"\ndensity = 0.5\n[scalp]\nlength = 0.3")?;
/// assert_eq!((hair.style.scalp.length, hair.style.scalp.bend), (0.3, Style::BOB.scalp.bend));
/// assert_eq!((hair.density, hair.seed, hair.style.brows), (0.5, 1, Style::BOB.brows));
///
/// let error = Hair::from_toml("preset = \"bop\"").unwrap_err();
/// assert_eq!((error.line, error.column, error.nearest.as_deref()), (1, 10, Some("bob")));
/// # Ok::<(), avatar_groom::TomlError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hair {
    /// How it looks and falls.
    pub style: Style,
    /// How many strands, by the usual number: 0 to [`Hair::MAX_DENSITY`].
    pub density: f32,
    /// Which random numbers.
    pub seed: u64,
}

impl Default for Hair {
    /// Short hair, as usual.
    fn default() -> Self {
        Self { style: Style::SHORT, density: 1.0, seed: 1 }
    }
}

impl Hair {
    /// A `hair.toml` with all keys, their meaning, and the defaults as values:
    ///
    #[doc = concat!("```toml\n", include_str!("../hair.toml"), "```")]
    ///
    /// ```
    /// use avatar_groom::Hair;
    /// assert_eq!(Hair::from_toml(Hair::EXAMPLE)?, Hair::default());
    /// # Ok::<(), avatar_groom::TomlError>(())
    /// ```
    pub const EXAMPLE: &str = include_str!("../hair.toml");

    /// The largest density. On the built-in head it gives as many strands as one binding can hold within
    /// WebGPU's default limits.
    pub const MAX_DENSITY: f32 = 7.0;

    /// Strands over a square of the skin's height where density is 1: some 80,000 on the built-in head.
    const USUAL_STRANDS: f32 = 100_000.0;

    /// Reads a `hair.toml`; an empty one means the defaults.
    ///
    /// # Errors
    /// A text that is not TOML, names that do not exist, values out of range: with the place, what would
    /// be right there, what stands there, and the name that is probably meant.
    pub fn from_toml(text: &str) -> Result<Self, TomlError> {
        text::read(text)
    }

    /// A text that [`Hair::from_toml`] reads as exactly this hair.
    ///
    /// ```
    /// use avatar_groom::{Hair, Style};
    /// let bob = Hair { style: Style::BOB, density: 0.3, seed: 7 };
    /// assert_eq!(Hair::from_toml(&bob.to_toml())?, bob);
    /// # Ok::<(), avatar_groom::TomlError>(())
    /// ```
    pub fn to_toml(&self) -> String {
        text::write(self)
    }

    /// Strands over a square of the skin's height, as [`crate::Groom::new`] takes them.
    pub fn strands(&self) -> f32 {
        Self::USUAL_STRANDS * self.density
    }
}
