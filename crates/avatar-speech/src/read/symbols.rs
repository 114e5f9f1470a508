//! Closed sets of mouths that programs write.

use crate::timeline::USUAL_STRESS;
use crate::viseme::Viseme;

/// Rhubarb's mouths (the README of Rhubarb Lip Sync describes them), as a viseme and how strong it is.
pub(super) fn rhubarb(symbol: &str) -> Option<(Viseme, f32)> {
    let (viseme, stress) = match symbol {
        "A" => (Viseme::PP, USUAL_STRESS),
        // Clenched teeth: most consonants, and "ee".
        "B" => (Viseme::SS, USUAL_STRESS),
        "C" => (Viseme::E, USUAL_STRESS),
        "D" => (Viseme::Aa, 0.6),
        // Slightly rounded.
        "E" => (Viseme::O, 0.4),
        "F" => (Viseme::U, USUAL_STRESS),
        "G" => (Viseme::FF, USUAL_STRESS),
        "H" => (Viseme::NN, USUAL_STRESS),
        "X" => (Viseme::Sil, USUAL_STRESS),
        _ => return None,
    };
    Some((viseme, stress))
}

/// The mouths of Amazon Polly, whose symbols follow X-SAMPA (its documentation lists them for each language).
pub(super) fn polly(symbol: &str) -> Option<Viseme> {
    Some(match symbol {
        "p" => Viseme::PP,
        "t" => Viseme::DD,
        "S" => Viseme::CH,
        "T" => Viseme::TH,
        "f" => Viseme::FF,
        "k" => Viseme::KK,
        "r" => Viseme::RR,
        "s" | "B" | "J" => Viseme::SS,
        "i" => Viseme::I,
        "u" => Viseme::U,
        "@" | "e" | "E" => Viseme::E,
        "a" => Viseme::Aa,
        "o" | "O" => Viseme::O,
        "sil" => Viseme::Sil,
        _ => return None,
    })
}

/// The mouths of Azure's speech service by their numbers (its documentation maps them to IPA). Two of them
/// are diphthongs, as the vowel that they begin with.
pub(super) const AZURE: [Viseme; 22] = [
    Viseme::Sil,
    Viseme::Aa,
    Viseme::Aa,
    Viseme::O,
    Viseme::E,
    Viseme::RR,
    Viseme::I,
    Viseme::U,
    Viseme::O,
    Viseme::Aa,
    Viseme::O,
    Viseme::Aa,
    Viseme::KK,
    Viseme::RR,
    Viseme::NN,
    Viseme::SS,
    Viseme::CH,
    Viseme::TH,
    Viseme::FF,
    Viseme::DD,
    Viseme::KK,
    Viseme::PP,
];
