/// The candidate that is closest to a misspelt `name`, if one is close enough to be meant.
///
/// Distance: insertions, deletions and substitutions, without regard to case (V. Levenshtein, 1966). Accepted up to a
/// third of the name's length, at least 2, but not beyond half of either name.
pub(crate) fn nearest<'a>(name: &str, candidates: impl Iterator<Item = &'a str>) -> Option<&'a str> {
    // A name out of a file may be of any length; what is longer than any name cannot be meant.
    let wanted: Vec<char> = name.chars().take(80).flat_map(char::to_lowercase).collect();
    let accepted = (wanted.len() / 3).max(2);
    candidates
        .map(|candidate| (distance(&wanted, candidate), candidate))
        .filter(|(distance, candidate)| {
            *distance <= accepted && 2 * distance <= wanted.len().min(candidate.chars().count())
        })
        .min_by_key(|(distance, _)| *distance)
        .map(|(_, candidate)| candidate)
}

fn distance(left: &[char], right: &str) -> usize {
    let mut row: Vec<usize> = (0..=left.len()).collect();
    for (i, b) in right.chars().flat_map(char::to_lowercase).enumerate() {
        let mut diagonal = row[0];
        row[0] = i + 1;
        for (j, a) in left.iter().enumerate() {
            let substituted = diagonal + usize::from(*a != b);
            diagonal = row[j + 1];
            row[j + 1] = substituted.min(diagonal + 1).min(row[j] + 1);
        }
    }
    row[left.len()]
}

#[cfg(test)]
mod tests {
    use super::nearest;

    const NAMES: [&str; 4] = ["color", "roughness_matte", "left-eyeball", "iris"];

    #[test]
    fn finds_what_is_meant_and_does_not_guess_wildly() {
        let find = |name: &str| nearest(name, NAMES.into_iter());
        assert_eq!(find("colour"), Some("color"));
        assert_eq!(find("roughness-matt"), Some("roughness_matte"));
        assert_eq!(find("Left-Eyebal"), Some("left-eyeball"));
        assert_eq!(find("temperature"), None);
        assert_eq!(find(""), None);
        assert_eq!(find(&"x".repeat(1_000_000)), None);
    }
}
