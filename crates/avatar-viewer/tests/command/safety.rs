//! Whatever a path leads to: only files are read, up to a size, and what an avatar brings along only from its
//! own folder. Each run has a limit of time: what waits for a pipe, or reads what never ends, would stop
//! there.
#![allow(clippy::expect_used, clippy::panic, reason = "a test may panic")]

use crate::common::{Run, copy_of_golden_pack, finish_soon, golden_pack, viewer};
use std::fs;
use std::os::unix::fs::symlink;
use std::os::unix::net::UnixListener;
use std::path::Path;
use std::process::Command;

fn make_pipe(path: &Path) {
    let made = Command::new("mkfifo").arg(path).status().expect("mkfifo starts");
    assert!(made.success());
}

/// What a message calls something that is not a file, and what makes it in the place of one.
type NoFile = (&'static str, fn(&Path));
const NO_FILES: [NoFile; 4] = [
    ("a pipe", make_pipe),
    ("a device", |path| symlink("/dev/zero", path).expect("a link")),
    ("a socket", |path| drop(UnixListener::bind(path).expect("a socket"))),
    ("a folder", |path| fs::create_dir(path).expect("made")),
];

fn info(pack: &Path) -> Run {
    finish_soon(viewer().arg("info").arg(pack))
}

/// Messages about what lies in the place of a file of this name: it is no file, or it is not in the folder.
fn refuses(what: &str, run: Run, name: &str) {
    assert_eq!(run.status, 1, "{what}: {}", run.stderr);
    assert!(run.stderr.contains(name), "{what}: {}", run.stderr);
    let outside = "expected a file in the same folder or below";
    let is_told =
        run.stderr.contains(&format!("found {what}")) || what == "a device" && run.stderr.contains(outside);
    assert!(is_told, "{what}: {}", run.stderr);
}

#[test]
fn the_avatar_itself() {
    for (what, make) in NO_FILES.into_iter().take(3) {
        for ending in ["glb", "gltf", "vrm", "obj", "fbx", "dae", "md5mesh", "bvh"] {
            let folder = tempfile::tempdir().expect("a temporary folder");
            let file = folder.path().join(format!("face.{ending}"));
            make(&file);
            let found = format!("face.{ending}: expected the folder or file of an avatar, found {what}");
            info(&file).fails(1, &[&found]);
            // The window opens nothing else, and converts nothing else.
            finish_soon(viewer().arg(&file)).fails(1, &[&found]);
            finish_soon(viewer().arg("convert").arg(&file).args(["--out", "-", "--format", "obj"]))
                .fails(1, &[&found]);
        }
    }
    finish_soon(viewer().args(["info", "/dev/zero"])).fails(1, &["/dev/zero: expected", "found a device"]);
    finish_soon(viewer().args(["info", "/dev/stdin"])).fails(1, &["/dev/stdin: expected"]);
}

#[test]
fn a_link_of_ones_own_to_an_avatar_is_followed() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let (link, file, elsewhere) =
        (folder.path().join("link"), folder.path().join("here.obj"), folder.path().join("x"));
    symlink(golden_pack(), &link).expect("a link");
    info(&link).ok();
    fs::create_dir(&elsewhere).expect("made");
    fs::write(elsewhere.join("there.obj"), TRIANGLE).expect("written");
    symlink(elsewhere.join("there.obj"), &file).expect("a link");
    info(&file).ok();
}

/// It goes on for hundreds of gigabytes, and the system says that it is a file of no bytes.
#[cfg(target_os = "linux")]
#[test]
fn files_without_an_end() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let endless = "found one that goes on";
    for name in ["face.glb", "face.obj", "face.fbx", "face.bvh"] {
        symlink("/proc/self/pagemap", folder.path().join(name)).expect("a link");
        info(&folder.path().join(name)).fails(1, &[name, endless]);
    }
    let large = folder.path().join("large.glb");
    // Room for it is claimed and not used.
    fs::File::create(&large).and_then(|file| file.set_len(5 << 30)).expect("a large file");
    info(&large).fails(1, &["large.glb: expected a file of at most 4294967296 bytes, found 5368709120"]);
    let pack = copy_of_golden_pack();
    let poses = pack.path().join("poses.toml");
    fs::File::create(&poses).and_then(|file| file.set_len(65 << 20)).expect("a large file");
    info(pack.path()).fails(1, &["poses.toml", "expected a file of at most 67108864 bytes, found 68157440"]);
}

