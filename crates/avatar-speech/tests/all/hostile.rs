//! Texts and timelines that nobody should write.

use avatar_speech::{Cue, Format, Mouth, Speech, Timeline, Viseme};
use proptest::prelude::*;

fn is_sound(mouth: &Mouth) -> bool {
    let others = [mouth.closed, mouth.bitten, mouth.loudness, mouth.brows];
    let is_sum_one = (mouth.visemes.iter().sum::<f64>() - 1.0).abs() < 1e-9;
    is_sum_one
        && mouth
            .visemes
            .iter()
            .chain(&mouth.articulators)
            .chain(&others)
            .all(|value| (-1e-12..=1.0 + 1e-12).contains(value))
}

proptest! {
    #[test]
    fn no_text_makes_it_panic(text in "[-0-9a-zA-Z \\t\\n.,:<>\"{}\\[\\]#_@=!/>é\u{feff}]{0,200}") {
        let _ = Timeline::read(&text, None);
        for format in Format::ALL {
            if let Ok(timeline) = Timeline::read(&text, Some(format)) {
                prop_assert!(is_sound(&Speech::new(&timeline).at(0.1)));
            }
        }
    }

    #[test]
    fn no_bytes_make_it_panic(bytes in proptest::collection::vec(any::<u8>(), 0..200)) {
        let _ = Timeline::from_bytes("a.TextGrid", &bytes);
        let _ = Timeline::from_bytes("a", &bytes);
    }

    /// However short, long or dense the sounds are, the mouth is one.
    #[test]
    fn any_timeline_gives_mouths(
        steps in proptest::collection::vec((0_usize..15, 0.0_f64..1.0, 0.0_f32..1.0), 1..60),
        scale in prop_oneof![Just(1e-6), Just(0.003), Just(0.05), Just(0.3), Just(50.0)],
    ) {
        let mut secs = 0.0;
        let cues = steps.iter().map(|&(viseme, length, stress)| {
            let start_secs = secs;
            secs += length * scale;
            Cue { start_secs, end_secs: secs, viseme: Viseme::ALL[viseme], stress }
        });
        let timeline = Timeline::new(cues.collect::<Vec<_>>()).unwrap();
        let speech = Speech::new(&timeline);
        for step in 0..400 {
            let mouth = speech.at(secs * f64::from(step - 50) / 300.0);
            prop_assert!(is_sound(&mouth), "{mouth:?}");
        }
    }
}

#[test]
fn times_that_are_none_are_silent() {
    let timeline = Timeline::read("a 100\np 100", None).unwrap();
    let speech = Speech::new(&timeline);
    for secs in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, -1e300, 1e300] {
        assert!(is_sound(&speech.at(secs)));
        assert_eq!(speech.at(secs).closed, 0.0, "{secs}");
    }
    let wrong = |start_secs, end_secs| {
        Timeline::new([Cue { start_secs, end_secs, viseme: Viseme::Aa, stress: f32::NAN }])
    };
    for (start, end) in
        [(f64::NAN, 1.0), (0.0, f64::NAN), (0.0, f64::INFINITY), (-1.0, 1.0), (2.0, 1.0), (0.0, 1e9)]
    {
        assert!(wrong(start, end).is_err(), "{start} {end}");
    }
    assert!(is_sound(&Speech::new(&wrong(0.0, 1.0).unwrap()).at(0.5)));
}

#[test]
fn weights_that_are_none_are_silent() {
    assert_eq!(Mouth::of_visemes(&[f32::NAN; 15], f32::NAN), Mouth::SILENT);
    assert_eq!(Mouth::of_visemes(&[-1.0; 15], 0.5), Mouth::SILENT);
    assert!(is_sound(&Mouth::of_visemes(&[f32::MAX; 15], f32::INFINITY)));
    let mut weights = [0.0; 15];
    weights[Viseme::PP.index()] = 3.0;
    assert_eq!(Mouth::of_visemes(&weights, 0.5).closed, 1.0);
}

/// Ten hours of quick speech: memory in proportion, and time of a frame as ever.
#[test]
fn ten_hours_take_a_bounded_amount_of_memory() {
    let count = 10 * 3600 * 15;
    let text: String = (0..count).map(|index| format!("{} 66\n", ["p", "a", "t", "i"][index % 4])).collect();
    let mut speech = None;
    let used = allocation_counter::measure(|| {
        let timeline = Timeline::read(&text, None).unwrap();
        speech = Some(Speech::new(&timeline));
    });
    assert!(used.bytes_max < 64 * text.len() as u64, "{} for {}", used.bytes_max, text.len());
    let speech = speech.unwrap();
    let frames = allocation_counter::measure(|| {
        for frame in 0..1000 {
            std::hint::black_box(speech.at(f64::from(frame) * 35.0));
        }
    });
    assert_eq!(frames.count_total, 0);
    assert!((speech.end_secs() - 0.066 * count as f64).abs() < 1e-3);
}

/// The texts that take the most for their length: every letter is a sound, every value of JSON a byte.
#[test]
fn dense_texts_take_a_bounded_amount_of_memory() {
    const COUNT: usize = 65_537;
    for (name, limit, text) in [
        ("labels", 64, "p 13\n".repeat(COUNT)),
        ("table", 64, (1..COUNT).map(|secs| format!("{secs} A\n")).collect()),
        ("marks", 256, format!("[{}0]", "0,".repeat(COUNT))),
        ("lists", 256, format!("[{}0]", "[0],".repeat(COUNT))),
        ("objects", 256, format!("[{}0]", "{\"\":0},".repeat(COUNT))),
        ("letters that hold the lips", 256, format!("1:0 --> 999:0\n{}", "pf".repeat(COUNT))),
        ("syllables", 256, format!("1:0 --> 999:0\n{}", "pa".repeat(COUNT))),
    ] {
        let used = allocation_counter::measure(|| {
            if let Ok(timeline) = Timeline::read(&text, None) {
                std::hint::black_box(Speech::new(&timeline));
            }
        });
        let times = used.bytes_max / text.len() as u64;
        assert!(times < limit, "{name}: {times}");
    }
}

/// A list of marks that claims nothing and nests without end.
#[test]
fn nested_json_is_an_error() {
    for format in [Format::Json, Format::Marks] {
        assert!(Timeline::read(&"[".repeat(1 << 20), Some(format)).is_err());
        assert!(Timeline::read(&"{\"a\":".repeat(1 << 18), Some(format)).is_err());
    }
    let xml = "<a>".repeat(1 << 18);
    assert!(Timeline::read(&xml, Some(Format::Xml)).is_err());
}
