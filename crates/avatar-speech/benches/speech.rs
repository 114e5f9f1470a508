//! A frame of a speaking face: the mouth at a time, laid over the values of its controls.

#![allow(clippy::panic, reason = "a bench may panic")]

use avatar_speech::{Amounts, Cue, Speech, SpeechMap, Timeline, Viseme};
use divan::{Bencher, black_box};
use pose_anim::ControlTable;

fn main() {
    divan::main();
}

/// A face with the shapes that ARKit has of mouth and brows.
fn arkit() -> ControlTable {
    let names = avatar_speech::Articulator::ALL.into_iter().flat_map(|articulator| articulator.names());
    let names = names.copied().chain(["browInnerUp", "browOuterUpLeft", "browOuterUpRight"]);
    let text: String =
        names.map(|name| format!("[[control]]\nname = \"{name}\"\nshape = \"{name}\"\n")).collect();
    ControlTable::from_toml(&text).unwrap_or_else(|error| panic!("{error}"))
}

/// Ten minutes of all visemes, fourteen a second.
fn long() -> Speech {
    let cue = |index: usize| Cue {
        start_secs: index as f64 / 14.0,
        end_secs: (index + 1) as f64 / 14.0,
        viseme: Viseme::ALL[index * 7 % 15],
        stress: 0.6,
    };
    Speech::new(&Timeline::new((0..8400).map(cue)).unwrap_or_else(|error| panic!("{error}")))
}

/// 1,000 faces at different times of a long speech.
#[divan::bench]
fn thousand_faces(bencher: Bencher<'_, '_>) {
    let (controls, speech) = (arkit(), long());
    let map = SpeechMap::new(&controls);
    let mut values = vec![0.0; controls.len()];
    let mut frame = 0;
    bencher.bench_local(|| {
        frame += 1;
        for face in 0..1000 {
            let secs = (f64::from(frame) / 60.0 + f64::from(face) * 0.577) % 599.0;
            values.fill(0.1);
            map.apply(&speech.at(black_box(secs)), Amounts::default(), &mut values);
            black_box(&values);
        }
    });
}
