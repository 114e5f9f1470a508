//! FBX: values computed by hand, other people's files, damaged files.

use crate::support::damage::{bounds, damage, files, read_any, triangles};
use crate::support::data::models;
use avatar_exchange::{ImportError, Scene, Transform, fbx};
use avatar_mesh::drivers::ShapeDrivers;
use glam::{Quat, Vec2, Vec3};
use std::f32::consts::FRAC_PI_2;

fn read(file: &str, bytes: &[u8]) -> Result<Scene, ImportError> {
    fbx::read(file, bytes, &mut |_| Err("there are no other files".to_owned()))
}

/// A square of 1 m in the x-y plane, in centimetres; a node that is turned before its own rotation; two bones of which
/// the second stands at the square's upper left corner; a channel with an in-between.
const FACE: &str = r#"; FBX 7.4.0 project file
FBXHeaderExtension:  {
	FBXHeaderVersion: 1003
	FBXVersion: 7400
}
GlobalSettings:  {
	Version: 1000
	Properties70:  {
		P: "UpAxis", "int", "Integer", "",1
		P: "UpAxisSign", "int", "Integer", "",1
		P: "FrontAxis", "int", "Integer", "",2
		P: "FrontAxisSign", "int", "Integer", "",1
		P: "CoordAxis", "int", "Integer", "",0
		P: "CoordAxisSign", "int", "Integer", "",1
		P: "UnitScaleFactor", "double", "Number", "",1
	}
}
Objects:  {
	Geometry: 10, "Geometry::square", "Mesh" {
		Vertices: *12 { a: 0,0,0,100,0,0,100,100,0,0,100,0 }
		PolygonVertexIndex: *4 { a: 0,1,2,-4 }
		GeometryVersion: 124
		LayerElementUV: 0 {
			Version: 101
			Name: "map"
			MappingInformationType: "ByPolygonVertex"
			ReferenceInformationType: "Direct"
			UV: *8 { a: 0,0,1,0,1,0.75,0,0.75 }
		}
		Layer: 0 {
			Version: 100
			LayerElement:  {
				Type: "LayerElementUV"
				TypedIndex: 0
			}
		}
	}
	Geometry: 20, "Geometry::half", "Shape" {
		Version: 100
		Indexes: *1 { a: 2 }
		Vertices: *3 { a: 0,0,10 }
	}
	Geometry: 21, "Geometry::full", "Shape" {
		Version: 100
		Indexes: *1 { a: 2 }
		Vertices: *3 { a: 0,0,40 }
	}
	Model: 11, "Model::face", "Mesh" {
		Version: 232
	}
	Model: 12, "Model::turned", "Null" {
		Version: 232
		Properties70:  {
			P: "RotationActive", "bool", "", "",1
			P: "PreRotation", "Vector3D", "Vector", "",0,0,90
			P: "Lcl Translation", "Lcl Translation", "", "A",100,0,0
		}
	}
	Model: 13, "Model::tip", "Null" {
		Version: 232
		Properties70:  {
			P: "Lcl Translation", "Lcl Translation", "", "A",100,0,0
		}
	}
	Model: 14, "Model::hip", "LimbNode" {
		Version: 232
	}
	Model: 15, "Model::knee", "LimbNode" {
		Version: 232
		Properties70:  {
			P: "Lcl Translation", "Lcl Translation", "", "A",0,100,0
		}
	}
	Deformer: 30, "Deformer::blend", "BlendShape" {
		Version: 100
	}
	Deformer: 31, "SubDeformer::smile", "BlendShapeChannel" {
		Version: 100
		DeformPercent: 75
		FullWeights: *2 { a: 50,100 }
	}
	Deformer: 40, "Deformer::skin", "Skin" {
		Version: 101
		Link_DeformAcuracy: 50
	}
	Deformer: 41, "SubDeformer::hip", "Cluster" {
		Version: 100
		Indexes: *2 { a: 0,1 }
		Weights: *2 { a: 1,1 }
		Transform: *16 { a: 1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1 }
		TransformLink: *16 { a: 1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1 }
	}
	Deformer: 42, "SubDeformer::knee", "Cluster" {
		Version: 100
		Indexes: *1 { a: 2 }
		Weights: *1 { a: 0.5 }
		Transform: *16 { a: 1,0,0,0,0,1,0,0,0,0,1,0,0,-100,0,1 }
		TransformLink: *16 { a: 1,0,0,0,0,1,0,0,0,0,1,0,0,100,0,1 }
	}
	AnimationStack: 50, "AnimStack::nod", "" {
		Properties70:  {
			P: "LocalStop", "KTime", "Time", "",46186158000
		}
	}
	AnimationLayer: 51, "AnimLayer::base", "" {
	}
	AnimationCurveNode: 52, "AnimCurveNode::DeformPercent", "" {
		Properties70:  {
			P: "d|DeformPercent", "Number", "", "A",0
		}
	}
	AnimationCurve: 53, "AnimCurve::", "" {
		Default: 0
		KeyVer: 4008
		KeyTime: *2 { a: 0,46186158000 }
		KeyValueFloat: *2 { a: 0,100 }
		KeyAttrFlags: *1 { a: 4 }
		KeyAttrDataFloat: *4 { a: 0,0,0,0 }
		KeyAttrRefCount: *1 { a: 2 }
	}
	AnimationCurveNode: 54, "AnimCurveNode::T", "" {
		Properties70:  {
			P: "d|X", "Number", "", "A",0
			P: "d|Y", "Number", "", "A",100
			P: "d|Z", "Number", "", "A",0
		}
	}
	AnimationCurve: 55, "AnimCurve::", "" {
		Default: 0
		KeyVer: 4008
		KeyTime: *2 { a: 0,46186158000 }
		KeyValueFloat: *2 { a: 0,50 }
		KeyAttrFlags: *1 { a: 4 }
		KeyAttrDataFloat: *4 { a: 0,0,0,0 }
		KeyAttrRefCount: *1 { a: 2 }
	}
	Material: 60, "Material::red", "" {
		Version: 102
		ShadingModel: "lambert"
		Properties70:  {
			P: "DiffuseColor", "Color", "", "A",0.5,0.25,0.125
			P: "DiffuseFactor", "Number", "", "A",1
		}
	}
}
Connections:  {
	C: "OO",11,0
	C: "OO",12,0
	C: "OO",13,12
	C: "OO",14,0
	C: "OO",15,14
	C: "OO",10,11
	C: "OO",60,11
	C: "OO",30,10
	C: "OO",31,30
	C: "OO",20,31
	C: "OO",21,31
	C: "OO",40,10
	C: "OO",41,40
	C: "OO",42,40
	C: "OO",14,41
	C: "OO",15,42
	C: "OO",51,50
	C: "OO",52,51
	C: "OP",52,31, "DeformPercent"
	C: "OP",53,52, "d|DeformPercent"
	C: "OO",54,51
	C: "OP",54,15, "Lcl Translation"
	C: "OP",55,54, "d|X"
}
"#;

