//! What is heard in sound that is made here: vowels of published formants, hiss, silence, noise, nonsense.

#![allow(clippy::expect_used, reason = "a test may panic")]

use std::f64::consts::PI;

use avatar_hearing::{DELAY_SECS, Frame, Hearing, HearingError, VISEMES};

/// Formants of vowels in Hz, of men and of women, and the viseme of each: G. E. Peterson and H. L. Barney,
/// "Control methods used in a study of the vowels", 1952, table II.
const VOWELS: [(&str, [f64; 3], [f64; 3]); 5] = [
    ("ih", [270.0, 2_290.0, 3_010.0], [310.0, 2_790.0, 3_310.0]),
    ("E", [530.0, 1_840.0, 2_480.0], [610.0, 2_330.0, 2_990.0]),
    ("aa", [730.0, 1_090.0, 2_440.0], [850.0, 1_220.0, 2_810.0]),
    ("oh", [570.0, 840.0, 2_410.0], [590.0, 920.0, 2_710.0]),
    ("ou", [300.0, 870.0, 2_240.0], [370.0, 950.0, 2_670.0]),
];

/// Numbers from -1 to 1 by chance, the same in every run.
fn noise(count: usize) -> Vec<f32> {
    let mut seed = 7_u32;
    let mut next = move || {
        seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (seed >> 8) as f32 / (1 << 23) as f32 - 1.0
    };
    (0..count).map(|_| next()).collect()
}

/// A resonator of D. H. Klatt, "Software for a cascade/parallel formant synthesizer", 1980.
fn resonate(samples: &mut [f64], hertz: f64, width: f64, rate: f64) {
    let c = -(-2.0 * PI * width / rate).exp();
    let b = 2.0 * (-PI * width / rate).exp() * (2.0 * PI * hertz / rate).cos();
    let a = 1.0 - b - c;
    let mut past = [0.0; 2];
    for sample in samples {
        let value = a * *sample + b * past[0] + c * past[1];
        past = [value, past[0]];
        *sample = value;
    }
}

/// A fifth of a second of silence, then a vowel of 0.5 s, as loud as somebody speaks, then silence.
fn vowel(formants: &[f64; 3], pitch: f64, rate: u32) -> Vec<f32> {
    let hertz = f64::from(rate);
    let count = (0.5 * hertz) as usize;
    let mut phase = 0.0;
    let mut samples: Vec<f64> = (0..count)
        .map(|index| {
            // The pitch falls, and the breath begins and ends softly.
            let part = index as f64 / count as f64;
            phase += pitch * (1.1 - 0.2 * part) / hertz;
            let pulse = if phase >= 1.0 { 1.0 } else { 0.0 };
            phase -= phase.floor();
            pulse * (PI * part).sin().sqrt()
        })
        .collect();
    // The tilt of the voice, then the mouth.
    resonate(&mut samples, 0.0, 100.0, hertz);
    let upper = [3_500.0, 4_500.0].map(|higher| higher * formants[2] / 2_500.0);
    for (formant, width) in formants.iter().chain(&upper).zip([60.0, 90.0, 150.0, 250.0, 300.0]) {
        if *formant < hertz / 2.0 {
            resonate(&mut samples, *formant, width, hertz);
        }
    }
    // What leaves the lips is the change of the flow.
    let flow = samples.clone();
    for index in 1..count {
        samples[index] = flow[index] - flow[index - 1];
    }
    around(&samples, rate)
}

/// The same level of -20 dB for all, with a fifth of a second of silence on both sides.
fn around(samples: &[f64], rate: u32) -> Vec<f32> {
    let power = samples.iter().map(|sample| sample * sample).sum::<f64>() / samples.len() as f64;
    let scale = 0.1 / power.sqrt();
    let silence = vec![0.0; rate as usize / 5];
    let spoken = samples.iter().map(|sample| (sample * scale) as f32);
    silence.iter().copied().chain(spoken).chain(silence.iter().copied()).collect()
}

fn frames(samples: &[f32], rate: u32) -> Vec<Frame> {
    let mut hearing = Hearing::new(rate).expect("the rate is heard");
    let mut frames = Vec::new();
    hearing.push(samples, |frame| frames.push(*frame));
    hearing.finish(|frame| frames.push(*frame));
    frames
}

/// Mean weights between two times.
fn mean(frames: &[Frame], begin: f64, end: f64) -> [f32; 15] {
    let mut sum = [0.0; 15];
    let inside: Vec<&Frame> = frames.iter().filter(|frame| (begin..end).contains(&frame.time_secs)).collect();
    for frame in &inside {
        for (sum, weight) in sum.iter_mut().zip(frame.weights) {
            *sum += weight / inside.len() as f32;
        }
    }
    sum
}

