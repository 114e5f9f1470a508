//! An independent witness for the shapes of ARKit: the 52 targets that others sculpted on MakeHuman's base
//! mesh.
//!
//! Both heads are brought together by landmarks. Then each shape must move the same region (the centre of its
//! motion) in the same direction (the mean cosine over the region) as its target does. The targets are read
//! from the data beside the workspace; nothing of them is in this repository.

mod heads;
mod warp;

use std::path::Path;

use glam::DVec3;

use super::shared;
use crate::arkit;
use heads::{Head, Organ, Ours, makehuman, target};
use warp::Warp;

/// Vertices that move by less than this share of the largest motion do not count as moved.
const MOVED: f64 = 0.25;
/// From under the chin to between the brows.
const FACE_HEIGHT: f64 = 11.9;

/// All names: what bones do, and what fields do.
fn names() -> Vec<String> {
    let mut names: Vec<String> = arkit::BY_BONES.iter().map(|n| (*n).to_owned()).collect();
    for (name, kind) in arkit::FIELDS {
        match kind {
            arkit::Kind::Both(_) | arkit::Kind::WithJaw(_) | arkit::Kind::OpenJaw(_) => {
                names.push(name.to_owned())
            }
            _ => names.extend([format!("{name}Left"), format!("{name}Right")]),
        }
    }
    names.sort();
    names
}

/// Vertices that count as moved.
fn moved(d: &[DVec3], head: &Head) -> Vec<usize> {
    let most = (0..d.len()).filter(|&i| head.organ[i].is_some()).map(|i| d[i].length()).fold(0.0, f64::max);
    (0..d.len()).filter(|&i| head.organ[i].is_some() && d[i].length() > MOVED * most.max(1e-9)).collect()
}

/// Where the motion has its centre, weighted by area and length.
fn centre(d: &[DVec3], p: &[DVec3], area: &[f64], moved: &[usize]) -> DVec3 {
    let (mut sum, mut total) = (DVec3::ZERO, 0.0);
    for &i in moved {
        let w = area[i] * d[i].length();
        sum += p[i] * w;
        total += w;
    }
    sum / total
}

struct Row {
    name: String,
    cosine: f64,
    centre: f64,
}

fn compare(data: &Path) -> Vec<Row> {
    let ours = Ours::new();
    let theirs = makehuman(data);
    let warp = Warp::new();
    let placed: Vec<DVec3> = theirs.p.iter().map(|p| warp.at(*p)).collect();
    let mut partner: Vec<Option<usize>> = vec![None; placed.len()];
    let mut rows = vec![];
    for name in names() {
        let target = target(data, &name, placed.len());
        // A displacement goes over to the other head with both of its ends.
        let witness: Vec<DVec3> = (0..placed.len())
            .map(|i| {
                if target[i] == DVec3::ZERO {
                    DVec3::ZERO
                } else {
                    warp.at(theirs.p[i] + target[i]) - placed[i]
                }
            })
            .collect();
        let d = ours.displacement(&name);
        let region = moved(&witness, &theirs);
        let (mut sum, mut total) = (0.0, 0.0);
        for &i in &region {
            let organ = theirs.organ[i].unwrap();
            let k = *partner[i].get_or_insert_with(|| nearest(&ours.head, organ, placed[i], theirs.n[i]));
            let (a, b) = (witness[i].normalize_or_zero(), d[k].normalize_or_zero());
            sum += theirs.area[i] * a.dot(b);
            total += theirs.area[i];
        }
        let centre_theirs = centre(&witness, &placed, &theirs.area, &region);
        let centre_ours = centre(&d, &ours.head.p, &ours.head.area, &moved(&d, &ours.head));
        let off = centre_theirs.distance(centre_ours) / FACE_HEIGHT;
        println!("{name:<20} {:>5.2} {:>5.1} %", sum / total, 100.0 * off);
        rows.push(Row { name, cosine: sum / total, centre: off });
    }
    rows
}

/// The nearest vertex of the same organ whose normal points the same way.
fn nearest(head: &Head, organ: Organ, p: DVec3, n: DVec3) -> usize {
    let cost = |i: usize| head.p[i].distance_squared(p) + 0.5 * (1.0 - head.n[i].dot(n));
    let same = (0..head.p.len()).filter(|&i| head.organ[i] == Some(organ));
    same.min_by(|&a, &b| cost(a).total_cmp(&cost(b))).unwrap()
}

#[test]
fn shapes_move_as_the_targets_of_another_head_do() {
    let Some(data) = shared("talkinghead-arkit-targets") else { return };
    let data = data.join("..");
    let rows = compare(&data);
    assert_eq!(rows.len(), 52);
    let bad: Vec<_> = rows.iter().filter(|r| r.cosine < 0.7 || r.centre > 0.1).map(|r| &r.name).collect();
    assert!(bad.is_empty(), "{bad:?}");
}
