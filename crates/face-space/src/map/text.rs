use super::{Map, Rule, Term};
use crate::plain::plain;
use crate::space::Space;
use placed_toml::{Document, Entry, Table, TomlError};
use std::sync::Arc;

const KEYS: [&str; 4] = ["from", "to", "there", "back"];
const WAY_KEYS: [&str; 4] = ["same", "rules", "unused", "unset"];
const RULE_KEYS: [&str; 4] = ["to", "plus", "sum", "products"];
const PRODUCT_KEYS: [&str; 3] = ["of", "less", "by"];

pub(super) fn read(text: &str, spaces: &[Arc<Space>]) -> Result<[Map; 2], TomlError> {
    let document = Document::parse(text)?;
    let mut root = document.root();
    let mut space = |key: &str| {
        let entry = root.require(key, "the key of a space")?;
        let wanted = entry.string("the key of a space")?;
        let found = spaces.iter().find(|space| space.key() == wanted);
        let keys = || spaces.iter().map(|space| space.key());
        found.cloned().ok_or_else(|| entry.unknown_value(wanted, "one of the spaces", keys()))
    };
    let (from, to) = (space("from")?, space("to")?);
    let there = root.require("there", "a table")?;
    let back = root.require("back", "a table")?;
    root.finish(&KEYS)?;
    Ok([way(&there, [from.clone(), to.clone()])?, way(&back, [to, from])?])
}

/// One name, or both sides of one.
#[derive(Clone, Copy)]
enum Places {
    One(usize),
    Both([usize; 2]),
}

impl Places {
    /// The place for a side of the target.
    fn at(self, side: usize) -> usize {
        match self {
            Self::One(place) => place,
            Self::Both(places) => places[side & 1],
        }
    }

    fn all(self) -> Vec<usize> {
        match self {
            Self::One(place) => vec![place],
            Self::Both(places) => places.to_vec(),
        }
    }
}

fn places(entry: &Entry<'_, '_>, name: &str, space: &Space, is_key: bool) -> Result<Places, TomlError> {
    if let Some(both) = space.pair(name) {
        return Ok(Places::Both(both));
    }
    // Names with a prefix of their space can go without.
    let one = space.index(name).or_else(|| space.find(name).filter(|_| !name.contains('*')));
    let unknown = || match is_key {
        true => entry.unknown_name(name, "one of the names", space.written()),
        false => entry.unknown_value(name, "one of the names", space.written()),
    };
    one.map(Places::One).ok_or_else(unknown)
}

fn list(entry: &Entry<'_, '_>, space: &Space) -> Result<Vec<Places>, TomlError> {
    let of_item = |item: &Entry<'_, '_>| places(item, item.string("a name")?, space, false);
    entry.array()?.iter().map(of_item).collect()
}

/// A term whose places may still be of both sides.
struct Product {
    by: f32,
    of: Vec<Places>,
    less: Vec<Places>,
}

impl Product {
    fn for_side(&self, side: usize) -> Term {
        let at = |places: &[Places]| places.iter().map(|places| places.at(side)).collect();
        Term { by: self.by, of: at(&self.of), less: at(&self.less) }
    }

    /// For a target without sides.
    fn terms(&self) -> Vec<Term> {
        let is_sided = self.of.iter().chain(&self.less).any(|places| matches!(places, Places::Both(_)));
        (0..if is_sided { 2 } else { 1 }).map(|side| self.for_side(side)).collect()
    }
}

