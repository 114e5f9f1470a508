//! The program espeak-ng, which reads texts aloud.

use crate::usage::usage;
use anyhow::{Context, Result, anyhow, bail};
use std::io::{ErrorKind, Write};
use std::process::{Command, Stdio};

const PROGRAM: &str = "espeak-ng";
/// The voice where none is asked for.
const VOICE: &str = "en";
/// Longer texts are refused: half an hour of speech.
pub(crate) const MOST_BYTES: u64 = 30_000;

/// A text as somebody says it.
#[derive(Debug)]
pub(crate) struct Said {
    /// The sound, as the bytes of a WAV file.
    pub(crate) wav: Vec<u8>,
    /// Its phones in IPA, a line for each clause.
    pub(crate) phones: String,
}

/// # Errors
/// A text of so many bytes is too long.
pub(crate) fn check_length(bytes: usize) -> Result<()> {
    if bytes as u64 > MOST_BYTES {
        return Err(usage(format!("expected a text of at most {MOST_BYTES} bytes, found a longer one")));
    }
    Ok(())
}

/// Lets espeak-ng read a text aloud.
pub(crate) fn say(text: &str, voice: Option<&str>) -> Result<Said> {
    let voice = voice.unwrap_or(VOICE);
    let is_part = |sign: char| sign.is_ascii_alphanumeric() || "-_+/".contains(sign);
    if voice.is_empty() || voice.starts_with('-') || !voice.chars().all(is_part) {
        return Err(usage(format!("expected a voice of espeak-ng, as in de or en-us+f3, found {voice:?}")));
    }
    check_length(text.len())?;
    if text.trim().is_empty() {
        return Err(usage("expected a text, found nothing to say"));
    }
    let wav = run(&["--stdin", "--stdout", "-b", "1", "-v", voice], text)?;
    let phones = run(&["--stdin", "-q", "--ipa", "--sep=_", "-b", "1", "-v", voice], text)?;
    Ok(Said { wav, phones: String::from_utf8_lossy(&phones).into_owned() })
}

/// What espeak-ng writes to its standard output. The text goes to its standard input, never among its
/// options.
fn run(options: &[&str], text: &str) -> Result<Vec<u8>> {
    let mut command = Command::new(PROGRAM);
    command.args(options).stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = command.spawn().map_err(|error| match error.kind() {
        ErrorKind::NotFound => anyhow!(
            "expected the program {PROGRAM}, found none; it can be installed (Debian and Ubuntu: apt install \
             espeak-ng; Fedora: dnf install espeak-ng; macOS: brew install espeak-ng; Windows: winget install \
             eSpeak-NG.eSpeak-NG), and recordings are spoken without it"
        ),
        _ => anyhow!(error).context(format!("{PROGRAM}: expected a program that starts")),
    })?;
    // It reads all of its input before it writes anything.
    if let Some(mut input) = child.stdin.take() {
        // One that ends early says why.
        let _ = input.write_all(text.as_bytes());
    }
    let output = child.wait_with_output().with_context(|| format!("{PROGRAM}: expected its output"))?;
    if !output.status.success() || output.stdout.is_empty() {
        let told = String::from_utf8_lossy(&output.stderr);
        let told = if told.trim().is_empty() { "nothing" } else { told.trim() };
        bail!("{PROGRAM}: expected speech, found that it ends with {}: {told}", output.status);
    }
    Ok(output.stdout)
}
