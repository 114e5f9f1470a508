//! How the mouth moves.

use avatar_speech::{Articulator, Cue, Loudness, Mouth, Speech, Timeline, Viseme};
use proptest::prelude::*;

fn speech(text: &str) -> Speech {
    Speech::new(&Timeline::read(text, None).unwrap_or_else(|error| panic!("{error}")))
}

/// A consonant and a vowel, again and again, at a number of syllables a second; a consonant takes 0.4 of it.
fn syllables(consonant: &str, vowel: &str, rate: f64) -> String {
    let [short, long] = [400.0 / rate, 600.0 / rate];
    format!("_ 300\n{}_ 300\n", format!("{consonant} {short}\n{vowel} {long}\n").repeat(12))
}

fn of(mouth: &Mouth, articulator: Articulator) -> f64 {
    mouth.articulators[articulator as usize]
}

const RATES: [f64; 7] = [3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0];

#[test]
fn lips_close_at_every_p_b_m_and_open_between_them() {
    for rate in RATES {
        for vowel in ["a", "i", "u", "o"] {
            for consonant in ["p", "b", "m"] {
                let speech = speech(&syllables(consonant, vowel, rate));
                for syllable in 0..12 {
                    let start = 0.3 + f64::from(syllable) / rate;
                    // Of the fastest consonant this is 29 ms, so a film of 60 pictures a second shows it in
                    // one at least.
                    for share in [0.1, 0.25, 0.5, 0.75] {
                        let mouth = speech.at(start + share * 0.4 / rate);
                        assert_eq!(mouth.closed, 1.0, "{consonant}{vowel} at {rate}, {share}");
                        assert_eq!(of(&mouth, Articulator::JawOpen), 0.0);
                        assert_eq!(of(&mouth, Articulator::MouthFunnel), 0.0);
                    }
                    let open = speech.at(start + 0.7 / rate);
                    assert!(open.closed < 0.15, "{consonant}{vowel} at {rate}: {}", open.closed);
                }
            }
        }
    }
}

#[test]
fn the_lip_is_bitten_at_every_f_and_v() {
    for rate in RATES {
        let speech = speech(&syllables("f", "a", rate));
        for syllable in 0..12 {
            let mouth = speech.at(0.3 + (f64::from(syllable) + 0.2) / rate);
            assert_eq!((mouth.bitten, mouth.closed), (1.0, 0.0));
        }
    }
    // One after the other, as in German "Pfeife": both are reached.
    let speech = speech("_ 200\np 60\nf 70\na 150\nf 60\nm 60\n_ 200");
    assert_eq!((speech.at(0.23).closed, speech.at(0.23).bitten), (1.0, 0.0));
    assert_eq!((speech.at(0.295).closed, speech.at(0.295).bitten), (0.0, 1.0));
}

/// Vowels become smaller in quick speech (Lindblom 1963), and are whole in slow speech.
#[test]
fn quick_vowels_are_smaller() {
    let most = |rate: f64| {
        let speech = speech(&syllables("t", "a", rate));
        let times = (0..1000).map(|step| 0.3 + 4.0 / rate + f64::from(step) / 1000.0 * 4.0 / rate);
        times.map(|secs| of(&speech.at(secs), Articulator::JawOpen)).fold(0.0, f64::max)
    };
    let jaws = RATES.map(most);
    assert!(jaws.windows(2).all(|pair| pair[1] <= pair[0] + 1e-9), "{jaws:?}");
    assert!(jaws[0] > 0.45, "{jaws:?}");
    assert!(jaws[6] < 0.9 * jaws[0], "{jaws:?}");
}

/// The lips are round for "t" in "tu", and not in "ti", before the vowel begins; the tongue is alike.
#[test]
fn a_vowel_is_prepared_by_the_consonants_before_it() {
    let rounded = |vowel: &str| {
        let speech = speech(&format!("_ 300\ns 80\nt 80\n{vowel} 200\n_ 300"));
        of(&speech.at(0.42), Articulator::MouthPucker)
    };
    assert!(rounded("u") > 0.2, "{}", rounded("u"));
    assert!(rounded("i") < 0.02, "{}", rounded("i"));
}

/// The jaw begins first and takes longest, the tip of the tongue begins last and is the fastest.
#[test]
fn jaw_lips_and_tongue_have_their_own_times() {
    let speech = speech("_ 500\nth 300\n_ 500");
    let jaw = |mouth: &Mouth| of(mouth, Articulator::JawOpen) / (0.55 + 0.9 * mouth.loudness);
    let lips = |mouth: &Mouth| of(mouth, Articulator::MouthUpperUp);
    let tongue = |mouth: &Mouth| of(mouth, Articulator::TongueOut);
    // When a part begins, and how long it takes from a twentieth of its way to nineteen of them.
    let movement = |part: &dyn Fn(&Mouth) -> f64| {
        let way: Vec<f64> = (0..650).map(|step| part(&speech.at(f64::from(step) / 1000.0))).collect();
        let most = way.iter().copied().fold(0.0, f64::max);
        let reached = |share: f64| way.iter().position(|value| *value >= share * most).unwrap();
        [reached(0.05), reached(0.95) - reached(0.05)]
    };
    let [jaw, lips, tongue] = [movement(&jaw), movement(&lips), movement(&tongue)];
    assert!(jaw[0] < lips[0] && lips[0] < tongue[0], "{jaw:?} {lips:?} {tongue:?}");
    assert!(jaw[1] > lips[1] && lips[1] > tongue[1], "{jaw:?} {lips:?} {tongue:?}");
}