#[test]
fn every_file_of_a_pack() {
    const TEXTS: [&str; 5] = ["poses.toml", "clips.toml", "controls.toml", "materials.toml", "hair.toml"];
    const BUFFERS: [&str; 3] = ["Transformations.xml", "MarsienneSkin_VB.raw", "UpperJaw_IB.raw"];
    for (what, make) in NO_FILES {
        for name in TEXTS.into_iter().chain(BUFFERS) {
            let pack = copy_of_golden_pack();
            let file = pack.path().join(name);
            if file.exists() {
                fs::remove_file(&file).expect("removed");
            }
            make(&file);
            refuses(what, info(pack.path()), name);
        }
        // Without a texture a face is shown all the same.
        for name in ["SkinTex_Decal.png", "HairMap.png"] {
            let pack = copy_of_golden_pack();
            make(&pack.path().join(name));
            let told = info(pack.path()).ok();
            assert!(told.contains(name), "{what}: {told}");
        }
    }
}

#[test]
fn links_that_leave_a_pack() {
    let outer = tempfile::tempdir().expect("a temporary folder");
    let secret = outer.path().join("secret.toml");
    fs::write(&secret, "password = 'hunter2'").expect("written");
    for name in
        ["poses.toml", "clips.toml", "controls.toml", "materials.toml", "hair.toml", "Transformations.xml"]
    {
        let pack = copy_of_golden_pack();
        let file = pack.path().join(name);
        if file.exists() {
            fs::remove_file(&file).expect("removed");
        }
        symlink(&secret, &file).expect("a link");
        let run = info(pack.path());
        assert!(
            !run.stderr.contains("hunter2") && !run.stderr.contains("password"),
            "{name}: {}",
            run.stderr
        );
        run.fails(1, &[name, "expected a file in the same folder or below"]);
    }
}

const TRIANGLE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n";

