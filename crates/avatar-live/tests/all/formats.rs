//! Examples that stand in the documents of the formats.

use avatar_live::{
    Arg, Found, FrameTime, IFacialMocap, LiveLink, MediaPipe, OscWriter, Vmc, channels, read_osc,
};

fn hex(text: &str) -> Vec<u8> {
    let digits: Vec<u8> = text
        .bytes()
        .filter(u8::is_ascii_hexdigit)
        .map(|digit| (digit as char).to_digit(16).unwrap() as u8)
        .collect();
    digits.chunks(2).map(|pair| pair[0] * 16 + pair[1]).collect()
}

/// Both messages of the page "OSC Message Examples" in the specification of Open Sound Control 1.0.
#[test]
fn open_sound_controls_own_examples() {
    let frequency = hex("2f6f7363 696c6c61 746f722f 342f6672 65717565 6e637900 2c660000 43dc0000");
    let foo =
        hex("2f666f6f 00000000 2c696973 66660000 000003e8 ffffffff 68656c6c 6f000000 3f9df3b6 40b5b22d");
    let mut seen = Vec::new();
    for packet in [&frequency, &foo] {
        read_osc(packet, &mut |message| seen.push((message.address, message.args().collect::<Vec<_>>())))
            .unwrap();
    }
    let arguments =
        vec![Arg::Int(1000), Arg::Int(-1), Arg::Text("hello"), Arg::Float(1.234), Arg::Float(5.678)];
    assert_eq!(seen, [("/oscillator/4/frequency", vec![Arg::Float(440.0)]), ("/foo", arguments.clone())]);
    let mut written = Vec::new();
    OscWriter::new(&mut written).message("/oscillator/4/frequency", &[Arg::Float(440.0)]);
    assert_eq!(written, frequency);
    written.clear();
    OscWriter::new(&mut written).message("/foo", &arguments);
    assert_eq!(written, foo);
}

#[test]
fn bundles_have_times_and_nest() {
    let mut packet = Vec::new();
    let mut writer = OscWriter::new(&mut packet);
    writer.bundle(1);
    writer.element(|out| out.message("/jawOpen", &[Arg::Float(0.25)]));
    writer.element(|out| {
        out.bundle(3 << 32 | 1 << 31);
        out.element(|out| out.message("/a/tongueOut", &[Arg::Int(1)]));
    });
    let mut seen = Vec::new();
    read_osc(&packet, &mut |message| seen.push((message.address, message.time))).unwrap();
    assert_eq!(seen, [("/jawOpen", None), ("/a/tongueOut", Some(3 << 32 | 1 << 31))]);
    let (frame, understood) = Vmc::default().read(&packet).unwrap();
    let frame = frame.unwrap();
    assert_eq!((understood, frame.time_secs), (2, Some(3.5)));
    assert_eq!((frame.named("jawOpen"), frame.named("tongueOut")), (Some(0.25), Some(1.0)));
}

/// The text on <https://www.ifacialmocap.com/for-developer/>.
const IFACIALMOCAP: &str = "mouthSmile_R-0|eyeLookOut_L-0|mouthUpperUp_L-11|eyeWide_R-0|mouthClose-8|mouthPucker-4|mouthRollLower-9|eyeBlink_R-7|eyeLookDown_L-17|cheekSquint_R-11|eyeBlink_L-7|tongueOut-0|jawRight-0|eyeLookIn_R-6|cheekSquint_L-11|mouthDimple_L-10|mouthPress_L-4|eyeSquint_L-11|mouthRight-0|mouthShrugLower-9|eyeLookUp_R-0|eyeLookOut_R-0|mouthPress_R-5|cheekPuff-2|jawForward-11|mouthLowerDown_L-9|mouthFrown_L-6|mouthShrugUpper-26|browOuterUp_L-4|browInnerUp-20|mouthDimple_R-10|browDown_R-0|mouthUpperUp_R-10|mouthRollUpper-8|mouthFunnel-12|mouthStretch_R-21|mouthFrown_R-13|eyeLookDown_R-17|jawOpen-12|jawLeft-0|browDown_L-0|mouthSmile_L-0|noseSneer_R-18|mouthLowerDown_R-8|noseSneer_L-21|eyeWide_L-0|mouthStretch_L-21|browOuterUp_R-4|eyeLookIn_L-4|eyeSquint_R-11|eyeLookUp_L-0|mouthLeft-1|=head#-21.488958,-6.038993,-6.6019735,-0.030653415,-0.10287084,-0.6584072|rightEye#6.0297494,2.4403017,0.25649446|leftEye#6.034903,-1.6660284,-0.17520553|";

