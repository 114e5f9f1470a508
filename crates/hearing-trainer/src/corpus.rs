//! Sounds with labels, from files.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result, ensure};

/// One sound and what each part of it looks like.
#[derive(Clone, Debug)]
pub(crate) struct Sound {
    /// The file's name without its ending.
    pub(crate) path: PathBuf,
    pub(crate) rate: u32,
    /// From -1 to 1.
    pub(crate) samples: Vec<f32>,
    /// In order of time.
    pub(crate) labels: Vec<Label>,
}

/// What a stretch of a sound looks like.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Label {
    pub(crate) begin: f64,
    pub(crate) end: f64,
    /// `None` where nobody knows.
    pub(crate) viseme: Option<usize>,
}

impl Sound {
    pub(crate) fn seconds(&self) -> f64 {
        self.samples.len() as f64 / f64::from(self.rate)
    }

    /// The viseme at a time; after the last label it is silent.
    pub(crate) fn viseme(&self, time: f64) -> Option<usize> {
        let index = self.labels.partition_point(|label| label.end <= time);
        self.labels.get(index).map_or(Some(0), |label| label.viseme)
    }
}

/// All sounds of a folder, in order of their names.
pub(crate) fn read(folder: &Path) -> Result<Vec<Sound>> {
    let mut paths = Vec::new();
    for entry in std::fs::read_dir(folder).with_context(|| folder.display().to_string())? {
        let path = entry?.path();
        if path.extension().is_some_and(|ending| ending == "wav") {
            paths.push(path.with_extension(""));
        }
    }
    paths.sort();
    ensure!(!paths.is_empty(), "{} holds no sound", folder.display());
    paths.into_iter().map(|path| sound(&path).with_context(|| path.display().to_string())).collect()
}

fn sound(path: &Path) -> Result<Sound> {
    let (rate, samples) = wave(&std::fs::read(path.with_extension("wav"))?)?;
    let mut labels = Vec::new();
    for line in std::fs::read_to_string(path.with_extension("vis"))?.lines() {
        let parts: Vec<&str> = line.split(' ').collect();
        ensure!(parts.len() == 3, "\"{line}\" is no label");
        labels.push(Label {
            begin: parts[0].parse()?,
            end: parts[1].parse()?,
            viseme: parts[2].parse().ok(),
        });
    }
    Ok(Sound { path: path.to_owned(), rate, samples, labels })
}

/// The samples of a WAV file of 16 bits and one channel, as speak.py writes it.
fn wave(bytes: &[u8]) -> Result<(u32, Vec<f32>)> {
    ensure!(bytes.starts_with(b"RIFF") && bytes.get(8..12) == Some(b"WAVE"), "no WAV file");
    let mut rest = &bytes[12..];
    let mut rate = 0;
    while let Some((head, behind)) = rest.split_first_chunk::<8>() {
        let size = u32::from_le_bytes([head[4], head[5], head[6], head[7]]) as usize;
        let body = &behind[..size.min(behind.len())];
        match &head[..4] {
            b"fmt " => {
                ensure!(
                    body.len() >= 16 && body[0] == 1 && body[2] == 1 && body[14] == 16,
                    "16 bits, one channel"
                );
                rate = u32::from_le_bytes([body[4], body[5], body[6], body[7]]);
            }
            b"data" => {
                let (values, _) = body.as_chunks::<2>();
                let samples = values.iter().map(|value| f32::from(i16::from_le_bytes(*value)) / 32_768.0);
                return Ok((rate, samples.collect()));
            }
            _ => {}
        }
        rest = behind.get(size + size % 2..).unwrap_or_default();
    }
    anyhow::bail!("no samples")
}
