//! References of a file to other files, as [`crate::Resolve`] takes them: relative, with `/`, below the
//! file's folder.

#[cfg(any(feature = "collada", feature = "fbx"))]
use crate::scene::{Resolve, SceneImage};

/// Why a reference does not lead to a file in the folder or below it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Outside {
    /// It names no file.
    Empty,
    /// It begins at a root, a drive or a server.
    Absolute,
    /// It leads upwards.
    Upwards,
}

/// The reference without empty and `.` segments, with `/` between the others.
pub(crate) fn inside(reference: &str) -> Result<String, Outside> {
    let segments = || reference.split(['/', '\\']);
    let kept: Vec<&str> = segments().filter(|segment| !(segment.is_empty() || *segment == ".")).collect();
    if reference.contains('\0') {
        return Err(Outside::Empty);
    }
    let has_scheme = |segment: Option<&str>| segment.is_some_and(|segment| segment.contains(':'));
    if reference.starts_with(['/', '\\'])
        || has_scheme(segments().next())
        || has_scheme(kept.first().copied())
    {
        return Err(Outside::Absolute);
    }
    if kept.contains(&"..") {
        return Err(Outside::Upwards);
    }
    if kept.is_empty() { Err(Outside::Empty) } else { Ok(kept.join("/")) }
}

/// As [`inside`], for formats whose writers name the places on their own machines: of a reference that leads
/// outside, the file's name remains, which is where people put such files. `None` where that is no name.
#[cfg(any(feature = "collada", feature = "fbx", feature = "obj"))]
pub(crate) fn beside(reference: &str) -> Option<String> {
    let reference = reference.trim();
    match inside(reference) {
        Ok(path) => Some(path),
        Err(Outside::Empty) => None,
        Err(Outside::Absolute | Outside::Upwards) => {
            let name = reference.rsplit(['/', '\\']).find(|segment| !segment.is_empty())?;
            (name != "." && name != ".." && !name.contains(':')).then(|| name.to_owned())
        }
    }
}

/// The picture behind a reference, and why it has no bytes where they were not found: a scene without a
/// picture is better than none.
#[cfg(any(feature = "collada", feature = "fbx"))]
pub(crate) fn image(reference: &str, resolve: &mut Resolve<'_>) -> (SceneImage, Option<String>) {
    let path = beside(reference).unwrap_or_default();
    let mime = mime_of(&path).to_owned();
    let found = if path.is_empty() { Err("it has no name".to_owned()) } else { resolve(&path) };
    let (bytes, problem) = match found {
        Ok(bytes) => (bytes, None),
        Err(why) => {
            (Vec::new(), Some(format!("'{path}' was not found, it is left without a picture: {why}")))
        }
    };
    (SceneImage { name: path, mime, bytes }, problem)
}

/// The media type that a name's ending stands for; empty where it is unknown.
#[cfg(any(feature = "collada", feature = "fbx"))]
pub(crate) fn mime_of(name: &str) -> &'static str {
    let ending = name.rsplit_once('.').map_or("", |(_, ending)| ending).to_ascii_lowercase();
    match ending.as_str() {
        "png" => "image/png",
        "jpg" | "jpeg" => "image/jpeg",
        _ => "",
    }
}

#[cfg(test)]
mod tests {
    use super::{Outside, inside};

    #[test]
    fn references_stay_in_their_folder() {
        assert_eq!(inside("./a b//c\\d.png"), Ok("a b/c/d.png".to_owned()));
        for (reference, why) in [
            ("/etc/x", Outside::Absolute),
            ("C:\\x", Outside::Absolute),
            ("./C:/x", Outside::Absolute),
            ("http://x/y", Outside::Absolute),
            ("\\\\x", Outside::Absolute),
            ("..", Outside::Upwards),
            ("a/../../b", Outside::Upwards),
            ("", Outside::Empty),
            ("./", Outside::Empty),
            ("a\0", Outside::Empty),
        ] {
            assert_eq!(inside(reference), Err(why), "{reference:?}");
        }
    }

    #[cfg(any(feature = "collada", feature = "fbx", feature = "obj"))]
    #[test]
    fn of_places_on_other_machines_the_name_remains() {
        use super::beside;
        for (reference, path) in [
            ("maps/skin.png", Some("maps/skin.png")),
            ("file:///C:/work/skin.png", Some("skin.png")),
            ("D:\\work\\skin.png", Some("skin.png")),
            ("../skin.png", Some("skin.png")),
            ("C:skin.png", None),
            // Nothing that leads upwards may be asked for.
            ("..", None),
            ("a/..", None),
            ("", None),
        ] {
            assert_eq!(beside(reference).as_deref(), path, "{reference:?}");
        }
    }
}
