//! The format of `shapes.toml`.

use super::controls::{Resolved, resolve};
use super::{FurtherShape, FurtherShapes, Mixture, ShapeWeight, Side, wrinkles};
use avatar_mesh::{FACE_PARTS, FACE_SHAPES};
use placed_toml::{Document, Entry, LARGEST, Table, TomlError, quote};
use pose_anim::{ControlTable, Drive};
use std::collections::{HashMap, HashSet};

const INPUT: &str = "a shape with a control of its own, or a control of a joint or shape";
const AT: &str = "a number up to 1e9 that is not 0";

/// More names in all `of` and `product` together are no face.
const MOST_NAMES: usize = 1 << 16;

impl FurtherShapes {
    /// Reads a `shapes.toml` of a pack with these controls (those of `controls.toml`). docs/packs.md
    /// describes the format.
    ///
    /// # Errors
    /// The first thing in the text that is not as it has to be, with its place.
    pub fn from_toml(text: &str, controls: &ControlTable) -> Result<Self, TomlError> {
        let document = Document::parse(text)?;
        let mut root = document.root();
        let (shapes, mixtures) = (root.take_tables("shape")?, root.take_tables("mixture")?);
        let tables = root.take_tables("wrinkle")?;
        root.finish(&["shape", "mixture", "wrinkle"])?;
        let mut reader = Reader::new(controls);
        let mut read = Self::default();
        let mut inputs = Vec::new();
        for table in shapes {
            read.shapes.push(reader.shape(table, &mut inputs)?);
        }
        // Inputs may stand after the shape that they are inputs of.
        for (entry, at) in &inputs {
            reader.check_input(entry, *at)?;
        }
        reader.later = mixtures.iter().filter_map(name_of).collect();
        for table in mixtures {
            let mixture = reader.mixture(table)?;
            reader.later.remove(&mixture.name);
            read.mixtures.push(mixture);
        }
        let named =
            |name: &str| FACE_SHAPES.contains(&name) || read.shapes.iter().any(|one| one.name == name);
        let names = || FACE_SHAPES.into_iter().chain(read.shapes.iter().map(|one| one.name.as_str()));
        let place = |(number, table)| wrinkles::read(number, table, named, || names().collect());
        let places = tables.into_iter().enumerate().map(place).collect::<Result<_, _>>()?;
        read.wrinkles = places;
        Ok(read)
    }
}

/// The name that a mixture will have, if it is one.
fn name_of(table: &Table<'_, '_>) -> Option<String> {
    let entry = table.entries().iter().find(|entry| entry.name() == "name")?;
    Some(entry.as_str()?.to_owned())
}

struct Reader<'c> {
    controls: &'c ControlTable,
    /// Of all shapes and mixtures so far.
    names: HashSet<String>,
    /// Shapes that have a control of their own.
    own: HashSet<String>,
    /// Shapes with a control of their own, and mixtures so far.
    movable: HashMap<String, Moves>,
    /// Mixtures that are still to come.
    later: HashSet<String>,
    /// Where shapes of an input stand alone.
    alone: HashSet<(Resolved, u32)>,
    /// How many names lists have had.
    listed: usize,
    /// How many controls all mixtures so far move, each counted by itself.
    moved: usize,
}

/// What a shape or mixture moves.
#[derive(Clone, Copy, Debug, Default)]
struct Moves {
    /// How far in all, at its value 1.
    way: f64,
    /// How many controls, at most.
    controls: usize,
}

impl Moves {
    /// Of a single control.
    const ITSELF: Self = Self { way: 1.0, controls: 1 };
}

impl<'c> Reader<'c> {
    fn new(controls: &'c ControlTable) -> Self {
        let own: HashSet<String> = FACE_SHAPES.into_iter().map(str::to_owned).collect();
        let alone = own.iter().map(|name| (Resolved::Slider(name.clone()), 1.0f32.to_bits())).collect();
        let movable = own.iter().map(|name| (name.clone(), Moves::ITSELF)).collect();
        Self { controls, names: own.clone(), own, movable, later: HashSet::new(), alone, listed: 0, moved: 0 }
    }

