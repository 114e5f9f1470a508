use std::collections::BTreeMap;

/// The same names, told apart: the second "smile" becomes "smile.2". A name that occurs once stays.
pub(crate) fn unique_names(names: Vec<String>) -> Vec<String> {
    let mut uses: BTreeMap<String, usize> = names.iter().map(|name| (name.clone(), 0)).collect();
    let mut unique = Vec::with_capacity(names.len());
    for name in names {
        let mut count = uses.get(&name).copied().unwrap_or(0) + 1;
        let mut candidate = name.clone();
        if count > 1 {
            candidate = format!("{name}.{count}");
            while uses.contains_key(&candidate) {
                count += 1;
                candidate = format!("{name}.{count}");
            }
            uses.insert(candidate.clone(), 1);
        }
        uses.insert(name, count);
        unique.push(candidate);
    }
    unique
}

#[cfg(test)]
mod tests {
    use super::unique_names;

    #[test]
    fn only_repeated_names_change() {
        let names = |all: &[&str]| unique_names(all.iter().map(|&name| name.to_owned()).collect());
        assert_eq!(names(&["a", "b", "a", "a"]), ["a", "b", "a.2", "a.3"]);
        // "a.2" stays the name of the shape that the file calls so.
        assert_eq!(names(&["a", "a", "a.2"]), ["a", "a.3", "a.2"]);
    }
}
