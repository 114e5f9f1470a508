//! Helpers of the tests.
#![allow(clippy::panic, clippy::unwrap_used, reason = "a test may panic")]

use rig_core::{Place, RawRig, Rig, XmlError, XmlProblem};

/// Marks the place of the expected error in a text.
pub(crate) const MARK: char = '¦';

/// The text without the mark, and the place of the mark, counted here in the most literal way.
pub(crate) fn marked(text: &str) -> (String, Place) {
    assert_eq!(text.matches(MARK).count(), 1, "one mark in {text:?}");
    let (mut line, mut column) = (1, 1);
    for c in text.chars().take_while(|&c| c != MARK) {
        (line, column) = if c == '\n' { (line + 1, 1) } else { (line, column + 1) };
    }
    (text.replace(MARK, ""), Place { line, column })
}

pub(crate) fn error_of(bytes: &[u8]) -> XmlError {
    match Rig::from_xml(bytes) {
        Ok(rig) => panic!("read as a rig of {} joints: {}", rig.len(), String::from_utf8_lossy(bytes)),
        Err(error) => error,
    }
}

/// The text, which has a mark, must fail there with this problem.
#[track_caller]
pub(crate) fn fails(text: &str, problem: &XmlProblem) {
    let (xml, place) = marked(text);
    let error = error_of(xml.as_bytes());
    assert_eq!(error.problem, *problem, "in {text}");
    assert_eq!(error.place, place, "{error} in {text}");
    assert_eq!(error.to_string(), format!("line {}, column {}: {problem}", place.line, place.column));
}

/// The text, which has a mark, must fail there as no well-formed XML, and the message must say `why`.
#[track_caller]
pub(crate) fn malformed(text: &str, why: &str) {
    let (xml, place) = marked(text);
    let error = error_of(xml.as_bytes());
    let XmlProblem::Malformed(message) = &error.problem else { panic!("{error} in {text}") };
    assert!(message.contains(why), "{message:?} does not say {why:?}");
    assert_eq!(error.place, place, "{error} in {text}");
}

pub(crate) const IDENTITY: &str = "1 0 0 0  0 1 0 0  0 0 1 0  0 0 0 1";

/// Everything but the places.
pub(crate) fn without_places(mut raw: RawRig) -> RawRig {
    raw.joints.iter_mut().for_each(|joint| joint.place = None);
    raw
}

/// SplitMix64: a seed gives the same numbers on every machine.
pub(crate) struct Random(pub(crate) u64);

impl Random {
    pub(crate) fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    pub(crate) fn below(&mut self, n: usize) -> usize {
        (self.next() % n as u64) as usize
    }
}

/// The folder of real data beside the repository, or `None` with a printed reason; under
/// `MIMIK_REQUIRE_DATA=1` its absence is a failure.
#[allow(clippy::disallowed_methods, reason = "a test asks what it must not skip")]
pub(crate) fn shared_data() -> Option<std::path::PathBuf> {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data");
    if folder.is_dir() {
        return Some(folder);
    }
    let required = std::env::var_os("MIMIK_REQUIRE_DATA").is_some_and(|value| value == "1");
    assert!(!required, "expected data in {} (MIMIK_REQUIRE_DATA=1), found no folder", folder.display());
    // Past the harness, which keeps the output of tests that pass to itself.
    let skipped = format_args!("SKIPPED: {} is not there\n", folder.display());
    let _ = std::io::Write::write_fmt(&mut std::io::stderr(), skipped);
    None
}
