//! What counts as neutral, kept as text.

use crate::chance::Chance;
use avatar_live::{Calibration, Frame, Receiver, Settings, channels};

/// The face after a second of one frame.
fn rests_at(receiver: &mut Receiver, frame: &Frame, from_secs: f64) -> Frame {
    for step in 0..=120 {
        let now_secs = from_secs + f64::from(step) / 60.0;
        let mut frame = *frame;
        frame.time_secs = Some(now_secs);
        receiver.push(now_secs, "Ann", &frame).unwrap();
        receiver.advance(now_secs);
    }
    *receiver.face()
}

#[test]
fn a_text_says_what_is_neutral_and_how_much_is_shown() {
    let text = "[neutral]\njawopen = 0.1\n\"head.bow\" = -4\n[gain]\nmouthSmileLeft = 1.5\n\"head.bow\" = 2";
    let calibration = Calibration::from_toml(text).unwrap();
    let mut receiver = Receiver::new(Settings::default());
    receiver.set_calibration(&calibration);
    let mut frame = Frame::default();
    for (name, value) in
        [("jawOpen", 0.55), ("mouthSmileLeft", 0.4), ("mouthSmileRight", 0.4), ("head.bow", 6.0)]
    {
        assert!(frame.set_named(name, value));
    }
    let face = rests_at(&mut receiver, &frame, 0.0);
    // (0.55 − 0.1) / (1 − 0.1), 1.5 · 0.4, 0.4, 2 · (6 + 4).
    for (name, expected) in
        [("jawOpen", 0.5), ("mouthSmileLeft", 0.6), ("mouthSmileRight", 0.4), ("head.bow", 20.0)]
    {
        let found = face.named(name).unwrap();
        assert!((found - expected).abs() < 1e-3 * expected.max(1.0), "{name}: {found}, expected {expected}");
    }
    // What is called neutral is at rest from then on, and the factors stay.
    let kept = receiver.calibrate().unwrap();
    assert!((kept.neutral(17) - 0.55).abs() < 1e-6 && channels()[17].name == "jawOpen");
    assert_eq!((kept.gain(23), kept.has_neutral(), receiver.calibration()), (1.5, true, &kept));
    let face = rests_at(&mut receiver, &frame, 2.1);
    assert!(face.iter().all(|(_, value)| value.abs() < 1e-3), "{face:?}");
}

#[test]
fn texts_are_read_as_they_were_written() {
    let mut chance = Chance::new(7);
    for _ in 0..200 {
        let neutral = chance.frame();
        let gains: String = (0..20)
            .map(|place| format!("\"{}\" = {}\n", channels()[place].name, chance.within(0.0, 10.0)))
            .collect();
        let calibration = Calibration::from_toml(&format!("[gain]\n{gains}")).unwrap().with_neutral(&neutral);
        assert_eq!(Calibration::from_toml(&calibration.to_toml()), Ok(calibration));
    }
    assert_eq!(Calibration::default().to_toml(), "[neutral]\n\n[gain]\n");
}

#[test]
fn mistakes_have_their_place() {
    for (text, place, found) in [
        ("[neutral]\njawOpn = 0.1", "line 2, column 1: ", "found \"jawOpn\"; did you mean \"jawOpen\"?"),
        ("[neutral]\njawOpen = 1.1", "line 2, column 11: ", "expected a number from 0 to 1, found 1.1"),
        ("[gain]\njawOpen = 11", "line 2, column 11: ", "expected a number from 0 to 10, found 11"),
        ("[gains]", "line 1, column 2: ", "did you mean \"gain\"?"),
    ] {
        let error = Calibration::from_toml(text).unwrap_err().to_string();
        assert!(error.starts_with(place) && error.contains(found), "{error}");
    }
}
