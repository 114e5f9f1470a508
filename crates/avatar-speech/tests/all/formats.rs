//! Each format, by a text as its program writes it.

use Viseme::{Aa, CH, E, FF, I, KK, NN, O, PP, SS, Sil, TH, U};
use avatar_speech::{Timeline, Viseme};

fn read(text: &str) -> Timeline {
    Timeline::read(text, None).unwrap_or_else(|error| panic!("{error}"))
}

/// Starts in milliseconds, and visemes.
fn told(timeline: &Timeline) -> Vec<(i64, Viseme)> {
    timeline.cues().iter().map(|cue| ((cue.start_secs * 1000.0).round() as i64, cue.viseme)).collect()
}

/// The sample of Rhubarb's own project says the same in its three formats.
const TSV: &str = "0.00\tX\n0.05\tD\n0.27\tC\n0.31\tB\n0.43\tX\n0.47\tX\n";
const XML: &str = r#"<?xml version="1.0" encoding="utf-8"?>
<rhubarbResult>
  <metadata><soundFile>hi.wav</soundFile><duration>0.47</duration></metadata>
  <mouthCues>
    <mouthCue start="0.00" end="0.05">X</mouthCue>
    <mouthCue start="0.05" end="0.27">D</mouthCue>
    <mouthCue start="0.27" end="0.31">C</mouthCue>
    <mouthCue start="0.31" end="0.43">B</mouthCue>
    <mouthCue start="0.43" end="0.47">X</mouthCue>
  </mouthCues>
</rhubarbResult>
"#;
const JSON: &str = r#"{ "metadata": { "duration": 0.47 }, "mouthCues": [
    { "start": 0.00, "end": 0.05, "value": "X" }, { "start": 0.05, "end": 0.27, "value": "D" },
    { "start": 0.27, "end": 0.31, "value": "C" }, { "start": 0.31, "end": 0.43, "value": "B" },
    { "start": 0.43, "end": 0.47, "value": "X" } ] }"#;

#[test]
fn rhubarb_in_three_formats() {
    let table = read(TSV);
    assert_eq!(told(&table), [(0, Sil), (50, Aa), (270, E), (310, SS), (430, Sil)]);
    assert_eq!(table.end_secs(), 0.47);
    assert_eq!(read(XML), table);
    assert_eq!(read(JSON), table);
    assert_eq!(told(&read(&XML.replace('\n', "\r\n"))), told(&table));
}

#[test]
fn a_table_of_oculus_visemes_with_strengths() {
    let timeline = read("0 sil\n0.1,PP,0.5\n0.18 aa 0.9\n0.4 viseme_kk\n0.5 sil\n");
    assert_eq!(told(&timeline), [(0, Sil), (100, PP), (180, Aa), (400, KK)]);
    assert_eq!(timeline.cues()[2].stress, 0.9);
    // "E" is a viseme of both; so many others are Oculus's alone.
    assert_eq!(told(&read("0 E\n0.1 aa\n0.2 sil")), [(0, E), (100, Aa)]);
}

#[test]
fn marks_of_cloud_services() {
    // Amazon Polly's documentation shows this form.
    let polly = r#"{"time":0,"type":"sentence","start":0,"end":23,"value":"Mary had"}
{"time":6,"type":"word","start":0,"end":4,"value":"Mary"}
{"time":6,"type":"viseme","value":"p"}
{"time":73,"type":"viseme","value":"E"}
{"time":180,"type":"viseme","value":"r"}
{"time":292,"type":"viseme","value":"i"}
{"time":373,"type":"viseme","value":"sil"}
"#;
    let timeline = read(polly);
    assert_eq!(told(&timeline), [(6, PP), (73, E), (180, Viseme::RR), (292, I)]);
    assert_eq!(timeline.end_secs(), 0.373);
    // Azure counts in 100 ns; 21 is p, 2 is ɑ, 18 is f, 0 is silence.
    let azure = r#"{"AudioOffset": 500000, "VisemeId": 21}
{"AudioOffset": 1200000, "VisemeId": 2}
{"audio_offset": 3000000, "viseme_id": 18}
{"audio_offset": 3900000, "viseme_id": 0}"#;
    assert_eq!(told(&read(azure)), [(50, PP), (120, Aa), (300, FF)]);
    let list = r#"[{"start": 0.5, "viseme": "viseme_TH"}, {"start": 0.62, "viseme": "sil"}]"#;
    assert_eq!(told(&read(list)), [(500, TH)]);
}

