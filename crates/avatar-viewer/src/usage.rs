use avatar_pack::Pack;
use pose_anim::{MixError, Pose};

/// The command line has to be corrected: exit status 2.
#[derive(Debug, thiserror::Error)]
#[error("{0}")]
pub(crate) struct UsageError(pub(crate) String);

/// A [`UsageError`] that names what was expected and found.
pub(crate) fn usage(message: impl Into<String>) -> anyhow::Error {
    UsageError(message.into()).into()
}

/// As [`usage`], for a name that is not in the pack, with the names that are.
pub(crate) fn unknown<'a>(what: &str, found: &str, names: impl Iterator<Item = &'a str>) -> anyhow::Error {
    let names: Vec<_> = names.collect();
    let names = if names.is_empty() { "none".to_owned() } else { names.join(", ") };
    usage(format!("expected the name of a {what}, found {found:?}; there are: {names}"))
}

/// The place of the part of this name.
pub(crate) fn part(pack: &Pack, name: &str) -> anyhow::Result<usize> {
    let names = || pack.parts().iter().map(|part| part.name.as_str());
    names().position(|other| other == name).ok_or_else(|| unknown("part", name, names()))
}

/// The pose of this name, or a mixture such as `smile:0.5 wink-left`.
pub(crate) fn pose(pack: &Pack, text: &str) -> anyhow::Result<Pose> {
    // A name in a file may hold what separates a mixture's parts.
    if let Some(pose) = pack.poses().get(text) {
        return Ok(pose.clone());
    }
    pack.poses().mix(text, pack.controls()).map_err(|error| match error {
        MixError::UnknownPose { name, .. } => {
            unknown("pose", &name, pack.poses().iter().map(|pose| pose.name.as_str()))
        }
        other => usage(other.to_string()),
    })
}
