//! Speech on the built-in face: where its lips are, by deforming its skin.
#![allow(clippy::panic, clippy::unwrap_used, reason = "a test may panic")]

use avatar_mesh::Deformed;
use avatar_pack::{FaceState, MemorySource, Pack};
use avatar_speech::{Amounts, Means, Speech, SpeechMap, Timeline, Viseme};
use std::path::Path;

/// Half of the mouth's width from corner to corner, as the sculptor has it (4.4 units in all).
const HALF_WIDTH: f32 = 2.2;
/// How far apart lips may be that are closed: 2 % of the mouth's width.
const CLOSED: f32 = 0.02 * 2.0 * HALF_WIDTH;

/// The face, and which vertices of its lips lie on each other while the mouth is at rest.
struct Face {
    pack: Pack,
    map: SpeechMap,
    skin: usize,
    rest: Deformed,
    /// Vertices of the lower lip, in front of the teeth.
    lower: Vec<usize>,
    /// The lower and the upper vertex.
    pairs: Vec<[usize; 2]>,
}

impl Face {
    fn load() -> Self {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../assets/marsienne");
        let mut source = MemorySource::default();
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            let name = path.file_name().unwrap().to_string_lossy().into_owned();
            source.files.insert(name, std::fs::read(path).unwrap());
        }
        let pack = Pack::load(&source).unwrap();
        let skin = pack.parts().iter().position(|part| part.name == "skin").unwrap();
        let map = SpeechMap::new(pack.controls());
        assert_eq!(map.means(), Means::ArKit);
        let mut face =
            Self { pack, map, skin, rest: Deformed::default(), lower: Vec::new(), pairs: Vec::new() };
        face.rest = face.deformed(&face.pack.controls().defaults());
        // Lips are what the jaw parts: the lower one goes with it, the upper one stays.
        let opened = face.deformed(&face.values(&[("jaw.open", 20.0)]));
        let moved = |index: usize| (opened.positions[index] - face.rest.positions[index]).length();
        let most = (0..face.rest.positions.len()).map(moved).fold(0.0, f32::max);
        let at_mouth = |index: &usize| {
            let place = face.rest.positions[*index];
            place.x.abs() < 0.9 * HALF_WIDTH && place.z > 3.0
        };
        let near: Vec<usize> = (0..face.rest.positions.len()).filter(at_mouth).collect();
        let upper: Vec<usize> = near.iter().copied().filter(|index| moved(*index) < 0.25 * most).collect();
        let mut pairs = Vec::new();
        let lower: Vec<usize> = near.into_iter().filter(|index| moved(*index) > 0.55 * most).collect();
        for lower in lower.iter().copied() {
            let distance = |upper: usize| (face.rest.positions[upper] - face.rest.positions[lower]).length();
            let nearest = upper.iter().copied().min_by(|a, b| distance(*a).total_cmp(&distance(*b))).unwrap();
            if distance(nearest) < 0.05 {
                pairs.push([lower, nearest]);
            }
        }
        assert!(pairs.len() > 100, "{}", pairs.len());
        face.lower = lower;
        face.pairs = pairs;
        face
    }

    fn values(&self, set: &[(&str, f32)]) -> Vec<f32> {
        let mut values = self.pack.controls().defaults();
        set.iter().for_each(|(name, value)| values[self.pack.controls().index(name).unwrap()] = *value);
        values
    }

    fn deformed(&self, values: &[f32]) -> Deformed {
        let mut state = FaceState::new(&self.pack);
        state.pose(&self.pack, values).unwrap();
        state.deform(&self.pack, self.skin).unwrap()
    }

    /// The widest opening between the lips: at each tenth of a unit across the mouth the narrowest of the
    /// pairs that lie behind each other there, and of these the largest.
    fn gap(&self, values: &[f32]) -> f32 {
        let posed = self.deformed(values);
        let mut narrowest = std::collections::BTreeMap::new();
        for [lower, upper] in &self.pairs {
            let place = (self.rest.positions[*lower].x * 10.0).round() as i32;
            let opening = posed.positions[*upper].y - posed.positions[*lower].y;
            let slot = narrowest.entry(place).or_insert(f32::INFINITY);
            *slot = slot.min(opening);
        }
        assert!(narrowest.len() > 30, "{}", narrowest.len());
        narrowest.into_values().fold(f32::NEG_INFINITY, f32::max)
    }

    fn gap_saying(&self, speech: &Speech, secs: f64, mut values: Vec<f32>) -> f32 {
        self.map.apply(&speech.at(secs), Amounts::default(), &mut values);
        self.gap(&values)
    }
}

