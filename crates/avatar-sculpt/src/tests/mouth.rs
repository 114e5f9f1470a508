//! What opened mouths and smiles look like: the rim, the cheeks, and which teeth are seen.

use avatar_pack::{FaceState, Pack};
use glam::DVec3;

use super::{
    hit,
    load::{loaded, posed, values},
    mesh, sculpture,
};
use crate::{anatomy::MOUTH_Y, mesh::normals, surface::half::Patch};

/// Half of the line between the lips, on the left: over the upper lip to the corner and back.
fn rim(pack: &Pack, set: &[(&str, f32)]) -> Vec<DVec3> {
    let (skin, p) = (&sculpture().skin, posed(pack, set));
    let vertex = |node: &usize| skin.vertices.iter().position(|v| v.source == *node && v.p.x >= 0.0);
    skin.loops.mouth.iter().map(|node| p[vertex(node).unwrap()]).collect()
}

/// The least and the largest distance from the centre of the oval that the rim fills, seen from the front, in
/// shares of the oval's: both are 1 for an ellipse.
fn off_an_ellipse(rim: &[DVec3]) -> (f64, f64) {
    let low = rim.iter().fold(DVec3::INFINITY, |a, p| a.min(*p));
    let high = rim.iter().fold(DVec3::NEG_INFINITY, |a, p| a.max(*p));
    let (half, middle) = (0.5 * (high.y - low.y), 0.5 * (high.y + low.y));
    let shares = rim.iter().map(|p| (p.x / high.x).hypot((p.y - middle) / half));
    shares.fold((f64::INFINITY, 0.0), |(least, most), share| (share.min(least), share.max(most)))
}

#[test]
fn the_rim_of_an_opened_mouth_is_an_oval() {
    let pack = loaded();
    for open in [0.8, 0.9, 1.0] {
        let (least, most) = off_an_ellipse(&rim(&pack, &[("jawOpen", open)]));
        assert!(least > 0.89 && most < 1.08, "jawOpen {open}: {least:.3} to {most:.3}");
    }
    // A hexagon, whose sides lie at cos 30° from its centre, is none.
    let corners = [0.0, 60.0, 120.0, 180.0, 240.0, 300.0_f64].map(|at| {
        let (y, x) = at.to_radians().sin_cos();
        DVec3::new(x, y, 0.0)
    });
    let hexagon: Vec<DVec3> =
        (0..60).map(|k| corners[k / 10].lerp(corners[(k / 10 + 1) % 6], (k % 10) as f64 / 10.0)).collect();
    let (least, most) = off_an_ellipse(&hexagon);
    assert!(least < 0.89 || most > 1.08, "{least:.3} to {most:.3}");
}

/// The vertex of the left cheek's or mouth's outer skin that is nearest to a place.
fn nearest(p: DVec3) -> usize {
    let skin = &sculpture().skin;
    let outer = |i: &usize| skin.half.nodes[skin.vertices[*i].source].patch == Patch::Sheet;
    let off = |i: usize| skin.vertices[i].p.distance_squared(p);
    (0..skin.vertices.len()).filter(outer).min_by(|a, b| off(*a).total_cmp(&off(*b))).unwrap()
}

/// Under the eye on the swelling, and at the same height below it beside and in the fold from nose to mouth.
const APPLE: DVec3 = DVec3::new(3.5, -3.0, 3.0);
const BESIDE_FOLD: DVec3 = DVec3::new(3.1, -4.2, 3.1);
const IN_FOLD: DVec3 = DVec3::new(2.35, -4.2, 3.6);

#[test]
fn a_smile_swells_the_cheek_and_deepens_its_fold() {
    let (pack, smile) = (loaded(), [("mouthSmileLeft", 1.0), ("mouthSmileRight", 1.0)]);
    let (rest, smiling) = (posed(&pack, &[]), posed(&pack, &smile));
    let moved = |at: DVec3| smiling[nearest(at)] - rest[nearest(at)];
    // A real cheek comes forward by about half a centimetre, and up.
    assert!(moved(APPLE).z > 0.4 && moved(APPLE).y > 0.3, "{}", moved(APPLE));
    let deeper = moved(BESIDE_FOLD).z - moved(IN_FOLD).z;
    assert!(deeper > 0.3, "{deeper}");
}

#[test]
fn an_open_jaw_hollows_the_cheeks_and_draws_them_long() {
    let pack = loaded();
    let (rest, open) = (posed(&pack, &[]), posed(&pack, &[("jawOpen", 1.0)]));
    let moved = |at: DVec3| open[nearest(at)] - rest[nearest(at)];
    let cheek = moved(DVec3::new(5.0, -4.6, 1.5));
    assert!(cheek.x < -0.25 && cheek.y < -0.2, "{cheek}");
    assert!(moved(APPLE).y < -0.1, "{}", moved(APPLE));
}

/// The least depth of the mouth's inside, from before the gums on, under the skin of lips and chin; below
/// zero it comes through.
fn bag_under_skin(pack: &Pack, set: &[(&str, f32)]) -> f64 {
    let (skin, p) = (&sculpture().skin, posed(pack, set));
    let patch = |i: usize| skin.half.nodes[skin.vertices[i].source].patch;
    let triangles: Vec<[usize; 3]> = skin.triangles.iter().map(|t| t.map(|i| i as usize)).collect();
    let n = normals(&p, &triangles);
    let at = |i: usize| skin.vertices[i].p;
    let about_mouth = |i: &usize| at(*i).z > 1.5 && at(*i).y > -9.0 && at(*i).y < -3.0;
    let near = || (0..p.len()).filter(about_mouth);
    let outer: Vec<usize> = near().filter(|i| patch(*i) == Patch::Sheet).collect();
    // Above and below the lips, every third one.
    let is_inner = |i: &usize| patch(*i) == Patch::Mouth && (at(*i).y - MOUTH_Y).abs() > 1.0;
    let inner: Vec<usize> = near().filter(is_inner).step_by(3).collect();
    assert!(inner.len() > 30 && outer.len() > 1000, "{} under {}", inner.len(), outer.len());
    let depth = |i: usize| {
        let nearest = outer
            .iter()
            .min_by(|a, b| p[**a].distance_squared(p[i]).total_cmp(&p[**b].distance_squared(p[i])));
        nearest.map_or(f64::INFINITY, |k| (p[*k] - p[i]).dot(n[*k]))
    };
    inner.into_iter().map(depth).fold(f64::INFINITY, f64::min)
}

