//! The matrix that turns the head.

use crate::turn::Matrix;

/// The sixteen numbers of a matrix, in the order in which they stand.
#[derive(Debug, Default)]
pub(super) struct Numbers {
    numbers: [f64; 16],
    count: usize,
    /// Whether they stand in rows of their own.
    pub(super) has_rows: bool,
}

impl Numbers {
    /// Appends a number; `None` if there are sixteen already.
    pub(super) fn push(&mut self, number: f64) -> Option<()> {
        *self.numbers.get_mut(self.count)? = number;
        self.count += 1;
        Some(())
    }

    pub(super) fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// The rows of its rotation, without its scale.
    pub(super) fn rows(&self) -> Option<Matrix> {
        if self.count != 16 || self.numbers.iter().any(|number| !number.is_finite()) {
            return None;
        }
        let at = |index: usize| self.numbers.get(index).copied().unwrap_or_default();
        // Bare numbers stand column by column, unless the places of the last row, 0 0 0 1, hold something
        // else.
        let is_by_rows = self.has_rows || [3, 7, 11].iter().any(|index| at(*index) != 0.0);
        let (row_step, column_step) = if is_by_rows { (4, 1) } else { (1, 4) };
        let mut rows = [[0.0; 3]; 3];
        for column in 0..3 {
            let numbers = [0, 1, 2].map(|row| at(row * row_step + column * column_step));
            let length = numbers.iter().map(|number| number * number).sum::<f64>().sqrt();
            if !(length.is_finite() && length > 1e-9) {
                return None;
            }
            for (row, number) in rows.iter_mut().zip(numbers) {
                *row.get_mut(column)? = number / length;
            }
        }
        Some(rows)
    }
}
