//! A face that speaks, over poses and clips and under its life.

#![allow(clippy::unwrap_used, reason = "helpers of tests fail as tests do")]

mod common;

use avatar_stage::avatar_life::{Life, Role, Style};
use avatar_stage::avatar_speech::{Amounts, HeardSpeech, Speech, SpeechMap, Timeline, Viseme};
use avatar_stage::{Attention, Performer, glam::Vec3};
use common::pack;
use std::sync::Arc;

fn speech(labels: &str) -> Arc<Speech> {
    Arc::new(Speech::new(&Timeline::read(labels, None).unwrap()))
}

/// Two utterances with a pause of half a second between them.
fn two_utterances() -> Arc<Speech> {
    speech("_ 300\nm 90\na 210\n_ 500\nb 80\no 220\n_ 200")
}

#[test]
fn speech_lies_between_poses_and_life() {
    let pack = pack();
    let speech = two_utterances();
    let map = SpeechMap::new(pack.controls());
    let mut face = Performer::new(pack.clone());
    let mut still = Performer::new(pack.clone());
    let mut life = Life::new(pack.controls(), Style::default(), 4);
    face.set_life(Some(life.clone())).unwrap();
    face.speak(speech.clone(), -0.2);
    assert!(face.is_speaking());
    for performer in [&mut face, &mut still] {
        performer.press("smile").unwrap();
    }
    let (dt, mut compared) = (1.0 / 64.0, 0);
    for frame in 1..=128 {
        face.advance(dt).unwrap();
        still.advance(dt).unwrap();
        let secs = f64::from(frame) * dt - 0.2;
        assert!((face.speech_secs().unwrap() - secs).abs() < 1e-9);
        // Life is told of utterances at their own times, which only shares of steps reach: what follows is
        // compared before the first one begins, and what is spoken everywhere.
        let mut expected = still.values().to_vec();
        if secs > -0.1 {
            map.apply(&speech.at(secs), Amounts::default(), &mut expected);
            assert_eq!(face.values(), still.values());
            if secs < 0.3 {
                life.advance(f64::from(frame) * dt - life.time_secs()).unwrap();
                let spoken = expected.clone();
                life.apply(&spoken, &mut expected).unwrap();
                assert_eq!(face.shown(), expected, "frame {frame}");
                compared += 1;
            }
        }
    }
    assert!(compared > 15, "{compared}");
}

#[test]
fn life_is_told_of_utterances() {
    let speech = two_utterances();
    let mut face = Performer::new(pack().clone());
    let life = Life::new(pack().controls(), Style::default(), 1);
    face.set_life(Some(life)).unwrap();
    face.speak(speech.clone(), 0.0);
    let mut roles = Vec::new();
    for _ in 0..300 {
        face.advance(0.01).unwrap();
        roles.push(face.life().unwrap().role());
    }
    for (step, role) in roles.iter().enumerate() {
        let secs = 0.01 * (step + 1) as f64;
        let within = |[begin, end]: &[f64; 2]| secs > begin + 1e-6 && secs < end - 1e-6;
        let near = speech.utterances().iter().flatten().any(|time| (secs - time).abs() < 2e-6);
        let expected = if speech.utterances().iter().any(within) { Role::Speaking } else { Role::Neither };
        assert!(near || *role == expected, "{secs}: {role:?}");
    }
    assert_eq!(speech.utterances().len(), 2);
    assert!(!face.is_speaking() && face.speech_secs().is_none());
    // Whoever listens where it does not speak.
    face.set_listening(true);
    assert_eq!(face.life().unwrap().role(), Role::Listening);
    face.speak(speech, 0.4);
    assert_eq!(face.life().unwrap().role(), Role::Speaking);
    face.hush();
    assert_eq!(face.life().unwrap().role(), Role::Listening);
    // Blinks come with ends of utterances more often than without them (0.7 of them and 14 a minute).
    let talk = self::speech("_ 500\na 500\n_ 500");
    let mut at_ends = 0;
    for seed in 0..100 {
        face.set_life(Some(Life::new(pack().controls(), Style::default(), seed))).unwrap();
        face.speak(talk.clone(), 0.6);
        face.advance(0.39).unwrap();
        let before = face.life().unwrap().counts().blinks;
        face.advance(0.02).unwrap();
        at_ends += face.life().unwrap().counts().blinks - before;
    }
    assert!((55..=90).contains(&at_ends), "{at_ends} of 100");
}

