//! Files of Maya, 3ds Max, Blender and Revit beside what these programs themselves wrote for a moment, as OBJ
//! (`../shared/data/ufbx-reference`). `docs/formats.md` tells which are met.

use super::read;
use crate::support::data::shared_data;
use avatar_exchange::{Scene, ScenePose};
use glam::{DAffine3, DMat3, DVec3, Vec3};
use std::collections::BTreeMap;
use std::path::Path;

/// Of the size of what the OBJ file shows.
const TOLERANCE: f64 = 1e-4;

/// Files that are not met, and what the page about formats says of them.
const NOT_MET: &[(&str, &str)] = &[
    ("blender_293_suzanne_subsurf_7400_binary.fbx", SUBDIVIDED),
    ("blender_293x_nonmanifold_subsurf_7400_binary.fbx", SUBDIVIDED),
    ("blender_312x_vertex_crease_7400_binary.fbx", SUBDIVIDED),
    ("maya_dq_weights_7500_binary.fbx", DUAL_QUATERNIONS),
    ("maya_dual_quaternion_7500_ascii.fbx", DUAL_QUATERNIONS),
    ("maya_nurbs_low_sphere_7500_ascii.fbx", NURBS),
    ("maya_poses_7700_ascii.fbx", "3.5e-4"),
    ("maya_subsurf_3x_cube_crease_7500_ascii.fbx", SUBDIVIDED),
    ("maya_subsurf_cube_7500_ascii.fbx", SUBDIVIDED),
    ("maya_subsurf_cube_crease_7500_ascii.fbx", SUBDIVIDED),
    ("maya_vertex_crease_6100_ascii.fbx", SUBDIVIDED),
    ("maya_vertex_crease_7700_binary.fbx", SUBDIVIDED),
    ("maya_vertex_crease_single_7700_ascii.fbx", SUBDIVIDED),
];
/// Files whose OBJ files have the faces in another order.
const REORDERED: [&str; 3] = ["blender_340_mirrored_normals", "max2009_blob", "revit_wall_square"];
const SUBDIVIDED: &str = "subdivision surface";
const DUAL_QUATERNIONS: &str = "dual quaternion";
const NURBS: &str = "NURBS surface";

/// Points and faces of an OBJ file, in metres and with y up.
struct Obj {
    points: Vec<DVec3>,
    faces: Vec<Vec<usize>>,
    text: String,
}

