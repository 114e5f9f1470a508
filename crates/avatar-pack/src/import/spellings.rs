//! Names of shapes as exporters write them.

use super::names::plain;
use super::sections::sections;
use super::shape_sets::ShapeSet;
use std::collections::{HashMap, HashSet};
use std::sync::OnceLock;

const SPELLINGS: &str = include_str!("../../assets/spellings.txt");
/// The fewest shapes whose common beginning is taken as a prefix of their exporter.
const MANY: usize = 8;

/// Spellings of fewer letters and digits, such as `PP`, may be words of anything.
const SHORTEST: usize = 4;

/// The names and aliases of the sets, and what `assets/spellings.txt` says, by names in lower case without
/// separators.
struct Names {
    /// The sets' own names; of sets that share one, the first set's.
    own: HashMap<String, (ShapeSet, &'static str)>,
    /// The other names.
    others: HashMap<String, (ShapeSet, &'static str)>,
    prefixes: HashSet<&'static str>,
}

fn names() -> &'static Names {
    static NAMES: OnceLock<Names> = OnceLock::new();
    NAMES.get_or_init(|| {
        let mut own = HashMap::new();
        for set in ShapeSet::ALL {
            for name in set.names() {
                own.entry(plain(name)).or_insert((set, *name));
            }
        }
        let mut names = Names { own, others: HashMap::new(), prefixes: HashSet::new() };
        for space in ShapeSet::ALL.iter().flat_map(|set| set.spaces()).map(|space| space.space()) {
            for (spelling, place) in space.spellings() {
                let name = space.names().get(place).map(|name| plain(&name.name));
                let known = name.and_then(|name| names.own.get(&name));
                if let (Some(known), false) = (known, names.own.contains_key(spelling))
                    && spelling.len() >= SHORTEST
                {
                    names.others.entry(spelling.to_owned()).or_insert(*known);
                }
            }
        }
        for (heading, entries) in sections(SPELLINGS) {
            match heading {
                "prefixes" => names.prefixes.extend(entries),
                _ => entries.into_iter().filter_map(|line| line.split_once('=')).for_each(|(other, name)| {
                    for side in sides_of(other) {
                        let (other, name) = (other.replace('*', side), name.replace('*', side));
                        if let Some(known) = names.own.get(&plain(&name)) {
                            names.others.insert(plain(&other), *known);
                        }
                    }
                }),
            }
        }
        names
    })
}

/// What `*` stands for in a line.
fn sides_of(line: &str) -> &'static [&'static str] {
    if line.contains('*') { &["Left", "Right"] } else { &[""] }
}

/// The set that a shape of this name belongs to, and how the set has the name.
pub(super) fn find(name: &str) -> Option<(ShapeSet, &'static str)> {
    let name = without_number(name.trim());
    let Names { own, others, .. } = names();
    if let Some(known) = others.get(&plain(name)) {
        return Some(*known);
    }
    let end = last(name);
    let body = end.as_str();
    if let Some(known) = own.get(&plain(body)).or_else(|| sided(body)).or_else(|| others.get(&plain(body))) {
        return Some(*known);
    }
    // Dots belong to the names of VRChat's mouths, and may have something before them.
    let two = name.match_indices(['.', ':', '|', '/']).rev().nth(1).map_or(name, |(at, _)| &name[at + 1..]);
    if let Some(known) = others.get(&plain(two)) {
        return Some(*known);
    }
    let mut rest = body;
    while let Some(shorter) = without_prefix(rest) {
        rest = shorter;
        let known = own.get(&plain(rest)).or_else(|| sided(rest)).filter(|known| is_long(known));
        if let Some(known) = known.or_else(|| others.get(&plain(rest))) {
            return Some(*known);
        }
    }
    None
}

/// As [`find`] for each of the shapes of a node, whose names may all begin with something that is not listed.
pub(crate) fn find_all(names: &[&str]) -> Vec<Option<(ShapeSet, &'static str)>> {
    let common = if names.len() < MANY { 0 } else { common_prefix(names) };
    let without = |name: &str| find(name.get(common..).filter(|_| common > 0)?).filter(is_long);
    names.iter().map(|name| find(name).or_else(|| without(name))).collect()
}