    /// Reads a shape; what it takes its weight from is left to be checked.
    fn shape<'t, 'a>(
        &mut self,
        mut table: Table<'t, 'a>,
        inputs: &mut Vec<(Entry<'t, 'a>, Option<f32>)>,
    ) -> Result<FurtherShape, TomlError> {
        let name_entry = table.require("name", "the name of a shape")?;
        let name = self.new_name(&name_entry, "the name of a shape")?;
        let (group, side) = (group(&mut table)?, side(&mut table)?);
        let parts = parts(&mut table)?;
        let (follows, at, product) = (table.take("follows"), table.take("at"), table.take("product"));
        table.finish(&["name", "group", "side", "parts", "follows", "at", "product"])?;
        let weight = match (follows, product) {
            (Some(_), Some(product)) => {
                return Err(product.error("either follows or product", "both"));
            }
            (Some(follows), None) => {
                let input = follows.string(INPUT)?.to_owned();
                let at = match &at {
                    None => 1.0,
                    Some(at) => {
                        Some(at.number(AT)?).filter(|x| *x != 0.0).ok_or_else(|| at.error_found(AT))?
                    }
                };
                inputs.push((follows, Some(at)));
                ShapeWeight::Follows { input, at }
            }
            (None, Some(product)) => {
                let items = product.array()?;
                self.count(&product, items.len())?;
                if items.is_empty() {
                    return Err(product.error_found("at least one input"));
                }
                let names = items.iter().map(|item| Ok(item.string(INPUT)?.to_owned()));
                let names = names.collect::<Result<Vec<_>, TomlError>>()?;
                inputs.extend(items.into_iter().map(|item| (item, None)));
                ShapeWeight::Product(names)
            }
            (None, None) => {
                self.own.insert(name.clone());
                self.movable.insert(name.clone(), Moves::ITSELF);
                self.alone.insert((Resolved::Slider(name.clone()), 1.0f32.to_bits()));
                ShapeWeight::Control
            }
        };
        if let (Some(at), ShapeWeight::Control | ShapeWeight::Product(_)) = (at, &weight) {
            return Err(at.error("at only beside follows", "it without"));
        }
        Ok(FurtherShape { name, group, side, parts, weight })
    }

    fn mixture(&mut self, mut table: Table<'_, '_>) -> Result<Mixture, TomlError> {
        let name =
            self.new_name(&table.require("name", "the name of a mixture")?, "the name of a mixture")?;
        let (group, side) = (group(&mut table)?, side(&mut table)?);
        let of = table.require("of", "a table of controls and how far each is moved")?;
        table.finish(&["name", "group", "side", "of"])?;
        let entries = of.table()?;
        self.count(&of, entries.entries().len())?;
        let (mut parts, mut all) = (Vec::new(), Moves::default());
        for entry in entries.rest() {
            let target = entry.name();
            let is_known = self.movable.contains_key(target) || self.controls.index(target).is_some();
            if self.later.contains(target) || !is_known {
                let known = self.controls.names().chain(self.movable.keys().map(String::as_str));
                let known = sorted(known.filter(|other| !self.later.contains(*other)));
                return Err(entry.unknown_name(
                    target,
                    "a control, a shape or an earlier mixture, of",
                    known,
                ));
            }
            let way = entry.number("a finite number up to 1e9")?;
            let moves = self.movable.get(target).copied().unwrap_or(Moves::ITSELF);
            all.way += f64::from(way).abs() * moves.way;
            all.controls = all.controls.saturating_add(moves.controls);
            parts.push((target.to_owned(), way));
        }
        // Mixtures of mixtures multiply; a coupling of controls takes no more.
        if all.way > LARGEST {
            return Err(of.error("moves of at most 1e9 in all", format!("{:e}", all.way)));
        }
        self.moved = self.moved.saturating_add(all.controls);
        if self.moved > MOST_NAMES {
            let expected = format!("mixtures that move at most {MOST_NAMES} controls in all");
            return Err(of.error(expected, "mixtures of mixtures that move more"));
        }
        self.movable.insert(name.clone(), all);
        Ok(Mixture { name, group, side, of: parts })
    }

