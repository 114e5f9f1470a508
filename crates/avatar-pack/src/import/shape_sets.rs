//! What shapes and parts are by their names.

use super::names::plain;
use face_space::Standard;
use pose_anim::face;
use std::fmt;
use std::sync::OnceLock;

/// The shapes of this format's own face.
const OWN: [&str; 2] = ["SSmile", "Frown"];

/// Shapes that many faces have under the same names.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum ShapeSet {
    /// The 52 blend shapes that face trackers of ARKit give weights for.
    ArKit,
    /// The expressions of VRM 1.0 and, by their older names, of VRM 0.x.
    Vrm,
    /// The 15 mouths for speech of Oculus.
    Visemes,
    /// The units of expressions that MakeHuman has as targets.
    MakeHuman,
    /// The shapes of this format's own face.
    Own,
}

impl fmt::Display for ShapeSet {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::ArKit => "ARKit",
            Self::Vrm => "VRM",
            Self::Visemes => "visemes (Oculus)",
            Self::MakeHuman => "MakeHuman",
            Self::Own => "the nine-joint face",
        })
    }
}

impl ShapeSet {
    /// All sets, in the order in which a name is looked for.
    pub const ALL: [Self; 5] = [Self::Own, Self::ArKit, Self::Visemes, Self::MakeHuman, Self::Vrm];

    /// The spaces that the set has the names of; of two that share a name, the first one's.
    pub(super) fn spaces(self) -> &'static [Standard] {
        match self {
            Self::ArKit => &[Standard::ArKit],
            Self::Vrm => &[Standard::Vrm1, Standard::Vrm0],
            Self::Visemes => &[Standard::Oculus],
            Self::MakeHuman => &[Standard::MakeHuman],
            Self::Own => &[],
        }
    }

    /// The names of the set.
    pub fn names(self) -> &'static [&'static str] {
        static SETS: OnceLock<Vec<(ShapeSet, Vec<&str>)>> = OnceLock::new();
        let sets = SETS.get_or_init(|| {
            let names = |set: Self| {
                let mut names: Vec<&'static str> = if set == Self::Own { OWN.to_vec() } else { Vec::new() };
                for name in set.spaces().iter().flat_map(|space| space.space().names()) {
                    if !names.iter().any(|other| plain(other) == plain(&name.name)) {
                        names.push(&name.name);
                    }
                }
                (set, names)
            };
            Self::ALL.map(names).to_vec()
        });
        sets.iter().find(|(set, _)| *set == self).map_or(&[], |(_, names)| names)
    }
}

/// Whether a part is one of those that MakeHuman's base mesh has for fitting clothes, hair and bones to it,
/// which are not to be seen. (Its plain eyes, teeth and tongue are.)
pub(super) fn is_fitting_helper(part: &str) -> bool {
    let helpers = [
        "hair",
        "skirt",
        "tights",
        "genital",
        "l-eyelashes-1",
        "l-eyelashes-2",
        "r-eyelashes-1",
        "r-eyelashes-2",
    ];
    part.starts_with("joint-") || part.strip_prefix("helper-").is_some_and(|what| helpers.contains(&what))
}

/// The control of the nine-joint face that means the same as a shape.
pub(crate) fn face_control(shape: &str) -> Option<&'static str> {
    match plain(shape.rsplit(['.', ':']).next().unwrap_or(shape)).as_str() {
        "ssmile" | "smile" | "mouthsmile" | "mouthcornerpuller" => Some(face::SMILE),
        "frown" | "mouthfrown" | "mouthdepression" => Some(face::FROWN),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn smiles_and_frowns_have_the_controls_of_the_face() {
        assert_eq!(face_control("Smile"), Some("smile"));
        assert_eq!(face_control("mouthSmileLeft"), None);
    }

    #[test]
    fn no_set_has_a_name_twice() {
        for set in ShapeSet::ALL {
            let mut names: Vec<_> = set.names().iter().map(|name| plain(name)).collect();
            names.sort();
            let count = names.len();
            names.dedup();
            assert_eq!(names.len(), count, "{set}");
        }
    }

    #[test]
    fn every_set_has_all_its_names() {
        let counts = ShapeSet::ALL.map(|set| set.names().len());
        assert_eq!(counts, [2, 52, 15, 34, 28]);
    }
}
