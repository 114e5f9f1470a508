//! Biovision hierarchies.

use crate::support::data::shared_data;
use crate::support::texts;
use avatar_exchange::bvh::read;
use avatar_exchange::{Scene, Transform};
use glam::{DMat3, DMat4, DVec3};

const ARM: &str = "HIERARCHY
ROOT hip bone
{
  OFFSET 1 2 3
  CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
  JOINT arm
  {
    OFFSET 0 2 0
    CHANNELS 1 Xrotation
    End Site
    {
      OFFSET 0 0 4
    }
  }
}
MOTION
Frames: 3
Frame Time: 0.25
1 2 3 0 0 0 0
2 2 3 90 0 0 0
1 2 2 90 90 0 90
";

fn good(text: &str) -> Scene {
    read("a.bvh", text.as_bytes()).expect("a good file")
}

fn ends(scene: &Scene, time_secs: f64) -> Vec<DVec3> {
    scene.worlds(&scene.at(0, time_secs).expect("a clip")).iter().map(|world| world.translation).collect()
}

#[test]
fn joints_move_as_their_channels_say() {
    let scene = good(ARM);
    let names: Vec<_> = scene.nodes.iter().map(|node| node.name.as_str()).collect();
    assert_eq!(names, ["hip bone", "arm", "arm End Site"]);
    assert_eq!((scene.clips[0].name.as_str(), scene.clips[0].duration_secs()), ("a", 0.5));
    let expected = [
        (0.0, [[1.0, 2.0, 3.0], [1.0, 4.0, 3.0], [1.0, 4.0, 7.0]]),
        // A quarter turn about z: the arm's +y becomes -x.
        (0.25, [[2.0, 2.0, 3.0], [0.0, 2.0, 3.0], [0.0, 2.0, 7.0]]),
        // Rz Rx takes y to z, and the arm's own quarter turn takes z to -y, which Rz Rx takes to -z.
        (0.5, [[1.0, 2.0, 2.0], [1.0, 2.0, 4.0], [1.0, 2.0, 0.0]]),
        // Half the way of a straight line and of an arc.
        (
            0.125,
            [
                [1.5, 2.0, 3.0],
                [1.5 - 2.0f64.sqrt(), 2.0 + 2.0f64.sqrt(), 3.0],
                [1.5 - 2.0f64.sqrt(), 2.0 + 2.0f64.sqrt(), 7.0],
            ],
        ),
    ];
    for (time, points) in expected {
        for (found, point) in ends(&scene, time).iter().zip(points) {
            assert!(found.abs_diff_eq(DVec3::from(point), 1e-5), "{time}: {found} {point:?}");
        }
    }
}

/// As motion libraries write them: every joint has positions, which repeat its offset.
const SIX: &str = "HIERARCHY
ROOT Hips
{
  OFFSET 0 0 0
  CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
  JOINT Spine
  {
    OFFSET 0 10 0
    CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
    JOINT Head
    {
      OFFSET 0 5 1
      CHANNELS 1 Yposition
      End Site
      {
        OFFSET 0 5 0
      }
    }
  }
}
MOTION
Frames: 2
Frame Time: 0.1
0 90 0 0 0 0 0 10 0 0 0 0 5
0 90 0 0 0 0 0 12 0 90 0 0 7
";

