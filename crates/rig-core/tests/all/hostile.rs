//! Files that were cut, damaged or made to hurt: an error in bounded time, never a panic.
#![allow(
    clippy::panic,
    clippy::unwrap_used,
    clippy::disallowed_methods,
    reason = "a test: it may panic and look at the clock"
)]

use crate::common::{IDENTITY, Random, error_of};
use rig_core::{MAX_DEPTH, Place, RawRig, Rig, XmlProblem};
use std::time::{Duration, Instant};

const SMALL: &str = r#"<?xml version="1.0"?>
<!-- grüße -->
<JointSet>
  <Joint name="Ä &amp; B" omit="true">
    <Matrix transposed="true"> 1 0 0 0  0 1 0 0  0 0 1 0 <![CDATA[ 1 2 3 1 ]]></Matrix>
    <Children><Joint name="C"><Matrix>1 0 0 0  0 1 0 0  0 0 1 0  0 0 0 &#49;</Matrix><Children/></Joint></Children>
  </Joint>
</JointSet>"#;

#[test]
fn cut_at_every_byte_is_an_error_with_a_place_inside_the_text() {
    assert_eq!(Rig::from_xml(SMALL.as_bytes()).unwrap().len(), 2);
    let lines = SMALL.lines().count();
    for end in 0..SMALL.len() {
        let error = error_of(&SMALL.as_bytes()[..end]);
        assert!((1..=lines).contains(&error.place.line), "{end}: {error}");
        match &error.problem {
            XmlProblem::Truncated { .. } | XmlProblem::NoJoint => {
                // Only whole characters can be read so far, and the end is the place.
                let (text, at_end) =
                    crate::common::marked(&format!("{}{}", &SMALL[..end], crate::common::MARK));
                assert_eq!((text.len(), error.place), (end, at_end), "{error}");
            }
            XmlProblem::Malformed(_) => {
                // A tag, comment or reference that lacks its end: the place is its beginning.
                let line = SMALL.lines().nth(error.place.line - 1).unwrap();
                let found = line.chars().nth(error.place.column - 1);
                assert!(matches!(found, Some('<' | '&')), "{end}: {error}, {found:?}");
            }
            XmlProblem::NotText(_) => assert!(!SMALL.is_char_boundary(end), "{end}: {error}"),
            problem => panic!("{end}: {problem}"),
        }
    }
}

#[test]
fn the_innermost_open_element_is_named() {
    for (cut, open) in [
        ("<JointSet>", "JointSet"),
        ("omit=\"true\">", "Joint"),
        ("transposed=\"true\">", "Matrix"),
        ("<Children>", "Children"),
        ("</Matrix>", "Joint"),
        ("</Joint>", "Children"),
    ] {
        let end = SMALL.find(cut).unwrap() + cut.len();
        let error = error_of(&SMALL.as_bytes()[..end]);
        assert_eq!(error.problem, XmlProblem::Truncated { open: open.to_owned() }, "{cut}");
    }
}

#[test]
fn rubbish_is_an_error() {
    let mut random = Random(1);
    for round in 0..3000 {
        let mut bytes: Vec<u8> = (0..random.below(300)).map(|_| random.next() as u8).collect();
        match round % 4 {
            0 => bytes.iter_mut().for_each(|byte| *byte &= 0x7F),
            1 => bytes.splice(0..0, [0xFF, 0xFE]).for_each(drop),
            2 => bytes.splice(0..0, *b"<?xml encoding='ISO-8859-1'?><JointSet>").for_each(drop),
            _ => {}
        }
        error_of(&bytes);
    }
}

/// A damaged byte may by luck give another valid file; then it must be a sane rig that can be written and
/// read.
#[test]
fn flipped_bytes_are_an_error_or_another_rig() {
    let mut random = Random(2);
    let mut rigs = 0;
    for _ in 0..20_000 {
        let mut bytes = SMALL.as_bytes().to_vec();
        for _ in 0..=random.below(3) {
            let at = random.below(bytes.len());
            bytes[at] ^= 1 << random.below(8);
        }
        match Rig::from_xml(&bytes) {
            Ok(rig) => {
                rigs += 1;
                assert!(rig.world_from_bind().iter().all(|w| w.is_finite()));
                let raw = RawRig::from_xml(&bytes).unwrap();
                if let Ok(text) = raw.to_xml() {
                    let again = RawRig::from_xml(text.as_bytes()).unwrap();
                    assert_eq!(crate::common::without_places(again), crate::common::without_places(raw));
                }
            }
            Err(error) => {
                assert!(error.place.line >= 1 && error.place.column >= 1 && !error.to_string().is_empty())
            }
        }
    }
    assert!(rigs > 100, "only {rigs} damaged files were still valid: the check above hardly ran");
}

