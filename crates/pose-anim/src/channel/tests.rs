use super::*;
use crate::brake::tests::FALLBACKS;
use crate::{Easing, Key, Track, Wrap};
use std::cell::Cell;

thread_local! {
    /// How often the nest of fades was full.
    pub(crate) static FOLDS: Cell<u32> = const { Cell::new(0) };
}

const RANGE: Range = Range { min: -2.0, max: 3.0 };

fn spec(target: f64, secs: f64) -> MoveSpec {
    MoveSpec { target, duration_secs: Some(secs), ..MoveSpec::NONE }
}

/// SplitMix64 (Steele, Lea & Flood 2014).
struct Random(u64);

impl Random {
    fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }

    fn one_of<T: Copy>(&mut self, items: &[T]) -> T {
        items[(self.unit() * items.len() as f64) as usize]
    }
}

fn assert_same(before: Jet, after: Jet, what: &str) {
    // What moves in a hundredth of a second may round so much in its derivatives.
    let within = |a: f64, b: f64| (a - b).abs() <= 1e-9 * (1.0 + a.abs());
    assert!((before.value - after.value).abs() <= 1e-12, "{what}: {before:?} {after:?}");
    assert!(within(before.velocity, after.velocity), "{what}: {before:?} {after:?}");
    assert!(within(before.acceleration, after.acceleration), "{what}: {before:?} {after:?}");
}

/// Far more presses than can be nested, of everything that can be inside a nest: nothing jumps at any of
/// them, the nest is folded over and over, and every fold finds a way within the range.
#[test]
fn folds_keep_value_velocity_and_acceleration() {
    let (folds, fallbacks) = (FOLDS.get(), FALLBACKS.get());
    let mut random = Random(3);
    let ends = [RANGE.min, -1.0, 2.5, RANGE.max];
    let easings = ["linear", "cubic-out", "step", "ease-in-out"].map(|name| Easing::from_name(name).unwrap());
    for round in 0..2000 {
        let (mut channel, mut cold) = (Channel::rest(RANGE, 0.0), Cold::new());
        for press in 0..40 {
            let before = channel.state(&cold);
            let (target, secs) = (random.one_of(&ends), random.one_of(&[0.05, 0.4, 2.0]));
            match (random.unit() * 6.0) as u32 {
                0 => {
                    let key = |time, value| Key::new(time, value, Easing::MinimumJerk);
                    let keys = vec![key(0.0, target), key(0.3, random.one_of(&ends)), key(0.6, target)];
                    let clip = Clip::new("c", vec![Track::new(0, keys).unwrap()]).unwrap();
                    let clip = clip.wrapped(random.one_of(&[Wrap::Once, Wrap::Loop, Wrap::PingPong]));
                    channel.play(&Arc::new(clip), 0, Pace::OTHER, Some(secs), &mut cold);
                }
                1 => {
                    let easing = Some(random.one_of(&easings));
                    channel.press(MoveSpec { easing, ..spec(target, secs) }, 0.0, &mut cold);
                }
                _ => channel.press(spec(target, secs), 0.0, &mut cold),
            }
            assert_same(before, channel.state(&cold), &format!("round {round}, press {press}"));
            for _ in 0..3 {
                let state = channel.advance(0.01 * random.unit(), &mut cold);
                let slack = 1e-12 * RANGE.width();
                assert!((RANGE.min - slack..=RANGE.max + slack).contains(&state.value), "{state:?}");
            }
        }
    }
    assert!(FOLDS.get() - folds > 3000, "{}", FOLDS.get() - folds);
    assert_eq!(FALLBACKS.get(), fallbacks);
}

/// A move that begins at the very moment of another one replaces it, whatever the first one was.
#[test]
fn a_press_at_the_same_moment_replaces() {
    let mut random = Random(5);
    let mut faded = 0;
    for _ in 0..500 {
        let (mut channel, mut cold) = (Channel::rest(RANGE, 0.0), Cold::new());
        for _ in 0..3 {
            let to = RANGE.min + random.unit() * RANGE.width();
            channel.press(spec(to, 0.1 + 0.5 * random.unit()), 0.0, &mut cold);
            channel.advance(0.2 * random.unit(), &mut cold);
        }
        let (mut alone, mut alone_cold) = (channel.clone(), cold.clone());
        // Direct or not, and more than one.
        for _ in 0..3 {
            let to = RANGE.min + random.unit() * RANGE.width();
            channel.press(spec(to, 0.05 + 0.4 * random.unit()), 0.0, &mut cold);
        }
        let last = spec(random.one_of(&[RANGE.max, 0.0]), 0.9);
        channel.press(last, 0.0, &mut cold);
        alone.press(last, 0.0, &mut alone_cold);
        faded += u32::from(alone.fades > 0);
        for _ in 0..20 {
            assert_eq!(channel.advance(0.05, &mut cold), alone.advance(0.05, &mut alone_cold));
        }
    }
    assert!((100..400).contains(&faded), "{faded}");
    // It also takes back a direct move that a stop follows at once.
    let (mut channel, mut cold) = (Channel::rest(RANGE, 0.5), Cold::new());
    channel.press(spec(2.0, 0.3), 0.0, &mut cold);
    channel.stop(Pace::OTHER, &mut cold);
    assert!(channel.is_at_rest(&cold) && channel.advance(1.0, &mut cold) == Jet::rest(0.5));
}

