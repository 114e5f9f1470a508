//! Files that are not as the format demands: which error, and at which line and column.
#![allow(clippy::panic, clippy::unwrap_used, reason = "a test may panic")]

use crate::common::{IDENTITY, fails, malformed};
use rig_core::{MAX_NAME_BYTES, Place, RigError, XmlProblem};

/// A joint named A with this inside, on lines 2 to 4.
fn joint(inside: &str) -> String {
    format!("<JointSet>\n  <Joint name=\"A\">\n    {inside}\n  </Joint>\n</JointSet>\n")
}

fn matrix(numbers: &str) -> String {
    joint(&format!("<Matrix>{numbers}</Matrix>"))
}

fn unexpected(found: &str, expected: &'static str) -> XmlProblem {
    XmlProblem::UnexpectedElement { found: found.to_owned(), expected }
}

fn text(found: &str, expected: &'static str) -> XmlProblem {
    XmlProblem::UnexpectedText { found: found.to_owned(), expected }
}

#[test]
fn a_wrong_element_is_named_with_what_may_stand_there() {
    fails("\n ¦<Rig/>", &unexpected("Rig", "<JointSet>"));
    fails("¦<Joint name=\"A\"/>", &unexpected("Joint", "<JointSet>"));
    fails("¦<jointset/>", &unexpected("jointset", "<JointSet>"));
    fails("<JointSet>\n¦<Matrix/></JointSet>", &unexpected("Matrix", "<Joint>"));
    fails(
        "<JointSet><Joint name='A'>¦<Bone/></Joint></JointSet>",
        &unexpected("Bone", "<Matrix> or <Children>"),
    );
    fails(&joint("¦<Joint name='B'/>"), &unexpected("Joint", "<Matrix> or <Children>"));
    fails(&matrix(&format!("{IDENTITY} ¦<Row/>")), &unexpected("Row", "16 numbers"));
    fails(
        &joint(&format!("<Matrix>{IDENTITY}</Matrix><Children>\n¦<x:Joint/></Children>")),
        &unexpected("x:Joint", "<Joint>"),
    );
    let whole = matrix(IDENTITY);
    fails(&format!("{whole}¦<JointSet/>"), &unexpected("JointSet", "the end of the file"));
    fails("<JointSet/>¦<JointSet/>", &unexpected("JointSet", "the end of the file"));
}

#[test]
fn text_between_elements_is_quoted() {
    fails("¦hello world <JointSet/>", &text("hello", "<JointSet>"));
    fails("<JointSet>\n\n  ¦1,2 3</JointSet>", &text("1,2", "<Joint>"));
    fails("<JointSet><![CDATA[ ¦cdata]]></JointSet>", &text("cdata", "<Joint>"));
    fails("<JointSet>¦&lt;</JointSet>", &text("<", "<Joint>"));
    fails(&joint("ä ¦").replace("ä ¦", "¦ä"), &text("ä", "<Matrix> or <Children>"));
    fails(
        &joint(&format!("<Matrix>{IDENTITY}</Matrix>;¦").replace(";¦", "¦;")),
        &text(";", "<Matrix> or <Children>"),
    );
    fails(&joint(&format!("<Matrix>{IDENTITY}</Matrix><Children>¦x</Children>")), &text("x", "<Joint>"));
    fails(&format!("{}\n ¦tail", matrix(IDENTITY)), &text("tail", "the end of the file"));
    let long = "x".repeat(1000);
    fails(&format!("¦{long}"), &text(&long[..40], "<JointSet>"));
}

#[test]
fn a_matrix_has_sixteen_numbers() {
    for (numbers, found) in [("", 0), (" \n ", 0), ("1", 1), (&IDENTITY[..IDENTITY.len() - 1], 15)] {
        let problem = XmlProblem::NumberCount { joint: "A".to_owned(), found };
        fails(&joint(&format!("¦<Matrix>{numbers}</Matrix>")), &problem);
    }
    for found in [17, 32, 1000] {
        let problem = XmlProblem::NumberCount { joint: "A".to_owned(), found };
        fails(&joint(&format!("¦<Matrix>{}</Matrix>", "1 ".repeat(found))), &problem);
    }
    fails(&joint("¦<Matrix/>"), &XmlProblem::NumberCount { joint: "A".to_owned(), found: 0 });
}

