//! Reads files that may be anything: devices are refused, because reading them may never end, and links that
//! lead out of an avatar's folder are not followed.

use anyhow::Context;
use std::fmt;
use std::io::{ErrorKind, Read};
use std::path::{Component, Path};

/// Larger files than this are not read.
const MAX_FILE_BYTES: u64 = 4 << 30;

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

/// Whether pipes are read. Nobody knows how long that takes: it ends when the program at the other end does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Pipes {
    /// They are.
    Read,
    /// They are not: nothing may wait for another program.
    Refused,
}

/// Reads a regular file or a pipe, or what a link leads to, of at most 4 GiB.
pub(crate) fn file(path: &Path) -> Result<Vec<u8>, Unread> {
    read_at_most(path, MAX_FILE_BYTES, Pipes::Read)
}

/// Reads a file of this name in a folder or below. Links within the folder are followed.
pub(crate) fn file_within(folder: &Path, name: &str, pipes: Pipes) -> Result<Vec<u8>, Unread> {
    let refused = || Unread::Refused("expected a file in the same folder or below".to_owned());
    let steps = |part| matches!(part, Component::Normal(_) | Component::CurDir);
    if !Path::new(name).components().all(steps) {
        return Err(refused());
    }
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    let path = folder.join(name);
    if !path.canonicalize()?.starts_with(folder.canonicalize()?) {
        return Err(refused());
    }
    read_at_most(&path, MAX_FILE_BYTES, pipes)
}

/// A text that may not be there. Pipes are refused: texts are read while the window is open.
pub(crate) fn text(path: &Path) -> anyhow::Result<Option<String>> {
    text_of(path, read_at_most(path, MAX_FILE_BYTES, Pipes::Refused))
}

/// As [`text`]; a link out of the file's folder is refused as well.
pub(crate) fn text_within_its_folder(path: &Path) -> anyhow::Result<Option<String>> {
    let folder = path.parent().unwrap_or(Path::new(""));
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    text_of(path, file_within(folder, &name, Pipes::Refused))
}

fn text_of(path: &Path, read: Result<Vec<u8>, Unread>) -> anyhow::Result<Option<String>> {
    let unreadable = || format!("{}: expected a readable text", path.display());
    match read {
        Ok(bytes) => Ok(Some(String::from_utf8(bytes).with_context(unreadable)?)),
        Err(Unread::Missing(_)) => Ok(None),
        Err(Unread::Refused(reason)) => Err(anyhow::anyhow!(reason).context(unreadable())),
    }
}

#[cfg(unix)]
fn is_pipe(metadata: &std::fs::Metadata) -> bool {
    std::os::unix::fs::FileTypeExt::is_fifo(&metadata.file_type())
}

#[cfg(not(unix))]
fn is_pipe(_: &std::fs::Metadata) -> bool {
    false
}

fn read_at_most(path: &Path, limit: u64, pipes: Pipes) -> Result<Vec<u8>, Unread> {
    // Before it is opened: opening a device may do something, and opening a pipe may wait.
    let metadata = std::fs::metadata(path)?;
    let is_pipe = is_pipe(&metadata);
    if !metadata.is_file() && (!is_pipe || pipes == Pipes::Refused) {
        let found = match (metadata.is_dir(), is_pipe) {
            (true, _) => "a folder",
            (false, true) => "a pipe",
            (false, false) => "a device or socket",
        };
        return Err(Unread::Refused(format!("expected a file, found {found}")));
    }
    let too_large =
        |found: u64| Unread::Refused(format!("expected a file of at most {limit} bytes, found {found}"));
    if metadata.len() > limit {
        return Err(too_large(metadata.len()));
    }
    // The file may have grown since then, and some files report a size of 0 but have contents.
    let mut bytes = Vec::new();
    usize::try_from(metadata.len()).ok().and_then(|size| bytes.try_reserve_exact(size).ok()).ok_or_else(
        || Unread::Refused(format!("expected a file that fits into memory, found {} bytes", metadata.len())),
    )?;
    std::fs::File::open(path)?.take(limit + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > limit { Err(too_large(bytes.len() as u64)) } else { Ok(bytes) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_are_read_up_to_a_limit() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("file");
        std::fs::write(&path, [7; 100]).expect("written");
        assert_eq!(read_at_most(&path, 100, Pipes::Read).expect("read"), [7; 100]);
        let told = read_at_most(&path, 99, Pipes::Read).expect_err("too large").to_string();
        assert_eq!(told, "expected a file of at most 99 bytes, found 100");
        assert!(matches!(file(&folder.path().join("none")), Err(Unread::Missing(_))));
        let told = file(folder.path()).expect_err("a folder").to_string();
        assert_eq!(told, "expected a file, found a folder");
    }

    /// The system says that such a file is empty.
    #[cfg(target_os = "linux")]
    #[test]
    fn a_file_that_hides_its_size_has_the_limit_as_well() {
        let told = read_at_most(Path::new("/proc/self/maps"), 100, Pipes::Read)
            .expect_err("more than it says")
            .to_string();
        assert_eq!(told, "expected a file of at most 100 bytes, found 101");
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
        let read = |name: &str| file_within(&folder, name, Pipes::Read).map_err(|error| error.to_string());
        assert_eq!(read("link").expect("a link within"), b"inner");
        assert_eq!(read("./below/inner").expect("below"), b"inner");
        for name in ["out", "up/secret", "../secret", "/etc/passwd", "endless"] {
            assert_eq!(read(name).expect_err(name), "expected a file in the same folder or below", "{name}");
        }
        assert_eq!(
            file(&folder.join("endless")).expect_err("endless").to_string(),
            "expected a file, found a device or socket"
        );
        let told = text_within_its_folder(&folder.join("out")).expect_err("a link out of the folder");
        assert!(format!("{told:#}").ends_with("expected a file in the same folder or below"), "{told:#}");
        assert_eq!(
            text_within_its_folder(&folder.join("link")).expect("a link within").as_deref(),
            Some("inner")
        );
        assert_eq!(text_within_its_folder(&folder.join("none")).expect("no file"), None);
    }

    /// A pipe without a writer would be waited for.
    #[cfg(unix)]
    #[test]
    fn texts_are_not_read_from_pipes() {
        let folder = tempfile::tempdir().expect("a folder");
        let pipe = folder.path().join("poses.toml");
        let made = std::process::Command::new("mkfifo").arg(&pipe).status().expect("mkfifo starts");
        assert!(made.success());
        for told in [text(&pipe).expect_err("a pipe"), text_within_its_folder(&pipe).expect_err("a pipe")] {
            assert!(format!("{told:#}").ends_with("expected a file, found a pipe"), "{told:#}");
        }
    }
}
