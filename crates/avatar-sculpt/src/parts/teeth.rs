//! Two rows of teeth with gums; the tongue lies in the lower part.

use glam::{DVec2, DVec3};

use crate::{
    math::{cos, lerp, pow, sin},
    mesh::Part,
};

const PI: f64 = std::f64::consts::PI;

/// Widths of the upper teeth from the midline outward, and their lengths.
const UPPER: [(f64, f64); 7] =
    [(0.69, 0.92), (0.54, 0.84), (0.57, 0.87), (0.54, 0.76), (0.54, 0.72), (0.78, 0.66), (0.76, 0.62)];
/// The same for the lower teeth.
const LOWER: [(f64, f64); 7] =
    [(0.45, 0.84), (0.48, 0.84), (0.54, 0.88), (0.54, 0.72), (0.56, 0.64), (0.80, 0.52), (0.78, 0.48)];

/// The dental arch at a signed arc position: a place on it and the way along it.
struct Arch {
    half_width: f64,
    front: f64,
    back: f64,
}

impl Arch {
    fn at(&self, angle: f64) -> DVec3 {
        DVec3::new(self.half_width * sin(angle), 0.0, lerp(self.back, self.front, cos(angle)))
    }

    /// Angle at which the arc from the midline has the given length.
    fn angle_of(&self, length: f64) -> f64 {
        let (mut angle, mut run) = (0.0, 0.0);
        let mut last = self.at(0.0);
        while run < length && angle < 1.7 {
            angle += 0.002;
            let next = self.at(angle);
            run += (next - last).length();
            last = next;
        }
        angle
    }

    /// Outward direction at an angle.
    fn outward(&self, angle: f64) -> DVec3 {
        DVec3::new(sin(angle) / self.half_width, 0.0, cos(angle) / (self.front - self.back))
            .normalize_or_zero()
    }
}

/// The arch of the upper row, which is the wider one.
const UPPER_ARCH: Arch = Arch { half_width: 2.48, front: 3.74, back: 0.7 };

/// The level direction away from the rows of teeth: that of an ellipse like the upper arch through a place
/// before them.
#[must_use]
pub fn outward(p: DVec3) -> DVec3 {
    let Arch { half_width, front, back } = UPPER_ARCH;
    let depth = front - back;
    DVec3::new(p.x / (half_width * half_width), 0.0, (p.z - back).max(0.0) / (depth * depth))
        .normalize_or_zero()
}

/// Upper teeth and gum.
#[must_use]
pub fn upper() -> Part {
    row(&UPPER, &UPPER_ARCH, -4.93, -1.0)
}

/// Lower teeth, gum and tongue.
#[must_use]
pub fn lower() -> Part {
    let arch = Arch { half_width: 2.34, front: 3.56, back: 0.6 };
    let mut part = row(&LOWER, &arch, -6.54, 1.0);
    tongue(&mut part);
    part.finish();
    part
}

/// A row of teeth that grow from the gum's height in the direction `grow` (up 1, down −1).
fn row(sizes: &[(f64, f64)], arch: &Arch, gum_y: f64, grow: f64) -> Part {
    let mut part = Part::default();
    let mut run = 0.0;
    for (k, &(width, length)) in sizes.iter().enumerate() {
        let angle = arch.angle_of(run + 0.5 * width);
        run += width;
        for side in [1.0, -1.0] {
            tooth(&mut part, arch, side * angle, k, DVec3::new(width, length, gum_y), grow);
        }
    }
    gum(&mut part, arch, arch.angle_of(run + 0.1), gum_y, grow);
    part.finish();
    part
}

