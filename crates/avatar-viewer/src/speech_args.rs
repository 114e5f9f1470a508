use crate::espeak::{MOST_BYTES, check_length};
use anyhow::{Context, Result};
use clap::Args;
use std::io::Read;
use std::path::PathBuf;

/// What the face speaks.
#[derive(Clone, Debug, Default, Args)]
pub(crate) struct SpeechArgs {
    /// Sounds that the face speaks, with their times: of Rhubarb (.tsv, .xml, .json), TextGrid, HTK, Festival
    /// or MBROLA labels, marks of cloud services, subtitles (docs/speech.md), on top of what it does
    /// otherwise
    #[arg(long, value_name = "FILE")]
    pub(crate) visemes: Option<PathBuf>,
    /// Recording of a voice (WAV, FLAC, Ogg Vorbis or MP3) that the face speaks by what is heard in it; with
    /// --visemes these say the sounds, and the recording how loud they are. A film in MP4 has it as its sound
    #[arg(long, value_name = "FILE")]
    pub(crate) audio: Option<PathBuf>,
    /// Text that the program espeak-ng reads aloud, and the face with it; `-` is standard input
    #[arg(long, value_name = "TEXT", allow_hyphen_values = true, conflicts_with_all = ["visemes", "audio"])]
    pub(crate) say: Option<String>,
    /// Voice of espeak-ng, as `espeak-ng --voices` lists them: de, en-us, es+f3 [default: en]
    #[arg(long, value_name = "VOICE", requires = "say")]
    pub(crate) voice: Option<String>,
}

impl SpeechArgs {
    /// Whether the face is to speak.
    pub(crate) fn is_given(&self) -> bool {
        self.visemes.is_some() || self.audio.is_some() || self.say.is_some()
    }

    /// The text that is to be said; `-` is that on the standard input.
    pub(crate) fn text(&self) -> Result<String> {
        let text = self.say.as_deref().unwrap_or_default();
        if text != "-" {
            return Ok(text.to_owned());
        }
        let mut text = Vec::new();
        let read = std::io::stdin().take(MOST_BYTES + 1).read_to_end(&mut text);
        read.context("standard input: expected a text")?;
        // One that is too long may have been cut within a character.
        check_length(text.len())?;
        String::from_utf8(text).context("standard input: expected a text in UTF-8")
    }

    /// What it speaks, in words of the command line.
    pub(crate) fn describe(&self) -> Vec<String> {
        let file = |name: &str, path: &Option<PathBuf>| {
            path.as_ref().map(|path| format!("{name}={}", path.display()))
        };
        let say = self.say.as_ref().map(|text| format!("say={text}"));
        let voice = self.voice.as_ref().map(|voice| format!("voice={voice}"));
        [file("visemes", &self.visemes), file("audio", &self.audio), say, voice]
            .into_iter()
            .flatten()
            .collect()
    }
}
