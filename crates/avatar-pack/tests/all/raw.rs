//! Avatars written in the raw format, and loaded again: the same vertices wherever the controls take them.
#![allow(
    clippy::expect_used,
    clippy::panic,
    clippy::disallowed_methods,
    reason = "a test: it may panic and read files"
)]

use crate::common::folder;
use avatar_exchange::{Node, RawScene, Scene, ScenePart, Skin, Transform, Trs, glb, gltf};
use avatar_mesh::{FACE_PARTS, Mesh, Shape, Skinning};
use avatar_pack::{
    FaceState, Import, MemorySource, Pack, RawError, RawFiles, ShapeWeight, Texture, Textures, export,
    raw_files,
};
use glam::{Affine3A, Quat, Vec2, Vec3};
use pose_anim::ClipSet;

/// Differences are parts of the avatar's size.
const TOLERANCE: f32 = 1e-6;

fn loaded(files: &RawFiles) -> (MemorySource, Pack) {
    let source = MemorySource { files: files.files.iter().cloned().collect() };
    let pack = Pack::load(&source).expect("what was written");
    (source, pack)
}

fn imported(raw: RawScene) -> Import {
    Import::from_scene(Scene::from_raw(raw).expect("a scene")).expect("an avatar")
}

/// The shapes that follow others of the pack, with their weights: in a GLB each has a control of its own.
fn followers<'a>(pack: &'a Pack, values: &[f32]) -> Vec<(&'a str, f32)> {
    let mut state = FaceState::new(pack);
    state.pose(pack, values).expect("a pose");
    let further = &pack.further_shapes().expect("further shapes").shapes;
    let weight_of = |name: &str| pack.shapes().iter().position(|shape| shape == name).expect("a shape");
    (further.iter().filter(|shape| shape.weight != ShapeWeight::Control))
        .map(|shape| (shape.name.as_str(), state.weights()[weight_of(&shape.name)]))
        .collect()
}

/// All vertices of a pose by the names of its controls, in the order of the parts.
fn posed(pack: &Pack, values: &[(&str, f32)], parts: &[usize]) -> Vec<Vec3> {
    let mut all = pack.controls().defaults();
    for (name, value) in values {
        all[pack.controls().index(name).unwrap_or_else(|| panic!("the control {name}"))] = *value;
    }
    let mut state = FaceState::new(pack);
    state.pose(pack, &all).expect("a pose");
    parts.iter().flat_map(|part| state.deform(pack, *part).expect("a part").positions).collect()
}

#[track_caller]
fn agree(a: &[Vec3], b: &[Vec3], size: f32, what: &str) {
    assert_eq!(a.len(), b.len(), "{what}");
    let worst = a.iter().zip(b).fold(0.0f32, |worst, (a, b)| worst.max((*a - *b).abs().max_element()));
    assert!(worst <= TOLERANCE * size, "{what}: {worst} of {size}");
}

/// Every control at both ends of its range, alone, and all at once at a third of theirs.
fn poses(pack: &Pack) -> Vec<Vec<(&str, f32)>> {
    let controls = pack.controls().controls();
    let ends = controls.iter().flat_map(|c| [vec![(c.name.as_str(), c.min)], vec![(c.name.as_str(), c.max)]]);
    let third = controls.iter().map(|c| (c.name.as_str(), (c.min + 2.0 * c.max) / 3.0)).collect();
    ends.chain([third]).collect()
}

#[test]
fn a_pack_of_the_format_comes_back_to_the_bit() {
    for folder in ["assets/marsienne", "tests/golden/pack"] {
        let own = self::folder(folder);
        let (mut pack, textures) = (Pack::load(&own).expect("a pack"), Textures::load(&own));
        let clips = "[[clip]]\nname = 'nod'\nkey = 'n'\nwrap = 'loop'\n[clip.tracks]\n'head.bow' = \
            [{ t = 0, v = 0.3, slopes = [0, -1.5] }, { t = 0.1, v = 2, transition = 'sine-in' }, { t = 1.7, v = 0 }]";
        let clips = ClipSet::from_toml(clips, pack.controls()).expect("clips");
        pack.set_clips(clips).expect("clips of these controls");
        let files = raw_files(&pack, &textures).expect("files");
        assert_eq!(files.notes, [""; 0], "{folder}");
        let (written, again) = loaded(&files);
        assert_eq!(again.clips(), pack.clips());
        for spec in FACE_PARTS {
            for end in ["_VB.raw", "_IB.raw"] {
                let name = format!("{}{end}", spec.stem);
                assert!(own.files[&name] == written.files[&name], "{folder}/{name}");
            }
        }
        assert_eq!(again.rig().names(), pack.rig().names());
        assert_eq!(again.rig().parent_from_joint(), pack.rig().parent_from_joint());
        assert_eq!((again.controls(), again.poses()), (pack.controls(), pack.poses()), "{folder}");
        assert_eq!((again.materials(), again.hair()), (pack.materials(), pack.hair()), "{folder}");
        let pictures = Textures::load(&written);
        for texture in Texture::ALL {
            assert!(pictures.get(texture) == textures.get(texture), "{folder}: {texture:?}");
        }
    }
}

