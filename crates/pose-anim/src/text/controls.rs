//! The format of `controls.toml`.

use crate::{Control, ControlTable, Coupling, Drive, JointMotion, Pace};
use glam::Vec3;
use placed_toml::{Document, Entry, Table, TomlError, quote};
use std::sync::LazyLock;

const AXIS: &str =
    r#"an axis "+x", "-x", "+y", "-y", "+z", "-z" or three numbers [x, y, z] that are not all 0"#;
const SECONDS: &str = "[shortest, longest]: two numbers of seconds, 0.001 to 3600, in this order";

/// The controls of the nine-joint face as a text, to be copied beside a face and changed.
pub const DEFAULT_CONTROLS_TOML: &str = include_str!("../../assets/controls.toml");

/// Read once, when first needed. The text is part of the crate and a test reads it, so the error cannot
/// happen.
static DEFAULT_FACE: LazyLock<ControlTable> =
    LazyLock::new(|| read(DEFAULT_CONTROLS_TOML).unwrap_or_default());

impl ControlTable {
    /// The fifteen controls of the nine-joint face: [`DEFAULT_CONTROLS_TOML`].
    pub fn default_face() -> Self {
        DEFAULT_FACE.clone()
    }

    /// Reads a `controls.toml`; its format is described at the top of [`DEFAULT_CONTROLS_TOML`].
    ///
    /// # Errors
    /// The first thing in the text that is not as it has to be, with its place.
    pub fn from_toml(text: &str) -> Result<Self, TomlError> {
        read(text)
    }
}

fn read(source: &str) -> Result<ControlTable, TomlError> {
    let document = Document::parse(source)?;
    let mut root = document.root();
    let mut controls: Vec<Control> = Vec::new();
    for table in root.take_tables("control")? {
        let control = control(table, &controls)?;
        controls.push(control);
    }
    let mut couplings: Vec<Coupling> = Vec::new();
    for table in root.take_tables("coupling")? {
        let coupling = coupling(table, &controls, &couplings)?;
        couplings.push(coupling);
    }
    root.finish(&["control", "coupling"])?;
    Ok(ControlTable::checked(controls, couplings))
}

fn control(mut table: Table<'_, '_>, before: &[Control]) -> Result<Control, TomlError> {
    let name_entry = table.require("name", "the name of a control")?;
    let name = name_entry.string("the name of a control")?;
    if before.iter().any(|other| other.name == name) {
        return Err(name_entry.error("unique names", format!("{} again", quote(name))));
    }
    let drives = drive(&mut table)?;
    let shape = matches!(drives, Drive::Shape { .. });
    let mut limit = |key: &str, of_shape: f32| match table.take(key) {
        Some(entry) => entry.number("a finite number up to 1e9"),
        None if shape => Ok(of_shape),
        None => Err(table.error_here(key, "a finite number up to 1e9", "none")),
    };
    let min = limit("min", 0.0)?;
    let max_entry_error = |found: &str| format!("a number that is not less than min = {found}");
    let max = match table.take("max") {
        Some(entry) => {
            let max = entry.number("a finite number up to 1e9")?;
            if max < min {
                return Err(entry.error_found(max_entry_error(&min.to_string())));
            }
            max
        }
        None if shape && min <= 1.0 => 1.0,
        None => return Err(table.error_here("max", &max_entry_error(&min.to_string()), "none")),
    };
    let default_expected = || format!("a number from {min} to {max}");
    let default = match table.take("default") {
        Some(entry) => {
            let default = entry.number("a number").ok().filter(|default| (min..=max).contains(default));
            default.ok_or_else(|| entry.error_found(default_expected()))?
        }
        None if (min..=max).contains(&0.0) => 0.0,
        None => return Err(table.error_here("default", &default_expected(), "none (which means 0)")),
    };
    let pace = match table.take("seconds") {
        Some(entry) => pace(&entry)?,
        None => Pace::named(name, &drives),
    };
    let group = table.take("group").map(|entry| Ok(entry.string("a heading")?.to_owned())).transpose()?;
    table.finish(&["name", "joint", "axis", "kind", "shape", "min", "max", "default", "seconds", "group"])?;
    Ok(Control { name: name.to_owned(), drives, min, max, default, pace, group })
}

