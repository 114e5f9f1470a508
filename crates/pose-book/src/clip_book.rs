use crate::history::History;
use crate::{BookError, arrange, clip_table};
use pose_anim::{Clip, ClipSet, ControlTable};
use toml_edit::Table;

const ENTRY: &str = "clip";

/// A `clips.toml` that is edited.
#[derive(Clone, Debug)]
pub struct ClipBook {
    controls: ControlTable,
    history: History,
    clips: ClipSet,
}

impl ClipBook {
    /// Opens a text; the empty one has no clips.
    ///
    /// # Errors
    /// The first thing in it that is not as [`ClipSet::from_toml`] demands.
    pub fn read(text: &str, controls: &ControlTable) -> Result<Self, BookError> {
        let clips = ClipSet::from_toml(text, controls)?;
        Ok(Self { controls: controls.clone(), history: History::new(text.to_owned()), clips })
    }

    /// A text for clips that come from elsewhere.
    ///
    /// # Errors
    /// Clips that a text cannot hold: a name twice, a value beyond its control's range.
    pub fn of_set(clips: &ClipSet, controls: &ControlTable) -> Result<Self, BookError> {
        Self::read(&clips.to_toml(controls), controls)
    }

    /// What the file says now.
    pub fn text(&self) -> &str {
        &self.history.text
    }

    /// What the text means.
    pub fn clips(&self) -> &ClipSet {
        &self.clips
    }

    /// Takes over a text that another program wrote. Earlier edits cannot be undone afterwards. The same text
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

    /// Adds a clip at the end.
    ///
    /// # Errors
    /// A name or key that another clip has, or a value beyond its control's range.
    pub fn add(&mut self, clip: &Clip) -> Result<usize, BookError> {
        let mut table = Table::new();
        clip_table::set(&mut table, clip, None, &self.controls);
        self.edit(format!("add {}", clip.name), |entries| entries.push(table))?;
        Ok(self.clips.clips.len().saturating_sub(1))
    }

    /// Puts a clip in the place of another one; `what` says what that does, for undo. Tracks that stay the
    /// same stay as they are written.
    ///
    /// # Errors
    /// No such clip, a name or key that another one has, or a value beyond its control's range.
    pub fn set(&mut self, index: usize, clip: &Clip, what: impl Into<String>) -> Result<(), BookError> {
        let before = self.clip(index)?.clone();
        let controls = self.controls.clone();
        self.edit(what.into(), |entries| {
            clip_table::set(&mut entries[index], clip, Some(&before), &controls);
        })
    }

    /// Takes a clip away.
    ///
    /// # Errors
    /// No such clip.
    pub fn remove(&mut self, index: usize) -> Result<(), BookError> {
        let edit = format!("delete {}", self.clip(index)?.name);
        self.edit(edit, |entries| {
            entries.remove(index);
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

    fn clip(&self, index: usize) -> Result<&Clip, BookError> {
        let len = self.clips.clips.len();
        self.clips.clips.get(index).ok_or(BookError::Index { index, len })
    }

    /// Texts of the history have been read before, so the error does not happen.
    fn understand(&mut self) {
        if let Ok(clips) = ClipSet::from_toml(&self.history.text, &self.controls) {
            self.clips = clips;
        }
    }

    fn edit(&mut self, edit: String, change: impl FnOnce(&mut Vec<Table>)) -> Result<(), BookError> {
        let text = arrange::edited(&self.history.text, ENTRY, change);
        match ClipSet::from_toml(&text, &self.controls) {
            Err(source) => Err(BookError::Refused { edit, source: Box::new(source) }),
            Ok(clips) => {
                self.clips = clips;
                if text != self.history.text {
                    self.history.push(edit, text);
                }
                Ok(())
            }
        }
    }
}
