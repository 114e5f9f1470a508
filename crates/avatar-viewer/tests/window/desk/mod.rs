//! A virtual display with the viewer on it, for real key and mouse events (XTEST, by xdotool); the screen is
//! read back.

mod drop;

use crate::common::{self, Run, finish, finish_soon, has_adapter, viewer};
use image::RgbImage;
use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};
use tempfile::NamedTempFile;
use x11rb::connection::Connection;
use x11rb::protocol::xproto::{ClientMessageEvent, ConnectionExt, EventMask, ImageFormat};

pub(crate) const PATIENCE: Duration = Duration::from_secs(60);
/// Longer than the window waits for a file to settle, and for its frame.
pub(crate) const A_WHILE: Duration = Duration::from_millis(800);

/// A window that shows the same for so long rests: many times what its frame takes.
const RESTS: Duration = Duration::from_millis(400);

/// A process that does not outlive its test.
struct Process(Child);

impl Drop for Process {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// A virtual display with the viewer on it.
pub(crate) struct Desk {
    display: String,
    pub(crate) window: u32,
    viewer: Process,
    _server: Process,
    stderr: NamedTempFile,
    /// One desk at a time: a person has one pair of hands, and the software adapter few cores.
    _turn: MutexGuard<'static, ()>,
}

static TURN: Mutex<()> = Mutex::new(());

/// A virtual display, and its name.
fn display() -> (Process, String) {
    let mut server = Command::new("Xvfb");
    // Without -noreset the display starts anew whenever its last client leaves, under the feet of the
    // next one.
    server.args(["-displayfd", "1", "-screen", "0", "1400x1000x24", "-nolisten", "tcp", "-noreset"]);
    let mut server =
        Process(server.stdout(Stdio::piped()).stderr(Stdio::null()).spawn().expect("Xvfb starts"));
    let mut number = String::new();
    let stdout = server.0.stdout.take().expect("a pipe");
    BufReader::new(stdout).read_line(&mut number).expect("the display's number");
    let display = format!(":{}", number.trim());
    (server, display)
}

/// Runs the program to its end on a display on which no window can open.
pub(crate) fn ends_without_a_window(command: &mut Command) -> Run {
    let _turn = TURN.lock().unwrap_or_else(PoisonError::into_inner);
    let (_server, display) = display();
    command.env("DISPLAY", &display);
    finish_soon(command.env_remove("WAYLAND_DISPLAY").env_remove("WAYLAND_SOCKET"))
}

impl Desk {
    /// Opens a window that shows nothing but the face, which is still unless it is told to live.
    pub(crate) fn open(arguments: &[&str]) -> Self {
        Self::start(viewer().args(still_unless(arguments)).arg("--no-panel"))
    }

    /// Opens a window with its panel, of a user who keeps settings in this folder.
    pub(crate) fn with_panel(arguments: &[&str], settings: &Path) -> Self {
        Self::start(viewer().args(still_unless(arguments)).env("XDG_CONFIG_HOME", settings))
    }

    /// Opens a window as somebody does who says nothing of how the face lives.
    pub(crate) fn as_it_comes(arguments: &[&str], settings: &Path) -> Self {
        Self::start(viewer().args(arguments).env("XDG_CONFIG_HOME", settings))
    }

    fn start(command: &mut Command) -> Self {
        let turn = TURN.lock().unwrap_or_else(PoisonError::into_inner);
        let (server, display) = display();
        command.env("DISPLAY", &display);
        command.env_remove("WAYLAND_DISPLAY").env_remove("WAYLAND_SOCKET");
        let stderr = NamedTempFile::new().expect("a temporary file");
        command.stderr(stderr.reopen().expect("a handle"));
        let viewer = Process(command.spawn().expect("the viewer starts"));
        let mut desk = Self { display, window: 0, viewer, _server: server, stderr, _turn: turn };
        let start = Instant::now();
        while desk.window == 0 {
            let ended = desk.viewer.0.try_wait().expect("the viewer can be waited for");
            assert_eq!(ended, None, "the viewer ended before its window appeared: {}", desk.told());
            assert!(start.elapsed() < PATIENCE, "no window appeared");
            let found = desk.xdotool(&["search", "--onlyvisible", "--name", "Mimik"]);
            desk.window = found.lines().next().and_then(|line| line.parse().ok()).unwrap_or(0);
            std::thread::sleep(Duration::from_millis(50));
        }
        desk.do_xdotool(&["windowfocus", &desk.window.to_string()]);
        desk
    }

    fn xdotool(&self, arguments: &[&str]) -> String {
        let output = Command::new("xdotool").args(arguments).env("DISPLAY", &self.display).output();
        String::from_utf8(output.expect("xdotool starts").stdout).expect("text")
    }

