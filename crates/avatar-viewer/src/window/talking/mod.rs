//! What the face says in the window, and what is heard with it.

mod script;
mod microphone;
mod playing;

use super::App;
use super::face::Face;
use super::messages::About;
use super::watch::Wake;
use crate::sound::MISSING;
use anyhow::Result;
use avatar_panel::Speaking;
use avatar_speech::{Amounts, Means};
use avatar_stage::Performer;
use microphone::Listening;
use playing::Playing;
pub(super) use script::Script;
use script::Source;
use std::path::Path;
use std::sync::mpsc::{Receiver, TryRecvError, channel};
use winit::event_loop::EventLoopProxy;

/// Seconds before the first sound in which the mouth gets ready.
const READY_SECS: f64 = 0.25;

/// What the face says, and how much of it is seen.
#[derive(Default)]
pub(super) struct Talking {
    script: Option<Script>,
    /// Something to say that is read, and what comes of it.
    coming: Option<Coming>,
    /// Plays the sound of the script.
    playing: Option<Playing>,
    /// Why it is not played, as far as that was tried.
    silent: Option<String>,
    listening: Option<Listening>,
    /// Up to when microphones have been heard.
    heard_secs: f64,
    amount: Option<f32>,
}

struct Coming {
    /// For people.
    name: String,
    script: Receiver<Result<Script>>,
}

impl Talking {
    /// Reads beside the running picture.
    fn read(&mut self, source: Source, window: EventLoopProxy<Wake>) {
        let name = source.name();
        let (sender, script) = channel();
        std::thread::spawn(move || {
            // Whoever listened may have turned to something else.
            let _ = sender.send(Script::read(&source));
            let _ = window.send_event(Wake::Ready);
        });
        self.coming = Some(Coming { name, script });
    }

    /// What has been read and its name, or why nothing was, once that is known.
    fn take(&mut self) -> Option<(String, Result<Script>)> {
        let coming = self.coming.as_ref()?;
        let read = match coming.script.try_recv() {
            Ok(read) => read,
            Err(TryRecvError::Empty) => return None,
            Err(TryRecvError::Disconnected) => {
                let error = "expected something to speak, found what ended its reader";
                Err(anyhow::anyhow!("{}: {error}", coming.name))
            }
        };
        self.coming.take().map(|coming| (coming.name, read))
    }

    /// Name of what is read.
    pub(super) fn reading(&self) -> Option<&str> {
        self.coming.as_ref().map(|coming| coming.name.as_str())
    }

    /// What the panel shows of it.
    pub(super) fn shown(&self, face: &Face) -> Speaking<'_> {
        let performer = &face.performer;
        let script = self.script.as_ref();
        let sound = script.and_then(|script| script.sound.as_ref());
        Speaking {
            file: script.map(|script| script.name.as_str()),
            sound: sound.map(|_| self.silent.as_deref().map_or(Ok(()), Err)),
            time_secs: performer.speech_secs().unwrap_or(0.0),
            duration_secs: script.map_or(0.0, Script::end_secs),
            is_speaking: performer.speech_secs().is_some()
                || self.playing.as_ref().is_some_and(|playing| !playing.is_over()),
            amount: performer.speech_amounts().mouth,
            microphone: MISSING.map_or(Ok(self.listening.is_some()), Err),
            heard: self.listening.as_ref().map_or(0.0, Listening::loudness),
            cannot: (performer.speech_means() == Means::Nothing)
                .then_some("This face has no jaw and no shapes of a mouth: it cannot speak."),
        }
    }

    /// Whether a microphone is open.
    pub(super) fn listens(&self) -> bool {
        self.listening.is_some()
    }

    /// Keeps mouth and sound together, and lets the face say what the microphone has heard. Returns whether
    /// sound has to be looked after, whatever the face does.
    pub(super) fn go_on(&mut self, performer: &mut Performer) -> bool {
        if let Some(listening) = &mut self.listening {
            listening.hear(performer);
            self.heard_secs = listening.latest_secs();
        }
        if let (Some(script), Some(playing)) = (&self.script, &mut self.playing) {
            match playing.keep_together(script, performer) {
                Ok(true) => {}
                Ok(false) => self.playing = None,
                Err(error) => {
                    self.playing = None;
                    self.silent = Some(error.to_string());
                }
            }
        }
        self.playing.is_some() || self.listening.is_some()
    }
}

