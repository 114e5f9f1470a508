//! A face's poses and clips: the only place where they are. They are edited in their texts, which can be
//! undone, and for poses in their file at once.

use crate::files::Files;
use crate::store::{self, Store};
use anyhow::Result;
use avatar_pack::Pack;
use pose_anim::{Clip, ControlTable, Easing, Key, PoseSet, Track};
use pose_book::{BookError, ClipBook, PoseBook};
use std::path::Path;

/// Which text an edit is in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Book {
    Poses,
    Clips,
}

/// In which order texts were edited: each knows only its own edits.
#[derive(Clone, Debug, Default)]
struct Order {
    done: Vec<Book>,
    undone: Vec<Book>,
}

impl Order {
    fn note(&mut self, book: Book) {
        self.done.push(book);
        self.undone.clear();
    }

    /// Forgets the edits of a text that was read again.
    fn forget(&mut self, book: Book) {
        self.done.retain(|other| *other != book);
        self.undone.retain(|other| *other != book);
    }
}

/// The texts of poses and clips, what they mean, and the files that they are kept in.
pub(super) struct Books {
    poses: PoseBook,
    clips: ClipBook,
    store: Store,
    order: Order,
}

impl Books {
    /// Takes poses and clips over from a pack, with the comments of their files.
    pub(super) fn open(files: &Files, pack: &Pack) -> Result<Self> {
        let mut books = Self {
            poses: PoseBook::of_set(pack.poses(), pack.controls())?,
            clips: ClipBook::of_set(pack.clips(), pack.controls())?,
            store: files.store(),
            order: Order::default(),
        };
        // Mistakes in the files are not reported here, but when the window starts to follow the files.
        let Self { poses, clips, store, .. } = &mut books;
        if let Ok(Some(text)) = store.read(store::POSES)
            && poses.replace(&text).is_ok()
        {
            store.take(store::POSES, text);
        }
        if let Ok(Some(text)) = store.read(store::CLIPS)
            && clips.replace(&text).is_ok()
        {
            store.take(store::CLIPS, text);
        }
        Ok(books)
    }

    pub(super) fn poses(&self) -> &PoseSet {
        self.poses.poses()
    }

    pub(super) fn clips(&self) -> &[Clip] {
        &self.clips.clips().clips
    }

    pub(super) fn clip(&self, index: usize) -> Option<&Clip> {
        self.clips().get(index)
    }

    /// The files that hold them.
    pub(super) fn store(&self) -> &Store {
        &self.store
    }

    /// Whether poses can be kept.
    pub(super) fn can_save_poses(&self) -> bool {
        self.poses_path().is_some()
    }

    fn poses_path(&self) -> Option<&Path> {
        self.store.path(store::POSES)
    }

    /// Changes the poses, and their file.
    pub(super) fn edit_poses(
        &mut self,
        edit: impl FnOnce(&mut PoseBook) -> Result<(), BookError>,
    ) -> Result<()> {
        self.change_poses(edit)?;
        self.order.note(Book::Poses);
        Ok(())
    }

    fn change_poses(&mut self, edit: impl FnOnce(&mut PoseBook) -> Result<(), BookError>) -> Result<()> {
        let before = self.poses.clone();
        edit(&mut self.poses)?;
        if let Err(error) = self.store.write(store::POSES, self.poses.text()) {
            self.poses = before;
            return Err(error);
        }
        Ok(())
    }

    /// Changes a clip; it is written to its file when the user says so. An index out of range changes
    /// nothing.
    pub(super) fn edit_clip(
        &mut self,
        index: usize,
        what: &str,
        edit: impl FnOnce(&mut Clip) -> Result<()>,
    ) -> Result<()> {
        let Some(mut clip) = self.clip(index).cloned() else { return Ok(()) };
        edit(&mut clip)?;
        self.clips.set(index, &clip, what)?;
        self.order.note(Book::Clips);
        Ok(())
    }

    /// Adds a clip after all others, and returns its index.
    pub(super) fn add_clip(&mut self, clip: &Clip) -> Result<usize> {
        let index = self.clips.add(clip)?;
        self.order.note(Book::Clips);
        Ok(index)
    }

    pub(super) fn delete_clip(&mut self, index: usize) -> Result<()> {
        self.clips.remove(index)?;
        self.order.note(Book::Clips);
        Ok(())
    }

    /// Whether the clips' file says something else.
    pub(super) fn has_unsaved_clips(&self) -> bool {
        self.clips.text() != self.store.text(store::CLIPS)
    }

