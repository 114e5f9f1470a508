/// Where on a head a strand grows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub enum Region {
    /// The head's own hair.
    Scalp = 0,
    /// Above the eyes.
    Brows = 1,
    /// At the edges of the lids.
    Lashes = 2,
}