impl App {
    /// Reads a file to speak by.
    pub(super) fn open_speech(&mut self, path: &Path) {
        self.talking.read(Source::File(path.to_owned()), self.proxy.clone());
        self.presenter.redraw();
    }

    /// Has a text read aloud, to speak it.
    pub(super) fn say(&mut self, text: String, voice: Option<String>) {
        self.talking.read(Source::Text { text, voice }, self.proxy.clone());
    }

    /// Speaks what was read. If that is broken, the script before stays.
    pub(super) fn take_speech(&mut self) {
        let Some((name, read)) = self.talking.take() else { return };
        self.presenter.redraw();
        match read {
            Ok(script) => {
                match script.notes.is_empty() {
                    true => self.messages.settle(About::Speech),
                    false => {
                        let notes = script.notes.join("\n");
                        self.messages.warn(About::Speech, format!("{name}:"), notes);
                    }
                }
                self.talking.script = Some(script);
                self.speak();
            }
            Err(error) => self.messages.error(About::Speech, format!("{name} is not spoken."), &error),
        }
    }

    /// Speaks by the script, from its beginning, with its sound where that can be played.
    pub(super) fn speak(&mut self) {
        self.catch_up();
        self.talking.playing = None;
        let failed = self.tell_of_failure();
        let Some(script) = &mut self.talking.script else { return };
        self.session.face.performer.speak(script.words.clone(), -READY_SECS);
        self.talking.silent = None;
        match Playing::start(script, READY_SECS, failed) {
            Ok(playing) => {
                self.talking.playing = playing;
                self.messages.settle(About::Sound);
            }
            Err(error) => {
                let why = format!("{error:#}");
                self.messages.warn(About::Sound, "The sound is not played.", why.as_str());
                self.talking.silent = Some(why);
            }
        }
    }

    pub(super) fn stop_speaking(&mut self) {
        self.talking.playing = None;
        self.session.face.performer.hush();
    }

    /// The face says what the microphone hears, or no longer.
    pub(super) fn toggle_microphone(&mut self) {
        if self.talking.listens() {
            return self.stop_listening();
        }
        match Listening::begin(self.talking.heard_secs, self.tell_of_failure()) {
            Ok(listening) => {
                self.talking.listening = Some(listening);
                self.session.face.performer.set_listening(true);
                self.messages.settle(About::Sound);
            }
            Err(error) => self.messages.error(About::Sound, "The microphone is not heard.", &error),
        }
    }

    fn stop_listening(&mut self) {
        self.talking.listening = None;
        let performer = &mut self.session.face.performer;
        if performer.is_hearing() {
            performer.hush();
        }
        performer.set_listening(false);
    }

    /// Tells the window, from another thread, that a device has failed.
    fn tell_of_failure(&self) -> impl FnMut(String) + Send + 'static {
        let window = self.proxy.clone();
        // An error means that the window is closed.
        move |error| drop(window.send_event(Wake::SoundFailed(error)))
    }

    /// A device has failed or vanished: the face goes on without sound.
    pub(super) fn lose_sound(&mut self, error: String) {
        // One message, however often the device says so.
        if self.talking.playing.is_none() && !self.talking.listens() {
            return;
        }
        self.talking.playing = None;
        if self.talking.listens() {
            self.stop_listening();
        }
        self.messages.error(About::Sound, "The sound has ended.", &anyhow::anyhow!(error));
        self.presenter.redraw();
    }

    /// Another avatar is shown: what the one before said is not finished, and the microphone is this one's.
    pub(super) fn hand_speech_over(&mut self) {
        self.talking.playing = None;
        self.show_speech_amount();
        self.session.face.performer.set_listening(self.talking.listens());
    }

    /// Films the face as it is while it speaks by the script.
    pub(super) fn film_speech(&mut self, format: usize) {
        let Some(script) = &self.talking.script else { return };
        let (line, stem) = (script.line(), script.stem.clone());
        self.film(format, None, Some((line, stem)));
    }

    pub(super) fn set_speech_amount(&mut self, amount: f32) {
        self.talking.amount = Some(amount);
        self.show_speech_amount();
    }

    /// Tells the face, which may be another one, how much of speech it shows.
    fn show_speech_amount(&mut self) {
        if let Some(amount) = self.talking.amount {
            self.session.face.performer.set_speech_amounts(Amounts { mouth: amount, brows: amount });
        }
    }
}
