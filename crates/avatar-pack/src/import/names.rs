use std::collections::HashMap;
use std::fmt;
use std::sync::OnceLock;

/// What a joint of a face does.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Role {
    /// Turns, bows and tilts the head.
    Head,
    /// Opens the mouth.
    Jaw,
    /// Turns the character's left eye.
    LeftEye,
    /// Turns the character's right eye.
    RightEye,
    /// Closes the character's left eye from above.
    LeftUpperLid,
    /// Closes the character's right eye from above.
    RightUpperLid,
    /// Closes the character's left eye from below.
    LeftLowerLid,
    /// Closes the character's right eye from below.
    RightLowerLid,
}

impl fmt::Display for Role {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Head => "head",
            Self::Jaw => "jaw",
            Self::LeftEye => "left eye",
            Self::RightEye => "right eye",
            Self::LeftUpperLid => "left upper lid",
            Self::RightUpperLid => "right upper lid",
            Self::LeftLowerLid => "left lower lid",
            Self::RightLowerLid => "right lower lid",
        })
    }
}

/// What stands before the names of joints: Mixamo, VRoid's VRM, Character Creator, 3ds Max, Unreal's and Blender's habits.
const PREFIXES: [&str; 9] =
    ["mixamorig", "jbipc", "jbipl", "jbipr", "jadjl", "jadjr", "ccbase", "bip01", "bip001"];

/// The names of joints in lower case and without what separates words. Of this format's own rig, Mixamo, VRM as VRoid
/// writes it, MakeHuman, Character Creator, Rigify.
const JOINTS: [(Role, &[&str]); 8] = [
    (Role::Head, &["head", "headjoint", "spine006", "defspine006", "bonehead"]),
    (Role::Jaw, &["jaw", "jawjoint", "jawroot", "lowerjaw", "mandible", "jawmaster", "defjaw"]),
    (
        Role::LeftEye,
        &[
            "lefteye",
            "eyeleft",
            "eyel",
            "leye",
            "lteyejoint",
            "lefteyejoint",
            "faceeyel",
            "faceeye.l",
            "mastereyel",
        ],
    ),
    (
        Role::RightEye,
        &[
            "righteye",
            "eyeright",
            "eyer",
            "reye",
            "rteyejoint",
            "righteyejoint",
            "faceeyer",
            "faceeye.r",
            "mastereyer",
        ],
    ),
    (Role::LeftUpperLid, &["ltupperlidjoint", "leftupperlid", "upperlidl", "orbicularis03l"]),
    (Role::RightUpperLid, &["rtupperlidjoint", "rightupperlid", "upperlidr", "orbicularis03r"]),
    (Role::LeftLowerLid, &["ltlowerlidjoint", "leftlowerlid", "lowerlidl", "orbicularis04l"]),
    (Role::RightLowerLid, &["rtlowerlidjoint", "rightlowerlid", "lowerlidr", "orbicularis04r"]),
];

/// Lower case, letters and digits only.
fn plain(name: &str) -> String {
    name.chars().filter(|c| c.is_alphanumeric()).flat_map(char::to_lowercase).collect()
}

/// What a joint of this name does.
pub(super) fn role_of(name: &str) -> Option<Role> {
    // Namespaces stand before the name itself.
    let name = name.rsplit([':', '|']).next().unwrap_or(name);
    let plain = plain(name);
    let is = |name: &str| JOINTS.iter().find(|(_, names)| names.contains(&name)).map(|(role, _)| *role);
    is(&plain).or_else(|| {
        let (prefix, rest) =
            PREFIXES.iter().find_map(|prefix| Some((*prefix, plain.strip_prefix(prefix)?)))?;
        // VRoid says the side before the name.
        match (prefix.chars().last(), rest) {
            (Some('l'), "faceeye") => Some(Role::LeftEye),
            (Some('r'), "faceeye") => Some(Role::RightEye),
            _ => is(rest),
        }
    })
}

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

    /// The names of the set.
    pub fn names(self) -> &'static [&'static str] {
        match self {
            Self::ArKit => &ARKIT,
            Self::Vrm => &VRM,
            Self::Visemes => &VISEMES,
            Self::MakeHuman => &MAKEHUMAN,
            Self::Own => &["SSmile", "Frown"],
        }
    }

    /// The set that a shape of this name belongs to, and how the set has the name: upper and lower case, separators, and what
    /// stands before the last dot do not count, `_L` and `_R` stand for `Left` and `Right`.
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

/// Whether a part is one of those that MakeHuman's base mesh has for fitting clothes, hair and bones to it, which are not to be
/// seen. (Its plain eyes, teeth and tongue are.)
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
        "ssmile" | "smile" | "mouthsmile" | "mouthcornerpuller" => Some("smile"),
        "frown" | "mouthfrown" | "mouthdepression" => Some("frown"),
        _ => None,
    }
}

