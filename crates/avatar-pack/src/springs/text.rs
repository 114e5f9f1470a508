//! The format of `springs.toml`.

use super::{MOST_BUMPS, Springs, parents};
use glam::Vec3;
use joint_springs::{Collider, Law, Shape, Spring};
use placed_toml::{Document, Entry, Table, TomlError, nearest, quote};
use rig_core::Rig;
use std::collections::HashMap;

/// More joints in all chains, or more colliders, are no avatar.
const MOST: usize = 1 << 12;
/// Larger lengths are no avatar, in whatever unit.
const FAR: f32 = 1e6;

/// Of a chain that does not say them.
const FREQUENCY_HZ: f32 = 2.0;
const DAMPING: f32 = 0.3;
const DRAG: f32 = 0.5;

const CHAIN: [&str; 10] = [
    "joints",
    "tail",
    "frequency",
    "damping",
    "stiffness",
    "drag",
    "gravity",
    "radius",
    "colliders",
    "center",
];
const COLLIDER: [&str; 6] = ["name", "joint", "sphere", "capsule", "plane", "inside"];

impl Springs {
    /// Reads a `springs.toml` for a rig. docs/packs.md describes the format.
    ///
    /// # Errors
    /// The first thing in the text that is not as it has to be, with its place: a joint that the rig does not
    /// have, one that two chains move, a chain whose joints are not below each other.
    pub fn from_toml(text: &str, rig: &Rig) -> Result<Self, TomlError> {
        let document = Document::parse(text)?;
        let mut root = document.root();
        let (chains, colliders) = (root.take_tables("chain")?, root.take_tables("collider")?);
        root.finish(&["chain", "collider"])?;
        let mut reader = Reader {
            rig,
            parents: parents(rig),
            read: Self::default(),
            colliders: HashMap::new(),
            chained: vec![false; rig.len()],
            bumps: 0,
        };
        for table in colliders {
            reader.collider(table)?;
        }
        for table in chains {
            reader.chain(table)?;
        }
        Ok(reader.read)
    }
}

struct Reader<'r> {
    rig: &'r Rig,
    parents: Vec<Option<usize>>,
    read: Springs,
    /// Places of the colliders by their names.
    colliders: HashMap<String, usize>,
    /// Joints that are in a chain.
    chained: Vec<bool>,
    bumps: usize,
}

