//! What is read, and the messages about what cannot be read.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use placed_toml::{Document, Entry, Field, TomlError, read_field, read_fields};
use proptest::prelude::*;

/// Reads the value of `key` by `read`.
fn value<T>(text: &str, read: impl Fn(&Entry<'_, '_>) -> Result<T, TomlError>) -> Result<T, TomlError> {
    let document = Document::parse(text)?;
    read(&document.root().require("key", "a value")?)
}

fn place<T: std::fmt::Debug>(result: Result<T, TomlError>) -> (usize, usize, String) {
    let error = result.unwrap_err();
    (error.line, error.column, error.found)
}

#[test]
fn places_are_lines_and_characters() {
    let number = |text: &str| place(value(text, |entry| entry.number("a number")));
    assert_eq!(number("key = true"), (1, 7, "true".into()));
    assert_eq!(number("# é\n\nkey = \"é\""), (3, 7, "\"é\"".into()));
    // The byte-order mark does not count as a column.
    assert_eq!(number("\u{feff}key = []"), (1, 7, "an array of 0".into()));
    assert_eq!(number("\"é\" = 1\r\nkey = {}"), (2, 7, "a table".into()));
    // In characters, not in bytes.
    let same_line = value("é = 1", |entry| entry.number("a number"));
    assert_eq!((same_line.as_ref().unwrap_err().line, place(same_line).1), (1, 1));
    let nested = |text| place(value(text, |entry| entry.table()?.require("x", "X")?.number("a number")));
    assert_eq!(nested("key = { \"éé\" = 1, x = 2e9 }"), (1, 23, "2e9".into()));
}

#[test]
fn keys_are_named_with_their_tables() {
    let key = |text: &str| {
        let document = Document::parse(text).unwrap();
        let mut table = document.root();
        while let Some(entry) = table.entries().first().cloned() {
            match entry.as_table() {
                Some(inner) => table = inner,
                None => return entry.path().to_owned(),
            }
        }
        unreachable!("a value")
    };
    assert_eq!(key("[eyeball.iris]\ndepth = 1"), "eyeball.iris.depth");
    assert_eq!(key("[pose]\n\"head.turn\" = 1"), "pose.\"head.turn\"");
    assert_eq!(key("\"\" = 1"), "\"\"");
    assert_eq!(key(&format!("{} = 1", "x".repeat(99))), format!("\"{}\"…", "x".repeat(60)));
}

#[test]
fn tables_tell_what_they_lack_and_what_they_should_not_have() {
    let document = Document::parse("[lamp]\nradiance = 1\ncolor = 2\n").unwrap();
    let lamp = || document.root().require("lamp", "a table").unwrap().table().unwrap();
    let missing = lamp().require("name", "the name of a lamp").unwrap_err();
    assert_eq!(missing.to_string(), "line 1, column 1: lamp.name: expected the name of a lamp, found none");
    let mut table = lamp();
    assert_eq!(table.take("radiance").unwrap().number("a number"), Ok(1.0));
    assert_eq!(table.take("radiance").map(|entry| entry.name().to_owned()), None, "taken");
    let unknown = table.clone().finish(&["radiance", "colour"]).unwrap_err();
    assert_eq!(
        unknown.to_string(),
        "line 3, column 1: lamp.color: expected one of the keys radiance, colour, found \"color\"; did you mean \"colour\"?"
    );
    table.take("color");
    assert_eq!(table.finish(&[]), Ok(()));
}

#[test]
fn lists_of_tables_are_read_in_order() {
    let document = Document::parse("[[lamp]]\nx = 1\n[[lamp]]\nx = 2\n[[other]]\n").unwrap();
    let mut root = document.root();
    let numbers: Vec<_> = (root.take_tables("lamp").unwrap().into_iter())
        .map(|mut table| table.require("x", "X").unwrap().number("a number").unwrap())
        .collect();
    assert_eq!(numbers, [1.0, 2.0]);
    assert_eq!(root.take_tables("none").unwrap().len(), 0);
    let document = Document::parse("lamp = 3").unwrap();
    let error = document.root().take_tables("lamp").unwrap_err();
    assert_eq!((error.expected.as_str(), error.found.as_str()), ("tables that begin with [[lamp]]", "3"));
}

