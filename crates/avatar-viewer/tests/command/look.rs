//! The options of the look and `materials.toml`, by the pictures that `render` draws.
#![allow(clippy::expect_used, clippy::panic, reason = "a test may panic")]

use crate::common::{finish, golden_pack, has_adapter, json, real_face, viewer};
use image::RgbaImage;
use std::fs;
use std::path::Path;
use tempfile::TempDir;

const QUALITIES: [&str; 4] = ["plain", "low", "medium", "high"];
const LOOKS: [&[&str]; 5] = [
    &["--quality", "plain"],
    &["--quality", "low"],
    &["--quality", "medium"],
    &["--quality", "high"],
    &["--style", "toon"],
];
const LIGHTS: [&str; 4] = ["studio", "daylight", "dramatic", "flat"];

/// What a run of `render` leaves.
struct Drawn {
    png: Vec<u8>,
    stderr: String,
}

fn draw(pack: Option<&Path>, options: &[&str]) -> Drawn {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let out = folder.path().join("face.png");
    let run = finish(viewer().arg("render").args(pack).args(options).arg("--out").arg(&out));
    let stderr = run.stderr.clone();
    run.ok();
    Drawn { png: fs::read(out).expect("a picture"), stderr }
}

fn picture(pack: &Path, options: &[&str]) -> RgbaImage {
    image::load_from_memory(&draw(Some(pack), options).png).expect("a PNG").into_rgba8()
}

/// The built-in avatar in a folder, without its textures of skin and teeth, which take long to load. It is
/// the same on both sides.
fn built_in() -> TempDir {
    let copy = tempfile::tempdir().expect("a temporary folder");
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets/marsienne");
    for entry in fs::read_dir(folder).expect("the built-in avatar") {
        let entry = entry.expect("a readable folder");
        let name = entry.file_name().into_string().expect("a plain name");
        let is_hair = name == "hair.toml";
        if !is_hair && (!name.ends_with(".png") || name == "EyeTex_Decal00.png") {
            fs::copy(entry.path(), copy.path().join(name)).expect("a copy");
        }
    }
    copy
}

/// The colours of the head alone, in this part of the picture's width.
fn head(picture: &RgbaImage, columns: std::ops::Range<u32>) -> impl Iterator<Item = [f64; 3]> {
    let inside =
        picture.enumerate_pixels().filter(move |(x, _, pixel)| columns.contains(x) && pixel.0[3] > 0);
    inside.map(|(_, _, pixel)| [pixel.0[0], pixel.0[1], pixel.0[2]].map(f64::from))
}

fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0), |(sum, count), value| (sum + value, count + 1));
    assert!(count > 100, "the head is in the picture");
    sum / f64::from(count)
}

fn gray([red, green, blue]: [f64; 3]) -> f64 {
    (red + green + blue) / 3.0
}

/// A small picture of the head alone.
fn head_in_light(pack: &Path, light: &str, options: &[&str]) -> RgbaImage {
    let fixed = ["--light", light, "--size", "96x96", "--background", "transparent", "--samples", "1"];
    picture(pack, &[&fixed, options].concat())
}

fn brightness(picture: &RgbaImage) -> f64 {
    mean(head(picture, 0..picture.width()).map(gray))
}

#[test]
fn wrong_values_are_wrong_usage() {
    let out = tempfile::tempdir().expect("a temporary folder");
    let file = out.path().join("out.png");
    let cases = [
        (
            "--quality",
            &["ultra", "", "Low", "3"][..],
            "expected one of auto, plain, low, medium, high, found",
        ),
        ("--style", &["cartoon"], "expected one of natural, toon, found"),
        ("--light", &["moon", "studio,flat"], "expected one of studio, daylight, dramatic, flat, found"),
        ("--tone-map", &["linear", "aces"], "expected one of neutral, agx, found"),
        (
            "--exposure",
            &["bright", "nan", "inf", "-inf", "10.01", "-11", ""],
            "expected a number from -10 to 10",
        ),
        ("--skin", &["plaid", "#12345", ""], "expected pale, fair, olive, tan, brown, dark or #RRGGBB"),
        ("--iris", &["red", "#12345g"], "expected brown, hazel, amber, green, blue, gray, violet or #RRGGBB"),
        (
            "--hair-color",
            &["blonde", "123456"],
            "expected black, dark-brown, brown, light-brown, blond, red, gray, white or #RRGGBB",
        ),
    ];
    for (option, values, message) in cases {
        for value in values {
            for verb in [&["render", "--out"][..], &["sheet", "--out"], &[]] {
                let mut command = viewer();
                command.args(verb);
                if !verb.is_empty() {
                    command.arg(&file);
                }
                finish(command.arg(format!("{option}={value}"))).fails(2, &[option, message]);
            }
        }
        // Where nothing is drawn there is nothing to look at.
        finish(viewer().args(["info", option, values[0]])).fails(2, &[option]);
    }
    assert_eq!(fs::read_dir(out.path()).expect("a folder").count(), 0, "a file was left behind");
    for verb in ["render", "sheet", ""] {
        let help = finish(viewer().args((!verb.is_empty()).then_some(verb)).arg("--help")).ok();
        for (option, _, _) in cases {
            assert!(help.contains(option), "{option} is not in: {help}");
        }
    }
}

