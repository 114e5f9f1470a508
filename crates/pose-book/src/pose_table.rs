//! A pose as a table of `poses.toml`.

use crate::scalar::{easing, number, precise, put, put_precise};
use pose_anim::{ControlTable, Pose, Timing};
use toml_edit::{InlineTable, Item, Table, TableLike, Value, value};

/// A new table.
pub(crate) fn new(pose: &Pose, controls: &ControlTable) -> Table {
    let mut table = Table::new();
    table.insert("name", value(&pose.name));
    set_key(&mut table, pose.key.as_deref());
    set_duration(&mut table, pose.duration_secs);
    if let Some(transition) = pose.transition {
        table.insert("transition", value(easing(transition)));
    }
    set_values(&mut table, &pose.values, controls);
    let timings: Vec<_> = pose.timings.iter().filter(|(_, timing)| *timing != Timing::default()).collect();
    if !timings.is_empty() {
        let mut within = Table::new();
        for (control, timing) in timings {
            let mut entry = InlineTable::new();
            if timing.delay_secs != 0.0 {
                entry.insert("delay", precise(timing.delay_secs));
            }
            if timing.factor != 1.0 {
                entry.insert("factor", precise(timing.factor));
            }
            within.insert(name_of(controls, *control), value(entry));
        }
        table.insert("timing", Item::Table(within));
    }
    table
}

pub(crate) fn set_name(table: &mut Table, name: &str) {
    put(table.entry("name").or_insert(Item::None), Value::from(name));
}

pub(crate) fn set_key(table: &mut Table, key: Option<&str>) {
    set(table, "key", key.map(Value::from), put);
}

pub(crate) fn set_duration(table: &mut Table, duration_secs: Option<f64>) {
    set(table, "duration", duration_secs.map(precise), put_precise);
}

fn set(table: &mut Table, name: &str, new: Option<Value>, put: fn(&mut Item, Value)) {
    match new {
        Some(new) => put(table.entry(name).or_insert(Item::None), new),
        None => {
            table.remove(name);
        }
    }
}

/// Sets the values of these controls, and takes away those of all others.
pub(crate) fn set_values(table: &mut Table, values: &[(usize, f32)], controls: &ControlTable) {
    if table.get("controls").is_none_or(|item| !item.is_table_like()) {
        table.insert("controls", Item::Table(Table::new()));
    }
    let Some(entries) = table.get_mut("controls").and_then(Item::as_table_like_mut) else { return };
    let named: Vec<(&str, f32)> =
        values.iter().map(|(control, value)| (name_of(controls, *control), *value)).collect();
    retain(entries, "", &|name| named.iter().any(|(other, _)| *other == name), controls);
    for (name, value) in &named {
        match find(entries, name) {
            Some(item) => put(item, number(*value)),
            None => {
                entries.insert(name, Item::Value(number(*value)));
            }
        }
    }
    // They would count instead.
    table.remove("shapes");
    if named.len() < controls.len() {
        // It would say those that are to go on as they are.
        table.remove("others");
    }
}

fn name_of(controls: &ControlTable, control: usize) -> &str {
    controls.controls().get(control).map_or("", |control| control.name.as_str())
}

/// The entry of a control, written as `"head.turn"` or as `head.turn`, a table in a table.
fn find<'t>(entries: &'t mut dyn TableLike, name: &str) -> Option<&'t mut Item> {
    if entries.contains_key(name) {
        return entries.get_mut(name);
    }
    let dots = name.match_indices('.').map(|(dot, _)| dot);
    let group = dots.into_iter().find(|dot| {
        entries
            .get(&name[..*dot])
            .and_then(Item::as_table_like)
            .is_some_and(|group| has(group, &name[*dot + 1..]))
    })?;
    find(entries.get_mut(&name[..group])?.as_table_like_mut()?, &name[group + 1..])
}

fn has(entries: &dyn TableLike, name: &str) -> bool {
    entries.contains_key(name)
        || name.match_indices('.').any(|(dot, _)| {
            let group = entries.get(&name[..dot]).and_then(Item::as_table_like);
            group.is_some_and(|group| has(group, &name[dot + 1..]))
        })
}

/// Keeps those entries whose full names are wanted, and the groups that have any left.
fn retain(
    entries: &mut dyn TableLike,
    prefix: &str,
    is_wanted: &dyn Fn(&str) -> bool,
    controls: &ControlTable,
) {
    let keys: Vec<String> = entries.iter().map(|(key, _)| key.to_owned()).collect();
    for key in keys {
        let name = if prefix.is_empty() { key.clone() } else { format!("{prefix}.{key}") };
        if is_wanted(&name) {
            continue;
        }
        let is_control = controls.index(&name).is_some();
        let left = match entries.get_mut(&key).and_then(Item::as_table_like_mut) {
            Some(group) if !is_control => {
                retain(group, &name, is_wanted, controls);
                !group.is_empty()
            }
            _ => false,
        };
        if !left {
            entries.remove(&key);
        }
    }
}
