//! All the shapes that XML gives the same content: encodings, comments, line ends, references, layouts.
#![allow(clippy::panic, clippy::unwrap_used, reason = "a test may panic")]

use crate::common::{IDENTITY, without_places};
use rig_core::{MatrixLayout, Place, RawRig, XmlError, XmlProblem};

/// Two joints; the numbers of the first are all different, so that no mix-up goes unseen.
const PLAIN: &str = r#"<JointSet>
  <Joint name="Höcker">
    <Matrix> 0 -1 0 1.5   1 0 0 -2.25   0 0 1 3   0 0 0 1 </Matrix>
    <Children>
      <Joint name="B" omit="true"><Matrix transposed="true"> 1 0 0 0   0 0 1 0   0 -1 0 0   4 5 6 1 </Matrix></Joint>
    </Children>
  </Joint>
</JointSet>
"#;

fn read(bytes: &[u8]) -> RawRig {
    without_places(RawRig::from_xml(bytes).unwrap_or_else(|error| panic!("{error}")))
}

#[test]
fn everything_is_read_as_it_stands() {
    let raw = RawRig::from_xml(PLAIN.as_bytes()).unwrap();
    let [a, b] = &raw.joints[..] else { panic!("{raw:?}") };
    assert_eq!((a.name.as_str(), a.parent.as_deref(), a.omit), ("Höcker", None, false));
    assert_eq!((b.name.as_str(), b.parent.as_deref(), b.omit), ("B", Some("Höcker"), true));
    assert_eq!((a.layout, b.layout), (MatrixLayout::RowByRow, MatrixLayout::Transposed));
    assert_eq!(a.place, Some(Place { line: 2, column: 3 }));
    assert_eq!(b.place, Some(Place { line: 5, column: 7 }));
    // Columns of the first: R e_x = e_y, R e_y = -e_x, translation last.
    let columns = [[0., 1., 0., 0.], [-1., 0., 0., 0.], [0., 0., 1., 0.], [1.5, -2.25, 3., 1.]];
    assert_eq!(a.parent_from_joint.to_cols_array_2d(), columns);
    let columns = [[1., 0., 0., 0.], [0., 0., 1., 0.], [0., -1., 0., 0.], [4., 5., 6., 1.]];
    assert_eq!(b.parent_from_joint.to_cols_array_2d(), columns);
}

#[test]
fn both_layouts_say_the_same() {
    let rows = "0 -1 0 1.5   1 0 0 -2.25   0 0 1 3   0 0 0 1";
    let columns = "0 1 0 0   -1 0 0 0   0 0 1 0   1.5 -2.25 3 1";
    let read_one = |attributes: &str, numbers: &str| {
        let text =
            format!("<JointSet><Joint name='A'><Matrix{attributes}>{numbers}</Matrix></Joint></JointSet>");
        read(text.as_bytes()).joints[0].parent_from_joint
    };
    let expected = read_one("", rows);
    for rows_by in [
        " transposed='false'",
        " transposed=\"0\"",
        " transposed = ' false '",
        " id='1'",
        " Transposed='true'",
    ] {
        assert_eq!(read_one(rows_by, rows), expected, "{rows_by}");
    }
    for columns_by in [" transposed='true'", " transposed='1'", "\n  transposed\n=\n\"true\"  "] {
        assert_eq!(read_one(columns_by, columns), expected, "{columns_by}");
    }
}

