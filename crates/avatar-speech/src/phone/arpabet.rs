use super::{Phone, STRESSES};
use crate::viseme::Viseme;

/// A symbol of ARPABET as dictionaries, TIMIT and Festival write it.
pub(super) fn phone(symbol: &str) -> Option<Phone> {
    use Viseme::{Aa, CH, DD, E, FF, I, KK, NN, O, PP, RR, SS, Sil, TH, U};
    if symbol.len() > 4 || !symbol.is_ascii() {
        return None;
    }
    let letters = symbol.trim_end_matches(|c: char| c.is_ascii_digit());
    let stress = match &symbol[letters.len()..] {
        "1" => Some(STRESSES[0]),
        "2" => Some(STRESSES[1]),
        "0" => Some(STRESSES[2]),
        "" => None,
        _ => return None,
    };
    let (one, two) = (Phone::one, Phone::two);
    let phone = match letters.to_ascii_lowercase().as_str() {
        "p" | "b" | "m" | "em" => one(PP),
        "pcl" | "bcl" => one(PP),
        "f" | "v" => one(FF),
        "th" | "dh" => one(TH),
        "t" | "d" | "dx" | "tcl" | "dcl" => one(DD),
        "k" | "g" | "kcl" | "gcl" | "ng" | "eng" | "hh" | "hv" | "h" | "q" => one(KK),
        "sh" | "zh" | "ch" | "jh" => one(CH),
        "s" | "z" => one(SS),
        "n" | "en" | "nx" | "l" | "el" => one(NN),
        "r" | "er" | "axr" => one(RR),
        // The sound at the beginning of "about".
        "ah" if stress == Some(STRESSES[2]) => one(E),
        "aa" | "ae" | "ah" => one(Aa),
        "ao" => one(O),
        "aw" => two(Aa, U),
        "ay" => two(Aa, I),
        "ax" | "ax-h" | "eh" => one(E),
        "ey" => two(E, I),
        "ih" | "ix" | "iy" | "y" => one(I),
        "ow" => two(O, U),
        "oy" => two(O, I),
        "uh" | "uw" | "ux" | "w" | "wh" => one(U),
        "pause" => one(Sil),
        _ => return None,
    };
    Some(Phone { stress, ..phone })
}
