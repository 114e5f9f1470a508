//! What a face did, taken down: as a table of Live Link Face, or as a clip of the avatar.

use crate::clips;
use crate::ending;
use crate::output::{Contents, OutputFile};
use anyhow::{Context, Result, anyhow};
use avatar_live::{Frame, FrameTime, LiveLink, write_table_header, write_table_row};
use avatar_pack::Pack;
use pose_anim::{ClipSet, ControlTable, Recording};
use std::path::Path;

/// What a take is written as.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum TakeFormat {
    /// A row for each frame.
    Table,
    /// Keys of the avatar's controls, as few as are needed.
    Clip,
}

/// Rows of a take: an hour at 60 a second would be 216,000.
const ROWS: i32 = 1_000_000;

/// A file that a take is written to, checked before.
#[derive(Debug)]
pub(crate) struct Take {
    out: OutputFile,
    format: TakeFormat,
    name: String,
}

impl Take {
    pub(crate) fn check(path: &Path) -> Result<Self> {
        let endings = [("csv", TakeFormat::Table), ("toml", TakeFormat::Clip)];
        let format = ending::format(path, None, &endings, "").context("--record")?;
        let out = OutputFile::check(path, Contents::Text)?;
        let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        Ok(Self { out, format, name })
    }

    /// Writes what was taken.
    pub(crate) fn write(&self, recorder: &Recorder, pack: &Pack) -> Result<()> {
        match self.format {
            TakeFormat::Table => self.out.write(&recorder.table),
            TakeFormat::Clip => {
                self.out.write(clip(&self.name, &recorder.table, pack.controls())?.as_bytes())
            }
        }
    }
}

/// Rows of a table, one for each frame.
#[derive(Debug)]
pub(crate) struct Recorder {
    table: Vec<u8>,
    hz: f64,
    rows: i32,
}

impl Recorder {
    /// Takes down so many frames a second.
    pub(crate) fn new(hz: f64) -> Self {
        let mut table = Vec::new();
        write_table_header(&mut table);
        Self { table, hz, rows: 0 }
    }

    /// Takes down a frame; nothing beyond a million.
    pub(crate) fn add(&mut self, frame: &Frame) {
        if self.rows < ROWS {
            let numerator = (self.hz * 1000.0).round().clamp(1.0, 1e9) as i32;
            let time = FrameTime { frame: self.rows, part: 0.0, numerator, denominator: 1000 };
            write_table_row(&time, &LiveLink::values_of(frame), &mut self.table);
            self.rows += 1;
        }
    }
}

fn clip(name: &str, table: &[u8], controls: &ControlTable) -> Result<String> {
    let text = std::str::from_utf8(table).context("a table that was written")?;
    let recording =
        Recording::from_csv(name, text, controls).map_err(|error| anyhow!("--record: {error}"))?;
    let clip = clips::reduced(&recording.clip, controls)?;
    Ok(ClipSet { clips: vec![clip] }.to_toml(controls))
}