#[test]
fn the_amount_of_speech_is_the_callers() {
    let pack = pack();
    let jaw = pack.controls().index("jaw.open").unwrap();
    let talk = speech("_ 300\na 600\n_ 300");
    let mut jaws = [0.0; 3];
    for (amount, found) in [0.0, 0.5, 1.0].into_iter().zip(&mut jaws) {
        let mut face = Performer::new(pack.clone());
        face.set_speech_amounts(Amounts { mouth: amount, brows: 1.0 });
        face.speak(talk.clone(), 0.0);
        face.advance(0.6).unwrap();
        *found = face.shown()[jaw];
        // A new amount is not there at once, and is there soon.
        face.set_speech_amounts(Amounts { mouth: 0.0, brows: 1.0 });
        face.advance(1e-4).unwrap();
        assert!((face.shown()[jaw] - *found).abs() < 0.01);
        face.advance(0.2).unwrap();
        assert!(face.shown()[jaw].abs() < 1e-4, "{}", face.shown()[jaw]);
    }
    assert!(jaws[0].abs() < 1e-5 && jaws[2] > 5.0 && (jaws[1] - 0.5 * jaws[2]).abs() < 1e-3, "{jaws:?}");
}

/// Eyes with life look at a point in the world as those do that look at it alone, wherever the head is posed.
#[test]
fn attention_goes_to_a_point_in_the_world() {
    let pack = pack();
    let size = pack.bounds().unwrap();
    let style = Style { contact: 1.0, fixation_secs: 60.0, ..Style::default() };
    let style = Style {
        amounts: avatar_stage::avatar_life::Amounts { gaze: 1.0, ..avatar_stage::avatar_life::Amounts::NONE },
        ..style
    };
    let controls: Vec<usize> =
        ["eye.left.lr", "eye.left.ud"].iter().map(|name| pack.controls().index(name).unwrap()).collect();
    for turn in [0.0, 18.0] {
        for aside in [-0.5, 0.3] {
            let point = size.center() + Vec3::new(aside, 0.1, 2.0) * size.size().z;
            let mut living = Performer::new(pack.clone());
            living.set("head.turn", turn).unwrap();
            living.advance(2.0).unwrap();
            living.set_life(Some(Life::new(pack.controls(), style, 1))).unwrap();
            living.attend(0, Some(Attention { size_metres: 0.0, ..Attention::face(point) })).unwrap();
            living.advance(3.0).unwrap();
            let mut expected = Vec::new();
            let mut gaze = avatar_stage::avatar_pack::Gaze::new(pack).unwrap();
            gaze.look_at(pack, living.values(), point, &mut expected).unwrap();
            for control in &controls {
                let alone = expected.iter().find(|(index, _)| index == control).unwrap().1;
                let found = living.shown()[*control];
                assert!((alone - found).abs() < 1.0, "{turn} {aside}: {found}, by the eyes alone {alone}");
            }
            // Behind the head there is nothing to look at.
            living.attend(0, Some(Attention::face(size.center() - Vec3::Z * 9.0 * size.size().z))).unwrap();
            living.advance(3.0).unwrap();
            assert!(living.shown()[controls[0]].abs() < 8.0);
        }
    }
}

/// Frames of a recogniser: silence, an a, a closed m, an a, and silence again.
fn frames() -> Vec<([f32; 15], f32)> {
    let of = |viseme: Viseme, count: usize| {
        let mut weights = [0.0; 15];
        weights[viseme.index()] = 1.0;
        std::iter::repeat_n((weights, if viseme == Viseme::Sil { 0.0 } else { 0.6 }), count)
    };
    let parts = [(Viseme::Sil, 30), (Viseme::Aa, 40), (Viseme::PP, 12), (Viseme::Aa, 40), (Viseme::Sil, 60)];
    parts.into_iter().flat_map(|(viseme, count)| of(viseme, count)).collect()
}

