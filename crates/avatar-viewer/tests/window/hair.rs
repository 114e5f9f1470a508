//! Hair in the window: `hair.toml` edited while it is open, and the key that goes through the presets.
//! Expected is what `render` draws of the same pack.
#![allow(clippy::expect_used, clippy::panic, reason = "a test may panic")]

use crate::common::hairy_pack;
use crate::desk::{A_WHILE, Desk, can_run, difference, errors, render, save_as_editors_do};
use std::fs;

const OWN: &str =
    "preset = 'bob'\ndensity = 0.03\nseed = 5\n[scalp]\nlength = 0.3\ntip_color = [0.9, 0.1, 0.1]\n";

#[test]
fn the_open_window_follows_the_hair_file() {
    if !can_run() {
        return;
    }
    let pack = hairy_pack();
    let file = pack.path().join("hair.toml");
    let options = [pack.path().to_str().expect("a plain path"), "--size", "160x120", "--quality", "plain"];
    let none = render(&options);
    let mut desk = Desk::open(&options);
    desk.shows(&none, "without the file");

    fs::write(&file, OWN).expect("written");
    let own = render(&options);
    assert_ne!(difference(&own, &none), Some(0), "hair shows");
    desk.shows(&own, "after the file appeared");

    fs::write(&file, "preset = 'bob'\n[scalp]\nlength = 5\n").expect("written");
    let told = errors(&desk, 1);
    let place = format!(
        "{}: line 3, column 10: scalp.length: expected a number from 0 to 3, found 5",
        file.display()
    );
    for part in [&place, "the hair stays as it was"] {
        assert!(told[0].contains(part), "expected {part:?} in: {}", told[0]);
    }
    assert_eq!(difference(&desk.picture(), &own), Some(0), "a broken file changes nothing");

    save_as_editors_do(pack.path(), "hair.toml", OWN.replace("bob", "short").as_bytes());
    let mended = render(&options);
    assert_ne!(difference(&mended, &own), Some(0));
    desk.shows(&mended, "after the file was mended");
    // The other file that is followed is not read because of this one, nor this one because of that.
    fs::write(pack.path().join("materials.toml"), "[skin]\ncolor = [0.1, 0.5, 0.2]\n").expect("written");
    desk.shows(&render(&options), "with other materials");
    errors(&desk, 1);

    fs::remove_file(&file).expect("removed");
    fs::remove_file(pack.path().join("materials.toml")).expect("removed");
    desk.shows(&none, "after the files were removed");
    desk.key("Escape");
    desk.closes();
}

#[test]
fn a_key_goes_through_the_presets_both_ways() {
    if !can_run() {
        return;
    }
    let pack = hairy_pack();
    fs::write(pack.path().join("hair.toml"), OWN).expect("written");
    let options = [pack.path().to_str().expect("a plain path"), "--size", "160x120", "--quality", "plain"];
    let own = render(&options);
    let of = |hair: &str| render(&[&options[..], &["--hair", hair]].concat());
    let mut desk = Desk::open(&options);
    desk.shows(&own, "at first");
    let mut before = own.clone();
    for hair in ["short", "bob", "long", "curly", "mohawk", "bald", "off"] {
        desk.key("h");
        let expected = of(hair);
        assert_ne!(difference(&expected, &before), Some(0), "{hair} shows");
        desk.shows(&expected, hair);
        before = expected;
    }
    desk.key("h");
    desk.shows(&own, "all the way round");
    desk.key("shift+h");
    desk.shows(&of("off"), "one back");
    desk.key("shift+h");
    desk.shows(&of("bald"), "two back");

    // A preset hides what the file says, but number and seed.
    save_as_editors_do(pack.path(), "hair.toml", OWN.replace("0.3", "0.5").as_bytes());
    std::thread::sleep(A_WHILE);
    desk.shows(&of("bald"), "the choice stays");
    desk.close_button();
    desk.closes();
}

#[test]
fn without_hair_of_its_own_a_pack_begins_with_the_option_or_none() {
    if !can_run() {
        return;
    }
    let pack = hairy_pack();
    let options = [
        pack.path().to_str().expect("a plain path"),
        "--size",
        "120x120",
        "--quality",
        "plain",
        "--hair-density",
        "0.03",
    ];
    let of = |hair: &str| render(&[&options[..], &["--hair", hair]].concat());
    // A pose on the same key is told of, and not pressed.
    let pose = "[[pose]]\nname = 'hello'\nkey = 'H'\n[pose.controls]\n'head.turn' = 30\n";
    fs::write(pack.path().join("poses.toml"), pose).expect("written");
    let mut desk = Desk::open(&options);
    desk.shows(&of("off"), "at first");
    let warning = "warning: pose hello: expected a free key, found Shift+h, which means: the hair before";
    assert!(desk.told().contains(warning), "{}", desk.told());
    desk.key("h");
    desk.shows(&of("short"), "the first preset, as many as the option says");
    desk.key("shift+h");
    desk.shows(&of("off"), "one back");
    desk.key("Escape");
    desk.closes();
    drop(desk);

    let mut desk = Desk::open(&[&options[..], &["--hair", "long"]].concat());
    desk.shows(&of("long"), "the option");
    desk.key("h");
    desk.shows(&of("curly"), "the one behind it");
    desk.key("Escape");
    desk.closes();
}

#[test]
fn hair_swings_while_the_head_turns_and_hangs_as_in_a_picture_when_it_has_settled() {
    if !can_run() {
        return;
    }
    let pack = hairy_pack();
    let options = [
        pack.path().to_str().expect("a plain path"),
        "--size",
        "120x120",
        "--quality",
        "plain",
        "--hair",
        "long",
        "--hair-density",
        "0.02",
    ];
    let pose = "[[pose]]\nname = 'aside'\nkey = '7'\n[pose.controls]\n'head.turn' = 40\n";
    fs::write(pack.path().join("poses.toml"), pose).expect("written");
    let still = render(&[&options[..], &["--pose", "aside"]].concat());
    let mut desk = Desk::open(&options);
    desk.shows(&render(&options), "at first");
    desk.key("7");
    // On the way hair is elsewhere than in any picture of the pose; then it is where the picture has it, and
    // stays.
    desk.shows(&still, "after it has settled");
    let settled = desk.picture();
    std::thread::sleep(A_WHILE);
    assert_eq!(difference(&settled, &desk.picture()), Some(0), "nothing moves");
    desk.key("Escape");
    desk.closes();
}
