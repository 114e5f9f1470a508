//! The field of displacement that values of the axes make.

use super::{Identity, LocalMap};
use glam::{DMat3, DVec3};

/// Step of the central differences that give the field's derivative, in units of space.
const STEP: f64 = 1e-4;

/// Where every place of space goes.
pub(crate) struct Field {
    maps: Vec<Placed>,
    /// The left one, then the right one; none where the file names no region.
    pub(crate) eyes: Option<[Eye; 2]>,
}

/// A map of one side at its value.
struct Placed {
    center: DVec3,
    /// 1 over the half axes.
    per_radius: DVec3,
    full: f64,
    linear: DMat3,
    shift: DVec3,
}

/// An eye and where it goes.
pub(crate) struct Eye {
    pub(crate) center: DVec3,
    full: f64,
    apart: f64,
    reach: f64,
    /// What other maps displace the centre by.
    carried: DVec3,
    shift: DVec3,
    pub(crate) size: f64,
    pub(crate) turn: DMat3,
}

impl Field {
    /// The field for one value of each axis and the bind places of left and right eye.
    pub(crate) fn new(identity: &Identity, values: &[f32], eyes: [DVec3; 2]) -> Self {
        let values = effective(identity, values);
        let mut maps = Vec::new();
        let (mut size, mut tilt, mut shift) = (1.0, 0.0f64, DVec3::ZERO);
        for (axis, value) in identity.axes.iter().zip(values).filter(|(_, value)| *value != 0.0) {
            size += value * f64::from(axis.eye.size - 1.0);
            tilt += value * f64::from(axis.eye.tilt);
            shift += value * vector(axis.eye.shift);
            for map in &axis.maps {
                maps.push(Placed::new(map, value, 1.0));
                if map.center[0] != 0.0 {
                    maps.push(Placed::new(map, value, -1.0));
                }
            }
        }
        let mut field = Self { maps, eyes: None };
        let Some(region) = identity.eyes else { return field };
        let eye = |center: DVec3, side: f64| Eye {
            center,
            full: region.full.into(),
            apart: region.apart.into(),
            reach: region.reach.into(),
            carried: field.displacement(center),
            shift: shift * DVec3::new(side, 1.0, 1.0),
            // Eyes neither vanish nor turn inside out, whatever a mixture asks for.
            size: size.max(0.5),
            turn: about_z(side * tilt.to_radians()),
        };
        field.eyes = Some([eye(eyes[0], 1.0), eye(eyes[1], -1.0)]);
        field
    }

    /// What the maps alone do.
    fn displacement(&self, p: DVec3) -> DVec3 {
        self.maps.iter().map(|map| map.displacement(p)).sum()
    }

    /// Where a place goes.
    pub(crate) fn at(&self, p: DVec3) -> DVec3 {
        let free = self.displacement(p);
        let Some(eyes) = &self.eyes else { return p + free };
        let near = |eye: &Eye| fade(p.distance(eye.center), eye.full, eye.apart);
        let follow = |eye: &Eye| fade(p.distance(eye.center), eye.full, eye.reach);
        // Between the eyes, inside the skull, both may count: together never more than once.
        let shared = |[left, right]: [f64; 2]| {
            let sum = (left + right).max(1.0);
            [left / sum, right / sum]
        };
        let (near, follow) = (shared(eyes.each_ref().map(near)), shared(eyes.each_ref().map(follow)));
        let of_eye = |at: usize| near[at] * (eyes[at].carried - free) + follow[at] * eyes[at].own(p);
        p + free + of_eye(0) + of_eye(1)
    }

    /// The derivative at a place, by central differences.
    pub(crate) fn derivative(&self, p: DVec3) -> DMat3 {
        let along = |axis: DVec3| (self.at(p + axis * STEP) - self.at(p - axis * STEP)) / (2.0 * STEP);
        DMat3::from_cols(along(DVec3::X), along(DVec3::Y), along(DVec3::Z))
    }
}

impl Placed {
    fn new(map: &LocalMap, value: f64, side: f64) -> Self {
        let mirror = DVec3::new(side, 1.0, 1.0);
        let mirrored = DMat3::from_diagonal(mirror);
        let turn = vector(map.turn) * std::f64::consts::PI / 180.0;
        let scale = DMat3::from_diagonal(vector(map.scale) - DVec3::ONE);
        let turned = DMat3::from_cols(turn.cross(DVec3::X), turn.cross(DVec3::Y), turn.cross(DVec3::Z));
        Self {
            center: vector(map.center) * mirror,
            per_radius: vector(map.radii).recip(),
            full: map.full.into(),
            linear: mirrored * (scale + turned) * mirrored * value,
            shift: vector(map.shift) * mirror * value,
        }
    }

    fn displacement(&self, p: DVec3) -> DVec3 {
        let rel = p - self.center;
        let share = fade((rel * self.per_radius).length(), self.full, 1.0);
        if share == 0.0 { DVec3::ZERO } else { share * (self.linear * rel + self.shift) }
    }
}

impl Eye {
    /// What the eye does by itself, beside what carries it.
    fn own(&self, p: DVec3) -> DVec3 {
        let rel = p - self.center;
        self.turn * rel * self.size - rel + self.shift
    }

    /// Whether a place belongs to the eye wholly.
    pub(crate) fn holds(&self, p: DVec3) -> bool {
        p.distance(self.center) <= self.full
    }

    /// Where its centre goes.
    pub(crate) fn moved_center(&self) -> DVec3 {
        self.center + self.carried + self.shift
    }
}

/// How far an axis goes where its own value and axes that are made of it add up: more is no plausible face.
const FARTHEST: f64 = 1.2;

/// The values of all axes with what axes that are made of others add to these.
fn effective(identity: &Identity, values: &[f32]) -> Vec<f64> {
    let mut effective: Vec<f64> = values.iter().map(|value| f64::from(*value)).collect();
    // Axes are made of earlier ones only.
    for (index, axis) in identity.axes.iter().enumerate().rev() {
        let value = effective.get(index).copied().unwrap_or(0.0);
        for (other, share) in &axis.of {
            if let Some(moved) = effective.get_mut(*other) {
                *moved += value * f64::from(*share);
            }
        }
    }
    effective.iter_mut().for_each(|value| *value = value.clamp(-FARTHEST, FARTHEST));
    effective
}

/// 1 up to `full`, 0 from `end` on, with two continuous derivatives.
fn fade(distance: f64, full: f64, end: f64) -> f64 {
    if distance <= full {
        return 1.0;
    }
    if distance >= end {
        return 0.0;
    }
    let s = (distance - full) / (end - full);
    1.0 - s * s * s * (10.0 + s * (6.0 * s - 15.0))
}

/// A turn about z. Its sine and cosine are rational in the tangent of the half angle, whose first terms are
/// exact to 1e-6 for the few degrees of an eye: unlike the platform's functions they are the same everywhere.
fn about_z(angle_rad: f64) -> DMat3 {
    let half = 0.5 * angle_rad;
    let t = half * (1.0 + half * half / 3.0);
    let (cos, sin) = ((1.0 - t * t) / (1.0 + t * t), 2.0 * t / (1.0 + t * t));
    DMat3::from_cols(DVec3::new(cos, sin, 0.0), DVec3::new(-sin, cos, 0.0), DVec3::Z)
}

fn vector(v: [f32; 3]) -> DVec3 {
    DVec3::from_array(v.map(f64::from))
}