/// An OBJ, an MTL and a texture; a glTF, its buffer and its texture.
fn referring(folder: &Path) -> [(&'static str, Vec<&'static str>); 2] {
    fs::write(folder.join("face.obj"), format!("mtllib face.mtl\nusemtl skin\n{TRIANGLE}")).expect("written");
    fs::write(folder.join("face.mtl"), "newmtl skin\nmap_Kd skin.png\n").expect("written");
    image::RgbImage::new(2, 2).save(folder.join("skin.png")).expect("written");
    let positions: Vec<u8> =
        [0_f32, 0., 0., 1., 0., 0., 0., 1., 0.].iter().flat_map(|x| x.to_le_bytes()).collect();
    fs::write(folder.join("face.bin"), positions).expect("written");
    let gltf = r#"{"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],
        "meshes":[{"primitives":[{"attributes":{"POSITION":0},"material":0}]}],
        "materials":[{"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}}],
        "textures":[{"source":0}],"images":[{"uri":"skin.png"}],
        "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}],
        "bufferViews":[{"buffer":0,"byteLength":36}],"buffers":[{"uri":"face.bin","byteLength":36}]}"#;
    fs::write(folder.join("face.gltf"), gltf).expect("written");
    [("face.obj", vec!["face.mtl", "skin.png"]), ("face.gltf", vec!["face.bin", "skin.png"])]
}

#[test]
fn what_a_file_refers_to() {
    let outer = tempfile::tempdir().expect("a temporary folder");
    fs::write(outer.path().join("secret"), "newmtl hunter2\n").expect("written");
    let leaves: NoFile = ("a link", |path| symlink("../secret", path).expect("a link"));
    for (number, (what, make)) in NO_FILES.into_iter().chain([leaves]).enumerate() {
        let folder = outer.path().join(format!("avatar-{number}"));
        fs::create_dir(&folder).expect("made");
        for (file, names) in referring(&folder) {
            info(&folder.join(file)).ok();
            for name in names {
                fs::rename(folder.join(name), folder.join("aside")).expect("renamed");
                make(&folder.join(name));
                let run = info(&folder.join(file));
                let told = format!("{}{}", run.stdout, run.stderr);
                assert!(!told.contains("hunter2"), "{told}");
                assert!(told.contains(name), "{what} as {name} of {file}: {told}");
                let outside = told.contains("expected a file in the same folder or below");
                assert!(
                    outside || told.contains(&format!("found {what}")),
                    "{what} as {name} of {file}: {told}"
                );
                // Without its points there is no mesh; without a picture there is.
                assert_eq!(run.status, i32::from(name == "face.bin"), "{what} as {name} of {file}: {told}");
                let _ = fs::remove_dir(folder.join(name)).or_else(|_| fs::remove_file(folder.join(name)));
                fs::rename(folder.join("aside"), folder.join(name)).expect("renamed");
            }
        }
    }
}

#[test]
fn further_files() {
    for (what, make) in NO_FILES.into_iter().take(3) {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let at = |name: &str| folder.path().join(name);
        fs::write(at("face.obj"), TRIANGLE).expect("written");
        fs::create_dir(at("targets")).expect("made");
        fs::write(at("targets/smile.target"), "0 0 0 1\n").expect("written");
        let with = |further: &str| {
            finish_soon(viewer().arg("info").arg(at("face.obj")).arg("--with").arg(at(further)))
        };
        with("targets").ok();
        make(&at("frown.target"));
        with("frown.target").fails(1, &["frown.target", &format!("expected a file, found {what}")]);
        make(&at("targets/frown.target"));
        refuses(what, with("targets"), "frown.target");
    }
    let folder = tempfile::tempdir().expect("a temporary folder");
    let at = |name: &str| folder.path().join(name);
    fs::write(at("face.obj"), TRIANGLE).expect("written");
    fs::write(at("secret"), "hunter2\n").expect("written");
    fs::create_dir(at("targets")).expect("made");
    symlink("../secret", at("targets/smile.target")).expect("a link");
    let run = finish_soon(viewer().arg("info").arg(at("face.obj")).arg("--with").arg(at("targets")));
    assert!(!run.stderr.contains("hunter2"), "{}", run.stderr);
    run.fails(1, &["smile.target: expected a file in the same folder or below"]);
}

#[test]
fn poses_and_clips_beside_a_file() {
    for name in ["face.obj.poses.toml", "face.obj.clips.toml"] {
        for (what, make) in NO_FILES {
            let folder = tempfile::tempdir().expect("a temporary folder");
            fs::write(folder.path().join("face.obj"), TRIANGLE).expect("written");
            make(&folder.path().join(name));
            refuses(what, info(&folder.path().join("face.obj")), name);
        }
        // Such a link would also be written through.
        let outer = tempfile::tempdir().expect("a temporary folder");
        let folder = outer.path().join("avatar");
        fs::create_dir(&folder).expect("made");
        fs::write(outer.path().join("secret"), "hunter2 = 1\n").expect("written");
        fs::write(folder.join("face.obj"), TRIANGLE).expect("written");
        symlink("../secret", folder.join(name)).expect("a link");
        let run = info(&folder.join("face.obj"));
        assert!(!run.stderr.contains("hunter2"), "{}", run.stderr);
        run.fails(1, &[name, "expected a file in the same folder or below"]);
    }
}

#[cfg(target_os = "linux")]
#[test]
fn settings() {
    for (what, make) in NO_FILES {
        let home = tempfile::tempdir().expect("a temporary folder");
        let settings = home.path().join("mimik");
        fs::create_dir(&settings).expect("made");
        make(&settings.join("keys.toml"));
        let run = finish_soon(viewer().arg("keys").env("XDG_CONFIG_HOME", home.path()));
        run.fails(1, &["keys.toml", &format!("expected a file, found {what}")]);
        fs::create_dir(settings.join("marsienne")).expect("made");
        make(&settings.join("marsienne/poses.toml"));
        let run = finish_soon(viewer().arg("info").env("XDG_CONFIG_HOME", home.path()));
        run.fails(1, &["poses.toml", &format!("expected a file, found {what}")]);
    }
    // One's own settings may be links to wherever one keeps them.
    let home = tempfile::tempdir().expect("a temporary folder");
    fs::create_dir(home.path().join("mimik")).expect("made");
    fs::write(home.path().join("dotfile"), "help = \"F7\"\n").expect("written");
    symlink("../dotfile", home.path().join("mimik/keys.toml")).expect("a link");
    let keys = finish_soon(viewer().arg("keys").env("XDG_CONFIG_HOME", home.path())).ok();
    assert!(keys.lines().any(|line| line.starts_with("F7 ")), "{keys}");
}
