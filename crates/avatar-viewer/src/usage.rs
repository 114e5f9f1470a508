/// The command line has to be corrected: exit status 2.
#[derive(Debug, thiserror::Error)]
#[error("{0}")]
pub(crate) struct UsageError(pub(crate) String);

/// A [`UsageError`] that names what was expected and found.
pub(crate) fn usage(message: impl Into<String>) -> anyhow::Error {
    UsageError(message.into()).into()
}

/// As [`usage`], for a name that is not in the pack, with the names that are.
pub(crate) fn unknown<'a>(what: &str, found: &str, names: impl Iterator<Item = &'a str>) -> anyhow::Error {
    let names: Vec<_> = names.collect();
    usage(format!("expected the name of a {what}, found {found:?}; there are: {}", names.join(", ")))
}
