use anyhow::{Context, Result, bail};
use avatar_pack::{Pack, Source, SourceError, Textures, Warning};
use include_dir::{Dir, include_dir};
use std::borrow::Cow;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

static BUILT_IN: Dir<'_> = include_dir!("$CARGO_MANIFEST_DIR/../../assets/marsienne");

/// Where a pack comes from: a folder, or this program.
#[derive(Debug)]
pub(crate) enum Files {
    BuiltIn,
    Folder(PathBuf),
}

impl Files {
    /// The folder, if there is one of that name; without a name the built-in avatar.
    pub(crate) fn open(pack: Option<&Path>) -> Result<Self> {
        let Some(path) = pack else { return Ok(Self::BuiltIn) };
        match std::fs::metadata(path) {
            Ok(metadata) if metadata.is_dir() => Ok(Self::Folder(path.to_owned())),
            Ok(_) => bail!("{}: expected the folder of an avatar, found a file", path.display()),
            Err(error) if error.kind() == ErrorKind::NotFound => {
                bail!(
                    "{}: expected the folder of an avatar (or a verb), found nothing of that name",
                    path.display()
                )
            }
            Err(error) => {
                Err(error).with_context(|| format!("{}: expected the folder of an avatar", path.display()))
            }
        }
    }

    /// A short name for titles.
    pub(crate) fn name(&self) -> String {
        match self {
            Self::BuiltIn => "marsienne".to_owned(),
            Self::Folder(path) => path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned(),
        }
    }

    /// Loads everything but the textures, and prints warnings.
    pub(crate) fn load_pack(&self) -> Result<Pack> {
        let pack = Pack::load(self)?;
        // A part that is turned around needs nobody's attention; `info` tells.
        let told = pack.warnings.iter().filter(|warning| !matches!(warning, Warning::InsideOut { .. }));
        told.for_each(|warning| eprintln!("warning: {warning}"));
        Ok(pack)
    }

    /// Loads the textures, and prints warnings.
    pub(crate) fn load_textures(&self) -> Textures {
        let textures = Textures::load(self);
        textures.warnings.iter().for_each(|warning| eprintln!("warning: {warning}"));
        textures
    }
}

impl Source for Files {
    fn read(&self, name: &str) -> Result<Option<Cow<'_, [u8]>>, SourceError> {
        let folder = match self {
            Self::BuiltIn => return Ok(BUILT_IN.get_file(name).map(|file| Cow::Borrowed(file.contents()))),
            Self::Folder(folder) => folder,
        };
        let path = folder.join(name);
        match std::fs::read(&path) {
            Ok(bytes) => Ok(Some(Cow::Owned(bytes))),
            Err(error) if error.kind() == ErrorKind::NotFound => Ok(None),
            Err(_) if path.is_dir() => Err(SourceError("expected a file, found a folder".to_owned())),
            Err(error) => Err(SourceError(format!("expected a readable file, found: {error}"))),
        }
    }

    fn locate(&self, name: &str) -> String {
        match self {
            Self::BuiltIn => format!("(built-in)/{name}"),
            Self::Folder(folder) => folder.join(name).display().to_string(),
        }
    }
}