#[test]
fn the_inside_of_the_mouth_stays_under_the_skin() {
    let pack = loaded();
    let is_of_mouth =
        |name: &&str| ["mouth", "jaw", "cheekPuff", "tongueOut"].iter().any(|of| name.starts_with(of));
    let names: Vec<&str> = pack.controls().names().filter(is_of_mouth).collect();
    assert!(names.len() > 25, "{names:?}");
    for name in names {
        let depth = bag_under_skin(&pack, &[(name, 1.0)]);
        assert!(depth > 0.1, "{name}: {depth:.3}");
    }
}

/// How many vertices of the lower teeth are seen, from straight ahead and from above by a little.
fn seen_teeth(pack: &Pack, set: &[(&str, f32)]) -> usize {
    let p = posed(pack, set);
    let skin = pack.parts().iter().position(|part| part.name == "skin").unwrap();
    let triangles: Vec<[DVec3; 3]> = pack.parts()[skin]
        .mesh
        .triangles
        .iter()
        .map(|t| t.map(|i| p[i as usize]))
        .filter(|t| t.iter().all(|p| p.z > 1.5 && p.y > -11.0 && p.y < -3.0 && p.x.abs() < 3.5))
        .collect();
    let row = pack.parts().iter().position(|part| part.name == "lower-jaw").unwrap();
    let mut face = FaceState::new(pack);
    face.pose(pack, &values(pack, set)).unwrap();
    let row = face.deform(pack, row).unwrap().positions;
    let teeth = mesh("LowerJaw");
    let is_tooth = |i: &usize| teeth.uv[*i].y < 0.5 && teeth.p[*i].z > 2.4;
    let views = [DVec3::Z, DVec3::new(0.0, 0.1, 1.0)].map(DVec3::normalize_or_zero);
    let hidden = |i: usize, view: DVec3| {
        let from = row[i].as_dvec3();
        triangles.iter().any(|t| hit(from, view, *t).is_some())
    };
    let seen = |i: &usize| views.iter().any(|view| !hidden(*i, *view));
    (0..teeth.p.len()).filter(is_tooth).step_by(5).filter(seen).count()
}

#[test]
fn rounded_lips_cover_the_lower_teeth_and_a_laugh_does_not() {
    let pack = loaded();
    assert_eq!(seen_teeth(&pack, &[("viseme_O", 1.0)]), 0);
    let pose = |name: &str| {
        let pose = pack.poses().iter().find(|pose| pose.name == name).unwrap();
        let names = pack.controls().controls();
        let still = |name: &str| name.starts_with("head.");
        let set = pose.values.iter().map(|(control, value)| (names[*control].name.as_str(), *value));
        set.filter(|(name, _)| !still(name)).collect::<Vec<_>>()
    };
    assert_eq!(seen_teeth(&pack, &pose("oh")), 0);
    let laughing = seen_teeth(&pack, &pose("laugh"));
    assert!(laughing > 10, "{laughing}");
}

/// The foremost place of the tongue that is seen from the front between lips and teeth.
fn seen_tongue(pack: &Pack, set: &[(&str, f32)]) -> f64 {
    let mut face = FaceState::new(pack);
    face.pose(pack, &values(pack, set)).unwrap();
    let mut before: Vec<[DVec3; 3]> = vec![];
    let mut tongue = vec![];
    for (number, part) in pack.parts().iter().enumerate() {
        if !["skin", "upper-jaw", "lower-jaw"].contains(&part.name.as_str()) {
            continue;
        }
        let p: Vec<DVec3> =
            face.deform(pack, number).unwrap().positions.iter().map(|p| p.as_dvec3()).collect();
        let near = |p: &DVec3| p.z > 1.0 && p.y > -9.0 && p.y < -3.0 && p.x.abs() < 2.0;
        let corners = part.mesh.triangles.iter().map(|t| t.map(|i| p[i as usize]));
        before.extend(corners.filter(|t| t.iter().all(near)));
        if part.name == "lower-jaw" {
            let uvs = &part.mesh.uvs;
            tongue.extend(p.iter().zip(uvs).filter(|(_, uv)| uv.y > 0.75).map(|(p, _)| *p));
        }
    }
    let seen = |from: &&DVec3| !before.iter().any(|t| hit(**from, DVec3::Z, *t).is_some_and(|s| s > 1e-3));
    let near = tongue.iter().filter(|p| p.x.abs() < 0.9).filter(seen);
    near.map(|p| p.z).fold(f64::NEG_INFINITY, f64::max)
}

#[test]
fn the_tip_of_the_tongue_is_seen_for_t_and_n_and_its_back_for_k() {
    let pack = loaded();
    let seen = |viseme: &str| seen_tongue(&pack, &[(viseme, 1.0)]);
    let (t, n, k) = (seen("viseme_DD"), seen("viseme_nn"), seen("viseme_kk"));
    assert!(t > 2.0 && n > 2.0 && k < 1.8, "t {t:.2}, n {n:.2}, k {k:.2}");
}
