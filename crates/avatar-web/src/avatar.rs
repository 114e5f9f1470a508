#[cfg(feature = "zip")]
use crate::Archive;
use crate::WebError;
use avatar_exchange::{Format, Resolve};
#[cfg(feature = "zip")]
use avatar_pack::files;
use avatar_pack::{Import, Pack, Source, Texture, Textures};
use std::sync::Arc;

/// How files in GLB begin.
const GLB: &[u8] = b"glTF";

/// An avatar that was read from the bytes of one file.
#[derive(Clone, Debug)]
pub struct Avatar {
    /// The name of its file.
    pub name: String,
    /// Everything but the pictures.
    pub pack: Arc<Pack>,
    /// The pictures that it is drawn with.
    pub textures: Textures,
    /// What was mended, left out or not understood, for people.
    pub notes: Vec<String>,
}

impl Avatar {
    /// Reads an avatar: a pack as a zip archive, an archive with a file of another format and what belongs to
    /// it, or such a file by itself. Its name tells the format by its end; GLB, VRM and archives are known
    /// without.
    ///
    /// # Errors
    /// A file of a format that is not built in, or what the format's reader finds.
    pub fn read(name: &str, bytes: &[u8]) -> Result<Self, WebError> {
        #[cfg(feature = "zip")]
        if bytes.starts_with(Archive::MAGIC) {
            return Self::of_archive(name, &Archive::read(name, bytes)?);
        }
        Self::of_file(name, bytes, &mut |file| Err(format!("{file:?} is not part of one file")))
    }

    /// Puts a pack together.
    ///
    /// # Errors
    /// What is wrong with its files.
    pub fn of_pack(name: &str, source: &impl Source) -> Result<Self, WebError> {
        let pack = Pack::load(source)?;
        let textures =
            Textures::load_by(source, &Texture::DRAWN, |count, decode| (0..count).for_each(decode));
        Ok(Self { name: name.to_owned(), notes: notes(&pack, &textures), pack: Arc::new(pack), textures })
    }

    #[cfg(feature = "zip")]
    fn of_archive(name: &str, archive: &Archive) -> Result<Self, WebError> {
        let split = |path: &'_ str| match path.rsplit_once('/') {
            Some((folder, file)) => (folder.to_owned(), file.to_owned()),
            None => (String::new(), path.to_owned()),
        };
        let mut paths: Vec<(String, String)> = archive.names().map(split).collect();
        // Those in the outermost folder first.
        paths.sort_by_key(|(folder, _)| (!folder.is_empty(), folder.matches('/').count()));
        if let Some((folder, _)) = paths.iter().find(|(_, file)| files::RIG_NAMES.contains(&file.as_str())) {
            return Self::of_pack(name, &archive.folder(folder));
        }
        let avatar = paths.iter().find(|(_, file)| Format::of_name(file).is_some());
        let Some((folder, file)) = avatar else {
            return Err(WebError::File {
                file: name.to_owned(),
                expected: format!("an archive with {} or {}", files::RIG_NAMES.join(", "), endings()),
                found: format!("one with {} other files", paths.len()),
            });
        };
        let path = |file: &str| if folder.is_empty() { file.to_owned() } else { format!("{folder}/{file}") };
        let bytes = archive.get(&path(file)).unwrap_or_default();
        Self::of_file(file, bytes, &mut |other| {
            let found = archive.get(&path(other)).map(<[u8]>::to_vec);
            found.ok_or_else(|| format!("{other:?} is not in the archive"))
        })
    }

    fn of_file(name: &str, bytes: &[u8], resolve: &mut Resolve<'_>) -> Result<Self, WebError> {
        let format = match Format::of_name(name) {
            Some(format) => format,
            None if bytes.starts_with(GLB) && says_vrm(bytes) => Format::Vrm,
            None if bytes.starts_with(GLB) => Format::Gltf,
            None => {
                let zip = if cfg!(feature = "zip") { "a zip archive, or " } else { "" };
                let expected = format!("{zip}a name that ends in {}", endings());
                let found = "another file".to_owned();
                return Err(WebError::File { file: name.to_owned(), expected, found });
            }
        };
        let import = import(name, format, bytes, resolve)?;
        let Import { pack, textures, report } = import;
        let notes = report.notes.iter().cloned().chain(notes(&pack, &textures)).collect();
        Ok(Self { name: name.to_owned(), pack: Arc::new(pack), textures, notes })
    }
}

fn import(name: &str, format: Format, bytes: &[u8], resolve: &mut Resolve<'_>) -> Result<Import, WebError> {
    let scene = |error| WebError::Scene { file: name.to_owned(), error };
    #[cfg(feature = "vrm")]
    if format == Format::Vrm {
        let model = avatar_exchange::vrm::read(name, bytes, resolve)?;
        return Import::from_vrm(model).map_err(scene);
    }
    // A name that tells nothing, since the bytes did.
    let told = match Format::of_name(name) {
        Some(_) => name.to_owned(),
        None => format!("{name}.{}", format.extensions().first().copied().unwrap_or_default()),
    };
    Import::from_scene(avatar_exchange::read(&told, bytes, &[], resolve)?).map_err(scene)
}

/// Whether a GLB has the extension of an avatar, of either version.
fn says_vrm(bytes: &[u8]) -> bool {
    // The first chunk is the JSON; its length stands behind the header of twelve bytes.
    let length = bytes.get(12..16).and_then(|length| length.try_into().ok()).map_or(0, u32::from_le_bytes);
    let end = 20usize.saturating_add(length as usize).min(bytes.len());
    let json = bytes.get(20..end).unwrap_or_default();
    let has = |name: &[u8]| json.windows(name.len()).any(|window| window == name);
    has(b"\"VRMC_vrm\"") || has(b"\"VRM\"")
}

fn endings() -> String {
    let endings = Format::ALL.iter().filter(|format| **format != Format::Fbx);
    endings.flat_map(|format| format.extensions()).map(|end| format!(".{end}")).collect::<Vec<_>>().join(", ")
}

fn notes(pack: &Pack, textures: &Textures) -> Vec<String> {
    pack.warnings().iter().chain(&textures.warnings).map(ToString::to_string).collect()
}