#[test]
fn auto_is_what_the_adapter_is_able_to_and_every_quality_looks_different() {
    if !has_adapter() {
        return;
    }
    let folder = tempfile::tempdir().expect("a temporary folder");
    let told = finish(viewer().args(["deform", "--gpu", "--out"]).arg(folder.path().join("skin.obj"))).stderr;
    let auto = match () {
        () if told.contains(", Cpu)") => "low",
        () if told.contains(", DiscreteGpu)") => "high",
        () => "medium",
    };
    let size = ["--size", "96x96"];
    let of = |quality: &str| picture(&golden_pack(), &[&size[..], &["--quality", quality]].concat());
    let pictures = QUALITIES.map(of);
    let place = QUALITIES.iter().position(|quality| *quality == auto).expect("a quality");
    assert!(of("auto") == pictures[place], "auto is {auto} on {told}");
    assert!(picture(&golden_pack(), &size) == pictures[place], "auto is the default");
    for (i, first) in pictures.iter().enumerate() {
        for (j, second) in pictures.iter().enumerate().skip(i + 1) {
            assert!(first != second, "{} and {}", QUALITIES[i], QUALITIES[j]);
        }
    }
    let toon = ["--style", "toon", "--quality"];
    let toons =
        ["plain", "high"].map(|quality| picture(&golden_pack(), &[&size[..], &toon, &[quality]].concat()));
    assert!(toons[0] == toons[1], "toon has one quality");
    assert!(!pictures.contains(&toons[0]));
}

#[test]
fn every_look_draws_every_pack_without_complaints_and_a_second_time_the_same() {
    if !has_adapter() {
        return;
    }
    let golden = golden_pack();
    let real = real_face();
    let packs = [Some(None), Some(Some(golden.as_path())), real.as_deref().map(Some)];
    for pack in packs.into_iter().flatten() {
        let info = json(&finish(viewer().arg("info").args(pack).arg("--json")).ok());
        let warnings = info["warnings"].as_array().expect("a list").iter().filter_map(|text| text.as_str());
        // Textures that a pack lacks are told of, and nothing else.
        let expected: String = warnings
            .filter(|text| text.contains("texture"))
            .map(|text| format!("warning: {text}\n"))
            .collect();
        for look in LOOKS {
            let options = [look, &["--size", "80x80", "--view", "three-quarter", "--pose", "smile"]].concat();
            let first = draw(pack, &options);
            assert_eq!(first.stderr, expected, "{pack:?} {look:?}");
            // The small pack tells for all packs without textures, the built-in face for those with them.
            if pack.is_none() || pack == Some(&golden) {
                assert!(first.png == draw(pack, &options).png, "{look:?}: two runs differ");
            }
        }
    }
}

#[test]
fn the_sheet_has_a_look_too() {
    if !has_adapter() {
        return;
    }
    let folder = tempfile::tempdir().expect("a temporary folder");
    let sheet = |options: &[&str]| {
        let out = folder.path().join("sheet.png");
        finish(viewer().arg("sheet").arg(golden_pack()).args(options).arg("--out").arg(&out)).ok();
        fs::read(out).expect("a picture")
    };
    let plain = sheet(&["--quality", "plain"]);
    assert!(plain == sheet(&["--quality", "plain", "--light", "studio", "--exposure", "0"]));
    for other in [&["--style", "toon"][..], &["--quality", "plain", "--light", "dramatic", "--exposure", "1"]]
    {
        assert!(plain != sheet(other), "{other:?}");
    }
}

