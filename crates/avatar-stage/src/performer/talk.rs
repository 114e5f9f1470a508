//! What a face says: one voice after the other, each of which takes over smoothly from the one before.

use super::live::Live;
use super::words::Words;
use avatar_speech::{Amounts, Mouth, VISEMES};
use pose_anim::Easing;

/// Seconds in which a voice takes over from what the mouth did before: as long as lips need from one sound to
/// the next.
const TAKE_OVER_SECS: f64 = 0.1;
/// Voices that may be on their way in at once; a further one waits until the first of them is there.
const MOST: usize = 6;

/// Something that happens at a time of its own, whatever the frames are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Event {
    /// An utterance begins.
    Begins,
    /// An utterance ends.
    Ends,
    /// Something that only the talk itself is concerned with.
    Own,
}

#[derive(Clone, Debug)]
enum Source {
    Silence,
    Words(Words),
    /// What is heard at the moment.
    Live,
}

/// Something to say, and how far it is.
#[derive(Clone, Debug)]
struct Voice {
    source: Source,
    amounts: Amounts,
    /// Seconds since its beginning.
    at_secs: f64,
    /// Seconds since it began to take over.
    since_secs: f64,
    /// Beginnings and ends of utterances that have passed.
    passed: usize,
}

impl Voice {
    fn silent(amounts: Amounts) -> Self {
        Self { source: Source::Silence, amounts, at_secs: 0.0, since_secs: 0.0, passed: 0 }
    }

    fn is_there(&self) -> bool {
        self.since_secs >= TAKE_OVER_SECS
    }

    fn mouth(&self, live: &Live) -> Mouth {
        match &self.source {
            // Silence shows nothing at all: else it would press the lips of whatever lies below.
            Source::Silence => Mouth::SILENT.scaled(Amounts { mouth: 0.0, brows: 0.0 }),
            Source::Words(words) => words.at(self.at_secs).scaled(self.amounts),
            Source::Live => live.mouth().scaled(self.amounts),
        }
    }

    /// The time of its next event, in seconds from its beginning, and what it is.
    fn next(&self) -> Option<(f64, Event)> {
        let Source::Words(words) = &self.source else { return None };
        Some(match words.utterance(self.passed / 2) {
            Some([begin, _]) if self.passed.is_multiple_of(2) => (begin, Event::Begins),
            Some([_, end]) => (end, Event::Ends),
            None => (words.rest_secs(), Event::Own),
        })
    }

    /// Passes over what is before its present time.
    fn skip(&mut self) {
        while let Some((_, Event::Begins | Event::Ends)) =
            self.next().filter(|(secs, _)| *secs < self.at_secs)
        {
            self.passed += 1;
        }
    }

    fn is_within_utterance(&self, live: &Live) -> bool {
        match self.source {
            Source::Live => live.is_within_utterance(),
            _ => !self.passed.is_multiple_of(2),
        }
    }
}

/// All voices: the oldest first, each laid over the ones before as far as it has taken over.
#[derive(Clone, Debug)]
pub(super) struct Talk {
    voices: Vec<Voice>,
    waiting: Option<Voice>,
    amounts: Amounts,
    live: Live,
}

impl Talk {
    pub(super) fn new() -> Self {
        let mut voices = Vec::with_capacity(MOST);
        let silent = Voice::silent(Amounts::default());
        voices.push(Voice { since_secs: TAKE_OVER_SECS, ..silent });
        Self { voices, waiting: None, amounts: Amounts::default(), live: Live::new() }
    }

    pub(super) fn speak(&mut self, words: Words, from_secs: f64) {
        let source = Source::Words(words);
        let mut voice = Voice { source, at_secs: from_secs, ..Voice::silent(self.amounts) };
        voice.skip();
        self.add(voice);
    }

    /// Says what is heard; whether an utterance begins or ends with this frame of it.
    pub(super) fn hear(&mut self, secs: f64, weights: &[f32; VISEMES], loudness: f32) -> bool {
        let was_within = self.is_within_utterance();
        self.live.hear(secs, weights, loudness);
        if !self.is_live() {
            self.add(Voice { source: Source::Live, ..Voice::silent(self.amounts) });
        }
        self.is_within_utterance() != was_within
    }

    /// Whether it says what is heard at the moment.
    pub(super) fn is_live(&self) -> bool {
        self.latest().is_some_and(|voice| matches!(voice.source, Source::Live))
    }

