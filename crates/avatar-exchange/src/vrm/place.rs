use crate::scene::{Finding, ImportError, Note, RawScene};
use glam::Vec3;
use serde_json::Value;
use std::ops::RangeInclusive;

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
        self.get(key)?.map_or_else(|| Ok(Vec::new()), |object| object.all_members())
    }

    /// The same of this object.
    pub(super) fn all_members(&self) -> Result<Vec<(&'v str, Self)>, ImportError> {
        let members = self.value.as_object().ok_or_else(|| self.wrong("an object"))?;
        let members = members.iter().filter(|(_, value)| !value.is_null());
        Ok(members.map(|(name, value)| (name.as_str(), self.below(name, value))).collect())
    }

    /// A text, number or truth value, or a list of these, as text; empty for anything else.
    pub(super) fn texts(&self) -> String {
        match self.value {
            Value::String(text) => text.clone(),
            Value::Bool(_) | Value::Number(_) => self.value.to_string(),
            Value::Array(items) => {
                let texts: Vec<&str> = items.iter().filter_map(Value::as_str).collect();
                texts.join(", ")
            }
            _ => String::new(),
        }
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

    /// Positions in a list of this length; none where there is no such member.
    pub(super) fn indices(&self, key: &str, what: &str, length: usize) -> Result<Vec<usize>, ImportError> {
        self.list(key)?.iter().map(|index| index.index(what, length)).collect()
    }

    /// As [`Place::float_or`]; what is out of range is brought into it, with a note.
    pub(super) fn clamped(
        &self,
        key: &str,
        default: f32,
        range: RangeInclusive<f32>,
        raw: &mut RawScene,
    ) -> Result<f32, ImportError> {
        let found = self.float_or(key, default)?;
        let value = found.clamp(*range.start(), *range.end());
        if value != found {
            let text = format!("{found} is out of range: {value} is taken");
            raw.notes.push(Note::new(format!("{}.{key}", self.path), Finding::Mended(text)));
        }
        Ok(value)
    }

    /// A list of three or four numbers, as many as the default has.
    pub(super) fn floats_or<const N: usize>(
        &self,
        key: &str,
        default: [f32; N],
    ) -> Result<[f32; N], ImportError> {
        let Some(place) = self.get(key)? else { return Ok(default) };
        let numbers: Vec<f32> = self.list(key)?.iter().map(Place::float).collect::<Result<_, _>>()?;
        numbers
            .try_into()
            .map_err(|_| place.wrong(format!("{} numbers", if N == 3 { "three" } else { "four" })))
    }

    /// Three numbers.
    pub(super) fn vec3_or(&self, key: &str, default: Vec3) -> Result<Vec3, ImportError> {
        Ok(Vec3::from_array(self.floats_or(key, default.to_array())?))
    }

    /// A version that has to be 1.0 or one of its betas.
    pub(super) fn version_1(&self, key: &str) -> Result<(), ImportError> {
        let version = self.need(key)?;
        if version.str()?.starts_with("1.0") { Ok(()) } else { Err(version.wrong("version 1.0")) }
    }

    /// Whether the value is the same as that of a JSON text, which has its numbers as floats.
    pub(super) fn is(&self, text: &str) -> bool {
        same(self.value, &serde_json::from_str(text).unwrap_or_default())
    }
}

/// Equality in which 0 and 0.0 are the same.
fn same(a: &Value, b: &Value) -> bool {
    match (a, b) {
        (Value::Array(a), Value::Array(b)) => a.len() == b.len() && a.iter().zip(b).all(|(a, b)| same(a, b)),
        (Value::Number(a), Value::Number(b)) => a.as_f64() == b.as_f64(),
        (a, b) => a == b,
    }
}
