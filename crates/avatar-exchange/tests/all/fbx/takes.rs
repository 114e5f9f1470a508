//! Takes: the file's own frames, scale that is not inherited, shapes of old files, cycles.

use super::{FACE, close, node, read};
use crate::support::data::shared_case;
use avatar_exchange::Scene;
use avatar_mesh::deform;
use glam::Vec3;

/// Ticks of a second in FBX.
const SECOND: i64 = 46_186_158_000;

/// Hip, knee and toe along x, 1 m apart, in centimetres and at 24 frames a second. The knee does not inherit
/// the hip's scale. One curve of two keys moves a property of the hip, from 1 s to `end`, in a take from 1 s.
fn leg(property: &str, axes: &[&str], values: [f64; 2], end: f64, flags: u32, more: &str) -> Scene {
    leg_in_take(property, axes, values, [1.0, end], flags, more, [1.0, 6.0])
}

/// The same with a curve that begins and ends at other times than the take.
fn leg_in_take(
    property: &str,
    axes: &[&str],
    [from, to]: [f64; 2],
    keys: [f64; 2],
    flags: u32,
    more: &str,
    take: [f64; 2],
) -> Scene {
    let ticks = |seconds: f64| (seconds * SECOND as f64) as i64;
    let [begin, end] = keys.map(ticks);
    let node = |number: u32, name: &str, more: &str| {
        format!(
            "Model: {number}, \"Model::{name}\", \"LimbNode\" {{ Version: 232\nProperties70: {{ {more} }} }}\n"
        )
    };
    let at = "P: \"Lcl Translation\", \"Lcl Translation\", \"\", \"A\",100,0,0";
    let apart = format!("{at}\nP: \"InheritType\", \"enum\", \"\", \"\",2");
    let curves: String = (axes.iter().enumerate())
        .map(|(k, _)| {
            format!(
                "AnimationCurve: {}, \"AnimCurve::\", \"\" {{ Default: 0\nKeyVer: 4008\n\
                 KeyTime: *2 {{ a: {begin},{end} }}\nKeyValueFloat: *2 {{ a: {from},{to} }}\n\
                 KeyAttrFlags: *1 {{ a: {flags} }}\nKeyAttrDataFloat: *4 {{ a: 0,0,0,0 }}\n\
                 KeyAttrRefCount: *1 {{ a: 2 }}\n{more}\n}}\n",
                60 + k
            )
        })
        .collect();
    let links: String = (axes.iter().enumerate())
        .map(|(k, axis)| format!("C: \"OP\",{},52, \"d|{axis}\"\n", 60 + k))
        .collect();
    let text = format!(
        "; FBX 7.4.0 project file\nFBXHeaderExtension: {{ FBXHeaderVersion: 1003\nFBXVersion: 7400 }}\n\
         GlobalSettings: {{ Version: 1000\nProperties70: {{\nP: \"UnitScaleFactor\", \"double\", \"Number\", \"\",1\n\
         P: \"TimeMode\", \"enum\", \"\", \"\",11\n}} }}\nObjects: {{\n{}{}{}\
         AnimationStack: 50, \"AnimStack::move\", \"\" {{ Properties70: {{\n\
         P: \"LocalStart\", \"KTime\", \"Time\", \"\",{}\nP: \"LocalStop\", \"KTime\", \"Time\", \"\",{} }} }}\n\
         AnimationLayer: 51, \"AnimLayer::base\", \"\" {{\n}}\n\
         AnimationCurveNode: 52, \"AnimCurveNode::x\", \"\" {{ Properties70: {{\nP: \"d|X\", \"Number\", \"\", \"A\",1\n\
         P: \"d|Y\", \"Number\", \"\", \"A\",1\nP: \"d|Z\", \"Number\", \"\", \"A\",1 }} }}\n{curves}}}\n\
         Connections: {{\nC: \"OO\",1,0\nC: \"OO\",2,1\nC: \"OO\",3,2\nC: \"OO\",51,50\nC: \"OO\",52,51\n\
         C: \"OP\",52,1, \"{property}\"\n{links}}}\n",
        node(1, "hip", ""),
        node(2, "knee", &apart),
        node(3, "toe", at),
        ticks(take[0]),
        ticks(take[1]),
    );
    read("leg.fbx", text.as_bytes()).unwrap()
}

