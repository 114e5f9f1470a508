use crate::scene::ImportError;
use serde_json::Value;

/// A value of the JSON and its place, which every error names.
#[derive(Clone, Debug)]
pub(super) struct Place<'v> {
    value: &'v Value,
    path: String,
}

impl<'v> Place<'v> {
    pub(super) fn new(value: &'v Value, path: &str) -> Self {
        Self { value, path: path.to_owned() }
    }

    pub(super) fn path(&self) -> &str {
        &self.path
    }

    pub(super) fn wrong(&self, expected: impl Into<String>) -> ImportError {
        let shown: String = self.value.to_string().chars().take(80).collect();
        ImportError::new(&self.path, expected, shown)
    }

    fn below(&self, key: &str, value: &'v Value) -> Self {
        Self { value, path: format!("{}.{key}", self.path) }
    }

    /// A member of an object; null counts as none.
    pub(super) fn get(&self, key: &str) -> Result<Option<Self>, ImportError> {
        let object = self.value.as_object().ok_or_else(|| self.wrong("an object"))?;
        Ok(object.get(key).filter(|value| !value.is_null()).map(|value| self.below(key, value)))
    }

    pub(super) fn need(&self, key: &str) -> Result<Self, ImportError> {
        let missing = || ImportError::new(&self.path, format!("a member '{key}'"), "none");
        self.get(key)?.ok_or_else(missing)
    }

    /// Members of an object in the file's order, without nulls; none where there is no such object.
    pub(super) fn members(&self, key: &str) -> Result<Vec<(&'v str, Self)>, ImportError> {
        let Some(object) = self.get(key)? else { return Ok(Vec::new()) };
        let members = object.value.as_object().ok_or_else(|| object.wrong("an object"))?;
        let members = members.iter().filter(|(_, value)| !value.is_null());
        Ok(members.map(|(name, value)| (name.as_str(), object.below(name, value))).collect())
    }

    /// Elements of a list; none where there is no such list.
    pub(super) fn list(&self, key: &str) -> Result<Vec<Self>, ImportError> {
        let Some(list) = self.get(key)? else { return Ok(Vec::new()) };
        let items = list.value.as_array().ok_or_else(|| list.wrong("a list"))?;
        let item = |(number, value)| Self { value, path: format!("{}[{number}]", list.path) };
        Ok(items.iter().enumerate().map(item).collect())
    }

    pub(super) fn str(&self) -> Result<&'v str, ImportError> {
        self.value.as_str().ok_or_else(|| self.wrong("a text"))
    }

    /// A text; empty where there is none.
    pub(super) fn text(&self, key: &str) -> Result<String, ImportError> {
        Ok(match self.get(key)? {
            Some(text) => text.str()?.to_owned(),
            None => String::new(),
        })
    }

    pub(super) fn flag(&self, key: &str) -> Result<bool, ImportError> {
        match self.get(key)? {
            Some(flag) => flag.value.as_bool().ok_or_else(|| flag.wrong("true or false")),
            None => Ok(false),
        }
    }

    pub(super) fn float(&self) -> Result<f32, ImportError> {
        let number = self.value.as_f64().map(|number| number as f32);
        number.filter(|number| number.is_finite()).ok_or_else(|| self.wrong("a finite number"))
    }

    pub(super) fn float_or(&self, key: &str, default: f32) -> Result<f32, ImportError> {
        self.get(key)?.map_or(Ok(default), |number| number.float())
    }

    /// A position in a list of this length.
    pub(super) fn index(&self, what: &str, length: usize) -> Result<usize, ImportError> {
        let index = self.value.as_u64().and_then(|index| usize::try_from(index).ok());
        index.filter(|index| *index < length).ok_or_else(|| self.wrong(format!("{what} below {length}")))
    }

    /// As [`Place::index`]; `None` for −1, by which older files say that there is none.
    pub(super) fn index_or_none(&self, what: &str, length: usize) -> Result<Option<usize>, ImportError> {
        if self.value.as_i64() == Some(-1) { Ok(None) } else { self.index(what, length).map(Some) }
    }
}
