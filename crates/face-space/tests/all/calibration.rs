use face_space::{Calibration, Standard};
use std::sync::Arc;

fn arkit() -> Arc<face_space::Space> {
    Standard::ArKit.space().clone()
}

fn applied(calibration: &Calibration, name: &str, value: f32) -> f32 {
    let place = arkit().index(name).unwrap();
    let mut values = arkit().rest();
    values[place] = value;
    calibration.apply(&mut values);
    values[place]
}

#[test]
fn without_settings_nothing_changes() {
    let new = Calibration::new(arkit());
    for value in [0.0, 0.123, 1.0] {
        assert_eq!(applied(&new, "jawOpen", value), value);
    }
    assert_eq!(applied(&new, "jawOpen", f32::NAN), 0.0);
    assert_eq!(new.to_toml(), "[neutral]\n\n[gain]\n");
}

#[test]
fn neutral_becomes_rest_and_the_end_stays() {
    let text = "[neutral]\nJawOpen = 0.2\n\n[gain]\nmouthSmile_L = 1.5\n";
    let read = Calibration::from_toml(arkit(), text).unwrap();
    let jaw: Vec<_> = [0.1, 0.2, 0.6, 1.0].map(|value| applied(&read, "jawOpen", value)).to_vec();
    // 0.4 of 0.8 beyond the neutral value.
    assert!(jaw.iter().zip([0.0, 0.0, 0.5, 1.0]).all(|(a, b)| (a - b).abs() < 1e-6), "{jaw:?}");
    assert_eq!(applied(&read, "mouthSmileLeft", 0.5), 0.75);
    assert_eq!(applied(&read, "mouthSmileLeft", 0.9), 1.0);
    assert_eq!(applied(&read, "mouthSmileRight", 0.5), 0.5);
    assert_eq!(Calibration::from_toml(arkit(), &read.to_toml()).unwrap(), read);
}

/// Angles go both ways: both ends stay.
#[test]
fn both_ends_of_an_angle_stay() {
    let space = Standard::LiveLink.space().clone();
    let mut calibration = Calibration::new(space.clone());
    let yaw = space.index("headYaw").unwrap();
    let mut rest = space.rest();
    rest[yaw] = 0.1;
    calibration.set_neutral(&rest);
    let ends = [space.names()[yaw].min, space.names()[yaw].max];
    for end in ends {
        let mut values = space.rest();
        values[yaw] = end;
        calibration.apply(&mut values);
        assert!((values[yaw] - end).abs() < 1e-6);
    }
    calibration.apply(&mut rest);
    assert_eq!(rest, space.rest());
}

#[test]
fn mistakes_are_told_with_their_place() {
    for (text, expected) in [
        ("[neutral]\njawOpne = 0.1\n", "line 2, column 1: neutral.jawOpne: expected one of the names"),
        (
            "[neutral]\njawOpen = 1.5\n",
            "line 2, column 11: neutral.jawOpen: expected a number from 0 to 1, found 1.5",
        ),
        ("[gain]\njawOpen = -1\n", "expected a number from 0 to 10, found -1"),
        ("[gian]\n", "found \"gian\"; did you mean \"gain\"?"),
    ] {
        let error = Calibration::from_toml(arkit(), text).unwrap_err().to_string();
        assert!(error.contains(expected), "{error}");
    }
}
