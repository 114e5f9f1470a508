use super::Table;
use crate::text::{Text, describe, quote};
use crate::{TomlError, nearest};
use std::ops::{Range, RangeInclusive};
use toml::Spanned;
use toml::de::DeValue;

/// Numbers beyond this, positive or negative, are refused: no file about faces needs them.
pub const LARGEST: f64 = 1e9;

/// A key with its value, or an item of an array, which has the array's key.
#[derive(Clone, Debug)]
pub struct Entry<'t, 'a> {
    pub(super) text: Text<'a>,
    pub(super) name: String,
    pub(super) path: String,
    pub(super) key_span: Range<usize>,
    pub(super) value: &'t Spanned<DeValue<'a>>,
}

impl<'t, 'a> Entry<'t, 'a> {
    /// The key, as it is meant: without quotes.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The key behind those of its tables, as errors show it: `eyeball.iris.depth`.
    pub fn path(&self) -> &str {
        &self.path
    }

    /// An error at the value.
    pub fn error(&self, expected: impl Into<String>, found: impl Into<String>) -> TomlError {
        self.text.error(&self.value.span(), &self.path, expected, found)
    }

    /// An error at the value, which is shown.
    pub fn error_found(&self, expected: impl Into<String>) -> TomlError {
        self.error(expected, describe(self.value.get_ref()))
    }

    /// An error at the key: a name that is not in `valid`, of which the nearest is suggested. `what` stands
    /// before their list: "one of the keys".
    pub fn unknown_name<'n>(
        &self,
        name: &str,
        what: &str,
        valid: impl IntoIterator<Item = &'n str>,
    ) -> TomlError {
        self.unknown_at(&self.key_span, name, what, valid)
    }

    /// As [`Self::unknown_name`], for a name that stands as a value.
    pub fn unknown_value<'n>(
        &self,
        name: &str,
        what: &str,
        valid: impl IntoIterator<Item = &'n str>,
    ) -> TomlError {
        self.unknown_at(&self.value.span(), name, what, valid)
    }

    fn unknown_at<'n>(
        &self,
        span: &Range<usize>,
        name: &str,
        what: &str,
        valid: impl IntoIterator<Item = &'n str>,
    ) -> TomlError {
        let valid: Vec<_> = valid.into_iter().collect();
        let expected = format!("{what} {}", valid.join(", "));
        let nearest = nearest(name, valid).map(str::to_owned);
        TomlError { nearest, ..self.text.error(span, &self.path, expected, quote(name)) }
    }

    /// The value as a text, if it is a text.
    pub fn as_str(&self) -> Option<&'t str> {
        match self.value.get_ref() {
            DeValue::String(text) => Some(text),
            _ => None,
        }
    }

    /// The value as a table, if it is one.
    pub fn as_table(&self) -> Option<Table<'t, 'a>> {
        match self.value.get_ref() {
            DeValue::Table(table) => Some(Table::new(self.text, &self.path, self.value.span(), table)),
            _ => None,
        }
    }

    /// The items of the value, if it is an array.
    pub fn as_array(&self) -> Option<Vec<Entry<'t, 'a>>> {
        match self.value.get_ref() {
            DeValue::Array(items) => {
                Some(items.iter().map(|value| Entry { value, ..self.clone() }).collect())
            }
            _ => None,
        }
    }

    /// The value, which must be a table.
    ///
    /// # Errors
    /// The value has another type or is out of bounds.
    pub fn table(&self) -> Result<Table<'t, 'a>, TomlError> {
        self.as_table().ok_or_else(|| self.error_found("a table"))
    }

    /// The items of the value, which must be an array.
    ///
    /// # Errors
    /// The value has another type or is out of bounds.
    pub fn array(&self) -> Result<Vec<Entry<'t, 'a>>, TomlError> {
        self.as_array().ok_or_else(|| self.error_found("an array"))
    }

    /// The value, which must be a text with something in it.
    ///
    /// # Errors
    /// The value is not a text, or blank.
    pub fn string(&self, expected: &str) -> Result<&'t str, TomlError> {
        self.as_str().filter(|text| !text.trim().is_empty()).ok_or_else(|| self.error_found(expected))
    }

    /// The value, which must be true or false.
    ///
    /// # Errors
    /// The value has another type.
    pub fn flag(&self) -> Result<bool, TomlError> {
        match self.value.get_ref() {
            DeValue::Boolean(value) => Ok(*value),
            _ => Err(self.error_found("true or false")),
        }
    }

    /// The value, which must be a finite number of at most [`LARGEST`], either way.
    ///
    /// # Errors
    /// The value has another type or is out of bounds.
    pub fn number(&self, expected: &str) -> Result<f32, TomlError> {
        self.precise(expected).map(|number| number as f32)
    }

    /// As [`Self::number`], in full precision.
    ///
    /// # Errors
    /// As [`Self::number`].
    pub fn precise(&self, expected: &str) -> Result<f64, TomlError> {
        let number = match self.value.get_ref() {
            DeValue::Integer(number) => {
                i64::from_str_radix(number.as_str(), number.radix()).ok().map(|number| number as f64)
            }
            DeValue::Float(number) => number.as_str().parse().ok(),
            _ => None,
        };
        // NaN is not below anything.
        number.filter(|number| f64::abs(*number) <= LARGEST).ok_or_else(|| self.error_found(expected))
    }

    /// The value, which must be a number in a range.
    ///
    /// # Errors
    /// The value is not a number, or outside the range.
    pub fn number_within(&self, range: RangeInclusive<f32>, expected: &str) -> Result<f32, TomlError> {
        let number = match self.value.get_ref() {
            // Not by way of f64: what was written from an f32 is to be read as the same.
            DeValue::Float(number) => number.as_str().parse().ok(),
            _ => self.number(expected).ok(),
        };
        number.filter(|number| range.contains(number)).ok_or_else(|| self.error_found(expected))
    }

    /// The value, which must be a whole number from 0 to 2⁶⁴ − 1.
    ///
    /// # Errors
    /// The value has another type or is out of bounds.
    pub fn natural(&self, expected: &str) -> Result<u64, TomlError> {
        let number = match self.value.get_ref() {
            DeValue::Integer(number) => u64::from_str_radix(number.as_str(), number.radix()).ok(),
            _ => None,
        };
        number.ok_or_else(|| self.error_found(expected))
    }
}
