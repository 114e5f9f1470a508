use avatar_pack::{Source, SourceError};
use include_dir::{Dir, include_dir};
use std::borrow::Cow;

static FILES: Dir<'_> = include_dir!("$CARGO_MANIFEST_DIR/../../assets/marsienne");

/// The files of the built-in face, as a [`Source`] for [`Pack::load`](avatar_pack::Pack::load) and
/// [`Textures::load`](avatar_pack::Textures::load).
#[derive(Clone, Copy, Debug, Default)]
pub struct DefaultFace;

impl Source for DefaultFace {
    fn read(&self, name: &str) -> Result<Option<Cow<'_, [u8]>>, SourceError> {
        Ok(FILES.get_file(name).map(|file| Cow::Borrowed(file.contents())))
    }

    fn locate(&self, name: &str) -> String {
        format!("(built-in)/{name}")
    }
}
