//! Faces that arrive: `live --headless`.

use crate::common::{finish, finish_soon, golden_pack, viewer};
use avatar_live::{Frame, FrameTime, LiveLink, mediapipe_line, write_table_header, write_table_row};
use std::fs;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::{TcpStream, UdpSocket};
use std::process::Stdio;
use std::time::{Duration, Instant};
use tempfile::TempDir;
use tungstenite::client::IntoClientRequest;
use tungstenite::http::HeaderValue;
use tungstenite::{Error, Message};

fn time(frame: i32) -> FrameTime {
    FrameTime { frame, part: 0.0, numerator: 60, denominator: 1 }
}

/// A head that turns, as a table and as packets.
fn face(frame: i32) -> [f32; 61] {
    let mut face = Frame::default();
    face.set_named("head.turn", 20.0 * (f64::from(frame) / 20.0).sin() as f32);
    LiveLink::values_of(&face)
}

fn column(trace: &str, name: &str) -> Vec<f32> {
    let mut lines = trace.lines();
    let place = lines.next().unwrap().split(',').position(|column| column == name).unwrap();
    lines.map(|line| line.split(',').nth(place).unwrap().parse().unwrap()).collect()
}

#[test]
fn a_recording_plays_by_its_own_times_and_is_recorded_again() {
    let folder = TempDir::new().unwrap();
    let path = |name: &str| folder.path().join(name);
    let mut table = Vec::new();
    write_table_header(&mut table);
    (0..240).for_each(|frame| write_table_row(&time(frame), &face(frame), &mut table));
    fs::write(path("head.csv"), table).unwrap();
    let play = |options: &[&str]| {
        let mut command = viewer();
        command.arg("live").arg(golden_pack()).arg("--headless").arg("--play").arg(path("head.csv"));
        finish(command.args(options))
    };
    let run = play(&["--trace", "-"]);
    let turn = column(&run.stdout, "head.turn");
    // Until half a second after the last row, 4.483 s.
    assert_eq!(turn.len(), 270);
    // One frame and 5 ms later, once the face has come in.
    for (row, turn) in turn.iter().enumerate().take(239).skip(180) {
        let expected = 20.0 * ((row as f64 - 1.0 - 0.3) / 20.0).sin();
        assert!((f64::from(*turn) - expected).abs() < 0.05, "{row}: {turn} {expected}");
    }
    assert!(run.stderr.contains("head.csv (frames): "), "{}", run.stderr);
    assert!(run.stderr.contains("240 received, 0 lost, 0 reordered, 0 twice, 0 late"), "{}", run.stderr);
    let mirrored = column(&play(&["--trace", "-", "--mirror"]).stdout, "head.turn");
    assert!((mirrored[200] + turn[200]).abs() < 0.01, "{} {}", mirrored[200], turn[200]);

    let again = path("again.csv");
    assert_eq!(play(&["--record", again.to_str().unwrap()]).status, 0);
    let text = fs::read_to_string(&again).unwrap();
    let recorded = column(&text, "HeadYaw");
    assert_eq!(recorded.len(), 270);
    assert!((recorded[200].to_degrees() - turn[200]).abs() < 1e-3);
    let clip = path("again.toml");
    assert_eq!(play(&["--record", clip.to_str().unwrap()]).status, 0);
    let text = fs::read_to_string(&clip).unwrap();
    assert!(text.contains("[[clip]]\nname = \"again\"") && text.contains("\"head.turn\" = ["), "{text}");
    assert!(text.lines().count() < 120, "{} lines: it is reduced", text.lines().count());
}

/// Packets through the system's own sockets: every ninth does not come, every tenth comes twice, and every
/// eleventh behind the next one.
#[test]
fn packets_arrive_and_are_counted() {
    let mut command = viewer();
    command.arg("live").arg(golden_pack()).args(["--headless", "--seconds", "4", "--trace", "-"]);
    command.args(["--listen", "livelink:0", "--listen", "vmc:0"]);
    let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    let mut errors = BufReader::new(child.stderr.take().unwrap());
    let mut line = String::new();
    errors.read_line(&mut line).unwrap();
    let address = line.trim().strip_prefix("listening for livelink at ").unwrap().to_owned();
    assert!(address.starts_with("127.0.0.1:"), "{address}");
    let mut output = child.stdout.take().unwrap();
    let reader = std::thread::spawn(move || {
        let mut text = String::new();
        output.read_to_string(&mut text).unwrap();
        text
    });
    let socket = UdpSocket::bind("127.0.0.1:0").unwrap();
    let packet = |frame: i32| {
        let mut packet = Vec::new();
        let values = Some(face(frame));
        LiveLink { device: "phone", subject: "Ann", time: Some(time(frame)), values }.encode(&mut packet);
        packet
    };
    let start = Instant::now();
    let (mut lost, mut twice, mut held) = (0, 0, None);
    for frame in 0..150 {
        let due = Duration::from_secs_f64(f64::from(frame) / 60.0);
        std::thread::sleep(due.saturating_sub(start.elapsed()));
        let is_clean = !(20..140).contains(&frame);
        if frame % 9 == 0 && !is_clean {
            lost += 1;
            continue;
        }
        if frame % 11 == 0 && !is_clean && held.is_none() {
            held = Some(packet(frame));
            continue;
        }
        socket.send_to(&packet(frame), &address).unwrap();
        if frame % 10 == 0 && !is_clean {
            twice += 1;
            socket.send_to(&packet(frame), &address).unwrap();
        }
        if let Some(packet) = held.take() {
            socket.send_to(&packet, &address).unwrap();
        }
    }
    socket.send_to(b"what is this?", &address).unwrap();
    let mut rest = String::new();
    errors.read_to_string(&mut rest).unwrap();
    assert!(child.wait().unwrap().success(), "{rest}");
    let trace = reader.join().unwrap();
    let received = 150 - lost + twice;
    assert!(rest.contains("Ann (livelink): "), "{rest}");
    let counts = format!("{received} received, {lost} lost, ");
    assert!(rest.contains(&counts) && rest.contains(&format!(" {twice} twice")), "{rest} {counts} {twice}");
    assert!(rest.contains("1 packets were not used; the last one: byte 0: expected version 6"), "{rest}");
    let turn = column(&trace, "head.turn");
    assert_eq!(turn.len(), 241);
    assert!(turn.iter().any(|turn| *turn > 15.0) && turn.iter().any(|turn| *turn < -15.0));
    // It eases to neutral after the last packet.
    assert!(turn[240].abs() < 3.0, "{}", turn[240]);
}

