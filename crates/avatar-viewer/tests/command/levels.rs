//! Levels of detail: `--lod` and `info --levels`.

use crate::common::{finish, golden_pack, has_adapter, json, run, viewer};
use image::RgbaImage;

fn picture(options: &[&str]) -> RgbaImage {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let out = folder.path().join("face.png");
    finish(
        viewer().args(["render", "--hair", "off", "--quality", "low"]).args(options).arg("--out").arg(&out),
    )
    .ok();
    image::open(out).expect("a PNG").into_rgba8()
}

/// Mean difference of the colours of the pixels, of 255.
fn difference(one: &RgbaImage, other: &RgbaImage) -> f64 {
    let all = one.as_raw().iter().zip(other.as_raw());
    all.map(|(a, b)| f64::from(a.abs_diff(*b))).sum::<f64>() / one.as_raw().len() as f64
}

/// How much of a picture changes where a level takes the place of the one before, beside what changes where
/// the camera moves by one pixel's width.
#[test]
fn a_level_takes_the_place_of_another_without_a_pop() {
    if !has_adapter() {
        return;
    }
    // The face fills the picture: a little less than its height.
    for (level, size) in [("1", "360x360"), ("2", "180x180"), ("3", "90x90"), ("4", "45x45")] {
        let before = level.parse::<u32>().map(|level| (level - 1).to_string()).expect("a number");
        let pose = ["--size", size, "--pose", "smile", "--yaw", "20"];
        let draw = |lod: &str| picture(&[&pose[..], &["--lod", lod]].concat());
        let [one, other] = [draw(&before), draw(level)];
        assert_ne!(one, other, "level {level} draws other triangles");
        let mut moved = one.clone();
        for (x, y, pixel) in moved.enumerate_pixels_mut() {
            *pixel = *one.get_pixel(x.saturating_sub(1), y);
        }
        let (pop, step) = (difference(&one, &other), difference(&one, &moved));
        assert!(pop < step / 3.0, "level {level}: {pop} beside {step}");
    }
}

#[test]
fn single_pictures_have_the_whole_face() {
    if !has_adapter() {
        return;
    }
    let size = ["--size", "64x64"];
    assert_eq!(picture(&size), picture(&["--size", "64x64", "--lod", "0"]));
}

/// Films of 60 pictures have the level of their height, shorter ones and those with hair the whole face.
#[test]
fn auto_goes_by_height_where_many_pictures_are_drawn() {
    if !has_adapter() {
        return;
    }
    let folder = tempfile::tempdir().expect("a temporary folder");
    let told = finish(viewer().args(["deform", "--gpu", "--out"]).arg(folder.path().join("skin.obj"))).stderr;
    // A graphics card draws the whole face.
    let expected = if told.contains(", Cpu)") { "3" } else { "0" };
    let of_hair = |hair: &str, frames: &str, options: &[&str]| {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let out = folder.path().join("face.png");
        let mut command = viewer();
        command.args([
            "record",
            "--quality",
            "plain",
            "--script",
            "0 smile",
            "--size",
            "64x48",
            "--samples",
            "1",
        ]);
        command.args(["--hair", hair, "--hair-density", "0.02"]);
        finish(command.args(["--fps", "60", "--duration", frames]).args(options).arg("--out").arg(&out)).ok();
        std::fs::read(out).expect("a film")
    };
    let film = |frames: &str, options: &[&str]| of_hair("off", frames, options);
    let (long, short) = ("1", "0.9");
    assert!(film(long, &["--lod", "auto"]) == film(long, &["--lod", expected]));
    assert!(film(long, &["--lod", "3"]) != film(long, &["--lod", "0"]));
    assert!(film(short, &["--lod", "auto"]) == film(short, &["--lod", "0"]));
    let with = |lod: &str| of_hair("short", long, &["--lod", lod]);
    assert!(with("auto") == with("0"));
}

#[test]
fn info_tells_levels_where_it_is_asked() {
    let pack = golden_pack();
    let text = finish(viewer().arg("info").arg(&pack).args(["--levels", "--json"])).ok();
    let report = json(&text);
    let levels = report["levels"].as_array().expect("levels");
    assert_eq!(levels.len(), 5);
    let pixels: Vec<Option<f64>> = levels.iter().map(|level| level["pixels"].as_f64()).collect();
    assert_eq!(pixels, [None, Some(360.0), Some(180.0), Some(90.0), Some(45.0)]);
    let parts = report["parts"].as_array().expect("parts").iter();
    let whole: u64 = parts.map(|part| part["triangles"].as_u64().expect("a number")).sum();
    assert_eq!(levels[0]["triangles"].as_u64(), Some(whole));
    let triangles = levels.iter().map(|level| level["triangles"].as_u64().expect("a number"));
    assert!(triangles.is_sorted_by(|before, after| before >= after));
    assert!(json(&finish(viewer().arg("info").arg(&pack).arg("--json")).ok()).get("levels").is_none());
}

#[test]
fn levels_that_do_not_exist_are_refused() {
    for level in ["5", "-1", "best", ""] {
        let options = ["render", "--out", "x.png", "--lod", level];
        run(&options).fails(2, &["--lod"]);
    }
}
