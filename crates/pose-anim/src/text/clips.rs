//! The format of `clips.toml`.

use super::entries::{by_control, key, transition, value};
use crate::clip::LATEST_SECS;
use crate::{Clip, ClipSet, Control, ControlTable, Key, Track, Transition, Wrap};
use placed_toml::{Document, Entry, Table, TomlError, quote};

const TIME: &str = "a number of seconds from 0 to 1000000, not before the previous key's";
const SLOPES: &str = "[leaving, arriving]: the slopes of a cubic, per second, here and at the next key";
const RISE: &str = "by how much the whole rises, from -1e9 to 1e9";
const FARTHEST: f64 = 1e9;

impl ClipSet {
    /// Reads a `clips.toml`:
    ///
    /// ```
    /// # let controls = pose_anim::ControlTable::default_face();
    /// let clips = pose_anim::ClipSet::from_toml(
    ///     r#"
    ///     [[clip]]
    ///     name = "nod"
    ///     key = "n"       # may be absent
    ///     wrap = "once"   # or "loop" or "ping-pong"
    ///     [clip.tracks]
    ///     "head.bow" = [
    ///         { t = 0.0, v = 0, transition = "sine-in-out" },    # a name, or [x1, y1, x2, y2] as in CSS
    ///         { t = 0.3, v = 14, slopes = [0, 0] },              # cubic: its slopes here and at the next
    ///         { t = 0.8, v = 0 },                                # straight, if there were a next key
    ///         ## what a key baked into an eased span leaves on either side is a part of the whole:
    ///         ## { t = 0.9, v = 1, part = { of = "sine-in-out", from = 0.5, to = 1, rise = 14 } }
    ///     ]
    ///     "#,
    ///     &controls,
    /// )?;
    /// assert_eq!(clips.get("nod").map(|clip| clip.duration_secs()), Some(0.8));
    /// # Ok::<(), pose_anim::TomlError>(())
    /// ```
    ///
    /// # Errors
    /// The first thing in the text that is not as it has to be, with its place: also a control that the table
    /// does not have, a value out of its range, a time before its predecessor's, a name or key that occurs
    /// twice.
    pub fn from_toml(text: &str, controls: &ControlTable) -> Result<Self, TomlError> {
        read(text, controls)
    }
}

fn read(source: &str, controls: &ControlTable) -> Result<ClipSet, TomlError> {
    let document = Document::parse(source)?;
    let mut root = document.root();
    let mut set = ClipSet::default();
    for table in root.take_tables("clip")? {
        let clip = clip(table, controls, &set)?;
        set.clips.push(clip);
    }
    root.finish(&["clip"])?;
    Ok(set)
}

fn clip(mut table: Table<'_, '_>, controls: &ControlTable, before: &ClipSet) -> Result<Clip, TomlError> {
    let entry = table.require("name", "the name of a clip")?;
    let name = entry.string("the name of a clip")?;
    if before.get(name).is_some() {
        return Err(entry.error("unique names", format!("{} again", quote(name))));
    }
    let mut clip = Clip { name: name.to_owned(), ..Clip::default() };
    if let Some(entry) = table.take("key") {
        let taken = before.clips.iter().filter_map(|clip| Some((clip.key.as_deref()?, clip.name.as_str())));
        clip.key = Some(key(&entry, "clip", taken)?);
    }
    if let Some(entry) = table.take("wrap") {
        clip.wrap = match entry.string("\"once\", \"loop\" or \"ping-pong\"")? {
            "once" => Wrap::Once,
            "loop" => Wrap::Loop,
            "ping-pong" => Wrap::PingPong,
            other => {
                return Err(entry.unknown_value(other, "one of", ["once", "loop", "ping-pong"]));
            }
        };
    }
    let mut tracks = Vec::new();
    let entry = table.require("tracks", "a table of tracks")?;
    by_control(&entry, "", controls, &mut tracks, &keys)?;
    for (control, keys) in tracks {
        let track = Track::new(control, keys);
        clip.tracks.push(track.map_err(|error| entry.error("tracks of keys", error.to_string()))?);
    }
    table.finish(&["name", "key", "wrap", "tracks"])?;
    Ok(clip)
}

fn keys(entry: &Entry<'_, '_>, control: &Control) -> Result<Vec<Key>, TomlError> {
    let mut keys: Vec<Key> = Vec::new();
    for entry in entry.array()? {
        let mut table = entry.table()?;
        let time = table.require("t", TIME)?;
        let time_secs = time.precise(TIME)?;
        let earliest_secs = keys.last().map_or(0.0, |key| key.time_secs);
        if !(earliest_secs..=LATEST_SECS).contains(&time_secs) {
            return Err(time.error_found(TIME));
        }
        let value = f64::from(value(&table.require("v", "a value")?, control)?);
        let mut key = Key { time_secs, value, transition: Transition::LINEAR };
        if let Some(entry) = table.take("transition") {
            key.transition = Transition::Ease(transition(&entry)?);
        }
        if let Some(entry) = table.take("slopes") {
            let slopes: Vec<f64> =
                entry.array()?.iter().map(|item| item.precise(SLOPES)).collect::<Result<_, _>>()?;
            let [leaving, arriving] = slopes[..] else { return Err(entry.error_found(SLOPES)) };
            if key.transition != Transition::LINEAR {
                return Err(entry.error("either a transition or slopes", "both"));
            }
            key.transition = Transition::Hermite { leaving, arriving };
        }
        if let Some(entry) = table.take("part") {
            if key.transition != Transition::LINEAR {
                return Err(entry.error("either a transition, slopes or part of a transition", "two of them"));
            }
            key.transition = part(&entry)?;
        }
        table.finish(&["t", "v", "transition", "slopes", "part"])?;
        keys.push(key);
    }
    if keys.is_empty() { Err(entry.error("at least one key", "none")) } else { Ok(keys) }
}

/// Reads a part of an eased span, which is what remains on either side of a key that was inserted with
/// [`Track::bake`].
fn part(entry: &Entry<'_, '_>) -> Result<Transition, TomlError> {
    let mut table = entry.table()?;
    let easing = transition(&table.require("of", "the transition of the whole")?)?;
    let mut share = |name| {
        let expected = "a share of the whole's time, from 0 to 1";
        let entry = table.require(name, expected)?;
        let share = entry.precise(expected)?;
        if (0.0..=1.0).contains(&share) { Ok(share) } else { Err(entry.error_found(expected)) }
    };
    let (from, to) = (share("from")?, share("to")?);
    let rise = table.require("rise", RISE)?;
    let whole = rise.precise(RISE)?;
    if !(-FARTHEST..=FARTHEST).contains(&whole) {
        return Err(rise.error_found(RISE));
    }
    table.finish(&["of", "from", "to", "rise"])?;
    Ok(Transition::Part { easing, from, to, rise: whole })
}
