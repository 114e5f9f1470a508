//! What the user wants, by key or by panel, is carried out.

use super::App;
use super::camera::Place;
use super::keys::Action as KeyAction;
use super::messages::About;
use super::shot::Shot;
use super::watch::{Watched, watch};
use crate::film;
use crate::output::OutputFile;
use anyhow::Result;
use avatar_panel::{Action, PoseForm};
use pose_anim::{Pose, Transition};
use std::path::PathBuf;
use winit::event_loop::ActiveEventLoop;
use winit::window::Fullscreen;

impl App {
    pub(super) fn act_on_key(&mut self, event_loop: &ActiveEventLoop, action: KeyAction) {
        match action {
            KeyAction::Close => self.close(event_loop),
            KeyAction::Orbit(yaw, pitch) => self.camera.orbit(yaw, pitch),
            KeyAction::Zoom(factor) => self.camera.zoom(factor),
            KeyAction::Pan(right, up) => self.camera.pan(right, up),
            KeyAction::Camera(place) => self.camera.go(place),
            KeyAction::Defaults => {
                self.catch_up();
                self.face.defaults();
            }
            KeyAction::Hair { backward } => self.next_hair(backward),
            KeyAction::Gaze => self.toggle_gaze(),
            KeyAction::Play => {
                let face = &self.face;
                let motion = face.motion.as_ref().filter(|motion| motion.is_wanted());
                let plays = face.playback.playing || motion.is_some_and(|motion| motion.playing);
                let of_file = motion.map(|motion| motion.clip);
                let of_file = of_file.or(face.pack.clips().clips.is_empty().then_some(0));
                let action = match of_file {
                    _ if plays => Action::Pause,
                    Some(clip) => Action::PlayFileClip(clip),
                    None => Action::Play(face.playback.clip.unwrap_or(0)),
                };
                self.act(event_loop, action);
            }
            KeyAction::Record => {
                let is_running = self.face.recorded_secs().is_some();
                self.act(event_loop, if is_running { Action::StopRecording } else { Action::StartRecording });
            }
            KeyAction::Picture => self.act(event_loop, Action::Picture),
            KeyAction::Open => self.act(event_loop, Action::OpenFile),
            KeyAction::Undo { again } => {
                self.act(event_loop, if again { Action::Redo } else { Action::Undo })
            }
            KeyAction::Help => {
                // The panel takes its usual keys for this itself.
                if let Some(overlay) = &mut self.overlay {
                    overlay.panel.toggle_help();
                }
            }
            KeyAction::Panel => {
                if let Some(overlay) = &mut self.overlay {
                    overlay.panel.toggle_folded();
                }
            }
            KeyAction::FullScreen => self.act(event_loop, Action::FullScreen),
        }
        self.redraw();
    }

    pub(super) fn play(&mut self, clip: usize) {
        let done = self.face.play(clip);
        self.report(About::Clips, "The clip does not play.", done);
        self.redraw();
    }

    /// Carries out what the panel says. What fails is told, and everything else goes on.
    pub(super) fn act(&mut self, event_loop: &ActiveEventLoop, action: Action) {
        self.catch_up();
        match action {
            Action::SetControl { .. } if self.interrupted.is_some() => {}
            Action::SetControl { control, value, .. } => self.face.set_control(control, value),
            Action::ResetControl(control) => self.face.reset_control(control),
            Action::ResetAll => self.face.defaults(),
            Action::Hover(control) => self.pointing.hovered = control,
            Action::GoTo(pose) => self.face.go_to(pose),
            Action::Play(clip) => self.play(clip),
            Action::PlayFileClip(clip) => {
                let done = self.face.play_file_clip(clip);
                self.report(About::Clips, "The clip does not play.", done);
            }
            Action::LeaveFileClip => self.face.leave_file_clip(),
            Action::Pause => self.face.pause(),
            Action::Stop => {
                self.face.pause();
                if let Some(clip) = self.face.playback.clip {
                    self.face.scrub(clip, 0.0);
                }
            }
            Action::Scrub { clip, time_secs } => self.face.scrub(clip, time_secs),
            Action::StartRecording => {
                let done = self.face.start_recording();
                self.report(About::Clips, "Nothing is recorded.", done);
            }
            Action::Gaze => self.toggle_gaze(),
            Action::Hair { backward } => self.next_hair(backward),
            Action::OpenFile => super::loading::ask(self.proxy.clone()),
            Action::OpenRecent(index) => {
                if let Some(path) = self.config.recent.get(index).cloned() {
                    self.open(&path);
                }
            }
            Action::Dismiss(message) => self.messages.dismiss(message),
            Action::Picture => self.save_picture(),
            Action::Film { format, clip } => self.film(format, clip),
            Action::StopFilm => self.stop_film(),
            Action::Camera(place) => {
                if let Some(place) = Place::ALL.get(place) {
                    self.camera.go(*place);
                }
            }
            Action::FullScreen => {
                if let Some(stage) = &self.stage {
                    let fills = stage.window().fullscreen().is_some();
                    stage.window().set_fullscreen((!fills).then_some(Fullscreen::Borderless(None)));
                }
            }
            Action::Theme(_) | Action::TextScale(_) => {}
            Action::Remember => self.remember(),
            Action::Quit => self.close(event_loop),
            edit => self.edit(edit),
        }
        self.redraw();
    }

