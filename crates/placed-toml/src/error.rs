/// Why a TOML text could not be read, and where.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("line {line}, column {column}: {}expected {expected}, found {found}{}", subject(.key), did_you_mean(.nearest.as_deref()))]
pub struct TomlError {
    /// Line, from 1.
    pub line: usize,
    /// Column in characters, from 1.
    pub column: usize,
    /// The key with its tables, such as `eyeball.iris.depth`; empty where no key is at fault.
    pub key: String,
    /// What would be right there.
    pub expected: String,
    /// What stands there instead.
    pub found: String,
    /// The nearest valid name, if the fault is a name and one is close to it.
    pub nearest: Option<String>,
}

fn subject(key: &str) -> String {
    if key.is_empty() { String::new() } else { format!("{key}: ") }
}

/// The end of an error message about a misspelt name: `; did you mean "smile"?`, or nothing without a nearest
/// name.
pub fn did_you_mean(nearest: Option<&str>) -> String {
    nearest.map(|name| format!("; did you mean {name:?}?")).unwrap_or_default()
}