/// Whether a set's names cannot be taken for something else behind a prefix, as "a" and "sad" can.
fn is_long((set, _): &(ShapeSet, &str)) -> bool {
    matches!(set, ShapeSet::ArKit | ShapeSet::Visemes)
}

/// The length of what all of these begin with, up to a separator.
fn common_prefix(names: &[&str]) -> usize {
    let Some((first, others)) = names.split_first() else { return 0 };
    let same = |other: &&str| first.bytes().zip(other.bytes()).take_while(|(a, b)| a == b).count();
    let length = others.iter().map(same).min().unwrap_or(0);
    let mut shared =
        first.char_indices().filter(|(at, c)| at + c.len_utf8() <= length && !c.is_alphanumeric());
    shared.next_back().map_or(0, |(at, c)| at + c.len_utf8())
}

/// Without the number that Blender gives to the second of a name: `jawOpen.001`.
fn without_number(name: &str) -> &str {
    let number = name.len().checked_sub(4).and_then(|at| name.split_at_checked(at));
    match number {
        Some((stem, number)) if stem.len() > 2 && is_number(number) => stem,
        _ => name,
    }
}

fn is_number(end: &str) -> bool {
    end.strip_prefix(['.', '_']).is_some_and(|digits| digits.bytes().all(|digit| digit.is_ascii_digit()))
}

/// What stands behind the names of meshes and of the nodes that blend shapes; Blender's `.L` belongs to it.
fn last(name: &str) -> String {
    let (stem, side) = match name.len().checked_sub(2).and_then(|at| name.split_at_checked(at)) {
        Some((stem, ".L" | ".l")) => (stem, "_L"),
        Some((stem, ".R" | ".r")) => (stem, "_R"),
        _ => (name, ""),
    };
    stem.rsplit(['.', ':', '|', '/']).next().unwrap_or(stem).to_owned() + side
}

/// Without the first of what stands before a name.
fn without_prefix(name: &str) -> Option<&str> {
    if let Some((mesh, rest)) = name.split_once("__")
        && !names().own.contains_key(&plain(mesh))
    {
        return Some(rest);
    }
    let (first, rest) = name.split_once(['_', '-', ' '])?;
    let word = first.trim_end_matches(|c: char| c.is_ascii_digit());
    let is_number = word.len() < first.len() && word.len() <= 2;
    (is_number || names().prefixes.contains(plain(word).as_str())).then_some(rest)
}

/// A name with its side in another place or another way.
fn sided(name: &str) -> Option<&'static (ShapeSet, &'static str)> {
    let Names { own, others, .. } = names();
    let known = |stem: &str, side: &str| {
        let plain = format!("{stem}{side}");
        own.get(&plain).or_else(|| others.get(&plain))
    };
    let words = words(name);
    let (first, last) = (words.first()?.as_str(), words.last()?.as_str());
    if let (Some(side), [stem @ .., _]) = (side(last), words.as_slice()) {
        return known(&stem.concat(), side);
    }
    // The left jaw is not a jaw that moves to the left.
    if let (Some(side), [_, stem @ ..]) = (side(first), words.as_slice())
        && stem.len() > 1
    {
        return known(&stem.concat(), side);
    }
    // Unreal writes all in lower case: "eyeblinkl".
    let (stem, end) = first.split_at_checked(first.len().checked_sub(1)?)?;
    let is_long = words.len() == 1 && stem.len() > "mouth".len();
    side(end).filter(|_| is_long).and_then(|side| known(stem, side))
}

fn side(word: &str) -> Option<&'static str> {
    match word {
        "l" | "left" => Some("left"),
        "r" | "right" => Some("right"),
        _ => None,
    }
}

/// The words of a name in lower case: they begin at separators, and at upper case after lower case.
fn words(name: &str) -> Vec<String> {
    let mut words: Vec<String> = Vec::new();
    let mut is_new = true;
    let mut was_lower = false;
    for c in name.chars() {
        if !c.is_alphanumeric() {
            is_new = true;
            continue;
        }
        if is_new || c.is_uppercase() && was_lower {
            words.push(String::new());
        }
        is_new = false;
        was_lower = c.is_lowercase();
        words.last_mut().into_iter().for_each(|word| word.extend(c.to_lowercase()));
    }
    words
}

#[cfg(test)]
mod tests {
    use super::*;
    use ShapeSet::{ArKit, MakeHuman, Own, Visemes, Vrm};

