/// Pixels of a rectangle within a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Region {
    pub(crate) left: usize,
    pub(crate) top: usize,
    pub(crate) width: usize,
    pub(crate) height: usize,
}

impl Region {
    /// The bytes of its rows in an RGBA picture that is `width` pixels wide.
    pub(crate) fn rows<'a>(&self, rgba: &'a [u8], width: usize) -> impl Iterator<Item = &'a [u8]> + use<'a> {
        let Self { left, top, width: across, height } = *self;
        let rows = rgba.chunks_exact(width * 4).skip(top).take(height);
        rows.filter_map(move |row| row.get(left * 4..(left + across) * 4))
    }
}

/// The smallest rectangle outside of which two RGBA pictures agree; one pixel where they are the same, since
/// a frame has to show something.
pub(crate) fn changed(before: &[u8], after: &[u8], width: usize) -> Region {
    let rows = || before.chunks_exact(width * 4).zip(after.chunks_exact(width * 4));
    let differs = |(a, b): (&[u8], &[u8])| a != b;
    let Some(top) = rows().position(differs) else { return Region { left: 0, top: 0, width: 1, height: 1 } };
    let bottom = rows().rposition(differs).unwrap_or(top);
    let (mut left, mut right) = (width - 1, 0);
    for (a, b) in rows().skip(top).take(bottom + 1 - top) {
        let pixels = || a.chunks_exact(4).zip(b.chunks_exact(4));
        if let Some(first) = pixels().take(left).position(differs) {
            left = first;
        }
        if let Some(last) = pixels().skip(right).rposition(differs) {
            right += last;
        }
    }
    Region { left, top, width: right + 1 - left.min(right), height: bottom + 1 - top }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn the_rectangle_is_the_smallest(
            width in 1usize..9,
            height in 1usize..9,
            places in prop::collection::vec((0usize..9, 0usize..9), 0..4),
        ) {
            let before = vec![7; width * height * 4];
            let mut after = before.clone();
            let places: Vec<_> = places.into_iter().map(|(x, y)| (x % width, y % height)).collect();
            places.iter().for_each(|(x, y)| after[(y * width + x) * 4 + 2] = 8);
            let xs = || places.iter().map(|place| place.0);
            let ys = || places.iter().map(|place| place.1);
            let expected = match (xs().min(), xs().max(), ys().min(), ys().max()) {
                (Some(left), Some(right), Some(top), Some(bottom)) => {
                    Region { left, top, width: right + 1 - left, height: bottom + 1 - top }
                }
                _ => Region { left: 0, top: 0, width: 1, height: 1 },
            };
            prop_assert_eq!(changed(&before, &after, width), expected);
        }
    }
}
