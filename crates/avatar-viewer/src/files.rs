use crate::cli::PackArg;
use crate::config;
use crate::identity_args::{self, IdentityArg};
use crate::reading::{self, MAX_FILE_BYTES, Unread, not_a_file};
use crate::standard;
use crate::store::{self, Store};
use crate::threads;
use anyhow::{Context, Result, anyhow, bail};
use avatar_exchange::vrm::VrmModel;
use avatar_exchange::{Format, Scene, TextFile};
use avatar_pack::{
    Import, ImportReport, Pack, Source, SourceError, Springs, Texture, Textures, Warning, files, load_poses,
};
use avatar_stage::DefaultFace;
use pose_anim::{ClipSet, ControlTable, PoseSet};
use std::borrow::Cow;
use std::fmt::Display;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

/// An avatar's files, and which person is made of it.
#[derive(Debug)]
pub(crate) struct Files {
    pub(crate) place: Place,
    identity: Vec<IdentityArg>,
}

/// Where a pack comes from: a folder, or this program.
#[derive(Debug)]
pub(crate) enum Place {
    BuiltIn,
    Folder(PathBuf),
    /// A file of an interchange format with the further files that belong to it, as an avatar.
    File(PathBuf, Vec<PathBuf>, Box<Import>),
}

impl Place {
    fn open(pack: Option<&Path>, further: &[PathBuf]) -> Result<Self> {
        let Some(path) = pack else { return Ok(Self::BuiltIn) };
        match std::fs::metadata(path) {
            Ok(metadata) if !metadata.is_dir() && not_a_file(&metadata).is_some() => {
                let found = not_a_file(&metadata).unwrap_or_default();
                bail!("{}: expected the folder or file of an avatar, found {found}", path.display())
            }
            Ok(metadata) if metadata.is_dir() && further.is_empty() => Ok(Self::Folder(path.to_owned())),
            Ok(metadata) if metadata.is_dir() => {
                bail!("{}: expected a file that further files belong to, found a folder", path.display())
            }
            Ok(_) if Format::of_name(&path.to_string_lossy()).is_none() => {
                let endings = Format::ALL.iter().flat_map(|format| format.extensions());
                let endings = endings.map(|ending| format!(".{ending}")).collect::<Vec<_>>().join(", ");
                bail!(
                    "{}: expected the folder of an avatar, or a file that ends in {endings}, found a file of another kind",
                    path.display()
                )
            }
            Ok(_) => {
                let import = Box::new(import(path, further)?);
                Ok(Self::File(path.to_owned(), further.to_vec(), import))
            }
            Err(error) if error.kind() == ErrorKind::NotFound => {
                bail!(
                    "{}: expected the folder or file of an avatar, found nothing of that name",
                    path.display()
                )
            }
            Err(error) => Err(error)
                .with_context(|| format!("{}: expected the folder or file of an avatar", path.display())),
        }
    }
}

impl Files {
    /// The folder, if there is one of that name; without a name the built-in avatar.
    pub(crate) fn open(pack: Option<&Path>, further: &[PathBuf]) -> Result<Self> {
        Ok(Self { place: Place::open(pack, further)?, identity: Vec::new() })
    }

    /// As [`Files::open`], with what the command line says.
    pub(crate) fn of_args(args: &PackArg) -> Result<Self> {
        Ok(Self { identity: args.identity.clone(), ..Self::open(args.pack.as_deref(), &args.with)? })
    }

    /// Where poses and clips are kept that a user makes: those of a pack in its folder, those of a file
    /// beside it, those of the built-in avatar among the user's settings.
    pub(crate) fn store(&self) -> Store {
        let paths = [store::POSES, store::CLIPS].map(|which| self.path_of(store::NAMES[which]));
        Store::new(paths, !matches!(self.place, Place::BuiltIn))
    }

    /// Where a file of the user's is kept that goes with the avatar, if there can be one; and whether links
    /// must not lead out of its folder.
    pub(crate) fn kept(&self, name: &str) -> Option<(PathBuf, bool)> {
        Some((self.path_of(name)?, !matches!(self.place, Place::BuiltIn)))
    }

