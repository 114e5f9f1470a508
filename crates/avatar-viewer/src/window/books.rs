//! A face's poses and clips, edited: in their texts, which can be undone, and for poses in their file at once.

use super::face::{Face, Playback};
use crate::store;
use anyhow::Result;
use pose_anim::{Clip, Key, Pose, Track};
use pose_book::{BookError, PoseBook};

/// Which text an edit is in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Book {
    Poses,
    Clips,
}

/// In which order texts were edited: each knows only its own edits.
#[derive(Clone, Debug, Default)]
pub(super) struct Order {
    done: Vec<Book>,
    undone: Vec<Book>,
}

impl Order {
    fn note(&mut self, book: Book) {
        self.done.push(book);
        self.undone.clear();
    }

    /// A text was read anew: its edits are no more.
    fn forget(&mut self, book: Book) {
        self.done.retain(|other| *other != book);
        self.undone.retain(|other| *other != book);
    }
}

impl Face {
    /// Changes the poses, and their file.
    pub(super) fn edit_poses(
        &mut self,
        edit: impl FnOnce(&mut PoseBook, &Pose) -> Result<(), BookError>,
    ) -> Result<()> {
        self.change_poses(edit)?;
        self.order.note(Book::Poses);
        Ok(())
    }

    fn change_poses(
        &mut self,
        edit: impl FnOnce(&mut PoseBook, &Pose) -> Result<(), BookError>,
    ) -> Result<()> {
        let present = self.present("");
        let before = self.poses.clone();
        edit(&mut self.poses, &present)?;
        if let Err(error) = self.store.write(store::POSES, self.poses.text()) {
            self.poses = before;
            return Err(error);
        }
        self.pack.set_poses(self.poses.poses().clone())?;
        Ok(())
    }

    /// Changes a clip; it is written to its file when the user says so.
    pub(super) fn edit_clip(
        &mut self,
        index: usize,
        what: &str,
        edit: impl FnOnce(&mut Clip) -> Result<()>,
    ) -> Result<()> {
        let Some(mut clip) = self.clips.clips().clips.get(index).cloned() else { return Ok(()) };
        edit(&mut clip)?;
        self.clips.set(index, &clip, what)?;
        self.order.note(Book::Clips);
        self.clips_changed()?;
        // What is shown follows what is edited.
        if !self.playback.playing && self.playback.clip == Some(index) {
            self.scrub(index, self.playback.time_secs);
        }
        Ok(())
    }

    /// A new clip, without keys yet.
    pub(super) fn new_clip(&mut self) -> Result<()> {
        let name = self.free_name("clip");
        let clip = Clip::new(name, Vec::new())?;
        self.add_clip(&clip)
    }

    pub(super) fn add_clip(&mut self, clip: &Clip) -> Result<()> {
        let index = self.clips.add(clip)?;
        self.order.note(Book::Clips);
        self.clips_changed()?;
        self.forget_playback();
        self.playback.clip = Some(index);
        Ok(())
    }

    pub(super) fn delete_clip(&mut self, index: usize) -> Result<()> {
        self.clips.remove(index)?;
        self.order.note(Book::Clips);
        self.clips_changed()?;
        self.forget_playback();
        Ok(())
    }

    /// What plays may be another clip now, or none.
    fn forget_playback(&mut self) {
        self.pause();
        self.playback = Playback::default();
    }

    fn clips_changed(&mut self) -> Result<()> {
        self.pack.set_clips(self.clips.clips().clone())?;
        Ok(())
    }

    /// Whether the clips' file says something else.
    pub(super) fn has_unsaved_clips(&self) -> bool {
        self.clips.text() != self.store.text(store::CLIPS)
    }

    pub(super) fn save_clips(&mut self) -> Result<()> {
        self.store.write(store::CLIPS, self.clips.text())
    }

    pub(super) fn free_name(&self, stem: &str) -> String {
        let clips = self.clips.clips();
        let mut names = std::iter::once(stem.to_owned()).chain((2..).map(|count| format!("{stem} {count}")));
        names.find(|name| clips.get(name).is_none()).unwrap_or_default()
    }

    /// Adds a key to a clip at a time: the in-between, or the present value where the control has no track yet.
    pub(super) fn insert_key(&mut self, index: usize, control: usize, time_secs: f64) -> Result<()> {
        let value = f64::from(self.goal.get(control).copied().unwrap_or_default());
        self.edit_clip(index, "insert a key", |clip| {
            match clip.track_mut(control) {
                Some(track) => {
                    track.bake(time_secs)?;
                }
                None => {
                    let track = Track::new(
                        control,
                        vec![Key::new(time_secs, value, pose_anim::Easing::MinimumJerk)],
                    )?;
                    let tracks = clip.tracks().iter().cloned().chain([track]).collect();
                    let (key, wrap) = (clip.key.clone(), clip.wrap);
                    *clip = Clip::new(clip.name.clone(), tracks)?.wrapped(wrap);
                    clip.key = key;
                }
            }
            Ok(())
        })
    }

