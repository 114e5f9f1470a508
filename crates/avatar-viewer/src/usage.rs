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

/// So many names are listed; more are a wall of letters.
const LISTED: usize = 60;

/// As [`usage`], for a name that is not in the pack, with the one that is meant and those that there are.
pub(crate) fn unknown<'a>(
    what: &str,
    found: &str,
    names: impl IntoIterator<Item = &'a str>,
) -> anyhow::Error {
    let names: Vec<_> = names.into_iter().collect();
    let hint = did_you_mean(found, names.iter().copied());
    let more = names.len().saturating_sub(LISTED);
    let mut listed =
        if names.is_empty() { "none".to_owned() } else { names[..names.len() - more].join(", ") };
    if more > 0 {
        listed.push_str(&format!(" and {more} more, which `info` lists"));
    }
    usage(format!("expected the name of a {what}, found {found:?}{hint}; there are: {listed}"))
}

/// As [`usage`], for the value of an option that has to be one of a few names.
pub(crate) fn unknown_option<'a>(
    option: &str,
    found: &str,
    names: impl IntoIterator<Item = &'a str>,
) -> anyhow::Error {
    let names: Vec<_> = names.into_iter().collect();
    let hint = did_you_mean(found, names.iter().copied());
    let found = if found.is_empty() { "nothing".to_owned() } else { format!("{found:?}") };
    usage(format!("{option}: expected one of {}, found {found}{hint}", names.join(", ")))
}

/// The end of a message about a misspelt name; nothing where none is close to it.
pub(crate) fn did_you_mean<'a>(found: &str, names: impl IntoIterator<Item = &'a str>) -> String {
    let nearest = placed_toml::nearest(found, names);
    nearest.map(|name| format!(" (did you mean {name:?}?)")).unwrap_or_default()
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_meant_is_said_and_long_lists_end() {
        let told = unknown("pose", "smlie", ["neutral", "smile"]).to_string();
        assert_eq!(
            told,
            "expected the name of a pose, found \"smlie\" (did you mean \"smile\"?); there are: neutral, smile"
        );
        let told = unknown("clip", "wave", []).to_string();
        assert_eq!(told, "expected the name of a clip, found \"wave\"; there are: none");
        let names: Vec<_> = (0..100).map(|number| format!("target {number}")).collect();
        let told = unknown("control", "x", names.iter().map(String::as_str)).to_string();
        assert!(told.ends_with("target 58, target 59 and 40 more, which `info` lists"), "{told}");
    }
}
