//! What joints are by their names.

use super::sections::sections;
pub(super) use face_space::plain;
use std::collections::HashMap;
use std::fmt;
use std::sync::OnceLock;

const JOINTS: &str = include_str!("../../assets/joints.txt");

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

impl Role {
    const ALL: [Self; 8] = [
        Self::Head,
        Self::Jaw,
        Self::LeftEye,
        Self::RightEye,
        Self::LeftUpperLid,
        Self::RightUpperLid,
        Self::LeftLowerLid,
        Self::RightLowerLid,
    ];

    /// In words, as `assets/joints.txt` has it.
    fn words(self) -> &'static str {
        match self {
            Self::Head => "head",
            Self::Jaw => "jaw",
            Self::LeftEye => "left eye",
            Self::RightEye => "right eye",
            Self::LeftUpperLid => "left upper lid",
            Self::RightUpperLid => "right upper lid",
            Self::LeftLowerLid => "left lower lid",
            Self::RightLowerLid => "right lower lid",
        }
    }
}

impl fmt::Display for Role {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.words())
    }
}

/// What `assets/joints.txt` says.
struct Names {
    joints: HashMap<&'static str, Role>,
    prefixes: Vec<&'static str>,
}

fn names() -> &'static Names {
    static NAMES: OnceLock<Names> = OnceLock::new();
    NAMES.get_or_init(|| {
        let mut names = Names { joints: HashMap::new(), prefixes: Vec::new() };
        for (heading, entries) in sections(JOINTS) {
            match Role::ALL.into_iter().find(|role| role.words() == heading) {
                Some(role) => names.joints.extend(entries.into_iter().map(|name| (name, role))),
                None if heading == "prefixes" => names.prefixes = entries,
                None => {}
            }
        }
        names
    })
}

/// What a joint of this name does.
pub(super) fn role_of(name: &str) -> Option<Role> {
    // Namespaces stand before the name itself.
    let name = name.rsplit([':', '|']).next().unwrap_or(name);
    let plain = plain(name);
    let Names { joints, prefixes } = names();
    let is = |name: &str| joints.get(name).copied();
    is(&plain).or_else(|| {
        let (prefix, rest) =
            prefixes.iter().find_map(|prefix| Some((*prefix, plain.strip_prefix(prefix)?)))?;
        // VRoid says the side before the name.
        match (prefix.chars().last(), rest) {
            (Some('l'), "faceeye") => Some(Role::LeftEye),
            (Some('r'), "faceeye") => Some(Role::RightEye),
            _ => is(rest),
        }
    })
}

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
    fn every_role_has_names() {
        for role in Role::ALL {
            assert!(names().joints.values().any(|other| *other == role), "{role}");
        }
        assert!(names().prefixes.len() >= 9);
        // Every heading is that of a role, so that no name is lost.
        let count: usize = sections(JOINTS).iter().map(|(_, names)| names.len()).sum();
        assert_eq!(count, names().joints.len() + names().prefixes.len());
    }
}
