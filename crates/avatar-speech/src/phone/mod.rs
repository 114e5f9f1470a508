//! Symbols of phones, and what they look like.

mod arpabet;
mod ipa;
mod sampa;

use crate::viseme::Viseme;

/// How the phones of a file are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Alphabet {
    /// The letters of dictionaries of English, in upper or lower case, stress as a digit behind a vowel: `HH
    /// AH0 L OW1`. Also what TIMIT and Festival add (`pau`, `ax`, `dx`, `axr` …).
    Arpabet,
    /// The International Phonetic Alphabet, with marks of length, stress and tone.
    Ipa,
    /// SAMPA and X-SAMPA: IPA in letters of ASCII, and the kind of it that eSpeak and MBROLA write.
    Sampa,
}

/// What a symbol stands for: a sound, or two one after the other (diphthongs).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Phone {
    pub(crate) first: Viseme,
    pub(crate) second: Option<Viseme>,
    /// Where the symbol tells it.
    pub(crate) stress: Option<f32>,
}

impl Phone {
    pub(crate) fn one(viseme: Viseme) -> Self {
        Self { first: viseme, second: None, stress: None }
    }

    pub(crate) fn two(first: Viseme, second: Viseme) -> Self {
        Self { first, second: (second != first).then_some(second), stress: None }
    }
}

/// What pauses, noises and breath are called.
const SILENCES: [&str; 24] = [
    "", "_", "#", "##", "-", "h#", "#h", "pau", "epi", "sil", "sp", "spn", "<sil>", "<p:>", "<p>", "ssil",
    "brth", "br", "noise", "nsn", "<nib>", "<usb>", "silence", "...",
];

/// What stress is worth: of a main one, a second one, and of a syllable without.
const STRESSES: [f32; 3] = [0.7, 0.6, 0.42];

impl Alphabet {
    /// The alphabets in the order in which they are tried.
    pub(crate) const ALL: [Self; 3] = [Self::Arpabet, Self::Ipa, Self::Sampa];

    pub(crate) fn phone(self, symbol: &str) -> Option<Phone> {
        let symbol = symbol.trim();
        if is_silence(symbol) {
            return Some(Phone::one(Viseme::Sil));
        }
        match self {
            Self::Arpabet => arpabet::phone(symbol),
            Self::Ipa => ipa::phone(symbol),
            Self::Sampa => sampa::phone(symbol),
        }
    }

    /// The alphabet that these symbols are of, and how many of them it does not know. In X-SAMPA nearly every
    /// row of letters means something, so one of words such as `AA1` is ARPABET's if most of them are; else
    /// the alphabet is the one that knows most.
    pub(crate) fn of<'a>(symbols: impl Iterator<Item = &'a str> + Clone) -> (Self, usize) {
        let spoken = symbols.filter(|symbol| !is_silence(symbol.trim()));
        let unknown =
            |alphabet: Self| spoken.clone().filter(|symbol| alphabet.phone(symbol).is_none()).count();
        let of_arpabet = unknown(Self::Arpabet);
        if of_arpabet * 4 <= spoken.clone().count() {
            return (Self::Arpabet, of_arpabet);
        }
        let best = Self::ALL.into_iter().map(|alphabet| (alphabet, unknown(alphabet)));
        best.min_by_key(|(_, unknown)| *unknown).unwrap_or((Self::Ipa, 0))
    }
}

pub(crate) fn is_silence(symbol: &str) -> bool {
    SILENCES.iter().any(|silence| silence.eq_ignore_ascii_case(symbol))
}

/// Two vowels as a diphthong, or anything else as the first that is known and the last vowel.
fn joined(mut visemes: impl Iterator<Item = Viseme>) -> Option<Phone> {
    let first = visemes.next()?;
    Some(visemes.last().map_or_else(|| Phone::one(first), |last| Phone::two(first, last)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use Viseme::*;

    fn both(alphabet: Alphabet, symbol: &str) -> (Viseme, Option<Viseme>) {
        let phone = alphabet.phone(symbol).unwrap_or_else(|| panic!("{symbol}"));
        (phone.first, phone.second)
    }

    #[test]
    fn the_same_words_in_three_alphabets_look_the_same() {
        // "my voice, both jars, thing": by the pronouncing dictionary, in IPA and in X-SAMPA.
        let arpabet = "M AY1 V OY1 S B OW1 TH JH AA1 R Z TH IH1 NG SH UW1";
        let ipa = "m aɪ v ɔɪ s b oʊ θ dʒ ɑː ɹ z θ ɪ ŋ ʃ uː";
        let sampa = "m aI v OI s b oU T dZ A: r\\ z T I N S u:";
        let read = |alphabet, text: &str| -> Vec<_> {
            text.split(' ').map(|symbol| both(alphabet, symbol)).collect()
        };
        let first = read(Alphabet::Arpabet, arpabet);
        assert_eq!(first, read(Alphabet::Ipa, ipa));
        assert_eq!(first, read(Alphabet::Sampa, sampa));
        assert_eq!(first[0], (PP, None));
        assert_eq!(first[1], (Aa, Some(I)));
        assert_eq!(first[7], (TH, None));
    }

    #[test]
    fn the_alphabet_is_found() {
        let of = |text: &str| Alphabet::of(text.split(' '));
        assert_eq!(of("sil HH AH0 L OW1 W ER1 L D sil"), (Alphabet::Arpabet, 0));
        assert_eq!(of("pau hh ax l ow pau"), (Alphabet::Arpabet, 0));
        assert_eq!(of("h ə l oʊ w ɜː l d"), (Alphabet::Ipa, 0));
        assert_eq!(of("h @ l @U w 3: l d S T"), (Alphabet::Sampa, 0));
        assert_eq!(of("h @ l $$ w"), (Alphabet::Sampa, 1));
    }

    #[test]
    fn marks_of_length_and_stress_change_no_sound() {
        assert_eq!(both(Alphabet::Ipa, "ˈaːʰ"), (Aa, None));
        assert_eq!(both(Alphabet::Ipa, "t͡ʃ"), (CH, None));
        assert_eq!(both(Alphabet::Sampa, "y:"), (U, None));
        assert_eq!(both(Alphabet::Ipa, "ʏ"), (U, None));
        let stress = |symbol| Alphabet::Arpabet.phone(symbol).and_then(|phone| phone.stress);
        assert!(stress("AH1") > stress("AH2") && stress("AH2") > stress("AH0"));
    }
}
