use avatar_exchange::ImportError;
use avatar_life::LifeError;
use avatar_pack::{FaceError, IdentityError, ImportFailure, PackError};
use avatar_render::StateError;
use avatar_render::headless::{NoAdapter, RenderImageError};
use avatar_speech::SpeechError;
use avatar_stage::{DraftError, PerformerError, ScreenError, UploadError};
use pose_anim::JumpError;

/// Why something that a page asked for is not done. A page gets the text as the message of an `Error`.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum WebError {
    /// A file that is no avatar that is read here.
    #[error("{file}: expected {expected}, found {found}")]
    File {
        /// Its name.
        file: String,
        /// What would do.
        expected: String,
        /// What it is.
        found: String,
    },
    /// A word that stands for nothing here.
    #[error("{place}: expected {expected}, found {found:?}{}", placed_toml::did_you_mean(nearest.as_deref()))]
    Word {
        /// What was to be set.
        place: String,
        /// What would do.
        expected: String,
        /// What was said.
        found: String,
        /// The word that is probably meant.
        nearest: Option<String>,
    },
    /// Numbers that are as many as they should not be.
    #[error("expected {expected} {what}, found {found}")]
    Count {
        /// What is counted.
        what: &'static str,
        /// How many there should be.
        expected: usize,
        /// How many there are.
        found: usize,
    },
    /// Samples of a rate that cannot be heard.
    #[error("{0}")]
    Sound(String),
    /// Nothing is drawn yet, or no more, so there are no pictures.
    #[error("expected a device that draws, found none: call show first")]
    Unseen,
    /// What the file of a pack says.
    #[error(transparent)]
    Pack(#[from] PackError),
    /// What the reader of a format says.
    #[error(transparent)]
    Import(#[from] ImportError),
    /// A scene that does not become an avatar.
    #[error("{file}: {error}")]
    Scene {
        /// Name of the file.
        file: String,
        /// Why.
        error: ImportFailure,
    },
    /// What the performer says.
    #[error(transparent)]
    Performer(#[from] PerformerError),
    /// Control values that do not become a face.
    #[error(transparent)]
    Face(#[from] FaceError),
    /// Values that a face cannot have.
    #[error(transparent)]
    Jump(#[from] JumpError),
    /// A person that cannot be made.
    #[error(transparent)]
    Identity(#[from] IdentityError),
    /// What the face does by itself.
    #[error(transparent)]
    Life(#[from] LifeError),
    /// Sounds and their times that cannot be read.
    #[error(transparent)]
    Speech(#[from] SpeechError),
    /// What the device cannot hold.
    #[error(transparent)]
    Upload(#[from] UploadError),
    /// A face that does not fit what was uploaded.
    #[error(transparent)]
    State(#[from] StateError),
    /// No device.
    #[error(transparent)]
    Adapter(#[from] NoAdapter),
    /// Nothing to draw on, or no more.
    #[error(transparent)]
    Screen(#[from] ScreenError),
    /// A frame in motion that was not drawn.
    #[error(transparent)]
    Draft(#[from] DraftError),
    /// A picture that was not drawn.
    #[error(transparent)]
    Picture(#[from] RenderImageError),
}

impl WebError {
    /// A word for `place` that is none of these.
    pub(crate) fn word<'a>(
        place: &str,
        found: &str,
        known: impl IntoIterator<Item = &'a str> + Clone,
        beside: &str,
    ) -> Self {
        let nearest = placed_toml::nearest(found, known.clone()).map(str::to_owned);
        let mut expected = known.into_iter().collect::<Vec<_>>().join(", ");
        if !beside.is_empty() {
            expected.push_str(beside);
        }
        Self::Word { place: place.to_owned(), expected, found: found.to_owned(), nearest }
    }

    /// A number for `place` that is none, or out of its range.
    pub(crate) fn number(place: &str, expected: impl Into<String>, found: &str) -> Self {
        Self::Word {
            place: place.to_owned(),
            expected: expected.into(),
            found: found.to_owned(),
            nearest: None,
        }
    }

    /// Whether nothing will be drawn any more before another device is opened.
    pub fn is_lost(&self) -> bool {
        matches!(self, Self::Screen(ScreenError::Lost))
    }
}