/// A page sends a message for each frame. One that sends something else is cut off, whatever it sends, and
/// the other one goes on.
#[test]
fn pages_in_a_browser_drive_the_face() {
    let mut command = viewer();
    command.arg("live").arg(golden_pack()).args(["--headless", "--seconds", "4", "--trace", "-"]);
    command.args(["--listen", "mediapipe:ws:0", "--page", "https://example.org"]);
    let command = command.stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = command.spawn().unwrap();
    let mut errors = BufReader::new(child.stderr.take().unwrap());
    let mut line = String::new();
    errors.read_line(&mut line).unwrap();
    let address = line.trim().strip_prefix("listening for mediapipe at ").unwrap().to_owned();
    assert!(address.starts_with("ws://127.0.0.1:"), "{address}");
    let place = address.trim_start_matches("ws://").to_owned();
    let mut output = child.stdout.take().unwrap();
    let reader = std::thread::spawn(move || {
        let mut text = String::new();
        output.read_to_string(&mut text).unwrap();
        text
    });
    // Somebody who speaks no WebSocket, somebody who says nothing, and somebody who says far too much.
    let mut other = TcpStream::connect(&place).unwrap();
    other.write_all(b"jawOpen 0.5\r\n\r\n").unwrap();
    let _silent = TcpStream::connect(&place).unwrap();
    let (mut loud, _) = tungstenite::connect(&address).unwrap();
    let _ = loud.send(Message::text("x".repeat(300_000)));
    // A page from elsewhere that is open on this computer.
    let of = |origin: &'static str| {
        let mut request = address.as_str().into_client_request().unwrap();
        request.headers_mut().insert("Origin", HeaderValue::from_static(origin));
        tungstenite::connect(request)
    };
    for origin in ["https://elsewhere.example", "null"] {
        let error = of(origin).unwrap_err();
        assert!(matches!(&error, Error::Http(response) if response.status() == 403), "{origin}: {error}");
    }
    drop(of("http://localhost:8000").unwrap());
    // One that was named.
    let (mut page, _) = of("https://example.org").unwrap();
    let start = Instant::now();
    for frame in 0..150 {
        std::thread::sleep(Duration::from_secs_f64(f64::from(frame) / 60.0).saturating_sub(start.elapsed()));
        let mut face = Frame::at(Some(f64::from(frame) / 60.0));
        face.set_named("head.turn", 20.0 * (f64::from(frame) / 20.0).sin() as f32);
        let mut line = Vec::new();
        mediapipe_line(&face, &mut line);
        page.send(Message::text(String::from_utf8(line).unwrap())).unwrap();
    }
    page.close(None).unwrap();
    let mut rest = String::new();
    errors.read_to_string(&mut rest).unwrap();
    assert!(child.wait().unwrap().success(), "{rest}");
    assert!(rest.contains("150 received, 0 lost"), "{rest}");
    assert!(
        rest.contains("https://elsewhere.example: --page https://elsewhere.example lets it in"),
        "{rest}"
    );
    assert!(rest.contains("found a file or a frame without an address"), "{rest}");
    let turn = column(&reader.join().unwrap(), "head.turn");
    assert!(turn.iter().any(|turn| *turn > 15.0) && turn.iter().any(|turn| *turn < -15.0));
    assert!(turn[240].abs() < 3.0, "{}", turn[240]);
}

#[test]
fn mistakes_are_told() {
    let told = |options: &[&str]| finish_soon(viewer().arg("live").arg(golden_pack()).args(options));
    let run = told(&["--headless", "--listen", "livelink:0"]);
    assert!(run.status == 2 && run.stderr.contains("expected --seconds"), "{run:?}");
    let run = told(&["--headless", "--listen", "livelnk"]);
    assert!(
        run.status == 2 && run.stderr.contains("expected livelink, vmc, ifacialmocap or mediapipe"),
        "{run:?}"
    );
    let run = told(&["--headless", "--seconds", "1", "--play", "nowhere.csv"]);
    assert!(run.status == 1 && run.stderr.contains("nowhere.csv: expected"), "{run:?}");
    let socket = UdpSocket::bind("127.0.0.1:0").unwrap();
    let taken = format!("vmc:{}", socket.local_addr().unwrap().port());
    let run = told(&["--headless", "--seconds", "1", "--listen", &taken]);
    assert!(
        run.status == 1 && run.stderr.contains("listening to vmc: expected a free port at 127.0.0.1:"),
        "{run:?}"
    );
}
