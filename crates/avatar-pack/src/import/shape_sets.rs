//! What shapes and parts are by their names.

use super::names::plain;
use super::sections::sections;
use pose_anim::face;
use std::collections::HashMap;
use std::fmt;
use std::sync::OnceLock;

const SHAPES: &str = include_str!("../../assets/shapes.txt");

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

    /// The heading of the set in `assets/shapes.txt`.
    fn heading(self) -> &'static str {
        match self {
            Self::ArKit => "arkit",
            Self::Vrm => "vrm",
            Self::Visemes => "visemes",
            Self::MakeHuman => "makehuman",
            Self::Own => "own",
        }
    }

    /// The names of the set.
    pub fn names(self) -> &'static [&'static str] {
        static SETS: OnceLock<Vec<(&str, Vec<&str>)>> = OnceLock::new();
        let sets = SETS.get_or_init(|| sections(SHAPES));
        sets.iter().find(|(heading, _)| *heading == self.heading()).map_or(&[], |(_, names)| names)
    }

    /// The set that a shape of this name belongs to, and how the set has the name: upper and lower case,
    /// separators, and what stands before the last dot do not count, `_L` and `_R` stand for `Left` and
    /// `Right`.
    pub(super) fn find(name: &str) -> Option<(Self, &'static str)> {
        let last = name.rsplit(['.', ':']).next().unwrap_or(name);
        let known = |name: &str| by_plain_name().get(name).copied();
        let sided = || {
            let (stem, side) = last.split_at_checked(last.len().checked_sub(2)?)?;
            let side = match side {
                "_L" | "_l" => "left",
                "_R" | "_r" => "right",
                _ => return None,
            };
            known(&(plain(stem) + side))
        };
        let viseme = || known(&format!("viseme{}", plain(last.strip_prefix("viseme_")?)));
        known(&plain(last)).or_else(sided).or_else(viseme)
    }
}

/// All sets' names without what does not count; of sets that share one, the first.
fn by_plain_name() -> &'static HashMap<String, (ShapeSet, &'static str)> {
    static NAMES: OnceLock<HashMap<String, (ShapeSet, &'static str)>> = OnceLock::new();
    NAMES.get_or_init(|| {
        let mut names = HashMap::new();
        for set in ShapeSet::ALL {
            for name in set.names() {
                names.entry(plain(name)).or_insert((set, *name));
            }
        }
        names
    })
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
    fn shapes_are_known_by_their_usual_names() {
        for (name, set) in [
            ("jawOpen", Some(ShapeSet::ArKit)),
            ("JawOpen", Some(ShapeSet::ArKit)),
            ("Face.M_F00_000_00_jawOpen", None),
            ("head.eyeBlink_L", Some(ShapeSet::ArKit)),
            ("mouthSmileRight", Some(ShapeSet::ArKit)),
            ("viseme_PP", Some(ShapeSet::Visemes)),
            ("SSmile", Some(ShapeSet::Own)),
            ("Surprised", Some(ShapeSet::Vrm)),
            ("eye-left-closure", Some(ShapeSet::MakeHuman)),
            ("mouth_open", Some(ShapeSet::MakeHuman)),
            ("Key 1", None),
            ("", None),
        ] {
            assert_eq!(ShapeSet::find(name).map(|(set, _)| set), set, "{name}");
        }
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
        assert_eq!(counts, [2, 52, 15, 34, 30]);
        let headings: Vec<_> = sections(SHAPES).into_iter().map(|(heading, _)| heading).collect();
        assert_eq!(
            headings,
            ShapeSet::ALL.map(ShapeSet::heading),
            "in the order of the search, and no other"
        );
    }
}
