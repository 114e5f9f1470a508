//! Clips: curves, editing, files and reduction.

#![allow(clippy::unwrap_used, clippy::disallowed_methods, reason = "tests read files and fail by panicking")]

use pose_anim::{Clip, ClipSet, ControlTable, Easing, Jet, Key, Track, Transition, Wrap};
use proptest::prelude::*;
use std::path::Path;

fn transition() -> impl Strategy<Value = Transition> {
    let easings: Vec<_> = Easing::names().iter().map(|name| Easing::from_name(name).unwrap()).collect();
    prop_oneof![
        prop::sample::select(easings).prop_map(Transition::Ease),
        (0.0f64..1.0, -1.0f64..2.0, 0.0f64..1.0, -1.0f64..2.0)
            .prop_map(|(a, b, c, d)| Transition::Ease(Easing::Bezier([a, b, c, d]))),
        (-5.0f64..5.0, -5.0f64..5.0)
            .prop_map(|(leaving, arriving)| Transition::Hermite { leaving, arriving }),
    ]
}

fn track() -> impl Strategy<Value = Track> {
    prop::collection::vec((0.05f64..1.0, -1.0f64..1.0, transition()), 1..6).prop_map(|keys| {
        let mut time_secs = -0.05;
        let key = |(wait, value, transition)| {
            time_secs += wait;
            Key { time_secs, value, transition }
        };
        Track::new(0, keys.into_iter().map(key).collect()).unwrap()
    })
}

fn end(track: &Track) -> f64 {
    track.keys().last().unwrap().time_secs
}

/// Times all over a track, but not at its keys, where a step has two values.
fn times(track: &Track) -> Vec<f64> {
    (0..400).map(|step| (f64::from(step) + 0.3719) / 390.0 * (end(track) + 0.01) - 0.005).collect()
}

#[test]
fn curves_by_hand() {
    let keys = vec![
        Key::new(1.0, 2.0, Easing::Linear),
        Key::new(2.0, 4.0, Easing::StepEnd),
        Key { time_secs: 3.0, value: 0.0, transition: Transition::Hermite { leaving: 1.0, arriving: -1.0 } },
        Key {
            time_secs: 5.0,
            value: 0.0,
            transition: Transition::Ease(Easing::from_name("quad-in").unwrap()),
        },
        Key::new(7.0, 8.0, Easing::Linear),
    ];
    let track = Track::new(3, keys).unwrap();
    let jet = |value, velocity, acceleration| Jet { value, velocity, acceleration };
    assert_eq!(track.at(0.5), Jet::rest(2.0));
    assert_eq!(track.at(1.25), jet(2.5, 2.0, 0.0));
    assert_eq!(track.at(2.9), Jet::rest(4.0));
    assert_eq!(track.at(3.0), jet(0.0, 1.0, -1.0));
    // x = t − t²/2 for t = 0..2
    assert_eq!(track.at(4.0), jet(0.5, 0.0, -1.0));
    // x = 8 (t/2)²
    assert_eq!(track.at(6.0), jet(2.0, 4.0, 4.0));
    assert_eq!(track.at(99.0), Jet::rest(8.0));
    let clip = Clip::new("c", vec![track]).unwrap();
    assert_eq!(
        (clip.duration_secs(), clip.at(0, 0.0), clip.at(3, 1.5)),
        (7.0, None, Some(jet(3.0, 2.0, 0.0)))
    );
    let mut values = [9.0; 4];
    clip.sample(6.0, &mut values);
    assert_eq!(values, [9.0, 9.0, 9.0, 2.0]);
    clip.sample(6.0, &mut values[..2]);
}