#[test]
fn numbers_are_finite_and_in_range() {
    let number = |text: &str| value(&format!("key = {text}"), |entry| entry.number("a number"));
    assert_eq!(number("0x10"), Ok(16.0));
    assert_eq!(number("1_000.5"), Ok(1000.5));
    assert_eq!(number("-1e9"), Ok(-1e9));
    for text in ["nan", "-inf", "1e10", "99999999999999999999", "\"1\"", "[1]"] {
        assert_eq!(number(text).unwrap_err().expected, "a number", "{text}");
    }
    let share =
        |text: &str| value(&format!("key = {text}"), |entry| entry.number_within(0.0..=1.0, "a share"));
    assert_eq!((share("0"), share("1.0"), share("0.1")), (Ok(0.0), Ok(1.0), Ok(0.1)));
    for text in ["-0.001", "1.001", "nan", "inf", "2"] {
        assert_eq!(share(text).unwrap_err().found, text);
    }
    let natural = |text: &str| value(&format!("key = {text}"), |entry| entry.natural("a whole number")).ok();
    assert_eq!(natural("18446744073709551615"), Some(u64::MAX));
    assert_eq!((natural("0b101"), natural("0")), (Some(5), Some(0)));
    for text in ["-1", "1.0", "18446744073709551616", "true"] {
        assert_eq!(natural(text), None, "{text}");
    }
}

#[test]
fn flags_are_true_or_false() {
    let flag = |text: &str| value(&format!("key = {text}"), |entry| entry.flag());
    assert_eq!((flag("true"), flag("false")), (Ok(true), Ok(false)));
    for text in ["1", "\"true\"", "[true]"] {
        assert_eq!(flag(text).unwrap_err().expected, "true or false", "{text}");
    }
}

#[test]
fn texts_have_something_in_them() {
    let string = |text: &str| value(text, |entry| entry.string("a name").map(str::to_owned));
    assert_eq!(string("key = ' a '"), Ok(" a ".into()));
    assert_eq!(
        string("key = '  '").unwrap_err().to_string(),
        "line 1, column 7: key: expected a name, found \"  \""
    );
    let unknown = value("key = 'smal'", |entry| -> Result<(), _> {
        Err(entry.unknown_value("smal", "one of", ["small", "large"]))
    });
    assert_eq!(
        unknown.unwrap_err().to_string(),
        "line 1, column 7: key: expected one of small, large, found \"smal\"; did you mean \"small\"?"
    );
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Lamp {
    radiance: f32,
    color: [f32; 3],
}

const FIELDS: [Field<Lamp>; 2] = [
    Field::one("radiance", 0.0, 100.0, |lamp| &mut lamp.radiance),
    Field::three("color", -1.0, 1.0, |lamp| &mut lamp.color),
];

fn lamp(text: &str) -> Result<Lamp, TomlError> {
    let mut lamp = Lamp { radiance: 7.0, color: [0.0; 3] };
    read_fields(Document::parse(text)?.root(), &FIELDS, &mut lamp)?;
    Ok(lamp)
}

#[test]
fn fields_are_read_by_their_table() {
    assert_eq!(lamp("color = [1, -0.5, 0]"), Ok(Lamp { radiance: 7.0, color: [1.0, -0.5, 0.0] }));
    for (text, message) in [
        ("radiance = 100.5", "line 1, column 12: radiance: expected a number from 0 to 100, found 100.5"),
        (
            "radiance = [1, 2, 3]",
            "line 1, column 12: radiance: expected a number from 0 to 100, found an array of 3",
        ),
        (
            "color = [0, 0, nan]",
            "line 1, column 16: color: expected an array of three numbers from -1 to 1, found nan",
        ),
        (
            "color = [0, 0]",
            "line 1, column 9: color: expected an array of three numbers from -1 to 1, found an array of 2",
        ),
        (
            "radience = 1",
            "line 1, column 1: radience: expected one of the keys radiance, color, found \"radience\"; did you mean \"radiance\"?",
        ),
    ] {
        assert_eq!(lamp(text).unwrap_err().to_string(), message);
    }
    // What may stand beside the fields is named, too.
    let document = Document::parse("iirs = 1").unwrap();
    let mut read = Lamp { radiance: 1.0, color: [0.0; 3] };
    let error = read_field(&document.root().entries()[0], &FIELDS, &["iris"], &mut read).unwrap_err();
    assert_eq!(
        (error.expected.as_str(), error.nearest.as_deref()),
        ("one of the keys radiance, color, iris", Some("iris"))
    );
}

proptest! {
    #[test]
    fn what_is_written_is_read_again(radiance in 0.0f32..=100.0, color in prop::array::uniform3(-1.0f32..=1.0)) {
        let written = Lamp { radiance, color };
        let text: String = FIELDS.iter().map(|field| field.line(&written)).collect();
        prop_assert_eq!(lamp(&text), Ok(written));
    }

    #[test]
    fn no_text_panics_and_every_place_is_in_it(text in "(\\PC|[\n\\[\\]='\"{}.,]){0,120}") {
        let places = match lamp(&text) {
            Ok(_) => return Ok(()),
            Err(error) => error,
        };
        let lines: Vec<&str> = text.split('\n').collect();
        prop_assert!(places.line >= 1 && places.line <= lines.len());
        prop_assert!(places.column >= 1 && places.column <= lines[places.line - 1].chars().count() + 1);
    }
}
