//! An hour of life against the ranges of the literature (named in src/parameters.rs).

use crate::face::full;
use avatar_life::{Amounts, Life, Saccade, Style, Target};

const HOUR_SECS: f64 = 3600.0;

/// What happens in an hour, seen from outside in steps of 2 ms.
#[derive(Default)]
struct Hour {
    /// Starts of blinks, and of each the seconds down to the lowest place, and up again.
    blinks: Vec<f64>,
    down: Vec<f64>,
    up: Vec<f64>,
    fastest_down: Vec<f64>,
    fastest_up: Vec<f64>,
    saccades: Vec<Saccade>,
    micro: u64,
    breaths: u64,
}

const STEP_SECS: f64 = 0.002;

fn hour(style: Style, target: Option<Target>) -> Hour {
    let controls = full();
    let mut life = Life::new(&controls, Style { droop: 0.0, ..style }, 11);
    life.attend(0, target);
    let mut hour = Hour::default();
    let (mut before, mut start, mut lowest, mut speeds) = (0.0, None, (0.0, 0.0), [0.0f64; 2]);
    for step in 1..=(HOUR_SECS / STEP_SECS) as u64 {
        let now = step as f64 * STEP_SECS;
        life.advance(STEP_SECS).unwrap();
        let closed = life.closed();
        match start {
            None if closed > 0.0 => {
                (start, lowest, speeds) = (Some(now), (now, closed), [0.0; 2]);
            }
            Some(from) => {
                let speed = (closed - before) / STEP_SECS;
                speeds = [speeds[0].max(speed), speeds[1].max(-speed)];
                if closed > lowest.1 {
                    lowest = (now, closed);
                }
                if closed == 0.0 {
                    hour.blinks.push(from);
                    hour.down.push(lowest.0 - from);
                    hour.up.push(now - lowest.0);
                    hour.fastest_down.push(speeds[0]);
                    hour.fastest_up.push(speeds[1]);
                    start = None;
                }
            }
            None => {}
        }
        before = closed;
        if let Some(saccade) = life.latest_saccade()
            && hour.saccades.last() != Some(&saccade)
        {
            hour.saccades.push(saccade);
        }
    }
    hour.micro = life.counts().micro_saccades;
    hour.breaths = life.counts().breaths;
    hour
}

fn mean(of: &[f64]) -> f64 {
    of.iter().sum::<f64>() / of.len() as f64
}

fn quantile(of: &[f64], share: f64) -> f64 {
    let mut sorted = of.to_vec();
    sorted.sort_by(f64::total_cmp);
    sorted[((sorted.len() - 1) as f64 * share) as usize]
}

fn of_all(check: impl Fn(&Style, &Hour)) {
    for style in Style::PRESETS {
        check(&style, &hour(style, None));
    }
}

#[test]
fn an_hour_of_each_preset() {
    of_all(|style, hour| {
        blinks(style, hour);
        saccades(style, hour);
        fixations(style, hour);
        small_and_slow(style, hour);
    });
}

/// Bentivoglio et al. 1997: 17 blinks a minute at rest, 26 in conversation; who is tense or tired blinks
/// more.
/// Evinger et al. 1991, VanderWerf et al. 2003: down in 75 to 100 ms, up in about twice that, down faster.
fn blinks(style: &Style, hour: &Hour) {
    let name = style.name;
    let rate = hour.blinks.len() as f64 / 60.0;
    let expected = match name {
        "calm" | "listening" => 12.0..20.0,
        "lively" | "tired" => 17.0..27.0,
        _ => 24.0..36.0,
    };
    assert!(expected.contains(&rate), "{name}: {rate} blinks a minute");

    let between: Vec<f64> = hour.blinks.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let doubles = between.iter().filter(|secs| **secs < 0.7).count() as f64 / between.len() as f64;
    assert!((0.03..0.2).contains(&doubles), "{name}: {doubles} of blinks are doubles");
    // Skewed to long times: the mean is above the median, and some wait three times as long.
    let single: Vec<f64> = between.iter().copied().filter(|secs| *secs >= 0.7).collect();
    let (middle, long) = (quantile(&single, 0.5), quantile(&single, 0.95));
    assert!(mean(&single) > 1.05 * middle, "{name}: {} {middle}", mean(&single));
    assert!((1.8..5.0).contains(&(long / middle)), "{name}: {long} {middle}");

    let slow = style.blink_slowness;
    let (down, up) = (quantile(&hour.down, 0.5) / slow, quantile(&hour.up, 0.5) / slow);
    assert!((0.075..0.1).contains(&down), "{name}: {down} s down");
    assert!((0.15..0.25).contains(&up), "{name}: {up} s up");
    let ratio = mean(&hour.fastest_down) / mean(&hour.fastest_up);
    assert!((1.3..3.0).contains(&ratio), "{name}: {ratio} times as fast down as up");
}