proptest! {
    #[test]
    fn baking_changes_the_curve_nowhere(track in track(), shares in prop::collection::vec(0.0f64..1.1, 1..6)) {
        let mut baked = track.clone();
        for share in shares {
            let time_secs = share * end(&track);
            let before = baked.keys().len();
            let index = baked.bake(time_secs).unwrap();
            prop_assert_eq!(baked.keys()[index].time_secs, time_secs);
            prop_assert!(baked.keys().len() == before + 1 || baked.bake(time_secs).unwrap() == index);
        }
        for time_secs in times(&track) {
            let (a, b) = (track.at(time_secs), baked.at(time_secs));
            prop_assert!((a.value - b.value).abs() < 1e-9, "{time_secs}: {a:?} {b:?}");
            prop_assert!((a.velocity - b.velocity).abs() < 1e-6 * (1.0 + a.velocity.abs()), "{time_secs}: {a:?} {b:?}");
        }
    }

    #[test]
    fn from_a_time_on_it_is_the_same_motion(
        track in track(), other in track(), wrap in 0..3usize, from in 0.0f64..2.5, shares in prop::collection::vec(0.0f64..4.0, 20)
    ) {
        let other = Track::new(other.control() + 1, other.keys().to_vec()).unwrap();
        let wrap = [Wrap::Once, Wrap::Loop, Wrap::PingPong][wrap];
        let clip = Clip::new("c", vec![track, other]).unwrap().wrapped(wrap);
        let duration_secs = clip.duration_secs();
        let from_secs = from * duration_secs;
        let rest = clip.starting_at(from_secs).unwrap();
        for share in shares {
            let time_secs = share * duration_secs;
            for track in clip.tracks() {
                let control = track.control();
                let here = rest.at(control, time_secs).unwrap();
                // Next to a jump rounding decides on which side a time lies.
                let near = [-1e-9, 0.0, 1e-9].map(|d| clip.at(control, from_secs + time_secs + d).unwrap().value);
                prop_assert!(
                    near.iter().any(|there| (here.value - there).abs() < 1e-6),
                    "{wrap:?} {from_secs} {time_secs}: {} {near:?}", here.value
                );
            }
        }
    }

    #[test]
    fn derivatives_are_those_of_the_curve(track in track(), share in 0.0f64..1.0) {
        let mut track = track;
        track.bake(share * end(&track)).unwrap();
        let h = 1e-7;
        for time_secs in times(&track) {
            let [before, here, after] = [-h, 0.0, h].map(|d| track.at(time_secs + d));
            let slope = (after.value - before.value) / (2.0 * h);
            // Not where one half or bounce meets the next within these steps: second differences see the
            // corner.
            let corner = (after.velocity - before.velocity).abs() > 1e-3 * (1.0 + here.velocity.abs());
            prop_assert!(corner || (slope - here.velocity).abs() < 1e-4 * (1.0 + slope.abs()), "{slope} {here:?}");
        }
    }

    #[test]
    fn turned_around_it_is_the_mirror_image(track in track()) {
        let clip = Clip::new("c", vec![track.clone()]).unwrap();
        let mut reversed = clip.clone();
        reversed.reverse();
        for time_secs in times(&track) {
            let (a, b) = (track.at(time_secs).value, reversed.at(0, end(&track) - time_secs).unwrap().value);
            prop_assert!((a - b).abs() < 1e-9, "{time_secs}: {a} {b}");
        }
        reversed.reverse();
        for time_secs in times(&track) {
            prop_assert!((track.at(time_secs).value - reversed.at(0, time_secs).unwrap().value).abs() < 1e-9);
        }
    }

    #[test]
    fn slower_repeated_and_appended(track in track(), other in track(), factor in 0.1f64..10.0) {
        let clip = Clip::new("c", vec![track.clone()]).unwrap();
        let duration_secs = clip.duration_secs();
        let mut slow = clip.clone();
        slow.scale_time(factor).unwrap();
        let (mut both, looped) = (clip.clone(), clip.clone().wrapped(Wrap::Loop));
        let to_and_fro = clip.clone().wrapped(Wrap::PingPong);
        both.append(&Clip::new("d", vec![other.clone()]).unwrap()).unwrap();
        for time_secs in times(&track).into_iter().filter(|time| (0.0..duration_secs).contains(time)) {
            let value = track.at(time_secs).value;
            let at = |clip: &Clip, time_secs: f64| clip.at(0, time_secs).unwrap();
            prop_assert!((at(&slow, factor * time_secs).value - value).abs() < 1e-9);
            prop_assert_eq!(at(&both, time_secs).value, value);
            prop_assert!((at(&looped, time_secs + 3.0 * duration_secs).value - value).abs() < 1e-6);
            prop_assert!((at(&to_and_fro, 2.0 * duration_secs - time_secs).value - value).abs() < 1e-6);
            prop_assert!((at(&to_and_fro, 2.0 * duration_secs - time_secs).velocity + track.at(time_secs).velocity).abs()
                < 1e-4 * (1.0 + track.at(time_secs).velocity.abs()));
        }
        for time_secs in times(&other).into_iter().filter(|time| (0.0..end(&other)).contains(time)) {
            prop_assert!((both.at(0, duration_secs + time_secs).unwrap().value - other.at(time_secs).value).abs() < 1e-6);
        }
    }

    #[test]
    fn reduction_keeps_its_bound(track in track(), bound in 0.001f64..0.2) {
        // Like a recording: sampled, with a gap.
        let samples = (0..240).filter(|frame| !(80..95).contains(frame)).map(|frame| f64::from(frame) / 60.0);
        let recorded = Track::from_samples(4, samples.map(|time| (time, track.at(time).value))).unwrap();
        // What stays in a range still does: no cubic bulges beyond the highest or lowest sample.
        let (reduced, _) = Clip::new("c", vec![recorded.clone()]).unwrap().reduced(|_| bound).unwrap();
        let values = recorded.keys().iter().map(|key| key.value);
        let (least, greatest) = (values.clone().fold(f64::MAX, f64::min), values.fold(f64::MIN, f64::max));
        for step in 0..2000 {
            let value = reduced.at(4, 0.002 * f64::from(step)).unwrap().value;
            prop_assert!((least - 1e-9..=greatest + 1e-9).contains(&value), "{value} in {least} to {greatest}");
        }
        for track in [recorded, track] {
            let clip = Clip::new("c", vec![track.clone()]).unwrap();
            let (reduced, report) = clip.reduced(|_| bound).unwrap();
            prop_assert!(report.worst <= bound && report.keys_after <= report.keys_before);
            prop_assert_eq!(report.keys_before, track.keys().len());
            prop_assert_eq!(report.bytes_after, reduced.byte_len());
            for time_secs in times(&track) {
                let strays = (track.at(time_secs).value - reduced.at(track.control(), time_secs).unwrap().value).abs();
                prop_assert!(strays <= bound + 1e-12, "{time_secs}: {strays}");
            }
        }
    }
}