/// A consonant that takes 0.4 of each syllable, and a vowel, at so many syllables a second, from 0.3 s on.
fn syllables(consonant: &str, vowel: &str, rate: f64) -> Speech {
    let [short, long] = [400.0 / rate, 600.0 / rate];
    let text = format!("_ 300\n{}_ 300\n", format!("{consonant} {short}\n{vowel} {long}\n").repeat(4));
    Speech::new(&Timeline::read(&text, None).unwrap())
}

#[test]
fn lips_are_closed_at_every_bilabial_from_three_to_nine_syllables_a_second() {
    let face = Face::load();
    for rate in [3.0, 4.5, 6.0, 7.5, 9.0] {
        for (consonant, vowel) in [("p", "a"), ("b", "i"), ("m", "o"), ("m", "u")] {
            let speech = syllables(consonant, vowel, rate);
            for syllable in 1..4 {
                let start = 0.3 + f64::from(syllable) / rate;
                for share in [0.1, 0.4, 0.75] {
                    let gap = face.gap_saying(&speech, start + share * 0.4 / rate, face.values(&[]));
                    assert!(gap < CLOSED, "{consonant}{vowel} at {rate}, {share}: {gap}");
                }
                // Between them the mouth is open: the measure sees lips that are apart.
                if vowel == "a" {
                    let gap = face.gap_saying(&speech, start + 0.7 / rate, face.values(&[]));
                    assert!(gap > 5.0 * CLOSED, "{consonant}{vowel} at {rate}: {gap}");
                }
            }
        }
    }
}

#[test]
fn lips_are_closed_whatever_the_face_expresses() {
    let face = Face::load();
    let speech = syllables("m", "a", 5.0);
    let mut parted = 0;
    for pose in face.pack.poses().iter() {
        let mut values = face.values(&[]);
        pose.values.iter().for_each(|&(control, value)| values[control] = value);
        parted += usize::from(face.gap(&values) > 2.0 * CLOSED);
        let gap = face.gap_saying(&speech, 0.3 + 0.2 + 0.04, values);
        assert!(gap < CLOSED, "{}: {gap}", pose.name);
    }
    // Without speech many of them show teeth.
    assert!(parted > 5, "{parted}");
}

/// What a mouth shows between its lower lip and its upper teeth, in the middle third of its width.
struct Bite {
    /// How far the lower lip covers the edge of the teeth, seen from the front, where it does so least.
    overlap: f32,
    /// How near the lip comes to that edge in space.
    distance: f32,
}

