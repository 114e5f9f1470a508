use super::{Name, Side, Space};
use crate::plain::plain;
use placed_toml::{Document, Entry, Table, TomlError};
use std::collections::HashMap;

const KEYS: [&str; 8] = ["title", "source", "prefix", "sides", "names", "like", "without", "order"];
const NAME_KEYS: [&str; 8] = ["name", "means", "side", "sides", "min", "max", "rest", "aliases"];

type Words = [String; 2];

/// A name, and every spelling that leads to it.
struct Spelt {
    name: Name,
    spellings: Vec<String>,
}

pub(super) fn read(key: &str, text: &str, others: &[&Space]) -> Result<Space, TomlError> {
    let document = Document::parse(text)?;
    let mut root = document.root();
    let title = root.require("title", "a text")?.string("a text")?.to_owned();
    let source = root.require("source", "a text")?.string("a text")?.to_owned();
    let prefix = match root.take("prefix") {
        Some(entry) => entry.string("what stands before each name")?,
        None => "",
    };
    let sides = root.take("sides").map(|entry| words(&entry)).transpose()?;
    let mut builder = Builder::default();
    let names = root.require("names", "an array of tables, one for each name")?;
    for entry in names.array()? {
        for spelt in of_entry(entry.table()?, prefix, sides.as_ref())? {
            builder.add(spelt, &entry)?;
        }
    }
    if let Some(like) = root.take("like") {
        let wanted = like.string("the key of a space")?;
        let keys = others.iter().map(|other| other.key.as_str());
        let other = others.iter().find(|other| other.key == wanted);
        let other = other.ok_or_else(|| like.unknown_value(wanted, "one of the spaces", keys))?;
        let without = match root.take("without") {
            Some(entry) => places(&entry, other)?,
            None => Vec::new(),
        };
        for (index, name) in other.names.iter().enumerate().filter(|(index, _)| !without.contains(index)) {
            let spellings = other.known.iter().filter(|(_, at)| **at == index);
            let spellings = spellings.map(|(spelling, _)| spelling.clone()).collect();
            builder.add(Spelt { name: name.clone(), spellings }, &like)?;
        }
    }
    let order = root.take("order");
    root.finish(&KEYS)?;
    if let Some(order) = order {
        builder.sort(&order)?;
    }
    Ok(builder.space(key, title, source))
}

/// The places of the names in an array, of both sides where they have `*`.
fn places(entry: &Entry<'_, '_>, space: &Space) -> Result<Vec<usize>, TomlError> {
    let mut found = Vec::new();
    for item in entry.array()? {
        let name = item.string("a name")?;
        match (space.pair(name), space.index(name)) {
            (Some(both), _) => found.extend(both),
            (None, Some(one)) => found.push(one),
            (None, None) => return Err(item.unknown_value(name, "one of the names", space.written())),
        }
    }
    Ok(found)
}

fn words(entry: &Entry<'_, '_>) -> Result<Words, TomlError> {
    let expected = "two texts, for the left and for the right";
    match entry.array()?.as_slice() {
        [left, right] => Ok([left.string(expected)?.to_owned(), right.string(expected)?.to_owned()]),
        _ => Err(entry.error_found(expected)),
    }
}