impl Obj {
    fn read(path: &Path, fbx: &ufbx::Scene) -> Self {
        let text = String::from_utf8_lossy(&std::fs::read(path).unwrap()).into_owned();
        let mut obj = Self { points: Vec::new(), faces: Vec::new(), text };
        let is_blenders = fbx.metadata.creator.contains("Blender") && fbx.metadata.version >= 7000;
        let is_centimeters = obj.text.contains("uses centimeters");
        // Revit's file came to OBJ by way of Maya, which converted feet and axes.
        let is_from_feet = is_centimeters && (fbx.settings.unit_meters - 0.3048).abs() < 1e-6;
        let unit = match fbx.settings.unit_meters {
            // Its OBJ files are in its own unit, and its FBX files say how many of theirs that is.
            _ if is_blenders && !is_centimeters => 1.0,
            _ if is_from_feet => 0.01,
            unit => unit,
        };
        let blenders_obj = obj.text.contains("# Blender");
        let is_z_up =
            fbx.settings.axes.up == ufbx::CoordinateAxis::PositiveZ && !blenders_obj && !is_from_feet;
        for line in obj.text.lines() {
            let mut words = line.split_whitespace();
            match words.next() {
                Some("v") => {
                    let mut next = || words.next().unwrap().parse::<f64>().unwrap() * unit;
                    let [x, y, z] = [next(), next(), next()];
                    obj.points.push(if is_z_up { DVec3::new(x, z, -y) } else { DVec3::new(x, y, z) });
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

    fn size(&self) -> f64 {
        let corner = |pick: fn(DVec3, DVec3) -> DVec3| self.points.iter().copied().reduce(pick).unwrap();
        (corner(DVec3::max) - corner(DVec3::min)).length()
    }

    /// How far triangles are from these faces, relative to the size: each from its own face, where the file
    /// has faces in the order of the FBX file, else all points from the nearest ones.
    fn distance(&self, triangles: &[[Vec3; 3]], is_reordered: bool) -> f64 {
        let ours = |some: &[[Vec3; 3]]| some.iter().flatten().map(|p| p.as_dvec3()).collect::<Vec<_>>();
        let both = |a: &[DVec3], b: &[DVec3]| farthest(a, b).max(farthest(b, a));
        if triangles.is_empty() {
            return f64::INFINITY;
        }
        if self.faces.is_empty() || is_reordered {
            return both(&self.points, &ours(triangles)) / self.size();
        }
        if self.faces.iter().map(|face| face.len() - 2).sum::<usize>() != triangles.len() {
            return f64::INFINITY;
        }
        let mut rest = triangles;
        let of_face = |face: &Vec<usize>| {
            let (own, others) = rest.split_at(face.len() - 2);
            rest = others;
            let theirs: Vec<DVec3> = face.iter().map(|point| self.points[*point]).collect();
            both(&theirs, &ours(own))
        };
        self.faces.iter().map(of_face).fold(0.0, f64::max) / self.size()
    }
}

/// The largest distance from a point of one set to the nearest one of another.
fn farthest(from: &[DVec3], to: &[DVec3]) -> f64 {
    let nearest = |a: &DVec3| to.iter().map(|b| a.distance_squared(*b)).fold(f64::MAX, f64::min);
    from.iter().map(nearest).fold(0.0, f64::max).sqrt()
}

/// All triangles of a scene in a pose. Maya moves a skinned mesh by its own node as well: from where that was
/// when the mesh was bound, `world_from_bound`.
fn triangles(scene: &Scene, pose: &ScenePose, world_from_bound: Option<DAffine3>) -> Vec<[Vec3; 3]> {
    let (bones, worlds) = (scene.bones(pose), scene.worlds(pose));
    let mut triangles = Vec::new();
    for (number, part) in scene.parts.iter().enumerate() {
        let mut out = part.mesh.deformed();
        let weights = scene.weights_of(number, pose);
        avatar_mesh::deform(&part.mesh, scene.bones_of(number, &bones), weights, &mut out).unwrap();
        let again = world_from_bound.map(|bound| worlds[part.node] * bound.inverse());
        let at = |vertex: u32| match again {
            Some(again) => again.transform_point3(out.positions[vertex as usize].as_dvec3()).as_vec3(),
            None => out.positions[vertex as usize],
        };
        triangles.extend(part.mesh.triangles.iter().map(|triangle| triangle.map(at)));
    }
    triangles
}

/// Where the mesh of a file's first bone was when it was bound, in metres.
fn world_from_bound(fbx: &ufbx::Scene) -> DAffine3 {
    let cluster = &fbx.skin_clusters[0];
    let m = ufbx::matrix_mul(&cluster.bind_to_world, &cluster.geometry_to_bone);
    let axis = |x, y, z| DVec3::new(x, y, z);
    let axes =
        DMat3::from_cols(axis(m.m00, m.m10, m.m20), axis(m.m01, m.m11, m.m21), axis(m.m02, m.m12, m.m22));
    DAffine3::from_mat3_translation(axes, axis(m.m03, m.m13, m.m23) * fbx.settings.unit_meters)
}

/// Names without version and kind: what the OBJ files are called after.
fn stem(file: &str) -> &str {
    file.rsplitn(3, '_').nth(2).unwrap()
}

/// The frame that an OBJ file of this stem shows; `None` inside is the pose outside of takes.
fn frame_of(obj: &str, stem: &str) -> Option<Option<u32>> {
    match obj.strip_prefix(stem)?.strip_suffix(".obj")? {
        "" => Some(None),
        rest => rest.strip_prefix('_')?.parse().ok().map(Some),
    }
}

#[test]
fn what_other_programs_wrote_is_met() {
    let Some(folder) = shared_data("ufbx-reference") else { return };
    let names: Vec<String> = std::fs::read_dir(&folder)
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    let mut distances: BTreeMap<&str, f64> = BTreeMap::new();
    let mut compared = 0;
    for file in names.iter().filter(|name| name.ends_with(".fbx")) {
        let bytes = std::fs::read(folder.join(file)).unwrap();
        let scene = read(file, &bytes).unwrap();
        let fbx = ufbx::load_memory(&bytes, ufbx::LoadOpts::default()).unwrap();
        for obj in &names {
            let Some(frame) = frame_of(obj, stem(file)) else { continue };
            let expected = Obj::read(&folder.join(obj), &fbx);
            let pose = match frame {
                None => scene.rest(),
                Some(frame) => {
                    let begin = fbx.anim_stacks[0].anim.time_begin;
                    scene.at(0, f64::from(frame) / fbx.settings.frames_per_second - begin).unwrap()
                }
            };
            let bound = expected.text.contains("# ufbx:transform_skin").then(|| world_from_bound(&fbx));
            let is_reordered = REORDERED.contains(&stem(file));
            let distance = expected.distance(&triangles(&scene, &pose, bound), is_reordered);
            println!("{file} {obj}: {distance:.1e}");
            let worst = distances.entry(file).or_default();
            *worst = worst.max(distance);
            compared += 1;
        }
    }
    assert_eq!((distances.len(), compared), (names.iter().filter(|name| name.ends_with(".fbx")).count(), 86));
    for (file, distance) in &distances {
        let why = NOT_MET.iter().find(|(name, _)| name == file);
        assert_eq!(*distance <= TOLERANCE, why.is_none(), "{file}: {distance:e}, {why:?}");
    }
    let page = include_str!("../../../../../docs/formats.md");
    for (file, why) in NOT_MET {
        let name = format!("`{file}`");
        let row =
            page.lines().find(|line| line.contains(&name)).unwrap_or_else(|| panic!("{file} is not there"));
        assert!(row.contains(why), "{row}");
    }
    let summary = format!("{} of {} files", distances.len() - NOT_MET.len(), distances.len());
    assert!(page.contains(&summary), "{summary} is not there");
}