fn face() -> Scene {
    read("face.fbx", FACE.as_bytes()).unwrap()
}

fn node(scene: &Scene, name: &str) -> usize {
    scene.nodes.iter().position(|node| node.name == name).unwrap()
}

fn close(a: &[f32], b: &[f32]) {
    let near = a.len() == b.len() && a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-5);
    assert!(near, "{a:?} is not {b:?}");
}

#[test]
fn nodes_are_in_metres_and_turned_before_they_turn() {
    let scene = face();
    let worlds = scene.worlds(&scene.rest());
    close(&worlds[node(&scene, "turned")].translation.as_vec3().to_array(), &[1.0, 0.0, 0.0]);
    // 1 m along the turned x axis, which is y.
    close(&worlds[node(&scene, "tip")].translation.as_vec3().to_array(), &[1.0, 1.0, 0.0]);
    assert!(
        scene.notes.iter().any(|note| note.finding.to_string().contains("0.01 m were converted")),
        "{:?}",
        scene.notes
    );
}

#[test]
fn a_square_becomes_two_triangles_with_flipped_uvs_and_normals() {
    let scene = face();
    let [part] = &scene.parts[..] else { panic!("{} parts", scene.parts.len()) };
    assert_eq!((part.mesh.positions.len(), part.mesh.triangles.len()), (4, 2));
    let at = |position: Vec3| part.mesh.positions.iter().position(|p| p.distance(position) < 1e-6).unwrap();
    assert_eq!(part.mesh.uvs[at(Vec3::ZERO)], Vec2::new(0.0, 1.0));
    assert_eq!(part.mesh.uvs[at(Vec3::new(1.0, 1.0, 0.0))], Vec2::new(1.0, 0.25));
    assert!(part.mesh.normals.iter().all(|normal| normal.distance(Vec3::Z) < 1e-6));
    close(&scene.materials[part.material.unwrap()].base_color, &[0.5, 0.25, 0.125, 1.0]);
}

