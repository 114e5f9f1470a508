//! Mouths that follow what a recogniser hears.

use avatar_speech::{Articulator, HeardSpeech, LiveMouth, Mouth, VISEMES, Viseme};
use proptest::prelude::*;

/// A recogniser that is sure of itself.
fn sure(viseme: Viseme) -> [f32; VISEMES] {
    let mut weights = [0.0; VISEMES];
    weights[viseme.index()] = 1.0;
    weights
}

/// Frames of sounds, each for so many hundredths of a second.
fn frames(sounds: &[(Viseme, usize)]) -> Vec<([f32; VISEMES], f32)> {
    let loudness = |viseme| if viseme == Viseme::Sil { 0.0 } else { 0.6 };
    sounds.iter().flat_map(|&(viseme, count)| vec![(sure(viseme), loudness(viseme)); count]).collect()
}

const MAMA: [(Viseme, usize); 6] = [
    (Viseme::Sil, 30),
    (Viseme::PP, 10),
    (Viseme::Aa, 25),
    (Viseme::PP, 9),
    (Viseme::Aa, 25),
    (Viseme::Sil, 40),
];

fn jaw(mouth: &Mouth) -> f64 {
    mouth.articulators[Articulator::JawOpen as usize]
}

/// Whether two mouths are one, but for the rounding of a time.
fn is_same(a: &Mouth, b: &Mouth) -> bool {
    let all = |mouth: &Mouth| {
        let others = [mouth.closed, mouth.bitten, mouth.loudness, mouth.brows];
        mouth.visemes.into_iter().chain(mouth.articulators).chain(others).collect::<Vec<f64>>()
    };
    all(a).iter().zip(all(b)).all(|(a, b)| (a - b).abs() < 1e-12)
}

#[test]
fn a_word_that_is_heard_opens_and_closes_the_mouth() {
    let speech = HeardSpeech::new(frames(&MAMA), 0.0125);
    // In the middle of each sound.
    assert_eq!((jaw(&speech.at(0.1)), speech.at(0.1).closed), (0.0, 0.0));
    assert_eq!((jaw(&speech.at(0.36)), speech.at(0.36).closed), (0.0, 1.0));
    assert!(jaw(&speech.at(0.54)) > 0.35, "{:?}", speech.at(0.54));
    assert_eq!((jaw(&speech.at(0.705)), speech.at(0.705).closed), (0.0, 1.0));
    assert!(jaw(&speech.at(0.87)) > 0.35);
    // Silent ends, whatever the time.
    for secs in [-1e300, -1.0, 1.25, speech.rest_secs(), 1e300, f64::NAN, f64::INFINITY] {
        assert_eq!(jaw(&speech.at(secs)), 0.0, "{secs}");
    }
    assert!((speech.end_secs() - (0.0125 + 1.38)).abs() < 1e-9);
}

/// No jump in the value, the speed or the acceleration: the third difference of a C² curve with bounded third
/// derivatives goes with the cube of the step, that of a kink with its square.
#[test]
fn what_is_heard_moves_without_a_kink() {
    let speech = HeardSpeech::new(frames(&MAMA), 0.0);
    let mut live = LiveMouth::new();
    let mut ends = Vec::new();
    for (number, (weights, loudness)) in frames(&MAMA).iter().enumerate() {
        live.push(number as f64 * 0.01, weights, *loudness);
        ends.push(live.clone());
    }
    // The live mouth, asked at the time that is settled.
    let live_at = |secs: f64| {
        let settled = ends.iter().find(|live| live.until_secs() >= secs);
        settled.unwrap_or(&ends[ends.len() - 1]).at(secs)
    };
    let of: [&dyn Fn(f64) -> Mouth; 2] = [&|secs: f64| speech.at(secs), &live_at];
    for at in of {
        let most = |step: f64| -> f64 {
            let count = (1.3 / step) as usize;
            let value = |k: usize| {
                let mouth = at(0.001 + k as f64 * step);
                [
                    jaw(&mouth),
                    mouth.closed,
                    mouth.articulators[Articulator::MouthUpperUp as usize],
                    mouth.loudness,
                ]
            };
            let rows: Vec<[f64; 4]> = (0..count).map(value).collect();
            rows.windows(4)
                .flat_map(|w| (0..4).map(move |c| (w[3][c] - 3.0 * w[2][c] + 3.0 * w[1][c] - w[0][c]).abs()))
                .fold(0.0, f64::max)
        };
        // Steps that are short beside the few milliseconds in which lips close.
        let (coarse, fine) = (most(0.0002), most(0.0001));
        assert!(fine < coarse / 6.0, "{coarse} {fine}");
    }
}

