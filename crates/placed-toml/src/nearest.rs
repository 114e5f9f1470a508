/// The candidate that is closest to a misspelt `name`, if one is close enough to be meant.
///
/// Distance: insertions, deletions, substitutions and swaps of neighbours, without regard to case (optimal string
/// alignment; Damerau 1964). Accepted up to a third of the name's length, at least 2, but not beyond
/// half of either name.
pub fn nearest<'a>(name: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    // A name out of a file may be of any length; what is longer than any name cannot be meant.
    let wanted: Vec<char> = name.chars().take(80).flat_map(char::to_lowercase).collect();
    let accepted = (wanted.len() / 3).max(2);
    candidates
        .into_iter()
        .map(|candidate| (distance(&wanted, candidate), candidate))
        .filter(|(distance, candidate)| {
            let shorter = wanted.len().min(candidate.chars().count());
            *distance <= accepted && 2 * distance <= shorter
        })
        .min_by_key(|(distance, _)| *distance)
        .map(|(_, candidate)| candidate)
}

fn distance(left: &[char], right: &str) -> usize {
    let right: Vec<char> = right.chars().flat_map(char::to_lowercase).collect();
    let mut before_last = Vec::new();
    let mut last: Vec<usize> = (0..=right.len()).collect();
    for (i, a) in left.iter().enumerate() {
        let mut row = vec![i + 1; right.len() + 1];
        for (j, b) in right.iter().enumerate() {
            let substitute = last[j] + usize::from(a != b);
            row[j + 1] = substitute.min(last[j + 1] + 1).min(row[j] + 1);
            if i > 0 && j > 0 && *a == right[j - 1] && left[i - 1] == *b {
                let swapped: usize = before_last[j - 1];
                row[j + 1] = row[j + 1].min(swapped + 1);
            }
        }
        before_last = std::mem::replace(&mut last, row);
    }
    last[right.len()]
}

#[cfg(test)]
mod tests {
    use super::nearest;

    const NAMES: [&str; 4] = ["head.turn", "head.bow", "lid.left.upper", "smile"];

    #[test]
    fn finds_what_is_meant() {
        assert_eq!(nearest("head.trun", NAMES), Some("head.turn"));
        assert_eq!(nearest("Smile", NAMES), Some("smile"));
        assert_eq!(nearest("lid.left.uper", NAMES), Some("lid.left.upper"));
        assert_eq!(nearest("simle", NAMES), Some("smile"));
    }

    #[test]
    fn does_not_guess_wildly() {
        assert_eq!(nearest("temperature", NAMES), None);
        assert_eq!(nearest("", NAMES), None);
        assert_eq!(nearest(&"x".repeat(1_000_000), NAMES), None);
        assert_eq!(nearest("smile", []), None);
    }
}
