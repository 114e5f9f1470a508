//! Arrays of numbers or names, and which elements read them.

use super::Reader;
use super::xml::At;
use crate::scene::ImportError;
use std::rc::Rc;

/// An array as an accessor sees it.
#[derive(Debug, Default)]
pub(super) struct Source {
    numbers: Vec<f64>,
    /// Words, of arrays of names.
    pub(super) names: Vec<String>,
    stride: usize,
    offset: usize,
    /// Number of items.
    pub(super) count: usize,
}

impl Source {
    /// The numbers of an item; none beyond the array.
    pub(super) fn item(&self, number: usize) -> Option<&[f64]> {
        let start = number.checked_mul(self.stride)?.checked_add(self.offset)?;
        if number < self.count { self.numbers.get(start..start.checked_add(self.stride)?) } else { None }
    }

    /// All items one after the other, and how many numbers each has.
    pub(super) fn flat(&self) -> (Vec<f64>, usize) {
        ((0..self.count).filter_map(|item| self.item(item)).flatten().copied().collect(), self.stride)
    }
}

/// An `<input>`.
#[derive(Clone, Debug)]
pub(super) struct Input<'a> {
    pub(super) semantic: &'a str,
    pub(super) source: At<'a>,
    pub(super) offset: usize,
    pub(super) set: usize,
}

/// The inputs of an element. Offsets are bounded, since a group of indices is as long as the largest.
pub(super) fn inputs<'a>(at: At<'a>) -> Result<Vec<Input<'a>>, ImportError> {
    let input = |input: At<'a>| {
        let number = |key| input.attribute(key).and_then(|text| text.trim().parse().ok()).unwrap_or(0);
        let (offset, set) = (number("offset"), number("set"));
        if offset > 255 {
            return Err(input.error("an offset up to 255", offset.to_string()));
        }
        let semantic = input.attribute("semantic").unwrap_or("");
        Ok(Input { semantic, source: input.target("source")?, offset, set })
    };
    at.all("input").map(input).collect()
}

impl<'a> Reader<'a> {
    /// Reads a `<source>`, or finds it as read before.
    pub(super) fn source(&mut self, at: At<'a>) -> Result<Rc<Source>, ImportError> {
        if let Some(known) = self.sources.get(&at.number) {
            return Ok(known.clone());
        }
        let source = Rc::new(read(at)?);
        self.sources.insert(at.number, source.clone());
        Ok(source)
    }

    /// The source of the first input with a meaning.
    pub(super) fn source_of(
        &mut self,
        at: At<'a>,
        semantic: &str,
    ) -> Result<Option<Rc<Source>>, ImportError> {
        let found = inputs(at)?.into_iter().find(|input| input.semantic == semantic);
        found.map(|input| self.source(input.source)).transpose()
    }
}

fn read(at: At<'_>) -> Result<Source, ImportError> {
    let accessor = at.path(&["technique_common", "accessor"]);
    let is_array = |at: &At<'_>| at.name().ends_with("_array");
    // Accessors may read an array of another source.
    let of_accessor = accessor.and_then(|accessor| accessor.target("source").ok()).filter(is_array);
    let Some(array) = of_accessor.or_else(|| at.children().find(is_array)) else {
        return Err(at.error("a source with an array", format!("<{}> without", at.name())));
    };
    let mut source = Source { stride: 1, ..Source::default() };
    match array.name() {
        "float_array" | "int_array" => source.numbers = array.numbers()?,
        _ => source.names = array.text().split_whitespace().map(str::to_owned).collect(),
    }
    let length = source.numbers.len().max(source.names.len());
    let number = |key, default| match accessor.and_then(|accessor| accessor.attribute(key)) {
        Some(text) => text.trim().parse().map_err(|_| at.error(format!("a whole number as '{key}'"), text)),
        None => Ok(default),
    };
    source.stride = number("stride", 1)?;
    source.offset = number("offset", 0)?;
    if source.stride == 0 || source.stride > 256 {
        return Err(at.error("a stride from 1 to 256", source.stride.to_string()));
    }
    let fits = length.saturating_sub(source.offset) / source.stride;
    let count = number("count", fits)?;
    if count > fits {
        return Err(at.error(format!("{count} items"), fits.to_string()));
    }
    source.count = count;
    Ok(source)
}