fn x_of(scene: &Scene, name: &str, time_secs: f64) -> f32 {
    scene.worlds(&scene.at(0, time_secs).unwrap())[node(scene, name)].translation.x as f32
}

/// A cubic of the Hermite kind without slopes, over 96 frames: 3u² − 2u³.
#[test]
fn the_files_own_frames_are_met() {
    const CUBIC_WITH_TANGENTS: u32 = 0x408;
    let scene = leg("Lcl Translation", &["X"], [0.0, 100.0], 5.0, CUBIC_WITH_TANGENTS, "");
    for frame in 0..=96 {
        let u = frame as f32 / 96.0;
        let found = x_of(&scene, "hip", f64::from(frame) / 24.0);
        let expected = 3.0 * u * u - 2.0 * u * u * u;
        assert!((found - expected).abs() < 1e-6, "frame {frame}: {found} is not {expected}");
    }
    assert_eq!(scene.clips[0].channels.len(), 1, "what has no curve is not the take's");
}

/// The hip's scale moves the knee and does not scale it: Maya's segment scale compensation.
#[test]
fn scale_that_is_not_inherited_moves_children() {
    const LINEAR: u32 = 4;
    let scene = leg("Lcl Scaling", &["X", "Y", "Z"], [1.0, 3.0], 5.0, LINEAR, "");
    for (time, scale) in [(0.0, 1.0), (1.0, 1.5), (2.0, 2.0), (4.0, 3.0)] {
        close(&[x_of(&scene, "knee", time), x_of(&scene, "toe", time)], &[scale, scale + 1.0]);
    }
}

#[test]
fn a_key_equal_to_rest_is_a_key() {
    let scene = leg("Lcl Translation", &["X", "Y", "Z"], [0.0, 0.0], 5.0, 4, "");
    let [channel] = &scene.clips[0].channels[..] else { panic!("{:?}", scene.clips) };
    // As long as the take.
    assert_eq!((channel.node, channel.values.as_slice()), (node(&scene, "hip"), &[0.0; 6][..]));
    assert_eq!(channel.times, [0.0, 5.0]);
}

/// From 1 s to 2 s of the file, so that the take's other four seconds are repetitions.
#[test]
fn curves_go_on_beyond_their_keys() {
    let with = |way: &str| {
        leg(
            "Lcl Translation",
            &["X"],
            [0.0, 100.0],
            2.0,
            4,
            &format!("Post-Extrapolation: {{ Type: {way} }}"),
        )
    };
    for (way, values) in [
        ("C", [0.25, 1.0, 1.0, 1.0, 1.0]),
        ("R", [0.25, 0.25, 0.75, 0.5, 0.25]),
        ("M", [0.25, 0.75, 0.25, 0.5, 0.25]),
        ("A", [0.25, 1.25, 1.75, 2.5, 4.25]),
        ("K", [0.25, 1.25, 1.75, 2.5, 4.25]),
    ] {
        let scene = with(way);
        for (time, value) in [0.25, 1.25, 1.75, 2.5, 4.25].into_iter().zip(values) {
            let found = x_of(&scene, "hip", time);
            assert!((found - value).abs() < 1e-5, "{way} at {time}: {found} is not {value}");
        }
        let told =
            scene.notes.iter().any(|note| note.to_string().contains("1 curves go on beyond their keys"));
        assert_eq!(told, way != "C", "{way}: {:?}", scene.notes);
    }
}

/// From 3 s to 4 s of the file, in a take from 1 s: what comes before the keys.
#[test]
fn curves_come_from_before_their_keys() {
    let times = [0.25, 0.75, 1.25, 2.25];
    for (way, values) in [
        ("C", [0.0, 0.0, 0.0, 0.25]),
        ("R", [0.25, 0.75, 0.25, 0.25]),
        ("M", [0.25, 0.75, 0.75, 0.25]),
        ("A", [-1.75, -1.25, -0.75, 0.25]),
        ("K", [-1.75, -1.25, -0.75, 0.25]),
    ] {
        let more = format!("Pre-Extrapolation: {{ Type: {way} }}");
        let scene = leg_in_take("Lcl Translation", &["X"], [0.0, 100.0], [3.0, 4.0], 4, &more, [1.0, 6.0]);
        for (time, value) in times.into_iter().zip(values) {
            let found = x_of(&scene, "hip", time);
            assert!((found - value).abs() < 1e-5, "{way} at {time}: {found} is not {value}");
        }
    }
}

