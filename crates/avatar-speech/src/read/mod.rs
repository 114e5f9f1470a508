//! Reads timelines that other programs write.

mod json;
mod labels;
mod letters;
mod subtitles;
mod symbols;
mod table;
mod textgrid;
mod xml;

use crate::error::{Place, SpeechError, shown};
use crate::timeline::Timeline;

/// A format of timelines.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Format {
    /// Rhubarb Lip Sync's table: seconds, a tabulator, a mouth from A to H or X. Also any table of seconds
    /// and the names of Oculus's visemes, with a strength from 0 to 1 as a third column if wanted.
    Table,
    /// Rhubarb Lip Sync's XML.
    Xml,
    /// Rhubarb Lip Sync's JSON.
    Json,
    /// The marks of cloud services, one JSON object a line (or all in one list): a time and a viseme. `time`
    /// is in milliseconds (Amazon Polly), `audioOffset` in spellings of all kinds in units of 100 ns (Azure),
    /// `start` in seconds. `value` or `viseme` is a symbol of Polly or a name of Oculus, `visemeId` a number
    /// of Azure. Marks of another `type` than `viseme` are passed over.
    Marks,
    /// Praat's TextGrid, long or short: the tier of phones.
    TextGrid,
    /// Labels of phones: lines of start, end and phone (whole numbers are units of 100 ns, as HTK writes
    /// them, others seconds); behind a line `#` of end, number and phone (Festival, ESPS); or phone and
    /// milliseconds (MBROLA, eSpeak).
    Labels,
    /// Subtitles in SubRip (SRT) or WebVTT: a guess by letters.
    Subtitles,
}

impl Format {
    /// All of them.
    pub const ALL: [Self; 7] =
        [Self::Table, Self::Xml, Self::Json, Self::Marks, Self::TextGrid, Self::Labels, Self::Subtitles];

    /// How names of files end that tell their format.
    pub const ENDINGS: [(&str, Self); 15] = [
        ("tsv", Self::Table),
        ("csv", Self::Table),
        ("txt", Self::Table),
        ("xml", Self::Xml),
        ("jsonl", Self::Marks),
        ("ndjson", Self::Marks),
        ("marks", Self::Marks),
        ("TextGrid", Self::TextGrid),
        ("lab", Self::Labels),
        ("phn", Self::Labels),
        ("pho", Self::Labels),
        ("lbl", Self::Labels),
        ("segs", Self::Labels),
        ("srt", Self::Subtitles),
        ("vtt", Self::Subtitles),
    ];

    /// The format that a file's name tells by its end; `.json` is found by what is in it.
    pub fn of_name(name: &str) -> Option<Self> {
        let (_, end) = name.rsplit_once('.')?;
        let (_, format) = Self::ENDINGS.into_iter().find(|(ending, _)| ending.eq_ignore_ascii_case(end))?;
        Some(format)
    }

    /// The format that a text seems to be in.
    pub fn of_text(text: &str) -> Self {
        let start = text.trim_start();
        let first = start.lines().next().unwrap_or_default();
        if start.starts_with('<') {
            Self::Xml
        } else if start.starts_with(['{', '[']) {
            if start.contains("\"mouthCues\"") { Self::Json } else { Self::Marks }
        } else if start.starts_with("File type") || start.starts_with("\"ooTextFile") {
            Self::TextGrid
        } else if start.starts_with("WEBVTT") || start.contains("-->") {
            Self::Subtitles
        } else if table::is_row(first) {
            Self::Table
        } else {
            Self::Labels
        }
    }
}

impl Timeline {
    /// Reads a timeline from a text. Without a format, the text tells it.
    ///
    /// ```
    /// use avatar_speech::{Timeline, Viseme};
    /// let timeline = Timeline::read("0.00\tX\n0.10\tA\n0.18\tD\n0.42\tX\n", None)?;
    /// assert_eq!(timeline.cues()[1].viseme, Viseme::PP);
    /// assert_eq!(timeline.end_secs(), 0.42);
    /// # Ok::<(), avatar_speech::SpeechError>(())
    /// ```
    ///
    /// # Errors
    /// What cannot be read, with its place. Phones that are not known become notes
    /// ([`Self::notes`]), and the sound before them goes on.
    pub fn read(text: &str, format: Option<Format>) -> Result<Self, SpeechError> {
        // Some programs begin a text with this mark.
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        if text.trim().is_empty() {
            return Err(Place::of_line(1).error("a timeline of speech", shown(text)));
        }
        match format.unwrap_or_else(|| Format::of_text(text)) {
            Format::Table => table::read(text),
            Format::Xml => xml::read(text),
            Format::Json => json::read_rhubarb(text),
            Format::Marks => json::read_marks(text),
            Format::TextGrid => textgrid::read(text),
            Format::Labels => labels::read(text),
            Format::Subtitles => subtitles::read(text),
        }
    }

    /// Reads a file of this name (an end that tells nothing may be missing): UTF-8, or UTF-16 with its mark,
    /// which Praat writes.
    ///
    /// # Errors
    /// Bytes that are no text, and as [`Self::read`].
    pub fn from_bytes(name: &str, bytes: &[u8]) -> Result<Self, SpeechError> {
        let no_text = || Place::of_line(1).error("a text in UTF-8 or UTF-16", "other bytes");
        // A name can lie: `.txt` is used for labels and for subtitles as well.
        let format = Format::of_name(name).filter(|format| *format != Format::Table);
        let wide = |of: fn([u8; 2]) -> u16| -> Result<String, SpeechError> {
            let units = bytes[2..].chunks_exact(2).map(|pair| of([pair[0], pair[1]]));
            char::decode_utf16(units).collect::<Result<_, _>>().map_err(|_| no_text())
        };
        match bytes {
            [0xff, 0xfe, ..] => Self::read(&wide(u16::from_le_bytes)?, format),
            [0xfe, 0xff, ..] => Self::read(&wide(u16::from_be_bytes)?, format),
            _ => Self::read(std::str::from_utf8(bytes).map_err(|_| no_text())?, format),
        }
    }
}

/// A finite number.
fn number(text: &str) -> Option<f64> {
    text.trim().parse().ok().filter(|number: &f64| number.is_finite())
}
