use avatar_mesh::drivers::ShapeDrivers;

/// What moves shapes where that is not simply one number for each: shapes that show how a slider is on its
/// way, and those that count as products of others.
#[derive(Clone, Debug, PartialEq)]
pub struct Sliders {
    /// Names of the sliders, in the order of their values; those of different nodes may be the same. Controls
    /// drive these.
    pub names: Vec<String>,
    /// Per shape of [`crate::Pack::shapes`] the sliders that it follows, as positions in `names`.
    pub of_shapes: Vec<Vec<usize>>,
    /// From values of sliders to weights of [`crate::Pack::shapes`].
    pub drivers: ShapeDrivers,
}