    pub(super) fn save_clips(&mut self) -> Result<()> {
        self.store.write(store::CLIPS, self.clips.text())
    }

    /// A name that no clip has yet.
    pub(super) fn free_name(&self, stem: &str) -> String {
        let clips = self.clips.clips();
        let mut names = std::iter::once(stem.to_owned()).chain((2..).map(|count| format!("{stem} {count}")));
        names.find(|name| clips.get(name).is_none()).unwrap_or_default()
    }

    /// Adds a key to a clip at a time: the in-between, or `present` where the control has no track yet.
    pub(super) fn insert_key(
        &mut self,
        index: usize,
        control: usize,
        time_secs: f64,
        present: f32,
    ) -> Result<()> {
        self.edit_clip(index, "insert a key", |clip| {
            match clip.track_mut(control) {
                Some(track) => {
                    track.bake(time_secs)?;
                }
                None => {
                    let key = Key::new(time_secs, present.into(), Easing::MinimumJerk);
                    let tracks =
                        clip.tracks().iter().cloned().chain([Track::new(control, vec![key])?]).collect();
                    replace_tracks(clip, tracks)?;
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
            replace_tracks(clip, tracks)
        })
    }

    /// What [`Self::undo`] takes back.
    pub(super) fn can_undo(&self) -> Option<&str> {
        self.next_undo().map(|(_, what)| what)
    }

    /// What [`Self::redo`] does again.
    pub(super) fn can_redo(&self) -> Option<&str> {
        self.next_redo().map(|(_, what)| what)
    }

    fn next_undo(&self) -> Option<(usize, &str)> {
        let what = |book: &Book| match book {
            Book::Poses => self.poses.can_undo(),
            Book::Clips => self.clips.can_undo(),
        };
        last(&self.order.done, what)
    }

    fn next_redo(&self) -> Option<(usize, &str)> {
        let what = |book: &Book| match book {
            Book::Poses => self.poses.can_redo(),
            Book::Clips => self.clips.can_redo(),
        };
        last(&self.order.undone, what)
    }

    /// Takes the last edit back; returns which text it was in.
    pub(super) fn undo(&mut self) -> Result<Option<Book>> {
        let Some((place, _)) = self.next_undo() else { return Ok(None) };
        let book = self.order.done[place];
        match book {
            Book::Poses => self.change_poses(|poses| {
                let _ = poses.undo();
                Ok(())
            })?,
            Book::Clips => {
                let _ = self.clips.undo();
            }
        }
        self.order.done.truncate(place);
        self.order.undone.push(book);
        Ok(Some(book))
    }

    /// Does the edit again that was taken back last; returns which text it is in.
    pub(super) fn redo(&mut self) -> Result<Option<Book>> {
        let Some((place, _)) = self.next_redo() else { return Ok(None) };
        let book = self.order.undone[place];
        match book {
            Book::Poses => self.change_poses(|poses| {
                let _ = poses.redo();
                Ok(())
            })?,
            Book::Clips => {
                let _ = self.clips.redo();
            }
        }
        self.order.undone.truncate(place);
        self.order.done.push(book);
        Ok(Some(book))
    }

    /// Reads the poses again, which somebody else may have written; whether they are other ones now.
    ///
    /// # Errors
    /// The first mistake in them; the old ones stay.
    pub(super) fn reload_poses(&mut self, files: &Files, controls: &ControlTable) -> Result<bool> {
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
                let usual = files.usual_poses(controls)?;
                if usual == *self.poses() {
                    return Ok(false);
                }
                self.poses = PoseBook::of_set(&usual, controls)?;
            }
        }
        self.order.forget(Book::Poses);
        Ok(true)
    }

    /// Reads the clips again, unless there are changes that are not saved; whether they are other ones now.
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
        Ok(true)
    }
}

/// The last of these books in which `what` finds an edit to undo or redo, and the name of that edit.
fn last<'a>(books: &[Book], what: impl Fn(&Book) -> Option<&'a str>) -> Option<(usize, &'a str)> {
    books.iter().enumerate().rev().find_map(|(place, book)| Some((place, what(book)?)))
}

/// The same clip with other tracks.
fn replace_tracks(clip: &mut Clip, tracks: Vec<Track>) -> Result<()> {
    let (key, wrap) = (clip.key.take(), clip.wrap);
    *clip = Clip::new(clip.name.clone(), tracks)?.wrapped(wrap);
    clip.key = key;
    Ok(())
}
