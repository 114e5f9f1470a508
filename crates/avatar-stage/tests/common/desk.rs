//! A virtual display with one window on it: real keys (XTEST, by xdotool), and the screen is read back.
#![allow(dead_code, reason = "every test file uses its own share")]
#![allow(unreachable_pub, reason = "a module of several test programs")]
#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::disallowed_methods,
    clippy::disallowed_types,
    reason = "helpers of tests: they start programs, wait for them, and may fail"
)]

use std::io::{BufRead, BufReader};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};
use x11rb::protocol::xproto::{ConnectionExt, ImageFormat};

const PATIENCE: Duration = Duration::from_secs(60);
/// A window that shows the same for so long rests.
const RESTS: Duration = Duration::from_millis(500);

/// Whether there are the programs that a [`Desk`] needs; if not, a line says so, and under
/// `MIMIK_REQUIRE_GPU=1` the test fails.
pub fn can_run() -> bool {
    let is_missing = |program: &str, option: &str| {
        let mut command = Command::new(program);
        command.arg(option).stdout(Stdio::null()).stderr(Stdio::null()).status().is_err()
    };
    let programs = [("Xvfb", "-help"), ("xdotool", "version")];
    let Some((missing, _)) = programs.into_iter().find(|(program, option)| is_missing(program, option))
    else {
        return true;
    };
    let required = std::env::var_os("MIMIK_REQUIRE_GPU").is_some_and(|value| value == "1");
    assert!(!required, "MIMIK_REQUIRE_GPU=1, but {missing} is not installed");
    // Not eprintln: the test runner keeps that back where a test passes.
    let skipped = format_args!("SKIPPED: {missing} is not installed\n");
    let _ = std::io::Write::write_fmt(&mut std::io::stderr(), skipped);
    false
}

/// A process that does not outlive its test.
struct Process(Child);

impl Drop for Process {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// A virtual display with the window of one program.
pub struct Desk {
    display: String,
    window: String,
    program: Process,
    _server: Process,
}

impl Desk {
    /// Starts a program and waits for its window, of this size.
    pub fn open(program: &mut Command, size: [u32; 2]) -> Self {
        let mut server = Command::new("Xvfb");
        server.args(["-displayfd", "1", "-screen", "0", "1000x800x24", "-nolisten", "tcp", "-noreset"]);
        let server = server.stdout(Stdio::piped()).stderr(Stdio::null()).spawn();
        let mut server = Process(server.expect("Xvfb starts"));
        let mut number = String::new();
        let stdout = server.0.stdout.take().expect("a pipe");
        BufReader::new(stdout).read_line(&mut number).expect("the display's number");
        let display = format!(":{}", number.trim());
        program.env("DISPLAY", &display).env_remove("WAYLAND_DISPLAY").env_remove("WAYLAND_SOCKET");
        let program = Process(program.spawn().expect("the program starts"));
        let mut desk = Self { display, window: String::new(), program, _server: server };
        let start = Instant::now();
        while desk.window.is_empty() {
            let ended = desk.program.0.try_wait().expect("the program can be waited for");
            assert_eq!(ended, None, "the program ended before its window appeared");
            assert!(start.elapsed() < PATIENCE, "no window appeared");
            let (_, found) = desk.try_xdotool(&["search", "--onlyvisible", "--name", "."]);
            desk.window = found.lines().next().unwrap_or_default().to_owned();
            std::thread::sleep(Duration::from_millis(50));
        }
        let [width, height] = size.map(|side| side.to_string());
        desk.xdotool(&["windowmove", &desk.window, "0", "0"]);
        desk.xdotool(&["windowsize", "--sync", &desk.window, &width, &height]);
        desk.xdotool(&["windowfocus", &desk.window]);
        desk
    }

    /// Whether xdotool succeeds, and what it prints. A search that finds nothing is a failure.
    fn try_xdotool(&self, arguments: &[&str]) -> (bool, String) {
        let output = Command::new("xdotool").args(arguments).env("DISPLAY", &self.display).output();
        let output = output.expect("xdotool starts");
        (output.status.success(), String::from_utf8(output.stdout).expect("text"))
    }

    fn xdotool(&self, arguments: &[&str]) {
        assert!(self.try_xdotool(arguments).0, "xdotool {arguments:?}");
    }

    pub fn key(&self, key: &str) {
        self.xdotool(&["key", key]);
    }

    /// The picture in the window: red, green, blue and one more byte for each pixel.
    pub fn picture(&self) -> Vec<u8> {
        let (connection, _) = x11rb::connect(Some(&self.display)).expect("the display");
        let window: u32 = self.window.parse().expect("a window");
        let size = connection.get_geometry(window).unwrap().reply().expect("a size");
        let image = connection.get_image(ImageFormat::Z_PIXMAP, window, 0, 0, size.width, size.height, !0);
        let mut pixels = image.unwrap().reply().expect("a picture").data;
        pixels.chunks_exact_mut(4).for_each(|pixel| pixel.swap(0, 2));
        pixels
    }

    /// Waits until the picture is done, which `is_done` sees, and does not change any more. What still moves
    /// is waited for longer: a program that counts frames takes its time where frames do.
    pub fn rests(&self, is_done: impl Fn(&[u8]) -> bool) -> Vec<u8> {
        let start = Instant::now();
        let (mut picture, mut since) = (self.picture(), Instant::now());
        loop {
            std::thread::sleep(Duration::from_millis(50));
            let next = self.picture();
            if next != picture {
                (picture, since) = (next, Instant::now());
            } else if since.elapsed() > RESTS && is_done(&picture) {
                return picture;
            }
            let is_stuck = since.elapsed() > PATIENCE || start.elapsed() > 5 * PATIENCE;
            assert!(!is_stuck, "the picture does not come to what it should be");
        }
    }
}
