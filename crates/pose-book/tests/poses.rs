//! Edits of poses, against a list that is edited the same way, and what stays of the text.
#![allow(clippy::expect_used, clippy::panic, reason = "a test may panic")]

use pose_anim::{ControlTable, DEFAULT_POSES_TOML, Easing, Pose, PoseSet, Timing};
use pose_book::{BookError, PoseBook};
use proptest::prelude::*;

const TEXT: &str = r#"# Poses of a friend.
# Do not lose this.

# A calm face.
[[pose]]
name = "calm" # as at home
key = "c"
duration = 1.50   # slowly
[pose.controls]
# The head first.
"head.turn" = 3.0 # a little
jaw.open = 1
smile = 0.2

[[pose]] # right here
name   =   'cross'
controls = { frown = 0.75, lid.left.upper = 2 }
timing.frown = { delay = 0.25 }

# The last one.
[[pose]]
name = "tail"
[pose.controls]
frown = 0.1 # end
# nothing below
"#;

fn controls() -> ControlTable {
    ControlTable::default_face()
}

fn book() -> PoseBook {
    PoseBook::read(TEXT, &controls()).expect("a book")
}

fn index(name: &str) -> usize {
    controls().index(name).expect("a control")
}

/// Comments of a text, in any order.
fn comments(text: &str) -> Vec<String> {
    let mut found: Vec<String> =
        text.lines().filter_map(|line| Some(line.split_once('#')?.1.trim().to_owned())).collect();
    found.sort();
    found
}

#[test]
fn an_edit_changes_its_lines_and_no_others() {
    let changed_lines = |book: &PoseBook| -> Vec<String> {
        book.text().lines().filter(|line| !TEXT.lines().any(|old| old == *line)).map(str::to_owned).collect()
    };
    let mut book = book();
    book.rename(1, "angry").expect("renamed");
    assert_eq!(changed_lines(&book), ["name   =   \"angry\""]);
    assert_eq!(book.text().lines().count(), TEXT.lines().count());
    book.undo();
    let values = [(index("head.turn"), 4.5), (index("jaw.open"), 1.0), (index("smile"), 0.2)];
    book.set_values(0, &values).expect("set");
    assert_eq!(changed_lines(&book), ["\"head.turn\" = 4.5 # a little"]);
    book.undo();
    book.describe(0, "calm", Some("x"), None).expect("described");
    assert_eq!(changed_lines(&book), ["key = \"x\""]);
    assert!(!book.text().contains("duration"));
    book.undo();
    assert_eq!(book.text(), TEXT);
}

#[test]
fn entries_take_their_comments_along_and_the_head_stays() {
    let mut book = book();
    book.move_to(0, 2).expect("moved");
    let names: Vec<&str> = book.poses().iter().map(|pose| pose.name.as_str()).collect();
    assert_eq!(names, ["cross", "tail", "calm"]);
    assert!(book.text().starts_with("# Poses of a friend.\n# Do not lose this.\n\n[[pose]] # right here"));
    assert!(book.text().contains("\n# A calm face.\n[[pose]]\nname = \"calm\" # as at home"));
    assert!(book.text().ends_with("# nothing below\n"), "{}", book.text());
    assert_eq!(comments(book.text()), comments(TEXT));
    for _ in 0..3 {
        book.remove(0).expect("removed");
    }
    assert!(book.text().starts_with("# Poses of a friend.\n# Do not lose this.\n"), "{}", book.text());
    assert!(book.text().contains("# nothing below"));
    assert!(book.poses().poses.is_empty());
    book.add(&Pose::new("first", vec![])).expect("added to nothing");
    assert_eq!(book.poses().poses.len(), 1);
    (0..5).for_each(|_| assert!(book.undo().is_some()));
    assert_eq!(book.text(), TEXT);
    assert_eq!(book.undo(), None);
    (0..5).for_each(|_| assert!(book.redo().is_some()));
    assert_eq!(book.redo(), None);
    assert_eq!(book.poses().poses[0].name, "first");
}

#[test]
fn what_the_format_refuses_is_refused_and_changes_nothing() {
    let mut book = book();
    let refused =
        |book: &mut PoseBook, edit: &dyn Fn(&mut PoseBook) -> Result<(), BookError>, words: &str| {
            let error = edit(book).expect_err("refused").to_string();
            assert!(error.contains(words), "{error}");
            assert_eq!((book.text(), book.can_undo()), (TEXT, None));
        };
    refused(&mut book, &|book| book.rename(1, "calm"), "unique names");
    refused(&mut book, &|book| book.describe(1, "cross", Some("c"), None), "a key of its own");
    refused(&mut book, &|book| book.describe(1, "cross", None, Some(-1.0)), "seconds");
    refused(&mut book, &|book| book.set_values(1, &[(index("smile"), 7.0)]), "0 to 1");
    refused(&mut book, &|book| book.set_values(1, &[(index("smile"), f32::NAN)]), "number");
    refused(&mut book, &|book| book.set_values(1, &[(usize::MAX, 0.0)]), "controls");
    refused(&mut book, &|book| book.remove(3), "below 3, found 3");
    refused(&mut book, &|book| book.move_to(0, 3), "below 3, found 3");
    refused(&mut book, &|book| book.add(&Pose::new("calm", vec![])).map(|_| ()), "unique names");
    assert!(matches!(book.replace("pose = 3"), Err(BookError::Text(_))));
    assert_eq!(book.text(), TEXT);
}

