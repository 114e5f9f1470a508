//! Faces that speak: `--visemes`, `--audio`, `--say` and the verb `speak`.

use crate::common::{finish, golden_pack, has_adapter, run, viewer, vowel};

/// A word with the times of its phones; "m" lasts from 0.3 to 0.4 s, "a" from 0.4 to 0.7.
const MAMA: &str = "_ 300\nm 100\na 300\nm 100\na 300\n_ 300\n";

fn labels() -> tempfile::NamedTempFile {
    let file = tempfile::Builder::new().suffix(".pho").tempfile().expect("a file");
    std::fs::write(file.path(), MAMA).expect("written");
    file
}

/// The value of `jaw.open` in each row of a trace.
fn jaw(options: &[&str]) -> Vec<f32> {
    let text = finish(viewer().arg("trace").arg(golden_pack()).args(options)).ok();
    let mut lines = text.lines();
    let mut names = lines.next().expect("names").split(',');
    let column = names.position(|name| name == "jaw.open").expect("a jaw");
    lines.map(|line| line.split(',').nth(column).expect("a column").parse().expect("a number")).collect()
}

#[test]
fn a_speech_is_the_same_in_every_verb() {
    let file = labels();
    let path = file.path().to_str().expect("a path");
    let spoken = jaw(&["--visemes", path, "--hz", "20", "--duration", "1.5"]);
    assert_eq!(spoken.len(), 31);
    // Closed in the middle of each m, open in each a, at rest at both ends.
    assert_eq!([spoken[0], spoken[7], spoken[15], spoken[30]], [0.0; 4]);
    assert!(spoken[11] > 5.0 && spoken[19] > 5.0, "{spoken:?}");
    let bones = |options: &[&str]| finish(viewer().arg("bones").arg(golden_pack()).args(options)).ok();
    let still = bones(&["--visemes", path, "--time", "0.55"]);
    assert_eq!(still, bones(&[&format!("--set=jaw.open={}", spoken[11])]));
    // It adds to poses and to what is set, and lips close over an open jaw.
    let over = jaw(&["--visemes", path, "--script", "0 surprise", "--hz", "20", "--duration", "1"]);
    assert!(over[11] > spoken[11], "{over:?}");
    assert_eq!(over[15], 0.0);
    assert_eq!(bones(&["--visemes", path, "--time", "0.35", "--set", "jaw.open=15"]), bones(&[]));
    // What speech does not concern keeps its value exactly.
    let turned = ["--set", "head.turn=20"];
    assert_eq!(bones(&[&["--visemes", path, "--time", "0.35"][..], &turned].concat()), bones(&turned));
}

#[test]
fn a_film_of_a_speech_lasts_until_the_mouth_rests() {
    if !has_adapter() {
        return;
    }
    let (file, folder) = (labels(), tempfile::tempdir().expect("a folder"));
    let frames = folder.path().join("frames");
    let mut command = viewer();
    command.arg("speak").arg(golden_pack()).arg("--visemes").arg(file.path());
    command.args(["--expression", "smile:0.3", "--fps", "5", "--size", "32x32", "--out"]).arg(&frames);
    finish(&mut command).ok();
    // 1.4 s of labels and 0.4 s until all has come to rest, at 5 frames a second, the first at 0 s.
    assert_eq!(std::fs::read_dir(&frames).expect("a folder").count(), 10);
}

#[test]
fn mistakes_have_their_place() {
    let file = tempfile::Builder::new().suffix(".tsv").tempfile().expect("a file");
    std::fs::write(file.path(), "0.0\tX\n0.2\tQ\n").expect("written");
    let path = file.path().to_str().expect("a path");
    let told = format!("error: {path}: line 2, column 5: expected a mouth of Rhubarb (A to H, X)");
    run(&["bones", "--visemes", path]).fails(1, &[&told]);
    run(&["speak", "--visemes", path, "--out", "-"]).fails(1, &[&told]);
    run(&["bones", "--visemes", "/nowhere.tsv"]).fails(1, &["error: /nowhere.tsv: expected a readable file"]);
    run(&["speak", "--out", "-"]).fails(2, &["--visemes <FILE>"]);
    run(&["bones", "--time", "1"]).fails(2, &["--visemes"]);
    let derived = ["trace", "--visemes", path, "--derivatives"];
    run(&derived).fails(2, &["--derivatives"]);
}