    pub(crate) fn do_xdotool(&self, arguments: &[&str]) {
        let status = Command::new("xdotool").args(arguments).env("DISPLAY", &self.display).status();
        assert!(status.expect("xdotool starts").success(), "xdotool {arguments:?}");
    }

    /// Moves the pointer to a place in the window.
    pub(crate) fn point(&self, x: i32, y: i32) {
        self.do_xdotool(&["mousemove", "--window", &self.window.to_string(), &x.to_string(), &y.to_string()]);
    }

    pub(crate) fn click(&self, x: i32, y: i32) {
        self.point(x, y);
        self.do_xdotool(&["click", "1"]);
    }

    pub(crate) fn write(&self, text: &str) {
        self.do_xdotool(&["type", text]);
    }

    pub(crate) fn key(&self, key: &str) {
        self.do_xdotool(&["key", key]);
    }

    /// Presses the window's close button, as a window manager tells it.
    pub(crate) fn close_button(&self) {
        let (connection, _) = x11rb::connect(Some(&self.display)).expect("the display");
        let atom =
            |name: &[u8]| connection.intern_atom(false, name).expect("sent").reply().expect("an atom").atom;
        let message = [atom(b"WM_DELETE_WINDOW"), x11rb::CURRENT_TIME, 0, 0, 0];
        let event = ClientMessageEvent::new(32, self.window, atom(b"WM_PROTOCOLS"), message);
        // An answer to wait for: a connection that is closed too early takes its last requests with it.
        let sent = connection.send_event(false, self.window, EventMask::NO_EVENT, event).expect("sent");
        sent.check().expect("the display took it");
    }

    /// Waits for the program's end, which is a success.
    #[track_caller]
    pub(crate) fn closes(&mut self) {
        let start = Instant::now();
        let status = loop {
            if let Some(status) = self.viewer.0.try_wait().expect("the viewer can be waited for") {
                break status;
            }
            assert!(start.elapsed() < PATIENCE, "the window did not close");
            std::thread::sleep(Duration::from_millis(20));
        };
        assert!(status.success(), "{status}: {}", self.told());
    }

    /// What the viewer has written on standard error so far.
    pub(crate) fn told(&self) -> String {
        std::fs::read_to_string(self.stderr.path()).expect("standard error is text")
    }

    /// What the window shows now.
    pub(crate) fn picture(&self) -> RgbImage {
        let (connection, _) = x11rb::connect(Some(&self.display)).expect("the display");
        let geometry =
            connection.get_geometry(self.window).expect("sent").reply().expect("the window's size");
        let (width, height) = (geometry.width, geometry.height);
        let image = connection.get_image(ImageFormat::Z_PIXMAP, self.window, 0, 0, width, height, u32::MAX);
        let pixels = image.expect("sent").reply().expect("the window's pixels").data;
        connection.flush().expect("sent");
        let rgb = pixels.as_chunks::<4>().0.iter().flat_map(|[blue, green, red, _]| [*red, *green, *blue]);
        RgbImage::from_raw(width.into(), height.into(), rgb.collect()).expect("four bytes a pixel")
    }

    /// What the window shows once it shows the same for a while.
    #[track_caller]
    pub(crate) fn settled(&self) -> RgbImage {
        let start = Instant::now();
        let mut before = self.picture();
        let mut since = Instant::now();
        loop {
            std::thread::sleep(Duration::from_millis(60));
            let now = self.picture();
            if difference(&now, &before) != Some(0) {
                (before, since) = (now, Instant::now());
            } else if since.elapsed() > RESTS {
                return now;
            }
            assert!(start.elapsed() < PATIENCE, "the window never rests: {}", self.told());
        }
    }

    /// Waits until the window does nothing for a while: the first draft stands still, too, while programs for
    /// the whole picture are compiled.
    #[track_caller]
    pub(crate) fn idles(&self) {
        let start = Instant::now();
        loop {
            let ticks = self.ticks();
            std::thread::sleep(RESTS);
            // There are a hundred in a second.
            if self.ticks() - ticks <= (10.0 * RESTS.as_secs_f64()) as u64 {
                return;
            }
            assert!(start.elapsed() < PATIENCE, "the window never idles: {}", self.told());
        }
    }

    /// Waits until the window shows something else.
    #[track_caller]
    pub(crate) fn changes_from(&self, before: &RgbImage, what: &str) {
        let start = Instant::now();
        while difference(&self.picture(), before) == Some(0) {
            assert!(start.elapsed() < PATIENCE, "{what}: nothing changes: {}", self.told());
            std::thread::sleep(Duration::from_millis(30));
        }
    }

    /// What the window is called.
    pub(crate) fn name(&self) -> String {
        self.xdotool(&["getwindowname", &self.window.to_string()]).trim().to_owned()
    }

