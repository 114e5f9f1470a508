//! What tests of text formats share.

use super::data::models;
use avatar_exchange::{ImportError, Scene};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// The files with these extensions in all folders of [`models`].
pub(crate) fn test_models(extensions: &[&str]) -> Vec<PathBuf> {
    let Some(folder) = models("") else { return Vec::new() };
    let mut found = Vec::new();
    let mut folders = vec![folder];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(&folder).expect("a folder").flatten() {
            let path = entry.path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|e| extensions.iter().any(|x| e.eq_ignore_ascii_case(x))) {
                found.push(path);
            }
        }
    }
    found.sort();
    found
}

pub(crate) fn bytes(path: &Path) -> Vec<u8> {
    std::fs::read(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// Reads a file of [`test_models`] within 20 seconds: a scene, or an error with file and place.
pub(crate) fn loads_or_tells(
    path: &Path,
    read: impl FnOnce(&str, &[u8]) -> Result<Scene, ImportError>,
) -> Result<Scene, ImportError> {
    let name = path.file_name().expect("a file").to_string_lossy().into_owned();
    let start = Instant::now();
    let result = read(&name, &bytes(path));
    assert!(start.elapsed() < Duration::from_secs(20), "{name} took {:?}", start.elapsed());
    match &result {
        Ok(scene) => println!("{name}: {} parts, {} nodes", scene.parts.len(), scene.nodes.len()),
        Err(error) => {
            println!("{error}");
            placed(error);
        }
    }
    result
}

/// An error says where, what and what instead, and is no longer than one wants to read.
pub(crate) fn placed(error: &ImportError) {
    let all_there =
        [&error.file, &error.place, &error.expected, &error.found].iter().all(|text| !text.is_empty());
    assert!(all_there && error.to_string().len() < 500, "{error}");
}

/// xorshift64*.
pub(crate) struct Random(pub(crate) u64);

impl Random {
    pub(crate) fn below(&mut self, limit: usize) -> usize {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        (self.0.wrapping_mul(0x2545_f491_4f6c_dd1d) >> 33) as usize % limit.max(1)
    }
}

/// Reads a good file cut after every 64th byte, with flipped bits, and with numbers that lie. Returns how
/// many of the damaged files were told to be so.
pub(crate) fn survives_damage(good: &[u8], read: impl Fn(&[u8]) -> Result<Scene, ImportError>) -> usize {
    let start = Instant::now();
    read(good).expect("the undamaged file");
    let mut told = 0;
    let mut check = |bytes: &[u8]| {
        if let Err(error) = read(bytes) {
            placed(&error);
            told += 1;
        }
    };
    for end in (0..good.len()).step_by(64) {
        check(&good[..end]);
    }
    let mut random = Random(20_261_122);
    for _ in 0..400 {
        let mut bytes = good.to_vec();
        for _ in 0..=random.below(4) {
            let at = random.below(bytes.len());
            bytes[at] ^= 1 << random.below(8);
        }
        check(&bytes);
    }
    let text = String::from_utf8_lossy(good).into_owned();
    let is_number = |word: &str| word.parse::<f64>().is_ok();
    let numbers: Vec<usize> = text
        .split_whitespace()
        .filter(|word| is_number(word))
        .map(|word| word.as_ptr() as usize - text.as_ptr() as usize)
        .collect();
    for lie in ["4294967295", "99999999999999999999", "-7", "1e39", "nan", "-inf", "0x10", "0"] {
        for _ in 0..24 {
            let at = numbers[random.below(numbers.len())];
            let end = text[at..].find(char::is_whitespace).map_or(text.len(), |length| at + length);
            check(format!("{}{lie}{}", &text[..at], &text[end..]).as_bytes());
        }
    }
    assert!(start.elapsed() < Duration::from_secs(60), "{:?}", start.elapsed());
    told
}
