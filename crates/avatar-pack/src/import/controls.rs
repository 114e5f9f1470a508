use super::names::Role;
use super::rig::Joints;
use super::shape_sets::{ShapeSet, face_control};
use super::sliders::Wanted;
use super::{ImportFailure, ImportReport};
use avatar_exchange::Scene;
use avatar_exchange::look_at::{LookAt, LookAtKind, RangeMap};
use glam::Vec3;
use pose_anim::{Control, ControlTable, Drive, JointMotion, Pace, face};
use std::collections::{BTreeSet, HashMap, HashSet};

/// Joints without a role that get controls. Each of their controls takes about a kilobyte up to a face that
/// moves, where a joint takes a few bytes in a file; skeletons of people have some hundred.
const MOST_JOINTS: usize = 1 << 14;

/// A jaw points forward and 35.75° down, and moves sideways about what is at right angles to that and to its
/// hinge.
const JUT: Vec3 = Vec3::new(0.0, 0.811_534_35, 0.584_304_75);

/// The controls of the nine-joint face that a role has: name, axis in world space at rest, range in degrees.
/// The character looks along +Z and its left is +X.
fn face_controls(role: Role) -> &'static [(&'static str, Vec3, f32, f32)] {
    match role {
        Role::Head => &[
            (face::HEAD_TURN, Vec3::Y, -70.0, 70.0),
            (face::HEAD_BOW, Vec3::X, -40.0, 40.0),
            (face::HEAD_BEND, Vec3::NEG_Z, -40.0, 40.0),
        ],
        Role::Jaw => &[(face::JAW_OPEN, Vec3::X, 0.0, 20.0), (face::JAW_JUT, JUT, -8.0, 8.0)],
        Role::LeftEye => {
            &[(face::EYE_LEFT_UD, Vec3::NEG_X, -25.0, 25.0), (face::EYE_LEFT_LR, Vec3::Y, -30.0, 30.0)]
        }
        Role::RightEye => {
            &[(face::EYE_RIGHT_UD, Vec3::NEG_X, -25.0, 25.0), (face::EYE_RIGHT_LR, Vec3::Y, -30.0, 30.0)]
        }
        Role::LeftUpperLid => &[(face::LID_LEFT_UPPER, Vec3::X, -10.0, 45.0)],
        Role::RightUpperLid => &[(face::LID_RIGHT_UPPER, Vec3::X, -10.0, 45.0)],
        Role::LeftLowerLid => &[(face::LID_LEFT_LOWER, Vec3::NEG_X, -5.0, 25.0)],
        Role::RightLowerLid => &[(face::LID_RIGHT_LOWER, Vec3::NEG_X, -5.0, 25.0)],
    }
}

/// How far eyes turn where a file says so, in degrees, none below 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct EyeRanges {
    pub(super) to_nose: f32,
    pub(super) from_nose: f32,
    pub(super) down: f32,
    pub(super) up: f32,
}

impl EyeRanges {
    /// The ranges of eyes that are turned by their bones.
    pub(super) fn of(look_at: &LookAt) -> Option<Self> {
        let most = |range: RangeMap| range.map(f32::MAX).max(0.0);
        (look_at.kind == LookAtKind::Bone).then(|| Self {
            to_nose: most(look_at.horizontal_inner),
            from_nose: most(look_at.horizontal_outer),
            down: most(look_at.vertical_down),
            up: most(look_at.vertical_up),
        })
    }

    /// The range of a control, if it is one of an eye.
    fn of_control(self, control: &str) -> Option<(f32, f32)> {
        match control {
            face::EYE_LEFT_UD | face::EYE_RIGHT_UD => Some((-self.down, self.up)),
            face::EYE_LEFT_LR => Some((-self.to_nose, self.from_nose)),
            face::EYE_RIGHT_LR => Some((-self.from_nose, self.to_nose)),
            _ => None,
        }
    }
}

