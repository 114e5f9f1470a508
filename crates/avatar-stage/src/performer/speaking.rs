//! What a face says, over poses and clips and under its life.

use super::Performer;
use super::talk::Event;
use super::words::Words;
use avatar_life::Role;
use avatar_speech::{Amounts, Means, VISEMES};

impl Performer {
    /// Speaks, from a time in seconds after the beginning of the speech; what is not finite is 0. What was
    /// said before gives way within a tenth of a second. From a fifth of a second before the beginning on
    /// (−0.2) the mouth has time to prepare the first sound.
    ///
    /// The life of the face is told when utterances begin and end.
    pub fn speak(&mut self, words: impl Into<Words>, from_secs: f64) {
        self.talk.speak(words.into(), if from_secs.is_finite() { from_secs } else { 0.0 });
        self.take_role();
    }

    /// Says what is heard at the moment, as from a microphone: a frame of a recogniser, a hundred a second,
    /// with its time in seconds, which rises; weights in the order of [`avatar_speech::Viseme::ALL`], and
    /// loudness from 0 to 1. The first frame takes over from what was said before, [`Self::hush`] ends it.
    /// The mouth is 70 ms behind the newest frame: what a C² curve needs, and frames that come in pieces.
    ///
    /// While nobody speaks, the face listens, if it was told to ([`Self::set_listening`]).
    pub fn hear(&mut self, secs: f64, weights: &[f32; VISEMES], loudness: f32) {
        if self.talk.hear(secs, weights, loudness) {
            let is_within = self.talk.is_within_utterance();
            self.tell_life(if is_within { Event::Begins } else { Event::Ends });
        }
    }

    /// Whether it says what is heard at the moment, if anything is.
    pub fn is_hearing(&self) -> bool {
        self.talk.is_live()
    }

    /// Says no more: the mouth comes to rest within a tenth of a second.
    pub fn hush(&mut self) {
        let was_within = self.talk.is_within_utterance();
        self.talk.hush();
        if was_within {
            self.tell_life(Event::Ends);
        }
    }

    /// Whether the mouth speaks, or is still on its way to rest. One that says what is heard rests while
    /// nothing is.
    pub fn is_speaking(&self) -> bool {
        !self.talk.rests()
    }

    /// Seconds from the beginning of what is said; `None` where nothing is.
    pub fn speech_secs(&self) -> Option<f64> {
        self.talk.secs()
    }

    /// How much of speech the face shows, from now on; it gets there within a tenth of a second.
    pub fn set_speech_amounts(&mut self, amounts: Amounts) {
        self.talk.set_amounts(amounts);
    }

    /// How much of speech the face shows.
    pub fn speech_amounts(&self) -> Amounts {
        self.talk.amounts()
    }

    /// What the avatar speaks with; [`Means::Nothing`] where it cannot.
    pub fn speech_means(&self) -> Means {
        self.speech_map.means()
    }

    /// Whether the face listens while it says nothing: its life then looks away less.
    pub fn set_listening(&mut self, listens: bool) {
        self.listens = listens;
        self.take_role();
    }

    /// Something has happened in what is said.
    pub(super) fn tell_life(&mut self, event: Event) {
        if let Some(life) = self.life.as_mut().filter(|_| event == Event::Ends) {
            life.end_utterance();
        }
        self.take_role();
    }

    /// Tells the life which part the face has in the talk.
    pub(super) fn take_role(&mut self) {
        let role = match self.listens {
            _ if self.talk.is_within_utterance() => Role::Speaking,
            true => Role::Listening,
            false => Role::Neither,
        };
        if let Some(life) = &mut self.life {
            life.set_role(role);
        }
    }

    /// Values of the controls with speech on top, and no life yet.
    pub(super) fn say(&mut self) {
        self.mouth = (!self.talk.is_silent()).then(|| self.talk.mouth());
        let mut spoken = std::mem::take(&mut self.spoken);
        spoken.copy_from_slice(self.layers.values());
        self.speak_over(&mut spoken);
        self.spoken = spoken;
    }

    /// Lays what the face says over values of all controls.
    pub(super) fn speak_over(&self, values: &mut [f32]) {
        if let Some(mouth) = &self.mouth {
            self.speech_map.apply(mouth, Amounts::default(), values);
        }
    }

    /// The value of one control as it is shown, with speech and life, in full precision; `None` if there is
    /// no such control.
    pub fn value(&self, control: usize) -> Option<f64> {
        let below = self.layers.state(control)?.value;
        let speak = |mouth| self.speech_map.value(mouth, Amounts::default(), control, below);
        let spoken = self.mouth.as_ref().map_or(below, speak);
        Some(self.life.as_ref().map_or(spoken, |life| life.value(control, spoken)))
    }
}
