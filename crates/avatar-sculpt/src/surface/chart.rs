//! The planar layout of the skin: every point of the outer skin is one point of a chart.
//!
//! Rays leave a vertical axis inside the head; `phi` is the turn of a ray from straight ahead (0) to the back
//! (π), `t` its elevation. Above the chin all rays leave one centre. Below it the start slides down the axis
//! while the rays level out, so that they meet the throat, the neck and the shoulders at a good angle and
//! never cross.

use glam::{DVec2, DVec3};

use crate::{
    form,
    math::{atan2, cos, exp, sin},
};

/// The centre that the rays leave.
const CENTRE: DVec3 = DVec3::new(0.0, -1.0, -4.5);
/// Elevation below which the start of the rays slides down.
const SLIDE_FROM: f64 = -0.872_664_625_997_164_8;
/// How far the start slides per unit of `t`.
const SLIDE_RATE: f64 = 8.0;

/// A place in the chart.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// Turn from straight ahead, 0…π.
    pub phi: f64,
    /// Elevation, in radians while it is one.
    pub t: f64,
}

/// Tangent of the elevation after the start has slid down by `slide`.
fn tangent(slide: f64) -> f64 {
    const STEEP: f64 = -1.191_753_592_594_21;
    if slide <= 3.0 { STEEP } else { STEEP + (slide - 3.0) * 0.083 }
}

/// Where a chart place's ray starts and where it points.
fn ray(place: Place) -> (DVec3, DVec3) {
    let (sp, cp) = if place.phi == 0.0 {
        (0.0, 1.0)
    } else if place.phi == std::f64::consts::PI {
        (0.0, -1.0)
    } else {
        (sin(place.phi), cos(place.phi))
    };
    if place.t >= SLIDE_FROM {
        let (st, ct) = (sin(place.t), cos(place.t));
        return (CENTRE, DVec3::new(ct * sp, st, ct * cp));
    }
    let slide = (SLIDE_FROM - place.t) * SLIDE_RATE;
    let direction = DVec3::new(sp, tangent(slide), cp).normalize_or_zero();
    (CENTRE - DVec3::Y * slide, direction)
}

/// The outermost point of the skin on the ray of a place.
#[must_use]
pub fn point(place: Place) -> DVec3 {
    let (start, direction) = ray(place);
    let p = cast(start + direction * 17.0, -direction);
    // Both ends of the half lie on the midline, to the last bit.
    if direction.x == 0.0 { DVec3::new(0.0, p.y, p.z) } else { p }
}

/// First point of the skin from `from` along `direction` (unit length), coming from outside.
#[must_use]
pub fn cast(from: DVec3, direction: DVec3) -> DVec3 {
    march(from, direction, 1.0)
}

/// First point where a ray that starts inside leaves the skin.
#[must_use]
pub fn leave(from: DVec3, direction: DVec3) -> DVec3 {
    march(from, direction, -1.0)
}

/// Marches until the sign of the distance turns, then halves the last step down to rounding.
fn march(from: DVec3, direction: DVec3, sign: f64) -> DVec3 {
    let mut s = 0.0;
    let mut last = 0.0;
    for _ in 0..600 {
        let d = sign * form::distance(from + direction * s);
        if d < 0.0 {
            break;
        }
        last = s;
        s += (0.6 * d).max(0.003);
    }
    let (mut outside, mut inside) = (last, s);
    for _ in 0..44 {
        let mid = 0.5 * (outside + inside);
        if sign * form::distance(from + direction * mid) < 0.0 { inside = mid } else { outside = mid }
    }
    from + direction * inside
}

/// The place whose ray goes through a point.
#[must_use]
pub fn place_of(p: DVec3) -> Place {
    let phi = if p.x == 0.0 {
        if p.z >= CENTRE.z { 0.0 } else { std::f64::consts::PI }
    } else {
        atan2(p.x, p.z - CENTRE.z)
    };
    let r = p.x.hypot(p.z - CENTRE.z);
    let t = atan2(p.y - CENTRE.y, r);
    if t >= SLIDE_FROM {
        return Place { phi, t };
    }
    let (mut low, mut high) = (0.0, 16.0);
    for _ in 0..52 {
        let mid = 0.5 * (low + high);
        if CENTRE.y - mid + r * tangent(mid) > p.y { low = mid } else { high = mid }
    }
    Place { phi, t: SLIDE_FROM - 0.5 * (low + high) / SLIDE_RATE }
}

/// A flat picture of the chart that keeps angles (stereographic from below): triangulating there is
/// triangulating on the round head.
#[must_use]
pub fn flat(place: Place) -> DVec2 {
    let polar = |t: f64| (1.0 - sin(t)) / cos(t);
    let rho = if place.t >= std::f64::consts::FRAC_PI_2 {
        0.0
    } else if place.t >= SLIDE_FROM {
        polar(place.t)
    } else {
        polar(SLIDE_FROM) * exp((SLIDE_FROM - place.t) * SLIDE_RATE / 5.0)
    };
    let across = if place.phi == 0.0 || place.phi == std::f64::consts::PI { 0.0 } else { sin(place.phi) };
    DVec2::new(rho * across, -rho * cos(place.phi))
}

/// The place on the neck's lower edge at turn `phi`.
#[must_use]
pub fn edge_place(phi: f64, height: f64) -> Place {
    let (mut low, mut high) = (SLIDE_FROM - 16.0 / SLIDE_RATE, SLIDE_FROM);
    for _ in 0..40 {
        let mid = 0.5 * (low + high);
        if point(Place { phi, t: mid }).y > height { high = mid } else { low = mid }
    }
    Place { phi, t: high }
}
