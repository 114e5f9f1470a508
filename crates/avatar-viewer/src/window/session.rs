use super::books::{Book, Books};
use super::face::{Face, Lively, Playback};
use super::filming::Filming;
use super::loading::{Loaded, Loading};
use super::messages::About;
use super::watch::{Wake, Watched, Watching, watch};
use crate::face_args::FaceChoice;
use crate::files::Files;
use anyhow::Result;
use avatar_pack::Textures;
use avatar_panel::{Edit, PoseForm};
use pose_anim::{Clip, Pose, Transition};
use std::time::{Duration, Instant};
use winit::event_loop::EventLoopProxy;

/// How long a changed file has to be left alone before it is read. A program that saves a file changes it
/// several times. After the first change the file may be empty or missing, and reading it after every change
/// would report one mistake several times.
const SETTLED: Duration = Duration::from_millis(100);

/// The avatar that is shown, where it comes from, and what goes on beside the window.
pub(super) struct Session {
    pub(super) files: Files,
    pub(super) textures: Textures,
    pub(super) face: Face,
    pub(super) books: Books,
    pub(super) loading: Option<Loading>,
    pub(super) filming: Option<Filming>,
    watching: Watching,
    /// When each of the files is read again, unless it changes once more before.
    reload_at: [Option<Instant>; Watched::ALL.len()],
    /// The user was told that clips are not saved.
    pub(super) is_warned: bool,
}

impl Session {
    pub(super) fn new(
        loaded: Loaded,
        start: FaceChoice,
        lively: Lively,
        window: EventLoopProxy<Wake>,
    ) -> Result<Self> {
        let Loaded { files, pack, textures } = loaded;
        let books = Books::open(&files, &pack)?;
        let face = Face::new(pack, start, lively)?;
        Ok(Self {
            // Files are watched until this is dropped.
            watching: watch(&files, books.store(), window),
            files,
            textures,
            face,
            books,
            loading: None,
            filming: None,
            // Nobody told of changes since the avatar was loaded.
            reload_at: [Some(Instant::now() + SETTLED); Watched::ALL.len()],
            is_warned: false,
        })
    }

    /// Title of the window.
    pub(super) fn title(&self) -> String {
        format!("Mimik: {}", self.files.name())
    }

    /// Whether something is lost with this face.
    pub(super) fn has_unsaved(&self) -> bool {
        self.books.has_unsaved_clips() || self.face.recorded_secs().is_some()
    }

    /// Reads a file again once it has been left alone.
    pub(super) fn reload_soon(&mut self, file: Watched) {
        for (watched, at) in Watched::ALL.iter().zip(&mut self.reload_at) {
            if *watched == file {
                *at = Some(Instant::now() + SETTLED);
            }
        }
    }

    /// When the next file is to be read again.
    pub(super) fn next_reload(&self) -> Option<Instant> {
        self.reload_at.iter().flatten().min().copied()
    }

    /// A file that has been left alone since it changed, if there is one; it is not told of a second time.
    pub(super) fn settled(&mut self) -> Option<Watched> {
        let now = Instant::now();
        let mut all = Watched::ALL.into_iter().zip(&mut self.reload_at);
        all.find_map(|(file, at)| at.take_if(|at| *at <= now).map(|_| file))
    }

    /// Reads the poses again.
    pub(super) fn reload_poses(&mut self) -> Result<()> {
        if self.books.reload_poses(&self.files, self.face.performer.pack().controls())? {
            self.face.active_pose = None;
        }
        Ok(())
    }

    /// Reads the clips again.
    pub(super) fn reload_clips(&mut self) -> Result<()> {
        if self.books.reload_clips()? {
            self.face.forget_playback();
        }
        Ok(())
    }

    /// Plays a clip by its index; one that is not there changes nothing.
    pub(super) fn play(&mut self, index: usize) -> Result<()> {
        self.books.clip(index).map_or(Ok(()), |clip| self.face.play(index, clip))
    }

    /// Shows a clip at a time; one that is not there changes nothing.
    pub(super) fn scrub(&mut self, index: usize, time_secs: f64) {
        if let Some(clip) = self.books.clip(index) {
            self.face.scrub(index, clip, time_secs);
        }
    }

    pub(super) fn stop_film(&self) {
        if let Some(filming) = &self.filming {
            filming.stop();
        }
    }