/// That of Facemotion3d's page, which separates as iFacialMocap's second version does; shortened.
const FACEMOTION3D: &str = "eyeLookOutLeft&3|mouthPressRight&14|jawForward&8|browInnerUp&19|FM_SAD&0|=head#-22.167973,0.45402408,-4.8798294,-0.039975993,-0.048437987,-0.45562273|rightEye#12.759762,5.527712,1.2244859|leftEye#12.862795,1.264116,0.28145725|";

#[test]
fn ifacialmocaps_own_examples() {
    let frame = IFacialMocap::decode(IFACIALMOCAP.as_bytes()).unwrap();
    // All shapes, three angles of the head and two of each eye.
    assert_eq!(frame.iter().count(), 52 + 3 + 4);
    for (name, value) in
        [("mouthUpperUpLeft", 0.11), ("noseSneerRight", 0.18), ("jawOpen", 0.12), ("mouthLeft", 0.01)]
    {
        assert_eq!(frame.named(name), Some(value), "{name}");
    }
    assert_eq!(frame.named("head.bow"), Some(-21.488958));
    assert_eq!(frame.named("head.turn"), Some(-6.038993));
    assert_eq!(frame.named("head.bend"), Some(6.6019735));
    // The shapes say the same of the eyes: both look down, and inward.
    assert!(frame.named("eyeLookDownLeft") > Some(0.1) && frame.named("eye.left.ud") == Some(-6.034903));
    assert!(frame.named("eyeLookInLeft") > Some(0.0) && frame.named("eye.left.lr") < Some(-1.0));
    assert!(frame.named("eyeLookInRight") > Some(0.0) && frame.named("eye.right.lr") > Some(1.0));

    let frame = IFacialMocap::decode(FACEMOTION3D.as_bytes()).unwrap();
    assert_eq!((frame.named("eyeLookOutLeft"), frame.named("mouthPressRight")), (Some(0.03), Some(0.14)));
    assert_eq!(frame.iter().count(), 4 + 3 + 4);
    let lost = IFacialMocap::decode(b"trackingStatus-0|jawOpen-12|").unwrap();
    assert!(!lost.is_tracked);
}

#[test]
fn mediapipe_in_the_words_of_javascript_and_python() {
    // A quarter turn to the left: column by column, and row by row.
    let javascript = br#"{"faceLandmarks":[[{"x":0.5,"y":0.5,"z":-0.01,"visibility":0}]],"faceBlendshapes":[{"categories":[{"index":0,"score":3.9e-7,"categoryName":"_neutral","displayName":""},{"index":25,"score":0.25,"categoryName":"jawOpen","displayName":""}],"headIndex":-1,"headName":""}],"facialTransformationMatrixes":[{"rows":4,"columns":4,"data":[0.7071068,0,-0.7071068,0,0,1,0,0,0.7071068,0,0.7071068,0,1.5,2.5,-40,1]}]}"#;
    let python = br#"{"timestamp_ms": 40, "face_blendshapes": [[{"index": 25, "score": 0.25, "display_name": "", "category_name": "jawOpen"}]], "facial_transformation_matrixes": [[[0.7071068, 0, 0.7071068, 1.5], [0, 1, 0, 2.5], [-0.7071068, 0, 0.7071068, -40], [0, 0, 0, 1]]]}"#;
    for line in [&javascript[..], python] {
        let frame = MediaPipe::decode(line).unwrap();
        assert_eq!((frame.is_tracked, frame.named("jawOpen")), (true, Some(0.25)));
        assert!((frame.named("head.turn").unwrap() - 45.0).abs() < 1e-3);
        assert!(
            frame.named("head.bow").unwrap().abs() < 1e-3 && frame.named("head.bend").unwrap().abs() < 1e-3
        );
    }
    assert_eq!(MediaPipe::decode(python).unwrap().time_secs, Some(0.04));
    let nobody = br#"{"faceLandmarks":[],"faceBlendshapes":[],"facialTransformationMatrixes":[]}"#;
    assert!(!MediaPipe::decode(nobody).unwrap().is_tracked);
}