#[test]
fn positions_take_the_place_of_offsets() {
    let scene = good(SIX);
    let expect = |time, points: [[f64; 3]; 4]| {
        for (found, point) in ends(&scene, time).iter().zip(points) {
            assert!(found.abs_diff_eq(DVec3::from(point), 1e-5), "{time}: {found} {point:?}");
        }
    };
    expect(0.0, [[0.0, 90.0, 0.0], [0.0, 100.0, 0.0], [0.0, 105.0, 1.0], [0.0, 110.0, 1.0]]);
    // The spine moves and turns y to -x; what no channel moves of the head's offset stays.
    expect(0.1, [[0.0, 90.0, 0.0], [0.0, 102.0, 0.0], [-7.0, 102.0, 1.0], [-12.0, 102.0, 1.0]]);
    let rest: Vec<f64> = scene.worlds(&scene.rest()).iter().map(|world| world.translation.y).collect();
    assert_eq!(rest, [0.0, 10.0, 15.0, 20.0]);
    assert!(scene.notes.is_empty(), "{:?}", scene.notes);
    // Positions that do not repeat the offset put the joint elsewhere from the first frame on.
    let moved = good(&SIX.replace("0 90 0 0 0 0 0 10 0 0", "0 90 0 0 0 0 0 0 0 0"));
    let note = moved.notes[0].to_string();
    assert!(note.contains("1 joints elsewhere than at rest, the first is 'Spine'"), "{note}");
}

#[test]
fn any_order_of_rotations() {
    let matrix = |axis: char, degrees: f64| match axis {
        'X' => DMat3::from_rotation_x(degrees.to_radians()),
        'Y' => DMat3::from_rotation_y(degrees.to_radians()),
        _ => DMat3::from_rotation_z(degrees.to_radians()),
    };
    for order in ["XYZ", "XZY", "YXZ", "YZX", "ZXY", "ZYX", "ZX", "Y"] {
        let channels: String = order.chars().map(|axis| format!(" {axis}rotation")).collect();
        let angles = &[20.0, -50.0, 130.0][..order.len()];
        let numbers: String = angles.iter().map(|angle| format!(" {angle}")).collect();
        let text = format!(
            "HIERARCHY\nROOT a {{\nOFFSET 0 0 0\nCHANNELS {}{channels}\n}}\nMOTION\nFrames: 1\nFrame Time: 1\n{numbers}\n",
            order.len()
        );
        let scene = good(&text);
        let expected =
            order.chars().zip(angles).fold(DMat3::IDENTITY, |m, (axis, angle)| m * matrix(axis, *angle));
        let pose = scene.at(0, 0.0).expect("a clip");
        assert!(DMat4::from(scene.worlds(&pose)[0]).abs_diff_eq(DMat4::from_mat3(expected), 1e-6), "{order}");
    }
}

#[test]
fn errors_name_their_line() {
    for (from, to, line) in [
        ("HIERARCHY", "HIERARCHI", 1),
        ("ROOT hip bone\n{", "ROOT hip bone", 3),
        ("JOINT arm", "JOIN arm", 6),
        ("CHANNELS 6", "CHANNELS 4000000000", 5),
        ("Yrotation", "Wrotation", 5),
        ("Yrotation", "Xrotation", 5),
        ("OFFSET 0 2 0", "OFFSET 0 2", 8),
        ("OFFSET 0 2 0", "OFFSET 0 nan 0", 8),
        ("Frames: 3", "Frames: -3", 17),
        ("Frames: 3", "Frames: 4", 21),
        ("Frames: 3", "Frames: 99999999999", 21),
        ("OFFSET 0 0 4", "End Site\n{\n}", 12),
        ("0.25", "-0.25", 18),
        ("0.25", "inf", 18),
        ("Frame Time", "Time", 18),
        ("2 2 3 90 0 0 0", "2 2 3 90 0 0", 20),
        ("2 2 3 90 0 0 0", "2 2 3 90 0 0 0 0", 20),
        ("2 2 3 90 0 0 0", "2 2 3 90 0 0 x", 20),
        ("  }\n}\n", "  }\n", 15),
        ("\nMOTION", "\n}\nMOTION", 16),
    ] {
        assert!(ARM.contains(from));
        let error = read("a.bvh", ARM.replacen(from, to, 1).as_bytes()).expect_err(to);
        assert_eq!((error.file.as_str(), error.place), ("a.bvh", format!("line {line}")), "{to}");
    }
    let notes = good(&ARM.replace("Frames: 3", "Frames: 2")).notes.clone();
    assert_eq!(notes.iter().map(|note| note.place.as_str()).collect::<Vec<_>>(), ["line 21"]);
    assert_eq!(read("a.bvh", b"").expect_err("nothing").found, "the end of the file");
}

