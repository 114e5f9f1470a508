use super::{Phone, STRESSES, joined};
use crate::viseme::Viseme;

/// The signs of one sound, and nothing else but marks, are read up to here.
const MOST_SIGNS: usize = 12;

/// A symbol of the International Phonetic Alphabet: one sound, an affricate or a diphthong, with marks.
pub(super) fn phone(symbol: &str) -> Option<Phone> {
    if symbol.chars().count() > MOST_SIGNS {
        return None;
    }
    let stress = if symbol.contains(['ˈ', '\'']) {
        Some(STRESSES[0])
    } else {
        symbol.contains(['ˌ', ',']).then_some(STRESSES[1])
    };
    let mut signs = [None; MOST_SIGNS];
    let mut count = 0;
    for sign in symbol.chars().filter(|sign| !is_mark(*sign)) {
        signs[count] = Some(viseme(sign)?);
        count += 1;
    }
    let sounds = || signs[..count].iter().copied().flatten();
    let is_vowels = sounds().all(Viseme::is_vowel);
    let phone = match is_vowels {
        true => joined(sounds())?,
        // An affricate (t͡ʃ, pf) looks like its second part; where it begins with the lips, like these.
        false => Phone::one(sounds().find(|viseme| *viseme == Viseme::PP).or_else(|| sounds().last())?),
    };
    Some(Phone { stress, ..phone })
}

/// Marks of length, stress, tone and colour.
fn is_mark(sign: char) -> bool {
    matches!(sign,
        'ː' | 'ˑ' | 'ˈ' | 'ˌ' | '\'' | ',' | ':' | '.' | '|' | '‖' | '‿' | '˞' | '0'..='9' | '↗' | '↘'
        | '\u{0300}'..='\u{036f}' | '\u{02b0}'..='\u{02b8}' | '\u{02e0}'..='\u{02e9}' | '\u{1d2c}'..='\u{1d6a}'
        | '\u{2070}'..='\u{209c}' | '\u{1d9c}'..='\u{1dff}' | 'ˀ' | 'ʼ')
}

/// What a sign looks like; consonants by their place, vowels by rounding and height.
fn viseme(sign: char) -> Option<Viseme> {
    use Viseme::{Aa, CH, DD, E, FF, I, KK, NN, O, PP, RR, SS, TH, U};
    Some(match sign {
        'p' | 'b' | 'm' | 'ɓ' | 'ʙ' | 'ɸ' | 'β' | 'ʘ' => PP,
        'f' | 'v' | 'ɱ' | 'ʋ' | 'ⱱ' => FF,
        'θ' | 'ð' => TH,
        't' | 'd' | 'ʈ' | 'ɖ' | 'ɗ' | 'ɾ' | 'ǀ' | 'ǃ' | 'ᶑ' => DD,
        'k' | 'g' | 'ɡ' | 'ŋ' | 'h' | 'ɦ' | 'x' | 'ɣ' | 'χ' | 'q' | 'ɢ' | 'ɴ' | 'ʔ' | 'ħ' | 'ʕ' | 'ɠ'
        | 'ʛ' | 'c' | 'ɟ' | 'ç' | 'ʝ' | 'ʁ' | 'ʀ' | 'ɰ' | 'ɧ' => KK,
        'ʃ' | 'ʒ' | 'ɕ' | 'ʑ' | 'ʂ' | 'ʐ' | 'ʧ' | 'ʤ' => CH,
        's' | 'z' | 'ɬ' | 'ɮ' | 'ʦ' | 'ʣ' => SS,
        'n' | 'l' | 'ɳ' | 'ɲ' | 'ɭ' | 'ʎ' | 'ʟ' | 'ɫ' | 'ɺ' | 'ǁ' => NN,
        'r' | 'ɹ' | 'ɻ' | 'ɽ' | 'ɝ' | 'ɚ' => RR,
        'a' | 'ɑ' | 'ɐ' | 'ɒ' | 'æ' | 'ʌ' | 'ä' | 'ɶ' => Aa,
        'e' | 'ɛ' | 'ə' | 'ɘ' | 'ɜ' | 'ɤ' | 'ᵊ' => E,
        'i' | 'ɪ' | 'ɨ' | 'j' | 'ᵻ' | 'ɯ' => I,
        'o' | 'ɔ' | 'ø' | 'œ' | 'ɵ' | 'ɞ' => O,
        'u' | 'ʊ' | 'ʉ' | 'y' | 'ʏ' | 'w' | 'ɥ' | 'ʍ' => U,
        _ => return None,
    })
}
