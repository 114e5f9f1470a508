//! Values where no map is written: the ones whose displacements come closest to those wanted.

/// Why displacements cannot be solved for.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum SolveError {
    /// A list has another length than the others.
    #[error("{what}: expected {expected}, found {found}")]
    Length {
        /// Which list.
        what: &'static str,
        /// Its right length.
        expected: usize,
        /// Its length.
        found: usize,
    },
    /// A range whose ends are no numbers, or in the wrong order.
    #[error("range {0}: expected two numbers, the lower one first")]
    Range(usize),
}

/// Share of the largest square of a displacement field that is added to each: fields that are the same, or 0,
/// then share what is wanted, and the answer is the only one.
const RIDGE: f64 = 1e-9;
/// Share of the scale of the right side by which a slope may miss its sign.
const TOLERANCE: f64 = 1e-10;

/// Finds values of a space on an avatar, whose displacement fields (what each value at 1 does to each
/// vertex, as a difference) are given, so that the vertices come closest to where they should be; each value
/// stays in its range.
///
/// It is a least-squares problem with bounds, solved by active sets (Stark and Parker, "Bounded-variable
/// least-squares: an algorithm and applications", Computational Statistics 10, 1995) on the normal equations.
#[derive(Clone, Debug)]
pub struct Solver<'a> {
    fields: &'a [&'a [[f32; 3]]],
    vertices: usize,
    gram: Vec<f64>,
    right: Vec<f64>,
    ranges: Vec<[f64; 2]>,
    values: Vec<f64>,
    work: Work,
}

impl<'a> Solver<'a> {
    /// Prepares for fields of one length, each with the range of its value.
    ///
    /// # Errors
    /// Lengths that differ; a range that is none.
    pub fn new(fields: &'a [&'a [[f32; 3]]], ranges: &[[f32; 2]]) -> Result<Self, SolveError> {
        let count = fields.len();
        let vertices = fields.first().map_or(0, |field| field.len());
        let check = |what, expected, found| match expected == found {
            true => Ok(()),
            false => Err(SolveError::Length { what, expected, found }),
        };
        fields.iter().try_for_each(|field| check("vertices of a field", vertices, field.len()))?;
        check("ranges", count, ranges.len())?;
        let mut gram = vec![0.0; count * count];
        for (row, slots) in gram.chunks_exact_mut(count.max(1)).enumerate() {
            for (slot, other) in slots.iter_mut().zip(fields) {
                *slot = fields.get(row).map_or(0.0, |field| dot(field, other));
            }
        }
        let ranges: Vec<_> = ranges.iter().map(|range| range.map(f64::from)).collect();
        check_ranges(&ranges)?;
        let work = Work::new(count);
        Ok(Self { fields, vertices, gram, right: vec![0.0; count], ranges, values: vec![0.0; count], work })
    }

    /// Finds the values for a wanted displacement of each vertex. Displacements that are no numbers count
    /// as 0. Allocates nothing.
    ///
    /// # Errors
    /// Another number of vertices than the fields have, or of values than there are fields.
    pub fn solve(&mut self, wanted: &[[f32; 3]], values: &mut [f32]) -> Result<(), SolveError> {
        let check = |what, expected, found| match expected == found {
            true => Ok(()),
            false => Err(SolveError::Length { what, expected, found }),
        };
        check("wanted displacements", self.vertices, wanted.len())?;
        check("values", self.fields.len(), values.len())?;
        for (slot, field) in self.right.iter_mut().zip(self.fields) {
            *slot = dot(field, wanted);
        }
        self.work.solve(&self.gram, &self.right, &self.ranges, &mut self.values);
        for (slot, value) in values.iter_mut().zip(&self.values) {
            *slot = *value as f32;
        }
        Ok(())
    }
}

/// The `x` within `ranges` with the least `½ xᵀ gram x − rightᵀ x`; `gram` is a symmetric matrix without
/// negative eigenvalues, row by row.
///
/// # Errors
/// Lengths that do not fit; a range that is none.
pub fn least_squares(gram: &[f64], right: &[f64], ranges: &[[f64; 2]]) -> Result<Vec<f64>, SolveError> {
    let count = right.len();
    for (what, expected, found) in
        [("entries of the matrix", count * count, gram.len()), ("ranges", count, ranges.len())]
    {
        if expected != found {
            return Err(SolveError::Length { what, expected, found });
        }
    }
    check_ranges(ranges)?;
    let mut values = vec![0.0; count];
    Work::new(count).solve(gram, right, ranges, &mut values);
    Ok(values)
}

fn check_ranges(ranges: &[[f64; 2]]) -> Result<(), SolveError> {
    let is_wrong = |range: &[f64; 2]| !(range[0] <= range[1] && range.iter().all(|end| end.is_finite()));
    ranges.iter().position(is_wrong).map_or(Ok(()), |place| Err(SolveError::Range(place)))
}

fn dot(a: &[[f32; 3]], b: &[[f32; 3]]) -> f64 {
    let product = |(a, b): (&f32, &f32)| f64::from(*a) * f64::from(*b);
    let sum = a.iter().flatten().zip(b.iter().flatten()).map(product);
    sum.filter(|product| product.is_finite()).sum()
}