    pub(super) fn hush(&mut self) {
        if !matches!(self.latest(), None | Some(Voice { source: Source::Silence, .. })) {
            self.add(Voice::silent(self.amounts));
        }
    }

    pub(super) fn set_amounts(&mut self, amounts: Amounts) {
        if amounts == self.amounts {
            return;
        }
        self.amounts = amounts;
        // The same voice, laid over itself.
        if let Some(voice) = self.latest().cloned() {
            self.add(Voice { amounts, since_secs: 0.0, ..voice });
        }
    }

    pub(super) fn amounts(&self) -> Amounts {
        self.amounts
    }

    /// The voice that is heard in the end.
    fn latest(&self) -> Option<&Voice> {
        self.waiting.as_ref().or(self.voices.last())
    }

    fn add(&mut self, voice: Voice) {
        self.forget();
        match self.voices.len() < MOST {
            true => self.voices.push(voice),
            false => self.waiting = Some(voice),
        }
    }

    /// Lets go of voices that others have taken over from entirely.
    fn forget(&mut self) {
        if let Some(there) = self.voices.iter().rposition(Voice::is_there) {
            self.voices.drain(..there);
        }
    }

    /// Seconds from the beginning of what is said.
    pub(super) fn secs(&self) -> Option<f64> {
        self.latest().filter(|voice| matches!(voice.source, Source::Words(_))).map(|voice| voice.at_secs)
    }

    /// Whether an utterance is under way.
    pub(super) fn is_within_utterance(&self) -> bool {
        self.latest().is_some_and(|voice| voice.is_within_utterance(&self.live))
    }

    /// Whether the mouth rests until somebody says something again.
    pub(super) fn rests(&self) -> bool {
        let is_there = self.waiting.is_none() && self.voices.last().is_some_and(Voice::is_there);
        self.is_silent() || (is_there && self.is_live() && self.live.rests())
    }

    /// Whether the mouth is silent, and stays so.
    pub(super) fn is_silent(&self) -> bool {
        let at_rest = |voice: &Voice| voice.is_there() && matches!(voice.source, Source::Silence);
        self.waiting.is_none() && self.voices.last().is_none_or(at_rest)
    }

    /// Goes on to the next event, if it comes within so many seconds; and returns after how many, and what it
    /// was.
    pub(super) fn next_event(&mut self, within_secs: f64) -> Option<(f64, Event)> {
        let latest = self.latest()?;
        let own = latest.next().map(|(secs, event)| (secs - latest.at_secs, event));
        // The second voice being there, the first is not needed any more, and there is room for another.
        let room = self.waiting.as_ref().and(self.voices.get(1));
        let room = room.map(|second| (TAKE_OVER_SECS - second.since_secs, Event::Own));
        let is_room = match (own, room) {
            (Some((own, _)), Some((room, _))) => room <= own,
            (_, room) => room.is_some(),
        };
        let (secs, event) = if is_room { room? } else { own? };
        let secs = secs.max(0.0);
        if secs > within_secs || within_secs.is_nan() {
            return None;
        }
        self.pass(secs);
        match event {
            Event::Own if is_room => {
                // Where the second is there but for a rounding.
                if self.voices.len() >= MOST {
                    self.voices.drain(..1);
                }
                self.voices.extend(self.waiting.take());
            }
            Event::Own => self.hush(),
            Event::Begins | Event::Ends => {
                let latest = self.waiting.as_mut().or(self.voices.last_mut());
                latest.into_iter().for_each(|voice| voice.passed += 1);
            }
        }
        Some((secs, event))
    }

    /// Lets time pass in which nothing happens.
    pub(super) fn pass(&mut self, secs: f64) {
        for voice in &mut self.voices {
            voice.at_secs += secs;
            voice.since_secs += secs;
        }
        if let Some(waiting) = &mut self.waiting {
            waiting.at_secs += secs;
        }
        self.live.pass(secs);
        self.forget();
    }

    pub(super) fn mouth(&self) -> Mouth {
        let (first, others) = (self.voices.first(), self.voices.iter().skip(1));
        let first = first.map_or(Mouth::SILENT, |voice| voice.mouth(&self.live));
        others.fold(first, |below, voice| {
            let share = Easing::MinimumJerk.at(voice.since_secs / TAKE_OVER_SECS).value;
            below.toward(&voice.mouth(&self.live), share)
        })
    }
}