    /// Clock ticks that the program has had on a processor.
    pub(crate) fn ticks(&self) -> u64 {
        let stat = std::fs::read_to_string(format!("/proc/{}/stat", self.viewer.0.id())).expect("a process");
        // The name in brackets may hold blanks.
        let fields: Vec<&str> = stat.rsplit(')').next().expect("fields").split_whitespace().collect();
        fields[11].parse::<u64>().expect("a number") + fields[12].parse::<u64>().expect("a number")
    }

    /// Drops a file or folder on the window.
    pub(crate) fn drop_file(&self, path: &Path) {
        drop::drop_file(&self.display, self.window, path);
    }

    /// What the window shows once it shows `expected`, or at the end of patience.
    fn picture_once_like(&self, expected: &RgbImage) -> RgbImage {
        let start = Instant::now();
        loop {
            let picture = self.picture();
            if difference(&picture, expected) == Some(0) || start.elapsed() > PATIENCE {
                return picture;
            }
            std::thread::sleep(Duration::from_millis(50));
        }
    }

    #[track_caller]
    pub(crate) fn shows(&self, expected: &RgbImage, what: &str) {
        let found = self.picture_once_like(expected);
        if let Some(0) = difference(&found, expected) {
            return;
        }
        let folder = std::env::temp_dir();
        let files = [folder.join("window-found.png"), folder.join("window-expected.png")];
        found.save(&files[0]).expect("saved");
        expected.save(&files[1]).expect("saved");
        let most = difference(&found, expected);
        panic!(
            "{what}: the window differs by up to {most:?} (None: in size): see {files:?}; {}",
            self.told()
        );
    }
}

/// The same arguments, of a face that is still if they do not say how it lives.
fn still_unless<'a>(arguments: &[&'a str]) -> Vec<&'a str> {
    let still: &[&str] = if arguments.contains(&"--life") { &[] } else { &["--life", "off"] };
    [arguments, still].concat()
}

/// The largest difference of a channel; `None` for pictures of different sizes.
pub(crate) fn difference(a: &RgbImage, b: &RgbImage) -> Option<u8> {
    let same_size = a.dimensions() == b.dimensions();
    same_size.then(|| a.as_raw().iter().zip(b.as_raw()).map(|(a, b)| a.abs_diff(*b)).max().unwrap_or(0))
}

pub(crate) fn render(options: &[&str]) -> RgbImage {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let out = folder.path().join("expected.png");
    finish(viewer().arg("render").args(options).arg("--out").arg(&out)).ok();
    image::open(&out).expect("a PNG").into_rgb8()
}

pub(crate) fn key_of(pose: &str) -> String {
    let keys = common::run(&["keys"]).ok();
    let line = keys.lines().find(|line| line.ends_with(&format!("pose {pose}")));
    line.and_then(|line| line.split_whitespace().next()).expect("a key").to_owned()
}

pub(crate) fn can_run() -> bool {
    let missing: Vec<_> = [("Xvfb", "-help"), ("xdotool", "version")]
        .into_iter()
        .filter(|(program, option)| {
            Command::new(program).arg(option).stdout(Stdio::null()).stderr(Stdio::null()).status().is_err()
        })
        .map(|(program, _)| program)
        .collect();
    if missing.is_empty() {
        return has_adapter();
    }
    let required = std::env::var_os("MIMIK_REQUIRE_GPU").is_some_and(|value| value == "1");
    assert!(!required, "MIMIK_REQUIRE_GPU=1, but {missing:?} is not installed");
    common::tell(&format!("{missing:?} is not installed"));
    false
}

/// As many editors save: a new file takes the place of the old one.
pub(crate) fn save_as_editors_do(pack: &Path, file: &str, text: &[u8]) {
    let new = pack.join(format!(".{file}.new"));
    std::fs::write(&new, text).expect("written");
    std::fs::rename(new, pack.join(file)).expect("renamed");
}

/// The errors on standard error, once there are `count` and no more come. One that is told again counts once:
/// a system may say twice that a file has changed.
#[track_caller]
pub(crate) fn errors(desk: &Desk, count: usize) -> Vec<String> {
    let read = || -> Vec<String> {
        let told = desk.told();
        let mut errors: Vec<_> = told.lines().filter(|line| line.starts_with("error:")).collect();
        errors.dedup();
        errors.into_iter().map(str::to_owned).collect()
    };
    let start = Instant::now();
    while read().len() < count && start.elapsed() < PATIENCE {
        std::thread::sleep(Duration::from_millis(20));
    }
    std::thread::sleep(A_WHILE);
    let errors = read();
    assert_eq!(errors.len(), count, "{}", desk.told());
    errors
}
