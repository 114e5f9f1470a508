//! A clip as a table of `clips.toml`.

use crate::scalar::{easing, number, precise, put};
use pose_anim::{Clip, ControlTable, Easing, Key, Track, Transition, Wrap};
use toml_edit::{Array, InlineTable, Item, Table, Value, value};

/// Writes a clip into a table. Entries that already have the right value keep their text.
pub(crate) fn set(table: &mut Table, clip: &Clip, before: Option<&Clip>, controls: &ControlTable) {
    put(table.entry("name").or_insert(Item::None), Value::from(&clip.name));
    let wrap = match clip.wrap {
        Wrap::Once => None,
        Wrap::Loop => Some("loop"),
        Wrap::PingPong => Some("ping-pong"),
    };
    for (name, new) in [("key", clip.key.as_deref()), ("wrap", wrap)] {
        match new {
            Some(new) => put(table.entry(name).or_insert(Item::None), Value::from(new)),
            None => {
                table.remove(name);
            }
        }
    }
    if before.is_some_and(|before| before.tracks() == clip.tracks()) {
        return;
    }
    let mut tracks = Table::new();
    for track in clip.tracks() {
        let name = controls.controls().get(track.control()).map_or("", |control| control.name.as_str());
        tracks.insert(name, value(keys(track)));
    }
    if let Some(old) = table.get("tracks").and_then(Item::as_table) {
        keep_tracks(&mut tracks, old, clip, before, controls);
    }
    table.insert("tracks", Item::Table(tracks));
}

/// Tracks that did not change keep their text, and those that did the comments above them.
fn keep_tracks(tracks: &mut Table, old: &Table, clip: &Clip, before: Option<&Clip>, controls: &ControlTable) {
    *tracks.decor_mut() = old.decor().clone();
    tracks.set_position(old.position());
    for track in clip.tracks() {
        let Some(name) = controls.controls().get(track.control()).map(|control| &control.name) else {
            continue;
        };
        let Some((key, item)) = old.get_key_value(name) else { continue };
        let same = before.and_then(|before| before.track(track.control())) == Some(track);
        let item = if same { item.clone() } else { tracks.get(name).cloned().unwrap_or_default() };
        tracks.remove(name);
        tracks.insert_formatted(key, item);
    }
}

/// One key a line: that is how they are read and compared.
fn keys(track: &Track) -> Array {
    let mut array = Array::new();
    for key in track.keys() {
        let mut entry = Value::from(self::key(key));
        entry.decor_mut().set_prefix("\n    ");
        array.push_formatted(entry);
    }
    array.set_trailing("\n");
    array.set_trailing_comma(true);
    array
}

fn key(key: &Key) -> InlineTable {
    let mut table = InlineTable::new();
    table.insert("t", precise(key.time_secs));
    // Values are read at 32 bits.
    table.insert("v", number(key.value as f32));
    match key.transition {
        Transition::Ease(Easing::Linear) => {}
        Transition::Ease(function) => {
            table.insert("transition", easing(function));
        }
        Transition::Hermite { leaving, arriving } => {
            table.insert(
                "slopes",
                Value::from([leaving, arriving].into_iter().map(precise).collect::<Array>()),
            );
        }
        Transition::Part { easing: function, from, to, rise } => {
            let mut part = InlineTable::new();
            part.insert("of", easing(function));
            part.insert("from", precise(from));
            part.insert("to", precise(to));
            part.insert("rise", precise(rise));
            table.insert("part", Value::from(part));
        }
    }
    table
}
