//! The program as a process, and packs to try it on.
#![allow(dead_code, reason = "each of the two test programs uses its own share of these helpers")]
#![allow(unreachable_pub, reason = "a module of two test programs")]

use serde_json::Value;
use std::fs;
use std::io::{Read, Seek, Write};
use std::path::{Path, PathBuf};
use std::process::{Command, ExitStatus, Output, Stdio};
use std::sync::OnceLock;
use std::time::{Duration, Instant};
use tempfile::TempDir;

/// The program under test.
pub fn viewer() -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_avatar-viewer"));
    // Not what whoever runs the tests keeps for themselves.
    command.env("XDG_CONFIG_HOME", concat!(env!("CARGO_TARGET_TMPDIR"), "/nobodys-settings"));
    command
}

/// What a run came to.
#[derive(Debug)]
pub struct Run {
    pub status: i32,
    pub stdout: String,
    pub stderr: String,
}

/// Runs the program with these arguments.
pub fn run<S: AsRef<std::ffi::OsStr>>(arguments: &[S]) -> Run {
    finish(viewer().args(arguments))
}

/// Runs a prepared command to its end.
pub fn finish(command: &mut Command) -> Run {
    let (bytes, mut run) = finish_bytes(command);
    run.stdout = String::from_utf8(bytes).expect("standard output is text");
    run
}

/// The same, for what writes more than text to standard output: that, and the run without it.
pub fn finish_bytes(command: &mut Command) -> (Vec<u8>, Run) {
    let Output { status, stdout, stderr } = command.output().expect("the program starts");
    (stdout, judged(status, stderr))
}

/// Runs a prepared command, which must not take so long: what waits for ever would stop the tests.
pub fn finish_soon(command: &mut Command) -> Run {
    let (out, errors) = (tempfile::tempfile().expect("a file"), tempfile::tempfile().expect("a file"));
    let copy = |file: &fs::File| Stdio::from(file.try_clone().expect("another handle"));
    let mut child = command.stdout(copy(&out)).stderr(copy(&errors)).spawn().expect("the program starts");
    let start = Instant::now();
    let status = loop {
        if let Some(status) = child.try_wait().expect("a state") {
            break status;
        }
        if start.elapsed() > SOON {
            let _ = child.kill();
            panic!("{command:?} did not end within {SOON:?}");
        }
        std::thread::sleep(Duration::from_millis(10));
    };
    let read = |mut file: fs::File| {
        let mut bytes = Vec::new();
        file.rewind().and_then(|()| file.read_to_end(&mut bytes)).expect("read");
        bytes
    };
    let run = judged(status, read(errors));
    Run { stdout: String::from_utf8(read(out)).expect("standard output is text"), ..run }
}

/// Long enough for a busy machine, far too short for a file that never ends.
const SOON: Duration = Duration::from_secs(60);

fn judged(status: ExitStatus, stderr: Vec<u8>) -> Run {
    let run = Run {
        status: status.code().expect("no signal ended the program"),
        stdout: String::new(),
        stderr: String::from_utf8(stderr).expect("standard error is text"),
    };
    for inner in ["panicked", ".rs:"] {
        assert!(!run.stderr.contains(inner), "an answer for programmers: {}", run.stderr);
    }
    run
}

impl Run {
    /// The run succeeded; its standard output.
    #[track_caller]
    pub fn ok(self) -> String {
        assert_eq!(self.status, 0, "expected success, found: {}", self.stderr);
        assert!(!self.stderr.contains("error"), "a success that speaks of errors: {}", self.stderr);
        self.stdout
    }

    /// The run failed with this status and one error message that holds all of `parts`.
    #[track_caller]
    pub fn fails(self, status: i32, parts: &[&str]) {
        assert_eq!(self.status, status, "stdout: {} stderr: {}", self.stdout, self.stderr);
        assert_eq!(self.stdout, "", "a failing verb prints nothing on standard output");
        let errors = self.stderr.lines().filter(|line| line.starts_with("error:")).count();
        assert_eq!(errors, 1, "expected one error, found: {}", self.stderr);
        for part in parts {
            assert!(self.stderr.contains(part), "expected {part:?} in: {}", self.stderr);
        }
    }
}

/// The small pack that is part of the repository.
pub fn golden_pack() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/golden/pack")
}

/// A real face, among the data beside the repository.
pub fn real_face() -> Option<PathBuf> {
    shared_data("avatar-course-format-makehuman")
}

/// A file or folder of the data beside the repository, where there is any; else the reason is printed, or
/// under `MIMIK_REQUIRE_DATA=1` the test fails.
pub fn shared_data(name: &str) -> Option<PathBuf> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data").join(name);
    if !path.exists() {
        let required = std::env::var_os("MIMIK_REQUIRE_DATA").is_some_and(|value| value == "1");
        assert!(!required, "expected data in {} (MIMIK_REQUIRE_DATA=1), found none", path.display());
        tell(&format!("{} is not there", path.display()));
        return None;
    }
    Some(path)
}

