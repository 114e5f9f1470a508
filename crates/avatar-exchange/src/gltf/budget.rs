use crate::ImportError;

const BASE_BYTES: u64 = 256 << 20;
const BYTES_PER_BYTE: u64 = 64;

/// How much may still be unpacked. A few bytes can describe gigabytes (accessors without data, many primitives that share one
/// accessor), so what a file unpacks to is limited by what it is: 256 MiB and 64 times its bytes.
#[derive(Debug)]
pub(super) struct Budget {
    left: u64,
}

impl Budget {
    pub(super) fn new(input_bytes: usize) -> Self {
        let mut budget = Self { left: BASE_BYTES };
        budget.grow(input_bytes);
        budget
    }

    /// More input came to light.
    pub(super) fn grow(&mut self, input_bytes: usize) {
        self.left = self.left.saturating_add((input_bytes as u64).saturating_mul(BYTES_PER_BYTE));
    }

    /// Takes what `count` elements of `size` bytes need, before they are allocated.
    pub(super) fn take(
        &mut self,
        place: impl Fn() -> String,
        count: usize,
        size: usize,
    ) -> Result<(), ImportError> {
        let bytes = (count as u64).saturating_mul(size as u64);
        match self.left.checked_sub(bytes) {
            Some(left) => {
                self.left = left;
                Ok(())
            }
            None => {
                let expected = format!("at most {} bytes more in a file of this size", self.left);
                Err(ImportError::new(place(), expected, bytes.to_string()))
            }
        }
    }
}