impl Reader<'_> {
    fn collider(&mut self, mut table: Table<'_, '_>) -> Result<(), TomlError> {
        const NAME: &str = "the name of a collider";
        let entry = table.require("name", NAME)?;
        let name = entry.string(NAME)?;
        if self.colliders.contains_key(name) {
            return Err(entry.error("a name that no other collider has", format!("{} again", quote(name))));
        }
        if self.colliders.len() >= MOST {
            return Err(entry.error(format!("at most {MOST} colliders"), "more"));
        }
        let joint = self.joint(&table.require("joint", "the name of a joint")?)?;
        let inside = table.take("inside");
        let is_inside = match &inside {
            Some(entry) => entry.flag()?,
            None => false,
        };
        let forms = ["sphere", "capsule", "plane"].map(|key| table.take(key));
        let shape = match forms {
            [Some(form), None, None] => sphere(&form, is_inside)?,
            [None, Some(form), None] => capsule(&form, is_inside)?,
            [None, None, Some(form)] => {
                if let Some(inside) = inside {
                    return Err(inside.error("inside beside a sphere or capsule", "it beside a plane"));
                }
                plane(&form)?
            }
            [None, None, None] => {
                return Err(table.error_here("sphere", "one of sphere, capsule and plane", "none"));
            }
            forms => {
                let second = forms.iter().flatten().nth(1).or(forms.iter().flatten().next());
                let error = |form: &Entry<'_, '_>| form.error("one of sphere, capsule and plane", "two");
                return Err(second.map_or_else(|| table.error_here("sphere", "one form", "none"), error));
            }
        };
        table.finish(&COLLIDER)?;
        self.colliders.insert(name.to_owned(), self.read.colliders.len());
        self.read.colliders.push(Collider { joint, shape });
        Ok(())
    }

    fn chain(&mut self, mut table: Table<'_, '_>) -> Result<(), TomlError> {
        const JOINTS: &str = "names of joints, each below the one before";
        let listed = table.require("joints", JOINTS)?;
        let names = listed.array()?;
        let tail = table.take("tail").map(|tail| vector(&tail, FAR)).transpose()?;
        let law = law(&mut table)?;
        let hit_radius = match table.take("radius") {
            Some(entry) => entry.number_within(0.0..=FAR, &format!("a number from 0 to {FAR}"))?,
            None => 0.0,
        };
        let colliders = self.bumps_of(&mut table)?;
        let center = table.take("center").map(|entry| self.joint(&entry)).transpose()?;
        table.finish(&CHAIN)?;
        let mut joints: Vec<usize> = Vec::with_capacity(names.len());
        for name in &names {
            let joint = self.joint(name)?;
            if let Some(above) = joints.last().filter(|above| !self.is_below(joint, **above)) {
                let above = self.rig.names().get(*above).map_or("", String::as_str);
                let found = name.as_str().unwrap_or_default();
                return Err(name.error(format!("a joint below {}", quote(above)), quote(found)));
            }
            joints.push(joint);
        }
        // Without a tail the last joint is the chain's end, and has no other part in the motion.
        let swings = if tail.is_some() { joints.len() } else { joints.len().saturating_sub(1) };
        if swings == 0 {
            return Err(listed.error("two joints at least, or one and a tail", format!("{}", joints.len())));
        }
        self.bumps = self.bumps.saturating_add(swings.saturating_mul(colliders.len()));
        if self.read.springs.len() + swings > MOST || self.bumps > MOST_BUMPS {
            let most = format!("at most {MOST} joints in all, and {MOST_BUMPS} colliders of these");
            return Err(listed.error(most, "more"));
        }
        for (at, joint) in joints.iter().copied().enumerate().take(swings) {
            let entry = names.get(at).unwrap_or(&listed);
            if self.chained.get_mut(joint).is_none_or(|chained| std::mem::replace(chained, true)) {
                let found = format!("{} again", quote(entry.as_str().unwrap_or_default()));
                return Err(entry.error("a joint that no other chain moves", found));
            }
            let end = match (joints.get(at + 1), tail) {
                (Some(next), _) => self.place(joint, *next),
                (None, tail) => tail.unwrap_or_default(),
            };
            let (colliders, spring) = (colliders.clone(), Spring::new(joint, end, law));
            self.read.springs.push(Spring { hit_radius, center, colliders, ..spring });
        }
        Ok(())
    }

    fn bumps_of(&self, table: &mut Table<'_, '_>) -> Result<Vec<usize>, TomlError> {
        let Some(entry) = table.take("colliders") else { return Ok(Vec::new()) };
        let items = entry.array()?;
        let place = |item: &Entry<'_, '_>| {
            let name = item.string("the name of a collider")?;
            self.colliders.get(name).copied().ok_or_else(|| {
                let mut known: Vec<&str> = self.colliders.keys().map(String::as_str).collect();
                known.sort_unstable();
                match known.is_empty() {
                    true => item.error("no collider where there is none", quote(name)),
                    false => item.unknown_value(name, "a collider, of", known),
                }
            })
        };
        items.iter().map(place).collect()
    }

    fn joint(&self, entry: &Entry<'_, '_>) -> Result<usize, TomlError> {
        let name = entry.string("the name of a joint")?;
        let unknown = || {
            // A list of all joints would be longer than anybody reads.
            let nearest = nearest(name, self.rig.names().iter().map(String::as_str)).map(str::to_owned);
            TomlError { nearest, ..entry.error("the name of a joint", quote(name)) }
        };
        self.rig.joint(name).map(|joint| joint.index()).ok_or_else(unknown)
    }

    fn is_below(&self, joint: usize, above: usize) -> bool {
        let parent = |joint: &usize| self.parents.get(*joint).copied().flatten();
        let mut ancestors = std::iter::successors(parent(&joint), parent);
        ancestors.any(|ancestor| ancestor == above)
    }

    /// Where a joint is at bind pose, in the space of another.
    fn place(&self, joint: usize, other: usize) -> Vec3 {
        let (worlds, inverses) = (self.rig.world_from_bind(), self.rig.bind_from_world());
        let (Some(back), Some(world)) = (inverses.get(joint), worlds.get(other)) else { return Vec3::ZERO };
        back.transform_point3(world.translation.into())
    }
}