/// Says that a test does not run, and why; past the harness, which keeps the output of tests that pass to
/// itself.
pub fn tell(reason: &str) {
    let _ = writeln!(std::io::stderr(), "SKIPPED: {reason}");
}

/// A copy of the small pack, to be damaged.
pub fn copy_of_golden_pack() -> TempDir {
    let copy = tempfile::tempdir().expect("a temporary folder");
    for entry in std::fs::read_dir(golden_pack()).expect("the golden pack is there") {
        let entry = entry.expect("a readable folder");
        std::fs::copy(entry.path(), copy.path().join(entry.file_name())).expect("a copy");
    }
    copy
}

/// The same, with a texture by which hair grows all over the skin.
pub fn hairy_pack() -> TempDir {
    let copy = copy_of_golden_pack();
    let white = image::GrayImage::from_pixel(8, 8, image::Luma([255]));
    white.save(copy.path().join("HairMap.png")).expect("written");
    copy
}

/// Whether drawing can be tested here. Where `MIMIK_REQUIRE_GPU=1` promises an adapter, a missing one is a
/// failure.
pub fn has_adapter() -> bool {
    // Once for all tests: it takes a whole start of the program.
    static PROBE: OnceLock<Run> = OnceLock::new();
    let run = PROBE.get_or_init(|| {
        let out = tempfile::tempdir().expect("a temporary folder");
        let picture = out.path().join("probe.png");
        finish(viewer().arg("render").arg(golden_pack()).args(["--size", "8x8", "--out"]).arg(&picture))
    });
    if run.status == 0 {
        return true;
    }
    let required = std::env::var_os("MIMIK_REQUIRE_GPU").is_some_and(|value| value == "1");
    assert!(!required, "MIMIK_REQUIRE_GPU=1, but nothing can be drawn: {}", run.stderr);
    assert!(run.stderr.contains("adapter"), "rendering failed for another reason: {}", run.stderr);
    tell(run.stderr.trim());
    false
}

/// Text as JSON.
pub fn json(text: &str) -> Value {
    serde_json::from_str(text).expect("JSON")
}

/// A list of numbers.
pub fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().expect("a list").iter().map(|x| x.as_f64().expect("a number")).collect()
}

/// All numbers agree to 1e-4.
pub fn close(found: &[f64], expected: &[f64], what: &str) {
    assert_eq!(found.len(), expected.len(), "{what}");
    for (found, expected) in found.iter().zip(expected) {
        assert!((found - expected).abs() <= 1e-4, "{what}: expected {expected}, found {found}");
    }
}

/// `v` and `vn` lines of an OBJ.
pub fn read_obj(path: &Path) -> (Vec<Vec<f64>>, Vec<Vec<f64>>, Vec<String>) {
    let text = fs::read_to_string(path).expect("an OBJ");
    let vectors = |prefix: &str| {
        let lines = text.lines().filter_map(|line| line.strip_prefix(prefix));
        lines.map(|line| line.split(' ').map(|x| x.parse().expect("a number")).collect()).collect()
    };
    let faces = text.lines().filter(|line| line.starts_with("f ")).map(str::to_owned).collect();
    (vectors("v "), vectors("vn "), faces)
}

/// A WAV of 16 kHz: half a second of silence, an `a` of three formants (G. E. Peterson and H. L. Barney 1952)
/// over a buzz of 120 Hz, and half a second of silence.
pub fn vowel() -> tempfile::NamedTempFile {
    let rate = 16_000.0_f64;
    let mut samples = vec![0.0_f64; 24_000];
    for number in (8_000..16_000).step_by(133) {
        samples[number] = 1.0;
    }
    for (hertz, width) in [(730.0, 90.0), (1_090.0, 110.0), (2_440.0, 170.0)] {
        // A resonator of D. H. Klatt (1980).
        let c = -(-std::f64::consts::TAU * width / rate).exp();
        let b =
            2.0 * (-std::f64::consts::PI * width / rate).exp() * (std::f64::consts::TAU * hertz / rate).cos();
        let mut past = [0.0; 2];
        for sample in &mut samples {
            let value = (1.0 - b - c) * *sample + b * past[0] + c * past[1];
            past = [value, past[0]];
            *sample = value;
        }
    }
    let peak = samples.iter().fold(0.0, |most: f64, sample| most.max(sample.abs()));
    let mut wav = [&b"RIFF"[..], &48_036_u32.to_le_bytes(), b"WAVEfmt ", &16_u32.to_le_bytes()].concat();
    wav.extend([1_u16, 1].iter().flat_map(|half| half.to_le_bytes()));
    wav.extend([16_000_u32, 32_000].iter().flat_map(|word| word.to_le_bytes()));
    wav.extend([2_u16, 16].iter().flat_map(|half| half.to_le_bytes()));
    wav.extend([&b"data"[..], &48_000_u32.to_le_bytes()].concat());
    wav.extend(samples.iter().flat_map(|sample| ((sample / peak * 16_000.0) as i16).to_le_bytes()));
    let file = tempfile::Builder::new().suffix(".wav").tempfile().expect("a file");
    std::fs::write(file.path(), wav).expect("written");
    file
}
