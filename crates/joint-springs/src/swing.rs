//! Joints that swing.

use crate::collider::Collider;
use crate::input::Input;
use crate::law::{Law, Response, within};
use crate::skeleton::{arc, check, known, matches};
use crate::{SpringError, TICKS_PER_SEC};
use glam::{Affine3A, Vec3, Vec3A};

/// A joint that swings about its origin.
#[derive(Clone, Debug, PartialEq)]
pub struct Spring {
    /// The joint.
    pub joint: usize,
    /// What the spring pulls, in the joint's own space: where the next joint of the chain is at rest. A tail
    /// in the origin never swings.
    pub tail: Vec3,
    /// What pulls.
    pub law: Law,
    /// Radius about the tail that bumps against colliders; not below 0.
    pub hit_radius: f32,
    /// The joint in whose space inertia counts: what moves with it does not swing. `None` for world space.
    pub center: Option<usize>,
    /// Numbers of the colliders that it bumps against, in that order.
    pub colliders: Vec<usize>,
}

impl Spring {
    /// A spring that bumps against nothing and feels every motion.
    pub fn new(joint: usize, tail: Vec3, law: Law) -> Self {
        Self { joint, tail, law, hit_radius: 0.0, center: None, colliders: Vec::new() }
    }
}

/// All springs of a skeleton, and how they swing now.
#[derive(Clone, Debug)]
pub struct Swing {
    parents: Vec<Option<usize>>,
    springs: Vec<Spring>,
    /// Closed forms of a whole tick.
    ticks: Vec<Option<Response>>,
    colliders: Vec<Collider>,
    /// The spring of each joint.
    spring_of: Vec<Option<usize>>,
    /// Whether a joint or one above it swings.
    moved: Vec<bool>,
    /// Joints that matter here, parents first.
    used: Vec<usize>,
    states: Vec<State>,
    input: Input,
    /// World matrices of the moment that is computed: from the animation, and with swinging joints.
    animated: Vec<Affine3A>,
    posed: Vec<Affine3A>,
    /// How long ago the last tick was at the last frame, in seconds.
    since_tick: f64,
    /// How many ticks no tail has moved for.
    quiet: u32,
    /// Whether time is only let pass until everything hangs still.
    settling: bool,
}

/// How a tail moves, in the space of its spring's center.
#[derive(Clone, Copy, Debug, Default)]
struct State {
    /// Whether the rest is known.
    started: bool,
    tail: Vec3A,
    /// The tail one tick before, of VRM's rule; otherwise its speed in units a second.
    second: Vec3A,
    /// Where the oscillator's middle was.
    rest: Vec3A,
    /// Whether the last tick did not move the tail.
    still: bool,
}

/// A longer frame counts as this long: after a second, what was before is forgotten.
const LONGEST_SECS: f64 = 1.0;
/// A tail that a tick moves by less than this share of its length is still.
const STILL: f32 = 2e-5;
/// All tails are at rest after so many still ticks: a tail that turns around is still for a moment only.
const STILL_TICKS: u32 = 12;
/// Ticks in which everything has to come to hang still.
const SETTLING_TICKS: u32 = 1200;
/// The least drag while it does; where a joint comes to rest does not depend on its drag.
const SETTLING_DRAG: f32 = 0.5;

impl Swing {
    /// Springs at rest. `parents` has one entry for each joint.
    ///
    /// Numbers out of their range are taken as the nearest in it, and NaN as the lowest.
    ///
    /// # Errors
    /// A parent stands behind its child; a joint or collider that does not exist; two springs at one joint.
    pub fn new(
        parents: &[Option<usize>],
        mut springs: Vec<Spring>,
        colliders: Vec<Collider>,
    ) -> Result<Self, SpringError> {
        check(parents)?;
        let joints = parents.len();
        let mut spring_of = vec![None; joints];
        let mut used = vec![false; joints];
        for collider in &colliders {
            used[known("a collider", collider.joint, joints)?] = true;
        }
        for (number, spring) in springs.iter_mut().enumerate() {
            let slot = &mut spring_of[known("a spring", spring.joint, joints)?];
            if slot.replace(number).is_some() {
                return Err(SpringError::Twice { what: "springs", joint: spring.joint });
            }
            if let Some(center) = spring.center {
                used[known("the center of a spring", center, joints)?] = true;
            }
            if let Some(found) = spring.colliders.iter().copied().find(|found| *found >= colliders.len()) {
                return Err(SpringError::UnknownCollider {
                    joint: spring.joint,
                    found,
                    colliders: colliders.len(),
                });
            }
            spring.law = spring.law.sane();
            spring.hit_radius = within(spring.hit_radius, 0.0, f32::MAX);
        }
        let mut moved = vec![false; joints];
        for (joint, parent) in parents.iter().enumerate() {
            moved[joint] = spring_of[joint].is_some() || parent.is_some_and(|parent| moved[parent]);
            used[joint] |= moved[joint];
            if let Some(parent) = parent.filter(|_| moved[joint]) {
                used[parent] = true;
            }
        }
        let ticks = springs.iter().map(|spring| response(spring.law, 1.0 / TICKS_PER_SEC)).collect();
        Ok(Self {
            parents: parents.to_vec(),
            ticks,
            states: vec![State::default(); springs.len()],
            springs,
            colliders,
            spring_of,
            moved,
            used: (0..joints).filter(|joint| used[*joint]).collect(),
            input: Input::new(joints),
            animated: vec![Affine3A::IDENTITY; joints],
            posed: vec![Affine3A::IDENTITY; joints],
            since_tick: 0.0,
            quiet: 0,
            settling: false,
        })
    }