#[test]
fn a_take_lasts_as_long_as_it_says() {
    let line = |keys, take| leg_in_take("Lcl Translation", &["X"], [0.0, 100.0], keys, 4, "", take);
    // Its curve ends earlier, and holds.
    let scene = line([1.0, 2.0], [1.0, 6.0]);
    assert_eq!(scene.clips[0].duration_secs(), 5.0);
    assert!((x_of(&scene, "hip", 4.0) - 1.0).abs() < 1e-6);
    // Its curve begins earlier and ends later: the line goes on to the limits.
    let scene = line([0.0, 10.0], [1.0, 6.0]);
    assert_eq!(scene.clips[0].duration_secs(), 5.0);
    for (time, x) in [(0.0, 0.1), (2.5, 0.35), (5.0, 0.6), (9.0, 0.6)] {
        assert!((x_of(&scene, "hip", time) - x).abs() < 1e-6, "{time}");
    }
    let is_told = |scene: &Scene| scene.notes.iter().any(|note| note.to_string().contains("behind its end"));
    assert!(is_told(&scene) && !is_told(&line([1.0, 2.0], [1.0, 6.0])));
    // A step at the very beginning, and one at the very end: what is on their other sides is not in the take.
    let step = |keys| leg_in_take("Lcl Translation", &["X"], [0.0, 100.0], keys, 2, "", [1.0, 6.0]);
    assert!((x_of(&step([0.0, 1.0]), "hip", 0.0) - 1.0).abs() < 1e-6);
    let scene = step([1.0, 6.0]);
    assert_eq!([4.999, 5.0].map(|time| x_of(&scene, "hip", time).round()), [0.0, 1.0]);
}

#[test]
fn frames_that_are_too_many_are_thinned_with_a_note() {
    let turn = |end| leg_in_take("Lcl Rotation", &["Z"], [0.0, 90.0], [1.0, end], 8, "", [1.0, end]);
    let is_told =
        |scene: &Scene| scene.notes.iter().any(|note| note.to_string().contains("only every second"));
    let (short, long) = (turn(601.0), turn(1001.0));
    assert!(!is_told(&short) && is_told(&long));
    let keys = |scene: &Scene| scene.clips[0].channels[0].times.len();
    // 24 frames a second; of those that are thinned, both ends stay.
    assert_eq!((keys(&short), keys(&long)), (600 * 24 + 1, 1000 * 12 + 2));
}

/// Until version 7.1 a curve moves a property of the mesh that is called like the shape.
#[test]
fn shapes_of_old_files_are_moved() {
    const OLD: &str = "; FBX 6.1.0 project file
FBXHeaderExtension:  { FBXHeaderVersion: 1003
FBXVersion: 6100 }
Objects:  {
	Model: \"Model::face\", \"Mesh\" {
		Version: 232
		Properties60:  {
			Property: \"top\", \"Number\", \"A+\",0
		}
		Vertices: 0,0,0,100,0,0,100,100,0,0,100,0
		PolygonVertexIndex: 0,1,2,-4
		GeometryVersion: 124
		Shape: \"top\" {
			Indexes: 2
			Vertices: 0,0,40
			Normals: 0,0,0
		}
	}
}
Connections:  { Connect: \"OO\", \"Model::face\", \"Model::Scene\" }
Takes:  {
	Current: \"Take 001\"
	Take: \"Take 001\" {
		LocalTime: 0,46186158000
		ReferenceTime: 0,46186158000
		Model: \"Model::face\" {
			Version: 1.1
			Channel: \"top\" {
				Default: 0
				KeyVer: 4005
				KeyCount: 2
				Key: 0,0,L,46186158000,100,L
			}
		}
	}
}
";
    // Before version 6, models stand at the top and hang from each other by names.
    let (top, takes) = (OLD.find("Model: ").unwrap(), OLD.find("Takes:").unwrap());
    let model = &OLD[top..OLD[..takes].rfind("}\nConnections").unwrap()];
    for (version, number) in [("5.0.0", "5000"), ("5.8.0", "5800"), ("6.0.0", "6000"), ("6.1.0", "6100")] {
        let text = if version < "6" {
            let (properties, vertices) =
                (model.find("Properties60").unwrap(), model.find("Vertices").unwrap());
            format!(
                "; FBX {version} project file\nFBXHeaderExtension: {{ FBXHeaderVersion: 1003\nFBXVersion: {number} }}\n\
                 {}MaterialAssignation: \"AllSame\"\n\t\t{}{}",
                model[..properties].replace(", \"Mesh\"", ""),
                &model[vertices..],
                &OLD[takes..]
            )
        } else {
            OLD.replace("6.1.0", version).replace("6100", number)
        };
        let old = read("old.fbx", text.as_bytes()).unwrap();
        assert_eq!(old.parts[0].mesh.shapes[0].name, "top", "{version}");
        assert_eq!(old.clips.len(), 1, "{version}: {:?}", old.notes);
        for (time, weight) in [(0.0, 0.0), (0.25, 0.25), (1.0, 1.0)] {
            close(&old.at(0, time).unwrap().weights[node(&old, "face")], &[weight]);
        }
    }
    // Version 7.1: the channel's weight is connected to the property of the mesh.
    let connected = FACE.replace("FBXVersion: 7400", "FBXVersion: 7100").replace(
        "C: \"OP\",52,31, \"DeformPercent\"",
        "C: \"OP\",52,10, \"smile\"\n\tC: \"PP\",10, \"smile\",31, \"DeformPercent\"",
    );
    assert!(connected.contains("\"PP\""));
    let scene = read("face.fbx", connected.as_bytes()).unwrap();
    for (time, weights) in [(0.0, [0.0, 0.0]), (0.25, [0.5, 0.0]), (0.75, [0.5, 0.5]), (1.0, [0.0, 1.0])] {
        close(&scene.at(0, time).unwrap().weights[node(&scene, "face")], &weights);
    }
}