/// "boy", with a tier of words before that of phones, long and short.
const LONG: &str = r#"File type = "ooTextFile"
Object class = "TextGrid"

xmin = 0
xmax = 0.6
tiers? <exists>
size = 2
item []:
    item [1]:
        class = "IntervalTier"
        name = "words"
        xmin = 0
        xmax = 0.6
        intervals: size = 2
        intervals [1]:
            xmin = 0
            xmax = 0.1
            text = ""
        intervals [2]:
            xmin = 0.1
            xmax = 0.6
            text = "a ""boy"""
    item [2]:
        class = "IntervalTier"
        name = "phones"
        xmin = 0
        xmax = 0.6
        intervals: size = 3
        intervals [1]:
            xmin = 0
            xmax = 0.1
            text = ""
        intervals [2]:
            xmin = 0.1
            xmax = 0.2
            text = "B"
        intervals [3]:
            xmin = 0.2
            xmax = 0.6
            text = "OY1"
"#;
const SHORT: &str = r#"File type = "ooTextFile"
Object class = "TextGrid"

0
0.6
<exists>
2
"IntervalTier"
"words"
0
0.6
2
0
0.1
""
0.1
0.6
"a ""boy"""
"IntervalTier"
"phones"
0
0.6
3
0
0.1
""
0.1
0.2
"B"
0.2
0.6
"OY1"
"#;

#[test]
fn a_text_grid_long_and_short() {
    let timeline = read(LONG);
    assert_eq!(told(&timeline), [(0, Sil), (100, PP), (200, O), (420, I)]);
    assert_eq!(read(SHORT), timeline);
    // Praat writes what ASCII does not hold in UTF-16.
    for bytes in [u16::to_le_bytes, u16::to_be_bytes] {
        let wide: Vec<u8> = "\u{feff}".encode_utf16().chain(LONG.encode_utf16()).flat_map(bytes).collect();
        assert_eq!(Timeline::from_bytes("boy.TextGrid", &wide).unwrap(), timeline);
    }
    // Another name of the tier: its labels tell.
    assert_eq!(read(&LONG.replace("\"phones\"", "\"tier 2\"")), timeline);
}

#[test]
fn labels_in_four_layouts_and_three_alphabets() {
    let htk = "0 1000000 sil\n1000000 1800000 m\n1800000 3000000 uw\n3000000 3900000 v\n";
    let expected = [(0, Sil), (100, PP), (180, U), (300, FF)];
    assert_eq!(told(&read(htk)), expected);
    let secs = "0 0.1 sil\n0.1 0.18 M\n0.18 0.3 UW1\n0.3 0.39 V\n";
    assert_eq!(told(&read(secs)), expected);
    let festival = "separator ;\nnfields 1\n#\n0.1 100 pau\n0.18 100 m\n0.3 100 uw\n0.39 100 v\n";
    assert_eq!(told(&read(festival)), expected);
    let mbrola = "; comment\n_ 100\nm 80 50 120\nu: 120\nv 90\n";
    assert_eq!(told(&read(mbrola)), expected);
    let ipa = "0 0.1 _\n0.1 0.18 m\n0.18 0.3 uː\n0.3 0.39 v\n";
    assert_eq!(told(&read(ipa)), expected);
    let full = "0 1000000 x^x-sil+m=uw\n1000000 1800000 x^sil-m+uw=v\n";
    assert_eq!(told(&read(full)), [(0, Sil), (100, PP)]);
}

#[test]
fn an_unknown_phone_is_noted_and_the_sound_before_goes_on() {
    let timeline = read("0 0.1 sil\n0.1 0.2 AA1\n0.2 0.3 QQQ\n0.3 0.4 HH\n0.4 0.5 S\n");
    assert_eq!(told(&timeline), [(0, Sil), (100, Aa), (300, KK), (400, SS)]);
    assert_eq!(timeline.cues()[1].end_secs, 0.3);
    let notes: Vec<String> = timeline.notes().iter().map(ToString::to_string).collect();
    assert_eq!(notes, ["line 3: \"QQQ\" is no phone that is known: the sound before it goes on"]);
}