    /// Spellings of published files and programs: three.js's `facecap.glb`, Apple's samples, Ready Player Me,
    /// Character Creator 3 and 4, Microsoft Rocketbox, Daz, MetaHuman, Faceshift, VRoid, VRChat, Blender.
    #[test]
    fn spellings_of_exporters_are_known() {
        for (name, expected) in [
            ("jawOpen", (ArKit, "jawOpen")),
            ("JawOpen", (ArKit, "jawOpen")),
            ("JAWOPEN", (ArKit, "jawOpen")),
            ("jaw_open", (ArKit, "jawOpen")),
            ("jaw-open", (ArKit, "jawOpen")),
            ("Jaw Open", (ArKit, "jawOpen")),
            ("jawOpen.001", (ArKit, "jawOpen")),
            ("jawOpen_001", (ArKit, "jawOpen")),
            ("eye_blink_left", (ArKit, "eyeBlinkLeft")),
            ("Eye_Blink_L", (ArKit, "eyeBlinkLeft")),
            ("eyeBlink.L", (ArKit, "eyeBlinkLeft")),
            ("eyeBlink.R.002", (ArKit, "eyeBlinkRight")),
            ("eyeBlink-L", (ArKit, "eyeBlinkLeft")),
            ("EyeBlinkL", (ArKit, "eyeBlinkLeft")),
            ("Left_EyeBlink", (ArKit, "eyeBlinkLeft")),
            ("rightEyeBlink", (ArKit, "eyeBlinkRight")),
            ("L_eyeBlink", (ArKit, "eyeBlinkLeft")),
            ("head.eyeBlink_L", (ArKit, "eyeBlinkLeft")),
            ("blendShape1.eyeBlink_L", (ArKit, "eyeBlinkLeft")),
            ("BS_ARKit.EyeBlinkLeft", (ArKit, "eyeBlinkLeft")),
            ("ARKit_eyeBlinkLeft", (ArKit, "eyeBlinkLeft")),
            ("bs_eyeBlinkLeft", (ArKit, "eyeBlinkLeft")),
            ("Mesh.001_eyeBlinkLeft", (ArKit, "eyeBlinkLeft")),
            ("head_jawOpen", (ArKit, "jawOpen")),
            ("Mesh_jawOpen", (ArKit, "jawOpen")),
            ("A14_Eye_Blink_Left", (ArKit, "eyeBlinkLeft")),
            ("AK_09_EyeBlinkLeft", (ArKit, "eyeBlinkLeft")),
            ("Eye_L_Look_R", (ArKit, "eyeLookInLeft")),
            ("Mouth_Down_Lower_R", (ArKit, "mouthLowerDownRight")),
            ("Mouth_L", (ArKit, "mouthLeft")),
            ("Genesis9__facs_bs_JawOpen", (ArKit, "jawOpen")),
            ("facs_jnt_EyeBlinkLeft", (ArKit, "eyeBlinkLeft")),
            ("Face.M_F00_000_00_jawOpen", (ArKit, "jawOpen")),
            ("CTRL_expressions_jawOpen", (ArKit, "jawOpen")),
            ("CTRL_expressions_jawFwd", (ArKit, "jawForward")),
            ("CTRL_expressions_eyeBlinkL", (ArKit, "eyeBlinkLeft")),
            ("ctrl_expressions_eyeblinkr", (ArKit, "eyeBlinkRight")),
            ("CTRL_expressions.eyeWidenR", (ArKit, "eyeWideRight")),
            ("CTRL_expressions_eyeLookLeftL", (ArKit, "eyeLookOutLeft")),
            ("CTRL_expressions_eyeLookLeftR", (ArKit, "eyeLookInRight")),
            ("ctrl_expressions_mouthcornerpulll", (ArKit, "mouthSmileLeft")),
            ("head_lod0_mesh__mouth_cornerPull_left", (ArKit, "mouthSmileLeft")),
            ("head_lod0_mesh__eye_squintInner_R", (ArKit, "eyeSquintRight")),
            ("EyeOpen_L", (ArKit, "eyeWideLeft")),
            ("BrowsU_C", (ArKit, "browInnerUp")),
            ("BrowsD_R", (ArKit, "browDownRight")),
            ("v2/EyeClosedLeft", (ArKit, "eyeBlinkLeft")),
            ("viseme_PP", (Visemes, "viseme_PP")),
            ("head.viseme_pp", (Visemes, "viseme_PP")),
            ("vrc.v_aa", (Visemes, "viseme_aa")),
            ("blendShape.vrc.v_oh", (Visemes, "viseme_O")),
            ("Fcl_ALL_Joy", (Vrm, "joy")),
            ("Face.M_F00_000_00_Fcl_ALL_Angry", (Vrm, "angry")),
            ("Face_Blendshape.Fcl_MTH_A", (Vrm, "aa")),
            ("Fcl_EYE_Close_L", (Vrm, "blinkLeft")),
            ("Blink_R", (Vrm, "blink_r")),
            ("Surprised", (Vrm, "surprised")),
            ("SSmile", (Own, "SSmile")),
            ("eye-left-closure", (MakeHuman, "eye-left-closure")),
            ("mouth_open", (MakeHuman, "mouth-open")),
        ] {
            assert_eq!(find(name), Some(expected), "{name}");
        }
    }

