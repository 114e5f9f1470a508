//! For `scripts/check-live`, which has other programs write what is read here, and read what is written here.
//!
//! Each line of standard input is a protocol and a packet in hexadecimal digits, or `write`, a protocol and
//! names with values; each answer is a line: names with values, or packets in hexadecimal digits.

#![allow(clippy::print_stdout, reason = "a program")]

use avatar_live::{Frame, FrameTime, LiveLink, Protocol, Receiver, Settings, VmcSender, channels};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut receiver = Receiver::new(Settings::default());
    for (number, line) in std::io::stdin().lines().enumerate() {
        let line = line?;
        let words: Vec<&str> = line.split_whitespace().collect();
        match words.as_slice() {
            ["write", protocol, values @ ..] => {
                let packets = write(protocol, values)?;
                let hex =
                    |packet: &Vec<u8>| packet.iter().map(|byte| format!("{byte:02x}")).collect::<String>();
                println!("{}", packets.iter().map(hex).collect::<Vec<_>>().join(" "));
            }
            [protocol, packet] => {
                let protocol = match *protocol {
                    "livelink" => Protocol::LiveLink,
                    "vmc" => Protocol::Vmc,
                    other => return Err(format!("line {}: {other}?", number + 1).into()),
                };
                let digits: Vec<u8> =
                    packet.chars().filter_map(|digit| Some(digit.to_digit(16)? as u8)).collect();
                let bytes: Vec<u8> = digits
                    .chunks(2)
                    .map(|pair| pair.iter().fold(0, |byte, digit| byte * 16 + digit))
                    .collect();
                let origin = ([127, 0, 0, 1], 9).into();
                let received = receiver.receive(number as f64, origin, protocol, &bytes)?;
                let values = received.frame.unwrap_or_default();
                let values = values
                    .iter()
                    .filter_map(|(at, value)| Some(format!("{} {value}", channels().get(at)?.name)));
                println!("{}", values.collect::<Vec<_>>().join(" "));
            }
            _ => return Err(format!("line {}: expected two words", number + 1).into()),
        }
    }
    Ok(())
}

fn write(protocol: &str, values: &[&str]) -> Result<Vec<Vec<u8>>, Box<dyn std::error::Error>> {
    let mut frame = Frame::default();
    for pair in values.chunks(2) {
        let [name, value] = pair else { return Err("expected names with values".into()) };
        frame.set_named(name, value.parse()?);
    }
    let mut packets = Vec::new();
    match protocol {
        "vmc" => VmcSender::default().send(&frame, 1.5, &mut |packet| packets.push(packet.to_vec())),
        _ => {
            let time = Some(FrameTime { frame: 5, part: 0.25, numerator: 60, denominator: 1 });
            // The other program takes ids of 36 characters, as phones have them.
            let device = "DEADC0DE-1337-1337-1337-CAFEBABE0001";
            let mut packet = Vec::new();
            let values = Some(LiveLink::values_of(&frame));
            LiveLink { device, subject: "Ann", time, values }.encode(&mut packet);
            packets.push(packet);
        }
    }
    Ok(packets)
}
