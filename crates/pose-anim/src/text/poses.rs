//! The format of `poses.toml`.

use super::entries::{by_control, key, transition, value};
use crate::{Control, ControlTable, Pose, PoseSet, Timing};
use placed_toml::{Document, Entry, Table, TomlError, quote};
use std::collections::HashSet;
use std::sync::LazyLock;

/// Values that `others` may add to all poses of a text: more is no set of faces.
const MOST_OTHERS: usize = 1 << 20;

const DURATION: &str = "a number of seconds from 0.001 to 3600";

/// The poses of the nine-joint face as a text, to be copied beside a face and changed.
pub const DEFAULT_POSES_TOML: &str = include_str!("../../assets/poses.toml");

/// The controls and poses of the nine-joint face, read once, when first needed: these texts take longer to
/// read than the meshes of a face. The text is part of the crate and a test reads it, so the error cannot
/// happen.
static DEFAULT_FACE: LazyLock<(ControlTable, PoseSet)> = LazyLock::new(|| {
    let controls = ControlTable::default_face();
    let poses = read(DEFAULT_POSES_TOML, &controls).unwrap_or_default();
    (controls, poses)
});

impl PoseSet {
    /// Reads a `poses.toml`; its format is described at the top of [`DEFAULT_POSES_TOML`].
    ///
    /// # Errors
    /// The first thing in the text that is not as it has to be, with its place: also a control that the table
    /// does not have, a value out of its range, a name or key that occurs twice.
    pub fn from_toml(text: &str, controls: &ControlTable) -> Result<Self, TomlError> {
        read(text, controls)
    }

    /// The poses of the nine-joint face: [`DEFAULT_POSES_TOML`]. For a face with other controls: without
    /// those that it lacks, within its ranges, and with all that these poses do not know at their defaults.
    pub fn default_face(controls: &ControlTable) -> Self {
        let (face, poses) = &*DEFAULT_FACE;
        let mut set = poses.clone();
        let names = face.controls().iter().map(|control| controls.index(&control.name));
        let of_face: Vec<Option<usize>> = names.collect();
        for pose in &mut set.poses {
            let values = pose.values.iter().filter_map(|(index, value)| {
                let here = of_face[*index]?;
                let control = &controls.controls()[here];
                Some((here, value.max(control.min).min(control.max)))
            });
            pose.values = values.collect();
            rest_others(pose, controls);
            let timings = pose.timings.iter();
            let timings = timings.filter_map(|(index, timing)| Some((of_face[*index]?, *timing)));
            pose.timings = timings.collect();
        }
        set
    }
}

fn read(source: &str, controls: &ControlTable) -> Result<PoseSet, TomlError> {
    let document = Document::parse(source)?;
    let mut root = document.root();
    let mut set = PoseSet::default();
    let mut room = MOST_OTHERS;
    for table in root.take_tables("pose")? {
        let pose = pose(table, controls, &set, &mut room)?;
        set.poses.push(pose);
    }
    root.finish(&["pose"])?;
    Ok(set)
}

/// Adds the defaults of all controls that the pose does not say.
fn rest_others(pose: &mut Pose, controls: &ControlTable) {
    let said: HashSet<usize> = pose.values.iter().map(|(control, _)| *control).collect();
    let others = controls.controls().iter().enumerate().filter(|(index, _)| !said.contains(index));
    pose.values.extend(others.map(|(index, control)| (index, control.default)));
}

/// Reads a pose; `room` is how many values `others` may still add.
fn pose(
    mut table: Table<'_, '_>,
    controls: &ControlTable,
    before: &PoseSet,
    room: &mut usize,
) -> Result<Pose, TomlError> {
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
    table.finish(&["name", "key", "duration", "transition", "controls", "others", "timing"])?;
    Ok(pose)
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
