use glam::Vec3;

/// A place at which shapes of a face wrinkle its skin. How the wrinkles run is a picture's business: it says
/// how deep each groove is, and this how much of that is there.
#[derive(Clone, Debug, PartialEq)]
pub struct Wrinkle {
    /// Its middle, at bind pose.
    pub center: Vec3,
    /// How far it reaches.
    pub radius: f32,
    /// The shapes that wrinkle it, by the numbers of their weights, and how strongly each does at weight 1.
    pub shapes: Vec<(usize, f32)>,
}

impl Wrinkle {
    /// The most places of a face; those behind them are not shown.
    pub const MOST: usize = 16;

    /// How strongly the place is wrinkled with these weights of shapes: 0 to 1. Shapes that there are no
    /// weights of count as at rest.
    #[expect(clippy::manual_clamp, reason = "NaN becomes 0")]
    pub fn weight(&self, weights: &[f32]) -> f32 {
        let of_one = |(shape, gain): &(usize, f32)| gain * weights.get(*shape).copied().unwrap_or(0.0);
        self.shapes.iter().map(of_one).sum::<f32>().max(0.0).min(1.0)
    }

    /// The share of that at a point at bind pose: 1 within the inner third of the radius, 0 beyond it, smooth
    /// between. The twin of `wrinkled` in the shader `deform.wgsl`.
    #[expect(clippy::manual_clamp, reason = "NaN becomes 0")]
    pub fn reach(&self, point: Vec3) -> f32 {
        let near = (1.5 * (1.0 - self.center.distance(point) / self.radius)).max(0.0).min(1.0);
        near * near * (3.0 - 2.0 * near)
    }
}
