//! Training: the network of `avatar_hearing::model`, by the gradient of its cross-entropy.

use avatar_hearing::{
    features::FEATURES,
    model::{AFTER, BEFORE, HIDDEN, INPUTS, Layer, Model, OUTPUTS},
};
use ndarray::{Array1, Array2, Axis};

use crate::{
    augment::{Chance, Frames, frames},
    corpus::Sound,
};

/// Frames that one step learns from.
const BATCH: usize = 256;

/// The rate of learning at the beginning; it falls to a hundredth of that.
const RATE: f32 = 1e-3;

/// The part of the wanted weights that goes to all visemes, so that the network does not become too sure.
const DOUBT: f32 = 0.05;

/// The part of the neurons that pause in a step, so that none is relied on.
const PAUSED: f32 = 0.1;

/// The part of the examples of which the network sees only some bands or frames.
const HIDDEN_BANDS: f32 = 0.4;

/// Matrices with what Adam (Kingma and Ba, 2015) knows of their gradients.
#[derive(Debug)]
struct Weights {
    weights: Array2<f32>,
    constant: Array1<f32>,
    means: (Array2<f32>, Array1<f32>),
    squares: (Array2<f32>, Array1<f32>),
}

impl Weights {
    fn new(inputs: usize, outputs: usize, chance: &mut Chance) -> Self {
        // He and others, 2015.
        let range = (6.0 / inputs as f32).sqrt();
        Self {
            weights: Array2::from_shape_simple_fn((inputs, outputs), || chance.between(-range, range)),
            constant: Array1::zeros(outputs),
            means: (Array2::zeros((inputs, outputs)), Array1::zeros(outputs)),
            squares: (Array2::zeros((inputs, outputs)), Array1::zeros(outputs)),
        }
    }

    fn run(&self, inputs: &Array2<f32>) -> Array2<f32> {
        inputs.dot(&self.weights) + &self.constant
    }

    fn learn(&mut self, gradient: &Array2<f32>, constant: &Array1<f32>, step: i32, rate: f32) {
        let (first, second) = (0.9_f32, 0.999_f32);
        let rate = rate * (1.0 - second.powi(step)).sqrt() / (1.0 - first.powi(step));
        let update = |weight: &mut f32, mean: &mut f32, square: &mut f32, gradient: f32| {
            *mean = first * *mean + (1.0 - first) * gradient;
            *square = second * *square + (1.0 - second) * gradient * gradient;
            *weight -= rate * (*mean / (square.sqrt() + 1e-8) + 1e-3 * *weight);
        };
        ndarray::Zip::from(&mut self.weights)
            .and(&mut self.means.0)
            .and(&mut self.squares.0)
            .and(gradient)
            .for_each(|weight, mean, square, gradient| update(weight, mean, square, *gradient));
        ndarray::Zip::from(&mut self.constant)
            .and(&mut self.means.1)
            .and(&mut self.squares.1)
            .and(constant)
            .for_each(|weight, mean, square, gradient| update(weight, mean, square, *gradient));
    }

    fn layer(&self) -> Layer {
        Layer {
            outputs: self.weights.ncols(),
            weights: self.weights.iter().copied().collect(),
            constant: self.constant.to_vec(),
        }
    }
}

/// A model that has heard all sounds `epochs` times, each time in another way.
pub(crate) fn train(sounds: &[Sound], epochs: usize, seed: u64) -> Model {
    let mut chance = Chance(seed);
    let sizes = [[INPUTS, HIDDEN[0]], [HIDDEN[0], HIDDEN[1]], [HIDDEN[1], OUTPUTS]];
    let mut layers = sizes.map(|[inputs, outputs]| Weights::new(inputs, outputs, &mut chance));
    let mut step = 0;
    for epoch in 0..epochs {
        let heard: Vec<Frames> = sounds
            .iter()
            .flat_map(|sound| std::iter::repeat_n(sound, times(sound)))
            .map(|sound| frames(sound, &mut chance))
            .collect();
        let mut places: Vec<(usize, usize)> = Vec::new();
        let mut counts = [1.0_f32; OUTPUTS];
        for (sound, frames) in heard.iter().enumerate() {
            for (frame, viseme) in frames.visemes.iter().enumerate() {
                if let Some(viseme) = viseme
                    && frame + AFTER < frames.features.len()
                {
                    places.push((sound, frame));
                    counts[*viseme] += 1.0;
                }
            }
        }
        for index in (1..places.len()).rev() {
            places.swap(index, chance.next() as usize % (index + 1));
        }
        // Rare visemes count for more, though not for as much as they are rare.
        let mean = places.len() as f32 / OUTPUTS as f32;
        let worth = counts.map(|count| (mean / count).powf(0.35));
        let steps = epochs * places.len() / BATCH;
        let (mut loss, mut right) = (0.0, 0);
        for batch in places.chunks_exact(BATCH) {
            step += 1;
            let part = step as f32 / steps as f32;
            let rate = RATE * (0.01 + 0.99 * 0.5 * (1.0 + (std::f32::consts::PI * part.min(1.0)).cos()));
            let (inputs, wanted) = rows(&heard, batch, &mut chance);
            let (one_loss, one_right) = learn(&mut layers, &inputs, &wanted, &worth, step, rate, &mut chance);
            loss += one_loss;
            right += one_right;
        }
        let count = places.len() / BATCH * BATCH;
        println!(
            "epoch {:2}: {count} frames, loss {:.3}, right {:.1} %",
            epoch + 1,
            loss / count.max(1) as f32,
            100.0 * right as f32 / count.max(1) as f32
        );
    }
    Model { layers: layers.map(|layer| layer.layer()) }
}