pub(super) fn controls(
    scene: &Scene,
    joints: &Joints,
    eyes: Option<EyeRanges>,
    sliders: &Wanted,
    report: &mut ImportReport,
) -> Result<ControlTable, ImportFailure> {
    let mut table = Table::default();
    for (role, node) in &joints.roles {
        let node_from_world = joints.turned_back(*node);
        let mut of_role = face_controls(*role).to_vec();
        // A rule of looking lifts first and then turns; the factors of a joint act from right to left.
        if eyes.is_some() && matches!(role, Role::LeftEye | Role::RightEye) {
            of_role.reverse();
        }
        for (name, axis, min, max) in of_role {
            let axis = (node_from_world * axis).normalize_or(axis);
            let joint = joints.names[*node].clone();
            let (min, max) = eyes.and_then(|eyes| eyes.of_control(name)).unwrap_or((min, max));
            table.add(name, Drive::Joint { joint, axis, kind: JointMotion::Rotation }, min, max, 0.0);
        }
    }
    shape_controls(sliders, report, &mut table);
    let mut without = 0;
    for &node in scene.order() {
        let has_role = joints.roles.iter().any(|(_, other)| *other == node);
        if has_role || !joints.moves[node] {
            continue;
        }
        if report.other_joints.len() == MOST_JOINTS {
            without += 1;
            continue;
        }
        let joint = &joints.names[node];
        for (axis_name, axis) in [("x", Vec3::X), ("y", Vec3::Y), ("z", Vec3::Z)] {
            let drives = Drive::Joint { joint: joint.clone(), axis, kind: JointMotion::Rotation };
            table.add(&format!("{joint}.{axis_name}"), drives, -180.0, 180.0, 0.0);
        }
        report.other_joints.push(joint.clone());
    }
    if without > 0 {
        let most = MOST_JOINTS;
        report.notes.push(format!("{without} joints beyond the first {most} have no controls of their own"));
    }
    Ok(ControlTable::new(table.controls)?)
}

/// One control for all shapes, or sliders of shapes, of a name.
fn shape_controls(sliders: &Wanted, report: &mut ImportReport, table: &mut Table) {
    let mut found: BTreeSet<(ShapeSet, &str)> = BTreeSet::new();
    let driven = &sliders.driven;
    let apart: HashSet<&str> = driven.apart.iter().map(String::as_str).collect();
    // Several nodes may have one of a name: the control reaches whatever one of them does. All rest at the
    // same value.
    let mut ranges: HashMap<&str, (f32, f32, f32)> = HashMap::new();
    // Their names are what poses and the gaze look for; a shape of such a name gets another one.
    table.names.extend(sliders.expressions.iter().cloned());
    let (of_shapes, of_expressions) = driven.names.split_at(sliders.first_expression);
    for (shape, (own_min, own_max, rest)) in of_shapes.iter().zip(&sliders.ranges) {
        let (min, max, _) = ranges.entry(shape).or_insert((*own_min, *own_max, *rest));
        (*min, *max) = (min.min(*own_min), max.max(*own_max));
    }
    for shape in of_shapes {
        // Each name once, where it is first.
        let Some((min, max, rest)) = ranges.remove(shape.as_str()) else { continue };
        match driven.known.get(shape) {
            Some(known) => _ = found.insert(*known),
            None => report.other_shapes.push(shape.clone()),
        }
        let of_face = face_control(shape).filter(|_| !apart.contains(shape.as_str()));
        let name = of_face.filter(|name| !table.names.contains(*name)).unwrap_or(shape);
        table.add(name, Drive::Shape { shape: shape.clone() }, min, max, rest);
    }
    for (name, slider) in sliders.expressions.iter().zip(of_expressions) {
        table.push(name.clone(), Drive::Shape { shape: slider.clone() }, 0.0, 1.0, 0.0);
    }
    let count = |set: ShapeSet| (set, found.iter().filter(|(other, _)| *other == set).count());
    report.shape_sets.extend(ShapeSet::ALL.map(count).into_iter().filter(|(_, count)| *count > 0));
    report.apart.clone_from(&driven.apart);
    report.notes.extend(driven.notes.iter().cloned());
}

#[derive(Default)]
struct Table {
    controls: Vec<Control>,
    names: HashSet<String>,
}

impl Table {
    fn add(&mut self, name: &str, drives: Drive, min: f32, max: f32, default: f32) {
        let mut unique = name.to_owned();
        let mut count = 1;
        while !self.names.insert(unique.clone()) {
            count += 1;
            unique = format!("{name}.{count}");
        }
        self.push(unique, drives, min, max, default);
    }

    fn push(&mut self, name: String, drives: Drive, min: f32, max: f32, default: f32) {
        let pace = Pace::named(&name, &drives);
        self.controls.push(Control { name, drives, min, max, default, pace, group: None });
    }
}
