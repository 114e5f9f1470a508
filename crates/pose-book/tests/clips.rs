//! Edits of clips, and what stays of the text.
#![allow(clippy::expect_used, clippy::panic, reason = "a test may panic")]

use pose_anim::{Clip, ClipSet, ControlTable, Easing, Key, Track, Transition, Wrap};
use pose_book::{BookError, ClipBook};

const TEXT: &str = r#"# My clips.

[[clip]]
name = "nod"
key = "n" # for yes
[clip.tracks]
# Down and up.
"head.bow" = [
    { t = 0.0, v = 0, transition = "sine-in-out" }, # from rest
    { t = 0.5, v = 14, slopes = [0, 0.5] },
    { t = 1.0, v = 0 },
]
# With joy.
smile = [ { t = 0, v = 0.5 } ]

# Blinks.
[[clip]]
name = "blink"
[clip.tracks]
"lid.left.upper" = [ { t = 0, v = 0 }, { t = 0.1, v = 10, transition = [0.1, 0, 0.2, 1] }, { t = 0.2, v = 0 } ]
"#;

fn controls() -> ControlTable {
    ControlTable::default_face()
}

fn index(name: &str) -> usize {
    controls().index(name).expect("a control")
}

#[test]
fn a_key_baked_moved_and_taken_away_leaves_everything_else_as_it_is_written() {
    let mut book = ClipBook::read(TEXT, &controls()).expect("a book");
    let mut clip = book.clips().clips[0].clone();
    let before = clip.clone();
    let bow = clip.track_mut(index("head.bow")).expect("a track");
    bow.bake(0.2).expect("baked");
    book.set(0, &clip, "insert a key").expect("set");
    for kept in [
        "# My clips.",
        "# for yes",
        "# Down and up.",
        "# With joy.\nsmile = [ { t = 0, v = 0.5 } ]",
        "# Blinks.",
    ] {
        assert!(book.text().contains(kept), "{kept} in {}", book.text());
    }
    let written = &book.clips().clips[0];
    assert_eq!(written.track(index("head.bow")).expect("a track").keys().len(), 4);
    // Values are kept at 32 bits.
    for k in 0..=100 {
        let at = |clip: &Clip| clip.at(index("head.bow"), f64::from(k) * 0.01).expect("a state").value;
        assert!((at(written) - at(&before)).abs() < 2e-6, "at {k}: {} and {}", at(written), at(&before));
    }
    assert_eq!(book.undo(), Some("insert a key".to_owned()));
    assert_eq!(book.text(), TEXT);
}

#[test]
fn every_kind_of_transition_and_end_is_written_and_read_as_it_is() {
    let names = Easing::names();
    let transitions = names
        .iter()
        .filter_map(|name| Easing::from_name(name))
        .chain([Easing::Bezier([0.25, -3.5, 0.5, 1.125])])
        .flat_map(|easing| {
            [Transition::Ease(easing), Transition::Part { easing, from: 0.125, to: 0.7, rise: -0.3 }]
        })
        .chain([Transition::Hermite { leaving: 0.1, arriving: -2.0 }]);
    let keys: Vec<Key> = transitions
        .enumerate()
        .map(|(k, transition)| Key {
            time_secs: k as f64 / 30.0,
            value: f64::from(0.01f32 * k as f32),
            transition,
        })
        .collect();
    let track = Track::new(index("smile"), keys).expect("a track");
    let mut set = ClipSet::default();
    for (name, wrap) in [("a", Wrap::Once), ("b", Wrap::Loop), ("c", Wrap::PingPong)] {
        set.clips.push(Clip::new(name, vec![track.clone()]).expect("a clip").wrapped(wrap));
    }
    let book = ClipBook::of_set(&set, &controls()).expect("a book");
    assert_eq!(*book.clips(), set, "{}", book.text());
}

#[test]
fn clips_come_and_go_and_what_the_format_refuses_changes_nothing() {
    let mut book = ClipBook::read("", &controls()).expect("an empty book");
    let track = Track::new(index("smile"), vec![Key::new(0.0, 0.5, Easing::Linear)]).expect("a track");
    let clip = Clip::new("one", vec![track]).expect("a clip");
    assert_eq!(book.add(&clip).expect("added"), 0);
    let text = book.text().to_owned();
    assert!(matches!(book.add(&clip), Err(BookError::Refused { .. })));
    let far = Track::new(index("smile"), vec![Key::new(0.0, 1.5, Easing::Linear)]).expect("a track");
    let beyond = Clip::new("beyond", vec![far]).expect("a clip");
    assert!(book.add(&beyond).expect_err("beyond its control").to_string().contains("add beyond"));
    assert!(book.set(1, &clip, "set").is_err());
    assert!(book.remove(1).is_err());
    assert_eq!(book.text(), text);
    book.set(0, &clip.clone().wrapped(Wrap::Loop), "loop").expect("set");
    assert_eq!(book.clips().clips[0].wrap, Wrap::Loop);
    book.remove(0).expect("removed");
    assert_eq!(book.text().trim(), "");
    assert_eq!((book.can_undo(), book.can_redo()), (Some("delete one"), None));
    book.undo();
    book.undo();
    assert_eq!((book.text(), book.can_redo()), (text.as_str(), Some("loop")));
    book.redo();
    assert_eq!(book.clips().clips[0].wrap, Wrap::Loop);
}