fn of_entry(mut table: Table<'_, '_>, prefix: &str, sides: Option<&Words>) -> Result<Vec<Spelt>, TomlError> {
    let entry = table.require("name", "a name")?;
    let name = entry.string("a name")?;
    let means = table.require("means", "a sentence")?.string("a sentence")?.to_owned();
    let own = table.take("sides").map(|entry| words(&entry)).transpose()?;
    let side = match table.take("side") {
        None => None,
        Some(entry) => match entry.string("left or right")? {
            "left" => Some(Side::Left),
            "right" => Some(Side::Right),
            other => return Err(entry.unknown_value(other, "one of", ["left", "right"])),
        },
    };
    let mut number = |key: &str, default: f32| match table.take(key) {
        Some(entry) => entry.number("a number"),
        None => Ok(default),
    };
    let (min, max) = (number("min", 0.0)?, number("max", 1.0)?);
    let rest = number("rest", 0.0)?;
    if !(min < max && (min..=max).contains(&rest)) {
        return Err(entry.error("min below max, and rest between them", format!("{min}, {max} and {rest}")));
    }
    let mut aliases = Vec::new();
    if let Some(entry) = table.take("aliases") {
        for item in entry.array()? {
            aliases.push(item.string("a name")?.to_owned());
        }
    }
    table.finish(&NAME_KEYS)?;
    let whole = format!("{prefix}{name}");
    if !name.contains('*') {
        let mut spellings = vec![plain(&whole), plain(name)];
        spellings.extend(aliases.iter().map(|alias| plain(alias)));
        let name = Name { name: whole, means, side, min, max, rest, aliases, pattern: None };
        return Ok(vec![Spelt { name, spellings }]);
    }
    let Some(words) = own.as_ref().or(sides) else {
        return Err(entry.error("a name without *, or sides that say what it stands for", name.to_owned()));
    };
    let of_side = |side: Side, word: &String| {
        let letter = side.word().get(..1).unwrap_or_default();
        let fill = |text: &str, word: &str| text.replace('*', word);
        let spellings = [whole.as_str(), name].into_iter().chain(aliases.iter().map(String::as_str));
        Spelt {
            spellings: spellings
                .flat_map(|text| [word, side.word(), letter].map(|word| plain(&fill(text, word))))
                .collect(),
            name: Name {
                name: fill(&whole, word),
                means: fill(&means, side.word()),
                side: Some(side),
                min,
                max,
                rest,
                aliases: aliases.iter().map(|alias| fill(alias, word)).collect(),
                pattern: Some(name.to_owned()),
            },
        }
    };
    Ok(Side::BOTH.into_iter().zip(words).map(|(side, word)| of_side(side, word)).collect())
}

#[derive(Default)]
struct Builder {
    names: Vec<Name>,
    known: HashMap<String, usize>,
}

impl Builder {
    fn add(&mut self, spelt: Spelt, entry: &Entry<'_, '_>) -> Result<(), TomlError> {
        let index = self.names.len();
        for spelling in spelt.spellings {
            match self.known.insert(spelling.clone(), index) {
                Some(other) if other != index => {
                    let own = &spelt.name.name;
                    let other = self.names.get(other).map_or("", |name| &name.name);
                    let found = format!("{spelling:?} for {other:?} and {own:?}");
                    return Err(entry.error("names and aliases that mean one thing each", found));
                }
                _ => {}
            }
        }
        self.names.push(spelt.name);
        Ok(())
    }

    fn sort(&mut self, order: &Entry<'_, '_>) -> Result<(), TomlError> {
        let mut from = Vec::new();
        for item in order.array()? {
            let name = item.string("a name")?;
            let names = self.names.iter().map(|name| name.name.as_str());
            let place = self.names.iter().position(|other| other.name == name);
            from.push(place.ok_or_else(|| item.unknown_value(name, "one of the names", names))?);
        }
        let mut to = vec![None; self.names.len()];
        for (new, old) in from.iter().enumerate() {
            to.get_mut(*old).into_iter().for_each(|place| *place = Some(new));
        }
        if from.len() != self.names.len() || to.contains(&None) {
            return Err(order.error(format!("each of the {} names once", to.len()), from.len().to_string()));
        }
        self.names = from.iter().filter_map(|old| self.names.get(*old).cloned()).collect();
        for place in self.known.values_mut() {
            *place = to.get(*place).copied().flatten().unwrap_or(*place);
        }
        Ok(())
    }

    fn space(self, key: &str, title: String, source: String) -> Space {
        let mut pairs: HashMap<String, [usize; 2]> = HashMap::new();
        for (index, name) in self.names.iter().enumerate() {
            if let Some(pattern) = &name.pattern {
                let both = pairs.entry(pattern.clone()).or_insert([index; 2]);
                match name.side {
                    Some(Side::Right) => both[1] = index,
                    _ => both[0] = index,
                }
            }
        }
        Space { key: key.to_owned(), title, source, names: self.names, pairs, known: self.known }
    }
}
