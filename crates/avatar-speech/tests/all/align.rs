//! Sounds that are known are found in what is heard.

use avatar_speech::{Phones, Timeline, VISEMES, Viseme};
use proptest::prelude::*;

/// What a recogniser hears of sounds that last so many hundredths of a second: it is sure to this degree, and
/// the rest is spread over the other classes.
fn heard(sounds: &[(Viseme, usize)], sure: f32) -> Vec<[f32; VISEMES]> {
    let frame = |viseme: Viseme| {
        let mut weights = [(1.0 - sure) / (VISEMES - 1) as f32; VISEMES];
        weights[viseme.index()] = sure;
        weights
    };
    sounds.iter().flat_map(|&(viseme, count)| vec![frame(viseme); count]).collect()
}

/// The cues of a timeline without its pauses, rounded to frames.
fn found(timeline: &Timeline) -> Vec<(Viseme, i64, i64)> {
    let frame = |secs: f64| (secs * 100.0).round() as i64;
    let spoken = timeline.cues().iter().filter(|cue| cue.viseme != Viseme::Sil);
    spoken.map(|cue| (cue.viseme, frame(cue.start_secs), frame(cue.end_secs))).collect()
}

/// "hello mama": the second word after a pause that the text does not ask for as a line.
#[test]
fn sounds_are_found_at_their_times() {
    use Viseme::{Aa, E, KK, NN, O, PP, Sil, U};
    let (phones, notes) = Phones::read("h_ə_l_ˈoʊ\nm_ˈɑː_m_ə");
    assert!(notes.is_empty());
    assert_eq!(phones.sounds(), [KK, E, NN, O, U, PP, Aa, PP, E]);
    let sounds = [
        (Sil, 20),
        (KK, 8),
        (E, 5),
        (NN, 7),
        (O, 9),
        (U, 8),
        (Sil, 33),
        (PP, 9),
        (Aa, 16),
        (PP, 7),
        (E, 12),
        (Sil, 25),
    ];
    for sure in [1.0, 0.6, 0.3] {
        let timeline = phones.align(&heard(&sounds, sure), 0.005);
        let mut at = 0;
        let mut meant = Vec::new();
        for (viseme, count) in sounds {
            if viseme != Sil {
                meant.push((viseme, at, at + count as i64));
            }
            at += count as i64;
        }
        assert_eq!(found(&timeline), meant, "{sure}");
    }
}

/// A recogniser that confuses a sound does not move it away: its neighbours hold it.
#[test]
fn a_sound_that_is_not_heard_stays_between_its_neighbours() {
    use Viseme::{Aa, FF, I, SS, Sil};
    let (phones, _) = Phones::read("a_f_i");
    let frames = heard(&[(Sil, 10), (Aa, 12), (SS, 10), (I, 12), (Sil, 10)], 0.9);
    let timeline = phones.align(&frames, 0.005);
    assert_eq!(found(&timeline), [(Aa, 10, 22), (FF, 22, 32), (I, 32, 44)]);
}

#[test]
fn marks_of_languages_are_passed_over_and_strange_phones_are_noted() {
    let (phones, notes) = Phones::read("(en)_ð_ɪ_s_(de) _ˈiː_s\n\nb_$$_ə");
    use Viseme::{E, I, PP, SS, TH};
    assert_eq!(phones.sounds(), [TH, I, SS, I, SS, PP, E]);
    let told: Vec<String> = notes.iter().map(ToString::to_string).collect();
    assert_eq!(told, ["line 3: \"$$\" is no phone that is known: it is passed over"]);
}

#[test]
fn too_much_text_for_a_recording_and_no_text_are_nothing() {
    let (phones, _) = Phones::read("a_b_a_b_a_b_a_b");
    assert_eq!(phones.align(&heard(&[(Viseme::Aa, 3)], 1.0), 0.0).cues(), []);
    assert_eq!(phones.align(&[], 0.0).cues(), []);
    let (none, _) = Phones::read("");
    assert!(found(&none.align(&heard(&[(Viseme::Aa, 30)], 1.0), 0.0)).is_empty());
}

/// Quick speech takes memory with its length, not with the square of it, and a pause may last minutes.
#[test]
fn long_texts_take_no_gigabytes() {
    let (mut text, mut sounds) = (String::new(), Vec::new());
    for clause in 0..150 {
        sounds.push((Viseme::Sil, if clause == 70 { 20_000 } else { 20 + clause % 30 }));
        for _ in 0..10 {
            text += "m_a_s_i_";
            sounds.extend([(Viseme::PP, 8), (Viseme::Aa, 10), (Viseme::SS, 9), (Viseme::I, 7)]);
        }
        text.push('\n');
    }
    let (phones, _) = Phones::read(&text);
    let frames = heard(&sounds, 0.7);
    let mut timeline = None;
    let taken = allocation_counter::measure(|| timeline = Some(phones.align(&frames, 0.0))).bytes_max;
    assert!(taken < 128 << 20, "{taken} bytes for {} frames", frames.len());
    assert_eq!(found(&timeline.unwrap()).len(), 6_000);
}

proptest! {
    /// Sounds keep their order, none is left out, and none lies outside of the recording.
    #[test]
    fn any_text_in_any_recording(
        text in "[ptkfsmnaeiou_ \\n]{0,60}",
        numbers in proptest::collection::vec(prop_oneof![0.0_f32..1.0, Just(f32::NAN), Just(-1.0)], 0..3_000),
    ) {
        let frames: Vec<[f32; VISEMES]> =
            numbers.chunks_exact(VISEMES).map(|chunk| chunk.try_into().unwrap()).collect();
        let (phones, _) = Phones::read(&text);
        let timeline = phones.align(&frames, 0.0);
        let found = found(&timeline);
        if phones.sounds().len() <= frames.len() {
            prop_assert_eq!(found.iter().map(|(viseme, ..)| *viseme).collect::<Vec<_>>(), phones.sounds());
        } else {
            prop_assert!(found.is_empty());
        }
        prop_assert!(timeline.end_secs() <= frames.len() as f64 * 0.01);
    }
}