#[test]
fn a_clip_is_let_go_of_when_it_has_no_part_any_more() {
    let keys = [0.0, 0.2].map(|time| Key::new(time, 5.0 * time, Easing::MinimumJerk)).to_vec();
    let clip = Arc::new(Clip::new("c", vec![Track::new(0, keys).unwrap()]).unwrap());
    let looped = Arc::new(Clip::clone(&clip).wrapped(Wrap::PingPong));
    let (mut channel, mut cold) = (Channel::rest(RANGE, 0.0), Cold::new());
    for next in [0.0, 2.0] {
        channel.play(&clip, 0, Pace::OTHER, Some(0.1), &mut cold);
        channel.advance(0.05, &mut cold);
        channel.play(&looped, 0, Pace::OTHER, Some(0.1), &mut cold);
        channel.advance(0.15, &mut cold);
        assert_eq!((Arc::strong_count(&clip), Arc::strong_count(&looped)), (1, 2));
        channel.press(spec(next, 0.2), 0.0, &mut cold);
        channel.advance(0.2, &mut cold);
        assert_eq!((Arc::strong_count(&clip), Arc::strong_count(&looped)), (1, 1));
    }
}

/// Keys beyond the range and cubics that bulge out of it stay in range inside the channel, and so does all
/// that becomes of them; a transition function that overshoots on purpose goes through to where the player
/// decides.
#[test]
fn clips_stay_in_range_unless_they_overshoot_on_purpose() {
    let steep = crate::Transition::Hermite { leaving: 60.0, arriving: -60.0 };
    let key = |time_secs, value, transition| Key { time_secs, value, transition };
    let line = crate::Transition::LINEAR;
    let tracks = [
        vec![key(0.0, 1.0, steep), key(0.5, 1.0, steep), key(1.0, -1.0, line)],
        vec![key(0.0, -9.0, line), key(0.4, 50.0, line), key(1.0, 7.0, line)],
    ];
    let slack = 1e-12 * RANGE.width();
    for keys in tracks {
        for wrap in [Wrap::Once, Wrap::Loop, Wrap::PingPong] {
            let clip = Clip::new("c", vec![Track::new(0, keys.clone()).unwrap()]).unwrap().wrapped(wrap);
            let (mut channel, mut cold) = (Channel::rest(RANGE, 0.0), Cold::new());
            channel.play(&Arc::new(clip), 0, Pace::OTHER, Some(0.05), &mut cold);
            for step in 0..300 {
                if step == 200 {
                    channel.press(spec(2.0, 0.5), 0.0, &mut cold);
                }
                let state = channel.advance(0.01, &mut cold);
                assert!((RANGE.min - slack..=RANGE.max + slack).contains(&state.value), "{step}: {state:?}");
            }
        }
    }
    let back = Easing::from_name("back-out").unwrap();
    let keys = vec![Key::new(0.0, 0.0, back), Key::new(1.0, RANGE.max, Easing::Linear)];
    let clip = Arc::new(Clip::new("c", vec![Track::new(0, keys).unwrap()]).unwrap());
    let (mut channel, mut cold) = (Channel::rest(RANGE, 0.0), Cold::new());
    channel.play(&clip, 0, Pace::OTHER, Some(0.05), &mut cold);
    let highest = (0..100).map(|_| channel.advance(0.01, &mut cold).value).fold(0.0, f64::max);
    assert!(highest > RANGE.max + 0.1, "{highest}");
}

/// Four fades that are over cost nothing and hide nothing.
#[test]
fn fades_that_are_over_leave_the_outermost_target() {
    let (mut channel, mut cold) = (Channel::rest(RANGE, 0.0), Cold::new());
    let easing = Easing::from_name("linear");
    for target in [1.0, 2.0, -1.0] {
        channel.press(MoveSpec { easing, ..spec(target, 1.0) }, 0.0, &mut cold);
        channel.advance(0.09, &mut cold);
    }
    assert_eq!(channel.fades, 3);
    channel.advance(0.25, &mut cold);
    assert_eq!((channel.fades, channel.other_base), (0, true));
    assert_eq!(channel.advance(0.67, &mut cold), Jet::rest(-1.0));
    assert!(channel.sleeps());
}