#[test]
fn exposure_brightens_and_darkens() {
    if !has_adapter() {
        return;
    }
    let pack = built_in();
    for (light, tone_map) in LIGHTS.into_iter().zip(["neutral", "agx", "neutral", "agx"]) {
        let bright = |stops: &str| {
            let options = ["--quality", "plain", "--tone-map", tone_map, "--exposure", stops];
            brightness(&head_in_light(pack.path(), light, &options))
        };
        let [dark, as_is, light_up] = ["-1", "0", "1"].map(bright);
        assert!(
            dark + 15.0 < as_is && as_is + 15.0 < light_up,
            "{light} {tone_map}: {dark} {as_is} {light_up}"
        );
    }
    let extreme = |stops: &str| brightness(&head_in_light(pack.path(), "studio", &["--exposure", stops]));
    assert!(extreme("-10") < 3.0 && extreme("10") > 245.0);
}

/// Each option changes its own part only, and the colours that the pack has change nothing.
#[test]
fn skin_and_irises_take_the_colors_that_are_named() {
    if !has_adapter() {
        return;
    }
    let pack = built_in();
    let with = |options: &[&str]| {
        picture(pack.path(), &[&["--size", "160x120", "--quality", "plain"], options].concat())
    };
    let as_is = with(&[]);
    let tone = |name: &str| {
        brightness(&head_in_light(pack.path(), "studio", &["--quality", "plain", "--skin", name]))
    };
    let tones = ["pale", "fair", "olive", "tan", "brown", "dark"].map(tone);
    assert!(tones.is_sorted_by(|light, dark| light > &(dark + 1.0)), "{tones:?}");
    let [left, top, right, bottom] = changed(&as_is, &with(&["--iris", "blue"]), 0..80).expect("an eye");
    assert!(right - left < 12 && bottom - top < 12, "{:?}", [left, top, right, bottom]);
    assert!(with(&["--iris", "#6b4a2b"]) != with(&["--iris", "blue"]));
}

#[test]
fn lights_come_from_where_their_names_say() {
    if !has_adapter() {
        return;
    }
    let pack = built_in();
    for quality in ["plain", "low", "high"] {
        let [studio, daylight, dramatic, flat] = LIGHTS.map(|light| {
            let picture = head_in_light(pack.path(), light, &["--quality", quality]);
            let middle = picture.width() / 2;
            // Seen from the front, the character's left is on the picture's right.
            let right = mean(head(&picture, 0..middle).map(gray));
            let left = mean(head(&picture, middle..picture.width()).map(gray));
            (left - right) / (left + right)
        });
        assert!(flat.abs() < 0.01, "{quality}: flat light has no side: {flat}");
        assert!(studio > 0.03, "{quality}: the studio's lamp stands at the left: {studio}");
        assert!(daylight < -0.03, "{quality}: the sun stands at the right: {daylight}");
        assert!(dramatic > 3.0 * studio, "{quality}: one side in the dark: {dramatic}");
    }
}

#[test]
fn agx_is_paler_than_neutral() {
    if !has_adapter() {
        return;
    }
    let pack = built_in();
    let spread = |[red, green, blue]: [f64; 3]| red.max(green).max(blue) - red.min(green).min(blue);
    for light in LIGHTS {
        let [neutral, agx] = ["neutral", "agx"].map(|tone_map| {
            let picture = head_in_light(pack.path(), light, &["--quality", "plain", "--tone-map", tone_map]);
            mean(head(&picture, 0..picture.width()).map(spread))
        });
        assert!(agx < 0.8 * neutral, "{light}: {agx} and {neutral}");
    }
}

/// The box around the pixels that differ in these columns: left, top, right, bottom.
fn changed(a: &RgbaImage, b: &RgbaImage, columns: std::ops::Range<u32>) -> Option<[u32; 4]> {
    assert_eq!(a.dimensions(), b.dimensions());
    let pixels = a.enumerate_pixels().filter(|(x, _, _)| columns.contains(x));
    pixels.filter(|(x, y, pixel)| *pixel != b.get_pixel(*x, *y)).fold(None, |found, (x, y, _)| {
        let [left, top, right, bottom] = found.unwrap_or([x, y, x, y]);
        Some([left.min(x), top.min(y), right.max(x), bottom.max(y)])
    })
}

