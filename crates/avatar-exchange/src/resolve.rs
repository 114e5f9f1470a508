/// Brings a file that another one refers to: takes a relative path with `/` between folders, never absolute and never
/// leading upwards, and returns the file's bytes, or what went wrong.
pub type Resolve<'a> = dyn FnMut(&str) -> Result<Vec<u8>, String> + 'a;

use crate::SceneImage;

/// The picture behind an address of a file. Files of these formats name pictures by where they were on the machine of
/// their makers, so one that cannot be found is an image without bytes and a reason, not an error.
pub(crate) fn image(address: &str, resolve: &mut Resolve<'_>) -> (SceneImage, Option<String>) {
    let path = relative(address);
    let mime = mime_of(&path).to_owned();
    let (bytes, problem) = match resolve(&path) {
        Ok(bytes) => (bytes, None),
        Err(why) => {
            (Vec::new(), Some(format!("'{path}' was not found, it is left without a picture: {why}")))
        }
    };
    (SceneImage { name: path, mime, bytes }, problem)
}

/// The address itself where it is relative and stays below its folder, else its last part.
pub(crate) fn relative(address: &str) -> String {
    let address = address.strip_prefix("file://").unwrap_or(address).replace('\\', "/");
    let parts: Vec<&str> = address.split('/').filter(|part| !part.is_empty() && *part != ".").collect();
    let leaves = address.starts_with('/')
        || parts.first().is_some_and(|first| first.contains(':'))
        || parts.contains(&"..");
    if leaves { parts.last().copied().unwrap_or("").replace(':', "_") } else { parts.join("/") }
}

/// The media type that a name's ending stands for; empty where it is unknown.
pub(crate) fn mime_of(name: &str) -> &'static str {
    let ending = name.rsplit_once('.').map_or("", |(_, ending)| ending).to_ascii_lowercase();
    match ending.as_str() {
        "png" => "image/png",
        "jpg" | "jpeg" => "image/jpeg",
        _ => "",
    }
}
