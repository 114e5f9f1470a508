use avatar_speech::{HeardSpeech, Mouth, Speech};
use std::sync::Arc;

/// Something that a face can say, shared by all who say it.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub enum Words {
    /// Sounds and their times.
    Speech(Arc<Speech>),
    /// What was heard in a recording.
    Heard(Arc<HeardSpeech>),
}

impl Words {
    /// The mouth at a time in seconds from the beginning.
    pub fn at(&self, secs: f64) -> Mouth {
        match self {
            Self::Speech(speech) => speech.at(secs),
            Self::Heard(heard) => heard.at(secs),
        }
    }

    /// When the last sound ends, in seconds from the beginning.
    pub fn end_secs(&self) -> f64 {
        match self {
            Self::Speech(speech) => speech.end_secs(),
            Self::Heard(heard) => heard.end_secs(),
        }
    }

    /// From when on the mouth is at rest, in seconds from the beginning.
    pub fn rest_secs(&self) -> f64 {
        match self {
            Self::Speech(speech) => speech.rest_secs(),
            Self::Heard(heard) => heard.rest_secs(),
        }
    }

    /// The beginning and end of an utterance, by its place among all of them.
    pub(super) fn utterance(&self, index: usize) -> Option<[f64; 2]> {
        match self {
            Self::Speech(speech) => speech.utterances().get(index).copied(),
            Self::Heard(heard) => heard.utterances().get(index).copied(),
        }
    }
}

impl From<Speech> for Words {
    fn from(speech: Speech) -> Self {
        Self::Speech(Arc::new(speech))
    }
}

impl From<Arc<Speech>> for Words {
    fn from(speech: Arc<Speech>) -> Self {
        Self::Speech(speech)
    }
}

impl From<HeardSpeech> for Words {
    fn from(heard: HeardSpeech) -> Self {
        Self::Heard(Arc::new(heard))
    }
}

impl From<Arc<HeardSpeech>> for Words {
    fn from(heard: Arc<HeardSpeech>) -> Self {
        Self::Heard(heard)
    }
}
