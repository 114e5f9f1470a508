//! Lists of names in texts that are compiled in.

/// The sections of a text: a heading in brackets, then one entry a line. Empty lines and lines that begin
/// with `#` are left out.
pub(super) fn sections(text: &'static str) -> Vec<(&'static str, Vec<&'static str>)> {
    let mut sections: Vec<(&str, Vec<&str>)> = Vec::new();
    for line in text.lines().map(str::trim).filter(|line| !line.is_empty() && !line.starts_with('#')) {
        match (line.strip_prefix('[').and_then(|rest| rest.strip_suffix(']')), sections.last_mut()) {
            (Some(heading), _) => sections.push((heading, Vec::new())),
            (None, Some((_, entries))) => entries.push(line),
            (None, None) => {}
        }
    }
    sections
}

#[cfg(test)]
mod tests {
    use super::sections;

    #[test]
    fn sections_have_their_lines_without_comments() {
        let found = sections("# a comment\nnowhere\n[one]\n a b \n\n# another\nc\n[two]\n");
        assert_eq!(found, [("one", vec!["a b", "c"]), ("two", vec![])]);
    }
}
