//! Once its senders are known, receiving does not allocate.

#![allow(clippy::unwrap_used, reason = "helpers of tests fail as tests do")]

use avatar_live::{
    ControlMap, Frame, FrameTime, IFacialMocap, LiveLink, Protocol, Receiver, Separator, Settings, VmcSender,
    mediapipe_line,
};
use pose_anim::ControlTable;

#[test]
fn packets_become_faces_without_allocating() {
    let controls = ControlTable::default_face();
    let mut map = ControlMap::new(&controls);
    let mut values = controls.defaults();
    for protocol in [Protocol::LiveLink, Protocol::Vmc, Protocol::IFacialMocap, Protocol::MediaPipe] {
        let mut receiver = Receiver::new(Settings { smooth_secs: Some(0.03), ..Settings::default() });
        let (mut packet, mut sender) = (Vec::with_capacity(1 << 16), VmcSender::default());
        let mut frames = 0;
        let mut run = |from: i32, to: i32| {
            for index in from..to {
                let now_secs = f64::from(index) / 60.0;
                let mut face = Frame::at(Some(now_secs));
                for channel in 0..59 {
                    face.set(channel, 0.1 + 0.01 * (index % 50) as f32);
                }
                let origin = ([127, 0, 0, 1], 1).into();
                let mut receive = |packet: &[u8]| {
                    frames += i32::from(
                        receiver.receive(now_secs, origin, protocol, packet).unwrap().frame.is_some(),
                    )
                };
                packet.clear();
                match protocol {
                    Protocol::LiveLink => {
                        let time = Some(FrameTime { frame: index, part: 0.0, numerator: 60, denominator: 1 });
                        let values = Some(LiveLink::values_of(&face));
                        LiveLink { device: "phone", subject: "Ann", time, values }.encode(&mut packet);
                        receive(&packet);
                    }
                    Protocol::Vmc => sender.send(&face, now_secs, &mut receive),
                    Protocol::IFacialMocap => {
                        IFacialMocap::encode(&face, Separator::Ampersand, &mut packet);
                        receive(&packet);
                    }
                    _ => {
                        mediapipe_line(&face, &mut packet);
                        receive(&packet);
                    }
                }
                let face = receiver.advance(now_secs);
                map.apply(face, &mut values);
                assert!(receiver.senders().len() == 1 && receiver.wakes_at().is_some());
            }
        };
        run(0, 200);
        let counted = allocation_counter::measure(|| run(200, 2000));
        assert_eq!(counted.count_total, 0, "{protocol}");
        assert_eq!(frames, 2000, "{protocol}");
    }
}