fn strongest(weights: [f32; 15]) -> &'static str {
    VISEMES[Frame { time_secs: 0.0, weights, loudness: 0.0 }.strongest()]
}

#[test]
fn vowels_of_published_formants_are_heard() {
    for (viseme, men, women) in VOWELS {
        for (formants, pitch) in [(men, 120.0), (women, 210.0)] {
            let heard = frames(&vowel(&formants, pitch, 16_000), 16_000);
            let weights = mean(&heard, 0.3, 0.6);
            assert_eq!(strongest(weights), viseme, "{formants:?}: {weights:?}");
        }
    }
}

#[test]
fn a_vowel_is_the_same_at_every_rate() {
    for rate in [8_000, 11_025, 22_050, 44_100, 48_000, 96_000, 192_000] {
        for viseme in ["aa", "ih", "ou"] {
            let (_, men, _) =
                VOWELS.into_iter().find(|(name, ..)| *name == viseme).expect("it is in the table");
            let weights = mean(&frames(&vowel(&men, 120.0, rate), rate), 0.3, 0.6);
            assert_eq!(strongest(weights), viseme, "{rate}: {weights:?}");
        }
    }
}

/// The hiss of "s" is noise above 4 kHz, that of "sh" around 2.5 to 4 kHz.
#[test]
fn hisses_are_heard() {
    for (viseme, hertz, width) in [("SS", 5_800.0, 1_200.0), ("CH", 2_900.0, 900.0)] {
        let mut samples: Vec<f64> = noise(4_000).into_iter().map(f64::from).collect();
        for _ in 0..2 {
            resonate(&mut samples, hertz, width, 16_000.0);
        }
        let flow = samples.clone();
        for index in 1..samples.len() {
            samples[index] = flow[index] - flow[index - 1];
        }
        // Between two vowels, as in speech: hissing alone may be a kettle.
        let (_, men, _) = VOWELS[2];
        let voiced = vowel(&men, 120.0, 16_000);
        let power = samples.iter().map(|sample| sample * sample).sum::<f64>() / samples.len() as f64;
        let hiss = samples.iter().map(|sample| (sample * 0.05 / power.sqrt()) as f32);
        let all: Vec<f32> =
            voiced[..11_000].iter().copied().chain(hiss).chain(voiced[3_300..].iter().copied()).collect();
        let weights = mean(&frames(&all, 16_000), 0.72, 0.9);
        assert_eq!(strongest(weights), viseme, "{weights:?}");
    }
}

#[test]
fn the_mouth_is_shut_in_silence() {
    let quiet: Vec<f32> = noise(32_000).into_iter().map(|value| value * 5e-4).collect();
    for samples in [vec![0.0; 32_000], quiet] {
        for frame in frames(&samples, 16_000) {
            assert!(frame.weights[0] > 0.99 && frame.loudness == 0.0, "{frame:?}");
        }
    }
    // Before and behind a word, too.
    let (_, men, _) = VOWELS[2];
    let heard = frames(&vowel(&men, 120.0, 16_000), 16_000);
    assert!(mean(&heard, 0.0, 0.15)[0] > 0.9);
    assert!(mean(&heard, 0.8, 0.9)[0] > 0.9);
    // And it is loud in between.
    let loudest = heard.iter().map(|frame| frame.loudness).fold(0.0, f32::max);
    assert!(loudest > 0.6, "{loudest}");
}

/// Onsets: the vowel begins at 0.2 s.
#[test]
fn a_vowel_is_heard_when_it_begins() {
    for (viseme, men, _) in VOWELS {
        let heard = frames(&vowel(&men, 120.0, 16_000), 16_000);
        let first = heard.iter().find(|frame| frame.weights[0] < 0.5).expect("something is heard");
        assert!((first.time_secs - 0.2).abs() < 0.04, "{viseme}: {}", first.time_secs);
    }
}

/// When a frame comes is measured in samples that went in until then.
#[test]
fn no_frame_comes_later_than_the_delay() {
    for rate in [8_000, 16_000, 44_100, 192_000] {
        let mut hearing = Hearing::new(rate).expect("the rate is heard");
        let mut last = None;
        for (index, sample) in noise(rate as usize / 2).into_iter().enumerate() {
            let now = (index + 1) as f64 / f64::from(rate);
            hearing.push(&[sample], |frame| {
                assert!(now - frame.time_secs <= DELAY_SECS + 1e-9, "{rate}: {now} {}", frame.time_secs);
                if let Some(last) = last.replace(frame.time_secs) {
                    assert!((frame.time_secs - last - 0.01).abs() < 1e-9);
                }
            });
        }
        assert!(last.is_some_and(|last| last > 0.42));
    }
    const { assert!(DELAY_SECS <= 0.060) };
}

