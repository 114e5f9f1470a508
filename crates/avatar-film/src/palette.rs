use color_quant::NeuQuant;
use std::collections::{BTreeMap, BTreeSet, HashMap};

/// The most colours of a palette; one further entry is kept for what is transparent.
const MOST_COLORS: usize = 255;
/// How many pixels the search for colours looks at, about.
const LOOKS: usize = 20_000;
/// Bits of each channel by which colours are alike.
const ALIKE_BITS: u32 = 5;

type Color = [u8; 3];

/// Colours for the pixels of one frame.
pub(crate) struct Palette {
    /// Red, green, blue of each entry; at most [`MOST_COLORS`] entries.
    pub(crate) rgb: Vec<u8>,
    entries: HashMap<Color, u8>,
    /// What finds the nearest entry, where there are more colours than entries.
    nearest: Option<NeuQuant>,
}

impl Palette {
    /// The colours themselves where they are few enough, else those that serve the pixels best.
    pub(crate) fn of(pixels: &[Color]) -> Self {
        let mut colors = BTreeSet::new();
        for pixel in pixels {
            colors.insert(*pixel);
            if colors.len() > MOST_COLORS {
                return Self::fitted(pixels);
            }
        }
        let entries = colors.iter().zip(0..).map(|(color, index)| (*color, index)).collect();
        Self { rgb: colors.into_iter().flatten().collect(), entries, nearest: None }
    }

    fn fitted(pixels: &[Color]) -> Self {
        let looks = evened(pixels);
        let rgba: Vec<u8> = looks.iter().flat_map(|[r, g, b]| [*r, *g, *b, 255]).collect();
        // The search is slow to learn: it has to see few colours again and again.
        let rgba = rgba.repeat((LOOKS / looks.len().max(1)).max(1));
        let every = (looks.len() / LOOKS).clamp(1, 30) as i32;
        let nearest = NeuQuant::new(every, MOST_COLORS, &rgba);
        Self { rgb: nearest.color_map_rgb(), entries: HashMap::new(), nearest: Some(nearest) }
    }

    /// The entry for a colour that was among the pixels.
    pub(crate) fn index_of(&mut self, color: Color) -> u8 {
        let [r, g, b] = color;
        let find = || self.nearest.as_ref().map_or(0, |nearest| nearest.index_of(&[r, g, b, 255]) as u8);
        // Faces repeat their colours, and the search is slow.
        *self.entries.entry(color).or_insert_with(find)
    }

    /// The entry that no colour has.
    pub(crate) fn transparent(&self) -> u8 {
        (self.rgb.len() / 3) as u8
    }
}

/// Of colours that are alike only about the square root of how many there are: else the skin would leave no
/// entries to the eyes.
fn evened(pixels: &[Color]) -> Vec<Color> {
    let mut alike: BTreeMap<Color, Vec<Color>> = BTreeMap::new();
    for pixel in pixels {
        alike.entry(pixel.map(|channel| channel >> (8 - ALIKE_BITS))).or_default().push(*pixel);
    }
    let some = |colors: Vec<Color>| colors.into_iter().enumerate().filter(|(at, _)| at.isqrt().pow(2) == *at);
    alike.into_values().flat_map(some).map(|(_, color)| color).collect()
}