#[test]
fn an_avatar_that_went_through_glb_is_the_same_in_all_poses() {
    let own = folder("assets/marsienne");
    let (pack, textures) = (Pack::load(&own).expect("a pack"), Textures::load(&own));
    let bytes = glb::write_raw(&export(&pack, &textures)).expect("a GLB");
    let scene = gltf::read("a.glb", &bytes, &mut |_| Err(String::new())).expect("a scene");
    let import = Import::from_scene(scene).expect("an avatar");
    let files = raw_files(&import.pack, &import.textures).expect("files");
    let (written, again) = loaded(&files);
    let names: Vec<_> = again.rig().names().to_vec();
    assert_eq!(names, pack.rig().names());
    for spec in FACE_PARTS {
        let name = format!("{}_VB.raw", spec.stem);
        let (a, b) = (&own.files[&name], &written.files[&name]);
        assert_eq!(a.len(), b.len(), "{name}");
    }
    let bounds = pack.bounds().expect("vertices");
    let size = (bounds.max - bounds.min).max_element();
    // The couplings of the pack and its mixtures are no part of a GLB: what it has of them is compared.
    let mixtures = &pack.further_shapes().expect("further shapes").mixtures;
    let all: Vec<usize> = (0..FACE_PARTS.len()).collect();
    for pose in poses(&pack) {
        let mut values = pack.controls().defaults();
        pose.iter().for_each(|(name, v)| values[pack.controls().index(name).expect("a control")] = *v);
        let mut state = FaceState::new(&pack);
        state.pose(&pack, &values).expect("a pose");
        let effective = state.effective().to_vec();
        let named: Vec<(&str, f32)> = (pack.controls().names().zip(effective))
            .filter(|(name, _)| !mixtures.iter().any(|mixture| mixture.name == *name))
            .chain(followers(&pack, &values))
            .collect();
        let of_pack = posed(&pack, &pose, &all);
        agree(&of_pack, &posed(&import.pack, &named, &all), size, &format!("GLB, {pose:?}"));
        agree(&of_pack, &posed(&again, &named, &all), size, &format!("folder, {pose:?}"));
    }
    let found = Textures::load(&written);
    for texture in
        [Texture::SkinColor, Texture::SkinNormal, Texture::SkinOcclusion, Texture::Eye(0), Texture::Teeth]
    {
        assert!(found.get(texture) == textures.get(texture), "{texture:?}");
    }
}

/// A square of four vertices.
fn square(at: Vec3) -> Mesh {
    let corners = [Vec3::ZERO, Vec3::X, Vec3::ONE - Vec3::Z, Vec3::Y];
    Mesh {
        positions: corners.map(|corner| corner + at).into(),
        normals: vec![Vec3::Z; 4],
        uvs: vec![Vec2::new(0.5, 0.25); 4],
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        ..Mesh::default()
    }
}

fn node(name: &str, parent: Option<usize>, trs: Trs) -> Node {
    Node { name: name.to_owned(), parent, local: Transform::Trs(trs), weights: Vec::new() }
}