#[test]
fn joints_move_points_and_points_without_weights_follow_the_mesh() {
    let scene = face();
    let mut pose = scene.rest();
    pose.weights[scene.parts[0].node].fill(0.0);
    let corner = |pose: &avatar_exchange::ScenePose, rest: Vec3| {
        let bones = scene.bones(pose);
        let mesh = &scene.parts[0].mesh;
        let mut out = mesh.deformed();
        avatar_mesh::deform(mesh, scene.bones_of(0, &bones), scene.weights_of(0, pose), &mut out).unwrap();
        out.positions[mesh.positions.iter().position(|p| p.distance(rest) < 1e-6).unwrap()].to_array()
    };
    let (right, left) = (Vec3::new(1.0, 1.0, 0.0), Vec3::new(0.0, 1.0, 0.0));
    close(&corner(&pose, right), &right.to_array());
    let knee = node(&scene, "knee");
    let Transform::Trs(trs) = &mut pose.locals[knee] else { panic!("a matrix") };
    trs.rotation = Quat::from_rotation_z(FRAC_PI_2);
    // 1 m to the right of the knee becomes 1 m above it. Its weight of 0.5, alone, was made 1.
    close(&corner(&pose, right), &[0.0, 2.0, 0.0]);
    close(&corner(&pose, left), &left.to_array());
    assert!(
        scene.notes.iter().any(|note| note.finding.to_string().contains("1 points without weights")),
        "{:?}",
        scene.notes
    );
}

#[test]
fn in_betweens_are_shapes_with_rules() {
    let scene = face();
    let part = &scene.parts[0];
    let names: Vec<&str> = part.mesh.shapes.iter().map(|shape| shape.name.as_str()).collect();
    assert_eq!(names, ["smile@50", "smile"]);
    // 75 %: halfway from the one to the other.
    close(&scene.nodes[part.node].weights, &[0.5, 0.5]);
    let lift =
        |shape: usize| part.mesh.shapes[shape].positions.iter().map(|(_, offset)| offset.z).sum::<f32>();
    close(&[lift(0), lift(1)], &[0.1, 0.4]);
    let [rules] = &scene.drivers[..] else { panic!("{:?}", scene.drivers) };
    let program = ShapeDrivers::new(&rules.drivers, &rules.shapes, &rules.rules).unwrap();
    let mut weights = [0.0; 2];
    program.run(&[0.25], &mut weights).unwrap();
    assert_eq!((rules.drivers[0].as_str(), weights), ("smile", [0.5, 0.0]));
}

#[test]
fn takes_move_nodes_and_shapes() {
    let scene = face();
    let [clip] = &scene.clips[..] else { panic!("{} clips", scene.clips.len()) };
    assert_eq!((clip.name.as_str(), clip.duration_secs()), ("nod", 1.0));
    let (face, knee) = (scene.parts[0].node, node(&scene, "knee"));
    for (time, weights) in
        [(0.0, [0.0, 0.0]), (0.25, [0.5, 0.0]), (0.5, [1.0, 0.0]), (0.75, [0.5, 0.5]), (1.0, [0.0, 1.0])]
    {
        let pose = scene.at(0, time).unwrap();
        close(&pose.weights[face], &weights);
        let Transform::Trs(trs) = pose.locals[knee] else { panic!("a matrix") };
        close(&trs.translation.to_array(), &[(0.5 * time) as f32, 1.0, 0.0]);
    }
}

/// Numbers of the Open Asset Import Library 5.2.5, from its export to glTF, times 0.01 where it keeps centimetres. Boxes of
/// skinned meshes are those before skinning: its weights do not sum to 1.
#[test]
fn other_peoples_files_have_the_sizes_that_another_reader_finds() {
    let Some(folder) = models("FBX") else { return };
    let open = |name: &str| read(name, &std::fs::read(folder.join(name)).unwrap()).unwrap();
    let near = |found: f32, expected: f32| {
        assert!((found - expected).abs() < 2e-5 * (1.0 + expected.abs()), "{found} is not {expected}");
    };
    let mirrored = open("cubes_with_mirroring_and_pivot.fbx");
    assert_eq!(triangles(&mirrored), 420);
    let box_ = [-0.06067, -0.14515, -0.06044, 0.14866, 0.15981, 0.26727];
    bounds(&mirrored).iter().flatten().zip(box_).for_each(|(found, expected)| near(*found, expected));
    let spider = open("spider.fbx");
    assert_eq!((triangles(&spider), spider.nodes.len()), (1368, 22));
    let box_ = [-92.655_235, -42.233_826, -106.691_2, 57.936_22, 37.503_952, 86.691_2];
    bounds(&spider).iter().flatten().zip(box_).for_each(|(found, expected)| near(*found, expected));

    let bones = open("huesitos.fbx");
    let worlds = bones.worlds(&bones.rest());
    for (name, expected) in [
        ("Bone", [-0.04024, 0.0, -3.07135]),
        ("Bone.002", [-0.04024, 2.11188, -3.07135]),
        ("Bone.004", [0.88255, 2.11188, -3.41173]),
        ("Bone.006", [3.14413, 2.11188, -4.50092]),
        ("Bone.008", [-0.04024, 4.62308, -3.07135]),
    ] {
        let world = worlds[node(&bones, name)].translation.as_vec3().to_array();
        world.into_iter().zip(expected).for_each(|(found, expected)| near(found, expected));
    }
    let mesh = bones.parts[0].mesh.bounds().unwrap();
    let box_ = [-1.023_423_4, -1.023_423_4, -1.256_192_7, 4.334_299, 2.191_927_7, 4.182_18].map(|x| x * 0.01);
    mesh.min
        .to_array()
        .into_iter()
        .chain(mesh.max.to_array())
        .zip(box_)
        .for_each(|(found, expected)| near(found, expected));
    assert_eq!((triangles(&bones), bones.skins[0].joints.len(), bones.clips.len()), (120, 9, 1));

    let tube = open("animation_with_skeleton.fbx");
    assert_eq!((triangles(&tube), tube.skins[0].joints.len(), tube.nodes.len()), (2112, 14, 21));
    assert_eq!(tube.clips[0].name, "Armature|ArmatureAction");
}