/// Bahill, Adler & Stark 1975: 86 % of saccades are of 15 degrees or less. Bahill, Clark & Stark 1975 and
/// Carpenter 1988: durations of 2.2 ms a degree and 21 ms; peak speeds by amplitude as in their figures.
fn saccades(style: &Style, hour: &Hour) {
    let name = style.name;
    let large = hour.saccades.iter().filter(|saccade| saccade.degrees > 0.5);
    let large: Vec<&Saccade> = large.collect();
    let small = large.iter().filter(|saccade| saccade.degrees <= 15.0).count() as f64 / large.len() as f64;
    assert!((0.8..1.0).contains(&small), "{name}: {small} of saccades are of 15 degrees at most");
    for Saccade { degrees, duration_secs, peak_speed, .. } in &large {
        let expected = 0.0022 * degrees + 0.021;
        assert!((duration_secs / expected - 1.0).abs() < 0.1, "{name}: {degrees} in {duration_secs} s");
        let range = match degrees {
            d if *d < 2.0 => 25.0..180.0,
            d if *d < 5.0 => 90.0..330.0,
            d if *d < 10.0 => 200.0..470.0,
            d if *d < 20.0 => 300.0..600.0,
            _ => 400.0..700.0,
        };
        assert!(range.contains(peak_speed), "{name}: {degrees} degrees at {peak_speed} degrees a second");
    }
    assert!(large.iter().any(|saccade| saccade.degrees > 12.0), "{name}");
}

/// Rayner 1998, Henderson 2003: fixations on scenes and faces of some 0.2 to 0.6 s; longer ones while
/// somebody rests, none below 0.1 s, and some of more than a second.
fn fixations(style: &Style, hour: &Hour) {
    let name = style.name;
    let pairs = hour.saccades.windows(2);
    let times: Vec<f64> =
        pairs.map(|pair| pair[1].start_secs - pair[0].start_secs - pair[0].duration_secs).collect();
    let middle = quantile(&times, 0.5);
    assert!((0.2..0.65).contains(&middle), "{name}: {middle} s");
    assert!(quantile(&times, 0.0) > 0.1, "{name}");
    assert!((1.5..4.0).contains(&(quantile(&times, 0.95) / middle)), "{name}");
}

/// Martinez-Conde et al. 2004: 1 to 2 micro-saccades a second. Breaths: 12.5 to 16 a minute by preset,
/// a little slower than the 17 of Tobin et al. 1983.
fn small_and_slow(style: &Style, hour: &Hour) {
    let name = style.name;
    let rate = hour.micro as f64 / HOUR_SECS;
    assert!((1.0..2.0).contains(&rate), "{name}: {rate} micro-saccades a second");
    let rate = hour.breaths as f64 / 60.0;
    assert!((12.0..16.5).contains(&rate), "{name}: {rate} breaths a minute");
}

/// Evinger et al. 1994: nearly every gaze shift of more than 33 degrees comes with a blink; small ones do
/// not.
#[test]
fn large_gaze_shifts_come_with_blinks() {
    let controls = full();
    let (mut with_blink, mut shifts) = (0, 0);
    for seed in 0..200 {
        let style = Style { contact: 1.0, ..Style::default() };
        let mut life = Life::new(&controls, style, seed);
        life.attend(0, Some(Target::point([-0.6, 0.0, 0.8])));
        life.advance(4.0).unwrap();
        // Not a blink that is under way or just over.
        while life.closed() > 0.0 {
            life.advance(0.05).unwrap();
        }
        life.advance(0.5).unwrap();
        if life.closed() > 0.0 {
            continue;
        }
        life.attend(0, Some(Target::point([0.6, 0.0, 0.8])));
        let before = life.counts().blinks;
        life.advance(0.35).unwrap();
        assert!(life.latest_saccade().unwrap().degrees > 60.0);
        shifts += 1;
        with_blink += u64::from(life.counts().blinks > before);
    }
    let share = with_blink as f64 / f64::from(shifts);
    assert!(shifts > 150 && share > 0.9, "{share} of {shifts}");
}

