//! Which controls are listed, in which order and under which headings.

use pose_anim::{Control, ControlTable, Drive, JointMotion};
use std::collections::HashSet;

/// A line of the list.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Row {
    /// A heading.
    Group {
        /// What the controls' names begin with, or what the controls say themselves.
        key: String,
        /// What the user reads.
        title: String,
        /// How many controls stand under it.
        count: usize,
    },
    /// A control.
    Control {
        /// Its index.
        index: usize,
        /// Its name without the heading's.
        label: String,
    },
}

/// Whole faces, then parts of the face from the large to the small. What is not here follows in the order of
/// the table.
const ORDER: [(&str, &str); 14] = [
    ("expression", "Expressions"),
    ("neck", "Neck"),
    ("head", "Head"),
    ("jaw", "Jaw"),
    ("mouth", "Mouth"),
    ("tongue", "Tongue"),
    ("gaze", "Gaze"),
    ("eye", "Eyes"),
    ("lid", "Lids"),
    ("brow", "Brows"),
    ("cheek", "Cheeks"),
    ("nose", "Nose"),
    ("viseme", "Visemes"),
    (SHAPES, "Shapes"),
];

const SHAPES: &str = "shapes";
const OTHERS: &str = "others";

/// The list for a search, without the controls of closed groups; a search opens all.
pub(crate) fn rows(controls: &ControlTable, query: &str, closed: &HashSet<String>) -> Vec<Row> {
    let wanted: Vec<String> = query.split_whitespace().map(str::to_lowercase).collect();
    let mut groups: Vec<(String, Vec<usize>)> = Vec::new();
    for (index, control) in controls.controls().iter().enumerate() {
        if !matches(control, &wanted) {
            continue;
        }
        let key = group(control);
        match groups.iter_mut().find(|(other, _)| *other == key) {
            Some((_, members)) => members.push(index),
            None => groups.push((key, vec![index])),
        }
    }
    groups.sort_by_key(|(key, _)| rank(key));
    let mut rows = Vec::new();
    for (key, members) in groups {
        let open = !wanted.is_empty() || !closed.contains(&key);
        rows.push(Row::Group { title: title(&key), count: members.len(), key });
        if open {
            let control = |index: usize| Row::Control { index, label: label(&controls.controls()[index]) };
            rows.extend(members.into_iter().map(control));
        }
    }
    rows
}

/// What the value of a control is counted in, with a sign and a word for it, and its decimals.
pub(crate) fn unit(control: &Control) -> (&'static str, &'static str, usize) {
    match control.drives {
        Drive::Joint { kind: JointMotion::Rotation, .. } => ("°", "degrees", 1),
        Drive::Joint { kind: JointMotion::Translation, .. } => ("", "units", 3),
        Drive::Shape { .. } => ("", "weight", 2),
    }
}

/// Every word of the search is a part of the control's name, of what it drives, or of its heading.
fn matches(control: &Control, wanted: &[String]) -> bool {
    let driven = match &control.drives {
        Drive::Joint { joint, .. } => joint,
        Drive::Shape { shape } => shape,
    };
    let group = control.group.as_deref().unwrap_or_default();
    let texts = [control.name.to_lowercase(), driven.to_lowercase(), group.to_lowercase()];
    wanted.iter().all(|word| texts.iter().any(|text| text.contains(word)))
}

/// What a control says itself; else what its name has before a dot; else, of a shape, the first word of its
/// name, if that is a part of the face: `browInnerUp`.
fn group(control: &Control) -> String {
    let named = control.group.as_deref().or(control.name.split_once('.').map(|(group, _)| group));
    match (named, &control.drives) {
        (Some(group), _) => singular(&group.to_lowercase()).to_owned(),
        (None, Drive::Joint { .. }) => OTHERS.to_owned(),
        (None, Drive::Shape { .. }) => {
            let end = control.name.find(|letter: char| !letter.is_lowercase());
            let word = singular(&control.name[..end.unwrap_or(control.name.len())]);
            let known = ORDER.iter().find(|(key, _)| *key == word);
            known.map_or(SHAPES, |(key, _)| key).to_owned()
        }
    }
}