    /// Takes a key away; with the last one goes the track.
    pub(super) fn delete_key(&mut self, index: usize, control: usize, key: usize) -> Result<()> {
        self.edit_clip(index, "delete a key", |clip| {
            if let Some(track) = clip.track_mut(control)
                && track.keys().len() > 1
            {
                track.remove_key(key)?;
                return Ok(());
            }
            let tracks = clip.tracks().iter().filter(|track| track.control() != control).cloned().collect();
            let (key, wrap) = (clip.key.clone(), clip.wrap);
            *clip = Clip::new(clip.name.clone(), tracks)?.wrapped(wrap);
            clip.key = key;
            Ok(())
        })
    }

    /// What an undo takes back, or a redo does again.
    pub(super) fn can_undo(&self, again: bool) -> Option<&str> {
        self.last_edit(again).map(|(_, what)| what)
    }

    fn last_edit(&self, again: bool) -> Option<(usize, &str)> {
        let books = if again { &self.order.undone } else { &self.order.done };
        let what = |book: &Book| match (book, again) {
            (Book::Poses, false) => self.poses.can_undo(),
            (Book::Poses, true) => self.poses.can_redo(),
            (Book::Clips, false) => self.clips.can_undo(),
            (Book::Clips, true) => self.clips.can_redo(),
        };
        books.iter().enumerate().rev().find_map(|(place, book)| Some((place, what(book)?)))
    }

    pub(super) fn undo(&mut self, again: bool) -> Result<()> {
        let Some((place, _)) = self.last_edit(again) else { return Ok(()) };
        let books = if again { &self.order.undone } else { &self.order.done };
        let book = books[place];
        match book {
            Book::Poses => {
                self.change_poses(|book, _| {
                    let _ = if again { book.redo() } else { book.undo() };
                    Ok(())
                })?;
                self.active_pose = None;
            }
            Book::Clips => {
                let _ = if again { self.clips.redo() } else { self.clips.undo() };
                self.clips_changed()?;
                let clips = self.clips.clips().clips.len();
                match self.playback.clip {
                    Some(index) if index >= clips => self.forget_playback(),
                    _ => self.pause(),
                }
            }
        }
        let (from, to) = match again {
            false => (&mut self.order.done, &mut self.order.undone),
            true => (&mut self.order.undone, &mut self.order.done),
        };
        from.truncate(place);
        to.push(book);
        Ok(())
    }

    /// Reads the poses again, which somebody else may have written.
    ///
    /// # Errors
    /// The first mistake in them; the old ones stay.
    pub(super) fn reload_poses(&mut self) -> Result<bool> {
        match self.store.read(store::POSES)? {
            Some(text) if text == self.poses.text() => {
                self.store.take(store::POSES, text);
                return Ok(false);
            }
            Some(text) => {
                self.poses.replace(&text).map_err(|error| self.store.placed(store::POSES, &error))?;
                self.store.take(store::POSES, text);
            }
            // Without a file of its own a face has the usual poses.
            None => {
                self.store.take(store::POSES, String::new());
                let usual = self.files.usual_poses(self.pack.controls())?;
                if usual == *self.pack.poses() {
                    return Ok(false);
                }
                self.poses = PoseBook::of_set(&usual, self.pack.controls())?;
            }
        }
        self.order.forget(Book::Poses);
        self.pack.set_poses(self.poses.poses().clone())?;
        self.active_pose = None;
        Ok(true)
    }

    /// Reads the clips again, unless there are changes that are not saved.
    ///
    /// # Errors
    /// The first mistake in them, or that there are such changes; the old ones stay.
    pub(super) fn reload_clips(&mut self) -> Result<bool> {
        let text = self.store.read(store::CLIPS)?.unwrap_or_default();
        if text == self.store.text(store::CLIPS) {
            return Ok(false);
        }
        if text == self.clips.text() {
            self.store.take(store::CLIPS, text);
            return Ok(false);
        }
        let mut read = self.clips.clone();
        read.replace(&text).map_err(|error| self.store.placed(store::CLIPS, &error))?;
        if self.has_unsaved_clips() {
            self.store.tell(store::CLIPS, text);
            let found = "expected to be the only one who changes it, found changes by somebody else, while yours are not \
                saved: save the clips to replace theirs, or undo yours to get theirs";
            return Err(self.store.placed(store::CLIPS, &found));
        }
        self.clips = read;
        self.store.take(store::CLIPS, text);
        self.order.forget(Book::Clips);
        self.clips_changed()?;
        self.forget_playback();
        Ok(true)
    }
}