#[test]
fn every_encoding_gives_the_same_rig() {
    let expected = read(PLAIN.as_bytes());
    let bom = [b"\xEF\xBB\xBF", PLAIN.as_bytes()].concat();
    assert_eq!(read(&bom), expected, "UTF-8 with a byte-order mark");
    let units = || "\u{FEFF}".encode_utf16().chain(PLAIN.encode_utf16());
    assert_eq!(read(&units().flat_map(u16::to_le_bytes).collect::<Vec<_>>()), expected, "UTF-16 LE");
    assert_eq!(read(&units().flat_map(u16::to_be_bytes).collect::<Vec<_>>()), expected, "UTF-16 BE");
    for declared in ["ISO-8859-1", "iso-8859-1", "latin1", "windows-1252"] {
        let text = format!("<?xml version='1.0' encoding='{declared}'?>\n{PLAIN}");
        let latin: Vec<u8> = text.chars().map(|c| u8::try_from(u32::from(c)).unwrap()).collect();
        assert!(latin.contains(&0xF6), "the ö is one byte");
        assert_eq!(read(&latin), expected, "{declared}");
    }
    for declared in ["UTF-8", "utf-8", "UTF-16"] {
        let text = format!("<?xml version='1.0' encoding='{declared}' standalone='yes'?>{PLAIN}");
        assert_eq!(read(text.as_bytes()), expected, "UTF-8 that is declared as {declared}");
    }
}

#[test]
fn bytes_that_are_no_text_are_refused_at_their_place() {
    let error = |bytes: &[u8]| RawRig::from_xml(bytes).unwrap_err();
    let not_text = |line, column, what: &str| XmlError {
        place: Place { line, column },
        problem: XmlProblem::NotText(what.to_owned()),
    };
    assert_eq!(error(b"<JointSet>\n\xC3\xA4\xC3\xA4 \xFF"), not_text(2, 4, "byte 16 is no UTF-8"));
    assert_eq!(error(b"\xEF\xBB\xBF<J\x80"), not_text(1, 3, "byte 5 is no UTF-8"));
    // Latin-1 that nobody declared.
    assert_eq!(error(b"<JointSet name='H\xF6cker'/>"), not_text(1, 18, "byte 17 is no UTF-8"));
    assert_eq!(error(b"\xFF\xFE<\0\n\0J\0x"), not_text(2, 2, "an odd number of bytes in UTF-16"));
    assert_eq!(error(b"\xFE\xFF\0<\0J\xD8\x00\0a"), not_text(1, 3, "half a surrogate pair in UTF-16"));
    // Places in UTF-16 and behind a mark count characters of the text.
    let text = "<JointSet>\nä <x/>";
    let utf16: Vec<u8> =
        "\u{FEFF}".encode_utf16().chain(text.encode_utf16()).flat_map(u16::to_le_bytes).collect();
    assert_eq!(error(&utf16).place, Place { line: 2, column: 1 });
    assert_eq!(error(b"\xEF\xBB\xBF<x/>").place, Place { line: 1, column: 1 });
}

#[test]
fn comments_and_instructions_may_stand_wherever_xml_allows() {
    let expected = read(PLAIN.as_bytes());
    let extra = "<!-- <Joint> & 1 2 3 --><?tool a='<b>' ?>";
    // Behind every `>` of a tag, and between all words of the matrices.
    let everywhere = PLAIN.replace('>', &format!(">{extra}")).replace(" 0 ", &format!(" 0{extra} "));
    assert_eq!(read(everywhere.as_bytes()), expected);
    let prolog = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<!DOCTYPE JointSet SYSTEM \"a.dtd\" [ <!ENTITY a \"1\"> <!-- > --> ]>\n";
    assert_eq!(read(format!("{prolog}{extra}\n{PLAIN}{extra}\n\n").as_bytes()), expected);
    // A comment separates no words: what it cuts is read in one piece, as XML says.
    assert_eq!(read(PLAIN.replace("2.25", "2.<!-- -->25").as_bytes()), expected);
}