/// Apple's `ARFaceAnchor.BlendShapeLocation`.
const ARKIT: [&str; 52] = [
    "browDownLeft",
    "browDownRight",
    "browInnerUp",
    "browOuterUpLeft",
    "browOuterUpRight",
    "cheekPuff",
    "cheekSquintLeft",
    "cheekSquintRight",
    "eyeBlinkLeft",
    "eyeBlinkRight",
    "eyeLookDownLeft",
    "eyeLookDownRight",
    "eyeLookInLeft",
    "eyeLookInRight",
    "eyeLookOutLeft",
    "eyeLookOutRight",
    "eyeLookUpLeft",
    "eyeLookUpRight",
    "eyeSquintLeft",
    "eyeSquintRight",
    "eyeWideLeft",
    "eyeWideRight",
    "jawForward",
    "jawLeft",
    "jawOpen",
    "jawRight",
    "mouthClose",
    "mouthDimpleLeft",
    "mouthDimpleRight",
    "mouthFrownLeft",
    "mouthFrownRight",
    "mouthFunnel",
    "mouthLeft",
    "mouthLowerDownLeft",
    "mouthLowerDownRight",
    "mouthPressLeft",
    "mouthPressRight",
    "mouthPucker",
    "mouthRight",
    "mouthRollLower",
    "mouthRollUpper",
    "mouthShrugLower",
    "mouthShrugUpper",
    "mouthSmileLeft",
    "mouthSmileRight",
    "mouthStretchLeft",
    "mouthStretchRight",
    "mouthUpperUpLeft",
    "mouthUpperUpRight",
    "noseSneerLeft",
    "noseSneerRight",
    "tongueOut",
];

/// VRM 1.0's preset expressions, then those names of VRM 0.x that differ.
const VRM: [&str; 30] = [
    "happy",
    "angry",
    "sad",
    "relaxed",
    "surprised",
    "aa",
    "ih",
    "ou",
    "ee",
    "oh",
    "blink",
    "blinkLeft",
    "blinkRight",
    "lookUp",
    "lookDown",
    "lookLeft",
    "lookRight",
    "neutral",
    "joy",
    "sorrow",
    "fun",
    "a",
    "i",
    "u",
    "e",
    "o",
    "blink_l",
    "blink_r",
    "Fcl_ALL_Joy",
    "Fcl_ALL_Angry",
];

/// The Oculus audio SDK's visemes as most exporters name them.
const VISEMES: [&str; 15] = [
    "viseme_sil",
    "viseme_PP",
    "viseme_FF",
    "viseme_TH",
    "viseme_DD",
    "viseme_kk",
    "viseme_CH",
    "viseme_SS",
    "viseme_nn",
    "viseme_RR",
    "viseme_aa",
    "viseme_E",
    "viseme_I",
    "viseme_O",
    "viseme_U",
];

/// MakeHuman's own spelling. "Corner puller" is the smile of the Facial Action Coding System, unit 12.
const MAKEHUMAN: [&str; 34] = [
    "eye-left-closure",
    "eye-left-opened-up",
    "eye-left-slit",
    "eye-right-closure",
    "eye-right-opened-up",
    "eye-right-slit",
    "eyebrows-left-down",
    "eyebrows-left-extern-up",
    "eyebrows-left-inner-up",
    "eyebrows-left-up",
    "eyebrows-right-down",
    "eyebrows-right-extern-up",
    "eyebrows-right-inner-up",
    "eyebrows-right-up",
    "mouth-compression",
    "mouth-corner-puller",
    "mouth-depression",
    "mouth-depression-retraction",
    "mouth-elevation",
    "mouth-eversion",
    "mouth-open",
    "mouth-parling",
    "mouth-part-later",
    "mouth-protusion",
    "mouth-pursing",
    "mouth-retraction",
    "mouth-upward-retraction",
    "neck-platysma",
    "nose-compression",
    "nose-depression",
    "nose-left-dilatation",
    "nose-left-elevation",
    "nose-right-dilatation",
    "nose-right-elevation",
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn joints_are_known_by_their_usual_names() {
        for (name, role) in [
            ("HeadJoint", Some(Role::Head)),
            ("mixamorig:Head", Some(Role::Head)),
            ("mixamorig5:Head", Some(Role::Head)),
            ("Armature|Armature:Head", Some(Role::Head)),
            ("mixamorig:HeadTop_End", None),
            ("J_Bip_C_Head", Some(Role::Head)),
            ("J_Adj_L_FaceEye", Some(Role::LeftEye)),
            ("J_Adj_R_FaceEye", Some(Role::RightEye)),
            ("CC_Base_Head", Some(Role::Head)),
            ("eye.L", Some(Role::LeftEye)),
            ("RightEye", Some(Role::RightEye)),
            ("RtLowerLidJoint", Some(Role::RightLowerLid)),
            ("jaw", Some(Role::Jaw)),
            ("forehead", None),
            ("", None),
        ] {
            assert_eq!(role_of(name), role, "{name}");
        }
    }

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
}