/// `eyes.left` belongs to `eye.left`.
fn singular(group: &str) -> &str {
    let one = group.strip_suffix('s').unwrap_or(group);
    if ORDER.iter().any(|(key, _)| *key == one) { one } else { group }
}

fn rank(key: &str) -> usize {
    let known = ORDER.iter().position(|(other, _)| *other == key);
    known.unwrap_or(if key == OTHERS { ORDER.len() + 1 } else { ORDER.len() })
}

fn title(key: &str) -> String {
    if let Some((_, title)) = ORDER.iter().find(|(other, _)| *other == key) {
        return (*title).to_owned();
    }
    let mut letters = key.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

fn label(control: &Control) -> String {
    match control.name.split_once('.') {
        Some((_, rest)) if !rest.is_empty() => rest.replace('.', " "),
        _ => control.name.clone(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use pose_anim::Pace;

    fn table(names: &[&str]) -> ControlTable {
        let control = |name: &&str| Control {
            name: (*name).to_owned(),
            drives: Drive::Shape { shape: name.to_uppercase() },
            min: 0.0,
            max: 1.0,
            default: 0.0,
            pace: Pace::SHAPE,
            group: None,
        };
        ControlTable::new(names.iter().map(control).collect()).unwrap()
    }

    fn titles(rows: &[Row]) -> Vec<&str> {
        let mut titles = Vec::new();
        for row in rows {
            if let Row::Group { title, .. } = row {
                titles.push(title.as_str());
            }
        }
        titles
    }

    #[test]
    fn groups_stand_from_large_to_small_and_the_unknown_ones_after_them() {
        let table = table(&[
            "smile",
            "tail.wag",
            "ear.left",
            "lid.a",
            "Eyes.left",
            "eye.right",
            "jaw.open",
            "head.turn",
        ]);
        let rows = rows(&table, "", &HashSet::new());
        assert_eq!(titles(&rows), ["Head", "Jaw", "Eyes", "Lids", "Shapes", "Tail", "Ear"]);
        assert!(rows.contains(&Row::Group { key: "eye".to_owned(), title: "Eyes".to_owned(), count: 2 }));
    }

    #[test]
    fn shapes_stand_with_their_part_of_the_face() {
        let mut controls =
            table(&["smile", "browInnerUp", "mouthPucker", "tongueOut", "viseme_aa", "oh", "mouse"]);
        let names: Vec<_> = controls.names().map(str::to_owned).collect();
        let mut list = controls.controls().to_vec();
        list[5].group = Some("Visemes".to_owned());
        controls = ControlTable::new(list).unwrap();
        let all = rows(&controls, "", &HashSet::new());
        assert_eq!(titles(&all), ["Mouth", "Tongue", "Brows", "Visemes", "Shapes"]);
        let under = |title: &str| {
            let from =
                all.iter().position(|row| matches!(row, Row::Group { title: own, .. } if own == title));
            let members = all.iter().skip(from.unwrap() + 1).map_while(|row| match row {
                Row::Control { index, .. } => Some(names[*index].as_str()),
                Row::Group { .. } => None,
            });
            members.collect::<Vec<_>>()
        };
        assert_eq!(under("Visemes"), ["viseme_aa", "oh"]);
        assert_eq!(under("Shapes"), ["smile", "mouse"]);
        // The heading is searched, too.
        assert_eq!(titles(&rows(&controls, "visem oh", &HashSet::new())), ["Visemes"]);
    }

    #[test]
    fn a_search_takes_parts_of_words_in_any_case_and_order() {
        let table = table(&["brow.left.up", "brow.right.up", "lid.left"]);
        let closed = HashSet::from(["brow".to_owned()]);
        let found = |query: &str| {
            let rows = rows(&table, query, &closed);
            let control = |row: &Row| match row {
                Row::Control { index, .. } => Some(*index),
                Row::Group { .. } => None,
            };
            rows.iter().filter_map(control).collect::<Vec<_>>()
        };
        assert_eq!(found("EF bRo"), [0]);
        // Lids come before brows.
        assert_eq!(found("left"), [2, 0]);
        assert_eq!(found("left nose"), [0usize; 0]);
        assert_eq!(found(""), [2]);
    }
}
