//! What a packet costs, and a frame.

#![allow(missing_docs, clippy::unwrap_used, reason = "a program")]

use avatar_live::{
    ControlMap, Frame, FrameTime, IFacialMocap, LiveLink, MediaPipe, MediaPipeReader, Protocol, Receiver,
    Separator, Settings, Vmc, VmcSender, channels,
};
use divan::{Bencher, black_box};
use pose_anim::ControlTable;

fn main() {
    divan::main();
}

fn face(index: usize) -> Frame {
    let mut face = Frame::at(Some(index as f64 / 60.0));
    for (channel, about) in channels().iter().enumerate().take(59) {
        let share = ((index * 7 + channel * 13) % 101) as f32 / 101.0;
        face.set(channel, if about.min < 0.0 { share * 20.0 - 10.0 } else { share });
    }
    face
}

fn live_link(index: usize) -> Vec<u8> {
    let mut packet = Vec::new();
    let time = Some(FrameTime { frame: index as i32, part: 0.0, numerator: 60, denominator: 1 });
    let values = Some(LiveLink::values_of(&face(index)));
    LiveLink { device: "DEADC0DE-1337-1337-1337-CAFEBABE0001", subject: "iPhone", time, values }
        .encode(&mut packet);
    packet
}

#[divan::bench]
fn decode_live_link(bencher: Bencher<'_, '_>) {
    let packet = live_link(5);
    bencher.bench_local(|| LiveLink::decode(black_box(&packet)).unwrap().frame());
}

/// All packets of a frame: three.
#[divan::bench]
fn decode_vmc_frame(bencher: Bencher<'_, '_>) {
    let (mut packets, mut vmc) = (Vec::new(), Vmc::default());
    VmcSender::default().send(&face(5), 1.0, &mut |packet| packets.push(packet.to_vec()));
    bencher
        .bench_local(|| packets.iter().filter_map(|packet| vmc.read(black_box(packet)).unwrap().0).count());
}

#[divan::bench]
fn decode_ifacialmocap(bencher: Bencher<'_, '_>) {
    let mut packet = Vec::new();
    IFacialMocap::encode(&face(5), Separator::Minus, &mut packet);
    bencher.bench_local(|| IFacialMocap::decode(black_box(&packet)).unwrap());
}

/// Lines as a browser writes them: numbers of 32 bits with the digits of 64.
fn mediapipe(index: usize) -> String {
    let face = face(index);
    let categories = channels().iter().take(52).enumerate().map(|(channel, about)| {
        let score = f64::from(face.get(channel).unwrap());
        let (number, name) = (channel + 1, about.name);
        format!(r#"{{"index":{number},"score":{score},"categoryName":"{name}","displayName":""}}"#)
    });
    let categories = categories.collect::<Vec<_>>().join(",");
    let (sin, cos) = (0.01 * index as f32).sin_cos();
    let rows =
        [cos, 0.0, -sin, 0.0, 0.0, 1.0, 0.0, 0.0, sin, 0.0, cos, 0.0, 0.3 * sin, 3.1 * cos, -41.7, 1.0];
    let rows = rows.map(|number| f64::from(number).to_string()).join(",");
    format!(
        r#"{{"faceBlendshapes":[{{"categories":[{categories}],"headIndex":-1,"headName":""}}],"facialTransformationMatrixes":[{{"rows":4,"columns":4,"data":[{rows}]}}],"timestampMs":{}}}"#,
        index as f64 * 16.7
    )
}

/// A line that is read for itself, as the first one of a sender is.
#[divan::bench]
fn decode_mediapipe_first(bencher: Bencher<'_, '_>) {
    let line = mediapipe(5);
    bencher.bench_local(|| MediaPipe::decode(black_box(line.as_bytes())).unwrap());
}

/// Lines of one sender, each with other numbers.
#[divan::bench]
fn decode_mediapipe(bencher: Bencher<'_, '_>) {
    let lines: Vec<_> = (0..16).map(mediapipe).collect();
    let (mut reader, mut index) = (MediaPipeReader::default(), 0);
    bencher.bench_local(|| {
        index = (index + 1) % lines.len();
        reader.read(black_box(lines[index].as_bytes())).unwrap()
    });
}

/// A packet of Live Link Face from its bytes to the values of the default face's controls, with smoothing.
#[divan::bench]
fn packet_to_controls(bencher: Bencher<'_, '_>) {
    let controls = ControlTable::default_face();
    let mut map = ControlMap::new(&controls);
    let mut values = controls.defaults();
    let mut receiver = Receiver::new(Settings { smooth_secs: Some(0.03), ..Settings::default() });
    let packets: Vec<_> = (0..10_000).map(live_link).collect();
    let mut index = 0;
    bencher.bench_local(|| {
        let now_secs = index as f64 / 60.0;
        if let Some(packet) = packets.get(index % packets.len()) {
            let origin = ([127, 0, 0, 1], 1).into();
            let _ = black_box(receiver.receive(now_secs, origin, Protocol::LiveLink, packet));
        }
        map.apply(receiver.advance(now_secs), &mut values);
        index += 1;
        black_box(&values);
    });
}

#[divan::bench]
fn encode_vmc_frame(bencher: Bencher<'_, '_>) {
    let (face, mut sender, mut bytes) = (face(5), VmcSender::default(), 0);
    bencher.bench_local(|| sender.send(black_box(&face), 1.0, &mut |packet| bytes += packet.len()));
    black_box(bytes);
}