    fn path_of(&self, name: &str) -> Option<PathBuf> {
        match &self.place {
            Place::Folder(folder) => Some(folder.join(name)),
            Place::File(path, ..) => {
                let mut beside = path.file_name()?.to_owned();
                beside.push(format!(".{name}"));
                Some(path.with_file_name(beside))
            }
            Place::BuiltIn => Some(config::folder()?.join("marsienne").join(name)),
        }
    }

    /// A short name for titles.
    pub(crate) fn name(&self) -> String {
        match &self.place {
            Place::BuiltIn => "marsienne".to_owned(),
            Place::Folder(path) | Place::File(path, ..) => {
                path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned()
            }
        }
    }

    /// Loads everything but the textures, and prints warnings.
    pub(crate) fn load_pack(&self) -> Result<Pack> {
        let pack = self.read_pack()?;
        // Parts that were turned around are not worth a warning here; `info` lists them.
        let told = pack.warnings().iter().filter(|warning| !matches!(warning, Warning::InsideOut { .. }));
        told.for_each(standard::warn);
        Ok(pack)
    }

    /// Loads these textures of a folder, all of a file of an interchange format, and prints warnings.
    pub(crate) fn load_textures(&self, wanted: &[Texture]) -> Textures {
        let textures = self.read_textures(wanted);
        textures.warnings.iter().for_each(standard::warn);
        textures
    }

    /// The pack with its warnings, which are not told here.
    pub(crate) fn read_pack(&self) -> Result<Pack> {
        let mut pack = match &self.place {
            Place::Folder(_) => return self.person(Pack::load(self)?),
            Place::BuiltIn => Pack::load(self)?,
            Place::File(.., import) => self.with_springs(import.pack.clone())?,
        };
        // Such an avatar has no folder of its own: what its user has made is elsewhere.
        let store = self.store();
        if let Some(text) = store.read(store::POSES)? {
            let poses = PoseSet::from_toml(&text, pack.controls());
            pack.set_poses(poses.map_err(|error| store.placed(store::POSES, &error))?)?;
        }
        if let Some(text) = store.read(store::CLIPS)? {
            let clips = ClipSet::from_toml(&text, pack.controls());
            pack.set_clips(clips.map_err(|error| store.placed(store::CLIPS, &error))?)?;
        }
        self.person(pack)
    }

    /// Springs that lie beside a file take the place of its own; joints that turn with others still do.
    fn with_springs(&self, mut pack: Pack) -> Result<Pack> {
        let Some(path) = self.path_of(files::SPRINGS) else { return Ok(pack) };
        let Some(text) = reading::text_within_its_folder(&path)? else { return Ok(pack) };
        let placed = |error: &dyn Display| anyhow!("{}: {error}", path.display());
        let read = Springs::from_toml(&text, pack.rig()).map_err(|error| placed(&error))?;
        let springs = Springs { constraints: pack.springs().constraints.clone(), ..read };
        pack.set_springs(springs).map_err(|error| placed(&error))?;
        Ok(pack)
    }

    fn person(&self, pack: Pack) -> Result<Pack> {
        identity_args::person(pack, &self.identity)
    }

    /// The poses that the avatar has where its user made none.
    pub(crate) fn usual_poses(&self, controls: &ControlTable) -> Result<PoseSet> {
        match &self.place {
            Place::File(.., import) => Ok(import.pack.poses().clone()),
            _ => Ok(load_poses(self, controls)?),
        }
    }

    /// As [`Files::load_pack`], but where poses or clips hold a mistake there are the usual ones: a window
    /// tells of it itself.
    pub(crate) fn load_pack_in_any_case(&self) -> Result<Pack> {
        self.load_pack().or_else(|error| {
            let pack = match &self.place {
                Place::File(.., import) => Ok(import.pack.clone()),
                _ => Pack::load(&WithoutBooks(self)),
            };
            match pack.map(|pack| self.person(pack)) {
                Ok(Ok(pack)) => {
                    standard::warn(format_args!(
                        "{error:#}: poses, clips and springs of its own are left out"
                    ));
                    Ok(pack)
                }
                _ => Err(error),
            }
        })
    }