#[test]
fn a_word_for_a_number_is_quoted_at_its_place() {
    let words = [
        "one", "1,5", "0x10", "1f", "--1", "1e", "NaN", "nan", "inf", "-inf", "infinity", "1e999", "-1e39",
        "1_0", "½",
    ];
    for word in words {
        let problem = XmlProblem::NotANumber { joint: "A".to_owned(), found: word.to_owned() };
        fails(&matrix(&format!("¦{word} {IDENTITY}")), &problem);
        fails(&matrix(&format!("1 0 0 0\n  0 1 0\t ¦{word} {IDENTITY}")), &problem);
        fails(&matrix(&format!("1 0 0 0\r\n  0 1 0\r\n ¦{word} {IDENTITY}")), &problem);
        fails(&matrix(&format!("1 0 <!-- ä\n --> 0 0 ¦{word}\n{IDENTITY}")), &problem);
        fails(&matrix(&format!("1 <![CDATA[0 ¦{word}]]> {IDENTITY}")), &problem);
        fails(&matrix(&format!("1&#10;0 <?x y?>¦{word}")), &problem);
    }
    // A reference in the middle glues its neighbours to one word, which begins where its first letter stands.
    let glued = XmlProblem::NotANumber { joint: "A".to_owned(), found: "1<2".to_owned() };
    fails(&matrix(&format!("{IDENTITY} ¦1&lt;2")), &glued);
    // The first word that is wrong counts, whatever follows, and long ones are cut.
    let long = "z".repeat(100);
    let problem = XmlProblem::NotANumber { joint: "A".to_owned(), found: long[..40].to_owned() };
    fails(&matrix(&format!("1 ¦{long} nan")), &problem);
}

#[test]
fn the_largest_and_smallest_numbers_are_read() {
    let numbers = format!("1 0 0 {}  0 1 0 {}  0 0 1 {}  0 0 0 1", "1e18", "-1e-45", "+.5");
    let rig = rig_core::Rig::from_xml(matrix(&numbers).as_bytes()).unwrap();
    assert_eq!(rig.parent_from_joint()[0].translation.to_array(), [1e18, -f32::from_bits(1), 0.5]);
}

#[test]
fn names_are_there_and_unique() {
    for attributes in ["", " omit=\"true\"", " name=\"\"", " name=\" \n\"", " Name=\"A\"", " x:name='A'"] {
        fails(&format!("<JointSet>\n ¦<Joint{attributes}/></JointSet>"), &XmlProblem::MissingName);
    }
    let matrix = format!("<Matrix>{IDENTITY}</Matrix>");
    let first = Place { line: 2, column: 3 };
    let problem = XmlProblem::DuplicateName { name: "Ä&B".to_owned(), first };
    fails(
        &format!(
            "<JointSet>\n  <Joint name='Ä&amp;B'>{matrix}</Joint>\n<Joint name='C'>{matrix}</Joint> ¦<Joint name='&#xC4;&#38;B'/></JointSet>"
        ),
        &problem,
    );
    // As the descendant of its namesake, too.
    fails(
        &format!(
            "<JointSet>\n  <Joint name='Ä&amp;B'>{matrix}<Children>\n ¦<Joint name='Ä&amp;B'/></Children></Joint></JointSet>"
        ),
        &problem,
    );
    let found = MAX_NAME_BYTES + 1;
    let problem = XmlProblem::NameTooLong { limit: MAX_NAME_BYTES, found };
    fails(&format!("<JointSet>¦<Joint name='{}'/></JointSet>", "n".repeat(found)), &problem);
}

#[test]
fn every_joint_has_one_matrix_and_at_most_one_list_of_children() {
    let matrix = format!("<Matrix>{IDENTITY}</Matrix>");
    let missing = XmlProblem::MissingMatrix { joint: "A".to_owned() };
    let repeated = |element| XmlProblem::Repeated { joint: "A".to_owned(), element };
    fails("<JointSet>\n <!-- --> ¦<Joint name='A'/></JointSet>", &missing);
    fails("<JointSet>\n ¦<Joint name='A'><Children/></Joint></JointSet>", &missing);
    // The joint stands before its children, whose matrices are no substitute.
    let child = format!("<Children><Joint name='B'>{matrix}</Joint></Children>");
    fails(&format!("<JointSet>¦<Joint name='A'>{child}</Joint></JointSet>"), &missing);
    fails(&joint(&format!("{matrix}\n¦{matrix}")), &repeated("Matrix"));
    fails(&joint(&format!("{matrix}<Children/>¦{matrix}")), &repeated("Matrix"));
    fails(&joint(&format!("{matrix}<Children/>\n ¦<Children/>")), &repeated("Children"));
    fails(&joint(&format!("{child}{matrix}¦<Children/>")), &repeated("Children"));
}

#[test]
fn a_file_without_joints_is_an_error_at_its_end() {
    for text in [
        "¦",
        " \n\n  ¦",
        "\n<JointSet/>¦",
        "<JointSet>\n</JointSet>\n¦",
        "<?xml version=\"1.0\"?>\n<!-- -->¦",
    ] {
        fails(text, &XmlProblem::NoJoint);
    }
}

#[test]
fn flags_are_true_or_false() {
    for found in ["yes", "TRUE", "", "2"] {
        let problem = |attribute| XmlProblem::NotABoolean { attribute, found: found.to_owned() };
        fails(&joint(&format!("¦<Matrix transposed='{found}'>{IDENTITY}</Matrix>")), &problem("transposed"));
        fails(&format!("<JointSet> ¦<Joint name='A' omit='{found}'/></JointSet>"), &problem("omit"));
    }
}

