//! She speaks.

use crate::face::{pass, stage};

/// A voice: pulses through two resonances of an open a, by J. L. Flanagan's formants; then silence.
fn voice(secs: f64, rate_hz: u32) -> Vec<f32> {
    let rate = f64::from(rate_hz);
    let mut state = [[0.0f64; 2]; 2];
    let samples = 0..(secs * rate) as usize;
    samples
        .map(|index| {
            let pulse = if index.is_multiple_of(rate_hz as usize / 120) { 1.0 } else { 0.0 };
            let mut sum = 0.0;
            for (hz, [y1, y2]) in [730.0, 1090.0].into_iter().zip(&mut state) {
                let r = (-std::f64::consts::PI * 90.0 / rate).exp();
                let y = pulse + 2.0 * r * (std::f64::consts::TAU * hz / rate).cos() * *y1 - r * r * *y2;
                (*y2, *y1) = (*y1, y);
                sum += y;
            }
            (sum * 0.12) as f32
        })
        .collect()
}

/// The furthest that the jaw opens in so many seconds.
fn opening(stage: &mut avatar_web::Stage, secs: f64) -> f32 {
    let jaw = stage.pack().controls().index("jaw.open").expect("a jaw");
    let mut most = f32::MIN;
    for _ in 0..(secs * 60.0) as usize {
        pass(stage, 1.0 / 60.0);
        most = most.max(stage.values()[jaw]);
    }
    most
}

#[test]
fn a_sound_opens_the_mouth_and_it_comes_to_rest_after_it() {
    let mut stage = stage();
    let rest = stage.values().to_vec();
    stage.speak_sound(&voice(0.6, 16_000), 16_000, 0.0).expect("a rate");
    assert!(stage.is_speaking());
    assert!(opening(&mut stage, 0.6) > 1.0);
    pass(&mut stage, 2.0);
    assert!(!stage.is_speaking() && !stage.is_moving() || stage.values() == rest);
    assert_eq!(stage.values(), rest);
    assert!(stage.speak_sound(&[0.0], 7, 0.0).is_err(), "seven samples a second");
}

#[test]
fn the_time_of_the_sound_can_be_told() {
    let mut stage = stage();
    stage.speak_sound(&voice(0.6, 16_000), 16_000, 0.0).expect("a rate");
    stage.speak_at(60.0);
    // What was said before gives way within a tenth of a second.
    pass(&mut stage, 0.2);
    assert_eq!(
        opening(&mut stage, 0.5),
        stage.values()[stage.pack().controls().index("jaw.open").expect("a jaw")]
    );
    assert!(!stage.is_speaking());
}

#[test]
fn visemes_and_their_times_are_spoken() {
    let mut stage = stage();
    stage.speak("0.0\tPP\t1\n0.1\taa\t1\n0.4\tsil\t1\n", -0.2).expect("a table");
    assert!(opening(&mut stage, 0.6) > 1.0);
    let told = stage.speak("what?", 0.0).expect_err("no table").to_string();
    assert!(told.contains("expected"), "{told}");
}

#[test]
fn a_microphone_is_followed_and_left() {
    let mut stage = stage();
    let mut most = f32::MIN;
    for piece in voice(0.6, 48_000).chunks(800) {
        stage.listen(piece, 48_000).expect("a rate");
        most = most.max(opening(&mut stage, 1.0 / 60.0 + 1e-9));
    }
    assert!(most > 1.0, "{most}");
    // Nobody says anything: the mouth rests, and there is nothing to draw.
    for _ in 0..120 {
        stage.listen(&[0.0; 800], 48_000).expect("a rate");
        pass(&mut stage, 1.0 / 60.0);
        stage.drawn();
    }
    assert!(stage.is_speaking() && !stage.is_moving(), "it listens on, at rest");
    stage.hush();
    pass(&mut stage, 0.5);
    assert!(!stage.is_speaking());
    // The next microphone is heard as the first was, whatever its rate.
    let mut most = f32::MIN;
    for piece in voice(0.6, 44_100).chunks(735) {
        stage.listen(piece, 44_100).expect("a rate");
        most = most.max(opening(&mut stage, 1.0 / 60.0 + 1e-9));
    }
    assert!(most > 1.0, "{most}");
}
