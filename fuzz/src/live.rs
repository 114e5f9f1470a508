use avatar_live::{
    Calibration, ControlMap, Frame, IFacialMocap, LiveLink, MediaPipe, MediaPipeReader, Protocol, Receiver,
    Separator, Settings, Vmc, VmcSender, mediapipe_line, read_osc, read_table,
};
use pose_anim::ControlTable;

/// What the first byte of an input says of the rest.
const PROTOCOLS: [Protocol; 4] =
    [Protocol::LiveLink, Protocol::Vmc, Protocol::IFacialMocap, Protocol::MediaPipe];

/// Packets of tracking programs, each behind its length in two bytes (the last one has what is left): every
/// decoder reads each of them, and a session of its own for each protocol goes on with them. What is read is
/// written and read again; the face stays within the ranges of its channels and of the controls.
pub fn live(data: &[u8]) {
    let controls = ControlTable::default_face();
    let mut map = ControlMap::new(&controls);
    let mut values = controls.defaults();
    for protocol in PROTOCOLS {
        let mut receiver = Receiver::new(Settings { smooth_secs: Some(0.03), ..Settings::default() });
        let (mut rest, mut now_secs) = (data, 0.0);
        let mut packets = 0;
        while let [high, low, after @ ..] = rest
            && packets < 64
        {
            packets += 1;
            let length = usize::from(u16::from_be_bytes([*high, *low])).min(after.len());
            let (packet, further) = after.split_at(length);
            rest = further;
            // Times depend on the bytes, too: from at once to a second and a half.
            now_secs += f64::from(*low) / 170.0;
            let origin = ([127, 0, 0, 1], u16::from(*low % 3)).into();
            let _ = receiver.receive(now_secs, origin, protocol, packet);
            let face = *receiver.advance(now_secs);
            check(&face);
            map.apply(&face, &mut values);
            for (value, control) in values.iter().zip(controls.controls()) {
                assert!((control.min..=control.max).contains(value), "{}: {value}", control.name);
            }
            receiver.set_mirrored(low % 5 == 0);
            if low % 7 == 0 {
                receiver.calibrate();
            }
            assert!(receiver.senders().len() <= 8);
            assert!(receiver.wakes_at().is_none_or(f64::is_finite));
        }
    }
    again(data);
    if let Ok(text) = std::str::from_utf8(data) {
        let _ = read_table(text).map(|frames| frames.iter().for_each(check));
        if let Ok(calibration) = Calibration::from_toml(text) {
            assert_eq!(Calibration::from_toml(&calibration.to_toml()), Ok(calibration));
        }
    }
}

fn check(frame: &Frame) {
    for (channel, value) in frame.iter() {
        let range = &avatar_live::channels()[channel];
        assert!((range.min..=range.max).contains(&value), "{}: {value}", range.name);
    }
}

/// Each decoder on the whole input; what it reads says the same when it has been written.
fn again(data: &[u8]) {
    let mut written = Vec::new();
    if let Ok(read) = LiveLink::decode(data) {
        read.encode(&mut written);
        assert_eq!(LiveLink::decode(&written), Ok(read));
        check(&read.frame());
    }
    if let Ok(frame) = IFacialMocap::decode(data) {
        check(&frame);
        written.clear();
        IFacialMocap::encode(&frame, Separator::Ampersand, &mut written);
        assert!(IFacialMocap::decode(&written).is_ok());
    }
    if let Ok(frame) = MediaPipe::decode(data) {
        check(&frame);
        written.clear();
        mediapipe_line(&frame, &mut written);
        assert!(MediaPipe::decode(&written).is_ok());
    }
    // A line says the same, whatever lines came before.
    let mut reader = MediaPipeReader::default();
    for line in data.split(|byte| *byte == b'\n').take(16) {
        assert_eq!(reader.read(line), MediaPipe::decode(line));
    }
    let mut messages = 0usize;
    let _ = read_osc(data, &mut |message| messages += 1 + message.args().count());
    assert!(messages <= data.len());
    if let Ok((Some(frame), _)) = Vmc::default().read(data) {
        check(&frame);
        let mut vmc = Vmc::default();
        VmcSender::default().send(&frame, 1.0, &mut |packet| assert!(vmc.read(packet).is_ok()));
    }
}