#[test]
fn materials_of_eyes_change_eyes_only_and_those_of_one_eye_that_eye() {
    if !has_adapter() {
        return;
    }
    let pack = built_in();
    let (width, height) = (160, 120);
    let with = |materials: &str, quality: &str| {
        fs::write(pack.path().join("materials.toml"), materials).expect("written");
        picture(pack.path(), &["--size", &format!("{width}x{height}"), "--quality", quality])
    };
    // Where the eyes are: paint the corneas, in a quality in which no light gets from pixel to pixel.
    let painted = with("[cornea]\nopacity = 1\ncolor = [0, 1, 0]\n", "plain");
    let unpainted = with("", "plain");
    // The character's right eye is on the picture's left.
    let halves = [0..width / 2, width / 2..width];
    let eyes = halves.clone().map(|half| changed(&painted, &unpainted, half).expect("an eye"));
    let of_both = |pupil: f32| format!("[eyeball.iris]\npupil = {pupil}\n");
    for quality in ["low", "high"] {
        let [defaults, narrow, wide] =
            ["".to_owned(), of_both(0.15), of_both(0.85)].map(|text| with(&text, quality));
        for ((half, eye), side) in halves.iter().zip(eyes).zip(["right", "left"]) {
            for (a, b) in [(&defaults, &narrow), (&defaults, &wide), (&narrow, &wide)] {
                let [left, top, right, bottom] = changed(a, b, half.clone()).expect("the pupil changes");
                let inside = left >= eye[0] && top >= eye[1] && right <= eye[2] && bottom <= eye[3];
                assert!(inside, "{quality}, {side}: {:?} is not within {eye:?}", [left, top, right, bottom]);
            }
        }
        let eye_brightness = |picture: &RgbaImage| {
            let [left, top, right, bottom] = eyes[0];
            let inside = picture
                .enumerate_pixels()
                .filter(|(x, y, _)| (left..=right).contains(x) && (top..=bottom).contains(y));
            inside.map(|(_, _, pixel)| f64::from(pixel.0[1])).sum::<f64>()
        };
        assert!(eye_brightness(&wide) < eye_brightness(&narrow), "{quality}: a wide pupil is dark");

        // The part's table goes over that of its kind, wherever it stands.
        let one = with(&format!("[left-eyeball.iris]\npupil = 0.15\n\n{}", of_both(0.85)), quality);
        let [on_the_left, on_the_right] = halves.clone();
        assert_eq!(
            changed(&one, &wide, on_the_left.clone()),
            None,
            "{quality}: the right eye is as its kind"
        );
        assert_eq!(changed(&one, &narrow, on_the_right.clone()), None, "{quality}: the left eye has its own");
        let alone = with("[left-eyeball.iris]\npupil = 0.15\n", quality);
        assert_eq!(changed(&alone, &defaults, on_the_left), None, "{quality}: the right eye as it was");
        assert_eq!(changed(&alone, &narrow, on_the_right), None, "{quality}: the left eye alone");
    }
}

#[test]
fn materials_of_every_part_show() {
    if !has_adapter() {
        return;
    }
    let pack = built_in();
    let with = |materials: &str| {
        fs::write(pack.path().join("materials.toml"), materials).expect("written");
        // A raised upper lip bares the upper teeth.
        let lips = ["--set", "mouthUpperUpLeft=1", "--set", "mouthUpperUpRight=1"];
        let open = ["--size", "160x120", "--quality", "low", "--set", "jaw.open=20"];
        picture(pack.path(), &[&open[..], &lips].concat())
    };
    let defaults = with("");
    assert!(defaults == with("# nothing\n[skin]\n[eyeball.iris]\n"), "no value, no change");
    let kinds = ["skin", "teeth", "eyeball", "cornea"];
    let parts = ["upper-jaw", "lower-jaw", "right-eyeball", "left-eyeball", "right-cornea", "left-cornea"];
    for part in kinds.into_iter().chain(parts) {
        let changes = with(&format!("[{part}]\nreflectance = 0.5\nroughness_matte = 0.2\nwetness = 0\n"));
        assert!(defaults != changes, "[{part}] changes nothing");
    }
}