    /// A name that no shape and no mixture has yet. A control of this name has to be the one of this shape.
    fn new_name(&mut self, entry: &Entry<'_, '_>, expected: &str) -> Result<String, TomlError> {
        let name = entry.string(expected)?;
        if !self.names.insert(name.to_owned()) {
            return Err(
                entry.error("names that no other shape or mixture has", format!("{} again", quote(name)))
            );
        }
        let control = self.controls.index(name).and_then(|index| self.controls.controls().get(index));
        let driven = control.map(|control| match &control.drives {
            Drive::Joint { joint, .. } => joint,
            Drive::Shape { shape } => shape,
        });
        match driven.filter(|driven| *driven != name) {
            None => Ok(name.to_owned()),
            Some(driven) => {
                let found = format!("{}, the control of {}", quote(name), quote(driven));
                Err(entry.error("a name that no control of anything else has", found))
            }
        }
    }

    /// Checks an input, and that only one shape stands alone at this value of it.
    fn check_input(&mut self, entry: &Entry<'_, '_>, at: Option<f32>) -> Result<(), TomlError> {
        let name = entry.as_str().unwrap_or_default();
        let Some(resolved) = resolve(name, self.controls, |shape| self.own.contains(shape)) else {
            let known = sorted(self.own.iter().map(String::as_str).chain(self.controls.names()));
            return Err(entry.unknown_value(name, &format!("{INPUT}, of"), known));
        };
        match at.is_none_or(|at| self.alone.insert((resolved, at.to_bits()))) {
            true => Ok(()),
            false => Err(entry.error(
                "another value of `at` than that of other shapes of this input",
                format!("{} again", at.unwrap_or_default()),
            )),
        }
    }

    /// Bounds what all lists together say.
    fn count(&mut self, entry: &Entry<'_, '_>, names: usize) -> Result<(), TomlError> {
        self.listed = self.listed.saturating_add(names);
        match self.listed > MOST_NAMES {
            true => Err(entry.error(format!("at most {MOST_NAMES} names in all lists"), "more")),
            false => Ok(()),
        }
    }
}

fn sorted<'n>(names: impl Iterator<Item = &'n str>) -> Vec<&'n str> {
    let mut names: Vec<_> = names.collect();
    names.sort_unstable();
    names.dedup();
    names
}

fn group(table: &mut Table<'_, '_>) -> Result<Option<String>, TomlError> {
    table.take("group").map(|entry| Ok(entry.string("a heading")?.to_owned())).transpose()
}

fn side(table: &mut Table<'_, '_>) -> Result<Option<Side>, TomlError> {
    let Some(entry) = table.take("side") else { return Ok(None) };
    let name = entry.string(r#""left" or "right""#)?;
    let side = [Side::Left, Side::Right].into_iter().find(|side| side.name() == name);
    side.map(Some).ok_or_else(|| entry.unknown_value(name, "one of", ["left", "right"]))
}

/// The skin where nothing is said.
fn parts(table: &mut Table<'_, '_>) -> Result<Vec<String>, TomlError> {
    let Some(entry) = table.take("parts") else { return Ok(vec![FACE_PARTS[0].name.to_owned()]) };
    let mut parts: Vec<String> = Vec::new();
    for item in entry.array()? {
        let name = item.string("the name of a part")?;
        if !FACE_PARTS.iter().any(|part| part.name == name) {
            return Err(item.unknown_value(name, "one of the parts", FACE_PARTS.map(|part| part.name)));
        }
        if parts.iter().any(|other| other == name) {
            return Err(item.error("each part once", format!("{} again", quote(name))));
        }
        parts.push(name.to_owned());
    }
    Ok(parts)
}