/// By the tables of <https://protocol.vmc.info/marionette-spec>, in a packet as a performer bundles it.
#[test]
fn a_frame_of_vmc() {
    let mut packet = Vec::new();
    let mut writer = OscWriter::new(&mut packet);
    writer.bundle(1);
    let bone = |name, [x, y, z, w]: [f32; 4]| {
        [
            Arg::Text(name),
            Arg::Float(0.0),
            Arg::Float(0.1),
            Arg::Float(0.0),
            Arg::Float(x),
            Arg::Float(y),
            Arg::Float(z),
            Arg::Float(w),
        ]
    };
    writer.element(|out| out.message("/VMC/Ext/OK", &[Arg::Int(1), Arg::Int(3), Arg::Int(0)]));
    writer.element(|out| out.message("/VMC/Ext/T", &[Arg::Float(12.5)]));
    // In Unity's left-handed frame, +Y turns an avatar that looks along +Z to its right.
    let (sin, cos) = 10f32.to_radians().sin_cos();
    writer.element(|out| out.message("/VMC/Ext/Bone/Pos", &bone("Head", [0.0, sin, 0.0, cos])));
    writer.element(|out| out.message("/VMC/Ext/Bone/Pos", &bone("Hips", [0.0, 0.0, 0.0, 1.0])));
    for (name, value) in [("Joy", 0.5), ("Blink_L", 1.0), ("browInnerUp", 0.25), ("ears", 1.0)] {
        writer.element(|out| out.message("/VMC/Ext/Blend/Val", &[Arg::Text(name), Arg::Float(value)]));
    }
    writer.element(|out| out.message("/VMC/Ext/Blend/Apply", &[]));
    let (frame, understood) = Vmc::default().read(&packet).unwrap();
    let frame = frame.unwrap();
    assert_eq!((understood, frame.time_secs), (7, Some(12.5)));
    assert_eq!(frame.named("happy"), Some(0.5));
    assert_eq!(frame.named("blinkLeft"), Some(1.0));
    assert_eq!(frame.named("browInnerUp"), Some(0.25));
    assert!((frame.named("head.turn").unwrap() + 20.0).abs() < 1e-3, "{frame:?}");
}

#[test]
fn packets_of_live_link_without_a_face() {
    let time = FrameTime { frame: 5, part: 0.5, numerator: 30, denominator: 1 };
    let whole = LiveLink { device: "d", subject: "s", time: Some(time), values: Some([0.5; 61]) };
    assert_eq!(time.secs(), Some(5.5 / 30.0));
    for (read, length) in [
        (LiveLink { time: None, values: None, ..whole }, 1 + 5 + 5),
        (LiveLink { values: None, ..whole }, 1 + 5 + 5 + 16 + 1),
        (whole, 1 + 5 + 5 + 16 + 1 + 61 * 4),
    ] {
        let mut packet = Vec::new();
        read.encode(&mut packet);
        assert_eq!(packet.len(), length);
        assert_eq!(LiveLink::decode(&packet), Ok(read));
        assert_eq!(read.frame().is_tracked, read.values.is_some());
    }
    let mut packet = Vec::new();
    LiveLink { values: None, ..whole }.encode(&mut packet);
    packet.pop();
    assert_eq!(LiveLink::decode(&packet).map(|read| (read.time, read.values)), Ok((Some(time), None)));
}