#[test]
fn a_text_from_elsewhere_takes_the_place_and_the_same_one_does_not() {
    let mut book = book();
    book.remove(0).expect("removed");
    let own = book.text().to_owned();
    book.replace(&own).expect("the same");
    assert_eq!(book.can_undo(), Some("delete calm"));
    book.replace(TEXT).expect("another");
    assert_eq!(book.can_undo(), None);
    assert_eq!(book.poses().poses.len(), 3);
}

#[test]
fn the_usual_poses_keep_their_comments_and_others_get_a_text_that_says_the_same() {
    let controls = controls();
    let usual = PoseSet::default_face(&controls);
    let mut book = PoseBook::of_set(&usual, &controls).expect("a book");
    assert_eq!(*book.poses(), usual);
    // The text as it is, but for the poses that this face cannot take; their names and keys are free.
    let start = DEFAULT_POSES_TOML.find("[[pose]]\nname = \"kiss\"").expect("a pose of shapes");
    assert!(book.text().starts_with(&DEFAULT_POSES_TOML[..start]));
    assert!(!book.text().contains("kiss") && book.text().contains("\"oh\""));
    let mut kiss = Pose::new("kiss", vec![(0, 1.0)]);
    kiss.key = Some("m".to_owned());
    book.add(&kiss).expect("added");
    let mut set = PoseSet::default();
    let bezier = Easing::Bezier([0.3, -2.0, 0.1, 1.5]);
    set.poses.push(
        Pose::new("a", vec![(index("head.bow"), 0.1), (index("smile"), 0.3)]).lasting(0.7).along(bezier),
    );
    set.poses.push(
        Pose::new("b \"quoted\" = #", vec![])
            .along(Easing::from_name("bounce-in-out").expect("a name"))
            .timed(index("smile"), Timing { delay_secs: 0.1, factor: 2.5 }),
    );
    let book = PoseBook::of_set(&set, &controls).expect("a book");
    assert_eq!(*book.poses(), set);
}

/// A text may have poses that the face cannot take: edits meet those that they are about.
#[test]
fn poses_that_the_face_cannot_take_stay_where_they_are() {
    let pose = |name: &str, table: &str| format!("[[pose]]\nname = \"{name}\"\n[pose.{table}]\nsmile = 1\n");
    let wings = "[[pose]]\nname = \"wings\"\n[pose.shapes]\nwings = 1\n";
    let text = [
        wings.to_owned(),
        pose("a", "controls"),
        wings.replace("\"wings\"", "\"more\""),
        pose("b", "shapes"),
    ];
    let mut book = PoseBook::read(&text.join("\n"), &controls()).expect("a book");
    let names = |book: &PoseBook| -> Vec<String> {
        let lines = book.text().lines().filter_map(|line| line.strip_prefix("name = "));
        lines.map(|name| name.trim_matches('"').to_owned()).collect()
    };
    book.rename(0, "c").expect("renamed");
    assert_eq!(names(&book), ["wings", "c", "more", "b"]);
    book.move_to(1, 0).expect("moved");
    assert_eq!(names(&book), ["wings", "b", "c", "more"]);
    // What is set takes the place of both tables.
    book.set_values(0, &[(index("frown"), 0.5)]).expect("set");
    assert_eq!(book.poses().poses[0].values, [(index("frown"), 0.5)]);
    assert!(book.text().contains("[pose.controls]\nfrown = 0.5"), "{}", book.text());
    book.remove(0).expect("removed");
    assert_eq!(names(&book), ["wings", "c", "more"]);
}

/// A pose that says what all others do no longer says it once it is set to some controls.
#[test]
fn what_is_set_are_these_controls_and_no_others() {
    let controls = controls();
    let mut book = PoseBook::read(DEFAULT_POSES_TOML, &controls).expect("a book");
    book.set_values(0, &[(index("smile"), 0.5)]).expect("set");
    assert_eq!(book.poses().poses[0].values, [(index("smile"), 0.5)]);
    assert_eq!(book.poses().poses[1].values.len(), controls.len());
}

#[test]
fn line_ends_of_windows_are_read() {
    let text = TEXT.replace('\n', "\r\n");
    let mut book = PoseBook::read(&text, &controls()).expect("a book");
    book.move_to(2, 0).expect("moved");
    assert_eq!(book.poses().poses[0].name, "tail");
    assert_eq!(comments(book.text()), comments(&text));
    book.undo();
    assert_eq!(book.text(), text);
}

