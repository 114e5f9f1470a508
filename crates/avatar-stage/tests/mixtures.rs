//! Poses, clips, speech and life together, with everything interrupted at any time: values stay in their
//! ranges, are twice continuously differentiable, and the same at every frame rate.

#![allow(clippy::unwrap_used, reason = "helpers of tests fail as tests do")]

mod common;

use avatar_stage::avatar_life::{Life, Style};
use avatar_stage::avatar_pack::Pack;
use avatar_stage::avatar_speech::{Amounts, Speech, Timeline};
use avatar_stage::pose_anim::{Clip, Easing, Key, Track};
use avatar_stage::{Attention, Performer, glam::Vec3};
use common::pack;
use std::sync::Arc;

/// SplitMix64.
struct Random(u64);

impl Random {
    fn share(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let x = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((x ^ (x >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }

    fn between(&mut self, least: f64, most: f64) -> f64 {
        least + (most - least) * self.share()
    }

    fn below(&mut self, count: usize) -> usize {
        (self.share() * count as f64) as usize
    }
}

/// What faces are told in these tests.
struct Told {
    pack: &'static Pack,
    speeches: Vec<Arc<Speech>>,
    clip: Clip,
}

impl Told {
    fn new() -> Self {
        let pack = pack();
        let speeches = [
            "_ 60\nm 70\na 120\nf 80\ni 90\n_ 600\np 60\no 150\ns 90\nu 120\n_ 100",
            "b 60\na 70\nb 60\na 70\nv 60\ne 80\nb 60\n_ 500\nl 70\na 200\n",
            "_ 200\nt 60\nu 200\nm 90\n_ 300",
        ];
        let speeches = speeches.map(|text| Arc::new(Speech::new(&Timeline::read(text, None).unwrap())));
        let jaw = pack.controls().index("jaw.open").unwrap();
        let key = |secs, value| Key::new(secs, value, Easing::MinimumJerk);
        let keys = vec![key(0.0, 0.0), key(0.2, 12.0), key(0.5, 3.0), key(0.9, 0.0)];
        let clip = Clip::new("jaw", vec![Track::new(jaw, keys).unwrap()]).unwrap();
        Self { pack, speeches: speeches.into(), clip }
    }

    fn face(&self, seed: u64) -> Performer {
        let mut face = Performer::new(self.pack.clone());
        let style = Style::PRESETS[seed as usize % Style::PRESETS.len()];
        face.set_life(Some(Life::new(self.pack.controls(), style, seed))).unwrap();
        face
    }

    /// One interruption of whatever the face does; the same for the same random numbers.
    fn interrupt(&self, face: &mut Performer, random: &mut Random) {
        let speech = &self.speeches[random.below(self.speeches.len())];
        let poses = &self.pack.poses().poses;
        let pose = &poses[random.below(poses.len())];
        let controls = self.pack.controls().controls();
        let index = random.below(controls.len());
        let (share, other) = (random.share(), random.share());
        let (control, value) = (&controls[index], share as f32);
        match random.below(12) {
            0..=2 => face.speak(speech.clone(), share * 2.0 - 0.3),
            3 => face.hush(),
            4 | 5 => face.press_pose(pose),
            6 => face.set_control(index, control.min + value * (control.max - control.min)),
            7 => face.play_clip(&self.clip, 0.5 * share).unwrap(),
            8 => face.set_speech_amounts(Amounts { mouth: value, brows: other as f32 }),
            9 => face.set_listening(share > 0.5),
            10 => {
                let size = self.pack.bounds().unwrap();
                let aside = Vec3::new(value - 0.5, other as f32 - 0.5, 2.0) * size.size();
                face.attend(0, Some(Attention::face(size.center() + aside))).unwrap();
            }
            _ => face.life_mut().unwrap().end_utterance(),
        }
    }
}

/// The second derivative of every control, by differences of three values `h` apart.
fn curvatures(values: &[Vec<f64>], h: f64) -> Vec<f64> {
    let [a, b, c] = [&values[0], &values[1], &values[2]];
    a.iter().zip(b).zip(c).map(|((a, b), c)| (a - 2.0 * b + c) / (h * h)).collect()
}

fn all(face: &Performer) -> Vec<f64> {
    (0..face.values().len()).map(|control| face.value(control).unwrap()).collect()
}

/// By how much accelerations differ before and after one interruption of this face, which is to come a moment
/// later; the face goes on as it is.
fn jumps(told: &Told, face: &Performer, seed: u64, h: f64) -> Vec<f64> {
    let mut face = face.clone();
    let take = |face: &mut Performer, interrupted: bool| {
        let mut values = Vec::new();
        if interrupted {
            told.interrupt(face, &mut Random(seed));
        }
        values.push(all(face));
        for _ in 0..2 {
            face.advance(h).unwrap();
            values.push(all(face));
        }
        values
    };
    // Up to the same moment, whatever the step.
    face.advance(4e-4 - 2.0 * h).unwrap();
    let before = take(&mut face, false);
    let after = take(&mut face, true);
    for (control, (before, after)) in before[2].iter().zip(&after[0]).enumerate() {
        let name = &told.pack.controls().controls()[control].name;
        assert!((before - after).abs() < 1e-9, "{name} jumps from {before} to {after}");
    }
    curvatures(&before, h).iter().zip(curvatures(&after, h)).map(|(a, b)| (a - b).abs()).collect()
}

/// Steps of time by which accelerations are told.
const STEPS: [f64; 3] = [1e-4, 5e-5, 1e-5];

/// Goes through so many mixtures, a group after the other.
fn mixtures(count: usize) {
    const GROUP: usize = 50;
    let told = Told::new();
    let controls = told.pack.controls().controls();
    let (mut seen, mut spoken) = (0, 0);
    for group in 0..count / GROUP {
        let mut random = Random(group as u64);
        let mut face = told.face(group as u64);
        let mut worst = [(); STEPS.len()].map(|()| vec![0.0f64; controls.len()]);
        for mixture in 0..GROUP {
            for _ in 0..1 + random.below(4) {
                face.advance(random.between(0.001, 0.12)).unwrap();
                for (control, value) in controls.iter().zip(face.shown()) {
                    assert!((control.min..=control.max).contains(value), "{}: {value}", control.name);
                }
            }
            let seed = (group * GROUP + mixture) as u64 ^ 0x5eed;
            for (worst, h) in worst.iter_mut().zip(STEPS) {
                for (worst, jump) in worst.iter_mut().zip(jumps(&told, &face, seed, h)) {
                    *worst = worst.max(jump);
                }
            }
            spoken += usize::from(face.is_speaking());
            told.interrupt(&mut face, &mut Random(seed));
        }
        // Of continuous accelerations the difference shrinks with the step; where one jumps, it stays. At one
        // of the coarse steps it may be small by chance.
        let [coarse, middle, fine] = &worst;
        for (index, control) in controls.iter().enumerate() {
            let (coarse, fine) = (coarse[index].max(middle[index]), fine[index]);
            // What rounding leaves of values up to 70.
            let rounding = 16.0 * 70.0 * f64::EPSILON / (STEPS[2] * STEPS[2]);
            assert!(fine < 0.5 * coarse + rounding, "{} of group {group}: {coarse} {fine}", control.name);
            seen += usize::from(fine > 10.0 * rounding);
        }
    }
    // The test sees something.
    assert!(seen > count / 10, "{seen}");
    assert!(spoken > count / 3, "{spoken}");
}

#[test]
fn ten_thousand_mixtures_are_smooth_and_keep_their_ranges() {
    mixtures(10_000);
}

/// The largest change of acceleration from one step to the next of each control, over 0.6 s full of
/// interruptions, beginnings and ends of utterances, blinks and saccades.
fn roughness(told: &Told, seed: u64, step_secs: f64) -> Vec<f64> {
    let (mut face, mut random) = (told.face(seed), Random(seed));
    let mut last: Vec<[f64; 4]> = vec![[0.0; 4]; face.values().len()];
    let mut worst = vec![0.0f64; last.len()];
    let mut seen = 0;
    for _ in 0..5 {
        told.interrupt(&mut face, &mut random);
        for _ in 0..(0.12 / step_secs).round() as usize {
            face.advance(step_secs).unwrap();
            for (control, last) in last.iter_mut().enumerate() {
                *last = [last[1], last[2], last[3], face.value(control).unwrap()];
                if seen >= 3 {
                    let third = last[3] - 3.0 * last[2] + 3.0 * last[1] - last[0];
                    worst[control] = worst[control].max(third.abs() / (step_secs * step_secs));
                }
            }
            seen += 1;
        }
    }
    worst
}

/// With a step of a fourth, changes of a continuous acceleration are a fourth, at every time; where it jumps,
/// they stay as they are.
#[test]
fn accelerations_never_jump() {
    let told = Told::new();
    let mut seen = 0;
    for seed in 0..5 {
        let (coarse, fine) = (roughness(&told, seed, 4e-5), roughness(&told, seed, 1e-5));
        for ((control, coarse), fine) in told.pack.controls().controls().iter().zip(coarse).zip(fine) {
            let rounding = 8.0 * 70.0 * f64::EPSILON / 1e-10;
            assert!(fine < 0.5 * coarse + rounding, "{} of seed {seed}: {coarse} {fine}", control.name);
            seen += usize::from(fine > 10.0 * rounding);
        }
    }
    assert!(seen > 60, "{seen}");
}

/// Half a minute with an interruption twice a second; values before each of them.
fn values(told: &Told, steps: &mut dyn FnMut() -> f64) -> Vec<f64> {
    let mut face = told.face(1);
    let mut random = Random(99);
    let mut all_values = Vec::new();
    for _ in 0..60 {
        told.interrupt(&mut face, &mut random);
        let mut left: f64 = random.between(0.03, 0.9);
        while left > 0.0 {
            let dt = steps().min(left);
            face.advance(dt).unwrap();
            left -= dt;
        }
        all_values.extend(all(&face));
    }
    all_values
}

#[test]
fn all_frame_rates_agree() {
    let told = Told::new();
    let once = values(&told, &mut || 5.0);
    assert!(once.iter().filter(|value| value.abs() > 0.01).count() > once.len() / 8);
    let mut random = Random(4);
    let mut steps: Vec<Box<dyn FnMut() -> f64>> =
        [24.0, 60.0, 144.0].map(|rate: f64| Box::new(move || 1.0 / rate) as Box<dyn FnMut() -> f64>).into();
    steps.push(Box::new(move || random.between(0.0005, 0.3)));
    for (which, mut steps) in steps.into_iter().enumerate() {
        let others = values(&told, &mut *steps);
        assert_eq!(once.len(), others.len());
        for (place, (one, other)) in once.iter().zip(&others).enumerate() {
            assert!((one - other).abs() < 1e-5, "{which} at {place}: {one} {other}");
        }
    }
}
