//! Entries that several of the formats have.

use crate::{Control, ControlTable, Easing};
use placed_toml::{Entry, Table, TomlError, quote};

const KEY: &str = r#"the name of one key, such as "1", "q" or "F5""#;

/// A key that does not occur in `taken`, which holds pairs of key and owner.
pub(crate) fn key<'n>(
    entry: &Entry<'_, '_>,
    what: &str,
    mut taken: impl Iterator<Item = (&'n str, &'n str)>,
) -> Result<String, TomlError> {
    let key = entry.string(KEY)?;
    let one_character = key.chars().count() == 1;
    if !one_character && !key.chars().all(|c| c.is_ascii_alphanumeric()) {
        return Err(entry.error_found(KEY));
    }
    match taken.find(|(other, _)| *other == key) {
        None => Ok(key.to_owned()),
        Some((_, owner)) => {
            let found = format!("{}, which calls {what} {}", quote(key), quote(owner));
            Err(entry.error("a key of its own", found))
        }
    }
}

/// Reads `"head.turn" = 10` as well as `head.turn = 10`, which TOML takes for a table in a table.
pub(crate) fn by_control<T>(
    entry: &Entry<'_, '_>,
    prefix: &str,
    controls: &ControlTable,
    out: &mut Vec<(usize, T)>,
    read: &dyn Fn(&Entry<'_, '_>, &Control) -> Result<T, TomlError>,
) -> Result<(), TomlError> {
    for entry in entry.table()?.rest() {
        let name = full_name(prefix, entry.name());
        if let Some(index) = controls.index(&name) {
            if out.iter().any(|(other, _)| *other == index) {
                return Err(entry.error("each control once", format!("{} again", quote(&name))));
            }
            out.push((index, read(&entry, &controls.controls()[index])?));
        } else if is_group(&entry, &name, controls) {
            by_control(&entry, &name, controls, out, read)?;
        } else {
            return Err(entry.unknown_name(&name, "one of the controls", controls.names()));
        }
    }
    Ok(())
}

/// Whether all that [`by_control`] would read are controls of the face.
pub(crate) fn has_all(entry: &Entry<'_, '_>, controls: &ControlTable) -> Result<bool, TomlError> {
    fn within(entry: &Entry<'_, '_>, prefix: &str, controls: &ControlTable) -> Result<bool, TomlError> {
        let mut all = true;
        for entry in entry.table()?.rest() {
            let name = full_name(prefix, entry.name());
            if controls.index(&name).is_none() {
                all &= is_group(&entry, &name, controls) && within(&entry, &name, controls)?;
            }
        }
        Ok(all)
    }
    within(entry, "", controls)
}

fn full_name(prefix: &str, key: &str) -> String {
    if prefix.is_empty() { key.to_owned() } else { format!("{prefix}.{key}") }
}

/// Whether an entry is a table of controls whose names begin with its own.
fn is_group(entry: &Entry<'_, '_>, name: &str, controls: &ControlTable) -> bool {
    let group = format!("{name}.");
    let has_entries = |table: Table<'_, '_>| !table.entries().is_empty();
    entry.as_table().is_some_and(has_entries) && controls.names().any(|control| control.starts_with(&group))
}

/// The name of a transition function, or the four numbers of a Bézier curve.
pub(crate) fn transition(entry: &Entry<'_, '_>) -> Result<Easing, TomlError> {
    let expected = "the name of a transition, such as \"cubic-in-out\", or [x1, y1, x2, y2] with x from 0 to 1 and y from -1000 to 1000";
    if let Some(name) = entry.as_str() {
        let names = Easing::names();
        let unknown = || entry.unknown_value(name, "one of", names.iter().map(String::as_str));
        return Easing::from_name(name).ok_or_else(unknown);
    }
    let Some(items) = entry.as_array() else { return Err(entry.error_found(expected)) };
    let numbers: Vec<f64> = items.iter().map(|item| item.precise(expected)).collect::<Result<_, _>>()?;
    match numbers[..] {
        [x1, y1, x2, y2]
            if [x1, x2].iter().all(|x| (0.0..=1.0).contains(x))
                && Easing::Bezier([x1, y1, x2, y2]).is_sound() =>
        {
            Ok(Easing::Bezier([x1, y1, x2, y2]))
        }
        _ => Err(entry.error(expected, format!("an array of {} numbers", items.len()))),
    }
}

pub(crate) fn value(entry: &Entry<'_, '_>, control: &Control) -> Result<f32, TomlError> {
    let value = entry.number("a number").ok().filter(|value| (control.min..=control.max).contains(value));
    value.ok_or_else(|| entry.error_found(format!("a number from {} to {}", control.min, control.max)))
}