/// A head of an interchange format: in centimetres, turned, with a skin, a jaw and an eye, and teeth.
fn head() -> RawScene {
    let at = |x: f32, y: f32, z: f32| Trs { translation: Vec3::new(x, y, z), ..Trs::default() };
    let nodes = vec![
        node(
            "root",
            None,
            Trs { scale: Vec3::splat(0.01), rotation: Quat::from_rotation_x(-1.5), ..Trs::default() },
        ),
        node("mixamorig:Neck", Some(0), Trs { rotation: Quat::from_rotation_z(0.4), ..at(0.0, 140.0, 3.0) }),
        node("mixamorig:Head", Some(1), Trs { rotation: Quat::from_rotation_y(0.7), ..at(0.0, 10.0, 0.0) }),
        node("jaw", Some(2), at(0.0, -5.0, 4.0)),
        node("eye.L", Some(2), Trs { rotation: Quat::from_rotation_x(0.3), ..at(3.0, 6.0, 8.0) }),
        node("Face", None, Trs::default()),
        node("LowerTeeth", Some(3), at(1.0, 2.0, 3.0)),
        node("LeftIris", Some(4), at(0.0, 0.0, 1.0)),
    ];
    let mut raw = RawScene { nodes, ..RawScene::default() };
    raw.nodes[5].weights = vec![0.0, 0.0];
    let worlds: Vec<glam::DAffine3> = (0..raw.nodes.len()).fold(Vec::new(), |mut worlds, index| {
        let local = raw.nodes[index].local.affine();
        let world = raw.nodes[index].parent.map_or(local, |parent: usize| worlds[parent] * local);
        worlds.push(world);
        worlds
    });
    let joints = vec![1, 2, 3];
    let inverse = |joint: &usize| {
        Affine3A::from_cols_array(&worlds[*joint].inverse().to_cols_array().map(|x| x as f32))
    };
    raw.skins.push(Skin { name: String::new(), inverse_binds: joints.iter().map(inverse).collect(), joints });
    let mut face = square(Vec3::new(-0.5, 0.2, 1.4));
    face.skinning = Some(Skinning {
        bones: vec![[0, 1, 0, 0], [1, 2, 0, 0], [2, 1, 0, 0], [1, 0, 0, 0]],
        weights: vec![
            [0.5, 0.5, 0.0, 0.0],
            [0.25, 0.75, 0.0, 0.0],
            [0.5, 0.5, 0.0, 0.0],
            [1.0, 0.0, 0.0, 0.0],
        ],
        ..Skinning::default()
    });
    face.shapes = vec![
        Shape::new("Key 1", vec![Vec3::X * 0.1; 4]).with_normals(vec![Vec3::X * 0.2; 4]),
        Shape::new("mouthSmile", vec![Vec3::Y * 0.1; 4]),
    ];
    raw.parts.push(ScenePart::skinned("Face", 5, face, 0));
    raw.parts.push(ScenePart::rigid("LowerTeeth", 6, square(Vec3::ZERO)));
    raw.parts.push(ScenePart::rigid("LeftIris", 7, square(Vec3::X)));
    raw
}

#[test]
fn a_head_of_another_format_takes_its_places() {
    let import = imported(head());
    let files = raw_files(&import.pack, &import.textures).expect("files");
    let (_, again) = loaded(&files);
    // Teeth and iris are parts at nodes of their own: they follow the known joints above.
    let place = |name: &str| FACE_PARTS.iter().position(|part| part.name == name).expect("a part");
    let count = |name: &str| again.parts()[place(name)].mesh.positions.len();
    assert_eq!((count("skin"), count("lower-jaw"), count("left-eyeball")), (4, 4, 4));
    let control = |name: &str, value: f32| (name.to_owned(), value);
    let mut poses = vec![vec![]];
    let follows = |name: &str| name.starts_with("LowerTeeth.") || name.starts_with("LeftIris.");
    for c in import.pack.controls().controls().iter().filter(|c| !follows(&c.name)) {
        poses.push(vec![control(&c.name, c.max / 2.0)]);
    }
    assert!(poses.len() > 12, "{}", poses.len());
    for pose in poses {
        let pose: Vec<(&str, f32)> = pose.iter().map(|(name, value)| (name.as_str(), *value)).collect();
        let (a, b) = (
            posed(&import.pack, &pose, &[0, 1, 2]),
            posed(&again, &pose, &["skin", "lower-jaw", "left-eyeball"].map(place)),
        );
        agree(&a, &b, 2.0, &format!("{pose:?}"));
    }
    let joint = |name: &str| again.rig().joint(name).is_some();
    assert!(joint("HeadJoint") && joint("JawJoint") && joint("LtEyeJoint") && joint("NeckJoint"));
    // `mouthSmile` is the face's own shape by its meaning, the other one takes what is left.
    let drives = |name: &str| {
        let control = &again.controls().controls()[again.controls().index(name).expect("a control")];
        format!("{:?}", control.drives)
    };
    assert!(drives("smile").contains("SSmile") && drives("Key 1").contains("Frown"));
    assert!(
        files.notes.iter().any(|note| note == "joint \"mixamorig:Head\" is called \"HeadJoint\""),
        "{:?}",
        files.notes
    );
}

