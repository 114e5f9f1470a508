//! Speech that is only heard, beside what the synthesiser that spoke says of it: flite, where it is
//! installed.
#![allow(clippy::expect_used, clippy::panic, reason = "helpers of tests")]

use avatar_hearing::Hearing;
use avatar_sound::{Limits, decode};
use avatar_speech::{HeardSpeech, LiveMouth, Phones, Timeline, VISEMES, Viseme};
use std::fs;
use std::io::Write;
use std::process::Command;

const SENTENCES: [&str; 4] = [
    "My brother bought a big map of Paris.",
    "Please put five apples in the paper bag before lunch.",
    "The sun was warm, and the boys swam across the river.",
    "Good morning! Have you seen the film about bees?",
];

/// What flite says of a sentence: the sound, and its labels.
struct Said {
    rate_hz: u32,
    samples: Vec<f32>,
    labels: Timeline,
    /// The phones of the labels, without their times.
    phones: String,
}

/// Voices of flite that the model of avatar-hearing was not trained on.
const VOICES: [&str; 3] = ["slt", "rms", "awb"];

/// The sentences in such a voice; none without flite, which is said on the terminal, or is a failure under
/// `MIMIK_REQUIRE_DATA=1`.
fn said(voice: &str) -> Vec<Said> {
    let folder = tempfile::tempdir().expect("a folder");
    let wav = folder.path().join("said.wav");
    let mut all = Vec::new();
    for sentence in SENTENCES {
        let mut flite = Command::new("flite");
        let Ok(run) = flite.args(["-voice", voice, "-psdur", "-t", sentence, "-o"]).arg(&wav).output() else {
            let required = std::env::var_os("MIMIK_REQUIRE_DATA").is_some_and(|value| value == "1");
            assert!(!required, "expected the program flite (MIMIK_REQUIRE_DATA=1), found none");
            let _ = writeln!(std::io::stderr(), "SKIPPED: flite is not installed");
            return Vec::new();
        };
        assert!(run.status.success(), "{run:?}");
        let (sound, notes) = decode(&fs::read(&wav).expect("a file"), &Limits::default()).expect("a sound");
        assert!(notes.is_empty(), "{notes:?}");
        // `phone:end`, apart by spaces; as Festival writes labels.
        let text = String::from_utf8(run.stdout).expect("text");
        let pairs: Vec<(&str, &str)> =
            text.split_whitespace().filter_map(|word| word.rsplit_once(':')).collect();
        assert!(pairs.len() > 20, "{text}");
        let rows: String = pairs.iter().map(|(phone, end)| format!("{end} 100 {phone}\n")).collect();
        let labels = Timeline::read(&format!("#\n{rows}"), None).expect("labels");
        let phones = pairs.iter().map(|(phone, _)| if *phone == "pau" { "\n" } else { phone });
        let phones = phones.collect::<Vec<_>>().join(" ");
        all.push(Said { rate_hz: sound.rate_hz, samples: sound.mono().into_owned(), labels, phones });
    }
    all
}

/// What the model hears: weights and loudness, and the time of the first frame.
fn heard(said: &Said) -> (Vec<([f32; VISEMES], f32)>, f64) {
    let mut hearing = Hearing::new(said.rate_hz).expect("a rate");
    let (mut frames, mut first) = (Vec::new(), None);
    let mut take = |frame: &avatar_hearing::Frame| {
        first.get_or_insert(frame.time_secs);
        frames.push((frame.weights, frame.loudness));
    };
    hearing.push(&said.samples, &mut take);
    hearing.finish(&mut take);
    (frames, first.expect("frames"))
}

