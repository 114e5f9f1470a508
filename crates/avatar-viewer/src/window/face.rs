use crate::face_args::FaceChoice;
use crate::files::Files;
use crate::store::{self, Store};
use anyhow::Result;
use avatar_pack::{FaceState, Pack, Textures, load_poses};
use pose_anim::{Clip, Key, Player, Pose, Track};
use pose_book::{BookError, ClipBook, PoseBook};
use std::sync::Arc;

/// Seconds in which a face follows a slider.
const SLIDER_SECS: f32 = 0.12;
/// Seconds in which a face follows the playhead that is dragged.
const SCRUB_SECS: f32 = 0.08;
/// A recording is reduced to keys that stray by at most this share of a control's range.
const RECORDED_TOLERANCE: f64 = 0.005;
/// A recording takes the face's values this often.
const RECORDED_PER_SEC: f64 = 60.0;
/// Longer recordings end by themselves.
const LONGEST_RECORDING_SECS: f64 = 600.0;

/// An avatar and what it does: where its controls are, where they are heading, what plays, and its poses and clips.
pub(super) struct Face {
    pub(super) files: Files,
    pub(super) pack: Pack,
    pub(super) textures: Textures,
    pub(super) player: Player,
    pub(super) state: FaceState,
    /// The face of the command line, with its single joints; until something else is asked for.
    start: Option<FaceChoice>,
    /// Where every control is heading: what sliders show.
    pub(super) goal: Vec<f32>,
    /// The pose that was asked for last, if nothing else was since.
    pub(super) active_pose: Option<usize>,
    pub(super) poses: PoseBook,
    pub(super) clips: ClipBook,
    pub(super) store: Store,
    pub(super) playback: Playback,
    recording: Option<Recording>,
    /// Which book was changed last, for undo.
    last: Book,
}

/// What plays.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Playback {
    pub(super) clip: Option<usize>,
    /// Seconds from its start.
    pub(super) time_secs: f64,
    pub(super) playing: bool,
}

struct Recording {
    secs: f64,
    /// Values of all controls, one row per sample.
    samples: Vec<Vec<f32>>,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Book {
    Poses,
    Clips,
}

impl Face {
    pub(super) fn new(
        files: Files,
        pack: Pack,
        textures: Textures,
        start: Option<FaceChoice>,
    ) -> Result<Self> {
        let mut player = Player::new(&pack.controls);
        let goal = start.as_ref().map_or_else(|| pack.controls.defaults(), FaceChoice::start_values);
        player.jump_to(&goal)?;
        let store = Store::of(&files);
        let poses = PoseBook::of_set(&pack.poses, &pack.controls)?;
        let clips = ClipBook::of_set(&pack.clips, &pack.controls)?;
        let mut face = Self {
            player,
            state: FaceState::new(&pack),
            start,
            goal,
            active_pose: None,
            poses,
            clips,
            store,
            playback: Playback::default(),
            recording: None,
            last: Book::Poses,
            files,
            pack,
            textures,
        };
        // The texts with their comments; the pack holds what they mean.
        if let Some(text) = face.store.read(store::POSES)? {
            face.poses.replace(&text)?;
        }
        if let Some(text) = face.store.read(store::CLIPS)? {
            face.clips.replace(&text)?;
        }
        Ok(face)
    }