/// Where a value is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Place {
    Least,
    Most,
    Free,
}

/// Room for one solution.
#[derive(Clone, Debug)]
struct Work {
    places: Vec<Place>,
    free: Vec<usize>,
    factor: Vec<f64>,
    step: Vec<f64>,
}

impl Work {
    fn new(count: usize) -> Self {
        Self {
            places: vec![Place::Least; count],
            free: Vec::with_capacity(count),
            factor: vec![0.0; count * count],
            step: vec![0.0; count],
        }
    }

    fn solve(&mut self, gram: &[f64], right: &[f64], ranges: &[[f64; 2]], x: &mut [f64]) {
        let count = right.len();
        let scale = (0..count).map(|at| gram[at * count + at]).fold(0.0, f64::max);
        let ridge = RIDGE * scale;
        let tolerance = TOLERANCE * right.iter().fold(scale, |most, value| most.max(value.abs()));
        self.places.fill(Place::Least);
        self.free.clear();
        for (value, range) in x.iter_mut().zip(ranges) {
            *value = range[0];
        }
        // Each round ends in another set of free values with a lower sum; the bound is for rounding.
        for _ in 0..8 * count + 8 {
            let slope = |at: usize, x: &[f64]| {
                let row = gram.get(at * count..(at + 1) * count).unwrap_or_default();
                row.iter().zip(x).map(|(g, x)| g * x).sum::<f64>() + ridge * x[at] - right[at]
            };
            let gain = |at: usize| match self.places[at] {
                Place::Free => 0.0,
                Place::Least => -slope(at, x),
                Place::Most => slope(at, x),
            };
            let can_move = |at: &usize| ranges[*at][0] < ranges[*at][1];
            let best =
                (0..count).filter(can_move).map(|at| (gain(at), at)).max_by(|a, b| a.0.total_cmp(&b.0));
            let Some((_, at)) = best.filter(|(gain, _)| *gain > tolerance) else { return };
            self.places[at] = Place::Free;
            self.free.push(at);
            while !self.step_inside(gram, right, ranges, ridge, x) {}
        }
    }

    /// Goes to the least sum of squares over the free values, or until the first of them is at an end of
    /// its range, which it then keeps. Returns whether none was.
    fn step_inside(
        &mut self,
        gram: &[f64],
        right: &[f64],
        ranges: &[[f64; 2]],
        ridge: f64,
        x: &mut [f64],
    ) -> bool {
        let count = right.len();
        let free = self.free.len();
        // The slopes of free values, turned around, become the steps that remove them.
        for (row, &at) in self.free.iter().enumerate() {
            let line = gram.get(at * count..(at + 1) * count).unwrap_or_default();
            let product: f64 = line.iter().zip(x.iter()).map(|(g, x)| g * x).sum();
            self.step[row] = right[at] - product - ridge * x[at];
            for (column, &other) in self.free.iter().enumerate().take(row + 1) {
                self.factor[row * count + column] = line[other] + if row == column { ridge } else { 0.0 };
            }
        }
        cholesky(&mut self.factor, count, free, ridge);
        substitute(&self.factor, count, &mut self.step[..free]);
        let mut share = 1.0;
        let mut stops = None;
        for (row, &at) in self.free.iter().enumerate() {
            let step = self.step[row];
            let end = if step > 0.0 { ranges[at][1] } else { ranges[at][0] };
            let room = (end - x[at]) / step;
            if step != 0.0 && room < share {
                share = room.max(0.0);
                stops = Some((row, at, if step > 0.0 { Place::Most } else { Place::Least }, end));
            }
        }
        for (row, &at) in self.free.iter().enumerate() {
            x[at] = (x[at] + share * self.step[row]).clamp(ranges[at][0], ranges[at][1]);
        }
        let Some((row, at, place, end)) = stops else { return true };
        x[at] = end;
        self.places[at] = place;
        self.free.remove(row);
        false
    }
}

/// Replaces the lower triangle of the first `size` rows, of `stride` entries each, by its Cholesky factor.
fn cholesky(matrix: &mut [f64], stride: usize, size: usize, least: f64) {
    for row in 0..size {
        for column in 0..=row {
            let product: f64 =
                (0..column).map(|k| matrix[row * stride + k] * matrix[column * stride + k]).sum();
            let rest = matrix[row * stride + column] - product;
            matrix[row * stride + column] = match row == column {
                // What rounding leaves of a field that the others make up.
                true => rest.max(least).max(f64::MIN_POSITIVE).sqrt(),
                false => rest / matrix[column * stride + column],
            };
        }
    }
}

/// Solves with the factor, there and back, in place.
fn substitute(factor: &[f64], stride: usize, x: &mut [f64]) {
    let size = x.len();
    for row in 0..size {
        let sum: f64 = (0..row).map(|k| factor[row * stride + k] * x[k]).sum();
        x[row] = (x[row] - sum) / factor[row * stride + row];
    }
    for row in (0..size).rev() {
        let sum: f64 = (row + 1..size).map(|k| factor[k * stride + row] * x[k]).sum();
        x[row] = (x[row] - sum) / factor[row * stride + row];
    }
}
