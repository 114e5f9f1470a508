//! Every bad input gets one clear error that names the file, the place, what was expected and what was found.
#![allow(clippy::expect_used, clippy::panic, reason = "a test may panic")]

use crate::common;
use crate::common::{copy_of_golden_pack, finish, run, viewer};
use std::fs;
use std::path::Path;

const SKIN_VB: &str = "MarsienneSkin_VB.raw";
const SKIN_IB: &str = "MarsienneSkin_IB.raw";
const TEETH_VB: &str = "UpperJaw_VB.raw";
const SKIN_BYTES: usize = 124;
const BONES_AT: usize = 8;
const WEIGHTS_AT: usize = 12;

/// Damages a copy of a good pack; `info`, `bones`, `deform` and `render` must then all fail in the same way,
/// and leave no file.
#[track_caller]
fn refuses(damage: impl FnOnce(&Path), parts: &[&str]) {
    let pack = copy_of_golden_pack();
    damage(pack.path());
    let out = tempfile::tempdir().expect("a temporary folder");
    let (mesh, picture) = (out.path().join("out.obj"), out.path().join("out.png"));
    run(&["info".as_ref(), pack.path().as_os_str()]).fails(1, parts);
    run(&["bones".as_ref(), pack.path().as_os_str()]).fails(1, parts);
    finish(viewer().arg("deform").arg(pack.path()).arg("--out").arg(&mesh)).fails(1, parts);
    // A pack is judged before the adapter is looked for.
    finish(without_adapter().arg("render").arg(pack.path()).arg("--out").arg(&picture)).fails(1, parts);
    finish(without_display().arg(pack.path())).fails(1, parts);
    assert_eq!(fs::read_dir(out.path()).expect("a folder").count(), 0, "a file was left behind");
}

fn without_adapter() -> std::process::Command {
    let mut command = viewer();
    for variable in ["VK_DRIVER_FILES", "VK_ICD_FILENAMES"] {
        command.env(variable, "/nonexistent.json");
    }
    command
}

fn without_display() -> std::process::Command {
    let mut command = viewer();
    for variable in ["DISPLAY", "WAYLAND_DISPLAY", "WAYLAND_SOCKET"] {
        command.env_remove(variable);
    }
    command
}

fn edit(pack: &Path, name: &str, change: impl FnOnce(&mut Vec<u8>)) {
    let path = pack.join(name);
    let mut bytes = fs::read(&path).expect("a file of the pack");
    change(&mut bytes);
    fs::write(path, bytes).expect("a damaged file");
}

fn edit_rig(pack: &Path, change: impl FnOnce(String) -> String) {
    edit(pack, "Transformations.xml", |bytes| {
        let text = String::from_utf8(std::mem::take(bytes)).expect("the rig is text");
        let changed = change(text.clone());
        assert_ne!(text, changed, "the damage did nothing");
        *bytes = changed.into_bytes();
    });
}

fn set_float(bytes: &mut [u8], vertex_bytes: usize, vertex: usize, float: usize, value: f32) {
    let at = vertex * vertex_bytes + float * 4;
    bytes[at..at + 4].copy_from_slice(&value.to_le_bytes());
}

fn float(bytes: &[u8], vertex_bytes: usize, vertex: usize, float: usize) -> f32 {
    let at = vertex * vertex_bytes + float * 4;
    f32::from_le_bytes([bytes[at], bytes[at + 1], bytes[at + 2], bytes[at + 3]])
}

#[test]
fn missing_files() {
    for name in [SKIN_VB, SKIN_IB, TEETH_VB, "LtEyeTransp_smtt_IB.raw"] {
        refuses(|pack| fs::remove_file(pack.join(name)).expect("removed"), &[name, "expected the file"]);
    }
    let names = ["Transformations.xml", "Transformationen.xml"];
    refuses(|pack| fs::remove_file(pack.join(names[0])).expect("removed"), &names);
}

#[test]
fn both_names_of_the_rig_are_read() {
    let pack = copy_of_golden_pack();
    let rename =
        fs::rename(pack.path().join("Transformations.xml"), pack.path().join("Transformationen.xml"));
    rename.expect("renamed");
    run(&["info".as_ref(), pack.path().as_os_str()]).ok();
}

#[test]
fn a_folder_or_file_where_the_other_is_meant() {
    for name in [SKIN_VB, "Transformations.xml", "UpperJaw_IB.raw"] {
        let damage = |pack: &Path| {
            fs::remove_file(pack.join(name)).expect("removed");
            fs::create_dir(pack.join(name)).expect("created");
        };
        refuses(damage, &[name, "expected a file, found a folder"]);
    }
    let pack = copy_of_golden_pack();
    let file = pack.path().join(SKIN_VB);
    run(&["info".as_ref(), file.as_os_str()]).fails(1, &[SKIN_VB, "expected the folder", "found a file"]);
    let nothing = pack.path().join("nothing");
    run(&["info".as_ref(), nothing.as_os_str()]).fails(1, &["nothing", "expected the folder"]);
    finish(without_display().arg(&nothing)).fails(1, &["nothing", "expected the folder"]);
}

