/// A sound as it looks: one of the fifteen classes that Oculus Lipsync has, in its order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[repr(u8)]
pub enum Viseme {
    /// Silence.
    Sil,
    /// p, b, m: the lips close.
    PP,
    /// f, v: the lower lip touches the upper teeth.
    FF,
    /// th: the tongue between the teeth.
    TH,
    /// t, d.
    DD,
    /// k, g, h.
    KK,
    /// sh, ch, j.
    CH,
    /// s, z.
    SS,
    /// n, l.
    NN,
    /// r.
    RR,
    /// a as in "father".
    Aa,
    /// e as in "bed".
    E,
    /// i as in "see".
    I,
    /// o as in "note".
    O,
    /// u as in "food", and w.
    U,
}

/// Number of visemes.
pub const VISEMES: usize = Viseme::ALL.len();

impl Viseme {
    /// All of them; the place in this list is the index of weights.
    pub const ALL: [Self; 15] = [
        Self::Sil,
        Self::PP,
        Self::FF,
        Self::TH,
        Self::DD,
        Self::KK,
        Self::CH,
        Self::SS,
        Self::NN,
        Self::RR,
        Self::Aa,
        Self::E,
        Self::I,
        Self::O,
        Self::U,
    ];

    /// The name that Oculus has for it, without `viseme_`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Sil => "sil",
            Self::PP => "PP",
            Self::FF => "FF",
            Self::TH => "TH",
            Self::DD => "DD",
            Self::KK => "kk",
            Self::CH => "CH",
            Self::SS => "SS",
            Self::NN => "nn",
            Self::RR => "RR",
            Self::Aa => "aa",
            Self::E => "E",
            Self::I => "I",
            Self::O => "O",
            Self::U => "U",
        }
    }

    /// The viseme of a name, in upper or lower case, with or without `viseme_`; also by the names that other
    /// programs give to the last three (`ih`, `oh`, `ou`).
    pub fn named(name: &str) -> Option<Self> {
        let name = name.strip_prefix("viseme_").unwrap_or(name);
        let own = Self::ALL.into_iter().find(|viseme| viseme.name().eq_ignore_ascii_case(name));
        own.or_else(|| match name.to_ascii_lowercase().as_str() {
            "ih" => Some(Self::I),
            "oh" => Some(Self::O),
            "ou" => Some(Self::U),
            _ => None,
        })
    }

    /// Its place in [`Self::ALL`].
    pub const fn index(self) -> usize {
        self as usize
    }

    /// Whether it is a vowel.
    pub const fn is_vowel(self) -> bool {
        matches!(self, Self::Aa | Self::E | Self::I | Self::O | Self::U)
    }
}
