//! Reads files that may be anything: only files are read, up to a size. Devices and pipes may never end, and
//! links that lead out of an avatar's folder are not followed.

use anyhow::Context;
use std::fmt;
use std::fs::{File, Metadata};
use std::io::{ErrorKind, Read};
use std::path::{Component, Path};

/// Larger files than this are not read, nor what a file refers to beyond so many bytes in all.
pub(crate) const MAX_FILE_BYTES: u64 = 4 << 30;
/// Larger texts than this are not read: one of poses, clips, materials, hair, keys or settings.
const MAX_TEXT_BYTES: u64 = 64 << 20;
/// Some files of the system say that they are empty, and have contents. So much of them is read.
const MAX_HIDDEN_BYTES: u64 = 1 << 20;

/// To find out whether a file goes on, this much more is read: files that the system makes up while they are
/// read want whole entries to be read.
const PAGE_BYTES: u64 = 4096;

/// Why a file was not read.
#[derive(Debug)]
pub(crate) enum Unread {
    /// The file does not exist.
    Missing(String),
    /// The file exists, but it cannot be read, or its kind, place or size is not allowed.
    Refused(String),
}

impl fmt::Display for Unread {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (Self::Missing(reason) | Self::Refused(reason)) = self;
        f.write_str(reason)
    }
}

impl From<std::io::Error> for Unread {
    fn from(error: std::io::Error) -> Self {
        let reason = format!("expected a readable file, found: {error}");
        if error.kind() == ErrorKind::NotFound { Self::Missing(reason) } else { Self::Refused(reason) }
    }
}

/// Reads a file of at most 4 GiB, or the one that a link leads to.
pub(crate) fn file(path: &Path) -> Result<Vec<u8>, Unread> {
    read_at_most(path, MAX_FILE_BYTES)
}

/// Reads a file of this name in a folder or below, of at most `limit` bytes. Links within the folder are
/// followed.
pub(crate) fn file_within(folder: &Path, name: &str, limit: u64) -> Result<Vec<u8>, Unread> {
    let refused = || Unread::Refused("expected a file in the same folder or below".to_owned());
    let steps = |part| matches!(part, Component::Normal(_) | Component::CurDir);
    if !Path::new(name).components().all(steps) {
        return Err(refused());
    }
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    // Read where the links lead now, whatever becomes of them.
    let path = folder.join(name).canonicalize()?;
    if !path.starts_with(folder.canonicalize()?) {
        return Err(refused());
    }
    read_at_most(&path, limit.min(MAX_FILE_BYTES))
}

/// A text of an avatar in its folder: a link out of the folder is refused, for somebody else made it.
pub(crate) fn text_bytes_within(folder: &Path, name: &str) -> Result<Vec<u8>, Unread> {
    file_within(folder, name, MAX_TEXT_BYTES)
}

/// The bytes of a text, in whatever encoding.
pub(crate) fn text_bytes(path: &Path) -> Result<Vec<u8>, Unread> {
    read_at_most(path, MAX_TEXT_BYTES)
}

/// A text that may not be there.
pub(crate) fn text(path: &Path) -> anyhow::Result<Option<String>> {
    text_of(path, read_at_most(path, MAX_TEXT_BYTES))
}

/// As [`text`]; a link out of the file's folder is refused as well.
pub(crate) fn text_within_its_folder(path: &Path) -> anyhow::Result<Option<String>> {
    let folder = path.parent().unwrap_or(Path::new(""));
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    text_of(path, text_bytes_within(folder, &name))
}

fn text_of(path: &Path, read: Result<Vec<u8>, Unread>) -> anyhow::Result<Option<String>> {
    let unreadable = || format!("{}: expected a readable text", path.display());
    match read {
        Ok(bytes) => Ok(Some(String::from_utf8(bytes).with_context(unreadable)?)),
        Err(Unread::Missing(_)) => Ok(None),
        Err(Unread::Refused(reason)) => Err(anyhow::anyhow!(reason).context(unreadable())),
    }
}

/// What there is instead of a file, in words; `None` if it is one.
pub(crate) fn not_a_file(metadata: &Metadata) -> Option<&'static str> {
    #[cfg(unix)]
    {
        use std::os::unix::fs::FileTypeExt;
        let kind = metadata.file_type();
        if kind.is_fifo() {
            return Some("a pipe");
        }
        if kind.is_socket() {
            return Some("a socket");
        }
    }
    match (metadata.is_file(), metadata.is_dir()) {
        (true, _) => None,
        (false, true) => Some("a folder"),
        (false, false) => Some("a device"),
    }
}

/// Opens a file; if there is a pipe by now, without waiting for whoever writes into it.
fn open(path: &Path) -> std::io::Result<File> {
    let mut options = File::options();
    options.read(true);
    #[cfg(unix)]
    std::os::unix::fs::OpenOptionsExt::custom_flags(&mut options, libc::O_NONBLOCK | libc::O_NOCTTY);
    options.open(path)
}