fn drive(table: &mut Table<'_, '_>) -> Result<Drive, TomlError> {
    if let Some(entry) = table.take("shape") {
        let shape = entry.string("the name of a blend shape")?.to_owned();
        for key in ["joint", "axis", "kind"] {
            if let Some(second) = table.take(key) {
                return Err(
                    second.error("a control of either a joint or a shape", format!("{key} beside shape"))
                );
            }
        }
        return Ok(Drive::Shape { shape });
    }
    let joint = table.require("joint", "the name of a joint (or a key `shape`)")?;
    let joint = joint.string("the name of a joint")?.to_owned();
    let axis = axis(&table.require("axis", AXIS)?)?;
    let kind = match table.take("kind") {
        None => JointMotion::Rotation,
        Some(entry) => match entry.string(r#""rotation" or "translation""#)? {
            "rotation" => JointMotion::Rotation,
            "translation" => JointMotion::Translation,
            other => {
                return Err(entry.unknown_value(other, "one of", ["rotation", "translation"]));
            }
        },
    };
    Ok(Drive::Joint { joint, axis, kind })
}

fn axis(entry: &Entry<'_, '_>) -> Result<Vec3, TomlError> {
    if let Some(name) = entry.as_str() {
        return match name {
            "+x" | "x" => Ok(Vec3::X),
            "-x" => Ok(Vec3::NEG_X),
            "+y" | "y" => Ok(Vec3::Y),
            "-y" => Ok(Vec3::NEG_Y),
            "+z" | "z" => Ok(Vec3::Z),
            "-z" => Ok(Vec3::NEG_Z),
            _ => Err(entry.error_found(AXIS)),
        };
    }
    let Some(items) = entry.as_array() else { return Err(entry.error_found(AXIS)) };
    let numbers: Vec<f32> = items.iter().map(|item| item.number(AXIS)).collect::<Result<_, _>>()?;
    let [x, y, z] = numbers[..] else {
        return Err(entry.error(AXIS, format!("an array of {}", items.len())));
    };
    let shown = || entry.error(AXIS, format!("[{x}, {y}, {z}]"));
    Vec3::new(x, y, z).try_normalize().ok_or_else(shown)
}

fn pace(entry: &Entry<'_, '_>) -> Result<Pace, TomlError> {
    let numbers: Vec<f64> =
        entry.array()?.iter().map(|item| item.precise(SECONDS)).collect::<Result<_, _>>()?;
    match numbers[..] {
        [shortest, longest] if shortest >= 0.001 && longest >= shortest && longest <= 3600.0 => {
            Ok(Pace::new(shortest, longest))
        }
        [shortest, longest] => Err(entry.error(SECONDS, format!("[{shortest}, {longest}]"))),
        _ => Err(entry.error_found(SECONDS)),
    }
}

fn coupling(
    mut table: Table<'_, '_>,
    controls: &[Control],
    before: &[Coupling],
) -> Result<Coupling, TomlError> {
    let mut control = |key: &str| {
        let entry = table.require(key, "the name of a control")?;
        let name = entry.string("the name of a control")?;
        let names = controls.iter().map(|control| control.name.as_str());
        let index = controls.iter().position(|control| control.name == name);
        let index = index.ok_or_else(|| entry.unknown_value(name, "one of the controls", names))?;
        Ok::<_, TomlError>((index, entry))
    };
    let (from, _) = control("from")?;
    let (to, to_entry) = control("to")?;
    if from == to {
        return Err(to_entry.error("another control than `from`", quote(&controls[to].name)));
    }
    if before.iter().any(|other| (other.from, other.to) == (from, to)) {
        return Err(to_entry.error("each pair of controls once", "this coupling again"));
    }
    let factor = table.require("factor", "a finite number up to 1e9")?.number("a finite number up to 1e9")?;
    table.finish(&["from", "to", "factor"])?;
    Ok(Coupling { from, to, factor })
}
