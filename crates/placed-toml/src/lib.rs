//! Reads TOML by hand, so that every mistake is told with its place: line and column, key, what would be
//! right there, what stands there, and the nearest valid name. Deserialising into structs would lose the
//! place of a value that has the right type but a wrong content.
//!
//! ```text
//!  text ─Document::parse─▶ Document ─root─▶ Table ─take, require, finish─▶ Entry ─number, string …─▶ values
//!                                             └─read_fields(FIELDS)─▶ the numbers of a struct, by its keys
//! ```
//!
//! ```
//! use placed_toml::{Document, Field, TomlError, read_fields};
//!
//! #[derive(Clone, Copy)]
//! struct Lamp {
//!     radiance: f32,
//!     color: [f32; 3],
//! }
//! const FIELDS: [Field<Lamp>; 2] = [
//!     Field::one("radiance", 0.0, 100.0, |lamp| &mut lamp.radiance),
//!     Field::three("color", 0.0, 1.0, |lamp| &mut lamp.color),
//! ];
//! fn read(text: &str) -> Result<Lamp, TomlError> {
//!     let mut lamp = Lamp { radiance: 1.0, color: [1.0; 3] };
//!     let document = Document::parse(text)?;
//!     let mut root = document.root();
//!     if let Some(entry) = root.take("lamp") {
//!         read_fields(entry.table()?, &FIELDS, &mut lamp)?;
//!     }
//!     root.finish(&["lamp"])?;
//!     Ok(lamp)
//! }
//! assert_eq!(read("[lamp]\nradiance = 3").unwrap().radiance, 3.0);
//! let error = read("[lamp]\ncolour = [1, 1, 1]").err().unwrap();
//! assert_eq!(
//!     error.to_string(),
//!     "line 2, column 1: lamp.colour: expected one of the keys radiance, color, \
//!      found \"colour\"; did you mean \"color\"?"
//! );
//! ```
//!
//! This crate knows no files and no clock. No text makes it panic.

mod nearest;
mod error;
mod text;
mod table;
mod field;

pub use error::{TomlError, did_you_mean};
pub use field::{Field, Slot, read_field, read_fields};
pub use nearest::nearest;
pub use table::{Document, Entry, LARGEST, Table};
pub use text::{quote, string};