    /// Lets time pass.
    pub(super) fn advance(&mut self, secs: f64) {
        // Elapsed times are neither negative nor NaN, the only errors there are.
        let _ = self.player.advance(secs);
        if self.playback.playing {
            self.playback.time_secs += secs;
            self.goal.copy_from_slice(self.player.values());
            let clip = self.playback.clip.and_then(|index| self.clips.clips().clips.get(index));
            match clip {
                Some(clip) if clip.wrap == pose_anim::Wrap::Once => {
                    self.playback.playing = self.playback.time_secs < clip.duration_secs();
                    self.playback.time_secs = self.playback.time_secs.min(clip.duration_secs());
                }
                Some(clip) if clip.duration_secs() > 0.0 => {
                    // There and back is twice the way; the ruler shows one.
                    let period_secs = match clip.wrap {
                        pose_anim::Wrap::PingPong => 2.0 * clip.duration_secs(),
                        _ => clip.duration_secs(),
                    };
                    self.playback.time_secs = self.playback.time_secs.rem_euclid(period_secs);
                }
                _ => self.playback.playing = false,
            }
        }
        if let Some(recording) = &mut self.recording {
            recording.secs += secs;
            let due = (recording.secs * RECORDED_PER_SEC) as usize;
            // A slow machine gives fewer values; what is between is a straight line then.
            while recording.samples.len() <= due {
                recording.samples.push(self.player.values().to_vec());
            }
        }
    }

    /// Whether frames have to follow each other.
    pub(super) fn moves(&self) -> bool {
        !self.player.is_at_rest() || self.playback.playing || self.recording.is_some()
    }

    /// Brings the state to the present values.
    pub(super) fn pose(&mut self) -> Result<()> {
        match &self.start {
            Some(start) => start.apply(&self.pack, &mut self.state),
            None => Ok(self.state.pose(&self.pack, self.player.values())?),
        }
    }

    /// Goes to a pose.
    pub(super) fn press(&mut self, pose: &Pose) {
        self.start = None;
        self.playback.playing = false;
        self.active_pose = None;
        for &(control, value) in &pose.values {
            if let (Some(goal), Some(control)) =
                (self.goal.get_mut(control), self.pack.controls.controls().get(control))
            {
                *goal = value.clamp(control.min, control.max);
            }
        }
        self.player.press(pose);
    }

    /// Takes single controls to values that somebody else finds out again and again; those that are nearly there are left alone.
    pub(super) fn lead(&mut self, values: &[(usize, f32)], secs: f32, off: f32) {
        let is_off = |(control, value): &&(usize, f32)| (self.goal[*control] - value).abs() > off;
        let values: Vec<(usize, f32)> = values.iter().filter(is_off).copied().collect();
        if values.is_empty() {
            return;
        }
        self.start = None;
        self.active_pose = None;
        values.iter().for_each(|(control, value)| self.goal[*control] = *value);
        self.player.press(&Pose::new("led", values).lasting(secs));
    }

    /// Goes to one of the poses.
    pub(super) fn go_to(&mut self, index: usize) {
        if let Some(pose) = self.poses.poses().poses.get(index).cloned() {
            self.press(&pose);
            self.active_pose = Some(index);
        }
    }

    /// Goes to the default face.
    pub(super) fn defaults(&mut self) {
        self.press(&Pose::from_values("defaults", &self.pack.controls.defaults()));
    }

    /// Takes one control to a value, as fast as a hand moves a slider.
    pub(super) fn set_control(&mut self, control: usize, value: f32) {
        self.press(&Pose::new("slider", vec![(control, value)]).lasting(SLIDER_SECS));
    }

    /// Takes one control back to its default.
    pub(super) fn reset_control(&mut self, control: usize) {
        if let Some(value) = self.pack.controls.controls().get(control).map(|control| control.default) {
            self.set_control(control, value);
        }
    }

    /// The pose that the face has or heads for, with all its controls.
    pub(super) fn present(&self, name: &str) -> Pose {
        Pose::from_values(name, &self.goal)
    }

    // Poses and clips.

    /// Changes the poses, and their file.
    pub(super) fn edit_poses(
        &mut self,
        edit: impl FnOnce(&mut PoseBook, &Pose) -> Result<(), BookError>,
    ) -> Result<()> {
        let present = self.present("");
        let before = self.poses.clone();
        edit(&mut self.poses, &present)?;
        self.last = Book::Poses;
        if let Err(error) = self.store.write(store::POSES, self.poses.text()) {
            self.poses = before;
            return Err(error);
        }
        self.pack.poses = self.poses.poses().clone();
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
        self.last = Book::Clips;
        self.clips_changed();
        // What is shown follows what is edited.
        if !self.playback.playing && self.playback.clip == Some(index) {
            self.scrub(index, self.playback.time_secs);
        }
        Ok(())
    }

