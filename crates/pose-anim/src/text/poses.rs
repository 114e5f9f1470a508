//! The format of `poses.toml`.

use super::entries::{by_control, has_all, key, transition, value};
use crate::{Control, ControlTable, Pose, PoseSet, Timing};
use placed_toml::{Document, Entry, Table, TomlError, quote};
use std::collections::HashSet;
use std::sync::LazyLock;

/// Values that `others` may add to all poses of a text: more is no set of faces.
const MOST_OTHERS: usize = 1 << 20;

const DURATION: &str = "a number of seconds from 0.001 to 3600";

/// The poses of the nine-joint face as a text, to be copied beside a face and changed.
pub const DEFAULT_POSES_TOML: &str = include_str!("../../assets/poses.toml");

/// The default poses by the names of controls, read once, when first needed: the text takes longer to read
/// than the meshes of a face. It is part of the crate and a test reads it, so the error cannot happen.
static DEFAULT_POSES: LazyLock<Vec<Said>> = LazyLock::new(|| said(DEFAULT_POSES_TOML).unwrap_or_default());

/// A default pose as its text says it, for faces that may lack some of its controls.
struct Said {
    /// What does not depend on the face: name and key. A test holds that the default poses have no more.
    pose: Pose,
    controls: Option<Vec<(String, f32)>>,
    shapes: Vec<(String, f32)>,
}

impl PoseSet {
    /// Reads a `poses.toml`; its format is described at the top of [`DEFAULT_POSES_TOML`].
    ///
    /// # Errors
    /// The first thing in the text that is not as it has to be, with its place: also a control that the table
    /// does not have, a value out of its range, a name or key that occurs twice.
    pub fn from_toml(text: &str, controls: &ControlTable) -> Result<Self, TomlError> {
        read(text, controls)
    }

    /// The poses of [`DEFAULT_POSES_TOML`] for any face: without the controls that it lacks, within its
    /// ranges, and with all that a pose does not say at their defaults. A face that has all of a pose's
    /// `shapes` gets them; poses that are made of `shapes` alone are left out where one is missing.
    pub fn default_face(controls: &ControlTable) -> Self {
        let of_face = |values: &[(String, f32)]| -> Vec<(usize, f32)> {
            let known = values.iter().filter_map(|(name, value)| {
                let here = controls.index(name)?;
                let control = &controls.controls()[here];
                Some((here, value.max(control.min).min(control.max)))
            });
            known.collect()
        };
        let poses = DEFAULT_POSES.iter().filter_map(|said| {
            let shapes = of_face(&said.shapes);
            let has_all = shapes.len() == said.shapes.len();
            if said.controls.is_none() && !has_all {
                return None;
            }
            let mut pose = said.pose.clone();
            pose.values = of_face(said.controls.as_deref().unwrap_or_default());
            if has_all {
                put_over(&mut pose.values, shapes);
            }
            rest_others(&mut pose, controls);
            Some(pose)
        });
        Self { poses: poses.collect() }
    }
}

/// Reads the default poses without a face.
fn said(source: &str) -> Result<Vec<Said>, TomlError> {
    let document = Document::parse(source)?;
    let mut poses = Vec::new();
    for mut table in document.root().take_tables("pose")? {
        let mut pose = Pose::new(table.require("name", "the name of a pose")?.string("a name")?, Vec::new());
        pose.key = table.take("key").map(|entry| entry.string("a key").map(str::to_owned)).transpose()?;
        let controls = table.take("controls").map(|entry| numbers(&entry)).transpose()?;
        let shapes = table.take("shapes").map(|entry| numbers(&entry)).transpose()?.unwrap_or_default();
        poses.push(Said { pose, controls, shapes });
    }
    Ok(poses)
}

/// All entries of a table by their names, also those of tables in it: `head.turn` is `"head.turn"`.
fn numbers(entry: &Entry<'_, '_>) -> Result<Vec<(String, f32)>, TomlError> {
    let mut out = Vec::new();
    for entry in entry.table()?.rest() {
        let name = entry.name();
        if entry.as_table().is_some() {
            out.extend(numbers(&entry)?.into_iter().map(|(rest, value)| (format!("{name}.{rest}"), value)));
        } else {
            out.push((name.to_owned(), entry.number("a number")?));
        }
    }
    Ok(out)
}

/// Values of which the latter ones count.
fn put_over(values: &mut Vec<(usize, f32)>, over: Vec<(usize, f32)>) {
    let said: HashSet<usize> = over.iter().map(|(control, _)| *control).collect();
    values.retain(|(control, _)| !said.contains(control));
    values.extend(over);
}

fn read(source: &str, controls: &ControlTable) -> Result<PoseSet, TomlError> {
    let document = Document::parse(source)?;
    let mut root = document.root();
    let mut set = PoseSet::default();
    let mut room = MOST_OTHERS;
    // Poses that this face cannot take are read as well: a text is right or wrong for all faces alike.
    let mut is_shown = Vec::new();
    for table in root.take_tables("pose")? {
        let (pose, is_for_face) = pose(table, controls, &set, &mut room)?;
        set.poses.push(pose);
        is_shown.push(is_for_face);
    }
    root.finish(&["pose"])?;
    let mut is_shown = is_shown.into_iter();
    set.poses.retain(|_| is_shown.next().unwrap_or(true));
    Ok(set)
}

/// Adds the defaults of all controls that the pose does not say.
fn rest_others(pose: &mut Pose, controls: &ControlTable) {
    let said: HashSet<usize> = pose.values.iter().map(|(control, _)| *control).collect();
    let others = controls.controls().iter().enumerate().filter(|(index, _)| !said.contains(index));
    pose.values.extend(others.map(|(index, control)| (index, control.default)));
}

/// Reads a pose, and whether the face can take it; `room` is how many values `others` may still add.
fn pose(
    mut table: Table<'_, '_>,
    controls: &ControlTable,
    before: &PoseSet,
    room: &mut usize,
) -> Result<(Pose, bool), TomlError> {
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
    let mut is_for_face = true;
    let base = table.take("controls");
    if let Some(entry) = &base {
        by_control(entry, "", controls, &mut pose.values, &value)?;
    }
    if let Some(entry) = table.take("shapes") {
        if has_all(&entry, controls)? {
            let mut shapes = Vec::new();
            by_control(&entry, "", controls, &mut shapes, &value)?;
            put_over(&mut pose.values, shapes);
        } else {
            is_for_face = base.is_some();
        }
    }
    if let Some(entry) = table.take("others") {
        let word = entry.string("\"default\"")?;
        if word != "default" {
            return Err(entry.unknown_value(word, "only", ["default"]));
        }
        let more = controls.len().saturating_sub(pose.values.len());
        *room = room.checked_sub(more).ok_or_else(|| {
            entry.error(format!("poses that say at most {MOST_OTHERS} others in all"), "more")
        })?;
        rest_others(&mut pose, controls);
    }
    if let Some(entry) = table.take("transition") {
        pose.transition = Some(transition(&entry)?);
    }
    if let Some(entry) = table.take("timing") {
        by_control(&entry, "", controls, &mut pose.timings, &timing)?;
    }
    table.finish(&["name", "key", "duration", "transition", "controls", "shapes", "others", "timing"])?;
    Ok((pose, is_for_face))
}

fn duration(entry: &Entry<'_, '_>) -> Result<f64, TomlError> {
    let duration_secs = entry.precise(DURATION)?;
    if (0.001..=3600.0).contains(&duration_secs) {
        Ok(duration_secs)
    } else {
        Err(entry.error_found(DURATION))
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
