//! Ten thousand random frames through every codec.

use crate::chance::Chance;
use avatar_live::{
    Arg, Frame, FrameTime, IFacialMocap, LiveLink, MediaPipe, MediaPipeReader, OscWriter, Separator, Vmc,
    VmcSender, mediapipe_line, read_osc,
};

const FRAMES: usize = 10_000;

fn near(a: &Frame, b: &Frame, bound: f32) {
    for (channel, value) in a.iter() {
        let other = b.get(channel).unwrap_or_else(|| panic!("channel {channel}: {b:?}"));
        assert!((value - other).abs() <= bound, "channel {channel}: {value} {other}");
    }
    assert_eq!(a.iter().count(), b.iter().count());
}

#[test]
fn live_link() {
    let (mut chance, mut packet) = (Chance::new(1), Vec::new());
    for frame in 0..FRAMES {
        let face = chance.frame();
        let time = FrameTime {
            frame: frame as i32 - 50,
            part: chance.share() as f32,
            numerator: 60,
            denominator: 1,
        };
        let values = LiveLink::values_of(&face);
        let sent = LiveLink { device: "Gerät", subject: "я", time: Some(time), values: Some(values) };
        packet.clear();
        sent.encode(&mut packet);
        let read = LiveLink::decode(&packet).unwrap();
        assert_eq!(read, sent);
        near(&face, &read.frame(), 1e-4);
    }
}

#[test]
fn vmc() {
    let (mut chance, mut sender, mut vmc) = (Chance::new(2), VmcSender::default(), Vmc::default());
    for frame in 0..FRAMES {
        let face = chance.frame();
        let secs = frame as f64 / 64.0;
        let mut read = None;
        let mut packets = 0;
        sender.send(&face, secs, &mut |packet| {
            assert!(packet.len() <= 1400);
            assert!(read.is_none(), "only the last packet is the end of a frame");
            read = vmc.read(packet).unwrap().0;
            packets += 1;
        });
        let read = read.unwrap();
        assert_eq!((read.time_secs, packets), (Some(secs), 3));
        // Weights as they were; angles through quaternions of 32 bits.
        near(&face, &read, 2e-3);
        for (channel, value) in face.iter().take(52) {
            assert_eq!(read.get(channel), Some(value));
        }
    }
}

#[test]
fn ifacialmocap() {
    let (mut chance, mut text) = (Chance::new(3), Vec::new());
    for frame in 0..FRAMES {
        let mut face = chance.frame();
        let separator = if frame % 2 == 0 { Separator::Minus } else { Separator::Ampersand };
        for channel in 0..52 {
            // It sends whole percent.
            face.set(channel, (face.get(channel).unwrap() * 100.0).round() / 100.0);
        }
        text.clear();
        IFacialMocap::encode(&face, separator, &mut text);
        assert_eq!(IFacialMocap::decode(&text).unwrap(), face);
    }
}

#[test]
fn mediapipe() {
    let (mut chance, mut line) = (Chance::new(4), Vec::new());
    let mut reader = MediaPipeReader::default();
    for frame in 0..FRAMES {
        let whole = chance.frame();
        let mut face = Frame::at(Some(frame as f64 / 32.0));
        // The eyes have no angles of their own there.
        whole.iter().take(55).for_each(|(channel, value)| face.set(channel, value));
        line.clear();
        mediapipe_line(&face, &mut line);
        let read = MediaPipe::decode(&line).unwrap();
        assert_eq!(reader.read(&line).unwrap(), read);
        assert_eq!(read.time_secs, face.time_secs);
        near(&face, &read, 1e-4);
        for (channel, value) in face.iter().take(52) {
            assert_eq!(read.get(channel), Some(value));
        }
    }
}

#[test]
fn open_sound_control() {
    let mut chance = Chance::new(5);
    for _ in 0..FRAMES {
        let blob: Vec<u8> = (0..chance.bits() % 9).map(|_| chance.bits() as u8).collect();
        let all = [
            Arg::Int(chance.bits() as i32),
            Arg::Float(chance.share() as f32),
            Arg::Text(["", "a", "abc", "Größe"][chance.bits() as usize % 4]),
            Arg::Blob(&blob),
            Arg::Long(chance.bits() as i64),
            Arg::Double(chance.share()),
            Arg::Time(chance.bits()),
            Arg::Four(b'm', [1, 2, 3, 4]),
            Arg::Bool(true),
            Arg::Bool(false),
            Arg::Mark(b'N'),
        ];
        let count = chance.bits() as usize % (all.len() + 1);
        let start = chance.bits() as usize % (count + 1);
        let mut packet = Vec::new();
        OscWriter::new(&mut packet).message("/a/b", &all[start..count]);
        assert_eq!(packet.len() % 4, 0);
        let mut read = Vec::new();
        read_osc(&packet, &mut |message| read.extend(message.args())).unwrap();
        assert_eq!(read, all[start..count]);
    }
}