    /// Changes poses or clips; returns which of them.
    pub(super) fn edit(&mut self, edit: Edit, window: &EventLoopProxy<Wake>) -> (About, Result<()>) {
        let done = match edit {
            Edit::SavePose(form) => (About::Poses, self.save_pose(&form)),
            Edit::EditPose { index, form } => {
                let PoseForm { name, key, duration_secs } = form;
                let described = |book: &mut pose_book::PoseBook| {
                    book.describe(index, &name, key.as_deref(), duration_secs)
                };
                (About::Poses, self.books.edit_poses(described))
            }
            Edit::UpdatePose(index) => {
                let present = self.face.present("");
                self.face.active_pose = Some(index);
                (About::Poses, self.books.edit_poses(|book| book.set_values(index, &present.values)))
            }
            Edit::MovePose { from, to } => {
                self.face.active_pose = None;
                (About::Poses, self.books.edit_poses(|book| book.move_to(from, to)))
            }
            Edit::DeletePose(index) => {
                self.face.active_pose = None;
                (About::Poses, self.books.edit_poses(|book| book.remove(index)))
            }
            Edit::Undo => (About::Poses, self.books.undo().map(|book| self.follow_edit(book))),
            Edit::Redo => (About::Poses, self.books.redo().map(|book| self.follow_edit(book))),
            Edit::SetWrap { clip, wrap } => {
                let set = |clip: &mut Clip| {
                    clip.wrap = wrap;
                    Ok(())
                };
                (About::Clips, self.edit_clip(clip, "change the end of the clip", set))
            }
            Edit::InsertKey { clip, control, time_secs } => {
                let present = self.face.performer.targets().nth(control).unwrap_or_default();
                let done = self.books.insert_key(clip, control, time_secs, present);
                (About::Clips, done.map(|()| self.show_edited(clip)))
            }
            Edit::MoveKey { clip, control, key, time_secs, value } => {
                let moved = |clip: &mut Clip| {
                    let track = clip.track_mut(control);
                    Ok(track.map_or(Ok(()), |track| track.move_key(key, time_secs, value))?)
                };
                (About::Clips, self.edit_clip(clip, "move a key", moved))
            }
            Edit::DeleteKey { clip, control, key } => {
                let done = self.books.delete_key(clip, control, key);
                (About::Clips, done.map(|()| self.show_edited(clip)))
            }
            Edit::SetTransition { clip, control, key, easing } => {
                let set = |clip: &mut Clip| {
                    let track = clip.track_mut(control);
                    Ok(track.map_or(Ok(()), |track| track.set_transition(key, Transition::Ease(easing)))?)
                };
                (About::Clips, self.edit_clip(clip, "change a transition", set))
            }
            Edit::NewClip => (About::Clips, self.new_clip()),
            Edit::DeleteClip(index) => {
                let done = self.books.delete_clip(index);
                (About::Clips, done.map(|()| self.face.forget_playback()))
            }
            Edit::StopRecording => (About::Clips, self.stop_recording()),
            Edit::SaveClips => (About::Clips, self.books.save_clips()),
        };
        self.is_warned = false;
        if self.watching.is_behind() {
            self.watching = watch(&self.files, self.books.store(), window.clone());
        }
        if !self.books.has_unsaved_clips() {
            // What somebody else wrote meanwhile can be taken over now.
            self.reload_soon(Watched::Clips);
        }
        done
    }

    /// Makes a pose of the present face, after all others.
    fn save_pose(&mut self, form: &PoseForm) -> Result<()> {
        let pose = described(self.face.present(""), form);
        self.face.active_pose = None;
        self.books.edit_poses(|book| book.add(&pose).map(|_| ()))?;
        self.face.active_pose = Some(self.books.poses().poses.len() - 1);
        Ok(())
    }

    fn edit_clip(
        &mut self,
        index: usize,
        what: &str,
        edit: impl FnOnce(&mut Clip) -> Result<()>,
    ) -> Result<()> {
        self.books.edit_clip(index, what, edit)?;
        self.show_edited(index);
        Ok(())
    }

    /// Shows an edited clip again at the playhead.
    fn show_edited(&mut self, index: usize) {
        if !self.face.is_playing() && self.face.playback.clip == Some(index) {
            self.scrub(index, self.face.playhead_secs());
        }
    }

    /// A new clip, without keys yet.
    fn new_clip(&mut self) -> Result<()> {
        let clip = Clip::new(self.books.free_name("clip"), Vec::new())?;
        self.add_clip(&clip)
    }

    fn stop_recording(&mut self) -> Result<()> {
        match self.face.stop_recording(self.books.free_name("recording"))? {
            Some(clip) => self.add_clip(&clip),
            None => Ok(()),
        }
    }

    /// Adds a clip and chooses it.
    fn add_clip(&mut self, clip: &Clip) -> Result<()> {
        let index = self.books.add_clip(clip)?;
        self.face.forget_playback();
        self.face.playback = Playback::at(index, 0.0);
        Ok(())
    }

    /// An edit was taken back or done again.
    fn follow_edit(&mut self, book: Option<Book>) {
        match book {
            Some(Book::Poses) => self.face.active_pose = None,
            Some(Book::Clips) => match self.face.playback.clip {
                Some(index) if index >= self.books.clips().len() => self.face.forget_playback(),
                _ => self.face.pause(),
            },
            None => {}
        }
    }
}

/// The present face as a pose with this description.
fn described(present: Pose, form: &PoseForm) -> Pose {
    let mut pose = present;
    pose.name.clone_from(&form.name);
    pose.key.clone_from(&form.key);
    pose.duration_secs = form.duration_secs;
    pose
}
