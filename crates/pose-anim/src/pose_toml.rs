//! The format of `poses.toml`.

use crate::{Control, ControlTable, Easing, Pose, PoseSet, Timing};
use placed_toml::{Document, Entry, Table, TomlError, quote};

const DURATION: &str = "a number of seconds from 0.001 to 3600";
const KEY: &str = r#"the name of one key, such as "1", "q" or "F5""#;

pub(crate) fn read(source: &str, controls: &ControlTable) -> Result<PoseSet, TomlError> {
    let document = Document::parse(source)?;
    let mut root = document.root();
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
        let taken = before.iter().filter_map(|pose| Some((pose.key.as_deref()?, pose.name.as_str())));
        pose.key = Some(key(&entry, "pose", taken)?);
    }
    if let Some(entry) = table.take("duration") {
        pose.duration_secs = Some(duration(&entry)?);
    }
    if let Some(entry) = table.take("controls") {
        by_control(&entry, "", controls, &mut pose.values, &value)?;
    }
    if let Some(entry) = table.take("transition") {
        pose.transition = Some(transition(&entry)?);
    }
    if let Some(entry) = table.take("timing") {
        by_control(&entry, "", controls, &mut pose.timings, &timing)?;
    }
    table.finish(&["name", "key", "duration", "transition", "controls", "timing"])?;
    Ok(pose)
}

pub(crate) fn duration(entry: &Entry<'_, '_>) -> Result<f64, TomlError> {
    let duration_secs = entry.precise(DURATION)?;
    if (0.001..=3600.0).contains(&duration_secs) {
        Ok(duration_secs)
    } else {
        Err(entry.error_found(DURATION))
    }
}

/// A key that none of `taken`, pairs of key and owner, has.
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
        let key = entry.name();
        let name = if prefix.is_empty() { key.to_owned() } else { format!("{prefix}.{key}") };
        let is_group = |table: Table<'_, '_>| {
            let group = format!("{name}.");
            !table.entries().is_empty() && controls.names().any(|control| control.starts_with(&group))
        };
        if let Some(index) = controls.index(&name) {
            if out.iter().any(|(other, _)| *other == index) {
                return Err(entry.error("each control once", format!("{} again", quote(&name))));
            }
            out.push((index, read(&entry, &controls.controls()[index])?));
        } else if entry.as_table().is_some_and(is_group) {
            by_control(&entry, &name, controls, out, read)?;
        } else {
            return Err(entry.unknown_name(&name, "one of the controls", controls.names()));
        }
    }
    Ok(())
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

fn timing(entry: &Entry<'_, '_>, _: &Control) -> Result<Timing, TomlError> {
    let mut table = entry.table()?;
    let mut timing = Timing::default();
    if let Some(entry) = table.take("delay") {
        timing.delay_secs = within(&entry, "a number of seconds from 0 to 3600", 0.0, 3600.0)?;
    }
    if let Some(entry) = table.take("factor") {
        timing.factor = within(&entry, "a number from 0.01 to 100", 0.01, 100.0)?;
    }
    table.finish(&["delay", "factor"])?;
    Ok(timing)
}

fn within(entry: &Entry<'_, '_>, expected: &str, min: f64, max: f64) -> Result<f64, TomlError> {
    let number = entry.precise(expected)?;
    if (min..=max).contains(&number) { Ok(number) } else { Err(entry.error_found(expected)) }
}

pub(crate) fn value(entry: &Entry<'_, '_>, control: &Control) -> Result<f32, TomlError> {
    let expected = format!("a number from {} to {}", control.min, control.max);
    let value = entry.number(&expected)?;
    if (control.min..=control.max).contains(&value) { Ok(value) } else { Err(entry.error_found(expected)) }
}