/// One tooth: a rounded block; front teeth taper to an edge, back teeth are broad. `size` is (width, length,
/// gum).
fn tooth(part: &mut Part, arch: &Arch, angle: f64, kind: usize, size: DVec3, grow: f64) {
    const ROWS: usize = 9;
    const COLUMNS: usize = 15;
    let outward = arch.outward(angle);
    let side = DVec3::new(outward.z, 0.0, -outward.x);
    let thickness = if kind < 3 { 0.34 } else { 0.62 };
    let root = 0.25;
    let centre =
        arch.at(angle) + DVec3::Y * (size.z + grow * 0.5 * (size.y - root)) - outward * (0.5 * thickness);
    part.add_grid(ROWS, COLUMNS, |r, c| {
        let lat = PI * (0.5 - r as f64 / (ROWS - 1) as f64);
        let lon = if c == COLUMNS - 1 { 0.0 } else { 2.0 * PI * c as f64 / (COLUMNS - 1) as f64 };
        let at_pole = r == 0 || r == ROWS - 1;
        let ring = if at_pole { 0.0 } else { block(cos(lat), 0.36) };
        let up = block(sin(lat), 0.45);
        // Toward the biting edge front teeth thin out and widen a trace.
        let tip = 0.5 + 0.5 * up * grow;
        let thin = if kind < 3 { lerp(1.0, 0.45, tip) } else { lerp(1.0, 0.9, tip) };
        let wide = lerp(0.86, 1.0, tip) * if kind == 2 { lerp(1.0, 0.84, tip * tip) } else { 1.0 };
        let p = centre
            + side * (0.498 * size.x * wide * ring * block(sin(lon), 0.7))
            + DVec3::Y * (0.5 * (size.y + root) * up)
            + outward * (0.5 * thickness * thin * ring * block(cos(lon), 0.7));
        let v = 0.5 - 0.5 * up * -grow;
        (p, DVec2::new(c as f64 / (COLUMNS - 1) as f64, 0.02 + 0.44 * v))
    });
}

/// Signed power: turns an ellipsoid into a rounded block.
fn block(x: f64, exponent: f64) -> f64 {
    x.signum() * pow(x.abs(), exponent)
}

/// The gum: a closed bead along the arch.
fn gum(part: &mut Part, arch: &Arch, end: f64, gum_y: f64, grow: f64) {
    const ALONG: usize = 57;
    const AROUND: usize = 15;
    part.add_grid(AROUND, ALONG, |r, c| {
        let angle = lerp(-end, end, c as f64 / (ALONG - 1) as f64);
        let around = if r == AROUND - 1 { 0.0 } else { 2.0 * PI * r as f64 / (AROUND - 1) as f64 };
        let shut = if c == 0 || c == ALONG - 1 { 0.0 } else { 1.0 };
        let outward = arch.outward(angle);
        let centre = arch.at(angle) + DVec3::Y * (gum_y - grow * 0.30) - outward * 0.33;
        let p = centre + (outward * (0.36 * cos(around)) - DVec3::Y * (0.42 * sin(around))) * shut;
        (p, DVec2::new(c as f64 / (ALONG - 1) as f64, 0.52 + 0.2 * r as f64 / (AROUND - 1) as f64))
    });
}

/// Whether a vertex of the lower part, known by its place in the picture, belongs to the tongue.
#[must_use]
pub fn is_tongue(uv: DVec2) -> bool {
    uv.y > 0.75
}

/// The tongue: flat and blunt, with a furrow along its middle.
fn tongue(part: &mut Part) {
    const ROWS: usize = 17;
    const COLUMNS: usize = 25;
    let centre = DVec3::new(0.0, -6.15, 1.25);
    part.add_grid(ROWS, COLUMNS, |r, c| {
        let lat = PI * r as f64 / (ROWS - 1) as f64;
        let lon = if c == COLUMNS - 1 { 0.0 } else { 2.0 * PI * c as f64 / (COLUMNS - 1) as f64 };
        let ring = if r == 0 || r == ROWS - 1 { 0.0 } else { sin(lat) };
        // Seen from above it is broad up to a blunt tip, from the side it thins out toward it.
        let broad = if ring == 0.0 { 0.0 } else { pow(ring, 0.72) };
        let (x, y) = (broad * cos(lon), ring * sin(lon));
        let furrow = 0.10 * crate::math::bell(x, 0.2) * y.max(0.0);
        let p = centre + DVec3::new(1.36 * x, 0.66 * y - furrow, 1.85 * cos(lat));
        (p, DVec2::new(c as f64 / (COLUMNS - 1) as f64, 0.76 + 0.22 * r as f64 / (ROWS - 1) as f64))
    });
}
