//! Single shapes and mixtures of the 52: no triangle flips, lids stay off the eyes, lips off the teeth.

mod closed;
pub(super) mod face;

use std::fs;

use glam::DVec3;

use super::{sculpture, shared, skin};
use crate::{anatomy::EYE_REACH, arkit, math, mesh::weld};
use face::{Face, Weights, distance, face, faults, names};

/// Shapes of fields, one at a time.
#[test]
fn a_shape_alone_flips_nothing_and_keeps_off_eyes_and_teeth() {
    let face = face();
    assert!(faults(face, &Weights::new()).clean());
    for name in names().into_iter().filter(|n| !arkit::BY_BONES.contains(&n.as_str())) {
        for weight in [0.5, 1.0] {
            let found = faults(face, &[(name.clone(), weight)].into());
            assert!(found.clean(), "{name} {weight}: {found:?}");
        }
    }
}

#[test]
fn lids_that_close_stay_off_the_eyes() {
    for closed in [0.25, 0.5, 0.75, 1.0] {
        let with = [("eyeBlinkLeft".to_owned(), closed), ("eyeBlinkRight".to_owned(), closed)].into();
        let found = faults(face(), &with);
        assert!(found.lids > EYE_REACH, "{closed}: {}", found.lids);
    }
}

#[test]
fn the_test_finds_faults() {
    // Far too much of shapes: lips go through teeth, lids come to the eye or fold.
    let face = face();
    let rolled = faults(face, &[("mouthRollUpper".to_owned(), 4.0)].into());
    assert!(rolled.in_teeth > 0, "{rolled:?}");
    let pursed = faults(face, &[("mouthPucker".to_owned(), 4.0)].into());
    assert!(pursed.flipped > 0, "{pursed:?}");
    let pressed = distance(
        DVec3::ZERO,
        [DVec3::new(-1.0, -1.0, 0.5), DVec3::new(2.0, -1.0, 0.5), DVec3::new(0.0, 2.0, 0.5)],
    );
    assert!((pressed - 0.5).abs() < 1e-12, "{pressed}");
}

#[test]
fn nothing_tears() {
    // Vertices at one place, at seams of the picture and sharp folds, move together.
    let m = skin();
    let joined = weld(&m.p);
    for shape in arkit::moved(sculpture()).iter().filter(|s| s.stem == "MarsienneSkin") {
        for (i, &first) in joined.iter().enumerate() {
            let apart = shape.offsets[i].distance(shape.offsets[first]);
            assert!(apart < 1e-9, "{} tears the skin by {apart} at {}", shape.name, m.p[i]);
        }
    }
}

#[test]
fn left_and_right_mirror_each_other() {
    let m = skin();
    let vertices = &sculpture().skin.vertices;
    // The right half's triangles come after the left half's, in the same order and turned around.
    let half = m.triangles.len() / 2;
    let mut twin: Vec<usize> = (0..m.p.len()).collect();
    for (l, r) in sculpture().skin.triangles[..half].iter().zip(&sculpture().skin.triangles[half..]) {
        for (a, b) in [(0, 0), (1, 2), (2, 1)] {
            twin[l[a] as usize] = r[b] as usize;
            twin[r[b] as usize] = l[a] as usize;
        }
    }
    let flip = |d: DVec3| DVec3::new(-d.x, d.y, d.z);
    assert!((0..twin.len()).all(|i| vertices[i].p.distance(flip(vertices[twin[i]].p)) < 1e-6));
    let all = arkit::moved(sculpture());
    let find = |name: &str| all.iter().find(|s| s.name == name && s.stem == "MarsienneSkin").unwrap();
    for shape in all.iter().filter(|s| s.stem == "MarsienneSkin") {
        let other = if let Some(stem) = shape.name.strip_suffix("Left") {
            find(&format!("{stem}Right"))
        } else if let Some(stem) = shape.name.strip_suffix("Right") {
            find(&format!("{stem}Left"))
        } else {
            shape
        };
        for (i, &k) in twin.iter().enumerate() {
            let off = shape.offsets[i].distance(flip(other.offsets[k]));
            let turned = shape.normals[i].distance(flip(other.normals[k]));
            assert!(off < 1e-4 && turned < 1e-4, "{}: {off} {turned} at {}", shape.name, m.p[i]);
        }
    }
}

