/// The candidate that is closest to a misspelt `name`, if one is close enough to be meant.
///
/// The distance counts insertions, deletions, substitutions and swaps of neighbours, without regard to case
/// ([`strsim::osa_distance`]). A candidate is accepted up to a third of the name's length, at least 2, but
/// not beyond half of either name.
pub fn nearest<'a>(name: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    // A name out of a file may be of any length. What follows its first 80 characters cannot be meant.
    let wanted: String = name.chars().take(80).flat_map(char::to_lowercase).collect();
    let length = wanted.chars().count();
    let accepted = (length / 3).max(2);
    candidates
        .into_iter()
        .map(|candidate| (strsim::osa_distance(&wanted, &candidate.to_lowercase()), candidate))
        .filter(|(distance, candidate)| {
            let shorter = length.min(candidate.chars().count());
            *distance <= accepted && 2 * distance <= shorter
        })
        .min_by_key(|(distance, _)| *distance)
        .map(|(_, candidate)| candidate)
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