#[derive(Clone, Debug)]
enum Edit {
    Add(u8, Vec<f32>),
    Rename(usize, u8),
    Describe(usize, u8, Option<u8>, Option<f64>),
    Values(usize, Vec<f32>),
    Move(usize, usize),
    Remove(usize),
    Undo,
    Redo,
}

fn edits() -> impl Strategy<Value = Vec<Edit>> {
    let values = || prop::collection::vec(0.0..1.0f32, 0..4);
    let one = prop_oneof![
        (any::<u8>(), values()).prop_map(|(name, values)| Edit::Add(name, values)),
        (0..6usize, 0..4u8).prop_map(|(index, name)| Edit::Rename(index, name)),
        (0..6usize, 0..9u8, prop::option::of(0..4u8), prop::option::of(0.1..3.0f64))
            .prop_map(|(index, name, key, secs)| Edit::Describe(index, name, key, secs)),
        (0..6usize, values()).prop_map(|(index, values)| Edit::Values(index, values)),
        (0..6usize, 0..6usize).prop_map(|(from, to)| Edit::Move(from, to)),
        (0..6usize).prop_map(Edit::Remove),
        Just(Edit::Undo),
        Just(Edit::Redo),
    ];
    prop::collection::vec(one, 0..25)
}

/// Values between 0 and 1 for the first controls from the end: those are weights.
fn weights(values: &[f32]) -> Vec<(usize, f32)> {
    let last = controls().controls().len() - 1;
    values.iter().take(2).enumerate().map(|(k, value)| (last - k, *value)).collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    /// The same edits of a plain list: what a person sees in the file is what the list says, in every step.
    #[test]
    fn a_book_is_a_list_with_undo(edits in edits()) {
        let mut book = book();
        let mut list: Vec<Pose> = book.poses().poses.clone();
        let (mut undo, mut redo): (Vec<Vec<Pose>>, Vec<Vec<Pose>>) = (vec![], vec![]);
        for edit in edits {
            let before = list.clone();
            let named = |name: u8| format!("pose {name}");
            let done = match &edit {
                Edit::Add(name, values) => {
                    list.push(Pose::new(named(*name), weights(values)));
                    book.add(&list[list.len() - 1]).is_ok()
                }
                Edit::Rename(index, name) => {
                    if let Some(pose) = list.get_mut(*index) { pose.name = named(*name) }
                    book.rename(*index, &named(*name)).is_ok()
                }
                Edit::Describe(index, name, key, secs) => {
                    let key = key.map(|key| format!("F{key}"));
                    if let Some(pose) = list.get_mut(*index) {
                        (pose.name, pose.key, pose.duration_secs) = (named(*name), key.clone(), *secs);
                    }
                    book.describe(*index, &named(*name), key.as_deref(), *secs).is_ok()
                }
                Edit::Values(index, values) => {
                    if let Some(pose) = list.get_mut(*index) { pose.values = weights(values) }
                    book.set_values(*index, &weights(values)).is_ok()
                }
                Edit::Move(from, to) if *from < list.len() && *to < list.len() => {
                    let pose = list.remove(*from);
                    list.insert(*to, pose);
                    book.move_to(*from, *to).is_ok()
                }
                Edit::Move(from, to) => book.move_to(*from, *to).is_ok(),
                Edit::Remove(index) => {
                    if *index < list.len() { list.remove(*index); }
                    book.remove(*index).is_ok()
                }
                Edit::Undo => {
                    prop_assert_eq!(book.undo().is_some(), !undo.is_empty());
                    if let Some(earlier) = undo.pop() { redo.push(std::mem::replace(&mut list, earlier)); }
                    true
                }
                Edit::Redo => {
                    prop_assert_eq!(book.redo().is_some(), !redo.is_empty());
                    if let Some(later) = redo.pop() { undo.push(std::mem::replace(&mut list, later)); }
                    true
                }
            };
            let same_names = (1..list.len()).any(|k| list[..k].iter().any(|other| other.name == list[k].name));
            let same_keys = (1..list.len())
                .any(|k| list[k].key.is_some() && list[..k].iter().any(|other| other.key == list[k].key));
            if !done {
                list = before;
            } else {
                prop_assert!(!same_names && !same_keys, "{:?} was to be refused", edit);
                if !matches!(edit, Edit::Undo | Edit::Redo) && sorted(&list) != sorted(&before) {
                    undo.push(before);
                    redo.clear();
                }
            }
            prop_assert_eq!(sorted(&book.poses().poses), sorted(&list));
            prop_assert_eq!(&PoseSet::from_toml(book.text(), &controls()).expect("valid"), book.poses());
            prop_assert!(book.text().contains("# Do not lose this."));
        }
        while book.undo().is_some() {}
        prop_assert_eq!(book.text(), TEXT);
    }
}

/// The order of a pose's values follows the file and has no meaning.
fn sorted(poses: &[Pose]) -> Vec<Pose> {
    let mut poses = poses.to_vec();
    poses.iter_mut().for_each(|pose| pose.values.sort_by_key(|(control, _)| *control));
    poses
}