    /// Back to rest: the next frame is the first.
    pub fn reset(&mut self) {
        self.input.reset();
        self.states.fill(State::default());
        self.since_tick = 0.0;
        self.quiet = 0;
    }

    /// Whether no joint swings any more. Time may still move the skeleton, and the joints with it.
    pub fn is_at_rest(&self) -> bool {
        self.quiet >= STILL_TICKS || self.springs.is_empty()
    }

    /// Turns the joints to where they come to rest on a skeleton that stays as it is, and starts anew from
    /// there: what a picture of one moment shows. Lets up to 20 seconds pass for that, in which the joints of
    /// [`Law::Vrm`] have a drag of at least a half. If a matrix that it needs is not finite, nothing is
    /// turned. Allocates nothing.
    ///
    /// # Errors
    /// `world` has another number of joints.
    pub fn settle(&mut self, world: &mut [Affine3A]) -> Result<(), SpringError> {
        matches(self.parents.len(), world.len())?;
        self.reset();
        if self.used.iter().any(|joint| !world[*joint].is_finite()) {
            return Ok(());
        }
        self.input.push(0.0, world);
        self.input.at(0.0, &self.used, &mut self.animated);
        self.step(0.0, true);
        self.settling = true;
        for _ in 0..SETTLING_TICKS {
            self.step(1.0 / TICKS_PER_SEC, true);
            if self.is_at_rest() {
                break;
            }
        }
        self.settling = false;
        // What is left of the motion ends here.
        for (state, spring) in self.states.iter_mut().zip(&self.springs) {
            state.second = match spring.law {
                Law::Vrm { .. } => state.tail,
                Law::Oscillator { .. } => Vec3A::ZERO,
            };
        }
        self.write(world);
        Ok(())
    }

    /// Lets `dt_secs` pass until the frame whose animated world matrices are given, and turns the joints that
    /// swing, and with them what is below. The first frame is at rest. A time below 0 or not finite counts as
    /// 0, one above a second as a second that the skeleton spent as it is now. Matrices that are not finite
    /// stay as they are, and springs start from rest after them. Allocates nothing.
    ///
    /// # Errors
    /// `world` has another number of joints.
    pub fn advance(&mut self, dt_secs: f64, world: &mut [Affine3A]) -> Result<(), SpringError> {
        matches(self.parents.len(), world.len())?;
        if self.used.iter().any(|joint| !world[*joint].is_finite()) {
            self.reset();
            return Ok(());
        }
        let secs = if dt_secs.is_finite() { dt_secs.max(0.0) } else { 0.0 };
        let tick = 1.0 / TICKS_PER_SEC;
        if !self.input.any() {
            self.input.push(0.0, world);
            self.input.at(0.0, &self.used, &mut self.animated);
            self.step(0.0, true);
        } else {
            if secs > LONGEST_SECS {
                self.input.reset();
            }
            let secs = secs.min(LONGEST_SECS);
            self.input.push(secs, world);
            // Seconds from the next tick to this frame. Sums of rounded times do not miss a tick.
            let mut late = self.since_tick + secs - tick;
            while late > -1e-9 {
                self.input.at(late.max(0.0), &self.used, &mut self.animated);
                self.step(tick, true);
                late -= tick;
            }
            self.since_tick = (late + tick).max(0.0);
        }
        self.input.at(0.0, &self.used, &mut self.animated);
        self.step(self.since_tick, false);
        self.write(world);
        Ok(())
    }

    /// Hands out the joints that swing, and what is below them.
    fn write(&self, world: &mut [Affine3A]) {
        for joint in &self.used {
            if self.moved[*joint] && self.posed[*joint].is_finite() {
                world[*joint] = self.posed[*joint];
            }
        }
    }

    /// Poses the skeleton `secs` after the last tick, and keeps the state if this is a tick itself.
    fn step(&mut self, secs: f64, keep: bool) {
        // Colliders and centers that swing themselves are where they were; all else is known.
        for joint in self.used.iter().filter(|joint| !self.moved[**joint]) {
            self.posed[*joint] = self.animated[*joint];
        }
        let mut still = true;
        for at in 0..self.used.len() {
            let joint = self.used[at];
            if !self.moved[joint] {
                continue;
            }
            let animated = self.animated[joint];
            let base = match self.parents[joint] {
                Some(parent) if self.moved[parent] => {
                    self.posed[parent] * (self.animated[parent].inverse() * animated)
                }
                _ => animated,
            };
            self.posed[joint] = match self.spring_of[joint] {
                Some(spring) => {
                    let (turned, state) = self.swung(spring, base, secs, keep);
                    if keep {
                        still &= state.still;
                        self.states[spring] = state;
                    }
                    turned
                }
                None => base,
            };
            // A joint that was scaled to nothing.
            if !self.posed[joint].is_finite() {
                self.posed[joint] = animated;
            }
        }
        if keep {
            self.quiet = if still { self.quiet.saturating_add(1) } else { 0 };
        }
    }