impl Face {
    fn bite(&self, speech: &Speech, secs: f64, mut values: Vec<f32>) -> Bite {
        const MIDDLE: f32 = 0.8;
        self.map.apply(&speech.at(secs), Amounts::default(), &mut values);
        let mut state = FaceState::new(&self.pack);
        state.pose(&self.pack, &values).unwrap();
        let teeth = self.pack.parts().iter().position(|part| part.name == "upper-jaw").unwrap();
        let teeth = state.deform(&self.pack, teeth).unwrap().positions;
        let front = teeth.iter().map(|place| place.z).fold(f32::NEG_INFINITY, f32::max) - 0.8;
        let in_front: Vec<_> =
            teeth.into_iter().filter(|place| place.z > front && place.x.abs() < MIDDLE).collect();
        let edge = in_front.iter().map(|place| place.y).fold(f32::INFINITY, f32::min);
        let skin = state.deform(&self.pack, self.skin).unwrap().positions;
        let mut highest = std::collections::BTreeMap::new();
        for [lower, _] in &self.pairs {
            let x = self.rest.positions[*lower].x;
            if x.abs() < MIDDLE {
                let slot = highest.entry((x * 5.0).round() as i32).or_insert(f32::NEG_INFINITY);
                *slot = slot.max(skin[*lower].y);
            }
        }
        assert!(highest.len() > 6, "{}", highest.len());
        let at_edge: Vec<_> = in_front.iter().filter(|place| place.y < edge + 0.1).collect();
        assert!(at_edge.len() > 20, "{}", at_edge.len());
        let lip = self.lower.iter().filter(|index| self.rest.positions[**index].x.abs() < MIDDLE);
        let distances = lip.flat_map(|index| at_edge.iter().map(|edge| (skin[*index] - **edge).length()));
        Bite {
            overlap: highest.into_values().fold(f32::INFINITY, f32::min) - edge,
            distance: distances.fold(f32::INFINITY, f32::min),
        }
    }
}

/// Seen from the front, no gap is left between the lower lip and the edge of the upper teeth. In depth the
/// lip does not touch them: a tenth of the mouth's width stays between them, about as much as at rest.
#[test]
fn the_lower_lip_covers_the_edge_of_the_upper_teeth_at_every_labiodental() {
    let face = Face::load();
    for rate in [3.0, 6.0, 9.0] {
        for (consonant, vowel) in [("f", "a"), ("v", "o"), ("v", "i")] {
            let speech = syllables(consonant, vowel, rate);
            for share in [0.1, 0.4, 0.75] {
                let secs = 0.3 + (2.0 + share * 0.4) / rate;
                let Bite { overlap, distance } = face.bite(&speech, secs, face.values(&[]));
                assert!(overlap > 0.0, "{consonant}{vowel} at {rate}, {share}: {overlap}");
                let tenths = distance / (0.2 * HALF_WIDTH);
                assert!(tenths < 1.0, "{consonant}{vowel} at {rate}, {share}: {tenths}");
            }
        }
        // An open vowel leaves a gap.
        let open = face.bite(&syllables("f", "a", rate), 0.3 + 2.7 / rate, face.values(&[]));
        assert!(open.overlap < -5.0 * CLOSED, "{rate}: {}", open.overlap);
    }
}

#[test]
fn the_lower_lip_covers_the_edge_of_the_upper_teeth_whatever_the_face_expresses() {
    let face = Face::load();
    let speech = syllables("f", "a", 5.0);
    let mut uncovered = 0;
    for pose in face.pack.poses().iter() {
        let mut values = face.values(&[]);
        pose.values.iter().for_each(|&(control, value)| values[control] = value);
        // The edge of the teeth is level as long as the head is.
        for (value, control) in values.iter_mut().zip(face.pack.controls().controls()) {
            if control.name.starts_with("head.") {
                *value = control.default;
            }
        }
        uncovered += usize::from(face.bite(&speech, 0.0, values.clone()).overlap < 0.0);
        let overlap = face.bite(&speech, 0.3 + 0.2 + 0.04, values).overlap;
        assert!(overlap > 0.0, "{}: {overlap}", pose.name);
    }
    // Without speech some of them leave a gap.
    assert!(uncovered > 3, "{uncovered}");
}

/// Weights that `avatar-hearing` finds in a voice are those that a mouth is made of, in the same order.
#[test]
fn what_is_heard_can_be_spoken() {
    let heard = avatar_hearing::VISEMES.map(Viseme::named);
    assert_eq!(heard, Viseme::ALL.map(Some));
}