#[test]
fn deep_nesting_is_no_recursion() {
    let depth = 100_000;
    let open: String = (0..depth)
        .map(|k| format!("{} j{k} {{\nOFFSET 0 1 0\n", if k == 0 { "ROOT" } else { "JOINT" }))
        .collect();
    let text = format!("HIERARCHY\n{open}{}MOTION\nFrames: 0\nFrame Time: 1\n", "}\n".repeat(depth));
    let scene = good(&text);
    assert_eq!(scene.worlds(&scene.rest())[depth - 1].translation.y, depth as f64);
    assert!(read("a.bvh", format!("HIERARCHY\n{open}").as_bytes()).is_err());
}

#[test]
fn the_end_of_the_name_tells_the_format() {
    let scene = avatar_exchange::read("a.bvh", ARM.as_bytes(), &[], &mut |_| Err(String::new()));
    assert_eq!(scene, read("a.bvh", ARM.as_bytes()));
}

#[test]
fn damaged_files_are_told() {
    let told = texts::survives_damage(ARM.as_bytes(), |bytes| read("a.bvh", bytes));
    assert!(told > 200, "{told}");
}

#[test]
fn the_face_units_load() {
    let Some(path) = shared_data("makehuman-cc0/poseunits/face-poseunits.bvh") else { return };
    let bytes = texts::bytes(&path);
    let scene = read("face-poseunits.bvh", &bytes).expect("face-poseunits.bvh");
    let text = String::from_utf8_lossy(&bytes);
    let count = |word: &str| text.split_whitespace().filter(|other| *other == word).count();
    assert_eq!(scene.nodes.len(), count("ROOT") + count("JOINT") + count("Site"));
    assert_eq!(count("ROOT") + count("JOINT"), 163);
    assert_eq!(scene.clips[0].channels.iter().map(|channel| channel.times.len()).max(), Some(60));
    // An end site at rest: the sum of the offsets above it.
    let mut sums: Vec<DVec3> = Vec::new();
    let mut last = DVec3::ZERO;
    for line in text.lines().take_while(|line| *line != "MOTION") {
        let words: Vec<&str> = line.split_whitespace().collect();
        match words[..] {
            ["{"] => sums.push(sums.last().copied().unwrap_or_default()),
            ["}"] => sums.truncate(sums.len() - 1),
            ["OFFSET", x, y, z] => {
                let sum = sums.last_mut().expect("a brace");
                *sum += DVec3::new(x.parse().expect("x"), y.parse().expect("y"), z.parse().expect("z"));
                last = *sum;
            }
            _ => {}
        }
    }
    let worlds = scene.worlds(&scene.rest());
    assert!(worlds[worlds.len() - 1].translation.abs_diff_eq(last, 1e-5));
    // The root stands at 0 in all frames, which is not its offset.
    assert!(scene.notes[0].to_string().contains("the first is 'root'"), "{:?}", scene.notes);
    // Something turns in every frame but the first, which is the rest.
    let moved = |frame: usize| {
        let pose = scene.at(0, frame as f64 * 0.041_667).expect("a clip");
        let angle =
            |(a, b): (&Transform, &Transform)| a.affine().matrix3.abs_diff_eq(b.affine().matrix3, 1e-3);
        !pose.locals.iter().zip(&scene.rest().locals).all(angle)
    };
    assert!(!moved(0) && (1..60).filter(|frame| moved(*frame)).count() > 50);
}

#[test]
fn test_models_load() {
    for path in texts::test_models(&["bvh"]) {
        let scene = texts::loads_or_tells(&path, read).expect("a good file");
        assert!(scene.nodes.len() > 20 && scene.clips[0].duration_secs() > 1.0);
    }
}