#[test]
fn parts_that_follow_known_joints_become_the_rigid_ones() {
    let mut raw = head();
    // The same as parts of a skin, as exporters that know one skin write them.
    for (part, bone) in [(1, 2u16), (2, 3)] {
        let node = if part == 1 { 3 } else { 4 };
        raw.skins[0].joints = vec![1, 2, 3, 4];
        let mesh = &mut raw.parts[part].mesh;
        mesh.skinning = Some(Skinning {
            bones: vec![[bone, 0, 0, 0]; 4],
            weights: vec![[1.0, 0.0, 0.0, 0.0]; 4],
            ..Skinning::default()
        });
        raw.parts[part].skin = Some(0);
        assert_eq!(raw.skins[0].joints[usize::from(bone)], node);
    }
    let eye = raw.nodes[..5].iter().fold(glam::DAffine3::IDENTITY, |world, node| match node.name.as_str() {
        "jaw" => world,
        _ => world * node.local.affine(),
    });
    raw.skins[0]
        .inverse_binds
        .push(Affine3A::from_cols_array(&eye.inverse().to_cols_array().map(|x| x as f32)));
    let import = imported(raw);
    let files = raw_files(&import.pack, &import.textures).expect("files");
    let (_, again) = loaded(&files);
    let place = |name: &str| FACE_PARTS.iter().position(|part| part.name == name).expect("a part");
    let count = |name: &str| again.parts()[place(name)].mesh.positions.len();
    assert_eq!(
        (count("skin"), count("lower-jaw"), count("left-eyeball"), count("right-eyeball")),
        (4, 4, 4, 1)
    );
    for pose in [vec![], vec![("jaw.open", 20.0), ("head.turn", 30.0)], vec![("eye.left.lr", -20.0)]] {
        let (a, b) = (
            posed(&import.pack, &pose, &[0, 1, 2]),
            posed(&again, &pose, &[place("skin"), place("lower-jaw"), place("left-eyeball")]),
        );
        agree(&a, &b, 2.0, &format!("{pose:?}"));
    }
}

/// Two have places in the vertices of the skin, more do not.
#[test]
fn any_number_of_shapes_is_written_beside_the_vertices() {
    let mut raw = head();
    raw.parts[0].mesh.shapes.push(Shape::new("jawOpen", vec![Vec3::Y; 4]));
    raw.nodes[5].weights.push(0.0);
    let import = imported(raw);
    let files = raw_files(&import.pack, &import.textures).expect("files");
    let (source, again) = loaded(&files);
    let list = again.further_shapes().expect("further shapes");
    let names: Vec<_> =
        list.shapes.iter().map(|shape| (shape.name.as_str(), shape.parts.join(", "))).collect();
    assert_eq!(names, [("Key 1", "skin".to_owned()), ("jawOpen", "skin".to_owned())]);
    assert_eq!(again.shapes(), ["SSmile", "Frown", "Key 1", "jawOpen"]);
    for name in ["Key 1", "smile", "jawOpen"] {
        let control = |pack: &Pack| {
            let controls = pack.controls();
            controls.controls()[controls.index(name).expect("a control")].clone()
        };
        let (a, b) = (control(&import.pack), control(&again));
        assert_eq!((a.min, a.max, a.default, a.pace), (b.min, b.max, b.default, b.pace), "{name}");
    }
    for pose in poses(&again) {
        let (a, b) = (posed(&import.pack, &pose, &[0]), posed(&again, &pose, &[0]));
        agree(&a, &b, 2.0, &format!("{pose:?}"));
    }
    let written = raw_files(&again, &Textures::default()).expect("files");
    for file in ["shapes.toml", "shapes.raw"] {
        assert!(written.files.contains(&(file.to_owned(), source.files[file].clone())), "{file}");
    }
}