#[test]
fn mistakes_have_places() {
    let time = FrameTime { frame: 5, part: 0.5, numerator: 30, denominator: 1 };
    let mut packet = Vec::new();
    LiveLink { device: "d", subject: "s", time: Some(time), values: Some([0.5; 61]) }.encode(&mut packet);
    let live_link = |at: usize, byte: u8| {
        let mut packet = packet.clone();
        packet[at] = byte;
        LiveLink::decode(&packet).unwrap_err().to_string()
    };
    assert_eq!(live_link(0, 7), "byte 0: expected version 6 of Live Link Face, found 7");
    assert_eq!(live_link(1, 1), "byte 1: expected the id of a device of at most 256 bytes, found 16777217");
    assert_eq!(live_link(10, 0xff), "byte 10: expected a text in UTF-8, found the byte 0xff");
    assert_eq!(live_link(27, 60), "byte 27: expected 61 values, or 0, found 60");
    let mut infinite = packet.clone();
    infinite[32..36].copy_from_slice(&f32::INFINITY.to_be_bytes());
    assert_eq!(
        LiveLink::decode(&infinite).unwrap_err().to_string(),
        "byte 32: expected a finite value, found inf"
    );
    let short = LiveLink::decode(&packet[..packet.len() - 1]).unwrap_err();
    assert_eq!((short.at, short.found), (packet.len() - 4, Found::Bytes(3)));
    packet.push(0);
    let long = LiveLink::decode(&packet).unwrap_err().to_string();
    assert_eq!(
        long,
        format!("byte {}: expected the end of the packet, found the byte 0x00", packet.len() - 1)
    );

    let osc = |packet: &[u8]| read_osc(packet, &mut |_| {}).unwrap_err().to_string();
    assert_eq!(osc(b"jaw\0"), "byte 0: expected an address that begins with /, or #bundle, found 'j'");
    assert_eq!(osc(b"/jaw"), "byte 4: expected a zero at the end of a text, found the end");
    assert_eq!(osc(b"/a\0\0,f\0\0\0\0"), "byte 8: expected a number, found 2 bytes");
    assert_eq!(
        osc(b"/a\0\0,q\0\0"),
        "byte 8: expected arguments of the types i f s b h d t c r m T F N I [ ], found 'q'"
    );
    assert_eq!(
        osc(b"#bundle\0\0\0\0\0\0\0\0\x01\0\0\0\x05/a\0\0,\0\0\0"),
        "byte 16: expected a multiple of 4, not more than the rest, found 5"
    );

    let text = |text: &str| IFacialMocap::decode(text.as_bytes()).unwrap_err().to_string();
    assert_eq!(text("jawOpen-1|mouthClose-x|"), "byte 21: expected a finite number, found 'x'");
    assert_eq!(text("jawOpen-1|=head#1,2|"), "byte 19: expected three angles, found the end");
    assert_eq!(text("jaw|"), "byte 0: expected a name, - or &, and a number, found 'j'");
    assert_eq!(text("nose-1|"), "byte 0: expected the name of a shape, or =head#, found 'n'");
    assert_eq!(text(""), "byte 0: expected the name of a shape, or =head#, found the end");

    let json =
        MediaPipe::decode(br#"{"faceBlendshapes":[{"categories":[{"categoryName":1}]}]}"#).unwrap_err();
    assert_eq!((json.at, json.found), (51, Found::Byte(b'1')));
    assert_eq!(MediaPipe::decode(br#"{"faceBl"#).unwrap_err().found, Found::End);
    let matrix = br#"{"facialTransformationMatrixes":[[1,2,3]]}"#;
    assert!(MediaPipe::decode(matrix).is_err());
    assert_eq!(channels().len(), 77);
}
