//! A face that others drive, in the window.

use crate::desk::{Desk, PATIENCE, can_run, difference, render};
use avatar_live::{FrameTime, LiveLink};
use image::RgbImage;
use std::net::UdpSocket;
use std::time::{Duration, Instant};

/// A phone that sends by loopback.
struct Phone {
    socket: UdpSocket,
    to: String,
    frame: i32,
}

impl Phone {
    /// One that sends to the port that the window says it listens at.
    fn of(desk: &Desk) -> Self {
        let start = Instant::now();
        loop {
            let told = desk.told();
            let place = told.lines().find_map(|line| line.strip_prefix("listening for livelink at "));
            if let Some(place) = place {
                let socket = UdpSocket::bind("127.0.0.1:0").expect("a port");
                return Self { socket, to: place.to_owned(), frame: 0 };
            }
            assert!(start.elapsed() < PATIENCE, "it does not listen: {told}");
            std::thread::sleep(Duration::from_millis(20));
        }
    }

    /// Sends a face with its mouth open by so much.
    fn send(&mut self, jaw: f32) {
        let mut values = [0.0; 61];
        values[17] = jaw;
        let time = FrameTime { frame: self.frame, part: 0.0, numerator: 60, denominator: 1 };
        let mut packet = Vec::new();
        LiveLink { device: "phone", subject: "Ann", time: Some(time), values: Some(values) }
            .encode(&mut packet);
        self.frame += 1;
        self.socket.send_to(&packet, &self.to).expect("sent");
    }

    /// Sends 60 faces a second until the window shows something that is wanted; returns that.
    fn send_until(
        &mut self,
        desk: &Desk,
        jaw: f32,
        mut is_wanted: impl FnMut(&RgbImage) -> bool,
    ) -> RgbImage {
        let start = Instant::now();
        loop {
            for _ in 0..6 {
                self.send(jaw);
                std::thread::sleep(Duration::from_micros(16_667));
            }
            let picture = desk.picture();
            if is_wanted(&picture) {
                return picture;
            }
            assert!(start.elapsed() < PATIENCE, "the window does not show it");
        }
    }
}

/// Somebody opens the mouth of the face, falls silent, and the face comes to rest by itself, also in a window
/// that draws so slowly that it sees nothing between. Then nothing is drawn any more.
#[test]
fn a_face_follows_its_sender_and_rests_when_nobody_sends() {
    if !can_run() {
        return;
    }
    let size = ["--size", "320x240"];
    let at_rest = render(&size);
    let mut desk = Desk::open(&[&["live", "--listen", "livelink:0"], &size[..]].concat());
    desk.shows(&at_rest, "at first");
    let mut phone = Phone::of(&desk);
    let open = phone.send_until(&desk, 1.0, |picture| difference(picture, &at_rest) != Some(0));
    assert_ne!(difference(&open, &at_rest), Some(0));
    // Who holds still is drawn with all care, though packets come. The face ends within 1e-5 of what is sent.
    let whole = render(&[&size[..], &["--set", "jawOpen=1"]].concat());
    phone.send_until(&desk, 1.0, |picture| difference(picture, &whole).is_some_and(|most| most <= 2));
    desk.shows(&at_rest, "when nobody sends");
    // Nothing arrives, nothing is drawn: a frame takes many ticks of the clock (each 10 ms) in software.
    desk.settled();
    let before = desk.ticks();
    std::thread::sleep(Duration::from_secs(2));
    let worked = desk.ticks() - before;
    assert!(worked <= 3, "{worked} ticks of work in 2 s in which nothing arrived");
    desk.key("Escape");
    desk.closes();
    assert!(desk.told().contains("Ann (livelink): "), "{}", desk.told());
}

/// What other programs can take away.
#[test]
fn the_background_is_a_colour() {
    if !can_run() {
        return;
    }
    let green = ["--size", "320x240", "--background", "#00ff00"];
    let mut desk = Desk::open(&[&["live", "--listen", "livelink:0", "--on-top"], &green[..]].concat());
    desk.shows(&render(&green), "a key colour");
    desk.key("Escape");
    desk.closes();
}

/// Mesa's software drivers show nothing in windows of X11 that one can see through: then the face has its
/// usual background, and the window says so. (What compositors get elsewhere is compared with a formula in
/// avatar-render.)
#[test]
fn a_window_that_cannot_be_seen_through_has_its_usual_background() {
    if !can_run() {
        return;
    }
    let size = ["--size", "320x240"];
    let mut desk = Desk::open(&[&size[..], &["--background", "transparent"]].concat());
    desk.shows(&render(&size), "the usual background");
    assert!(desk.told().contains("shows nothing through windows"), "{}", desk.told());
    desk.key("Escape");
    desk.closes();
}

/// Nobody named the file: a window that does not open would help nobody.
#[test]
fn a_calibration_that_cannot_be_read_is_told_and_the_window_opens() {
    if !can_run() {
        return;
    }
    let settings = tempfile::tempdir().expect("a temporary folder");
    let kept = settings.path().join("mimik/marsienne");
    std::fs::create_dir_all(&kept).expect("a folder");
    std::fs::write(kept.join("calibration.toml"), "[neutral]\njawOpen = much\n").expect("written");
    let mut desk = Desk::with_panel(&["--size", "640x480"], settings.path());
    let told = desk.told();
    assert!(told.contains("calibration.toml: line 2, column 11"), "{told}");
    desk.settled();
    desk.key("Escape");
    desk.closes();
}