    /// The pictures with their warnings, which are not told here.
    pub(crate) fn read_textures(&self, wanted: &[Texture]) -> Textures {
        match &self.place {
            Place::File(.., import) => import.textures.clone(),
            _ => Textures::load_by(self, wanted, threads::all),
        }
    }

    /// The scene of a file of an interchange format, which is read again: an avatar keeps what moves of it,
    /// not its meshes and pictures as the file has them.
    pub(crate) fn read_scene(&self) -> Result<Option<Scene>> {
        let Place::File(path, further, _) = &self.place else { return Ok(None) };
        let mut scene = match read(path, further)? {
            FileScene::Vrm(model) => model.scene,
            FileScene::Other(scene) => *scene,
        };
        avatar_pack::leave_helpers_out(&mut scene);
        Ok(Some(scene))
    }

    /// Whether it says more than a scene can hold.
    pub(crate) fn is_vrm(&self) -> bool {
        matches!(&self.place, Place::File(path, ..) if Format::of_name(&path.to_string_lossy()) == Some(Format::Vrm))
    }

    /// What became of a file of an interchange format.
    pub(crate) fn report(&self) -> Option<&ImportReport> {
        match &self.place {
            Place::File(.., import) => Some(&import.report),
            _ => None,
        }
    }
}

/// Reads an avatar from a file of an interchange format, what belongs to it, and what it refers to from its
/// folder.
fn import(path: &Path, further: &[PathBuf]) -> Result<Import> {
    let import = match read(path, further)? {
        FileScene::Vrm(model) => Import::from_vrm(*model),
        FileScene::Other(scene) => Import::from_scene(*scene),
    };
    import.map_err(|error| anyhow!("{}: {error}", path.display()))
}

/// What a file of an interchange format has.
enum FileScene {
    Vrm(Box<VrmModel>),
    Other(Box<Scene>),
}

fn read(path: &Path, further: &[PathBuf]) -> Result<FileScene> {
    let file = path.display().to_string();
    let bytes = reading::file(path).map_err(|reason| anyhow!("{file}: {reason}"))?;
    let mut files = Vec::new();
    for further in further {
        let placed = |path: &Path, reason: &dyn Display| anyhow!("{}: {reason}", path.display());
        if !further.is_dir() {
            let bytes = reading::file(further).map_err(|reason| placed(further, &reason))?;
            files.push((bytes, further.display().to_string()));
            continue;
        }
        for name in files_of(further, path).map_err(|reason| placed(further, &reason))? {
            let path = further.join(&name);
            let bytes = reading::file_within(further, &name, MAX_FILE_BYTES);
            files.push((bytes.map_err(|reason| placed(&path, &reason))?, path.display().to_string()));
        }
    }
    let further: Vec<_> = files.iter().map(|(bytes, file)| TextFile { file, bytes }).collect();
    let folder = path.parent().unwrap_or(Path::new(""));
    let mut left = MAX_FILE_BYTES;
    let mut resolve = |name: &str| {
        let bytes = reading::file_within(folder, name, left).map_err(|error| error.to_string())?;
        left -= bytes.len() as u64;
        Ok(bytes)
    };
    if Format::of_name(&file) == Some(Format::Vrm) && further.is_empty() {
        let model = avatar_exchange::vrm::read(&file, &bytes, &mut resolve)?;
        return Ok(FileScene::Vrm(Box::new(model)));
    }
    let scene = avatar_exchange::read(&file, &bytes, &further, &mut resolve)?;
    Ok(FileScene::Other(Box::new(scene)))
}

