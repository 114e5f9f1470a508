//! What the user wants, by key, by pointer or by panel, is carried out.

use super::App;
use super::action::Action;
use super::camera::{CameraMove, Place};
use super::messages::About;
use super::talking::Script;
use crate::speech::Line;
use anyhow::Result;
use avatar_panel::{Action as Panel, Edit};
use winit::event_loop::ActiveEventLoop;

impl App {
    /// Carries out an action of the user. A failure is shown as a message, and the window goes on.
    pub(super) fn act(&mut self, event_loop: &ActiveEventLoop, action: Action) {
        self.catch_up();
        match action {
            Action::Panel(wanted) => self.act_on_panel(event_loop, wanted),
            Action::Camera(moved) => self.presenter.camera.apply(moved),
            Action::PressPose(pose) => {
                self.interrupt();
                self.session.face.go_to(self.session.books.poses(), pose);
            }
            Action::PressClip(clip) => {
                self.interrupt();
                self.play(clip);
            }
            Action::PlayOrPause => self.act_on_panel(event_loop, self.play_or_pause()),
            Action::Record => {
                let wanted = match self.session.face.recorded_secs() {
                    Some(_) => Panel::Edit(Edit::StopRecording),
                    None => Panel::StartRecording,
                };
                self.act_on_panel(event_loop, wanted);
            }
            Action::Help => {
                // The panel takes its usual keys for this itself.
                if let Some(overlay) = &mut self.presenter.overlay {
                    overlay.panel.toggle_help();
                }
            }
            Action::FoldPanel => {
                if let Some(overlay) = &mut self.presenter.overlay {
                    overlay.panel.toggle_folded();
                }
            }
        }
        self.presenter.redraw();
    }

    fn act_on_panel(&mut self, event_loop: &ActiveEventLoop, action: Panel) {
        let face = &mut self.session.face;
        match action {
            Panel::SetControl { .. } if self.input.is_interrupted() => {}
            Panel::SetControl { control, value, .. } => face.set_control(control, value),
            Panel::ResetControl(control) => face.reset_control(control),
            Panel::ResetAll => face.defaults(),
            Panel::Hover(control) => self.presenter.pointing.hovered = control,
            Panel::GoTo(pose) => face.go_to(self.session.books.poses(), pose),
            Panel::Edit(edit) => {
                let (about, done) = self.session.edit(edit, &self.proxy);
                self.messages.report(about, "The change was not made.", done);
            }
            Panel::Play(clip) => self.play(clip),
            Panel::PlayFileClip(clip) => {
                let done = face.play_file_clip(clip);
                self.messages.report(About::Clips, "The clip does not play.", done);
            }
            Panel::LeaveFileClip => face.leave_file_clip(),
            Panel::Pause => face.pause(),
            Panel::Stop => {
                face.pause();
                if let Some(clip) = face.playback.clip {
                    self.session.scrub(clip, 0.0);
                }
            }
            Panel::Scrub { clip, time_secs } => self.session.scrub(clip, time_secs),
            Panel::StartRecording => {
                let done = face.start_recording();
                self.messages.report(About::Clips, "Nothing is recorded.", done);
            }
            Panel::OpenSpeech => super::loading::ask_for_speech(&Script::endings(), self.proxy.clone()),
            Panel::Speak => self.speak(),
            Panel::StopSpeaking => self.stop_speaking(),
            Panel::Say { text, voice } => self.say(text, voice),
            Panel::Microphone => self.toggle_microphone(),
            Panel::FilmSpeech(format) => self.film_speech(format),
            Panel::SpeechAmount(amount) => self.set_speech_amount(amount),
            Panel::Live(wish) => self.wish(wish),
            Panel::Life => self.presenter.toggle_life(face),
            Panel::Gaze => self.presenter.toggle_gaze(face),
            Panel::Hair { backward } => self.next_hair(backward),
            Panel::OpenFile => super::loading::ask(self.proxy.clone()),
            Panel::OpenRecent(index) => {
                if let Some(path) = self.config.recent.get(index).cloned() {
                    self.open(&path);
                }
            }
            Panel::Dismiss(message) => self.messages.dismiss(message),
            Panel::Picture => match self.presenter.save_picture(&mut self.session) {
                Ok(path) => self.messages.news(About::Picture, format!("Saved {}.", path.display()), ""),
                Err(error) => self.messages.error(About::Picture, "The picture was not saved.", &error),
            },
            Panel::Film { format, clip } => self.film(format, clip, None),
            Panel::StopFilm => self.session.stop_film(),
            Panel::Camera(place) => {
                if let Some(place) = Place::ALL.get(place) {
                    self.presenter.camera.apply(CameraMove::Go(*place));
                }
            }
            Panel::FullScreen => self.presenter.toggle_full_screen(),
            // The panel has told egui, which draws anew; the background follows with the next frame.
            Panel::Theme(_) | Panel::TextScale(_) => {}
            Panel::Remember => self.remember(),
            Panel::Quit => self.close(event_loop),
        }
    }

    /// What the key for playing means now.
    fn play_or_pause(&self) -> Panel {
        let face = &self.session.face;
        let motion = face.motion.as_ref().filter(|motion| motion.is_wanted());
        let plays = face.is_playing() || motion.is_some_and(|motion| motion.playing);
        let of_file = motion.map(|motion| motion.clip);
        match of_file.or(self.session.books.clips().is_empty().then_some(0)) {
            _ if plays => Panel::Pause,
            Some(clip) => Panel::PlayFileClip(clip),
            None => Panel::Play(face.playback.clip.unwrap_or(0)),
        }
    }

    fn play(&mut self, clip: usize) {
        let done: Result<()> = self.session.play(clip);
        self.messages.report(About::Clips, "The clip does not play.", done);
    }

    /// A slider that is held lets go of the face: the key is the newer wish.
    fn interrupt(&mut self) {
        let overlay = self.presenter.overlay.as_ref();
        if overlay.is_some_and(|overlay| overlay.ctx.egui_is_using_pointer()) {
            self.input.interrupt();
        }
    }

    /// Begins a film of a clip, of something that is said and the beginning of its name, or of the present
    /// face from all around.
    pub(super) fn film(&mut self, format: usize, clip: Option<usize>, said: Option<(Line, String)>) {
        if self.session.filming.is_some() {
            return;
        }
        match self.presenter.film(&self.session, format, (clip, said), self.proxy.clone()) {
            Ok(filming) => {
                self.messages.settle(About::Film);
                self.session.filming = Some(filming);
            }
            Err(error) => self.messages.error(About::Film, "The film was not begun.", &error),
        }
    }

    /// Takes over how far the film is.
    pub(super) fn take_film(&mut self) {
        let Some(filming) = &mut self.session.filming else { return };
        self.presenter.frames.soon();
        let Some(result) = filming.take() else { return };
        let (path, stopped) = (filming.path().to_owned(), filming.is_stopped());
        self.session.filming = None;
        match result {
            Ok(()) => self.messages.news(About::Film, format!("Saved {}.", path.display()), ""),
            Err(_) if stopped => self.messages.news(About::Film, "The film was stopped.", ""),
            Err(error) => self.messages.error(About::Film, "The film was not made.", &error),
        }
    }
}