    /// Changes poses or clips.
    fn edit(&mut self, action: Action) {
        let face = &mut self.face;
        let (about, done) = match action {
            Action::SavePose(form) => {
                let done = face.edit_poses(|book, present| book.add(&described(present, &form)).map(|_| ()));
                face.active_pose = done.is_ok().then(|| face.pack.poses().poses.len() - 1);
                (About::Poses, done)
            }
            Action::EditPose { index, form } => {
                let PoseForm { name, key, duration_secs } = form;
                let done =
                    face.edit_poses(|book, _| book.describe(index, &name, key.as_deref(), duration_secs));
                (About::Poses, done)
            }
            Action::UpdatePose(index) => {
                let done = face.edit_poses(|book, present| book.set_values(index, &present.values));
                face.active_pose = Some(index);
                (About::Poses, done)
            }
            Action::MovePose { from, to } => {
                face.active_pose = None;
                (About::Poses, face.edit_poses(|book, _| book.move_to(from, to)))
            }
            Action::DeletePose(index) => {
                face.active_pose = None;
                (About::Poses, face.edit_poses(|book, _| book.remove(index)))
            }
            Action::Undo => (About::Poses, face.undo(false)),
            Action::Redo => (About::Poses, face.undo(true)),
            Action::SetWrap { clip, wrap } => {
                let set = |clip: &mut pose_anim::Clip| {
                    clip.wrap = wrap;
                    Ok(())
                };
                (About::Clips, face.edit_clip(clip, "change the end of the clip", set))
            }
            Action::InsertKey { clip, control, time_secs } => {
                (About::Clips, face.insert_key(clip, control, time_secs))
            }
            Action::MoveKey { clip, control, key, time_secs, value } => {
                let moved = |clip: &mut pose_anim::Clip| {
                    let track = clip.track_mut(control);
                    Ok(track.map_or(Ok(()), |track| track.move_key(key, time_secs, value))?)
                };
                (About::Clips, face.edit_clip(clip, "move a key", moved))
            }
            Action::DeleteKey { clip, control, key } => (About::Clips, face.delete_key(clip, control, key)),
            Action::SetTransition { clip, control, key, easing } => {
                let set = |clip: &mut pose_anim::Clip| {
                    let track = clip.track_mut(control);
                    Ok(track.map_or(Ok(()), |track| track.set_transition(key, Transition::Ease(easing)))?)
                };
                (About::Clips, face.edit_clip(clip, "change a transition", set))
            }
            Action::NewClip => (About::Clips, face.new_clip()),
            Action::DeleteClip(index) => (About::Clips, face.delete_clip(index)),
            Action::StopRecording => (About::Clips, face.stop_recording()),
            Action::SaveClips => (About::Clips, face.save_clips()),
            _ => return,
        };
        self.is_warned = false;
        if self.watching.is_behind() {
            self.watching = watch(&self.face.files, &self.face.store, self.proxy.clone());
        }
        if !self.face.has_unsaved_clips() {
            // What somebody else wrote meanwhile can be taken over now.
            self.reload_soon(Watched::Clips);
        }
        self.report(about, "The change was not made.", done);
    }

    fn report(&mut self, about: About, title: &str, done: Result<()>) {
        match done {
            Ok(()) => self.messages.settle(about),
            Err(error) => self.messages.error(about, title, &error),
        }
    }

    fn save_picture(&mut self) {
        let done = self.try_save_picture();
        match done {
            Ok(path) => self.messages.news(About::Picture, format!("Saved {}.", path.display()), ""),
            Err(error) => self.messages.error(About::Picture, "The picture was not saved.", &error),
        }
    }

    /// The picture as the window shows it, without the panel, in the first free name of the folder that the program was started in.
    fn try_save_picture(&mut self) -> Result<PathBuf> {
        self.face.pose()?;
        let background = self.background();
        let Some(stage) = &mut self.stage else { anyhow::bail!("expected a window, found none") };
        let (width, height) = stage.size();
        let (pack, state) = (&self.face.pack, &self.face.state);
        let shot = Shot { pack, state, view: self.camera.view, background, free: None };
        let picture = stage.picture(&shot, width, height)?;
        let stem = self.face.active_pose.and_then(|pose| pack.poses().poses.get(pose));
        let path = free_name(stem.map_or("face", |pose| pose.name.as_str()), "png")?;
        film::still(&OutputFile::check(&path)?, &picture, &self.face.choice().describe(pack))?;
        Ok(path)
    }
}

/// The present face as a pose with this description.
fn described(present: &Pose, form: &PoseForm) -> Pose {
    let mut pose = present.clone();
    pose.name.clone_from(&form.name);
    pose.key.clone_from(&form.key);
    pose.duration_secs = form.duration_secs;
    pose
}

/// A name in the folder that the program was started in that nothing has yet.
pub(super) fn free_name(stem: &str, ending: &str) -> Result<PathBuf> {
    let stem = stem.replace(['/', '\\', ':'], "-");
    let dot = if ending.is_empty() { "" } else { "." };
    let mut names = (1..=MOST_NAMES).map(|count| PathBuf::from(format!("{stem}-{count}{dot}{ending}")));
    let free = names.find(|path| !path.exists());
    free.ok_or_else(|| anyhow::anyhow!("expected a free name up to {stem}-{MOST_NAMES}, found none"))
}

/// More pictures of one name than these are not looked through.
const MOST_NAMES: u32 = 100_000;
