//! From sRGB to what video is made of: ITU-R BT.709, luma from 16 to 235 and chroma from 16 to 240, chroma at
//! half the resolution.

/// Weights of red, green and blue in luma.
const LUMA: [f32; 3] = [0.2126, 0.7152, 0.0722];

/// Smaller pictures are not encoded.
const SMALLEST_SIDE: usize = 16;

/// Planes of a picture with even sides of at least 16 pixels; what is missing repeats the last column and
/// row.
pub(crate) struct Planes {
    pub(crate) width: usize,
    pub(crate) height: usize,
    pub(crate) y: Vec<u8>,
    pub(crate) u: Vec<u8>,
    pub(crate) v: Vec<u8>,
    /// Colours of two rows, in which chroma is found.
    rows: [Vec<[f32; 3]>; 2],
}

impl Planes {
    pub(crate) fn new(width: usize, height: usize) -> Self {
        let side = |side: usize| side.next_multiple_of(2).max(SMALLEST_SIDE);
        let (width, height) = (side(width), side(height));
        let (y, quarter) = (vec![0; width * height], vec![0; width * height / 4]);
        Self {
            width,
            height,
            y,
            u: quarter.clone(),
            v: quarter,
            rows: [vec![], vec![]].map(|_: Vec<()>| vec![[0.0; 3]; width]),
        }
    }

    /// Takes over a picture of `width` pixels a row, on black where it is not opaque.
    pub(crate) fn fill(&mut self, rgba: &[u8], width: usize) {
        let half = self.width / 2;
        let last = (rgba.len() / (width * 4)).saturating_sub(1);
        for pair in 0..self.height / 2 {
            for (half_row, colors) in self.rows.iter_mut().enumerate() {
                let row = pair * 2 + half_row;
                let pixels = &rgba[row.min(last) * width * 4..][..width * 4];
                for (column, color) in colors.iter_mut().enumerate() {
                    let at = column.min(width - 1) * 4;
                    *color = on_black(&pixels[at..at + 4]);
                    self.y[row * self.width + column] = luma_code(luma(*color));
                }
            }
            let [above, below] = &self.rows;
            for column in 0..half {
                // Chroma lies on the left one of each two columns, and between the two rows.
                let at = |column: usize| {
                    let (a, b) = (above[column], below[column]);
                    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
                };
                let (left, here, right) =
                    (at((column * 2).saturating_sub(1)), at(column * 2), at(column * 2 + 1));
                let color: [f32; 3] = std::array::from_fn(|i| (left[i] + 2.0 * here[i] + right[i]) / 8.0);
                let luma = luma(color);
                self.u[pair * half + column] = chroma_code((color[2] - luma) / (2.0 - 2.0 * LUMA[2]));
                self.v[pair * half + column] = chroma_code((color[0] - luma) / (2.0 - 2.0 * LUMA[0]));
            }
        }
    }
}

/// Red, green and blue from 0 to 1.
fn on_black(pixel: &[u8]) -> [f32; 3] {
    let alpha = f32::from(pixel[3]) / (255.0 * 255.0);
    [0, 1, 2].map(|channel| f32::from(pixel[channel]) * alpha)
}

fn luma(color: [f32; 3]) -> f32 {
    LUMA[0] * color[0] + LUMA[1] * color[1] + LUMA[2] * color[2]
}

fn luma_code(luma: f32) -> u8 {
    (16.0 + 219.0 * luma).round() as u8
}

fn chroma_code(chroma: f32) -> u8 {
    (128.0 + 224.0 * chroma).round() as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_have_the_codes_of_the_recommendation() {
        // 8-bit codes of the bars of 100 %, as BT.709 defines them: white, yellow, cyan, green, magenta, red,
        // blue, black.
        let bars = [
            ([255, 255, 255], [235, 128, 128]),
            ([255, 255, 0], [219, 16, 138]),
            ([0, 255, 255], [188, 154, 16]),
            ([0, 255, 0], [173, 42, 26]),
            ([255, 0, 255], [78, 214, 230]),
            ([255, 0, 0], [63, 102, 240]),
            ([0, 0, 255], [32, 240, 118]),
            ([0, 0, 0], [16, 128, 128]),
        ];
        let mut planes = Planes::new(3, 1);
        assert_eq!((planes.width, planes.height), (16, 16));
        for ([r, g, b], expected) in bars {
            planes.fill(&[r, g, b, 255].repeat(3), 3);
            assert!(planes.y.iter().all(|y| *y == expected[0]), "{r} {g} {b}");
            assert!(planes.u.iter().all(|u| *u == expected[1]), "{r} {g} {b}: {}", planes.u[0]);
            assert!(planes.v.iter().all(|v| *v == expected[2]), "{r} {g} {b}: {}", planes.v[0]);
        }
        planes.fill(&[255, 255, 255, 0].repeat(3), 3);
        assert!(planes.y.iter().all(|y| *y == 16), "nothing is black");
    }

    #[test]
    fn chroma_is_that_of_the_left_columns() {
        let mut planes = Planes::new(16, 16);
        let row = |column: usize| if column < 8 { [255, 0, 0, 255] } else { [0, 0, 255, 255] };
        planes.fill(&(0..16).flat_map(row).collect::<Vec<u8>>().repeat(16), 16);
        // Column 8 is blue; a quarter of its chroma is that of the red column before it.
        let mixed = |red: f32, blue: f32| (0.75 * blue + 0.25 * red).round() as u8;
        assert_eq!(planes.u[3..6], [102, mixed(102.3, 240.0), 240]);
        assert_eq!(planes.v[3..6], [240, mixed(240.0, 117.7), 118]);
    }
}
