use std::f32::consts::PI;

/// Rings per exponential of the profile: errors stay below 0.001.
const RINGS: usize = 64;

/// What a white, translucent surface makes of a lamp of radiance 1, per channel, row by row:
///
/// - columns are the cosine between normal and lamp, `n_dot_l = 2u − 1`,
/// - rows are `s = v`, the scatter distance `d` times the curvature (1 / radius), 0 to 1,
///
/// with `u`, `v` at the middle of their texel. For small `s` it is `max(n_dot_l, 0)`.
///
/// Pre-integrated skin: E. Penner and G. Borshukov, GPU Pro 2, 2011, with the profile of P. Christensen and
/// B. Burley, "Approximate Reflectance Profiles for Efficient Subsurface Scattering", 2015: `R(r) =
/// (exp(−r/d) + exp(−r/3d)) / (8π d r)`; see [`crate::optics::diffusion_distance`] for `d`.
///
/// Penner integrates over a ring of the sphere. That makes and loses light, as points beside the ring are
/// left out, and has no limit for this profile: `∫ R(r) dr` grows without bound toward `r = 0`. So this
/// integrates over the whole sphere, where an area at chord `r` measures `r dr dφ` as in the plane, which
/// takes the pole of `R` away. What leaves one point arrives at others with the same weight either way: `2 ∫
/// D dn_dot_l = 1` for each row, so even light from all sides is reflected exactly as it comes in.
pub fn scatter_table(width: usize, height: usize) -> Vec<f32> {
    let mut table = Vec::with_capacity(width * height);
    for row in 0..height {
        let rings = rings((row as f32 + 0.5) / height as f32);
        table.extend((0..width).map(|column| {
            let n_dot_l = 2.0 * (column as f32 + 0.5) / width as f32 - 1.0;
            rings.iter().map(|ring| ring.weight * ring.mean_light(n_dot_l)).sum::<f32>()
        }));
    }
    table
}

/// A ring around a point of the unit sphere from which light arrives there below the surface.
struct Ring {
    weight: f32,
    /// Cosine and sine of the angle between the point and the ring, seen from the centre.
    cos: f32,
    sin: f32,
}

/// The profile with `d = s` on a sphere of radius 1, as rings.
fn rings(s: f32) -> Vec<Ring> {
    let exponentials = [s, 3.0 * s].map(|length| {
        // r from 0 to 2, the far pole; what a flat surface would scatter farther is spread over the sphere
        // instead.
        let reach = -(-2.0 / length).exp_m1();
        (length, reach, length * reach)
    });
    let total: f32 = exponentials.iter().map(|(.., weight)| weight).sum();
    let rings = exponentials.iter().flat_map(|&(length, reach, weight)| {
        (0..RINGS).map(move |i| {
            // Denser toward the far ones: they are few and alone light the dark side.
            let near = 1.0 - (i as f32 + 0.5) / RINGS as f32;
            let share = 1.0 - near * near;
            let chord = (-length * (-share * reach).ln_1p()).min(2.0);
            Ring {
                weight: 2.0 * near * weight / (total * RINGS as f32),
                cos: 1.0 - 0.5 * chord * chord,
                sin: chord * (1.0 - 0.25 * chord * chord).max(0.0).sqrt(),
            }
        })
    });
    rings.collect()
}

impl Ring {
    /// The mean of `max(n · l, 0)` over the ring around a point with `n_dot_l`: along the ring it is `a + b
    /// cos φ`.
    fn mean_light(&self, n_dot_l: f32) -> f32 {
        let a = n_dot_l * self.cos;
        let b = (1.0 - n_dot_l * n_dot_l).max(0.0).sqrt() * self.sin;
        if a >= b {
            a
        } else if a <= -b {
            0.0
        } else {
            let lit = (-a / b).acos();
            (a * lit + b * lit.sin()) / PI
        }
    }
}