/// Phones whose times are found in the sound are where the synthesiser put them: half of their beginnings
/// within two frames of the recogniser, and nine of ten within as much as a sound lasts.
#[test]
fn sounds_are_found_where_they_were_said() {
    for voice in VOICES {
        let mut off = Vec::new();
        for said in said(voice) {
            let (frames, first) = heard(&said);
            let (phones, notes) = Phones::read(&said.phones);
            assert!(notes.is_empty(), "{notes:?}");
            let weights: Vec<_> = frames.iter().map(|(weights, _)| *weights).collect();
            let timeline = phones.align(&weights, first);
            let spoken = |timeline: &Timeline| -> Vec<_> {
                timeline.cues().iter().filter(|cue| cue.viseme != Viseme::Sil).copied().collect()
            };
            let (found, meant) = (spoken(&timeline), spoken(&said.labels));
            assert_eq!(found.len(), meant.len());
            off.extend(
                found.iter().zip(&meant).map(|(found, meant)| (found.start_secs - meant.start_secs).abs()),
            );
        }
        let count = off.len();
        if count == 0 {
            return;
        }
        off.sort_by(f64::total_cmp);
        let (half, most) = (off[count / 2], off[count * 9 / 10]);
        let [half_ms, most_ms] = [half, most].map(|secs| 1e3 * secs);
        println!("{voice}: {count} sounds: half within {half_ms:.1} ms, nine of ten within {most_ms:.1} ms");
        assert!(half <= 0.02 && most <= 0.12, "{voice}: {half} s, {most} s");
    }
}

/// Lips close at most of the p, b and m that are said and in the middle of few vowels, and the jaw is closed
/// where nothing is said. How often lips close, in the recording and live, is printed.
#[test]
fn lips_close_where_they_should_and_the_mouth_is_shut_in_silence() {
    VOICES.into_iter().for_each(lips_close);
}

fn lips_close(voice: &str) {
    let (mut bilabials, mut closed, mut live_closed, mut wrong, mut vowels) = (0, 0, 0, 0, 0);
    let mut silent = 0;
    for said in said(voice) {
        let (frames, first) = heard(&said);
        let speech = HeardSpeech::new(frames.clone(), first);
        let mut live = LiveMouth::new();
        let mut live_at = Vec::new();
        for (number, (weights, loudness)) in frames.iter().enumerate() {
            live.push(first + number as f64 * 0.01, weights, *loudness);
            live_at.push((live.until_secs(), live.at(live.until_secs()).closed));
        }
        for cue in said.labels.cues() {
            let moments = || {
                let count = ((cue.end_secs - cue.start_secs) * 200.0).ceil() as u32;
                (0..=count).map(move |k| cue.start_secs + f64::from(k) / 200.0)
            };
            let is_closed = moments().any(|secs| speech.at(secs).closed > 0.9);
            let is_live_closed = live_at
                .iter()
                .any(|(secs, closed)| (cue.start_secs..=cue.end_secs + 0.05).contains(secs) && *closed > 0.9);
            match cue.viseme {
                Viseme::PP => {
                    bilabials += 1;
                    closed += u32::from(is_closed);
                    live_closed += u32::from(is_live_closed);
                }
                Viseme::Sil => {
                    // Not at a border to a sound, where the mouth is on its way.
                    let from = if cue.start_secs < 1e-9 { 0.0 } else { cue.start_secs + 0.12 };
                    for secs in moments().filter(|secs| *secs >= from && *secs < cue.end_secs - 0.12) {
                        silent += 1;
                        let mouth = speech.at(secs);
                        assert!(mouth.articulators[0] < 0.03, "the jaw is open at {secs} s: {mouth:?}");
                    }
                }
                viseme if viseme.is_vowel() => {
                    vowels += 1;
                    let middle = (cue.start_secs + cue.end_secs) / 2.0;
                    wrong += u32::from(speech.at(middle).closed > 0.5);
                }
                _ => {}
            }
        }
    }
    if bilabials == 0 {
        return;
    }
    println!(
        "{voice}: {closed} of {bilabials} closed, live {live_closed}; {wrong} of {vowels} vowels closed"
    );
    assert!(silent > 20, "{silent} moments of silence were looked at");
    assert!(4 * closed.min(live_closed) > 3 * bilabials, "{voice}: {closed}, {live_closed} of {bilabials}");
    assert!(wrong * 20 <= vowels, "{voice}: {wrong} of {vowels} vowels close the lips");
}
