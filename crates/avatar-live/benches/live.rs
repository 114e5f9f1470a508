//! What a packet costs, and a frame.

#![allow(missing_docs, clippy::unwrap_used, reason = "a program")]

use avatar_live::{
    ControlMap, Frame, FrameTime, IFacialMocap, LiveLink, MediaPipe, Protocol, Receiver, Separator, Settings,
    Vmc, VmcSender, channels, mediapipe_line,
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

#[divan::bench]
fn decode_mediapipe(bencher: Bencher<'_, '_>) {
    let mut line = Vec::new();
    mediapipe_line(&face(5), &mut line);
    bencher.bench_local(|| MediaPipe::decode(black_box(&line)).unwrap());
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