fn rule(mut table: Table<'_, '_>, [from, to]: [&Space; 2]) -> Result<Vec<Rule>, TomlError> {
    let entry = table.require("to", "the name of a target")?;
    let targets = places(&entry, entry.string("the name of a target")?, to, false)?;
    let plus = table.take("plus").map(|entry| entry.number("a number")).transpose()?.unwrap_or(0.0);
    let mut products = Vec::new();
    if let Some(sum) = table.take("sum") {
        for entry in sum.table()?.rest() {
            let of = vec![places(&entry, entry.name(), from, true)?];
            products.push(Product { by: entry.number("a factor")?, of, less: Vec::new() });
        }
    }
    if let Some(entry) = table.take("products") {
        for entry in entry.array()? {
            let mut table = entry.table()?;
            let by = table.require("by", "a factor")?.number("a factor")?;
            let of = list(&table.require("of", "an array of names")?, from)?;
            let less = match table.take("less") {
                Some(entry) => list(&entry, from)?,
                None => Vec::new(),
            };
            table.finish(&PRODUCT_KEYS)?;
            products.push(Product { by, of, less });
        }
    }
    table.finish(&RULE_KEYS)?;
    Ok(match targets {
        Places::One(to) => vec![Rule { to, plus, terms: products.iter().flat_map(Product::terms).collect() }],
        Places::Both(both) => (both.into_iter().enumerate())
            .map(|(side, to)| Rule {
                to,
                plus,
                terms: products.iter().map(|product| product.for_side(side)).collect(),
            })
            .collect(),
    })
}

fn way(entry: &Entry<'_, '_>, [from, to]: [Arc<Space>; 2]) -> Result<Map, TomlError> {
    let mut table = entry.table()?;
    let mut rules: Vec<Rule> = Vec::new();
    if let Some(entry) = table.take("rules") {
        for item in entry.array()? {
            for rule in rule(item.table()?, [&from, &to])? {
                if rules.iter().any(|other| other.to == rule.to) {
                    let name = to.names().get(rule.to).map_or("", |name| name.name.as_str());
                    return Err(item.error("one rule for each target", format!("another one for {name:?}")));
                }
                rules.push(rule);
            }
        }
    }
    let is_same = table.take("same").map(|entry| entry.flag()).transpose()?.unwrap_or(false);
    if is_same {
        for (place, name) in to.names().iter().enumerate() {
            let same = from.names().iter().position(|other| plain(&other.name) == plain(&name.name));
            if let Some(source) = same.filter(|_| rules.iter().all(|rule| rule.to != place)) {
                let term = Term { by: 1.0, of: vec![source], less: Vec::new() };
                rules.push(Rule { to: place, plus: 0.0, terms: vec![term] });
            }
        }
    }
    let used = |place: usize| {
        let terms = rules.iter().flat_map(|rule| &rule.terms);
        terms.flat_map(|term| term.of.iter().chain(&term.less)).any(|other| *other == place)
    };
    let unused = listed(&mut table, "unused", &from, entry, used)?;
    let unset = listed(&mut table, "unset", &to, entry, |place| rules.iter().any(|rule| rule.to == place))?;
    table.finish(&WAY_KEYS)?;
    Ok(Map::new([from, to], rules, [unused, unset]))
}

/// The names listed under a key, which must be those, and all of those, that no rule has.
fn listed(
    table: &mut Table<'_, '_>,
    key: &str,
    space: &Space,
    way: &Entry<'_, '_>,
    has_rule: impl Fn(usize) -> bool,
) -> Result<Vec<usize>, TomlError> {
    let mut found = Vec::new();
    let name = |place: usize| space.names().get(place).map_or("", |name| name.name.as_str());
    if let Some(entry) = table.take(key) {
        for item in entry.array()? {
            for place in places(&item, item.string("a name")?, space, false)?.all() {
                if has_rule(place) || found.contains(&place) {
                    let text = format!("{:?}, which has one or is listed twice", name(place));
                    return Err(item.error("names that no rule has", text));
                }
                found.push(place);
            }
        }
    }
    match (0..space.len()).find(|place| !has_rule(*place) && !found.contains(place)) {
        Some(place) => {
            let expected = format!("each name of {} in a rule or under {key}", space.key());
            Err(way.error(expected, format!("{:?} in neither", name(place))))
        }
        None => Ok(found),
    }
}