#[test]
fn a_recording_is_spoken_as_labels_are() {
    let jaw = pack().controls().index("jaw.open").unwrap();
    let heard = Arc::new(HeardSpeech::new(frames(), 0.0));
    assert_eq!(heard.utterances().len(), 1);
    let [begin, end] = heard.utterances()[0];
    assert!((begin - 0.3).abs() < 1e-9 && (end - 1.22).abs() < 1e-9, "{begin} {end}");
    let mut face = Performer::new(pack().clone());
    face.set_life(Some(Life::new(pack().controls(), Style::default(), 1))).unwrap();
    face.speak(Arc::clone(&heard), -0.1);
    let (mut jaws, mut roles) = (Vec::new(), Vec::new());
    while face.is_speaking() {
        face.advance(0.02).unwrap();
        jaws.push((face.speech_secs().unwrap_or(heard.end_secs()), face.value(jaw).unwrap()));
        roles.push(face.life().unwrap().role());
        assert!(jaws.len() < 200, "it never ends");
    }
    let most = jaws.iter().fold(0.0, |most: f64, (_, jaw)| most.max(*jaw));
    let at =
        |secs: f64| jaws.iter().min_by(|a, b| (a.0 - secs).abs().total_cmp(&(b.0 - secs).abs())).unwrap().1;
    assert!(most > 4.0 && at(0.5) > 0.8 * most && at(0.76) < 0.2 * most && at(1.0) > 0.8 * most, "{jaws:?}");
    let speaking = roles.iter().filter(|role| **role == Role::Speaking).count();
    assert!((44..=48).contains(&speaking), "{speaking} frames of 20 ms, of 0.92 s");
}

/// What a microphone hears moves the mouth at once, in silence the face rests and listens, and pieces in
/// which the frames come delay it and change nothing else.
#[test]
fn what_is_heard_is_said_while_it_is_heard() {
    let jaw = pack().controls().index("jaw.open").unwrap();
    let frames = frames();
    let mut curves = Vec::new();
    for piece in [1, 3] {
        let mut face = Performer::new(pack().clone());
        face.set_life(Some(Life::new(pack().controls(), Style::default(), 1))).unwrap();
        face.set_listening(true);
        let (mut jaws, mut roles, mut largest) = (Vec::new(), Vec::new(), 0.0_f64);
        for (number, pieces) in frames.chunks(piece).enumerate() {
            for (k, (weights, loudness)) in pieces.iter().enumerate() {
                face.hear(0.01 * (number * piece + k) as f64, weights, *loudness);
            }
            assert!(face.is_hearing() && face.speech_secs().is_none());
            for _ in pieces {
                for _ in 0..10 {
                    let before = face.value(jaw).unwrap();
                    face.advance(0.001).unwrap();
                    largest = largest.max((face.value(jaw).unwrap() - before).abs());
                }
                jaws.push(face.value(jaw).unwrap());
                roles.push(face.life().unwrap().role());
            }
        }
        let most = jaws.iter().fold(0.0, |most: f64, jaw| most.max(*jaw));
        // The m is heard from 0.70 to 0.82 s, and seen 100 ms later; so is the end.
        let closed = jaws[80..92].iter().fold(f64::INFINITY, |least, jaw| least.min(*jaw));
        assert!(
            most > 4.0 && jaws[55] > 0.8 * most && closed < 0.1 * most && jaws[112] > 0.8 * most,
            "{jaws:?}"
        );
        assert!(jaws[145] < 0.05 * most, "{}", jaws[145]);
        assert_eq!([roles[20], roles[80], roles[170]], [Role::Listening, Role::Speaking, Role::Listening]);
        // However the frames come, the jaw goes and does not jump.
        assert!(largest < 0.1 * most, "{largest} of {most} in a millisecond");
        // A second of silence later it rests, until somebody speaks.
        for k in 0..120 {
            let secs = 0.01 * f64::from(182 + k);
            let mut silent = [0.0; 15];
            silent[Viseme::Sil.index()] = 1.0;
            face.hear(secs, &silent, 0.0);
            face.advance(0.01).unwrap();
        }
        assert!(!face.is_speaking() && face.is_hearing());
        face.hush();
        assert!(!face.is_hearing());
        face.advance(0.2).unwrap();
        curves.push(jaws);
    }
    // Frames in pieces of three come up to 20 ms later; the jaw is where it was within that time.
    for (at, jaw) in curves[1].iter().enumerate() {
        let near = &curves[0][at.saturating_sub(3)..(at + 4).min(curves[0].len())];
        let least = near.iter().copied().fold(f64::INFINITY, f64::min);
        let most = near.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        assert!((least - 0.1..=most + 0.1).contains(jaw), "{at}: {jaw} of {least} to {most}");
    }
}