/// The oscillator by its frequency and damping, or VRM's rule by its stiffness and drag.
fn law(table: &mut Table<'_, '_>) -> Result<Law, TomlError> {
    let number = |entry: &Entry<'_, '_>, min: f32, max: f32| {
        entry.number_within(min..=max, &format!("a number from {min} to {max}"))
    };
    let [frequency, damping, stiffness, drag] =
        ["frequency", "damping", "stiffness", "drag"].map(|key| table.take(key));
    let gravity = table.take("gravity").map(|entry| vector(&entry, FAR)).transpose()?.unwrap_or_default();
    let of = |entry: &Option<Entry<'_, '_>>, min: f32, max: f32, default: f32| match entry {
        Some(entry) => number(entry, min, max),
        None => Ok(default),
    };
    match (frequency.as_ref().or(damping.as_ref()), stiffness.as_ref().or(drag.as_ref())) {
        (Some(_), Some(entry)) => {
            Err(entry.error("either frequency and damping or stiffness and drag", "both"))
        }
        (None, Some(_)) => Ok(Law::Vrm {
            stiffness: of(&stiffness, 0.0, 1000.0, 1.0)?,
            drag: of(&drag, 0.0, 1.0, DRAG)?,
            gravity,
        }),
        (_, None) => Ok(Law::Oscillator {
            frequency_hz: of(&frequency, 0.05, 100.0, FREQUENCY_HZ)?,
            damping_ratio: of(&damping, 0.0, 10.0, DAMPING)?,
            gravity,
        }),
    }
}

fn vector(entry: &Entry<'_, '_>, most: f32) -> Result<Vec3, TomlError> {
    let expected = format!("an array of three numbers from {} to {most}", -most);
    let number = |item: &Entry<'_, '_>| item.number_within(-most..=most, &expected);
    match entry.as_array().as_deref() {
        Some([x, y, z]) => Ok(Vec3::new(number(x)?, number(y)?, number(z)?)),
        _ => Err(entry.error_found(&expected)),
    }
}

/// A vector of a form; the place of its joint where nothing is said.
fn point(table: &mut Table<'_, '_>, key: &str) -> Result<Vec3, TomlError> {
    table.take(key).map_or(Ok(Vec3::ZERO), |entry| vector(&entry, FAR))
}

fn radius(table: &mut Table<'_, '_>) -> Result<f32, TomlError> {
    let expected = format!("a number from 0 to {FAR}");
    table.require("radius", &expected)?.number_within(0.0..=FAR, &expected)
}

fn sphere(entry: &Entry<'_, '_>, inside: bool) -> Result<Shape, TomlError> {
    let mut table = entry.table()?;
    let (offset, radius) = (point(&mut table, "offset")?, radius(&mut table)?);
    table.finish(&["offset", "radius"])?;
    Ok(Shape::Sphere { offset, radius, inside })
}

fn capsule(entry: &Entry<'_, '_>, inside: bool) -> Result<Shape, TomlError> {
    let mut table = entry.table()?;
    let (offset, tail) = (point(&mut table, "offset")?, point(&mut table, "tail")?);
    let radius = radius(&mut table)?;
    table.finish(&["offset", "tail", "radius"])?;
    Ok(Shape::Capsule { offset, tail, radius, inside })
}

fn plane(entry: &Entry<'_, '_>) -> Result<Shape, TomlError> {
    let mut table = entry.table()?;
    let (offset, front) = (point(&mut table, "offset")?, table.require("normal", "three numbers")?);
    let normal = vector(&front, FAR)?;
    if normal.try_normalize().is_none() {
        return Err(front.error("a direction", "none"));
    }
    table.finish(&["offset", "normal"])?;
    Ok(Shape::Plane { offset, normal })
}
