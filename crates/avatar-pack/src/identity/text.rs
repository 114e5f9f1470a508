//! The format of `identity.toml`.

use super::{Axis, EyeChange, EyeRegion, Identity, LocalMap};
use placed_toml::{Document, Entry, Field, Table, TomlError, quote, read_fields};
use std::collections::HashMap;

/// More axes, or more maps in all, are no face.
const MOST: usize = 1000;
/// Of an axis without `spread`.
const SPREAD: f32 = 0.35;
/// Larger lengths are no head, in whatever unit.
const FAR: f32 = 1e6;

const REGION: [Field<EyeRegion>; 3] = [
    Field::one("full", 0.0, FAR, |eyes| &mut eyes.full),
    Field::one("apart", 0.0, FAR, |eyes| &mut eyes.apart),
    Field::one("reach", 0.0, FAR, |eyes| &mut eyes.reach),
];

const EYE: [Field<EyeChange>; 3] = [
    Field::one("size", 0.5, 1.5, |eye| &mut eye.size),
    Field::one("tilt", -30.0, 30.0, |eye| &mut eye.tilt),
    Field::three("move", -FAR, FAR, |eye| &mut eye.shift),
];

const MAP: [Field<LocalMap>; 6] = [
    Field::three("center", -FAR, FAR, |map| &mut map.center),
    Field::three("radii", 1e-6, FAR, |map| &mut map.radii),
    Field::one("full", 0.0, 0.9, |map| &mut map.full),
    Field::three("scale", 0.1, 10.0, |map| &mut map.scale),
    Field::three("turn", -90.0, 90.0, |map| &mut map.turn),
    Field::three("move", -FAR, FAR, |map| &mut map.shift),
];

impl Identity {
    /// Reads an `identity.toml`. docs/packs.md describes the format.
    ///
    /// # Errors
    /// The first thing in the text that is not as it has to be, with its place.
    pub fn from_toml(text: &str) -> Result<Self, TomlError> {
        let document = Document::parse(text)?;
        let mut root = document.root();
        let mut read = Self::default();
        if let Some(entry) = root.take("eyes") {
            read.eyes = Some(region(&entry)?);
        }
        let axes = root.take_tables("axis")?;
        root.finish(&["eyes", "axis"])?;
        let mut reader = Reader { eyes: read.eyes, places: HashMap::new(), maps: 0 };
        for table in axes {
            let axis = reader.axis(table)?;
            read.axes.push(axis);
        }
        Ok(read)
    }
}

fn region(entry: &Entry<'_, '_>) -> Result<EyeRegion, TomlError> {
    let mut region = EyeRegion { full: 0.0, apart: 0.0, reach: 0.0 };
    read_fields(entry.table()?, &REGION, &mut region)?;
    let EyeRegion { full, apart, reach } = region;
    if full > 0.0 && full < apart && apart <= reach {
        return Ok(region);
    }
    let found = format!("full = {full}, apart = {apart}, reach = {reach}");
    Err(entry.error("0 < full < apart <= reach", found))
}

struct Reader {
    eyes: Option<EyeRegion>,
    /// Of the axes so far.
    places: HashMap<String, usize>,
    /// How many maps they have.
    maps: usize,
}

impl Reader {
    fn axis(&mut self, mut table: Table<'_, '_>) -> Result<Axis, TomlError> {
        const NAME: &str = "the name of an axis";
        let entry = table.require("name", NAME)?;
        let name = entry.string(NAME)?.to_owned();
        if self.places.contains_key(&name) {
            return Err(entry.error("a name that no other axis has", format!("{} again", quote(&name))));
        }
        if self.places.len() >= MOST {
            return Err(entry.error(format!("at most {MOST} axes"), "more"));
        }
        let mut word = |key: &str, expected: &str| -> Result<String, TomlError> {
            Ok(table.require(key, expected)?.string(expected)?.to_owned())
        };
        let less = word("less", "what a face is called at -1")?;
        let more = word("more", "what a face is called at 1")?;
        let mut axis = Axis { name, less, more, spread: SPREAD, ..Axis::default() };
        if let Some(entry) = table.take("spread") {
            axis.spread = entry.number_within(0.0..=1.0, "a number from 0 to 1")?;
        }
        axis.with = self.shares(&mut table, "with", 1.0)?;
        axis.of = self.shares(&mut table, "of", 2.0)?;
        if let Some(entry) = table.take("eye") {
            if self.eyes.is_none() {
                return Err(entry.error("a table [eyes] where an axis changes eyes", "none"));
            }
            read_fields(entry.table()?, &EYE, &mut axis.eye)?;
        }
        for map in table.take_tables("map")? {
            self.maps += 1;
            for key in ["center", "radii"] {
                if !map.entries().iter().any(|entry| entry.name() == key) {
                    return Err(map.error_here(key, "three numbers", "none"));
                }
            }
            if self.maps > MOST {
                return Err(map.error_here("map", &format!("at most {MOST} maps in all"), "more"));
            }
            let mut read = LocalMap::default();
            read_fields(map, &MAP, &mut read)?;
            axis.maps.push(read);
        }
        table.finish(&["name", "less", "more", "spread", "with", "of", "eye", "map"])?;
        self.places.insert(axis.name.clone(), self.places.len());
        Ok(axis)
    }

    /// Earlier axes and their shares.
    fn shares(
        &self,
        table: &mut Table<'_, '_>,
        key: &str,
        most: f32,
    ) -> Result<Vec<(usize, f32)>, TomlError> {
        let Some(entry) = table.take(key) else { return Ok(Vec::new()) };
        let mut shares = Vec::new();
        for share in entry.table()?.entries() {
            let Some(place) = self.places.get(share.name()) else {
                let mut known: Vec<&str> = self.places.keys().map(String::as_str).collect();
                known.sort_unstable();
                if known.is_empty() {
                    return Err(share.error("no axis before there is one", quote(share.name())));
                }
                return Err(share.unknown_name(share.name(), "an earlier axis, of", known));
            };
            let expected = format!("a number from {} to {most}", -most);
            shares.push((*place, share.number_within(-most..=most, &expected)?));
        }
        Ok(shares)
    }
}