#[test]
fn numbers_may_be_written_as_cdata_and_references() {
    let expected = read(PLAIN.as_bytes());
    let cdata = PLAIN.replace(" 0 -1 0 1.5 ", "<![CDATA[ 0 -1]]><![CDATA[]]> <![CDATA[0 1]]>.5 ");
    assert_eq!(read(cdata.as_bytes()), expected);
    let references = PLAIN.replace("0 -1 0 1.5", "&#48;&#x20;-&#x31;&#9;&#x000030; 1&#46;5");
    assert_eq!(read(references.as_bytes()), expected);
    // Numbers in any form that stands for the same f32.
    let forms = PLAIN
        .replace("0 -1 0 1.5", "+0 -1e0 .0 15E-1")
        .replace("4 5 6 1", "4. 5.0e+0 0.6e1 1.00000000000000000001");
    assert_eq!(read(forms.as_bytes()), expected);
}

#[test]
fn line_ends_and_white_space_do_not_matter() {
    let expected = read(PLAIN.as_bytes());
    for end in ["\r\n", "\r", " ", "\t", "\n\n\n"] {
        assert_eq!(read(PLAIN.replace('\n', end).as_bytes()), expected, "{end:?}");
        assert_eq!(read(PLAIN.replace("   ", end).as_bytes()), expected, "{end:?}");
    }
    let windows = RawRig::from_xml(PLAIN.replace('\n', "\r\n").as_bytes()).unwrap();
    assert_eq!(windows.joints[1].place, Some(Place { line: 5, column: 7 }));
}

#[test]
fn attributes_that_we_do_not_know_are_ignored() {
    let expected = read(PLAIN.as_bytes());
    let xml = PLAIN
        .replace("<JointSet>", "<JointSet xmlns='urn:x' xmlns:y=\"urn:y\" version='2'>")
        .replace("<Joint ", "<Joint y:name='other' id='>' ")
        .replace("<Matrix", "<Matrix rows='4'")
        .replace("<Children>", "<Children count='&lt;1'>");
    assert_eq!(read(xml.as_bytes()), expected);
}

#[test]
fn names_keep_every_character() {
    let cases = [
        ("&lt;a&gt; &amp;&quot;&apos;", "<a> &\"'"),
        ("Ärmel 関節 🦴", "Ärmel 関節 🦴"),
        ("&#x1F9B4;&#228;", "🦴ä"),
        (" padded ", " padded "),
        ("raw\ttab\nline\r\nend", "raw tab line end"),
        ("&#9;&#10;&#13;x", "\t\n\rx"),
    ];
    for (written, name) in cases {
        let text =
            format!("<JointSet><Joint name=\"{written}\"><Matrix>{IDENTITY}</Matrix></Joint></JointSet>");
        assert_eq!(read(text.as_bytes()).joints[0].name, name);
    }
}

#[test]
fn children_may_stand_before_the_matrix() {
    let matrix = format!("<Matrix>{IDENTITY}</Matrix>");
    let child = format!("<Children><Joint name='B'>{matrix}</Joint></Children>");
    let joint = |inside: String| format!("<JointSet><Joint name='A'>{inside}</Joint></JointSet>");
    assert_eq!(
        read(joint(format!("{child}{matrix}")).as_bytes()),
        read(joint(format!("{matrix}{child}")).as_bytes())
    );
}

#[test]
fn columns_count_characters() {
    let matrix = format!("<Matrix>{IDENTITY}</Matrix>");
    let text = format!(
        "<JointSet><!-- 関節 🦴 --><Joint name='Ä'>{matrix}</Joint><Joint name='B'>{matrix}</Joint></JointSet>"
    );
    let raw = RawRig::from_xml(text.as_bytes()).unwrap();
    for joint in &raw.joints {
        let start = format!("<Joint name='{}'", joint.name);
        let (_, place) =
            crate::common::marked(&text.replace(&start, &format!("{}{start}", crate::common::MARK)));
        assert_eq!(joint.place, Some(place), "{}", joint.name);
    }
    crate::common::fails(
        "<JointSet><!-- 関節 🦴 -->¦<Bone/></JointSet>",
        &XmlProblem::UnexpectedElement { found: "Bone".to_owned(), expected: "<Joint>" },
    );
}
