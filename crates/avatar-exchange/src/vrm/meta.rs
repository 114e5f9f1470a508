use super::place::Place;
use crate::scene::ImportError;

/// Who made an avatar, and what may be done with it. All may be empty.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Meta {
    /// Its name.
    pub title: String,
    /// Its version.
    pub version: String,
    /// Its authors.
    pub authors: Vec<String>,
    /// Name or address of its licence.
    pub licence: String,
    /// What else the file says about its maker and its use, by the names of the format: `commercialUsage` is
    /// `personalNonProfit`, `allowRedistribution` is `false` …
    pub terms: Vec<(String, String)>,
}

/// All members as texts, but for those that are known.
pub(super) fn terms(meta: &Place<'_>, known: &[&str]) -> Result<Vec<(String, String)>, ImportError> {
    let mut terms = Vec::new();
    for (key, place) in meta.all_members()? {
        let texts = place.texts();
        if !known.contains(&key) && !texts.is_empty() {
            terms.push((key.to_owned(), texts));
        }
    }
    Ok(terms)
}
