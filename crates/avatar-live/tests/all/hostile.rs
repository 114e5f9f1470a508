//! Senders that mean harm, or are broken.

use crate::chance::Chance;
use avatar_live::{
    FrameTime, Gate, IFacialMocap, LiveLink, MediaPipe, MediaPipeReader, OscWriter, Protocol, Receiver,
    Refused, Separator, Settings, VmcSender, mediapipe_line, read_osc,
};

/// A good packet of each protocol.
fn good(chance: &mut Chance) -> Vec<(Protocol, Vec<u8>)> {
    let face = chance.frame();
    let time = Some(FrameTime { frame: 9, part: 0.0, numerator: 60, denominator: 1 });
    let mut packets = vec![
        (Protocol::LiveLink, Vec::new()),
        (Protocol::Vmc, Vec::new()),
        (Protocol::IFacialMocap, Vec::new()),
        (Protocol::MediaPipe, Vec::new()),
    ];
    let values = Some(LiveLink::values_of(&face));
    LiveLink { device: "phone", subject: "Ann", time, values }.encode(&mut packets[0].1);
    VmcSender::default().send(&face, 1.0, &mut |packet| packets[1].1 = packet.to_vec());
    IFacialMocap::encode(&face, Separator::Minus, &mut packets[2].1);
    mediapipe_line(&face, &mut packets[3].1);
    packets
}

#[test]
fn changed_packets_do_no_harm() {
    let mut chance = Chance::new(7);
    let mut receiver = Receiver::new(Settings::default());
    let mut read = 0;
    for round in 0..3000 {
        for (protocol, mut packet) in good(&mut chance) {
            for _ in 0..=chance.bits() % 4 {
                let at = chance.bits() as usize % packet.len();
                match chance.bits() % 3 {
                    0 => packet[at] = chance.bits() as u8,
                    1 => packet.truncate(at.max(1)),
                    _ => packet.insert(at, chance.bits() as u8),
                }
            }
            let origin = ([10, 0, 0, (round % 9) as u8], 9).into();
            let now_secs = f64::from(round) / 30.0;
            read += i32::from(receiver.receive(now_secs, origin, protocol, &packet).is_ok());
            let face = receiver.advance(now_secs);
            assert!(face.iter().all(|(_, value)| value.is_finite()));
        }
    }
    // The test would say nothing if all were refused, or none.
    assert!((500..11_000).contains(&read), "{read}");
    assert!(receiver.senders().len() <= 8);
}