/// A listener looks at who speaks about 75 % of the time or more (Argyle & Cook 1976), and away while
/// thinking.
#[test]
fn listeners_look_at_who_speaks_and_thinkers_away() {
    let share = |style: Style, thinking: f64| {
        let controls = full();
        let mut life = Life::new(&controls, style, 5);
        life.think(thinking);
        life.attend(0, Some(Target::face([0.25, 0.0, 1.0])));
        let mut on = 0;
        for _ in 0..36_000 {
            life.advance(0.1).unwrap();
            let [left, right] = life.eyes();
            let [turn, bow, _] = life.head();
            let yaw = 0.5 * (left[0] + right[0]) + turn;
            let pitch = left[1] - bow;
            let expected = 0.25f64.atan().to_degrees();
            on += u32::from((yaw - expected).abs() < 6.0 && pitch.abs() < 6.0);
        }
        f64::from(on) / 36_000.0
    };
    let listening = share(Style::preset("listening").unwrap(), 0.0);
    assert!((0.72..0.97).contains(&listening), "{listening}");
    let thinking = share(Style::default(), 1.0);
    assert!(thinking < 0.3, "{thinking}");
}

/// Eyes move as [`Life::latest_saccade`] says: as far, and at that speed at the fastest, `550 (1 − e^(−A/7))`
/// degrees a second for A degrees (the form of Bahill, Clark & Stark 1975).
#[test]
fn eyes_move_as_saccades_say() {
    const STEP_SECS: f64 = 2e-4;
    let controls = full();
    let amounts = Amounts { gaze: 1.0, ..Amounts::NONE };
    let mut life = Life::new(&controls, Style { amounts, ..Style::preset("lively").unwrap() }, 3);
    let sight = |life: &Life| {
        let [left, right] = life.eyes();
        [0.5 * (left[0] + right[0]), left[1]]
    };
    let between = |a: [f64; 2], b: [f64; 2]| (b[0] - a[0]).hypot(b[1] - a[1]);
    let (mut before, mut checked) = (sight(&life), 0);
    // The saccade under way, where it began, and its fastest step.
    let mut way: Option<(Saccade, [f64; 2], f64)> = None;
    for step in 1..=(120.0 / STEP_SECS) as u64 {
        life.advance(STEP_SECS).unwrap();
        let here = sight(&life);
        let latest = life.latest_saccade();
        if let Some(saccade) = latest.filter(|latest| way.is_none_or(|(saccade, ..)| saccade != *latest)) {
            way = Some((saccade, before, 0.0));
        }
        if let Some((saccade, from, fastest)) = &mut way {
            *fastest = fastest.max(between(before, here) / STEP_SECS);
            let now = step as f64 * STEP_SECS;
            let end = saccade.start_secs + saccade.duration_secs;
            if (end..end + STEP_SECS).contains(&now) && saccade.degrees > 0.5 {
                let formula = 550.0 * (1.0 - (-saccade.degrees / 7.0).exp());
                assert!((*fastest / formula - 1.0).abs() < 0.01, "{saccade:?}: {fastest} for {formula}");
                assert!((between(*from, here) / saccade.degrees - 1.0).abs() < 0.01, "{saccade:?}");
                checked += 1;
            }
        }
        before = here;
    }
    assert!(checked > 100, "{checked}");
}

/// Blinks often come at the end of an utterance: in 0.7 of them, and hardly ever by chance in that moment.
#[test]
fn blinks_come_at_the_end_of_utterances() {
    let controls = full();
    let [mut told, mut untold] = [0u64; 2];
    for seed in 0..400 {
        let mut life = Life::new(&controls, Style::default(), seed);
        // No face begins with a blink.
        life.advance(0.5).unwrap();
        let mut other = life.clone();
        life.end_utterance();
        for (life, count) in [(&mut life, &mut told), (&mut other, &mut untold)] {
            life.advance(0.05).unwrap();
            *count += life.counts().blinks;
        }
    }
    let [told, untold] = [told, untold].map(|count| count as f64 / 400.0);
    assert!((told - 0.7).abs() < 0.1 && untold < 0.1, "{told} {untold}");
}