#[test]
fn a_louder_syllable_opens_the_jaw_further_and_lifts_the_brows() {
    let text = |stress: &str| format!("0 0.3 sil\n0.3 0.38 T\n0.38 0.6 AA{stress}\n0.6 0.9 sil\n");
    let at = |stress| speech(&text(stress)).at(0.48);
    let (weak, main) = (at("0"), at("1"));
    assert!(of(&main, Articulator::JawOpen) > 1.15 * of(&weak, Articulator::JawOpen));
    assert!(main.brows > 0.01 && weak.brows == 0.0, "{} {}", main.brows, weak.brows);
    // The loudness of a recording takes the place of stresses.
    let loud = speech(&text("0")).with_loudness(Loudness::new(10.0, vec![0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0]));
    assert!((loud.at(0.48).loudness - 1.0).abs() < 0.05, "{}", loud.at(0.48).loudness);
    assert!(of(&loud.at(0.48), Articulator::JawOpen) > of(&main, Articulator::JawOpen));
    // Lips close all the same.
    let shouted = speech("a 100\np 80\na 100").with_loudness(Loudness::new(10.0, vec![1.0; 5]));
    assert_eq!(of(&shouted.at(0.14), Articulator::JawOpen), 0.0);
}

#[test]
fn silence_is_silent() {
    let speech = speech("_ 500\na 200\np 100\n_ 900");
    for secs in [-1.0, 0.0, 0.2, 1.3, 1.7, 9.0, speech.rest_secs()] {
        let mouth = speech.at(secs);
        assert_eq!(mouth.visemes[Viseme::Sil.index()], 1.0, "{secs}");
        assert_eq!(of(&mouth, Articulator::JawOpen), 0.0);
    }
}

/// All numbers of a mouth.
fn numbers(mouth: &Mouth) -> impl Iterator<Item = f64> {
    let others = [mouth.closed, mouth.bitten, mouth.loudness, mouth.brows];
    mouth.visemes.into_iter().chain(mouth.articulators).chain(others)
}

/// The largest step of a second derivative, by finite differences, between neighbouring times.
fn largest_step(values: impl Fn(f64) -> Vec<f64>, [from, to]: [f64; 2], width: f64) -> f64 {
    let count = ((to - from) / width) as usize;
    let (mut largest, mut before): (f64, Option<Vec<f64>>) = (0.0, None);
    for step in 0..count {
        let at = from + step as f64 * width;
        let [a, b, c] = [at - width, at, at + width].map(&values);
        let bent = |((a, b), c): ((&f64, &f64), &f64)| (a - 2.0 * b + c) / (width * width);
        let now: Vec<f64> = a.iter().zip(&b).zip(&c).map(bent).collect();
        if let Some(before) = &before {
            largest = now.iter().zip(before).map(|(a, b)| (a - b).abs()).fold(largest, f64::max);
        }
        before = Some(now);
    }
    largest
}

/// A second derivative without jumps: its steps shrink with the width of the differences; at a jump they
/// would stay. A third derivative that is bounded makes them four times smaller.
fn is_smooth(values: impl Fn(f64) -> Vec<f64>, range: [f64; 2]) -> Result<(), [f64; 2]> {
    let [wide, narrow] = [4e-4, 1e-4].map(|width| largest_step(&values, range, width));
    if narrow < 0.4 * wide + 1.0 { Ok(()) } else { Err([wide, narrow]) }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn motion_is_smooth(
        steps in proptest::collection::vec((0_usize..15, 0.013_f64..0.3, 0.0_f32..1.0), 4..14),
        loud in proptest::collection::vec(0.0_f32..1.0, 20),
    ) {
        let mut secs = 0.0;
        let cues: Vec<_> = steps.iter().map(|&(viseme, length, stress)| {
            let start_secs = secs;
            secs += length;
            Cue { start_secs, end_secs: secs, viseme: Viseme::ALL[viseme], stress }
        }).collect();
        let speech = Speech::new(&Timeline::new(cues).unwrap());
        let speeches = [speech.clone(), speech.with_loudness(Loudness::new(10.0, loud))];
        for speech in &speeches {
            let smooth = is_smooth(|secs| numbers(&speech.at(secs)).collect(), [-0.4, secs + 0.4]);
            prop_assert_eq!(smooth, Ok(()));
        }
    }
}

/// The measure above finds a jump of 100/s² in the acceleration of one of two numbers, a sixth of what an
/// articulator has that goes all the way in a tenth of a second, wherever between two times it lies.
#[test]
fn the_measure_of_smoothness_finds_a_kink() {
    for kink in [0.1, 0.100_03, 0.100_07, 0.100_2] {
        let bent = |secs: f64| vec![secs.sin(), 50.0 * (secs - kink).max(0.0).powi(2)];
        assert!(is_smooth(bent, [0.0, 0.2]).is_err(), "{kink}");
    }
    assert_eq!(is_smooth(|secs| vec![100.0 * secs.sin()], [0.0, 0.2]), Ok(()));
}
