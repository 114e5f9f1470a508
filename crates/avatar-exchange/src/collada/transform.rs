//! The steps of a node's transform.

use super::xml::At;
use crate::scene::ImportError;
use glam::{DMat4, DVec3};

/// One element such as `<rotate>`; the matrix of the first is the outermost.
#[derive(Clone, Debug)]
pub(super) struct Step {
    /// What animations call it.
    pub(super) sid: String,
    /// Its kind.
    pub(super) kind: Kind,
    /// Its numbers, as the file has them.
    pub(super) values: Vec<f64>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Matrix,
    Translate,
    Rotate,
    Scale,
    LookAt,
    Skew,
}

impl Step {
    /// The step that an element is, if it is one.
    pub(super) fn of(at: At<'_>) -> Result<Option<Self>, ImportError> {
        let (kind, values) = match at.name() {
            "matrix" => (Kind::Matrix, at.exactly::<16>()?.to_vec()),
            "translate" => (Kind::Translate, at.exactly::<3>()?.to_vec()),
            "rotate" => (Kind::Rotate, at.exactly::<4>()?.to_vec()),
            "scale" => (Kind::Scale, at.exactly::<3>()?.to_vec()),
            "lookat" => (Kind::LookAt, at.exactly::<9>()?.to_vec()),
            "skew" => (Kind::Skew, at.exactly::<7>()?.to_vec()),
            _ => return Ok(None),
        };
        Ok(Some(Self { sid: at.attribute("sid").unwrap_or("").to_owned(), kind, values }))
    }

    /// With other values, as many as its own.
    pub(super) fn matrix(&self, values: &[f64]) -> DMat4 {
        let at = |k: usize| values.get(k).copied().unwrap_or(0.0);
        let vector = |k: usize| DVec3::new(at(k), at(k + 1), at(k + 2));
        match self.kind {
            Kind::Matrix => row_major(values),
            Kind::Translate => DMat4::from_translation(vector(0)),
            Kind::Scale => DMat4::from_scale(vector(0)),
            Kind::Rotate => match vector(0).try_normalize() {
                Some(axis) => DMat4::from_axis_angle(axis, at(3).to_radians()),
                None => DMat4::IDENTITY,
            },
            Kind::LookAt => look_at(vector(0), vector(3), vector(6)),
            Kind::Skew => skew(at(0).to_radians(), vector(1), vector(4)),
        }
    }
}

/// The product of all steps.
pub(super) fn product<'a>(steps: impl Iterator<Item = (&'a Step, &'a [f64])>) -> DMat4 {
    steps.fold(DMat4::IDENTITY, |product, (step, values)| product * step.matrix(values))
}

/// Sixteen numbers by rows; missing numbers are 0.
pub(super) fn row_major(values: &[f64]) -> DMat4 {
    let mut columns = [0.0; 16];
    columns.iter_mut().zip(values).for_each(|(to, from)| *to = *from);
    DMat4::from_cols_array(&columns).transpose()
}

/// At the eye, −z toward the point of interest. Without a direction, only moved.
fn look_at(eye: DVec3, interest: DVec3, up: DVec3) -> DMat4 {
    let back = (eye - interest).try_normalize();
    let right = back.and_then(|back| up.cross(back).try_normalize());
    match (back, right) {
        (Some(z), Some(x)) => {
            DMat4::from_cols(x.extend(0.0), z.cross(x).extend(0.0), z.extend(0.0), eye.extend(1.0))
        }
        _ => DMat4::from_translation(eye),
    }
}

/// RenderMan's skew: points move along `along` in such a way that `turned` turns toward it by the angle. With
/// `n` the direction square to `along` in which `turned` leans by φ, points move by (tan(φ + angle) − tan
/// φ)·(p·n).
fn skew(angle: f64, turned: DVec3, along: DVec3) -> DMat4 {
    let (Some(turned), Some(along)) = (turned.try_normalize(), along.try_normalize()) else {
        return DMat4::IDENTITY;
    };
    let lean = turned.dot(along);
    let Some(n) = (turned - along * lean).try_normalize() else { return DMat4::IDENTITY };
    let phi = lean.atan2(turned.dot(n));
    let shift = along * ((phi + angle).tan() - phi.tan());
    DMat4::from_cols(
        (DVec3::X + shift * n.x).extend(0.0),
        (DVec3::Y + shift * n.y).extend(0.0),
        (DVec3::Z + shift * n.z).extend(0.0),
        glam::DVec4::W,
    )
}