/// Names of those files of a folder that may belong to `first`, in an order in which `f2` comes before `f10`.
/// What only looks like a file is among them: reading refuses it.
fn files_of(folder: &Path, first: &Path) -> Result<Vec<String>, String> {
    let unreadable = |error: std::io::Error| format!("expected a readable folder, found: {error}");
    let entries = std::fs::read_dir(folder).map_err(unreadable)?;
    let mut files =
        entries.map(|entry| Ok(entry?.path())).collect::<std::io::Result<Vec<_>>>().map_err(unreadable)?;
    let endings = Format::of_name(&first.to_string_lossy()).map_or(&[][..], Format::further_extensions);
    let belongs = |file: &Path| {
        let ending = file.extension().map(|ending| ending.to_string_lossy().to_lowercase());
        ending.is_some_and(|ending| endings.contains(&ending.as_str())) && !file.is_dir()
    };
    files.retain(|file| belongs(file));
    // The avatar itself may be among them.
    let itself = std::fs::canonicalize(first).ok();
    files.retain(|file| itself.is_none() || std::fs::canonicalize(file).ok() != itself);
    // Other meshes beside targets are no frames.
    let is_target =
        |file: &PathBuf| file.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("target"));
    if files.iter().any(is_target) {
        files.retain(is_target);
    }
    if files.is_empty() {
        return Err(format!("expected files that end in {}, found none", endings.join(", ")));
    }
    let mut names = Vec::new();
    for file in files {
        let name = file.file_name().unwrap_or_default();
        let name =
            name.to_str().ok_or_else(|| format!("expected a name in UTF-8, found {}", name.display()))?;
        names.push(name.to_owned());
    }
    names.sort_by_cached_key(|name| (by_numbers(name), name.clone()));
    Ok(names)
}

/// A name in an order in which `f2` comes before `f10`: runs of digits are numbers.
fn by_numbers(name: &str) -> Vec<(u64, String)> {
    let mut parts = vec![(0u64, String::new())];
    let mut was_digit = false;
    for letter in name.chars() {
        let digit = letter.to_digit(10).map(u64::from);
        if digit.is_some() && !was_digit {
            parts.push((0, String::new()));
        }
        if let Some((number, text)) = parts.last_mut() {
            match digit {
                Some(digit) => *number = number.saturating_mul(10).saturating_add(digit),
                None => text.push(letter),
            }
        }
        was_digit = digit.is_some();
    }
    parts
}

/// All files but the poses and clips.
struct WithoutBooks<'a>(&'a Files);

impl Source for WithoutBooks<'_> {
    fn read(&self, name: &str) -> Result<Option<Cow<'_, [u8]>>, SourceError> {
        if store::NAMES.contains(&name) { Ok(None) } else { self.0.read(name) }
    }

    fn locate(&self, name: &str) -> String {
        self.0.locate(name)
    }
}

impl Source for Files {
    fn read(&self, name: &str) -> Result<Option<Cow<'_, [u8]>>, SourceError> {
        let folder = match &self.place {
            Place::BuiltIn => return DefaultFace.read(name),
            // A file of an interchange format holds all there is.
            Place::File(..) => return Ok(None),
            Place::Folder(folder) => folder,
        };
        let is_text = Path::new(name).extension().is_some_and(|ending| ending == "toml");
        let read = match is_text {
            true => reading::text_bytes_within(folder, name),
            false => reading::file_within(folder, name, MAX_FILE_BYTES),
        };
        match read {
            Ok(bytes) => Ok(Some(Cow::Owned(bytes))),
            Err(Unread::Missing(_)) => Ok(None),
            Err(Unread::Refused(reason)) => Err(SourceError(reason)),
        }
    }

    fn locate(&self, name: &str) -> String {
        match &self.place {
            Place::BuiltIn => DefaultFace.locate(name),
            Place::Folder(folder) => folder.join(name).display().to_string(),
            Place::File(path, ..) => path.display().to_string(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::by_numbers;

    #[test]
    fn numbers_in_names_are_numbers() {
        let mut names = ["f10", "f2", "f1b", "f1", "e3", "f1a", "12", "2"];
        names.sort_by_cached_key(|name| by_numbers(name));
        assert_eq!(names, ["2", "12", "e3", "f1", "f1a", "f1b", "f2", "f10"]);
    }
}
