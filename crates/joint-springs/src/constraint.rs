//! Joints that turn with others, as the extension `VRMC_node_constraint` 1.0 has them,
//! <https://github.com/vrm-c/vrm-specification/tree/master/specification/VRMC_node_constraint-1.0>.

use crate::SpringError;
use crate::law::within;
use crate::skeleton::{arc, check, known, matches};
use glam::{Affine3A, Quat, Vec3};

/// A joint that turns with another one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Constraint {
    /// The joint that turns.
    pub joint: usize,
    /// The joint that it follows.
    pub source: usize,
    /// How far it goes from its own rest to what the source demands, 0…1.
    pub weight: f32,
    /// What it takes over.
    pub kind: ConstraintKind,
}

/// What a joint takes over from its source.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ConstraintKind {
    /// The turn about an axis.
    Roll {
        /// The axis in the space of the joint that turns.
        axis: Vec3,
    },
    /// An axis points to the source.
    Aim {
        /// The axis in the space of the joint that turns.
        axis: Vec3,
    },
    /// The source's rotation from its rest, each in its own space.
    Rotation,
}

/// All constraints of a skeleton.
#[derive(Clone, Debug)]
pub struct Constraints {
    parents: Vec<Option<usize>>,
    /// Rotation of each joint at rest, in its parent's space.
    rest: Vec<Quat>,
    /// Each behind those that move its source or a joint above.
    constraints: Vec<Constraint>,
    /// Which joints are below the one that turns.
    below: Vec<bool>,
}

impl Constraints {
    /// Constraints of a skeleton with these parents and, at rest, these world matrices.
    ///
    /// # Errors
    /// A parent stands behind its child, the slices differ in length, a joint does not exist or has two
    /// constraints, or a constraint waits for itself: for a joint that it turns.
    pub fn new(
        parents: &[Option<usize>],
        world_at_rest: &[Affine3A],
        constraints: &[Constraint],
    ) -> Result<Self, SpringError> {
        check(parents)?;
        let joints = parents.len();
        matches(joints, world_at_rest.len())?;
        let mut of_joint: Vec<Option<Constraint>> = vec![None; joints];
        for constraint in constraints {
            known("a constraint", constraint.source, joints)?;
            let slot = &mut of_joint[known("a constraint", constraint.joint, joints)?];
            let axis = |axis: Vec3| axis.try_normalize().unwrap_or(Vec3::Y);
            let kind = match constraint.kind {
                ConstraintKind::Roll { axis: along } => ConstraintKind::Roll { axis: axis(along) },
                ConstraintKind::Aim { axis: along } => ConstraintKind::Aim { axis: axis(along) },
                ConstraintKind::Rotation => ConstraintKind::Rotation,
            };
            let sane = Constraint { weight: within(constraint.weight, 0.0, 1.0), kind, ..*constraint };
            if slot.replace(sane).is_some() {
                return Err(SpringError::Twice { what: "constraints", joint: constraint.joint });
            }
        }
        let rest = (0..joints).map(|joint| local_rotation(parents, world_at_rest, joint)).collect();
        let constraints = ordered(parents, &of_joint)?;
        Ok(Self { parents: parents.to_vec(), rest, constraints, below: vec![false; joints] })
    }

    /// Turns the joints that follow others, and with them what is below. What is not finite stays as it is.
    /// Allocates nothing.
    ///
    /// # Errors
    /// `world` has another number of joints.
    pub fn apply(&mut self, world: &mut [Affine3A]) -> Result<(), SpringError> {
        matches(self.parents.len(), world.len())?;
        for constraint in &self.constraints {
            let joint = constraint.joint;
            let parent = self.parents[joint].map_or(Quat::IDENTITY, |parent| rotation(&world[parent]));
            let local =
                Quat::slerp(self.rest[joint], self.demanded(constraint, parent, world), constraint.weight);
            let turn = parent * local * rotation(&world[joint]).inverse();
            let origin = Affine3A::from_translation(world[joint].translation.into());
            let turn = origin * Affine3A::from_quat(turn) * origin.inverse();
            if !turn.is_finite() {
                continue;
            }
            self.below.fill(false);
            self.below[joint] = true;
            // It turns about its origin, which rounding leaves alone.
            world[joint].matrix3 = turn.matrix3 * world[joint].matrix3;
            for (other, matrix) in world.iter_mut().enumerate().skip(joint + 1) {
                if self.parents[other].is_some_and(|parent| self.below[parent]) {
                    self.below[other] = true;
                    *matrix = turn * *matrix;
                }
            }
        }
        Ok(())
    }