#[test]
fn partial_elements_and_empty_buffers() {
    for (name, element) in [(SKIN_VB, "124-byte vertices"), (TEETH_VB, "32-byte vertices")] {
        refuses(
            |pack| edit(pack, name, |bytes| bytes.truncate(bytes.len() - 1)),
            &[name, element, "whole number"],
        );
        refuses(|pack| edit(pack, name, Vec::clear), &[name, "at least one vertex"]);
    }
    for name in [SKIN_IB, "UpperJaw_IB.raw"] {
        let cut = |pack: &Path| edit(pack, name, |bytes| bytes.truncate(bytes.len() - 4));
        refuses(cut, &[name, "12-byte triangles"]);
    }
}

#[test]
fn indices_out_of_range() {
    let vertices = fs::metadata(common::golden_pack().join(SKIN_VB)).expect("the golden pack").len() / 124;
    let found = format!("expected a vertex below {vertices}, found {vertices}");
    let damage = |pack: &Path| {
        edit(pack, SKIN_IB, |bytes| bytes[16..20].copy_from_slice(&(vertices as u32).to_le_bytes()));
    };
    refuses(damage, &[SKIN_IB, "triangle 1, corner 1", &found]);
}

#[test]
fn impossible_bones() {
    for (bad, found) in [(0.5, "found 0.5"), (-1.0, "found -1"), (9.0, "found 9"), (f32::NAN, "found NaN")] {
        let damage =
            |pack: &Path| edit(pack, SKIN_VB, |bytes| set_float(bytes, SKIN_BYTES, 2, BONES_AT + 1, bad));
        refuses(damage, &[SKIN_VB, "vertex 2, bone 1", "whole number from 0 to 8", found]);
    }
}

#[test]
fn weights_that_do_not_sum_to_one() {
    let off_by = |pack: &Path, off: f32| {
        edit(pack, SKIN_VB, |bytes| {
            let weight = float(bytes, SKIN_BYTES, 3, WEIGHTS_AT);
            set_float(bytes, SKIN_BYTES, 3, WEIGHTS_AT, weight + off);
        });
    };
    refuses(|pack| off_by(pack, 2e-3), &[SKIN_VB, "vertex 3", "sum to 1"]);

    let pack = copy_of_golden_pack();
    off_by(pack.path(), 1e-4);
    let mended = run(&["bones".as_ref(), pack.path().as_os_str()]);
    assert!(mended.stderr.contains("renormalised 1 vertices (vertex 3"), "{}", mended.stderr);
    mended.ok();
}

#[test]
fn numbers_that_are_not_finite() {
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        let position = |pack: &Path| edit(pack, SKIN_VB, |bytes| set_float(bytes, SKIN_BYTES, 1, 2, bad));
        refuses(position, &[SKIN_VB, "vertex 1", "finite number in position"]);
        let offset = |pack: &Path| edit(pack, SKIN_VB, |bytes| set_float(bytes, SKIN_BYTES, 1, 26, bad));
        refuses(offset, &[SKIN_VB, "vertex 1", "Frown"]);
        let normal = |pack: &Path| edit(pack, TEETH_VB, |bytes| set_float(bytes, 32, 0, 5, bad));
        refuses(normal, &[TEETH_VB, "vertex 0", "finite number in normal"]);
    }
}

#[test]
fn damaged_rigs() {
    const RIG: &str = "Transformations.xml";
    let xml = "Transformations.xml: line";
    refuses(
        |p| edit_rig(p, |x| x.replacen("<Joint ", "<Bone ", 1)),
        &[xml, "expected <Joint>, found <Bone>"],
    );
    refuses(
        |p| edit_rig(p, |x| x.replacen("</Matrix>", " 1 </Matrix>", 1)),
        &[xml, "16 numbers", "found 17"],
    );
    refuses(
        |p| edit_rig(p, |x| x.replacen("</Matrix>", " one </Matrix>", 1)),
        &[xml, "finite number", "one"],
    );
    let twice = |x: String| x.replace("\"JawJoint\"", "\"HeadJoint\"");
    refuses(|p| edit_rig(p, twice), &[xml, "unique", "HeadJoint"]);
    refuses(|p| edit_rig(p, |x| x.replacen(" name=\"JawJoint\"", "", 1)), &[xml, "a joint with a name"]);
    let other = |x: String| x.replace("\"JawJoint\"", "\"ChinJoint\"");
    refuses(|p| edit_rig(p, other), &[RIG, "expected a joint named \"JawJoint\"", "ChinJoint"]);
    let half = |x: String| x[..x.len() / 2].to_owned();
    refuses(|p| edit_rig(p, half), &[xml]);
    refuses(|p| edit(p, RIG, |bytes| *bytes = (0..=255).cycle().take(5000).collect()), &[RIG, "line"]);
    let scaled = |x: String| {
        let at = x.find("<Matrix").expect("a matrix");
        let open = at + x[at..].find('>').expect("its end") + 1;
        let close = at + x[at..].find("</Matrix>").expect("its end");
        format!("{}2 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1{}", &x[..open], &x[close..])
    };
    refuses(|p| edit_rig(p, scaled), &[xml, "rigid"]);
}

