use glam::Vec3;

/// Steps after which a search that still creeps ends.
const STEPS: usize = 24;
/// How far apart the values of a difference quotient are, as a share of the range.
const DIFFERENCE: f32 = 1e-3;

/// One of the two unknowns: where it may be, and where the search for it starts.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Unknown {
    pub(super) min: f32,
    pub(super) max: f32,
    pub(super) start: f32,
}

/// The values within their ranges at which `residual` is shortest: damped Gauss-Newton steps (Levenberg 1944,
/// Marquardt 1963) with difference quotients. A value at an end of its range rests while the descent leads
/// beyond it. Unknowns without a range stay where they start.
///
/// # Errors
/// The first one of `residual`.
pub(super) fn least<E>(
    unknowns: [Unknown; 2],
    mut residual: impl FnMut([f32; 2]) -> Result<Vec3, E>,
) -> Result<[f32; 2], E> {
    let mut at = unknowns.map(|unknown| unknown.start);
    let mut rest = residual(at)?;
    let mut damping = 1e-3;
    for _ in 0..STEPS {
        let mut slopes = [Vec3::ZERO; 2];
        for (i, Unknown { min, max, .. }) in unknowns.into_iter().enumerate() {
            // Toward the middle, where the range goes on.
            let way = (max - min) * DIFFERENCE * if at[i] > 0.5 * (min + max) { -1.0 } else { 1.0 };
            if way != 0.0 {
                let mut beside = at;
                beside[i] += way;
                slopes[i] = (residual(beside)? - rest) / way;
            }
        }
        let descent = [-slopes[0].dot(rest), -slopes[1].dot(rest)];
        for (i, Unknown { min, max, .. }) in unknowns.into_iter().enumerate() {
            if (at[i] <= min && descent[i] < 0.0) || (at[i] >= max && descent[i] > 0.0) {
                slopes[i] = Vec3::ZERO;
            }
        }
        let step = damped_step(slopes, rest, damping);
        let mut next = at;
        for (i, Unknown { min, max, .. }) in unknowns.into_iter().enumerate() {
            next[i] = (at[i] + step[i]).max(min).min(max);
        }
        if next == at {
            break;
        }
        let there = residual(next)?;
        if there.length_squared() < rest.length_squared() {
            (at, rest) = (next, there);
            damping *= 0.1;
        } else {
            damping = damping.max(1e-6) * 10.0;
        }
    }
    Ok(at)
}

/// Solves `(JᵀJ + damping · diag(JᵀJ)) step = −Jᵀ rest`; a column of zeros takes no part.
fn damped_step(slopes: [Vec3; 2], rest: Vec3, damping: f32) -> [f32; 2] {
    let [a, b] = slopes;
    let (aa, ab, bb) = (a.length_squared() * (1.0 + damping), a.dot(b), b.length_squared() * (1.0 + damping));
    let (a_rest, b_rest) = (-a.dot(rest), -b.dot(rest));
    let alone = |square: f32, right: f32| if square > 0.0 { right / square } else { 0.0 };
    let determinant = aa * bb - ab * ab;
    // Parallel columns: one of them does it.
    if determinant <= 1e-6 * aa * bb {
        return if aa >= bb { [alone(aa, a_rest), 0.0] } else { [0.0, alone(bb, b_rest)] };
    }
    [(bb * a_rest - ab * b_rest) / determinant, (aa * b_rest - ab * a_rest) / determinant]
}