/// The files that showed what was wrong, where they are.
#[test]
fn the_reported_files_are_right() {
    let open = |case: &str| shared_case(case).map(|path| std::fs::read(path).unwrap());
    if let Some(bytes) = open("fbx-old-morph-animation/maya_blend_shape_cube_6100_ascii.fbx") {
        let scene = read("cube.fbx", &bytes).unwrap();
        let fbx = ufbx::load_memory(&bytes, ufbx::LoadOpts::default()).unwrap();
        let anim = &fbx.anim_stacks[0].anim;
        let face = scene.parts[0].node;
        let duration = scene.clips[0].duration_secs();
        assert!(
            (duration - (anim.time_end - anim.time_begin)).abs() < 1e-9 && (duration - 4.96).abs() < 5e-3
        );
        for frame in 0..=120 {
            let time = f64::from(frame) / fbx.settings.frames_per_second;
            let expected: Vec<f32> = (fbx.blend_channels.iter())
                .map(|channel| ufbx::evaluate_blend_weight(anim, channel, time + anim.time_begin) as f32)
                .collect();
            close(&scene.at(0, time).unwrap().weights[face], &expected);
        }
    }
    if let Some(bytes) = open("fbx-segment-scale-animation/maya_game_sausage_7500_binary_deform.fbx") {
        let scene = read("sausage.fbx", &bytes).unwrap();
        let obj = open("fbx-segment-scale-animation/maya_game_sausage_deform_8.obj").unwrap();
        let text = String::from_utf8(obj).unwrap();
        let points: Vec<Vec3> = (text.lines().filter_map(|line| line.strip_prefix("v ")))
            .map(|line| {
                let mut numbers = line.split_whitespace().map(|word| word.parse::<f32>().unwrap() * 0.01);
                Vec3::from_array(std::array::from_fn(|_| numbers.next().unwrap()))
            })
            .collect();
        let clip = scene.clips.iter().position(|clip| clip.name == "deform").unwrap();
        let pose = scene.at(clip, 8.0 / 24.0).unwrap();
        let (bones, mesh) = (scene.bones(&pose), &scene.parts[0].mesh);
        let mut out = mesh.deformed();
        deform(mesh, scene.bones_of(0, &bones), scene.weights_of(0, &pose), &mut out).unwrap();
        let size = points.iter().map(|point| point.length()).fold(0.0, f32::max);
        for point in &out.positions {
            let nearest = points.iter().map(|other| other.distance(*point)).fold(f32::MAX, f32::min);
            assert!(nearest < 1e-5 * size, "{point} is {nearest} away");
        }
    }
}