#[test]
fn editing_keys() {
    let keys = [0.0, 1.0, 2.0].map(|time| Key::new(time, time, Easing::Linear)).to_vec();
    let mut clip = Clip::new("c", vec![Track::new(7, keys).unwrap()]).unwrap();
    let track = clip.track_mut(7).unwrap();
    track.move_key(1, 1.5, -4.0).unwrap();
    assert_eq!(track.at(1.5).value, -4.0);
    let errors = [
        (track.move_key(1, 2.5, 0.0), "control 7, key 1: expected a time from 0 s to 2 s, found 2.5 s"),
        (track.move_key(3, 2.5, 0.0), "control 7: expected a key below 3, found 3"),
        (
            track.move_key(1, 1.0, f64::NAN),
            "control 7, key 1: expected finite numbers up to 1e12, found others",
        ),
        (track.bake(-1.0).map(|_| ()), "control 7, key 3: expected a time from 0 s to 1000000 s, found -1 s"),
        (
            track.set_transition(
                0,
                Transition::Part { easing: Easing::Linear, from: -0.1, to: 1.0, rise: 1.0 },
            ),
            "control 7, key 0: expected a piece of a span between its shares 0 and 1, found another",
        ),
        (
            track.set_transition(
                0,
                Transition::Part { easing: Easing::Linear, from: 0.5, to: 1.1, rise: 1.0 },
            ),
            "control 7, key 0: expected a piece of a span between its shares 0 and 1, found another",
        ),
        (
            track.set_transition(0, Transition::Hermite { leaving: f64::INFINITY, arriving: 0.0 }),
            "control 7, key 0: expected finite numbers up to 1e12, found others",
        ),
    ];
    for (result, expected) in errors {
        assert_eq!(result.unwrap_err().to_string(), expected);
    }
    track.set_transition(0, Transition::STEP).unwrap();
    assert_eq!(track.at(1.4).value, 0.0);
    track.remove_key(1).unwrap();
    assert_eq!((track.keys().len(), track.at(1.4).value), (2, 0.0));
    track.remove_key(0).unwrap();
    assert_eq!(
        track.remove_key(0).unwrap_err().to_string(),
        "control 7: expected a track with at least one key, found none"
    );
    assert!(
        clip.scale_time(0.0).is_err() && clip.scale_time(f64::NAN).is_err() && clip.scale_time(1e9).is_err()
    );
    assert!(clip.reduced(|_| -1.0).is_err());
    let late = Key::new(9e5, 0.0, Easing::Linear);
    let late = Clip::new("late", vec![Track::new(7, vec![late]).unwrap()]).unwrap();
    clip.append(&late).unwrap();
    assert!(clip.append(&late).is_err());
    assert!(Track::new(0, vec![]).is_err());
    let twice = vec![Track::from_samples(1, [(0.0, 0.0)]).unwrap(); 2];
    assert_eq!(Clip::new("c", twice).unwrap_err().to_string(), "control 1: expected one track, found two");
    assert!(Track::from_samples(1, [(1.0, 0.0), (0.5, 0.0)]).is_err());
    // A control that only the second clip moves.
    let mut first = Clip::new("c", vec![Track::from_samples(0, [(0.0, 0.0), (1.0, 1.0)]).unwrap()]).unwrap();
    first
        .append(&Clip::new("d", vec![Track::from_samples(1, [(0.0, 5.0), (1.0, 6.0)]).unwrap()]).unwrap())
        .unwrap();
    assert_eq!((first.at(1, 0.0).unwrap().value, first.at(1, 1.5).unwrap().value), (5.0, 5.5));
}

