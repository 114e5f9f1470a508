use crate::WebError;
use avatar_exchange::memory;
use avatar_pack::{Source, SourceError};
use lzma_rust2::XzReader;
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::io::{Cursor, Read};
use zip::result::ZipError;
use zip::{CompressionMethod, ZipArchive};

/// An archive with more files than this is no avatar.
const MOST_FILES: usize = 10_000;
/// What archives unpack to, of all that reading an avatar may take: while a file grows it is there twice, and
/// readers need memory of their own.
const UNPACKED: (u64, u64) = (memory::BASE / 4, memory::PER_BYTE / 4);
/// Kilobytes that unpacking xz may take: its dictionary of 64 MiB at most, and a little.
const XZ_KB: u32 = 66_000;

/// The files of a zip archive, unpacked. Folders are part of the names, with `/` between them; `..` and
/// names from the root are refused.
#[derive(Clone, Debug, Default)]
pub struct Archive {
    name: String,
    files: BTreeMap<String, Vec<u8>>,
}

impl Archive {
    /// How archives begin.
    pub const MAGIC: &[u8] = b"PK\x03\x04";

    /// Unpacks an archive: stored, deflated or xz. `name` is told in errors.
    ///
    /// What it unpacks to is limited by its own size, since a few bytes can claim gigabytes.
    ///
    /// # Errors
    /// Bytes that are no such archive, one that unpacks to too much, files that no folder may hold.
    pub fn read(name: &str, bytes: &[u8]) -> Result<Self, WebError> {
        let error = |expected: &str, found: String| WebError::File {
            file: name.to_owned(),
            expected: expected.to_owned(),
            found,
        };
        let broken = |problem: ZipError| error("a zip archive", problem.to_string());
        let mut zip = ZipArchive::new(Cursor::new(bytes)).map_err(broken)?;
        if zip.len() > MOST_FILES {
            return Err(error(&format!("at most {MOST_FILES} files"), zip.len().to_string()));
        }
        let limit = memory::share(UNPACKED, bytes.len() as u64);
        let mut left = limit;
        let mut files = BTreeMap::new();
        for index in 0..zip.len() {
            let file = zip.by_index_raw(index).map_err(broken)?;
            if file.is_dir() {
                continue;
            }
            let path = file.enclosed_name().and_then(|path| Some(path.to_str()?.replace('\\', "/")));
            let Some(path) = path else {
                return Err(error("names of files in folders below", format!("{:?}", file.name())));
            };
            // Sizes that an archive claims are not trusted: reading ends where the room does.
            let mut unpacked = Vec::new();
            let most = left.saturating_add(1);
            let read = match file.compression() {
                // The archive's own way to it trusts what xz claims to need.
                CompressionMethod::Xz => {
                    XzReader::new_mem_limit(file, false, XZ_KB).take(most).read_to_end(&mut unpacked)
                }
                _ => {
                    drop(file);
                    zip.by_index(index).map_err(broken)?.take(most).read_to_end(&mut unpacked)
                }
            };
            read.map_err(|problem| error("a zip archive", format!("{problem} in {path:?}")))?;
            left = left
                .checked_sub(unpacked.len() as u64)
                .ok_or_else(|| error(&format!("files of at most {limit} bytes in all"), "more".to_owned()))?;
            files.insert(path, unpacked);
        }
        Ok(Self { name: name.to_owned(), files })
    }

    /// Names of the files, in the order of their letters.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.files.keys().map(String::as_str)
    }

    /// The bytes of a file.
    pub fn get(&self, name: &str) -> Option<&[u8]> {
        self.files.get(name).map(Vec::as_slice)
    }

    /// The files of one folder, as a source of a pack; the empty name is the outermost folder.
    pub fn folder<'a>(&'a self, folder: &'a str) -> impl Source + 'a {
        Folder { archive: self, folder }
    }
}

struct Folder<'a> {
    archive: &'a Archive,
    folder: &'a str,
}

impl Folder<'_> {
    fn path(&self, name: &str) -> String {
        if self.folder.is_empty() { name.to_owned() } else { format!("{}/{name}", self.folder) }
    }
}

impl Source for Folder<'_> {
    fn read(&self, name: &str) -> Result<Option<Cow<'_, [u8]>>, SourceError> {
        Ok(self.archive.get(&self.path(name)).map(Cow::Borrowed))
    }

    fn locate(&self, name: &str) -> String {
        format!("{}/{}", self.archive.name, self.path(name))
    }
}
