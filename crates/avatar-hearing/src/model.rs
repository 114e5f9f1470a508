//! A small network of three layers that hears a fifth of a second and names the viseme in it.
//!
//! What it takes, how it is stored: `MIMIKEAR`, the version as a byte, three zeros, then three layers: rows
//! and columns as u32, then the row's weights as i16 after a scale as f32, for each of the columns (inputs)
//! and last for the constant. All little-endian. The program that trains it is `hearing-trainer`.

use crate::features::FEATURES;

/// Frames before the one that is named.
pub const BEFORE: usize = 12;

/// Frames behind it, and so the delay.
pub const AFTER: usize = 4;

/// Numbers that the network takes: those of all frames, the oldest first.
pub const INPUTS: usize = (BEFORE + 1 + AFTER) * FEATURES;

/// Neurons of the two layers between.
pub const HIDDEN: [usize; 2] = [224, 96];

/// Number of visemes.
pub const OUTPUTS: usize = 15;

/// What a file of a model begins with.
pub const MAGIC: [u8; 12] = *b"MIMIKEAR\x01\0\0\0";

/// What the shipped model is.
const SHIPPED: &[u8] = include_bytes!("model.bin");

/// One layer: `outputs[o] = constant[o] + sum over i of inputs[i] * weights[i][o]`.
#[derive(Clone, Debug, PartialEq)]
pub struct Layer {
    /// Numbers that it makes.
    pub outputs: usize,
    /// `weights[i * outputs + o]`.
    pub weights: Vec<f32>,
    /// One for each output.
    pub constant: Vec<f32>,
}

impl Layer {
    /// The layer's output for these inputs, into `out`.
    pub fn run(&self, inputs: &[f32], out: &mut [f32]) {
        out.copy_from_slice(&self.constant);
        for (input, weights) in inputs.iter().zip(self.weights.chunks_exact(self.outputs)) {
            if *input != 0.0 {
                for (sum, weight) in out.iter_mut().zip(weights) {
                    *sum += input * weight;
                }
            }
        }
    }
}

/// The network.
#[derive(Clone, Debug, PartialEq)]
pub struct Model {
    /// From the frames to the visemes.
    pub layers: [Layer; 3],
}

/// Room for the numbers between the layers.
#[derive(Clone, Debug)]
pub(crate) struct Between {
    first: [f32; HIDDEN[0]],
    second: [f32; HIDDEN[1]],
}

impl Between {
    pub(crate) fn new() -> Self {
        Self { first: [0.0; HIDDEN[0]], second: [0.0; HIDDEN[1]] }
    }
}

impl Model {
    /// The shipped one.
    #[must_use]
    pub fn shipped() -> Option<Self> {
        Self::from_bytes(SHIPPED)
    }

    /// A model from its file; `None` where that is not one of this version.
    #[must_use]
    pub fn from_bytes(bytes: &[u8]) -> Option<Self> {
        let mut rest = bytes.strip_prefix(&MAGIC)?;
        let sizes = [[INPUTS, HIDDEN[0]], [HIDDEN[0], HIDDEN[1]], [HIDDEN[1], OUTPUTS]];
        let mut layers = Vec::with_capacity(sizes.len());
        for [inputs, outputs] in sizes {
            for size in [inputs, outputs] {
                let (stored, behind) = rest.split_first_chunk::<4>()?;
                rest = behind;
                if u32::from_le_bytes(*stored) as usize != size {
                    return None;
                }
            }
            let mut weights = Vec::with_capacity((inputs + 1) * outputs);
            for _ in 0..=inputs {
                let (scale, behind) = rest.split_first_chunk::<4>()?;
                let (row, behind) = behind.split_at_checked(2 * outputs)?;
                rest = behind;
                let scale = f32::from_le_bytes(*scale);
                if !scale.is_finite() || scale.abs() > 1.0 {
                    return None;
                }
                let (values, _) = row.as_chunks::<2>();
                weights.extend(values.iter().map(|value| f32::from(i16::from_le_bytes(*value)) * scale));
            }
            let constant = weights.split_off(inputs * outputs);
            layers.push(Layer { outputs, weights, constant });
        }
        let layers = layers.try_into().ok()?;
        rest.is_empty().then_some(Self { layers })
    }

    /// The model as a file, each weight rounded to one part in 32,767 of the largest in its row.
    #[must_use]
    pub fn to_bytes(&self) -> Vec<u8> {
        let mut bytes = MAGIC.to_vec();
        for layer in &self.layers {
            let inputs = layer.weights.len() / layer.outputs.max(1);
            for size in [inputs, layer.outputs] {
                bytes.extend((size as u32).to_le_bytes());
            }
            let rows = layer.weights.chunks_exact(layer.outputs.max(1)).chain([&layer.constant[..]]);
            for row in rows {
                let most = row.iter().fold(0.0_f32, |most, weight| most.max(weight.abs()));
                let scale = most / 32_767.0;
                bytes.extend(scale.to_le_bytes());
                for weight in row {
                    let part = if scale > 0.0 { libm::roundf(weight / scale) } else { 0.0 };
                    bytes.extend((part as i16).to_le_bytes());
                }
            }
        }
        bytes
    }

    /// How much of each viseme is heard in these [`INPUTS`], in parts of 1.
    pub(crate) fn name(&self, inputs: &[f32; INPUTS], between: &mut Between, out: &mut [f32; OUTPUTS]) {
        let Between { first, second } = between;
        self.layers[0].run(inputs, first);
        first.iter_mut().for_each(|value| *value = value.max(0.0));
        self.layers[1].run(first, second);
        second.iter_mut().for_each(|value| *value = value.max(0.0));
        self.layers[2].run(second, out);
        let most = out.iter().fold(f32::MIN, |most, value| most.max(*value));
        let mut sum = 0.0;
        for value in out.iter_mut() {
            *value = libm::expf(*value - most);
            sum += *value;
        }
        out.iter_mut().for_each(|value| *value /= sum);
    }
}
