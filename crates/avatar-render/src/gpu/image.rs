/// A picture: 8 bits per channel, straight alpha, row by row from the top.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Image {
    /// Pixels across.
    pub width: u32,
    /// Pixels down.
    pub height: u32,
    /// Red, green, blue, alpha: `4 · width · height` bytes.
    pub rgba: Vec<u8>,
}

/// A picture whose bytes do not fit its size.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("expected {expected} bytes of RGBA for {width}×{height} pixels (at least 1×1), found {found}")]
pub struct ImageSizeError {
    /// Pixels across.
    pub width: u32,
    /// Pixels down.
    pub height: u32,
    /// `4 · width · height`.
    pub expected: u64,
    /// Length of the bytes.
    pub found: u64,
}

impl Image {
    /// Checks that there are pixels, and exactly those that the size promises.
    ///
    /// # Errors
    /// The size is 0, or the number of bytes does not match it.
    pub fn check(&self) -> Result<(), ImageSizeError> {
        let (width, height) = (self.width, self.height);
        let expected = (u64::from(width) * u64::from(height)).saturating_mul(4);
        let found = self.rgba.len() as u64;
        match expected > 0 && expected == found {
            true => Ok(()),
            false => Err(ImageSizeError { width, height, expected, found }),
        }
    }

    /// The pixel in column `x` of row `y`; transparent black outside.
    pub fn pixel(&self, x: u32, y: u32) -> [u8; 4] {
        let at = (u64::from(y) * u64::from(self.width) + u64::from(x)) * 4;
        let inside = x < self.width;
        let bytes = usize::try_from(at).ok().filter(|_| inside).and_then(|at| self.rgba.get(at..at + 4));
        bytes.and_then(|bytes| bytes.try_into().ok()).unwrap_or_default()
    }
}
