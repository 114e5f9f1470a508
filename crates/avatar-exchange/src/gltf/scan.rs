//! What the structures of the JSON drop without a word, found in a pass of its own.

use serde::de::{DeserializeSeed, Deserializer, Error, IgnoredAny, MapAccess, SeqAccess, Visitor};
use std::collections::BTreeSet;
use std::fmt;

/// Names that occur in a JSON text.
#[derive(Debug, Default)]
pub(super) struct Found {
    /// All extensions that some object has, whether the file lists them or not.
    pub(super) extensions: BTreeSet<String>,
    /// What morph targets move beside positions, normals and tangents.
    pub(super) target_attributes: BTreeSet<String>,
}

/// Members of a target that the structures have, or that say nothing of geometry.
const MOVED: [&str; 4] = ["POSITION", "NORMAL", "TANGENT", "extensions"];

/// Reads a text that was read before: what is wrong in it ends the list early, and is an error elsewhere.
pub(super) fn scan(text: &[u8]) -> Found {
    let mut found = Found::default();
    let mut json = serde_json::Deserializer::from_slice(text);
    let _ = Walk { found: &mut found, at: At::Value }.deserialize(&mut json);
    found
}

#[derive(Clone, Copy, PartialEq)]
enum At {
    /// Anything of glTF.
    Value,
    /// An object whose members are extensions.
    Extensions,
    /// Anything inside an extension, where only further extensions count.
    Extension,
    /// The list of a primitive's targets, and one of them.
    Targets,
    Target,
}

struct Walk<'f> {
    found: &'f mut Found,
    at: At,
}

impl<'de> DeserializeSeed<'de> for Walk<'_> {
    type Value = ();
    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<(), D::Error> {
        deserializer.deserialize_any(self)
    }
}

impl<'de> Visitor<'de> for Walk<'_> {
    type Value = ();

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("JSON")
    }

    fn visit_bool<E: Error>(self, _: bool) -> Result<(), E> {
        Ok(())
    }

    fn visit_i64<E: Error>(self, _: i64) -> Result<(), E> {
        Ok(())
    }

    fn visit_u64<E: Error>(self, _: u64) -> Result<(), E> {
        Ok(())
    }

    fn visit_f64<E: Error>(self, _: f64) -> Result<(), E> {
        Ok(())
    }

    fn visit_str<E: Error>(self, _: &str) -> Result<(), E> {
        Ok(())
    }

    fn visit_unit<E: Error>(self) -> Result<(), E> {
        Ok(())
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<(), A::Error> {
        let at = if self.at == At::Targets { At::Target } else { self.at };
        while list.next_element_seed(Walk { found: &mut *self.found, at })?.is_some() {}
        Ok(())
    }

    fn visit_map<A: MapAccess<'de>>(self, mut object: A) -> Result<(), A::Error> {
        while let Some(key) = object.next_key::<String>()? {
            let at = match (self.at, key.as_str()) {
                (At::Extensions, _) => At::Extension,
                (_, "extensions") => At::Extensions,
                (At::Value | At::Target, "extras") => {
                    object.next_value::<IgnoredAny>()?;
                    continue;
                }
                (At::Value, "targets") => At::Targets,
                (at, _) => at,
            };
            match self.at {
                At::Extensions => {
                    self.found.extensions.insert(key);
                }
                At::Target if !MOVED.contains(&key.as_str()) => {
                    self.found.target_attributes.insert(key);
                }
                _ => {}
            }
            object.next_value_seed(Walk { found: &mut *self.found, at })?;
        }
        Ok(())
    }
}