    #[test]
    fn other_names_are_nobodys() {
        for name in [
            "",
            "L",
            ".L",
            "Key 1",
            "Basis",
            // What corrects two shapes that meet, and halves and quarters of a shape.
            "jawOpen_mouthClose",
            "jawOpen__mouthClose",
            "corrective_jawOpen_mouthClose",
            "eyeBlink_eyeSquintLeft",
            "EyeBlinkLookDownLeft",
            "facs_bs_EyeLookInLeft_div2",
            "browInnerUp_L",
            "cheekPuff_L",
            "CTRL_expressions_mouthFunnelUL",
            "CTRL_expressions_mouthCornerUpL",
            // A side that is no movement to that side, or none of the shape's.
            "Left_Jaw",
            "L_mouth",
            "jawl",
            "mouthl",
            "eyeLookLeft",
            "eyeBlink",
            // Words that contain a name, or begin or end with it.
            "notJawOpen",
            "unjawOpen",
            "jawOpener",
            "jawOpen2",
            "mouthSmileLeftover",
            "overjoyed",
            // One word of many meanings behind a prefix.
            "head_a",
            "mesh_o",
            "face_sad",
            "body_neutral",
            "a.001",
            "vrc.v_xx",
        ] {
            assert_eq!(find(name), None, "{name}");
        }
    }

    #[test]
    fn what_all_shapes_of_a_node_begin_with_is_a_prefix() {
        let with = |prefix: &str, names: &[&str]| -> usize {
            let names: Vec<String> = names.iter().map(|name| format!("{prefix}{name}")).collect();
            let names: Vec<&str> = names.iter().map(String::as_str).collect();
            find_all(&names).iter().flatten().count()
        };
        let names = ArKit.names();
        assert_eq!(with("Amelie-v3 ", names), 52);
        assert_eq!(with("Amelie", names), 0, "not without something between");
        assert_eq!(with("Amelie_", &names[..7]), 0, "of a few shapes it may be a word of theirs");
        assert_eq!(with("mouth_", Vrm.names()), 0);
    }

    #[test]
    fn every_line_means_something() {
        let Names { others, prefixes, .. } = names();
        let found = sections(SPELLINGS);
        let headings: Vec<_> = found.iter().map(|(heading, _)| *heading).collect();
        assert_eq!(headings, ["prefixes", "names"]);
        assert_eq!(prefixes.len(), found[0].1.len());
        let spaces = || ShapeSet::ALL.iter().flat_map(|set| set.spaces()).map(|space| space.space());
        for line in &found[1].1 {
            let (other, name) = line.split_once('=').unwrap_or((line, ""));
            for side in sides_of(other) {
                let (other, name) = (plain(&other.replace('*', side)), plain(&name.replace('*', side)));
                let known = others.get(&other).map(|(_, known)| plain(known));
                assert_eq!(known.as_ref(), Some(&name), "{line}");
                assert!(spaces().all(|space| space.find(&other).is_none()), "{line}: face-space knows it");
            }
        }
        // None of them is a name of its own with another meaning.
        assert!(others.iter().all(|(other, known)| names().own.get(other).is_none_or(|own| own == known)));
    }
}