#[test]
fn what_does_not_fit_is_named() {
    let refused = |raw: RawScene| {
        let import = imported(raw);
        raw_files(&import.pack, &import.textures).expect_err("too much")
    };
    let mut raw = RawScene::default();
    for number in 0..10 {
        raw.nodes.push(node(&format!("n{number}"), None, Trs::default()));
        raw.parts.push(ScenePart::rigid("", number, square(Vec3::ZERO)));
    }
    assert!(matches!(refused(raw.clone()), RawError::TooManyJoints { found } if found.len() == 10));
    raw.parts.pop();
    let import = imported(raw);
    assert!(raw_files(&import.pack, &import.textures).is_ok(), "nine fit");

    let mut raw = head();
    raw.nodes[0].local = Transform::Trs(Trs { scale: Vec3::new(0.01, 0.02, 0.01), ..Trs::default() });
    assert!(matches!(refused(raw), RawError::Uneven { .. }));

    let mut raw = RawScene::default();
    raw.nodes.push(node("bone", None, Trs::default()));
    assert_eq!(refused(raw), RawError::NoMesh);
}

#[test]
fn of_more_than_four_bones_a_raw_file_gets_the_largest_with_a_note() {
    let mut raw = head();
    let skinning = raw.parts[0].mesh.skinning.as_mut().expect("a skinned face");
    skinning.weights[1] = [0.125, 0.125, 0.125, 0.125];
    skinning.bones[1] = [0, 1, 2, 0];
    skinning.more_bones = vec![[0; 4], [1, 2, 0, 0], [0; 4], [0; 4]];
    skinning.more_weights = vec![[0.0; 4], [0.375, 0.125, 0.0, 0.0], [0.0; 4], [0.0; 4]];
    let import = imported(raw);
    let files = raw_files(&import.pack, &import.textures).expect("files");
    let note = "part \"Face\": 1 vertices have more than four bones: the four largest are kept";
    assert!(files.notes.iter().any(|found| found == note), "{:?}", files.notes);
    let (_, again) = loaded(&files);
    let written = again.parts()[0].mesh.skinning.as_ref().expect("a skin");
    // ⅜ and three of the four eighths, of ¾.
    let expected = [0.5, 1.0 / 6.0, 1.0 / 6.0, 1.0 / 6.0];
    let near = written.weights[1].iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-6);
    assert!(near && written.more_bones.is_empty(), "{written:?}");
}

/// Joints that scale unevenly are refused; what is mirrored or stretched at binding comes through.
#[test]
fn what_is_mirrored_or_stretched_at_binding_has_its_front_and_normals_outside() {
    for scale in [Vec3::new(-2.0, 1.0, 1.0), Vec3::new(1.0, 3.0, 1.0), Vec3::new(-1.0, -1.0, -0.5)] {
        let mut raw = head();
        let jaw = [0, 1, 2, 3]
            .into_iter()
            .fold(glam::DAffine3::IDENTITY, |world, node: usize| world * raw.nodes[node].local.affine());
        let stretched = jaw.inverse() * glam::DAffine3::from_scale(scale.as_dvec3());
        let inverse = Affine3A::from_cols_array(&stretched.to_cols_array().map(|x| x as f32));
        raw.skins.push(Skin { name: String::new(), joints: vec![3], inverse_binds: vec![inverse] });
        raw.parts[1].skin = Some(1);
        // A slope, whose normal another scale tilts.
        let mesh = &mut raw.parts[1].mesh;
        mesh.positions.iter_mut().for_each(|p| p.z += 0.5 * p.x + 0.25 * p.y);
        mesh.normals = vec![Vec3::new(-0.5, -0.25, 1.0).normalize_or_zero(); 4];
        mesh.skinning = Some(Skinning {
            bones: vec![[0; 4]; 4],
            weights: vec![[1.0, 0.0, 0.0, 0.0]; 4],
            ..Skinning::default()
        });
        let import = imported(raw);
        let files = raw_files(&import.pack, &import.textures).expect("files");
        let (_, again) = loaded(&files);
        let jaw = again.parts().iter().find(|part| part.name == "lower-jaw").expect("a part");
        assert_eq!(jaw.mesh.triangles.len(), 2);
        for corners in &jaw.mesh.triangles {
            let [a, b, c] = corners.map(|corner| jaw.mesh.positions[corner as usize]);
            let front = (b - a).cross(c - a).normalize_or_zero();
            for normal in corners.map(|corner| jaw.mesh.normals[corner as usize]) {
                assert!(front.distance(normal) < 1e-4, "{scale}: {front} {normal}");
            }
        }
    }
}
