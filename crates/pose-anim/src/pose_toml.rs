//! The format of `poses.toml`.

use crate::text::{Entry, Table, Text, quote};
use crate::{Control, ControlTable, Pose, PoseSet, TomlError};
use toml::de::DeValue;

const DURATION: &str = "a number of seconds from 0.001 to 3600";
const KEY: &str = r#"the name of one key, such as "1", "q" or "F5""#;

pub(crate) fn read(source: &str, controls: &ControlTable) -> Result<PoseSet, TomlError> {
    let (text, document) = Text::parse(source)?;
    let mut root = Table::new(text, "", 0..0, document.get_ref());
    let mut set = PoseSet::default();
    for table in root.take_tables("pose")? {
        let pose = pose(table, controls, &set)?;
        set.poses.push(pose);
    }
    root.finish(&["pose"])?;
    Ok(set)
}

fn pose(mut table: Table<'_, '_>, controls: &ControlTable, before: &PoseSet) -> Result<Pose, TomlError> {
    let entry = table.require("name", "the name of a pose")?;
    let name = entry.string("the name of a pose")?;
    if before.get(name).is_some() {
        return Err(entry.error("unique names", format!("{} again", quote(name))));
    }
    let mut pose = Pose::new(name, Vec::new());
    if let Some(entry) = table.take("key") {
        pose.key = Some(key(&entry, before)?);
    }
    if let Some(entry) = table.take("duration") {
        pose.duration_secs = Some(duration(&entry)?);
    }
    if let Some(entry) = table.take("controls") {
        values(&entry, "", controls, &mut pose.values)?;
    }
    table.finish(&["name", "key", "duration", "controls"])?;
    Ok(pose)
}

pub(crate) fn duration(entry: &Entry<'_, '_>) -> Result<f32, TomlError> {
    let duration_secs = entry.number(DURATION)?;
    if (0.001..=3600.0).contains(&duration_secs) {
        Ok(duration_secs)
    } else {
        Err(entry.error_found(DURATION))
    }
}

fn key(entry: &Entry<'_, '_>, before: &PoseSet) -> Result<String, TomlError> {
    let key = entry.string(KEY)?;
    let one_character = key.chars().count() == 1;
    if !one_character && !key.chars().all(|c| c.is_ascii_alphanumeric()) {
        return Err(entry.error_found(KEY));
    }
    match before.by_key(key) {
        None => Ok(key.to_owned()),
        Some(other) => {
            let found = format!("{}, which calls pose {}", quote(key), quote(&other.name));
            Err(entry.error("a key of its own", found))
        }
    }
}

/// Reads `"head.turn" = 10` as well as `head.turn = 10`, which TOML takes for a table in a table.
fn values(
    entry: &Entry<'_, '_>,
    prefix: &str,
    controls: &ControlTable,
    out: &mut Vec<(usize, f32)>,
) -> Result<(), TomlError> {
    for (key, entry) in entry.table()?.rest() {
        let name = if prefix.is_empty() { key } else { format!("{prefix}.{key}") };
        if let Some(index) = controls.index(&name) {
            if out.iter().any(|(other, _)| *other == index) {
                return Err(entry.error("each control once", format!("{} again", quote(&name))));
            }
            out.push((index, value(&entry, &controls.controls()[index])?));
        } else if matches!(entry.value.get_ref(), DeValue::Table(table) if !table.is_empty()) {
            values(&entry, &name, controls, out)?;
        } else {
            return Err(entry.unknown_name(&name, "one of the controls", controls.names()));
        }
    }
    Ok(())
}

fn value(entry: &Entry<'_, '_>, control: &Control) -> Result<f32, TomlError> {
    let expected = format!("a number from {} to {}", control.min, control.max);
    let value = entry.number(&expected)?;
    if (control.min..=control.max).contains(&value) { Ok(value) } else { Err(entry.error_found(expected)) }
}
