//! A real recording: three seconds of a phone's packets, and the values that another program decoded.

use avatar_live::{LiveLink, Protocol, Receiver, Settings, read_table, write_table_header, write_table_row};
use std::io::Read;
use std::path::{Path, PathBuf};

fn shared(name: &str) -> Option<PathBuf> {
    let path =
        Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data/livelink-recording").join(name);
    if path.exists() {
        return Some(path);
    }
    let required = std::env::var_os("MIMIK_REQUIRE_DATA").is_some_and(|value| value == "1");
    assert!(!required, "expected data in {} (MIMIK_REQUIRE_DATA=1), found none", path.display());
    let skipped = format_args!("SKIPPED: {} is not there\n", path.display());
    let _ = std::io::Write::write_fmt(&mut std::io::stderr(), skipped);
    None
}

/// The packets of a take: behind gzip a version, a count, and each packet behind its length.
fn packets(path: &Path) -> Vec<Vec<u8>> {
    let mut bytes = Vec::new();
    flate2::read::GzDecoder::new(std::fs::File::open(path).unwrap()).read_to_end(&mut bytes).unwrap();
    let number = |at: usize| u32::from_be_bytes(bytes[at..at + 4].try_into().unwrap()) as usize;
    assert_eq!((bytes[0], number(1)), (6, 180));
    let (mut packets, mut at) = (Vec::new(), 5);
    while at < bytes.len() {
        let length = number(at);
        packets.push(bytes[at + 4..at + 4 + length].to_vec());
        at += 4 + length;
    }
    packets
}

#[test]
fn packets_are_the_table_to_the_last_digit() {
    let (Some(take), Some(table)) = (shared("dao.gesichter"), shared("dao.csv")) else { return };
    let packets = packets(&take);
    let mut written = Vec::new();
    write_table_header(&mut written);
    let mut again = Vec::new();
    for packet in &packets {
        let read = LiveLink::decode(packet).unwrap();
        assert_eq!((read.device, read.subject), ("DEADC0DE-1337-1337-1337-CAFEBABE", "LLV Default Device"));
        write_table_row(&read.time.unwrap(), &read.values.unwrap(), &mut written);
        again.clear();
        read.encode(&mut again);
        assert_eq!(&again, packet);
    }
    let expected = std::fs::read_to_string(table).unwrap();
    let written = String::from_utf8(written).unwrap();
    assert_eq!(packets.len(), 180);
    for (ours, theirs) in written.lines().zip(expected.lines()) {
        assert_eq!(ours, theirs);
    }
    assert_eq!(written.lines().count(), expected.lines().count());
    // And a table that was written is read as the frames of the packets.
    let frames = read_table(&written).unwrap();
    assert_eq!(frames.len(), packets.len());
    for (frame, packet) in frames.iter().zip(&packets) {
        let other = LiveLink::decode(packet).unwrap().frame();
        for (channel, value) in frame.iter() {
            let difference = (value - other.get(channel).unwrap()).abs();
            assert!(difference < 1e-5, "channel {channel}: {value} {other:?}");
        }
    }
}

#[test]
fn lost_frames_are_seen_as_lost() {
    let Some(take) = shared("dao.gesichter") else { return };
    let mut receiver = Receiver::new(Settings::default());
    let packets = packets(&take);
    let secs = |packet: &[u8]| LiveLink::decode(packet).unwrap().time.unwrap().secs().unwrap();
    let first = secs(&packets[0]);
    for packet in &packets {
        let now_secs = secs(packet) - first;
        receiver.receive(now_secs, ([127, 0, 0, 1], 1).into(), Protocol::LiveLink, packet).unwrap();
        receiver.advance(now_secs);
    }
    let status = receiver.senders().next().unwrap();
    // 5,375,741 to 5,375,747 are missing.
    assert_eq!((status.name, status.received, status.lost), ("LLV Default Device", 180, 7));
    assert_eq!((status.duplicates, status.reordered, status.late), (0, 0, 0));
    assert!((status.rate_hz - 60.0).abs() < 1.0, "{status:?}");
    assert!(status.drift_ppm.abs() < 1.0, "{status:?}");
}

/// The eyes' angles in Live Link Face go against what `EyeLook…` say: out less in, and up less down.
#[test]
fn eyes_turn_as_their_shapes_say() {
    let Some(take) = shared("dao.gesichter") else { return };
    let values: Vec<_> = (packets(&take).iter())
        .filter_map(|packet| LiveLink::decode(packet).unwrap().values)
        .map(|values| values.map(f64::from))
        .collect();
    assert!(values.len() > 100);
    // The left eye's yaw and pitch.
    for (angle, more, less) in [(55, 3, 2), (56, 4, 1)] {
        let pairs: Vec<_> =
            values.iter().map(|values| [values[angle], values[more] - values[less]]).collect();
        let mean = |at: usize| pairs.iter().map(|pair| pair[at]).sum::<f64>() / pairs.len() as f64;
        let means = [mean(0), mean(1)];
        let sum = |a: usize, b: usize| {
            pairs.iter().map(|pair| (pair[a] - means[a]) * (pair[b] - means[b])).sum::<f64>()
        };
        let correlation = sum(0, 1) / (sum(0, 0) * sum(1, 1)).sqrt();
        assert!(correlation < -0.999, "{angle}: {correlation}");
    }
}