#[test]
fn deep_bundles_and_long_packets_are_refused() {
    let mut packet = Vec::new();
    for depth in 0..3000usize {
        OscWriter::new(&mut packet).bundle(1);
        packet.extend((60_000 - 20 * depth as u32 - 20).to_be_bytes());
    }
    packet.resize(60_000, 0);
    let error = read_osc(&packet, &mut |_| {}).unwrap_err().to_string();
    assert!(error.contains("nested at most eight deep"), "{error}");
    let mut receiver = Receiver::new(Settings::default());
    let origin = ([127, 0, 0, 1], 9).into();
    let result = receiver.receive(0.0, origin, Protocol::Vmc, &packet);
    assert_eq!(result, Err(Refused::TooLong { limit: 16 * 1024, found: 60_000 }));
    let deep = [b"[".repeat(100_000), b"]".repeat(100_000)].concat();
    assert!(MediaPipe::decode(&deep).is_err());
    let line = [br#"{"faceBlendshapes":"#.to_vec(), deep].concat();
    assert!(MediaPipe::decode(&line).is_err());
}

/// Whatever lines a sender has sent before, the next one says what it says for itself.
#[test]
fn a_line_does_not_depend_on_the_lines_before_it() {
    let mut chance = Chance::new(11);
    let mut lines = Vec::new();
    for index in 0..4 {
        let mut face = chance.frame();
        face.time_secs = (index % 2 == 0).then_some(0.25 * f64::from(index));
        let mut line = Vec::new();
        mediapipe_line(&face, &mut line);
        lines.push(line);
    }
    for line in [
        r#"{"faceLandmarks":[[{"x":0.51,"y":0.5,"z":-0.01}]],"faceBlendshapes":[{"categories":[{"index":1,"score":0.25,"categoryName":"jawOpen","displayName":"\"1.5\\"},{"score":1e-3,"categoryName":"_neutral"}]},{"categories":[{"score":0.5,"categoryName":"jawLeft"}]}],"facialTransformationMatrixes":[{"rows":4,"columns":4,"data":[1,0,0,0,0,1,0,0,0,0,1,0,1.5,2.5,-40,1]}],"timestampMs":40.25}"#,
        r#"{"timestamp_ms":40,"face_blendshapes":[[{"score":0.25,"category_name":"jawOpen","score":0.75}]],"facial_transformation_matrixes":[[[1,0,0,1.5],[0,1,0,2.5],[0,0,1,-40],[0,0,0,1]]]}"#,
        r#"{"timestampMs":7,"facialTransformationMatrixes":[[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1]],"timestampMs":null,"facialTransformationMatrixes":[[0,0,1,0,0,1,0,0,-1,0,0,0,0,0,0,1]],"timestampMs":9}"#,
        r#"{"faceBlendshapes":[],"number":1e999,"text":"\ud800"}"#,
    ] {
        lines.push(line.as_bytes().to_vec());
    }
    let mut reader = MediaPipeReader::default();
    let mut read = 0;
    for line in &lines {
        for _ in 0..4000 {
            let mut changed = line.clone();
            // Digits for digits mostly, so that the words stay as they are; now and then anything.
            for _ in 0..chance.bits() % 4 {
                let at = chance.bits() as usize % changed.len();
                let byte = &mut changed[at];
                match (byte.is_ascii_digit(), chance.bits() % 8) {
                    (true, 1..) => *byte = b"0123456789"[chance.bits() as usize % 10],
                    (_, 0) => *byte = chance.bits() as u8,
                    _ => {}
                }
            }
            if chance.bits().is_multiple_of(16) {
                let at = chance.bits() as usize % changed.len();
                changed.splice(at..at, *b"0.5");
            }
            let expected = MediaPipe::decode(&changed);
            read += u32::from(expected.is_ok());
            assert_eq!(reader.read(&changed), expected, "{}", String::from_utf8_lossy(&changed));
        }
    }
    assert!(read > 16_000, "{read}");
}

#[test]
fn a_flood_costs_a_bounded_share_and_who_is_heard_stays() {
    let mut gate = Gate::default();
    let (flood, phone) = (([10, 0, 0, 1], 7).into(), ([10, 0, 0, 2], 7).into());
    let (mut flooded, mut heard) = (0, 0);
    // Ten seconds of 100,000 packets a second, and 60 a second from a phone.
    for index in 0..1_000_000 {
        let now_secs = f64::from(index) / 100_000.0;
        flooded += i32::from(gate.admits(now_secs, flood, 320));
        if index % 1666 == 0 {
            heard += i32::from(gate.admits(now_secs, phone, 320));
        }
    }
    assert_eq!(heard, 601);
    // 4 MB a second and 1 MB at once, at 420 bytes for each.
    assert!((95_000..98_000).contains(&flooded), "{flooded}");
    // Other addresses find no place, but those that are silent give up theirs.
    let mut places = 0;
    for port in 0..1000 {
        places += i32::from(gate.admits(10.0, ([10, 0, 0, 3], port).into(), 320));
    }
    assert_eq!(places, 14);
    assert!(gate.admits(10.1, phone, 320));
    assert!(gate.admits(15.2, ([10, 0, 0, 4], 1).into(), 320));
}

#[test]
fn many_names_do_not_push_out_who_is_heard() {
    let mut receiver = Receiver::new(Settings::default());
    let mut chance = Chance::new(3);
    let values = Some(LiveLink::values_of(&chance.frame()));
    let mut packet = Vec::new();
    let mut refused = 0;
    let counted = allocation_counter::measure(|| {
        for index in 0..2000 {
            let now_secs = f64::from(index) / 60.0;
            let time = Some(FrameTime { frame: index, part: 0.0, numerator: 60, denominator: 1 });
            for name in ["Ann", &format!("nobody\x1b[2J {index}")] {
                packet.clear();
                LiveLink { device: "phone", subject: name, time, values }.encode(&mut packet);
                let result =
                    receiver.receive(now_secs, ([127, 0, 0, 1], 1).into(), Protocol::LiveLink, &packet);
                refused += i32::from(result == Err(Refused::TooManySenders));
            }
            receiver.advance(now_secs);
        }
    });
    assert!(refused > 1900, "{refused}");
    let ann = receiver.senders().next().unwrap();
    assert_eq!((ann.name, ann.is_chosen, ann.received, ann.lost), ("Ann", true, 2000, 0));
    assert!(receiver.senders().all(|sender| !sender.name.contains('\x1b')));
    assert!(counted.bytes_max < 1_000_000, "{counted:?}");
}