/// The bones of these files stand as they were bound, so that at rest all of them move the mesh alike.
#[test]
fn at_rest_bones_agree() {
    let Some(folder) = models("FBX") else { return };
    let scene = read("huesitos.fbx", &std::fs::read(folder.join("huesitos.fbx")).unwrap()).unwrap();
    let bones = scene.bones(&scene.rest());
    for bone in &bones {
        let difference = bone
            .to_cols_array()
            .iter()
            .zip(bones[0].to_cols_array())
            .map(|(a, b)| (a - b).abs())
            .fold(0.0, f32::max);
        // Matrices hold a scale of 100.
        assert!(difference < 1e-3, "{bone} is not {}", bones[0]);
    }
}

#[test]
fn embedded_pictures_come_with_their_bytes() {
    let Some(folder) = models("FBX") else { return };
    // How the bytes of a Targa picture (colours, packed by run lengths) and of a PNG begin.
    for (name, picture, begin) in [
        ("box_orphant_embedded_texture.fbx", "GridGrey.tga", &[0, 10][..]),
        ("embedded_ascii/box_embedded_texture_fragmented.fbx", "paper.png", b"PN"),
    ] {
        let scene = read(name, &std::fs::read(folder.join(name)).unwrap()).unwrap();
        let image = &scene.images[scene.materials[0].base_color_texture.unwrap()];
        assert_eq!((image.name.as_str(), image.bytes.get(1..3)), (picture, Some(begin)), "{name}");
    }
    // The other way: a file that is brought.
    let bytes = std::fs::read(folder.join("spider.fbx")).unwrap();
    let scene = fbx::read("spider.fbx", &bytes, &mut |path| Ok(path.as_bytes().to_vec())).unwrap();
    let brought = scene.images.iter().find(|image| image.name == "SpiderTex.jpg").unwrap();
    assert_eq!((brought.bytes.as_slice(), brought.mime.as_str()), (&b"SpiderTex.jpg"[..], "image/jpeg"));
}

#[test]
fn other_peoples_files_load_or_are_refused() {
    let Some(folder) = models("FBX") else { return };
    let mut refused = Vec::new();
    let found = files(&folder, &["fbx"]);
    assert!(found.len() >= 19, "{found:?}");
    for path in found {
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        if let Err(error) = read_any(read, &name, &std::fs::read(&path).unwrap()) {
            refused.push(error.to_string());
        }
    }
    // A binary file whose zeros became blanks.
    assert_eq!(
        refused,
        ["transparentTest.fbx: near byte 0: expected an FBX file, found Not an FBX file (Unknown)"]
    );
}

#[test]
fn damaged_files_are_refused_or_load() {
    let bytes = FACE.as_bytes();
    let all = bytes.len() / 64 + 1 + 200;
    let loaded = damage(read, "damaged.fbx", bytes, 200);
    // Some flips hit numbers.
    assert!(loaded > 0 && loaded < all, "{loaded} of {all}");
    let Some(folder) = models("FBX") else { return };
    for name in ["phong_cube.fbx", "boxWithCompressedCTypeArray.FBX"] {
        damage(read, name, &std::fs::read(folder.join(name)).unwrap(), 100);
    }
}

#[test]
fn what_is_no_fbx_is_refused_with_its_place() {
    let obj = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    for bytes in [&b""[..], &b"glTF"[..], &obj[..], &[0; 4096]] {
        let error = read_any(read, "no.fbx", bytes).unwrap_err();
        assert_eq!((error.file.as_str(), error.expected.as_str()), ("no.fbx", "an FBX file"));
    }
}
