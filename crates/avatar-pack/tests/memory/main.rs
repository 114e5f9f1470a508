//! Small files that claim to be large: whatever they say, reading them and making an avatar of them takes no
//! more than 64 times their own size and 256 MiB. A program of its own, since it counts what it allocates.
//!
//! What the C library that reads FBX allocates is not counted here; it has a limit of its own
//! (`avatar_exchange::fbx`), which is part of the sum.
#![allow(
    clippy::expect_used,
    clippy::panic,
    clippy::print_stdout,
    reason = "a test may panic, and prints what it measured"
)]

mod bytes;
mod gltf;
mod others;
mod packed;

use avatar_exchange::{TextFile, memory};
use avatar_pack::Import;

const MIB: u64 = 1 << 20;

/// What became of a file.
#[derive(Debug)]
enum Outcome {
    /// An avatar.
    Read,
    /// An error, and its text.
    Refused(String),
}

impl Outcome {
    fn is_read(&self) -> bool {
        matches!(self, Self::Read)
    }
}

/// Reads a file and files that belong to it up to an avatar, and measures the most that it holds at a time.
/// `beside` is what is held where it is not counted.
fn measured(name: &str, bytes: &[u8], further: &[(&str, &[u8])], beside: u64) -> Outcome {
    let texts: Vec<TextFile<'_>> = further.iter().map(|(file, bytes)| TextFile { file, bytes }).collect();
    let size = (bytes.len() + further.iter().map(|(_, bytes)| bytes.len()).sum::<usize>()) as u64;
    let mut outcome = None;
    let info = allocation_counter::measure(|| {
        let scene = avatar_exchange::read(name, bytes, &texts, &mut |_| Err("no files".to_owned()));
        outcome = Some(match scene.map_err(|error| error.to_string()) {
            Ok(scene) => match Import::from_scene(scene) {
                Ok(_) => Outcome::Read,
                Err(error) => Outcome::Refused(error.to_string()),
            },
            Err(error) => Outcome::Refused(error),
        });
    });
    let outcome = outcome.expect("it was read");
    let (peak, limit) = (info.bytes_max + beside, memory::most(size));
    let what = match &outcome {
        Outcome::Read => "read".to_owned(),
        Outcome::Refused(why) => format!("refused: {}", why.chars().take(150).collect::<String>()),
    };
    println!("{name}: {size} bytes, {} of {} MiB, {what}", peak / MIB, limit / MIB);
    assert!(peak <= limit, "{name}: {size} bytes took {} MiB of {}: {what}", peak / MIB, limit / MIB);
    outcome
}

/// Reads files that claim more and more, eight times as much each time, until one is refused, then between
/// the largest that was read and that one: the largest that is read is what takes most.
fn growing(name: &str, file: impl Fn(u64) -> Vec<u8>) {
    growing_beside(name, file, |_| 0);
}

/// As [`growing`], for files that are refused whatever their size is.
fn refused(name: &str, file: impl Fn(u64) -> Vec<u8>) {
    for count in (1..11).map(|step| 1 << (3 * step)) {
        let outcome = measured(&format!("{count}.{name}"), &file(count), &[], 0);
        assert!(!outcome.is_read(), "{name}");
    }
}

/// As [`growing`], with what is held where it is not counted.
fn growing_beside(name: &str, file: impl Fn(u64) -> Vec<u8>, beside: impl Fn(&[u8]) -> u64) {
    let is_read = |count: u64| {
        let bytes = file(count);
        let is_read = measured(&format!("{count}.{name}"), &bytes, &[], beside(&bytes)).is_read();
        (is_read, bytes.len())
    };
    let (mut largest, mut size) = (0, 0);
    for count in (1..11).map(|step| 1 << (3 * step)) {
        let (was_read, new_size) = is_read(count);
        if was_read {
            // A file that cannot grow any more is the largest.
            if size == new_size {
                return;
            }
            (largest, size) = (count, new_size);
        } else if largest > 0 {
            let mut refused = count;
            for _ in 0..4 {
                let between = largest + (refused - largest) / 2;
                if is_read(between).0 { largest = between } else { refused = between }
            }
            return;
        }
    }
    panic!("{name}: none was read, or none was refused: nothing was measured");
}

#[test]
fn the_limit_is_the_one_that_is_promised() {
    assert_eq!(memory::most(0), 256 * MIB);
    assert_eq!(memory::most(1_000_000), 256 * MIB + 64_000_000);
    assert_eq!(memory::most(u64::MAX), u64::MAX);
}

#[test]
fn the_measure_itself_works() {
    let info = allocation_counter::measure(|| drop(vec![0_u8; 3 << 20]));
    assert_eq!(info.bytes_max, 3 * MIB);
}
