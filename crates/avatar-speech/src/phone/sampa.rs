use super::{Phone, STRESSES, ipa};

/// Longer symbols are no phones.
const MOST_LETTERS: usize = 12;

/// A symbol of SAMPA or X-SAMPA: written in IPA first, and read as that.
pub(super) fn phone(symbol: &str) -> Option<Phone> {
    if symbol.len() > MOST_LETTERS || !symbol.is_ascii() {
        return None;
    }
    let stress = if symbol.contains(['"', '\'']) {
        Some(STRESSES[0])
    } else {
        symbol.contains('%').then_some(STRESSES[1])
    };
    let mut in_ipa = String::with_capacity(2 * MOST_LETTERS);
    let mut letters = symbol.chars().peekable();
    while let Some(letter) = letters.next() {
        // A backslash or hook makes another sign of the letter before.
        match letters.next_if(|next| matches!(next, '\\' | '`')) {
            Some('\\') => in_ipa.push(with_backslash(letter)?),
            Some(_) => in_ipa.push(with_hook(letter)?),
            None => match letter {
                '_' => {
                    // What follows an underscore describes the sign before: _h, _j, _0 …
                    letters.next();
                }
                '"' | '%' | '\'' | '~' | '=' | '-' | '!' | '^' | '*' | ';' => {}
                letter => in_ipa.push(plain(letter)),
            },
        }
    }
    Some(Phone { stress, ..ipa::phone(&in_ipa)? })
}

/// The sign that a letter alone stands for.
fn plain(letter: char) -> char {
    match letter {
        'A' => 'ɑ',
        'B' => 'β',
        'C' => 'ç',
        'D' => 'ð',
        'E' => 'ɛ',
        'F' => 'ɱ',
        'G' => 'ɣ',
        'H' => 'ɥ',
        'I' => 'ɪ',
        'J' => 'ɲ',
        'K' => 'ɬ',
        'L' => 'ʎ',
        'M' => 'ɯ',
        'N' => 'ŋ',
        'O' => 'ɔ',
        'P' => 'ʋ',
        'Q' => 'ɒ',
        'R' => 'ʁ',
        'S' => 'ʃ',
        'T' => 'θ',
        'U' => 'ʊ',
        'V' => 'ʌ',
        'W' => 'ʍ',
        'X' => 'χ',
        'Y' => 'ʏ',
        'Z' => 'ʒ',
        '@' => 'ə',
        '{' => 'æ',
        '}' => 'ʉ',
        '?' => 'ʔ',
        '&' => 'ɶ',
        '1' => 'ɨ',
        '2' => 'ø',
        '3' => 'ɜ',
        '4' => 'ɾ',
        '6' => 'ɐ',
        '7' => 'ɤ',
        '8' => 'ɵ',
        '9' => 'œ',
        other => other,
    }
}

fn with_backslash(letter: char) -> Option<char> {
    Some(match letter {
        'r' => 'ɹ',
        'h' => 'ɦ',
        'j' => 'ʝ',
        's' => 'ɕ',
        'z' => 'ʑ',
        'p' => 'ɸ',
        'v' => 'ʋ',
        'x' => 'ɧ',
        'l' => 'ɺ',
        'J' => 'ɟ',
        'L' => 'ʟ',
        'M' => 'ɰ',
        'N' => 'ɴ',
        'R' => 'ʀ',
        'B' => 'ʙ',
        'G' => 'ɢ',
        'H' | 'X' => 'ħ',
        'I' | 'U' => 'ɪ',
        '3' => 'ɞ',
        '@' => 'ɘ',
        '?' => 'ʕ',
        'O' => 'ʘ',
        _ => return None,
    })
}

fn with_hook(letter: char) -> Option<char> {
    Some(match letter {
        'r' => 'ɻ',
        's' => 'ʂ',
        'z' => 'ʐ',
        't' => 'ʈ',
        'd' => 'ɖ',
        'n' => 'ɳ',
        'l' => 'ɭ',
        '@' => 'ɚ',
        '3' => 'ɝ',
        _ => return None,
    })
}
