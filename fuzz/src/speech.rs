use avatar_speech::{Amounts, Format, Mouth, Speech, SpeechMap, Timeline};
use pose_anim::ControlTable;

/// So many moments of each speech are looked at.
const MOMENTS: u32 = 16;

/// A timeline of speech in any format. What is read is spoken: every mouth has weights from 0 to 1, and
/// every control stays in its range.
pub fn speech(data: &[u8]) {
    let guessed = Timeline::from_bytes("", data);
    let text = std::str::from_utf8(data).ok();
    let told = Format::ALL.into_iter().filter_map(|format| Timeline::read(text?, Some(format)).ok());
    let controls = ControlTable::default_face();
    let map = SpeechMap::new(&controls);
    for timeline in guessed.into_iter().chain(told) {
        let speech = Speech::new(&timeline);
        for moment in 0..MOMENTS {
            let secs = speech.rest_secs() * f64::from(moment) / f64::from(MOMENTS - 1);
            let mouth = speech.at(secs);
            let Mouth { visemes, articulators, closed, bitten, loudness, brows, .. } = mouth;
            let all = visemes.iter().chain(&articulators).chain([&closed, &bitten, &loudness, &brows]);
            for weight in all {
                assert!((-1e-9..=1.0 + 1e-9).contains(weight), "{mouth:?} at {secs}");
            }
            let mut values = controls.defaults();
            map.apply(&mouth, Amounts::default(), &mut values);
            for (value, control) in values.iter().zip(controls.controls()) {
                assert!((control.min..=control.max).contains(value), "{}: {value} at {secs}", control.name);
            }
        }
    }
}