fn read_at_most(path: &Path, limit: u64) -> Result<Vec<u8>, Unread> {
    let checked = |metadata: Metadata| match not_a_file(&metadata) {
        Some(found) => Err(Unread::Refused(format!("expected a file, found {found}"))),
        None => Ok(metadata.len()),
    };
    // Before it is opened, for opening a device may do something; and again what was opened.
    checked(std::fs::metadata(path)?)?;
    let file = open(path)?;
    let size = checked(file.metadata()?)?;
    let too_large = |found: &dyn fmt::Display| {
        Unread::Refused(format!("expected a file of at most {limit} bytes, found {found}"))
    };
    if size > limit {
        return Err(too_large(&size));
    }
    let mut bytes = Vec::new();
    usize::try_from(size).ok().and_then(|size| bytes.try_reserve_exact(size).ok()).ok_or_else(|| {
        Unread::Refused(format!("expected a file that fits into memory, found {size} bytes"))
    })?;
    // The file may have grown since then, and some files report a size of 0 but have contents.
    let most = size.max(MAX_HIDDEN_BYTES).min(limit);
    file.take(most + PAGE_BYTES).read_to_end(&mut bytes)?;
    match bytes.len() as u64 {
        found if found <= most => Ok(bytes),
        _ if most == limit => Err(too_large(&"more")),
        _ => Err(Unread::Refused(format!(
            "expected a file of {size} bytes, as the system says, found one that goes on"
        ))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_are_read_up_to_a_limit() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("file");
        std::fs::write(&path, [7; 100]).expect("written");
        assert_eq!(read_at_most(&path, 100).expect("read"), [7; 100]);
        let told = read_at_most(&path, 99).expect_err("too large").to_string();
        assert_eq!(told, "expected a file of at most 99 bytes, found 100");
        assert!(matches!(file(&folder.path().join("none")), Err(Unread::Missing(_))));
        let told = file(folder.path()).expect_err("a folder").to_string();
        assert_eq!(told, "expected a file, found a folder");
    }

    /// The system says that such a file is empty.
    #[cfg(target_os = "linux")]
    #[test]
    fn a_file_that_hides_its_size_has_the_limit_as_well() {
        let told =
            read_at_most(Path::new("/proc/self/maps"), 100).expect_err("more than it says").to_string();
        assert_eq!(told, "expected a file of at most 100 bytes, found more");
    }

    #[cfg(unix)]
    #[test]
    fn links_are_followed_within_a_folder_and_to_files_only() {
        use std::os::unix::fs::symlink;
        let outer = tempfile::tempdir().expect("a folder");
        let folder = outer.path().join("avatar");
        std::fs::create_dir_all(folder.join("below")).expect("a folder");
        std::fs::write(outer.path().join("secret"), "secret").expect("written");
        std::fs::write(folder.join("below/inner"), "inner").expect("written");
        symlink("below/inner", folder.join("link")).expect("a link");
        symlink("../secret", folder.join("out")).expect("a link");
        symlink("..", folder.join("up")).expect("a link");
        symlink("/dev/zero", folder.join("endless")).expect("a link");
        let read = |name: &str| file_within(&folder, name, MAX_FILE_BYTES).map_err(|error| error.to_string());
        assert_eq!(read("link").expect("a link within"), b"inner");
        assert_eq!(read("./below/inner").expect("below"), b"inner");
        for name in ["out", "up/secret", "../secret", "/etc/passwd", "endless"] {
            assert_eq!(read(name).expect_err(name), "expected a file in the same folder or below", "{name}");
        }
        assert_eq!(
            file(&folder.join("endless")).expect_err("endless").to_string(),
            "expected a file, found a device"
        );
        let told = text_within_its_folder(&folder.join("out")).expect_err("a link out of the folder");
        assert!(format!("{told:#}").ends_with("expected a file in the same folder or below"), "{told:#}");
        assert_eq!(
            text_within_its_folder(&folder.join("link")).expect("a link within").as_deref(),
            Some("inner")
        );
        assert_eq!(text_within_its_folder(&folder.join("none")).expect("no file"), None);
    }

    /// A map of all addresses that a program can have: hundreds of gigabytes, and the system says that it is
    /// empty.
    #[cfg(target_os = "linux")]
    #[test]
    fn a_file_that_goes_on_for_ever_is_refused() {
        let told = file(Path::new("/proc/self/pagemap")).expect_err("endless").to_string();
        assert_eq!(told, "expected a file of 0 bytes, as the system says, found one that goes on");
    }

    /// A pipe without a writer would be waited for.
    #[cfg(unix)]
    #[test]
    fn nothing_is_read_from_pipes_and_sockets() {
        let folder = tempfile::tempdir().expect("a folder");
        let pipe = folder.path().join("poses.toml");
        let made = std::process::Command::new("mkfifo").arg(&pipe).status().expect("mkfifo starts");
        assert!(made.success());
        assert_eq!(file(&pipe).expect_err("a pipe").to_string(), "expected a file, found a pipe");
        // It was a file when it was looked at.
        assert!(open(&pipe).expect("opened at once").metadata().is_ok());
        let socket = folder.path().join("socket");
        let _listener = std::os::unix::net::UnixListener::bind(&socket).expect("a socket");
        assert_eq!(file(&socket).expect_err("a socket").to_string(), "expected a file, found a socket");
        for told in [text(&pipe).expect_err("a pipe"), text_within_its_folder(&pipe).expect_err("a pipe")] {
            assert!(format!("{told:#}").ends_with("expected a file, found a pipe"), "{told:#}");
        }
    }
}