#[test]
fn pieces_of_any_length_are_heard_alike() {
    let (_, _, women) = VOWELS[0];
    let samples = vowel(&women, 210.0, 44_100);
    let whole = frames(&samples, 44_100);
    for length in [1, 7, 441, 1_000, 9_999] {
        let mut hearing = Hearing::new(44_100).expect("the rate is heard");
        let mut pieces = Vec::new();
        for piece in samples.chunks(length) {
            hearing.push(piece, |frame| pieces.push(*frame));
        }
        hearing.finish(|frame| pieces.push(*frame));
        assert_eq!(pieces, whole, "{length}");
        // And again, as if it were new.
        hearing.reset();
        let mut again = Vec::new();
        hearing.push(&samples, |frame| again.push(*frame));
        assert_eq!(again[..], whole[..again.len()]);
    }
}

#[test]
fn samples_that_are_no_numbers_do_no_harm() {
    let bad = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, f32::MAX, f32::MIN, f32::MIN_POSITIVE, -0.0, 1e20];
    let mut samples: Vec<f32> = bad.iter().copied().cycle().take(8_000).collect();
    samples.extend(noise(8_000));
    let (_, men, _) = VOWELS[2];
    samples.extend(std::iter::repeat_n(0.0, 160_000));
    samples.extend(vowel(&men, 120.0, 16_000));
    let heard = frames(&samples, 16_000);
    // What is no number is heard as 0, and what lies beyond the range as its end.
    let meant: Vec<f32> =
        samples.iter().map(|sample| if sample.is_finite() { sample.clamp(-1.0, 1.0) } else { 0.0 }).collect();
    assert_eq!(frames(&meant, 16_000), heard);
    for frame in &heard {
        let sum: f32 = frame.weights.iter().sum();
        assert!((sum - 1.0).abs() < 1e-4 && frame.weights.iter().all(|weight| (0.0..=1.0).contains(weight)));
        assert!((0.0..=1.0).contains(&frame.loudness));
    }
    // Ten seconds later, nothing of it is left.
    assert_eq!(strongest(mean(&heard, 11.3, 11.6)), "aa");
}

#[test]
fn rates_that_are_not_heard_are_said() {
    for rate in [0, 1, 7_999, 192_001, u32::MAX] {
        let error = Hearing::new(rate).err();
        assert_eq!(error, Some(HearingError::Rate { found: rate, least: 8_000, most: 192_000 }));
    }
    for rate in [8_000, 8_001, 44_056, 191_999, 192_000] {
        assert!(Hearing::new(rate).is_ok());
    }
}

#[test]
fn nothing_allocates_after_the_beginning() {
    let samples = noise(48_000);
    let mut hearing = Hearing::new(48_000).expect("the rate is heard");
    let mut count = 0;
    let info = allocation_counter::measure(|| {
        for piece in samples.chunks(480) {
            hearing.push(piece, |frame| count += usize::from(frame.loudness > 0.0));
        }
        hearing.finish(|_| ());
        hearing.reset();
    });
    assert_eq!(info.count_total, 0);
    assert!(count > 80);
}

#[test]
fn models_that_are_none_are_refused() {
    use avatar_hearing::model::{MAGIC, Model};
    let model = Model::shipped().expect("the shipped model is one");
    let bytes = model.to_bytes();
    assert!(bytes.len() <= 400_000, "{}", bytes.len());
    assert!(bytes.starts_with(&MAGIC));
    // Its numbers survive: a weight is rounded by half a part in 32,767 of the largest in its row.
    let again = Model::from_bytes(&bytes).expect("what is written is read");
    for (layer, again) in model.layers.iter().zip(&again.layers) {
        let rows = layer.weights.chunks(layer.outputs).chain([&layer.constant[..]]);
        let again = again.weights.chunks(layer.outputs).chain([&again.constant[..]]);
        for (row, again) in rows.zip(again) {
            let most = row.iter().fold(0.0_f32, |most, weight| most.max(weight.abs()));
            let error = row.iter().zip(again).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
            assert!(error <= 0.51 / 32_767.0 * most, "{error} of {most}");
        }
    }
    for length in (0..bytes.len()).step_by(997).chain([bytes.len() - 1]) {
        assert_eq!(Model::from_bytes(&bytes[..length]), None, "{length}");
    }
    let mut longer = bytes.clone();
    longer.push(0);
    assert_eq!(Model::from_bytes(&longer), None);
    // Any byte changed: another model, or none, and never a panic.
    for place in (0..bytes.len()).step_by(463) {
        let mut changed = bytes.clone();
        changed[place] ^= 0xff;
        let _ = Model::from_bytes(&changed);
    }
}