#[test]
fn two_hundred_thousand_levels() {
    let nested = |n: usize| {
        let mut xml = String::from("<JointSet>");
        for joint in 0..n {
            xml.push_str(&format!(
                "<Joint name=\"{joint}\"><Matrix>1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1</Matrix><Children>"
            ));
        }
        xml.push_str(&"</Children></Joint>".repeat(n));
        xml + "</JointSet>"
    };
    let damage = |pack: &Path| fs::write(pack.join("Transformations.xml"), nested(200_000)).expect("written");
    refuses(damage, &["Transformations.xml: line 1", "levels of joints"]);
}

#[test]
fn poses_and_controls() {
    let poses =
        |text: &'static str| move |pack: &Path| fs::write(pack.join("poses.toml"), text).expect("written");
    let unknown = "[[pose]]\nname = \"x\"\n[pose.controls]\n\"jaw.opne\" = 3\n";
    refuses(poses(unknown), &["poses.toml", "line 4", "jaw.opne", "jaw.open"]);
    refuses(poses("[[pose]\n"), &["poses.toml", "line 1"]);
    let controls =
        |text: &'static str| move |pack: &Path| fs::write(pack.join("controls.toml"), text).expect("written");
    let joint = "[[control]]\nname = \"a\"\njoint = \"Elbow\"\naxis = \"+x\"\nmin = 0\nmax = 1\n";
    refuses(controls(joint), &["controls.toml", "Elbow"]);
    refuses(
        |pack| fs::write(pack.join("poses.toml"), b"name = \"\xFF\"").expect("written"),
        &["poses.toml", "UTF-8"],
    );
}

#[test]
fn materials() {
    const FILE: &str = "materials.toml";
    let of = |text: &'static str| move |pack: &Path| fs::write(pack.join(FILE), text).expect("written");
    let at = |line: usize, column: usize| format!("/{FILE}: line {line}, column {column}: ");
    refuses(of("[skin\n"), &[&at(1, 6), "expected valid TOML"]);
    refuses(of("[skin]\nwetness = 1\nwetness = 1\n"), &[&at(3, 1), "expected valid TOML", "duplicate key"]);
    let table =
        ["expected one of the tables skin, teeth,", "found \"left_eyeball\"; did you mean \"left-eyeball\"?"];
    refuses(of("# eyes\n[left_eyeball]\n"), &[&at(2, 2), table[0], table[1]]);
    let key = ["skin.colour: expected one of the keys color,", "found \"colour\"; did you mean \"color\"?"];
    refuses(of("[skin]\ncolour = [1, 1, 1]\n"), &[&at(2, 1), key[0], key[1]]);
    let three = "teeth.color: expected an array of three numbers from 0 to 1, found \"white\"";
    refuses(of("[teeth]\ncolor = \"white\"\n"), &[&at(2, 9), three]);
    refuses(of("cornea = 1\n"), &[&at(1, 10), "cornea: expected a table, found 1"]);
    let one = "cornea.opacity: expected a number from 0 to 1, found 1.5";
    refuses(of("[cornea]\nopacity = 1.5\n"), &[&at(2, 11), one]);
    let index = "eyeball.iris.refractive_index: expected a number from 1 to 3, found 0.9";
    refuses(of("[eyeball.iris]\nrefractive_index = 0.9\n"), &[&at(2, 20), index]);
    for (bad, text) in
        [("nan", "[skin]\nscatter = [0, nan, 0]\n"), ("-inf", "[skin]\nscatter = [0, -inf, 0]\n")]
    {
        let number = format!("skin.scatter: expected an array of three numbers from 0 to 1, found {bad}");
        refuses(of(text), &[&at(2, 15), &number]);
    }
    refuses(of("[skin.iris]\npupil = 0.5\n"), &[&at(1, 7), "skin.iris: expected one of the keys color,"]);
    let bytes = |pack: &Path| fs::write(pack.join(FILE), b"[skin]\n# \xFF\n").expect("written");
    refuses(bytes, &[FILE, "expected UTF-8 text, found a bad byte at offset 9"]);
    let folder = |pack: &Path| fs::create_dir(pack.join(FILE)).expect("created");
    refuses(folder, &[FILE, "expected a file, found a folder"]);
}