#[test]
fn subtitles_are_guessed_by_letters() {
    let srt = "1\n00:00:01,000 --> 00:00:02,000\n<i>Push</i> the moon.\n\n2\n00:00:03,000 --> 00:00:03,500\n[music] My.\n";
    let timeline = read(srt);
    let visemes: Vec<_> = timeline.cues().iter().map(|cue| cue.viseme).collect();
    assert_eq!(visemes, [PP, U, CH, TH, E, PP, U, NN, Sil, PP, I, Sil]);
    assert_eq!(timeline.cues()[0].start_secs, 1.0);
    let my = timeline.cues().iter().find(|cue| cue.start_secs >= 3.0).unwrap();
    assert_eq!((my.start_secs, my.viseme), (3.0, PP));
    assert!(timeline.end_secs() <= 3.5);
    let vtt = "WEBVTT\n\nintro\n00:01.000 --> 00:02.000 align:start\nPush the moon.\n\n00:03.000 --> 00:03.500\nMy.\n";
    assert_eq!(read(vtt), timeline);
    // Cyrillic: "mama".
    let visemes: Vec<_> =
        read("1\n0:0:0,0 --> 0:0:1,0\nмама\n").cues().iter().map(|cue| cue.viseme).collect();
    assert_eq!(visemes, [PP, Aa, PP, Aa]);
}

#[test]
fn mistakes_have_their_place() {
    for (text, expected) in [
        ("", "line 1, column 1: expected a timeline of speech, found nothing"),
        (
            "0.0\tX\n0.1\tK\n",
            "line 2, column 5: expected a mouth of Rhubarb (A to H, X) or a viseme of Oculus (sil, PP … U), found \"K\"",
        ),
        ("0.0\tX\n0.2\tA\n0.1\tB\n", "line 2, column 1: expected an end after the start, 0.2 s, found 0.1 s"),
        ("0.0\tX\nnan\tA\n", "line 2, column 1: expected seconds, found \"nan\""),
        ("0 aa\n0.1 PP 2\n", "line 2, column 8: expected a strength from 0 to 1, found \"2\""),
        ("0.0 1e7 p\n0 2 aa\n", "line 1, column 1: expected a time from 0 to 172800 s, found 10000000 s"),
        (
            "0.2 0.3 aa\n0.1 0.2 p",
            "line 2, column 1: expected a start after that of the sound before, 0.2 s, found 0.1 s",
        ),
        ("0.2 0.3 aa\n-0.1 0.2 p", "line 2, column 1: expected the start of a phone, found \"-0.1\""),
        ("{\"time\":1,\"value\":\"p\"}\n{\"time\":", "line 2, column 8: expected JSON"),
        (
            "{\"time\":1,\"value\":\"?\"}",
            "line 1, column 1: expected a viseme of Polly or Oculus as value, or a visemeId, found \"?\"",
        ),
        (
            "{\"offset\":1,\"visemeId\":22}",
            "line 1, column 1: expected the number of a viseme, 0 to 21, found 22",
        ),
        (
            "<rhubarbResult><mouthCues>\n<mouthCue start=\"0\" end=\"1\">Q</mouthCue></mouthCues></rhubarbResult>",
            "line 2, column 29: expected a mouth from A to H, or X, found \"Q\"",
        ),
        ("<html></html>", "line 1, column 1: expected an element rhubarbResult, found none"),
        (
            &SHORT.replace("0.2\n\"B\"", "x\n\"B\""),
            "line 29, column 1: expected the end of an interval, found \"B\"",
        ),
        (
            &LONG.replace("size = 3", "size = 4000000000"),
            "line 41, column 1: expected the start of an interval, found the end",
        ),
        (
            "1\n00:00:01 --> later\nHello",
            "line 2, column 1: expected a time such as 00:01:02,500, found \"later\"",
        ),
        (
            "WEBVTT\n",
            "line 1, column 1: expected subtitles with lines such as 00:00:01,000 --> 00:00:02,500, found none",
        ),
    ] {
        let told = Timeline::read(text, None).expect_err(text).to_string();
        assert!(told.starts_with(expected), "{text:?}: {told}");
    }
}

#[test]
fn sounds_over_each_other_are_cut_with_a_note() {
    let timeline = read("0 0.3 aa\n0.2 0.4 p\n0.4 0.4 t\n");
    assert_eq!(told(&timeline), [(0, Aa), (200, PP)]);
    assert_eq!(timeline.cues()[0].end_secs, 0.2);
    assert_eq!(timeline.notes().len(), 1);
    assert_eq!(timeline.notes()[0].line, 2);
}