    /// The rotation in its parent's space that a joint takes at weight 1.
    fn demanded(&self, constraint: &Constraint, parent: Quat, world: &[Affine3A]) -> Quat {
        let (rest, source_rest) = (self.rest[constraint.joint], self.rest[constraint.source]);
        let source = local_rotation(&self.parents, world, constraint.source);
        match constraint.kind {
            ConstraintKind::Rotation => rest * source_rest.inverse() * source,
            ConstraintKind::Roll { axis } => {
                // The source's turn from rest, in its parent's axes, seen from the joint.
                let turn = source * source_rest.inverse();
                let own = rest.inverse() * turn * rest;
                rest * arc(axis, own * axis).inverse() * own
            }
            ConstraintKind::Aim { axis } => {
                let there = world[constraint.source].translation - world[constraint.joint].translation;
                let Some(there) = there.try_normalize() else { return rest };
                let turn = arc((parent * rest * axis).normalize_or_zero(), there.into());
                parent.inverse() * turn * parent * rest
            }
        }
    }
}

fn rotation(matrix: &Affine3A) -> Quat {
    let (_, rotation, _) = matrix.to_scale_rotation_translation();
    rotation.normalize()
}

fn local_rotation(parents: &[Option<usize>], world: &[Affine3A], joint: usize) -> Quat {
    let own = rotation(&world[joint]);
    parents[joint].map_or(own, |parent| rotation(&world[parent]).inverse() * own)
}

/// The constraints, each behind those of every joint that its own depends on: its source, and what is above
/// either. Visits each joint once, without recursion.
fn ordered(
    parents: &[Option<usize>],
    of_joint: &[Option<Constraint>],
) -> Result<Vec<Constraint>, SpringError> {
    #[derive(Clone, Copy, PartialEq)]
    enum Visit {
        Never,
        Begun,
        Done,
    }
    let mut visits = vec![Visit::Never; parents.len()];
    let mut order = Vec::new();
    let mut stack = Vec::new();
    // Those that have begun, each waiting for the next.
    let mut way = Vec::new();
    for start in 0..parents.len() {
        stack.push(start);
        while let Some(joint) = stack.last().copied() {
            let needs = [parents[joint], of_joint[joint].map(|constraint| constraint.source)];
            match visits[joint] {
                Visit::Never => {
                    visits[joint] = Visit::Begun;
                    way.push(joint);
                    for need in needs.into_iter().flatten() {
                        match visits[need] {
                            Visit::Never => stack.push(need),
                            Visit::Begun => {
                                let from = way.iter().position(|joint| *joint == need).unwrap_or(0);
                                let joint = culprit(&way[from..], parents, of_joint);
                                return Err(SpringError::Circle { joint });
                            }
                            Visit::Done => {}
                        }
                    }
                }
                Visit::Begun => {
                    visits[joint] = Visit::Done;
                    way.pop();
                    order.extend(of_joint[joint]);
                    stack.pop();
                }
                Visit::Done => {
                    stack.pop();
                }
            }
        }
    }
    Ok(order)
}

/// A joint of a circle, each of which waits for the next one and the last for the first, whose constraint
/// makes it wait: parents alone form no circle.
fn culprit(circle: &[usize], parents: &[Option<usize>], of_joint: &[Option<Constraint>]) -> usize {
    let mut steps = circle.iter().copied().zip(circle.iter().copied().cycle().skip(1));
    let waits = |(joint, next): &(usize, usize)| {
        parents[*joint] != Some(*next)
            && of_joint[*joint].is_some_and(|constraint| constraint.source == *next)
    };
    steps.find(waits).map_or(0, |(joint, _)| joint)
}