#[test]
fn words_of_the_format_in_random_order_never_panic() {
    let words = [
        "<JointSet>",
        "</JointSet>",
        "<Joint name='a'>",
        "<Joint name='b'>",
        "<Joint>",
        "</Joint>",
        "<Matrix>",
        "</Matrix>",
        "<Children>",
        "</Children>",
        IDENTITY,
        "1 ",
        "<!--",
        "-->",
        "<![CDATA[",
        "]]>",
        "&#49;",
        "&",
        "<?",
        "?>",
        "<",
        ">",
        "<Matrix/>",
        "\r\n",
        "ä",
        "<!DOCTYPE a [",
        "]>",
    ];
    let mut random = Random(3);
    for _ in 0..20_000 {
        let text: String = (0..random.below(20)).map(|_| words[random.below(words.len())]).collect();
        let _ = Rig::from_xml(text.as_bytes());
    }
}

/// Generous for a slow machine without optimisation; quadratic work on these files would take hours.
const BOUND: Duration = Duration::from_secs(20);

fn bounded<T>(work: impl FnOnce() -> T) -> T {
    let start = Instant::now();
    let result = work();
    assert!(start.elapsed() < BOUND, "took {:?}", start.elapsed());
    result
}

#[test]
fn two_hundred_thousand_levels_of_joints_are_refused_at_the_first_too_many() {
    let mut text = String::from("<JointSet>\n");
    for level in 0..200_000 {
        text += &format!("<Joint name=\"j{level}\"><Matrix>{IDENTITY}</Matrix><Children>\n");
    }
    let limit = MAX_DEPTH;
    for closed in [false, true] {
        if closed {
            text += &"</Children></Joint>".repeat(200_000);
            text += "</JointSet>";
        }
        let error = bounded(|| error_of(text.as_bytes()));
        assert_eq!(error.problem, XmlProblem::TooDeep { limit });
        assert_eq!(error.place, Place { line: 2 + limit, column: 1 });
    }
}

#[test]
fn the_limit_of_levels_itself_is_allowed() {
    let nested = |levels: usize| {
        let open: String = (0..levels)
            .map(|level| format!("<Joint name='{level}'><Matrix>{IDENTITY}</Matrix><Children>"))
            .collect();
        format!("<JointSet>{open}{}</JointSet>", "</Children></Joint>".repeat(levels))
    };
    assert_eq!(Rig::from_xml(nested(MAX_DEPTH).as_bytes()).unwrap().len(), MAX_DEPTH);
    let limit = MAX_DEPTH;
    assert_eq!(error_of(nested(MAX_DEPTH + 1).as_bytes()).problem, XmlProblem::TooDeep { limit });
}

#[test]
fn two_hundred_thousand_levels_of_other_elements_are_refused_at_the_first() {
    for (name, start) in
        [("a", ""), ("JointSet", "<JointSet>"), ("Children", "<JointSet><Joint name='A'><Children>")]
    {
        let text =
            format!("{start}{}{}", format!("<{name}>").repeat(200_000), format!("</{name}>").repeat(200_000));
        let error = bounded(|| error_of(text.as_bytes()));
        assert!(
            matches!(&error.problem, XmlProblem::UnexpectedElement { found, .. } if found == name),
            "{error}"
        );
        assert_eq!(error.place, Place { line: 1, column: start.len() + 1 });
    }
}

#[test]
fn time_grows_with_the_size_of_the_file() {
    // Many joints side by side, each at a place of its own.
    let joints: String =
        (0..100_000).map(|i| format!("<Joint name='j{i}'>\n<Matrix>{IDENTITY}</Matrix></Joint>\n")).collect();
    let raw = bounded(|| RawRig::from_xml(format!("<JointSet>\n{joints}</JointSet>").as_bytes()).unwrap());
    assert_eq!(raw.joints.len(), 100_000);
    assert_eq!(raw.joints[99_999].place, Some(Place { line: 2 + 2 * 99_999, column: 1 }));
    assert_eq!(bounded(|| Rig::from_raw(&raw).unwrap()).len(), 100_000);

    // Many attributes, comments in a matrix, numbers in a matrix, entities in a name.
    let attributes: String = (0..100_000).map(|i| format!(" a{i}=''")).collect();
    let one = |attributes: &str, numbers: &str| {
        format!("<JointSet><Joint name='A'{attributes}><Matrix>{numbers}</Matrix></Joint></JointSet>")
    };
    bounded(|| Rig::from_xml(one(&attributes, IDENTITY).as_bytes()).unwrap());
    let comments = "<!-- -->".repeat(100_000) + IDENTITY;
    bounded(|| Rig::from_xml(one("", &comments).as_bytes()).unwrap());
    let error = bounded(|| error_of(one("", &"1 ".repeat(1_000_000)).as_bytes()));
    assert!(matches!(error.problem, XmlProblem::NumberCount { found: 1_000_000, .. }));
    let entity = format!("<!DOCTYPE a [<!ENTITY b '{}'>]><JointSet/>", "&b;".repeat(100_000));
    assert_eq!(bounded(|| error_of(entity.as_bytes())).problem, XmlProblem::NoJoint);
}