/// Settled moments stay as they are, whatever comes.
#[test]
fn what_is_settled_does_not_change() {
    let mut live = LiveMouth::new();
    assert_eq!((live.at(0.3), live.until_secs()), (Mouth::SILENT, 0.0));
    let mut seen: Vec<(f64, Mouth)> = Vec::new();
    for (number, (weights, loudness)) in frames(&MAMA).iter().enumerate() {
        live.push(5.0 + number as f64 * 0.01, weights, *loudness);
        let secs = live.until_secs();
        seen.push((secs, live.at(secs)));
        for (secs, mouth) in seen.iter().rev().take(40) {
            assert!(is_same(&live.at(*secs), mouth), "{secs}");
        }
    }
    assert!(seen.iter().any(|(_, mouth)| mouth.closed == 1.0));
    assert!(seen.iter().any(|(_, mouth)| jaw(mouth) > 0.35));
    assert_eq!(jaw(&seen[seen.len() - 1].1), 0.0);
    // Frames that come late or twice are passed over; after a gap the mouth is silent.
    let before = live.at(live.until_secs());
    live.push(5.0, &sure(Viseme::Aa), 1.0);
    live.push(f64::NAN, &sure(Viseme::Aa), 1.0);
    assert!(is_same(&live.at(live.until_secs()), &before));
    live.push(100.0, &sure(Viseme::Aa), 1.0);
    assert_eq!(jaw(&live.at(99.9)), 0.0);
    live.reset();
    assert_eq!(live.at(99.9), Mouth::SILENT);
}

#[test]
fn a_live_mouth_allocates_nothing() {
    let mut live = LiveMouth::new();
    let frames = frames(&MAMA);
    let counted = allocation_counter::measure(|| {
        for (number, (weights, loudness)) in frames.iter().enumerate() {
            live.push(number as f64 * 0.01, weights, *loudness);
            std::hint::black_box(live.at(live.until_secs()));
        }
    });
    assert_eq!(counted.count_total, 0);
}

/// A quiet recording moves the mouth as far as a loud one.
#[test]
fn loudness_is_that_beside_the_rest_of_the_recording() {
    let at = |loudness: f32| {
        let frames = frames(&[(Viseme::Aa, 600)]).into_iter().map(|(weights, _)| (weights, loudness));
        HeardSpeech::new(frames, 0.0).at(3.0)
    };
    assert!((at(0.2).loudness - 0.5).abs() < 0.02 && (at(0.9).loudness - 0.5).abs() < 0.02);
    assert!((jaw(&at(0.2)) - jaw(&at(0.9))).abs() < 0.02);
}

proptest! {
    /// Any numbers give mouths.
    #[test]
    fn nothing_that_is_heard_makes_a_mouth_that_is_none(
        numbers in proptest::collection::vec(
            prop_oneof![-1.0_f32..2.0, Just(f32::NAN), Just(f32::INFINITY), Just(f32::MAX), Just(0.0)], 0..400),
        secs in prop_oneof![-1.0_f64..5.0, Just(f64::NAN), Just(1e18)],
    ) {
        let frames: Vec<([f32; VISEMES], f32)> = numbers
            .chunks_exact(VISEMES + 1)
            .map(|chunk| (chunk[..VISEMES].try_into().unwrap(), chunk[VISEMES]))
            .collect();
        let speech = HeardSpeech::new(frames.clone(), 0.01);
        let mut live = LiveMouth::new();
        for (number, (weights, loudness)) in frames.iter().enumerate() {
            live.push(number as f64 * 0.013, weights, *loudness);
        }
        let moments = [secs, 0.05, live.until_secs()];
        for mouth in moments.iter().flat_map(|secs| [speech.at(*secs), live.at(*secs)]) {
            let others = [mouth.closed, mouth.bitten, mouth.loudness, mouth.brows];
            prop_assert!((mouth.visemes.iter().sum::<f64>() - 1.0).abs() < 1e-6, "{mouth:?}");
            for value in mouth.visemes.iter().chain(&mouth.articulators).chain(&others) {
                prop_assert!((-1e-9..=1.0 + 1e-6).contains(value), "{mouth:?}");
            }
        }
    }
}