    /// A new clip: the present face, held for a second.
    pub(super) fn new_clip(&mut self) -> Result<()> {
        let name = self.free_name("clip");
        let clip = Clip::new(name, Vec::new())?;
        self.add_clip(&clip)
    }

    fn add_clip(&mut self, clip: &Clip) -> Result<()> {
        let index = self.clips.add(clip)?;
        self.last = Book::Clips;
        self.clips_changed();
        self.playback = Playback { clip: Some(index), ..Playback::default() };
        Ok(())
    }

    pub(super) fn delete_clip(&mut self, index: usize) -> Result<()> {
        self.clips.remove(index)?;
        self.last = Book::Clips;
        self.clips_changed();
        self.playback = Playback::default();
        Ok(())
    }

    fn clips_changed(&mut self) {
        self.pack.clips = self.clips.clips().clone();
    }

    /// Whether the clips' file says something else.
    pub(super) fn has_unsaved_clips(&self) -> bool {
        self.clips.text() != self.store.text(store::CLIPS)
    }

    pub(super) fn save_clips(&mut self) -> Result<()> {
        self.store.write(store::CLIPS, self.clips.text())
    }

    fn free_name(&self, stem: &str) -> String {
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

    /// What an undo takes back, or a redo does again: of the book that was changed last.
    pub(super) fn can_undo(&self, again: bool) -> Option<&str> {
        match (self.last, again) {
            (Book::Poses, false) => self.poses.can_undo(),
            (Book::Poses, true) => self.poses.can_redo(),
            (Book::Clips, false) => self.clips.can_undo(),
            (Book::Clips, true) => self.clips.can_redo(),
        }
    }

    pub(super) fn undo(&mut self, again: bool) -> Result<()> {
        match (self.last, again) {
            (Book::Poses, _) => self.edit_poses(|book, _| {
                let _ = if again { book.redo() } else { book.undo() };
                Ok(())
            }),
            (Book::Clips, _) => {
                let _ = if again { self.clips.redo() } else { self.clips.undo() };
                self.clips_changed();
                let clips = self.clips.clips().clips.len();
                self.playback.clip = self.playback.clip.filter(|index| *index < clips);
                Ok(())
            }
        }
    }

    /// Reads the poses again, which somebody else may have written.
    ///
    /// # Errors
    /// The first mistake in them; the old ones stay.
    pub(super) fn reload_poses(&mut self) -> Result<bool> {
        match self.store.read(store::POSES)? {
            Some(text) if text == self.poses.text() => return Ok(false),
            Some(text) => {
                self.poses.replace(&text).map_err(|error| self.store.placed(store::POSES, &error))?;
            }
            // Without a file of its own a face has the usual poses.
            None => {
                let usual = load_poses(&self.files, &self.pack.controls)?;
                if usual == self.pack.poses {
                    return Ok(false);
                }
                self.poses = PoseBook::of_set(&usual, &self.pack.controls)?;
            }
        }
        self.pack.poses = self.poses.poses().clone();
        self.active_pose = None;
        Ok(true)
    }

    /// Reads the clips again, unless there are changes that are not saved.
    ///
    /// # Errors
    /// The first mistake in them; the old ones stay.
    pub(super) fn reload_clips(&mut self) -> Result<bool> {
        let unsaved = self.has_unsaved_clips();
        let text = self.store.read(store::CLIPS)?.unwrap_or_default();
        if unsaved || text == self.clips.text() {
            return Ok(false);
        }
        self.clips.replace(&text).map_err(|error| self.store.placed(store::CLIPS, &error))?;
        self.clips_changed();
        self.playback = Playback::default();
        Ok(true)
    }

    // Playing and recording.

    /// Plays a clip from where the playhead stands, or from its start.
    pub(super) fn play(&mut self, index: usize) -> Result<()> {
        let Some(clip) = self.clips.clips().clips.get(index) else { return Ok(()) };
        let ended = clip.wrap == pose_anim::Wrap::Once && self.playback.time_secs >= clip.duration_secs();
        let from_secs = match self.playback.clip == Some(index) && !ended {
            true => self.playback.time_secs,
            false => 0.0,
        };
        let rest = clip.starting_at(from_secs)?;
        // Where the face is at the clip's place already, it need not be led there.
        let is_there = rest.tracks().iter().all(|track| {
            let here = self.player.values().get(track.control()).copied().unwrap_or_default();
            (f64::from(here) - track.at(0.0).value).abs() < 1e-3
        });
        self.start = None;
        self.active_pose = None;
        self.player.play(&Arc::new(rest), is_there.then_some(0.0));
        self.playback = Playback { clip: Some(index), time_secs: from_secs, playing: true };
        Ok(())
    }

    /// Halts what plays.
    pub(super) fn pause(&mut self) {
        if self.playback.playing {
            self.playback.playing = false;
            self.player.stop();
            self.goal.copy_from_slice(self.player.values());
        }
    }

    /// Shows a clip at a time.
    pub(super) fn scrub(&mut self, index: usize, time_secs: f64) {
        let Some(clip) = self.clips.clips().clips.get(index) else { return };
        let values = clip.tracks().iter().map(|track| (track.control(), track.at(time_secs).value as f32));
        let pose = Pose::new("playhead", values.collect()).lasting(SCRUB_SECS);
        self.press(&pose);
        self.playback = Playback { clip: Some(index), time_secs, playing: false };
    }

    pub(super) fn recorded_secs(&self) -> Option<f64> {
        Some(self.recording.as_ref()?.secs)
    }

    pub(super) fn start_recording(&mut self) {
        self.recording = Some(Recording { secs: 0.0, samples: vec![self.player.values().to_vec()] });
    }

    /// Whether a recording has become too long.
    pub(super) fn recording_is_full(&self) -> bool {
        self.recording.as_ref().is_some_and(|recording| recording.secs > LONGEST_RECORDING_SECS)
    }

    /// Makes a clip of what was recorded: of those controls that moved, with as few keys as say it.
    pub(super) fn stop_recording(&mut self) -> Result<()> {
        let Some(Recording { samples, .. }) = self.recording.take() else { return Ok(()) };
        let controls = self.pack.controls.controls();
        let moved = |control: &usize| samples.iter().any(|row| row[*control] != samples[0][*control]);
        let tracks = (0..controls.len()).filter(moved).map(|control| {
            let sample =
                |(k, row): (usize, &Vec<f32>)| (k as f64 / RECORDED_PER_SEC, f64::from(row[control]));
            Track::from_samples(control, samples.iter().enumerate().map(sample))
        });
        let tracks = tracks.collect::<Result<Vec<_>, _>>()?;
        if tracks.is_empty() {
            anyhow::bail!("expected a face that moves while it is recorded, found one at rest");
        }
        let range = |control: usize| f64::from(controls[control].max - controls[control].min);
        let (mut clip, _) = Clip::new(self.free_name("recording"), tracks)?
            .reduced(|control| range(control) * RECORDED_TOLERANCE)?;
        // A cubic may swing a little beyond its keys, and a file takes no key beyond its control's range.
        for control in 0..controls.len() {
            let Some(track) = clip.track_mut(control) else { continue };
            let (min, max) = (f64::from(controls[control].min), f64::from(controls[control].max));
            for index in 0..track.keys().len() {
                let key = track.keys()[index];
                if key.value.clamp(min, max) != key.value {
                    track.move_key(index, key.time_secs, key.value.clamp(min, max))?;
                }
            }
        }
        self.add_clip(&clip)
    }
}
