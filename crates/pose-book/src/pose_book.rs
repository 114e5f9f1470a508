use crate::history::History;
use crate::{BookError, arrange, pose_table};
use pose_anim::{ControlTable, DEFAULT_POSES_TOML, Pose, PoseSet};
use toml_edit::{Item, Table};

const ENTRY: &str = "pose";

/// A `poses.toml` that is edited.
#[derive(Clone, Debug)]
pub struct PoseBook {
    controls: ControlTable,
    history: History,
    poses: PoseSet,
}

impl PoseBook {
    /// Opens a text.
    ///
    /// # Errors
    /// The first thing in it that is not as [`PoseSet::from_toml`] demands.
    pub fn read(text: &str, controls: &ControlTable) -> Result<Self, BookError> {
        let poses = PoseSet::from_toml(text, controls)?;
        Ok(Self { controls: controls.clone(), history: History::new(text.to_owned()), poses })
    }

    /// A text for poses that come from elsewhere: the usual one of the nine-joint face, with its comments, if
    /// they are its poses.
    ///
    /// # Errors
    /// Poses that no text can say: a name twice, a value beyond its control's range.
    pub fn of_set(poses: &PoseSet, controls: &ControlTable) -> Result<Self, BookError> {
        if PoseSet::from_toml(DEFAULT_POSES_TOML, controls).is_ok_and(|usual| usual == *poses) {
            // Without those that the face cannot take: their names and keys are free.
            let is_there = |entry: &Table| {
                entry.get("name").and_then(Item::as_str).is_some_and(|name| poses.get(name).is_some())
            };
            let text = arrange::edited(DEFAULT_POSES_TOML, ENTRY, |entries| entries.retain(is_there));
            return Self::read(&text, controls);
        }
        Self::read(&poses.to_toml(controls), controls)
    }

    /// What the file says now.
    pub fn text(&self) -> &str {
        &self.history.text
    }

    /// What the text means.
    pub fn poses(&self) -> &PoseSet {
        &self.poses
    }

    /// Takes over a text that somebody else wrote. What was done before cannot be undone then; the same text
    /// changes nothing.
    ///
    /// # Errors
    /// As [`Self::read`]; then the book stays as it is.
    pub fn replace(&mut self, text: &str) -> Result<(), BookError> {
        if text != self.history.text {
            *self = Self::read(text, &self.controls)?;
        }
        Ok(())
    }

    /// Adds a pose at the end.
    ///
    /// # Errors
    /// A name or key that another pose has, or a value beyond its control's range.
    pub fn add(&mut self, pose: &Pose) -> Result<usize, BookError> {
        let table = pose_table::new(pose, &self.controls);
        self.edit(format!("add {}", pose.name), |entries| entries.push(table))?;
        Ok(self.poses.poses.len().saturating_sub(1))
    }

    /// Gives a pose another name.
    ///
    /// # Errors
    /// No such pose, or a name that another one has.
    pub fn rename(&mut self, index: usize, name: &str) -> Result<(), BookError> {
        let edit = format!("rename {} to {name}", self.pose(index)?.name);
        self.edit_entry(index, edit, |entry| pose_table::set_name(entry, name))
    }

    /// Gives a pose another name, key and duration, in one edit.
    ///
    /// # Errors
    /// No such pose, a name or key that another one has, or a duration that the format does not allow.
    pub fn describe(
        &mut self,
        index: usize,
        name: &str,
        key: Option<&str>,
        duration_secs: Option<f64>,
    ) -> Result<(), BookError> {
        let edit = format!("change {}", self.pose(index)?.name);
        self.edit_entry(index, edit, |entry| {
            pose_table::set_name(entry, name);
            pose_table::set_key(entry, key);
            pose_table::set_duration(entry, duration_secs);
        })
    }

    /// Gives a pose other values; controls that are not among them are no longer the pose's.
    ///
    /// # Errors
    /// No such pose, or a value beyond its control's range.
    pub fn set_values(&mut self, index: usize, values: &[(usize, f32)]) -> Result<(), BookError> {
        let edit = format!("set the face of {}", self.pose(index)?.name);
        let controls = self.controls.clone();
        self.edit_entry(index, edit, |entry| pose_table::set_values(entry, values, &controls))
    }

    /// Puts a pose where another one is, which moves on.
    ///
    /// # Errors
    /// No such pose.
    pub fn move_to(&mut self, from: usize, to: usize) -> Result<(), BookError> {
        let edit = format!("move {}", self.pose(from)?.name);
        let (from, to) = (self.pose(from)?.name.clone(), self.pose(to)?.name.clone());
        self.edit(edit, |entries| {
            if let (Some(from), Some(to)) = (place(entries, &from), place(entries, &to)) {
                let entry = entries.remove(from);
                entries.insert(to, entry);
            }
        })
    }

    /// Takes a pose away.
    ///
    /// # Errors
    /// No such pose.
    pub fn remove(&mut self, index: usize) -> Result<(), BookError> {
        let name = self.pose(index)?.name.clone();
        self.edit(format!("delete {name}"), |entries| {
            if let Some(at) = place(entries, &name) {
                entries.remove(at);
            }
        })
    }

    /// Name of the edit that [`Self::undo`] takes back.
    pub fn can_undo(&self) -> Option<&str> {
        self.history.can_undo()
    }

    /// Name of the edit that [`Self::redo`] does again.
    pub fn can_redo(&self) -> Option<&str> {
        self.history.can_redo()
    }

    /// Takes the last edit back and returns its name; `None` if there is none.
    pub fn undo(&mut self) -> Option<String> {
        let edit = self.history.undo();
        self.understand();
        edit
    }

    /// Does the edit again that was taken back last.
    pub fn redo(&mut self) -> Option<String> {
        let edit = self.history.redo();
        self.understand();
        edit
    }

    fn pose(&self, index: usize) -> Result<&Pose, BookError> {
        let len = self.poses.poses.len();
        self.poses.poses.get(index).ok_or(BookError::Index { index, len })
    }

    /// Texts of the history have been read before, so the error does not happen.
    fn understand(&mut self) {
        if let Ok(poses) = PoseSet::from_toml(&self.history.text, &self.controls) {
            self.poses = poses;
        }
    }

    /// Changes the entry of a pose.
    fn edit_entry(
        &mut self,
        index: usize,
        edit: String,
        change: impl FnOnce(&mut Table),
    ) -> Result<(), BookError> {
        let name = self.pose(index)?.name.clone();
        self.edit(edit, |entries| {
            if let Some(at) = place(entries, &name) {
                change(&mut entries[at]);
            }
        })
    }

    fn edit(&mut self, edit: String, change: impl FnOnce(&mut Vec<Table>)) -> Result<(), BookError> {
        let text = arrange::edited(&self.history.text, ENTRY, change);
        match PoseSet::from_toml(&text, &self.controls) {
            Err(source) => Err(BookError::Refused { edit, source: Box::new(source) }),
            Ok(poses) => {
                self.poses = poses;
                if text != self.history.text {
                    self.history.push(edit, text);
                }
                Ok(())
            }
        }
    }
}

/// Which entry of the text a pose is. Names are unique, and the text may have poses that the face cannot
/// take.
fn place(entries: &[Table], name: &str) -> Option<usize> {
    entries.iter().position(|entry| entry.get("name").and_then(Item::as_str) == Some(name))
}