#[test]
fn what_is_no_xml_is_refused_where_it_breaks() {
    malformed(&joint("<Matrix>¦</Children>"), "expected `</Matrix>`");
    malformed("¦</JointSet>", "JointSet");
    malformed("<JointSet>¦&nosuch;</JointSet>", "nosuch");
    malformed(&matrix(&format!("{IDENTITY} ¦&#0;")), "invalid character reference");
    malformed(&matrix("¦& 1"), "reference not closed");
    malformed("<JointSet>¦<Joint name='A' name='B'/></JointSet>", "duplicate");
    malformed("<JointSet>¦<Joint name='A' omit='true' omit='true'/></JointSet>", "duplicate");
    malformed("¦<JointSet a='1' a='2'/>", "duplicate");
    malformed("<JointSet>¦<Joint name='A' omit/></JointSet>", "attribute");
    malformed("<JointSet>¦<Joint name=A/></JointSet>", "attribute value must be enclosed");
    malformed(&joint(&format!("<Matrix>{IDENTITY}</Matrix>¦<Children =/>")), "attribute");
    malformed("<JointSet>¦<Joint name='&broken;'/></JointSet>", "broken");
    malformed("\n¦<!-- no end", "omment");
    malformed("<JointSet>\n ¦<![CDATA[ no end", "CDATA");
    malformed("¦<!DOCTYPE no end", "DOCTYPE");
    malformed("¦<?pi no end", "rocessing instruction");
}

#[test]
fn what_is_no_rigid_matrix_is_refused_at_its_joint() {
    let cases = [
        // Mirrored, halved, sheared, turned and scaled along one axis, projective.
        ("-1 0 0 0  0 1 0 0  0 0 1 0  0 0 0 1", "the handedness (determinant)", 2.0),
        ("0 1 0 0  1 0 0 0  0 0 1 0  0 0 0 1", "the handedness (determinant)", 2.0),
        ("0.5 0 0 0  0 0.5 0 0  0 0 0.5 0  0 0 0 1", "the lengths and right angles of the axes", 0.75),
        ("1 0.25 0 0  0 1 0 0  0 0 1 0  0 0 0 1", "the lengths and right angles of the axes", 0.25),
        ("0 -2 0 0  1 0 0 0  0 0 1 0  0 0 0 1", "the lengths and right angles of the axes", 3.0),
        ("0 0 0 0  0 0 0 0  0 0 0 0  0 0 0 1", "the lengths and right angles of the axes", 1.0),
        ("1 0 0 0  0 1 0 0  0 0 1 0  0 0 0.5 1", "the last row", 0.5),
        ("1 0 0 0  0 1 0 0  0 0 1 0  0 0 0 0", "the last row", 1.0),
        // The transposed text of a translation, without the attribute.
        ("1 0 0 0  0 1 0 0  0 0 1 0  3 -14 2 1", "the last row", 14.0),
    ];
    for (numbers, what, deviation) in cases {
        let rig = RigError::NotRigid { joint: "A".to_owned(), what, deviation, tolerance: 1e-3 };
        let text = matrix(numbers).replace("<Joint n", "¦<Joint n");
        fails(&text, &XmlProblem::Rig(rig));
        // The editable form takes it, so that it can be mended.
        assert!(rig_core::RawRig::from_xml(crate::common::marked(&text).0.as_bytes()).is_ok());
    }
    let huge = matrix("3e38 3e38 0 0  3e38 -3e38 0 0  0 0 3e38 0  0 0 0 1").replace("<Joint n", "¦<Joint n");
    let (xml, place) = crate::common::marked(&huge);
    let error = crate::common::error_of(xml.as_bytes());
    assert_eq!(error.place, place);
    assert!(
        matches!(error.problem, XmlProblem::Rig(RigError::NotRigid { deviation, .. }) if deviation == f32::INFINITY)
    );
}

#[test]
fn rigidity_has_a_tolerance_of_a_thousandth() {
    // 2 s + s² is how far the squared length of an axis of length 1 + s is off.
    let scaled = |s: f64| matrix(&format!("{} 0 0 0  0 1 0 0  0 0 1 0  0 0 0 1", 1.0 + s));
    for s in [0.000_499, -0.000_499, 0.0] {
        assert!(rig_core::Rig::from_xml(scaled(s).as_bytes()).is_ok(), "{s}");
    }
    for s in [0.000_501, -0.000_501] {
        let error = crate::common::error_of(scaled(s).as_bytes());
        assert!(matches!(error.problem, XmlProblem::Rig(RigError::NotRigid { .. })), "{s}: {error}");
    }
    for (row, good) in
        [("0.00099 -0.00099 0 1.00099", true), ("0 0.00101 0 1", false), ("0 0 0 0.99899", false)]
    {
        let text = matrix(&format!("1 0 0 0  0 1 0 0  0 0 1 0  {row}"));
        assert_eq!(rig_core::Rig::from_xml(text.as_bytes()).is_ok(), good, "{row}");
    }
}

#[test]
fn a_translation_that_leaves_no_room_is_refused() {
    let far = matrix("1 0 0 0  0 1 0 -2e18  0 0 1 0  0 0 0 1").replace("<Joint n", "¦<Joint n");
    let rig = RigError::TooFar { joint: "A".to_owned(), found: -2e18, limit: 1e18 };
    fails(&far, &XmlProblem::Rig(rig));
}
