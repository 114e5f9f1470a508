//! Texts of `face-space`: what a tracker says of a resting face, spaces and maps.

use face_space::{Calibration, Map, Space, Standard};
use std::sync::Arc;

/// One text as `face.toml`, as a space and as a map. A calibration is written back and read again; a map gives
/// values within their ranges, whatever it is given.
pub fn faces(data: &[u8]) {
    let Ok(text) = std::str::from_utf8(data) else { return };
    let live = Standard::LiveLink.space();
    if let Ok(calibration) = Calibration::from_toml(live.clone(), text) {
        let written = calibration.to_toml();
        assert_eq!(
            Calibration::from_toml(live.clone(), &written).as_ref(),
            Ok(&calibration),
            "written as {written}"
        );
        let mut values: Vec<f32> = numbers(data).take(live.len()).collect();
        calibration.apply(&mut values);
        within(live, &values);
    }
    let arkit = Standard::ArKit.space();
    let mut spaces = Standard::ALL.map(|standard| standard.space().clone()).to_vec();
    if let Ok(space) = Space::from_toml("fuzz", text, &[arkit]) {
        for (place, name) in space.names().iter().enumerate() {
            assert_eq!(space.find(&name.name), Some(place), "{:?}", name.name);
        }
        spaces.push(Arc::new(space));
    }
    for map in Map::from_toml(text, &spaces).into_iter().flatten() {
        let values: Vec<f32> = numbers(data).take(map.from().len()).collect();
        let mut found = map.to().rest();
        map.apply(&values, &mut found);
        within(map.to(), &found);
        map.rules().iter().for_each(|rule| drop(map.describe(rule)));
    }
}

/// Numbers of all kinds, made of the input.
fn numbers(data: &[u8]) -> impl Iterator<Item = f32> + '_ {
    let bytes = data.iter().chain(&[0, 1, 2, 3]).cycle();
    bytes.enumerate().map(|(at, byte)| match byte {
        0 => f32::NAN,
        1 => f32::NEG_INFINITY,
        _ => f32::from(*byte) / 100.0 - at as f32 / 10.0,
    })
}

fn within(space: &Space, values: &[f32]) {
    for (name, value) in space.names().iter().zip(values) {
        assert!((name.min..=name.max).contains(value), "{:?} is {value}", name.name);
    }
}