/// How often a sound is heard in an epoch: those made of recorded voices more often than those of formants.
fn times(sound: &Sound) -> usize {
    let name = sound.path.file_name().unwrap_or_default();
    if name.to_string_lossy().starts_with("espeak") { 1 } else { 2 }
}

/// The inputs of a batch, a row each, and the visemes.
fn rows(heard: &[Frames], batch: &[(usize, usize)], chance: &mut Chance) -> (Array2<f32>, Vec<usize>) {
    let mut inputs = Vec::with_capacity(batch.len() * INPUTS);
    let mut wanted = Vec::with_capacity(batch.len());
    for (sound, frame) in batch {
        let frames = &heard[*sound];
        let start = inputs.len();
        for offset in 0..BEFORE + 1 + AFTER {
            // Before the beginning it is as silent as in the first frame.
            let index = (frame + offset).saturating_sub(BEFORE);
            inputs.extend(frames.features[index]);
        }
        if chance.part() < HIDDEN_BANDS {
            hide(&mut inputs[start..], chance);
        }
        wanted.push(frames.visemes[*frame].unwrap_or(0));
    }
    debug_assert_eq!(inputs.len(), batch.len() * (BEFORE + 1 + AFTER) * FEATURES);
    let inputs = Array2::from_shape_vec((batch.len(), INPUTS), inputs).unwrap_or_default();
    (inputs, wanted)
}

/// Takes a few neighbouring bands or frames away (D. Park and others, "SpecAugment", 2019).
fn hide(inputs: &mut [f32], chance: &mut Chance) {
    let wide = chance.next() as usize;
    let (first, count) = (chance.next() as usize, 1 + wide % 4);
    for (index, frame) in inputs.chunks_exact_mut(FEATURES).enumerate() {
        if wide.is_multiple_of(3) {
            // Not the frame that is named.
            if index != BEFORE && (index + first) % (BEFORE + AFTER) < count {
                frame.fill(0.0);
            }
        } else {
            let first = first % (FEATURES - count);
            frame[first..first + count].fill(0.0);
        }
    }
}

/// One step; the loss and how many frames were right before it.
fn learn(
    layers: &mut [Weights; 3],
    inputs: &Array2<f32>,
    wanted: &[usize],
    worth: &[f32; OUTPUTS],
    step: i32,
    rate: f32,
    chance: &mut Chance,
) -> (f32, usize) {
    let mut pause = |values: &mut Array2<f32>| {
        values.mapv_inplace(|value| {
            let paused = chance.part() < PAUSED;
            if paused { 0.0 } else { value.max(0.0) / (1.0 - PAUSED) }
        });
    };
    let mut first = layers[0].run(inputs);
    pause(&mut first);
    let mut second = layers[1].run(&first);
    pause(&mut second);
    let mut out = layers[2].run(&second);
    let (mut loss, mut right) = (0.0, 0);
    for (mut row, wanted) in out.axis_iter_mut(Axis(0)).zip(wanted) {
        let most = row.fold(f32::MIN, |most, value| most.max(*value));
        if row[*wanted] >= most {
            right += 1;
        }
        row.mapv_inplace(|value| (value - most).exp());
        let sum = row.sum();
        loss -= (row[*wanted] / sum).max(1e-9).ln();
        for (viseme, value) in row.iter_mut().enumerate() {
            let target = DOUBT / OUTPUTS as f32 + if viseme == *wanted { 1.0 - DOUBT } else { 0.0 };
            *value = worth[*wanted] * (*value / sum - target) / inputs.nrows() as f32;
        }
    }
    let back = |gradient: &Array2<f32>, layer: &Weights, values: &Array2<f32>| {
        let mut back = gradient.dot(&layer.weights.t());
        ndarray::Zip::from(&mut back).and(values).for_each(|back, value| {
            *back = if *value > 0.0 { *back / (1.0 - PAUSED) } else { 0.0 };
        });
        back
    };
    let at_second = back(&out, &layers[2], &second);
    let at_first = back(&at_second, &layers[1], &first);
    layers[2].learn(&second.t().dot(&out), &out.sum_axis(Axis(0)), step, rate);
    layers[1].learn(&first.t().dot(&at_second), &at_second.sum_axis(Axis(0)), step, rate);
    layers[0].learn(&inputs.t().dot(&at_first), &at_first.sum_axis(Axis(0)), step, rate);
    (loss, right)
}
