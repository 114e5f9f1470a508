use std::fmt;

/// A kind of file that holds a film.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Format {
    /// GIF: up to 256 colours in what changes from frame to frame, 50 frames per second at most.
    Gif,
    /// Animated PNG: every frame to the bit.
    Apng,
    /// H.264 in MP4: small, without alpha.
    #[cfg(feature = "mp4")]
    Mp4,
}

impl Format {
    /// All that are compiled.
    pub const ALL: &[Self] = &[
        Self::Gif,
        Self::Apng,
        #[cfg(feature = "mp4")]
        Self::Mp4,
    ];

    /// The format that a file's name ends in, in whichever case.
    pub fn of_name(name: &str) -> Option<Self> {
        let (_, ending) = name.rsplit_once('.')?;
        let is_meant =
            |format: &Self| format.extensions().iter().any(|known| known.eq_ignore_ascii_case(ending));
        Self::ALL.iter().copied().find(is_meant)
    }

    /// The ends of names of such files, the usual one first.
    pub const fn extensions(self) -> &'static [&'static str] {
        match self {
            Self::Gif => &["gif"],
            Self::Apng => &["png", "apng"],
            #[cfg(feature = "mp4")]
            Self::Mp4 => &["mp4"],
        }
    }

    /// Whether pixels can be transparent; without, they are shown on black.
    pub const fn keeps_alpha(self) -> bool {
        match self {
            Self::Gif | Self::Apng => true,
            #[cfg(feature = "mp4")]
            Self::Mp4 => false,
        }
    }

    /// Whether a film can have sound.
    pub const fn keeps_sound(self) -> bool {
        match self {
            Self::Gif | Self::Apng => false,
            #[cfg(feature = "mp4")]
            Self::Mp4 => true,
        }
    }

    /// Longer and shorter side of the largest picture.
    pub(crate) const fn largest(self) -> (u32, u32) {
        match self {
            Self::Gif => (65_535, 65_535),
            Self::Apng => (1 << 30, 1 << 30),
            // Level 5.2, as far as the encoder goes.
            #[cfg(feature = "mp4")]
            Self::Mp4 => (3840, 2160),
        }
    }

    /// The most frames per second, where there is a limit below [`crate::Rate::FASTEST`].
    pub(crate) const fn fastest(self) -> Option<u32> {
        match self {
            // Delays are hundredths of a second, and programs that show GIFs take less than two of them for
            // ten.
            Self::Gif => Some(50),
            Self::Apng => None,
            #[cfg(feature = "mp4")]
            Self::Mp4 => None,
        }
    }

    /// A size in words.
    pub(crate) fn words((width, height): (u32, u32)) -> String {
        format!("{width}x{height}")
    }
}

impl fmt::Display for Format {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Gif => "GIF",
            Self::Apng => "animated PNG",
            #[cfg(feature = "mp4")]
            Self::Mp4 => "MP4",
        })
    }
}
