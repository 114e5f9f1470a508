//! The planar layout of the skin: every point of the outer skin is one point of a chart.
//!
//! Rays leave a vertical axis inside the head; `phi` is the turn of a ray from straight ahead (0) to the back
//! (π), `t` its elevation. Above the chin all rays leave one centre. Below it the start slides down the axis
//! while the rays level out, so that they meet the throat, the neck and the shoulders at a good angle and
//! never cross.

use glam::{DVec2, DVec3};

use crate::{
    form,
    math::{atan2, cos, exp, lerp, sin, smooth},
};

/// The centre that the rays leave.
const CENTRE: DVec3 = DVec3::new(0.0, -1.0, -4.5);
/// Elevation below which the start of the rays slides down.
const SLIDE_FROM: f64 = -0.872_664_625_997_164_8;
/// How far the start slides per unit of `t`.
const SLIDE_RATE: f64 = 8.0;
/// How far the start has slid down below the chin.
const CHIN_END: f64 = 3.0;
/// How far the start has slid down where rays meet shoulders.
const NECK_END: f64 = 9.5;
/// How far where they meet the trapezius last, and the tops of the shoulders.
const TRAPEZIUS_END: f64 = 12.0;
/// See [`TRAPEZIUS_END`].
const SHOULDER_END: f64 = 15.0;
/// Below this height lies nothing of the head, only neck and shoulders.
const CHIN_Y: f64 = -11.0;
/// Rays of the neck meet the skin within this distance from the axis.
const NECK_REACH: f64 = 7.0;
/// How far the start slides at most.
const SLIDE_END: f64 = 38.0;

/// A place in the chart.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// Turn from straight ahead, 0…π.
    pub phi: f64,
    /// Elevation, in radians while it is one.
    pub t: f64,
}

/// Tangent of the elevation after the start has slid down by `slide`.
///
/// Rays level out quickly below the chin, so that they meet the tops of the shoulders from inside. Where they
/// meet them `r` from the axis, the tangent may grow by less than 1 / r, or rays would cross there.
fn tangent(slide: f64, phi: f64) -> f64 {
    const STEEP: f64 = -1.191_753_592_594_21;
    // The nape lies farther from the axis than the sides of the neck.
    let neck = 0.14 - 0.035 * smooth(2.0, 2.6, phi);
    let rates: [(f64, f64); 4] =
        [(CHIN_END, neck), (NECK_END, 0.11), (TRAPEZIUS_END, 0.07), (SHOULDER_END, 0.02)];
    let mut value = STEEP;
    for (i, (from, rate)) in rates.iter().enumerate() {
        let to = rates.get(i + 1).map_or(SLIDE_END, |next| next.0);
        value += (slide - from).clamp(0.0, to - from) * rate;
    }
    value
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
    let direction = DVec3::new(sp, tangent(slide, place.phi), cp).normalize_or_zero();
    (CENTRE - DVec3::Y * slide, direction)
}

/// The outermost point of the skin on the ray of a place.
#[must_use]
pub fn point(place: Place) -> DVec3 {
    let (start, direction) = ray(place);
    // Rays that lead down past the neck end in the shoulders: they are followed from between the two.
    let slide = CENTRE.y - start.y;
    let reach = if slide == 0.0 {
        17.0
    } else if slide < NECK_END {
        let neck = NECK_REACH + 2.5 * smooth(2.0, 2.8, place.phi);
        lerp(10.0, neck, (slide / CHIN_END).min(1.0)) / direction.x.hypot(direction.z)
    } else {
        30.0
    };
    let p = cast(start + direction * reach, -direction);
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
    let below_chin = p.y < CHIN_Y;
    if t >= SLIDE_FROM && !below_chin {
        return Place { phi, t };
    }
    // Farther out than they meet the skin, rays cross: there a place belongs to the chin or to what lies
    // below.
    let (mut low, mut high) = if !below_chin && CENTRE.y - CHIN_END + r * tangent(CHIN_END, phi) <= p.y {
        (0.0, CHIN_END)
    } else {
        let low = match r {
            r if r > 12.0 => SHOULDER_END,
            r if r > 9.0 => TRAPEZIUS_END,
            r if r > NECK_REACH => NECK_END,
            _ => CHIN_END,
        };
        (low, SLIDE_END)
    };
    for _ in 0..52 {
        let mid = 0.5 * (low + high);
        if CENTRE.y - mid + r * tangent(mid, phi) > p.y { low = mid } else { high = mid }
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
        // The logarithm grows by a step along the skin over the distance from the axis.
        let slide = (SLIDE_FROM - place.t) * SLIDE_RATE;
        polar(SLIDE_FROM) * exp(slide.min(NECK_END) / 5.0 + (slide - NECK_END).max(0.0) / 14.0)
    };
    let across = if place.phi == 0.0 || place.phi == std::f64::consts::PI { 0.0 } else { sin(place.phi) };
    DVec2::new(rho * across, -rho * cos(place.phi))
}

/// The place at turn `phi` that lies `below` the neckline of the top.
#[must_use]
pub fn neckline_place(phi: f64, below: f64) -> Place {
    let (mut low, mut high) = (SLIDE_FROM - SLIDE_END / SLIDE_RATE, SLIDE_FROM);
    for _ in 0..40 {
        let mid = 0.5 * (low + high);
        if form::below_neckline(point(Place { phi, t: mid })) < below { high = mid } else { low = mid }
    }
    Place { phi, t: high }
}

/// The place on the bust's lower edge at turn `phi`.
#[must_use]
pub fn edge_place(phi: f64, height: f64) -> Place {
    let (mut low, mut high) = (SLIDE_FROM - SLIDE_END / SLIDE_RATE, SLIDE_FROM);
    for _ in 0..40 {
        let mid = 0.5 * (low + high);
        if point(Place { phi, t: mid }).y > height { high = mid } else { low = mid }
    }
    Place { phi, t: high }
}
