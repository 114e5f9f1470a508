//! Which hair a picture shows: `hair.toml` of the pack, and the options over it.
#![allow(clippy::expect_used, clippy::panic, reason = "a test may panic")]

use crate::common::{copy_of_golden_pack, finish, hairy_pack, has_adapter, json, viewer};
use serde_json::Value;
use std::fs;
use std::path::Path;

const FEW: &[&str] = &["--hair-density", "0.02", "--hair-seed", "3"];
const BOB: &str = "preset = 'bob'\ndensity = 0.02\nseed = 3\n";

fn draw(pack: &Path, options: &[&str]) -> Vec<u8> {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let out = folder.path().join("face.png");
    let small = ["--size", "120x120", "--quality", "plain"];
    finish(viewer().arg("render").arg(pack).args(small).args(options).arg("--out").arg(&out)).ok();
    fs::read(out).expect("a picture")
}

fn strands(pack: &Path, options: &[&str]) -> Vec<Value> {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let out = folder.path().join("strands.json");
    finish(viewer().arg("strands").arg(pack).args(options).arg("--out").arg(&out)).ok();
    let text = fs::read_to_string(out).expect("strands");
    json(&text)["strands"].as_array().expect("a list").clone()
}

#[test]
fn options_go_over_the_file_and_the_file_over_nothing() {
    if !has_adapter() {
        return;
    }
    let pack = hairy_pack();
    let none = draw(pack.path(), &[]);
    assert!(none == draw(pack.path(), FEW), "nobody says that there is hair");
    let bob = draw(pack.path(), &[FEW, &["--hair", "bob"]].concat());
    let short = draw(pack.path(), &[FEW, &["--hair", "short"]].concat());
    assert!(bob != none && short != none && bob != short);

    let file = pack.path().join("hair.toml");
    let write = |text: &str| fs::write(&file, text).expect("written");
    write(BOB);
    assert!(draw(pack.path(), &[]) == bob, "the file decides");
    assert!(draw(pack.path(), &["--hair", "off"]) == none);
    assert!(draw(pack.path(), &["--hair", "short"]) == short, "number and seed stay the file's");
    assert!(draw(pack.path(), &["--hair-seed", "4"]) != bob);
    write(&BOB.replace("0.02", "0.01"));
    assert!(draw(pack.path(), &["--hair-density", "0.02"]) == bob);

    write(&format!("{BOB}[scalp]\nlength = 0.2\ntip_color = [1, 0, 0]\n"));
    let own = draw(pack.path(), &[]);
    assert!(own != bob, "tables show");
    assert!(draw(pack.path(), &["--hair", "bob"]) == bob, "a preset is the whole style");
}

#[test]
fn hair_has_the_color_that_is_named() {
    if !has_adapter() {
        return;
    }
    let pack = hairy_pack();
    let bob =
        |color: &[&str]| draw(pack.path(), &[&["--hair", "bob", "--hair-density", "0.3"], color].concat());
    let light = |png: &[u8]| {
        let picture = image::load_from_memory(png).expect("a PNG").into_rgba8();
        picture.pixels().map(|pixel| u64::from(pixel.0[0])).sum::<u64>()
    };
    let [black, red, white] = ["black", "red", "white"].map(|name| light(&bob(&["--hair-color", name])));
    assert!(black < red && red < white, "{black} {red} {white}");
    assert!(light(&bob(&["--hair-color", "#ffffff"])) > white);
    assert!(draw(pack.path(), &["--hair-color", "white"]) == draw(pack.path(), &[]), "a colour is no hair");
}

#[test]
fn strands_are_those_of_the_pack() {
    if !has_adapter() {
        return;
    }
    let pack = hairy_pack();
    assert!(strands(pack.path(), &[]).is_empty());
    fs::write(pack.path().join("hair.toml"), BOB).expect("written");
    let of_pack = strands(pack.path(), &[]);
    assert!(of_pack.len() > 100, "{}", of_pack.len());
    assert_eq!(of_pack, strands(pack.path(), &["--hair", "bob"]));
    let twice = strands(pack.path(), &["--hair-density", "0.04"]).len();
    assert!(twice.abs_diff(2 * of_pack.len()) <= 3, "{twice}, {}", of_pack.len());
    assert!(strands(pack.path(), &["--hair", "off"]).is_empty());
}

#[test]
fn more_strands_than_a_device_binds_are_told_by_the_key_that_asks_for_them() {
    if !has_adapter() {
        return;
    }
    let pack = hairy_pack();
    fs::write(pack.path().join("hair.toml"), "density = 2.5\n[scalp]\ndensity = 100\n").expect("written");
    let out = pack.path().join("face.png");
    let run = finish(viewer().arg("render").arg(pack.path()).arg("--out").arg(out));
    run.fails(1, &["density of hair: expected a number from 0 to ", ", found 2.5: expected at most "]);
}

#[test]
fn wrong_values_are_wrong_usage() {
    let out = tempfile::tempdir().expect("a temporary folder");
    for (option, message) in [
        ("--hair=wig", "expected one of short, bob, long, curly, mohawk, bald, off, found \"wig\""),
        ("--hair-density=7.1", "expected a number from 0 to 7"),
        ("--hair-density=nan", "expected a number from 0 to 7"),
        ("--hair-seed=-1", "--hair-seed"),
    ] {
        let mut command = viewer();
        command.arg("render").arg(option).arg("--out").arg(out.path().join("face.png"));
        finish(&mut command).fails(2, &[message]);
    }
}

#[test]
fn a_broken_file_is_one_error_with_its_place() {
    let pack = copy_of_golden_pack();
    let file = pack.path().join("hair.toml");
    fs::write(&file, "preset = 'bob'\n[scalp]\nlenght = 1\n").expect("written");
    let place = format!("{}: line 3, column 1: scalp.lenght: expected one of the keys", file.display());
    for verb in ["info", "keys"] {
        let run = finish(viewer().arg(verb).arg(pack.path()));
        run.fails(1, &[&place, "found \"lenght\"; did you mean \"length\"?"]);
    }
}
