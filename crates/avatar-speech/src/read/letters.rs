//! Phones and letters that become sounds of a timeline.

use crate::error::{Place, SpeechError, shown};
use crate::phone::Alphabet;
use crate::timeline::{Builder, Cue, USUAL_STRESS};
use crate::viseme::Viseme;

/// Where in a diphthong the second vowel begins to be meant.
const SECOND_VOWEL: f64 = 0.55;

/// Adds a phone, a diphthong as two sounds. One that is not known is noted, and the sound before goes on.
pub(super) fn add_phone(
    builder: &mut Builder,
    place: Place,
    [start_secs, end_secs]: [f64; 2],
    symbol: &str,
    alphabet: Alphabet,
) -> Result<(), SpeechError> {
    let Some(phone) = alphabet.phone(symbol) else {
        let text = format!("{} is no phone that is known: the sound before it goes on", shown(symbol));
        builder.note(place, text);
        builder.prolong(end_secs);
        return Ok(());
    };
    let stress = phone.stress.unwrap_or(USUAL_STRESS);
    let cue = |start_secs, end_secs, viseme| Cue { start_secs, end_secs, viseme, stress };
    match phone.second {
        None => builder.add(place, cue(start_secs, end_secs, phone.first)),
        Some(second) => {
            let middle_secs = start_secs + SECOND_VOWEL * (end_secs - start_secs);
            builder.add(place, cue(start_secs, middle_secs, phone.first))?;
            builder.add(place, cue(middle_secs, end_secs, second))
        }
    }
}

/// Sounds that a word's letters suggest, with how long each lasts beside the others. Nothing is known of the
/// language: pairs of letters that mean one sound in most languages that have them, then single letters.
pub(super) fn sounds_of(word: &str, mut add: impl FnMut(Viseme, f64)) {
    use Viseme::{Aa, CH, DD, E, FF, I, KK, NN, O, PP, RR, SS, TH, U};
    const CONSONANT: f64 = 0.7;
    const VOWEL: f64 = 1.3;
    let mut letters = word.chars().flat_map(char::to_lowercase).map(bare).peekable();
    let mut before = ' ';
    while let Some(letter) = letters.next() {
        let next = letters.peek().copied().unwrap_or(' ');
        let pair = match (letter, next) {
            ('s', 'h') | ('c', 'h') => Some(CH),
            ('t', 'h') => Some(TH),
            ('p', 'h') => Some(FF),
            ('o', 'o') | ('o', 'u') => Some(U),
            ('e', 'e') | ('e', 'a') | ('i', 'e') => Some(I),
            ('c', 'k') | ('g', 'h') | ('q', 'u') => Some(KK),
            ('a', 'i' | 'y') | ('e', 'i') => Some(E),
            _ => None,
        };
        if let Some(viseme) = pair {
            letters.next();
            add(viseme, if viseme.is_vowel() { VOWEL } else { CONSONANT });
            before = next;
            continue;
        }
        let viseme = match letter {
            'p' | 'b' | 'm' | 'п' | 'б' | 'м' | 'π' | 'μ' => PP,
            'f' | 'v' | 'ф' | 'в' | 'φ' | 'β' => FF,
            't' | 'd' | 'т' | 'д' | 'τ' => DD,
            'k' | 'g' | 'c' | 'q' | 'h' | 'x' | 'к' | 'г' | 'х' | 'κ' | 'γ' | 'χ' | 'ξ' => KK,
            'j' | 'ш' | 'ж' | 'ч' | 'щ' => CH,
            's' | 'z' | 'с' | 'з' | 'ц' | 'σ' | 'ς' | 'ζ' | 'ψ' => SS,
            'n' | 'l' | 'н' | 'л' | 'ν' | 'λ' => NN,
            'r' | 'р' | 'ρ' => RR,
            'θ' | 'δ' => TH,
            'a' | 'а' | 'я' | 'α' => Aa,
            'e' | 'е' | 'э' | 'ё' | 'ε' => E,
            'i' | 'y' | 'и' | 'й' | 'ы' | 'ι' | 'η' | 'υ' => I,
            'o' | 'о' | 'ο' | 'ω' => O,
            'u' | 'w' | 'у' | 'ю' => U,
            'ь' | 'ъ' => continue,
            // Of scripts whose signs are syllables, or unknown: open a little, now so, now so.
            other if other.is_alphanumeric() => match u32::from(other) % 3 {
                0 => Aa,
                1 => E,
                _ => O,
            },
            _ => continue,
        };
        // A letter twice is one sound.
        if letter != before {
            add(viseme, if viseme.is_vowel() { VOWEL } else { CONSONANT });
        }
        before = letter;
    }
}

/// A letter without its accents.
fn bare(letter: char) -> char {
    match letter {
        'à' | 'á' | 'â' | 'ã' | 'å' | 'ā' | 'ä' | 'æ' | 'ą' | 'ά' => 'a',
        'è' | 'é' | 'ê' | 'ë' | 'ē' | 'ě' | 'ę' | 'έ' => 'e',
        'ì' | 'í' | 'î' | 'ï' | 'ī' | 'ı' | 'ί' | 'ή' | 'ύ' => 'i',
        'ò' | 'ó' | 'ô' | 'õ' | 'ö' | 'ø' | 'ō' | 'ő' | 'œ' | 'ό' | 'ώ' => 'o',
        'ù' | 'ú' | 'û' | 'ü' | 'ū' | 'ů' | 'ű' => 'u',
        'ç' | 'ß' | 'ś' => 's',
        'č' | 'ć' | 'š' | 'ž' | 'ş' => 'j',
        'ñ' | 'ń' | 'ł' => 'n',
        'ř' => 'r',
        'ý' | 'ÿ' => 'y',
        other => other,
    }
}