/// By the jaw alone, whatever else turns, the cheeks' inner side comes to no gum either.
#[test]
fn bones_alone_stay_clean() {
    let face = face();
    for (i, a) in arkit::BY_BONES.iter().enumerate() {
        for b in &arkit::BY_BONES[i..] {
            for weight in [0.25, 0.5, 0.75, 1.0] {
                let with = [((*a).to_owned(), weight), ((*b).to_owned(), 1.0)].into();
                let found = faults(face, &with);
                assert!(found.flips.is_empty() && found.touching.is_empty(), "{found:?} under {with:?}");
            }
        }
    }
}

/// What a mixture does wrong.
fn judge(face: &Face, with: &Weights) -> Result<(), String> {
    let m = skin();
    let found = faults(face, with);
    if found.lids <= EYE_REACH {
        return Err(format!("lids at {} under {with:?}", found.lids));
    }
    if let Some(i) = found.touching.first() {
        return Err(format!("{} is in the teeth under {with:?}", m.p[*i]));
    }
    if let Some(t) = found.flips.first() {
        return Err(format!("a triangle at {} is flipped under {with:?}", m.p[face.triangles[*t][0]]));
    }
    Ok(())
}

/// Judges many mixtures.
///
/// # Panics
///
/// If one of them is not clean, with all that are not.
fn judge_all(mixtures: impl Iterator<Item = Weights>) {
    let face = face();
    let bad: Vec<String> = mixtures.filter_map(|with| judge(face, &with).err()).collect();
    assert!(bad.is_empty(), "{} mixtures are not clean:\n{}", bad.len(), bad.join("\n"));
}

fn random(round: u64, few: usize, names: &[String]) -> Weights {
    let chance = |k: usize| math::hash01(round * 1000 + k as u64);
    (0..few)
        .map(|k| {
            let at = if few == names.len() { k } else { (chance(2 * k) * names.len() as f64) as usize };
            (names[at].clone(), chance(2 * k + 1))
        })
        .collect()
}

fn pair(a: &str, b: &str) -> Weights {
    [(a.to_owned(), 1.0), (b.to_owned(), 1.0)].into()
}

fn mixtures(names: &[String], count: u64) -> impl Iterator<Item = Weights> {
    (0..count).map(|round| random(round, [4, 8, 16, 52][round as usize % 4], names))
}

/// Some pairs and mixtures; the next test takes all.
#[test]
fn pairs_and_mixtures_stay_clean() {
    let names = names();
    let pairs = names.iter().enumerate().map(|(i, a)| pair(a, &names[(7 * i + 3) % names.len()]));
    judge_all(pairs);
    judge_all(mixtures(&names, 40));
}

#[test]
fn a_recording_of_a_phone_stays_clean() {
    let Some(data) = shared("livelink-recording") else { return };
    let text = fs::read_to_string(data.join("dao.csv")).unwrap();
    let mut lines = text.lines();
    // The recording's names begin with a capital letter.
    let column = |name: &str| name[..1].to_lowercase() + &name[1..];
    let header: Vec<String> = lines.next().unwrap().split(',').map(column).collect();
    let names = names();
    assert!(names.iter().all(|name| header.contains(name)), "{header:?}");
    let frames: Vec<Weights> = lines
        .map(|line| {
            let values = header.iter().zip(line.split(','));
            let known = values.filter(|(name, _)| names.contains(name));
            known.map(|(name, value)| (name.clone(), value.parse().unwrap())).collect()
        })
        .collect();
    assert!(frames.len() == 180 && frames.iter().all(|with| with.len() == 52));
    judge_all(frames.into_iter());
}

#[test]
#[ignore = "a minute of a processor: run with --ignored after a change of shapes"]
fn all_pairs_and_a_thousand_mixtures_stay_clean() {
    let names = names();
    let pairs = names.iter().enumerate().flat_map(|(i, a)| names[i + 1..].iter().map(|b| pair(a, b)));
    judge_all(pairs);
    judge_all(mixtures(&names, 1000));
}