#[test]
fn files() {
    let table = ControlTable::default_face();
    let text = "
        [[clip]]
        name = 'nod'
        key = 'n'
        wrap = 'ping-pong'
        [clip.tracks]
        head.bow = [{ t = 0, v = 0, transition = [0.4, 0, 0.6, 1] }, { t = 0.5, v = 10, slopes = [0, -3] }, { t = 1, v = 0 }]
        smile = [{ t = 0.25, v = 1 }]
        [[clip]]
        name = 'empty'
        tracks = {}";
    let set = ClipSet::from_toml(text, &table).unwrap();
    let nod = set.get("nod").unwrap();
    assert_eq!(
        (nod.wrap, nod.key.as_deref(), nod.tracks().len(), nod.duration_secs()),
        (Wrap::PingPong, Some("n"), 2, 1.0)
    );
    assert_eq!(nod.at(1, 0.5).map(|jet| jet.value), Some(10.0));
    assert_eq!(
        nod.track(1).unwrap().keys()[1].transition,
        Transition::Hermite { leaving: 0.0, arriving: -3.0 }
    );
    assert_eq!(set.nearest("nodd"), Some("nod"));
    let rows = [
        ("", "line 1, column 1: clip.tracks: expected a table of tracks, found none"),
        (
            "wrap = 'lop'",
            "line 3, column 8: clip.wrap: expected one of once, loop, ping-pong, found \"lop\"; did you mean \"loop\"?",
        ),
        ("tracks = { simle = [] }", "expected one of the controls head.turn, "),
        (
            "tracks = { smile = [] }",
            "line 3, column 20: clip.tracks.smile: expected at least one key, found none",
        ),
        (
            "tracks = { smile = [{ v = 1 }] }",
            "clip.tracks.smile.t: expected a number of seconds from 0 to 1000000, not before the previous key's, found none",
        ),
        (
            "tracks = { smile = [{ t = 0, v = 2 }] }",
            "line 3, column 34: clip.tracks.smile.v: expected a number from 0 to 1, found 2",
        ),
        (
            "tracks = { smile = [{ t = 1, v = 1 }, { t = 0, v = 1 }] }",
            "line 3, column 45: clip.tracks.smile.t: expected a number of seconds from 0 to 1000000, not before the previous key's, found 0",
        ),
        (
            "tracks = { smile = [{ t = 1, v = 1, transition = 'linear', slopes = [1, 1] }] }",
            "clip.tracks.smile.slopes: expected [leaving, arriving]",
        ),
        (
            "tracks = { smile = [{ t = 1, v = 1, transition = 'step', slopes = [1, 1] }] }",
            "clip.tracks.smile.slopes: expected either a transition or slopes, found both",
        ),
        (
            "tracks = { smile = [{ t = 1, v = 1, w = 1 }] }",
            "clip.tracks.smile.w: expected one of the keys t, v, transition, slopes, part, found \"w\"",
        ),
        (
            "tracks = { smile = [{ t = 1, v = 1, transition = 'step', part = { of = 'step', from = 0, to = 1, rise = 1 } }] }",
            "clip.tracks.smile.part: expected either a transition, slopes or part of a transition, found two of them",
        ),
        (
            "tracks = { smile = [{ t = 1, v = 1, part = { of = 'sine-in', from = 0, to = 2, rise = 1 } }] }",
            "clip.tracks.smile.part.to: expected a share of the whole's time, from 0 to 1, found 2",
        ),
    ];
    for (rest, expected) in rows {
        let result = ClipSet::from_toml(&format!("[[clip]]\nname = 'c'\n{rest}"), &table);
        // A plain line with slopes is a cubic.
        match result {
            Ok(_) => assert!(rest.contains("linear"), "{rest}"),
            Err(error) => assert!(error.to_string().contains(expected), "{rest}: {error}"),
        }
    }
    let twice = ClipSet::from_toml(
        "clip = [{ name = 'a', key = 'x', tracks = {} }, { name = 'b', key = 'x', tracks = {} }]",
        &table,
    );
    assert!(twice.unwrap_err().to_string().contains("found \"x\", which calls clip \"a\""));
}