#[test]
fn textures_that_do_not_decode() {
    let pack = copy_of_golden_pack();
    fs::write(pack.path().join("SkinTex_Decal.png"), b"no picture").expect("written");
    let report = run(&["info".as_ref(), pack.path().as_os_str(), "--json".as_ref()]).ok();
    let report: serde_json::Value = serde_json::from_str(&report).expect("JSON");
    let warnings: Vec<_> =
        report["warnings"].as_array().expect("a list").iter().filter_map(|w| w.as_str()).collect();
    let about = |name: &str| warnings.iter().filter(|w| w.contains(name)).count();
    assert_eq!(about("SkinTex_Decal"), 1, "{warnings:?}");
    assert!(
        warnings.iter().any(|w| w.contains("SkinTex_Decal.png") && w.contains("default")),
        "{warnings:?}"
    );
}

#[test]
fn no_adapter() {
    let out = tempfile::tempdir().expect("a temporary folder");
    let at = |name: &str| out.path().join(name);
    // Variables that name drivers which are not there have the Vulkan loader find none.
    let mut wanted = vec!["expected a GPU adapter"];
    if cfg!(target_os = "linux") {
        wanted.extend(["VK_DRIVER_FILES=/nonexistent.json names the only Vulkan drivers", "unset it"]);
        wanted.extend(["Debian, Ubuntu, Mint   apt install mesa-vulkan-drivers", "Fedora", "Arch", "Alpine"]);
    }
    finish(without_adapter().args(["render", "--out"]).arg(at("out.png"))).fails(1, &wanted);
    finish(without_adapter().args(["sheet", "--out"]).arg(at("out.jpg"))).fails(1, &wanted);
    finish(without_adapter().args(["deform", "--gpu", "--out"]).arg(at("out.obj"))).fails(1, &wanted);
    let script = ["record", "--script", "0 smile", "--out"];
    finish(without_adapter().args(script).arg(at("out.gif"))).fails(1, &wanted);
    assert_eq!(fs::read_dir(out.path()).expect("a folder").count(), 0, "a file was left behind");
}

#[test]
fn no_display() {
    finish(&mut without_display()).fails(1, &["display"]);
}

#[test]
fn outputs_that_cannot_be_written() {
    let out = tempfile::tempdir().expect("a temporary folder");
    fs::create_dir(out.path().join("folder.obj")).expect("made");
    let deform = |name: &str| finish(viewer().args(["deform", "--out"]).arg(out.path().join(name)));
    deform("folder.obj").fails(1, &["found a folder"]);
    deform("no/where.obj").fails(1, &["no", "folder"]);
    assert_eq!(fs::read_dir(out.path()).expect("a folder").count(), 1, "a file was left behind");
}

#[test]
fn wrong_usage() {
    let usage = |arguments: &[&str]| {
        let run = run(arguments);
        assert_eq!(run.status, 2, "{arguments:?}: {}", run.stderr);
        assert!(run.stderr.contains("error:"), "{arguments:?}: {}", run.stderr);
    };
    usage(&["render"]);
    usage(&["render", "--out", "x.png", "--size", "12"]);
    usage(&["render", "--out", "x.png", "--size", "0x10"]);
    usage(&["render", "--out", "x.png", "--samples", "2"]);
    usage(&["render", "--out", "x.png", "--view", "below"]);
    usage(&["render", "--out", "x.png", "--yaw", "nan"]);
    usage(&["render", "--out", "x.png", "--background", "red"]);
    usage(&["bones", "--pose", "nosuch"]);
    usage(&["bones", "--set", "jaw.open"]);
    usage(&["bones", "--set", "jaw.open=wide"]);
    usage(&["bones", "--set", "jaw.opne=3"]);
    usage(&["bones", "--rotate", "HeadJoint=w:3"]);
    usage(&["bones", "--rotate", "Elbow=x:3"]);
    usage(&["deform", "--out", "x.obj", "--part", "beard"]);
    usage(&["trace"]);
    usage(&["trace", "--script", "smile"]);
    usage(&["trace", "--script", "0 nosuch"]);
    usage(&["trace", "--script", "0 smile", "--hz", "0"]);
    usage(&["trace", "--script", "0 smile", "--duration", "-1"]);
    usage(&["trace", "--script", "0 smile", "--hz", "1e9", "--duration", "1e9"]);
    usage(&["info", "--nonsense"]);
}