    /// A joint that the animation and the joints above it have at `base`, turned to where its tail is `secs`
    /// after the last tick, and its state then.
    fn swung(&self, number: usize, base: Affine3A, secs: f64, whole: bool) -> (Affine3A, State) {
        let spring = &self.springs[number];
        let origin = base.translation;
        let rest_tail = base.transform_point3a(spring.tail.into());
        let length = (rest_tail - origin).length();
        let Some(axis) = (rest_tail - origin).try_normalize() else { return (base, State::default()) };
        let center = spring.center.map(|center| self.posed[center]);
        let into_center = center.map(|center| center.inverse());
        let inward = |point: Vec3A| into_center.map_or(point, |matrix| matrix.transform_point3a(point));
        let outward = |point: Vec3A| center.map_or(point, |matrix| matrix.transform_point3a(point));

        let rest = inward(rest_tail);
        let fresh = State { started: true, tail: rest, second: Vec3A::ZERO, rest, still: false };
        let mut state = self.states[number];
        let (moved, rest) = match spring.law {
            Law::Oscillator { frequency_hz, gravity, .. } => {
                let omega = std::f32::consts::TAU * frequency_hz;
                let rest = inward(rest_tail + Vec3A::from(gravity) / (omega * omega));
                if !state.started {
                    state = State { tail: rest, rest, ..fresh };
                }
                let response = if whole { self.ticks[number] } else { response(spring.law, secs) };
                let distance = state.tail - state.rest;
                match response.filter(|_| secs > 0.0) {
                    Some(r) => {
                        let rest_speed = (rest - state.rest) / secs as f32;
                        let speed = state.second - rest_speed;
                        state.second = distance * r.vx + speed * r.vv + rest_speed;
                        (rest + distance * r.xx + speed * r.xv, rest)
                    }
                    None => (rest + distance, rest),
                }
            }
            Law::Vrm { stiffness, drag, gravity } => {
                if !state.started {
                    state = State { second: fresh.tail, ..fresh };
                }
                let tick = (1.0 / TICKS_PER_SEC) as f32;
                let drag = if self.settling { drag.max(SETTLING_DRAG) } else { drag };
                let coasted = outward(state.tail + (state.tail - state.second) * (1.0 - drag));
                let pulled = coasted + axis * (stiffness * tick) + Vec3A::from(gravity) * tick;
                // Of a part of a tick, that part of the way.
                let part = (secs * TICKS_PER_SEC) as f32;
                let before = outward(state.tail);
                let direction = (pulled - origin).try_normalize().unwrap_or(axis);
                state.second = state.tail;
                (inward(before + (origin + direction * length - before) * part), state.rest)
            }
        };
        let direction = (outward(moved) - origin).try_normalize().unwrap_or(axis);
        let mut tail = origin + direction * length;
        let mut hit = false;
        for collider in spring.colliders.iter().map(|collider| &self.colliders[*collider]) {
            let matrix = &self.posed[collider.joint];
            if let Some((out, depth)) = collider.shape.way_out(matrix, tail, spring.hit_radius) {
                let direction = (tail + out * depth - origin).try_normalize().unwrap_or(axis);
                tail = origin + direction * length;
                hit = true;
                if let Law::Oscillator { .. } = spring.law {
                    // What went into the collider stops there.
                    let out =
                        into_center.map_or(out, |matrix| matrix.transform_vector3a(out)).normalize_or_zero();
                    state.second -= out * state.second.dot(out).min(0.0);
                }
            }
        }
        let keeps_length = matches!(spring.law, Law::Vrm { .. });
        let before = state.tail;
        state.tail = if hit || keeps_length { inward(tail) } else { moved };
        // Far from the origin, numbers are too coarse for less.
        let coarse = 4.0 * f32::EPSILON * state.tail.abs().max_element();
        state.still = (state.tail - before).length() <= STILL * length + coarse;
        state.rest = rest;
        state.started = true;
        if ![state.tail, state.second, state.rest].iter().all(|vector| vector.is_finite()) {
            return (base, fresh);
        }
        let own_tail = base.inverse().transform_point3a(tail);
        let turn = match (Vec3A::from(spring.tail).try_normalize(), own_tail.try_normalize()) {
            (Some(from), Some(to)) => arc(from.into(), to.into()),
            _ => return (base, fresh),
        };
        (base * Affine3A::from_quat(turn), state)
    }
}

fn response(law: Law, secs: f64) -> Option<Response> {
    match law {
        Law::Oscillator { frequency_hz, damping_ratio, .. } => {
            Some(Response::new(frequency_hz, damping_ratio, secs))
        }
        Law::Vrm { .. } => None,
    }
}