/// A take of a face with 61 channels at 60 frames per second, in which seven frames are missing.
#[test]
fn a_real_recording_gets_small() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data/livelink-recording/dao.csv");
    let Ok(text) = std::fs::read_to_string(&path) else {
        let required = std::env::var_os("MIMIK_REQUIRE_DATA").is_some_and(|value| value == "1");
        assert!(!required, "expected data in {} (MIMIK_REQUIRE_DATA=1), found none", path.display());
        // Past the harness, which keeps the output of tests that pass to itself.
        let skipped = format_args!("SKIPPED: {} is not there\n", path.display());
        let _ = std::io::Write::write_fmt(&mut std::io::stderr(), skipped);
        return;
    };
    let rows: Vec<Vec<f64>> = text
        .lines()
        .skip(1)
        .map(|line| line.split(',').map(|word| word.parse().unwrap()).collect())
        .collect();
    let time = |row: &[f64]| (row[0] + row[1] - rows[0][0] - rows[0][1]) * row[3] / row[2];
    let channels = rows[0][4] as usize;
    let track =
        |channel: usize| Track::from_samples(channel, rows.iter().map(|row| (time(row), row[5 + channel])));
    let clip = Clip::new("dao", (0..channels).map(|channel| track(channel).unwrap()).collect()).unwrap();
    assert_eq!((clip.tracks().len(), clip.tracks()[0].keys().len()), (61, 180));
    let gap = clip.tracks()[0]
        .keys()
        .windows(2)
        .map(|pair| pair[1].time_secs - pair[0].time_secs)
        .fold(0.0, f64::max);
    assert!((0.12..0.15).contains(&gap), "{gap}");
    for bound in [0.005, 0.01, 0.02] {
        let (reduced, report) = clip.reduced(|_| bound).unwrap();
        println!("{bound}: {report:?}");
        assert!(report.worst <= bound && report.keys_after * 3 < report.keys_before);
        for track in clip.tracks() {
            for step in 0..2000 {
                let time_secs = f64::from(step) / 2000.0 * clip.duration_secs();
                let strays =
                    track.at(time_secs).value - reduced.at(track.control(), time_secs).unwrap().value;
                assert!(strays.abs() <= bound + 1e-12);
            }
        }
    }
}