#[test]
fn a_voice_that_is_heard_opens_the_mouth_and_silence_shuts_it() {
    let file = vowel();
    let path = file.path().to_str().expect("a path");
    let spoken = jaw(&["--audio", path, "--hz", "20", "--duration", "1.5"]);
    // What was heard dies out: in degrees, far below what moves a pixel.
    assert!([spoken[0], spoken[4], spoken[30]].iter().all(|value| *value < 1e-6), "{spoken:?}");
    assert!(spoken[13..18].iter().all(|value| *value > 3.0), "{spoken:?}");
    // The same moment in a verb that poses one face.
    let bones = |options: &[&str]| finish(viewer().arg("bones").arg(golden_pack()).args(options)).ok();
    let still = bones(&["--audio", path, "--time", "0.75"]);
    assert_eq!(still, bones(&[&format!("--set=jaw.open={}", spoken[15])]));
    // With labels these say what is seen.
    let labels = labels();
    let both = ["--visemes", labels.path().to_str().expect("a path"), "--audio", path];
    let told = jaw(&[&both[..], &["--hz", "20", "--duration", "1.5"]].concat());
    assert_eq!([told[7], told[15]], [0.0; 2], "{told:?}");
}

#[test]
fn a_film_has_the_sound_of_its_voice() {
    if !has_adapter() {
        return;
    }
    let (file, folder) = (vowel(), tempfile::tempdir().expect("a folder"));
    let speak = |out: &std::path::Path| {
        let mut command = viewer();
        command.arg("speak").arg(golden_pack()).arg("--audio").arg(file.path());
        command.args(["--fps", "10", "--size", "32x32", "--out"]).arg(out);
        finish(&mut command)
    };
    // A folder has the sound beside its pictures, as it was.
    let frames = folder.path().join("frames");
    speak(&frames).ok();
    let wav = std::fs::read(frames.join("sound.wav")).expect("a sound");
    assert_eq!(wav, std::fs::read(file.path()).expect("a sound"));
    // An MP4 has a second track, of 16 kHz in one channel; a GIF says that it has none.
    let film = folder.path().join("film.mp4");
    speak(&film).ok();
    let bytes = std::fs::read(&film).expect("a film");
    let has = |name: &[u8]| bytes.windows(name.len()).any(|part| part == name);
    assert!(has(b"mp4a") && has(b"elst") && has(b"avc1"));
    let gif = speak(&folder.path().join("film.gif"));
    assert!(gif.stderr.contains("GIF is silent"), "{}", gif.stderr);
    gif.ok();
}

#[test]
fn sounds_that_are_none_have_their_place() {
    let file = tempfile::Builder::new().suffix(".wav").tempfile().expect("a file");
    let path = file.path().to_str().expect("a path");
    let expected = "expected a sound as WAV, FLAC, Ogg Vorbis or MP3, found";
    run(&["bones", "--audio", path]).fails(1, &[&format!("error: {path}: {expected} an empty file")]);
    std::fs::write(file.path(), "0.1 PP\n").expect("written");
    run(&["bones", "--audio", path]).fails(1, &[&format!("error: {path}: {expected} a text")]);
    run(&["bones", "--audio", "/nowhere.wav"]).fails(1, &["error: /nowhere.wav: expected a readable file"]);
    run(&["bones", "--say", "a", "--audio", path]).fails(2, &["--say", "--audio"]);
    run(&["bones", "--voice", "de"]).fails(2, &["--say"]);
    run(&["bones", "--say", " "]).fails(2, &["expected a text, found nothing to say"]);
    run(&["bones", "--say", "a", "--voice=-w"]).fails(2, &["expected a voice of espeak-ng"]);
}

/// Where espeak-ng is not installed, `--say` says how to get it; where it is, texts that look like options
/// are texts, and strange voices are errors.
#[test]
fn texts_are_said_by_espeak() {
    let without = finish(viewer().args(["bones", "--say", "mama"]).env("PATH", ""));
    without.fails(1, &["expected the program espeak-ng, found none", "apt install espeak-ng"]);
    if std::process::Command::new("espeak-ng").arg("--version").output().is_err() {
        let required = std::env::var_os("MIMIK_REQUIRE_DATA").is_some_and(|value| value == "1");
        assert!(!required, "expected the program espeak-ng (MIMIK_REQUIRE_DATA=1), found none");
        let _ = std::io::Write::write_fmt(
            &mut std::io::stderr(),
            format_args!("SKIPPED: espeak-ng is not installed\n"),
        );
        return;
    }
    for (text, voice) in [("mama papa", "en"), ("--help", "de"), ("-w x.wav", "en-us+f3")] {
        let spoken = jaw(&["--say", text, "--voice", voice, "--hz", "50", "--duration", "2"]);
        // Vowels open the jaw, the wide ones of "mama" most, and lips or silence close it again.
        let wide = if text == "mama papa" { 3.0 } else { 1.0 };
        let open = spoken.iter().position(|value| *value > wide);
        let open = open.unwrap_or_else(|| panic!("{text}: {spoken:?}"));
        assert!(spoken[open..].iter().any(|value| *value < 0.1), "{text}: {spoken:?}");
    }
    run(&["bones", "--say", "a", "--voice", "nobody"]).fails(1, &["espeak-ng: expected speech"]);
}
