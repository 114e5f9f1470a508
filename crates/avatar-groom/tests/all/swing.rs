//! Time in ticks, and springs that are exact.

use avatar_groom::{Oscillator, SEGMENTS, TICKS_PER_SECOND, TickClock};

/// The spring, by a thousand small steps a tick (Störmer and Verlet with half steps of the speed).
fn by_small_steps(frequency: f64, mut y: f64, mut v: f64, ticks: u32) -> (f64, f64) {
    let omega = frequency * std::f64::consts::TAU;
    let steps = 1000;
    let h = 1.0 / f64::from(TICKS_PER_SECOND) / f64::from(steps);
    let pull = |y: f64, v: f64| -omega * omega * y - 2.0 * 0.4 * omega * v;
    for _ in 0..ticks * steps {
        let half = v + 0.5 * h * pull(y, v);
        y += h * half;
        v = half + 0.5 * h * pull(y, half);
    }
    (y, v)
}

#[test]
fn a_tick_is_what_many_small_steps_are() {
    for frequency in [0.7f32, 1.8, 6.0, 25.0] {
        let spring = Oscillator::new(frequency, 1.0 / f64::from(TICKS_PER_SECOND));
        let (mut y, mut v) = (1.0f32, -3.0f32);
        for _ in 0..40 {
            (y, v) = (spring.place[0] * y + spring.place[1] * v, spring.speed[0] * y + spring.speed[1] * v);
        }
        let (wanted, speed) = by_small_steps(f64::from(frequency), 1.0, -3.0, 40);
        assert!((f64::from(y) - wanted).abs() < 1e-3, "{frequency}: {y} {wanted}");
        assert!((f64::from(v) - speed).abs() < 2e-2 * speed.abs().max(1.0), "{frequency}: {v} {speed}");
    }
    let held = Oscillator::new(0.0, 0.1);
    assert_eq!((held.place, held.speed), ([0.0; 2], [0.0; 2]));
    assert_eq!(Oscillator::new(f32::NAN, 0.1).place, [0.0; 2]);
}

#[test]
fn strands_are_stiffer_at_the_root() {
    let along = Oscillator::along(1.8);
    assert_eq!(along[1].place, [0.0; 2]);
    for i in 3..=SEGMENTS {
        assert!(along[i].place[0] > along[i - 1].place[0]);
    }
}

#[test]
fn every_frame_rate_has_the_same_ticks() {
    for rate in [24u16, 30, 60, 75, 144, 360] {
        let mut clock = TickClock::default();
        let (mut count, mut last) = (0, -1.0f64);
        for frame in 0..rate * 4 {
            let ticks = clock.advance(1.0 / f64::from(rate));
            for k in 0..ticks.count {
                let at = f64::from(frame) + f64::from(ticks.first) + f64::from(k) * f64::from(ticks.step);
                let seconds = at / f64::from(rate);
                let wanted = f64::from(count + k + 1) / f64::from(TICKS_PER_SECOND);
                assert!((seconds - wanted).abs() < 2e-5, "{rate}: {seconds} {wanted}");
                assert!(seconds > last);
                last = seconds;
            }
            count += ticks.count;
        }
        assert!(count.abs_diff(4 * TICKS_PER_SECOND as u32) <= 1, "{rate}: {count}");
    }
}

#[test]
fn a_time_that_is_nan_or_out_of_range_leaves_hair_still() {
    let mut clock = TickClock::default();
    for seconds in [f64::NAN, -1.0, f64::INFINITY, 3.0] {
        assert!(clock.advance(seconds).is_still, "{seconds}");
    }
    assert!(clock.advance(1e-40).step.is_finite());
    let none = clock.advance(0.0);
    assert!(!none.is_still && none.count == 0 && none.step.is_finite());
}
