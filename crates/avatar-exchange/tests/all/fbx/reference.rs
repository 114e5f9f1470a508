//! Files of Maya, 3ds Max, Blender and Revit beside what these programs themselves wrote for a moment, as OBJ
//! (`../shared/data/ufbx-reference`).

use super::read;
use crate::support::data::shared_data;
use avatar_exchange::{Scene, ScenePose};
use glam::DVec3;
use std::path::Path;

/// Points and faces of an OBJ file, as they stand there.
struct Obj {
    points: Vec<DVec3>,
    faces: Vec<Vec<usize>>,
}

impl Obj {
    fn read(path: &Path, scale: f64) -> Self {
        let text = String::from_utf8_lossy(&std::fs::read(path).unwrap()).into_owned();
        let stated = text.lines().find_map(|line| line.strip_prefix("# ufbx:position_scale="));
        let scale = scale * stated.map_or(1.0, |text| 1.0 / text.trim().parse::<f64>().unwrap());
        let mut obj = Self { points: Vec::new(), faces: Vec::new() };
        for line in text.lines() {
            let mut words = line.split_whitespace();
            match words.next() {
                Some("v") => {
                    let mut next = || words.next().unwrap().parse::<f64>().unwrap() * scale;
                    obj.points.push(DVec3::new(next(), next(), next()));
                }
                Some("f") => {
                    let index = |word: &str| word.split('/').next().unwrap().parse::<usize>().unwrap() - 1;
                    obj.faces.push(words.map(index).collect());
                }
                _ => {}
            }
        }
        obj
    }
}

/// Corners of all triangles of a scene in a pose, in metres.
fn corners(scene: &Scene, pose: &ScenePose) -> Vec<[DVec3; 3]> {
    let bones = scene.bones(pose);
    let mut corners = Vec::new();
    for (number, part) in scene.parts.iter().enumerate() {
        let mut out = part.mesh.deformed();
        let weights = scene.weights_of(number, pose);
        avatar_mesh::deform(&part.mesh, scene.bones_of(number, &bones), weights, &mut out).unwrap();
        let at = |vertex: u32| out.positions[vertex as usize].as_dvec3();
        corners.extend(part.mesh.triangles.iter().map(|triangle| triangle.map(at)));
    }
    corners
}

/// The largest distance from a point of one set to the nearest one of another.
fn farthest(from: &[DVec3], to: &[DVec3]) -> f64 {
    let nearest = |a: &DVec3| to.iter().map(|b| a.distance_squared(*b)).fold(f64::MAX, f64::min);
    from.iter().map(nearest).fold(0.0, f64::max).sqrt()
}

#[test]
fn what_other_programs_wrote_is_met() {
    let Some(folder) = shared_data("ufbx-reference") else { return };
    let mut names: Vec<String> = std::fs::read_dir(&folder)
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    for file in names.iter().filter(|name| name.ends_with(".fbx")) {
        let bytes = std::fs::read(folder.join(file)).unwrap();
        let scene = match read(file, &bytes) { Ok(s) => s, Err(e) => { println!("{file}: {e}"); continue } };
        let fbx = ufbx::load_memory(&bytes, ufbx::LoadOpts::default()).unwrap();
        let base = file.rsplitn(3, '_').nth(2).unwrap();
        let unit = if file.starts_with("blender") && !file.contains("6100") && !file.contains("nested") { 1.0 } else { fbx.settings.unit_meters };
        for obj in names.iter().filter(|name| name.ends_with(".obj")) {
            let Some(rest) = obj.strip_prefix(base).and_then(|rest| rest.strip_suffix(".obj")) else { continue };
            let frame = rest.strip_prefix('_').and_then(|frame| frame.parse::<u32>().ok());
            if frame.is_none() && !rest.is_empty() { continue }
            let expected = Obj::read(&folder.join(obj), unit);
            let anim = &fbx.anim_stacks.first().map(|s| (s.anim.time_begin, s.anim.time_end));
            let pose = match frame {
                None => scene.rest(),
                Some(frame) => {
                    let time = f64::from(frame) / fbx.settings.frames_per_second - anim.map_or(0.0, |a| a.0);
                    match scene.at(0, time) { Ok(p) => p, Err(e) => { println!("{file} {obj}: {e}"); scene.rest() } }
                }
            };
            let found = corners(&scene, &pose);
            let points: Vec<DVec3> = found.iter().flatten().copied().collect();
            let theirs: Vec<DVec3> = expected.faces.iter().flatten().map(|p| expected.points[*p]).collect();
            let theirs = if theirs.is_empty() { expected.points.clone() } else { theirs };
            if theirs.is_empty() { println!("{file} {obj}: no points"); continue }
            if points.is_empty() { println!("{file} {obj}: nothing"); continue }
            let low = theirs.iter().copied().reduce(DVec3::min).unwrap();
            let high = theirs.iter().copied().reduce(DVec3::max).unwrap();
            let size = (high - low).length();
            let turned = |p: &DVec3| DVec3::new(p.x, p.z, -p.y);
            let t2: Vec<DVec3> = theirs.iter().map(turned).collect();
            let set = |theirs: &[DVec3]| farthest(&points, theirs).max(farthest(theirs, &points)) / size;
            let triangles: usize = expected.faces.iter().map(|face| face.len() - 2).sum();
            // face by face
            let by_face = |turn: bool| {
                if triangles != found.len() { return f64::NAN }
                let mut at = 0; let mut worst: f64 = 0.0;
                for face in &expected.faces {
                    let theirs: Vec<DVec3> = face.iter().map(|p| if turn { turned(&expected.points[*p]) } else { expected.points[*p] }).collect();
                    let ours: Vec<DVec3> = found[at..at + face.len() - 2].iter().flatten().copied().collect();
                    at += face.len() - 2;
                    worst = worst.max(farthest(&theirs, &ours)).max(farthest(&ours, &theirs));
                }
                worst / size
            };
            println!("{file:52} {obj:46} tri {} {} set {:.2e} turned {:.2e} face {:.2e} {:.2e} fps {} {:?}", found.len(), triangles, set(&theirs), set(&t2), by_face(false), by_face(true), fbx.settings.frames_per_second, anim);
        }
        for n in &scene.notes { println!("      {n}"); }
    }
}
