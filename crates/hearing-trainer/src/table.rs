//! How well is heard what the model was not trained on, beside two other programs.
//!
//! Of each program, frames of 10 ms are compared with the labels. The other two have a delay of their own:
//! the one that makes most of their frames right is taken from them.

use std::path::Path;

use anyhow::{Context, Result};
use avatar_hearing::{Hearing, VISEMES, model::Model};

use crate::corpus::{Sound, read};

/// Time from one compared frame to the next.
const STEP: f64 = 0.01;

/// A sound's onset counts as heard if it is heard within this time.
const NEAR: f64 = 0.15;

/// What one program hears in one sound: from when on which viseme.
type Heard = Vec<(f64, usize)>;

/// Results of one program in one folder.
#[derive(Debug, Default)]
struct Score {
    right: [usize; 15],
    frames: [usize; 15],
    onsets: Vec<f64>,
    missed: usize,
}

impl Score {
    fn all(&self) -> f64 {
        self.right.iter().sum::<usize>() as f64 / self.frames.iter().sum::<usize>().max(1) as f64
    }

    fn classes(&self) -> f64 {
        let parts = self.right.iter().zip(&self.frames).filter(|(_, frames)| **frames > 0);
        let parts: Vec<f64> = parts.map(|(right, frames)| *right as f64 / *frames as f64).collect();
        parts.iter().sum::<f64>() / parts.len().max(1) as f64
    }

    fn add(&mut self, sound: &Sound, heard: &Heard, delay: f64) {
        let count = (sound.seconds() / STEP) as usize;
        for frame in 0..count {
            let time = (frame as f64 + 0.5) * STEP;
            if let Some(viseme) = sound.viseme(time) {
                self.frames[viseme] += 1;
                self.right[viseme] += usize::from(at(heard, time + delay) == viseme);
            }
        }
        let begins: Vec<(f64, usize)> = heard
            .iter()
            .enumerate()
            .filter(|(index, (_, viseme))| *index == 0 || heard[index - 1].1 != *viseme)
            .map(|(_, (time, viseme))| (time - delay, *viseme))
            .collect();
        for (index, label) in sound.labels.iter().enumerate() {
            let Some(viseme) = label.viseme.filter(|viseme| *viseme > 0) else { continue };
            if index > 0 && sound.labels[index - 1].viseme == Some(viseme) {
                continue;
            }
            let errors = begins.iter().filter(|(_, begun)| *begun == viseme);
            let error = errors.map(|(time, _)| (time - label.begin).abs()).min_by(f64::total_cmp);
            match error.filter(|error| *error <= NEAR) {
                Some(error) => self.onsets.push(error),
                None => self.missed += 1,
            }
        }
    }

    fn onset(&self) -> (f64, f64) {
        let mut onsets = self.onsets.clone();
        onsets.sort_by(f64::total_cmp);
        let median = onsets.get(onsets.len() / 2).copied().unwrap_or(f64::NAN);
        (median * 1000.0, onsets.len() as f64 / (onsets.len() + self.missed).max(1) as f64)
    }
}

fn at(heard: &Heard, time: f64) -> usize {
    let index = heard.partition_point(|(begin, _)| *begin <= time);
    index.checked_sub(1).map_or(0, |index| heard[index].1)
}

fn ours(sound: &Sound, model: &Model) -> Result<Heard> {
    let mut hearing = Hearing::with_model(sound.rate, model.clone())?;
    let mut heard = Vec::new();
    // A frame stands for the hundredth of a second around it.
    let mut hear =
        |frame: &avatar_hearing::Frame| heard.push((frame.time_secs - STEP / 2.0, frame.strongest()));
    hearing.push(&sound.samples, &mut hear);
    hearing.finish(&mut hear);
    Ok(heard)
}

fn theirs(sound: &Sound, program: &str) -> Result<Heard> {
    let path = sound.path.with_extension(program);
    let text = std::fs::read_to_string(&path)
        .with_context(|| format!("{}: compare.mjs writes it", path.display()))?;
    let lines = text.lines().filter_map(|line| {
        let (time, viseme) = line.split_once(' ')?;
        Some((time.parse().ok()?, viseme.parse().ok()?))
    });
    Ok(lines.collect())
}

fn score(sounds: &[Sound], heard: &[Heard], delay: f64) -> Score {
    let mut score = Score::default();
    for (sound, heard) in sounds.iter().zip(heard) {
        score.add(sound, heard, delay);
    }
    score
}

/// Prints the tables, in Markdown.
pub(crate) fn print(folder: &Path, model: &Path) -> Result<()> {
    let model = Model::from_bytes(&std::fs::read(model)?).context("no model of this version")?;
    let programs = ["ours", "headaudio", "wlipsync"];
    let mut delays = [0.0; 3];
    println!(
        "| | | frames right | mean of classes | onset, median | onsets heard |\n|---|---|---|---|---|---|"
    );
    let mut clean = Vec::new();
    for place in ["test", "noise", "silence", "music"] {
        let sounds = read(&folder.join(place))?;
        for (program, delay) in programs.iter().zip(&mut delays) {
            let heard: Result<Vec<Heard>> = sounds
                .iter()
                .map(|sound| if *program == "ours" { ours(sound, &model) } else { theirs(sound, program) })
                .collect();
            let heard = heard?;
            if place == "test" && *program != "ours" {
                let tried = (-10..=20).map(|step| f64::from(step) * STEP);
                let right = |delay: &f64| score(&sounds, &heard, *delay).all();
                *delay = tried.max_by(|a, b| right(a).total_cmp(&right(b))).unwrap_or(0.0);
                println!("<!-- {program}: delay {:.0} ms -->", *delay * 1000.0);
            }
            let score = score(&sounds, &heard, *delay);
            if score.onsets.len() + score.missed > 0 {
                let (median, part) = score.onset();
                println!(
                    "| {place} | {program} | {:.1} % | {:.1} % | {median:.0} ms | {:.0} % |",
                    100.0 * score.all(),
                    100.0 * score.classes(),
                    100.0 * part
                );
            } else {
                println!("| {place} | {program} | {:.1} % | – | – | – |", 100.0 * score.all());
            }
            if place == "test" {
                if *program == "ours" {
                    voices(&sounds, &heard);
                }
                clean.push(score);
            }
        }
    }
    println!("\n| viseme | frames | {} |\n|---|---|---|---|---|", programs.join(" | "));
    for (viseme, name) in VISEMES.iter().enumerate() {
        let parts: Vec<String> = clean
            .iter()
            .map(|score| {
                format!("{:.0} %", 100.0 * score.right[viseme] as f64 / score.frames[viseme].max(1) as f64)
            })
            .collect();
        println!("| {name} | {} | {} |", clean[0].frames[viseme], parts.join(" | "));
    }
    Ok(())
}

/// Ours by voice, which is the file's name without its number.
fn voices(sounds: &[Sound], heard: &[Heard]) {
    let name = |sound: &Sound| {
        let stem = sound.path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        stem.rsplit_once('-').map_or(stem.clone(), |(voice, _)| voice.to_owned())
    };
    let mut names: Vec<String> = sounds.iter().map(name).collect();
    names.dedup();
    for voice in names {
        let mut score = Score::default();
        for (sound, heard) in sounds.iter().zip(heard).filter(|(sound, _)| name(sound) == voice) {
            score.add(sound, heard, 0.0);
        }
        println!("<!-- {voice}: {:.1} %, {:.0} ms -->", 100.0 * score.all(), score.onset().0);
    }
}
