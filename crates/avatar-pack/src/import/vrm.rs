use super::known::{Known, NamedExpression};
use super::springs::springs;
use super::{Import, ImportFailure, Role};
use crate::look_rule::EXPRESSION;
use avatar_exchange::vrm::{Expression, FirstPersonView, Meta, Vrm, VrmModel};
use pose_anim::{ControlTable, Drive, Pose};
use std::collections::HashMap;

impl Import {
    /// Makes an avatar of a VRM: as [`Import::from_scene`], with head, jaw and eyes by the file's own word.
    /// Each expression has a control, `expression.happy` and so on, whose values make the weights of shapes
    /// as [`avatar_exchange::vrm::expression_weights`] does, with what expressions take from each other; and
    /// a pose of its own name, in which all other expressions and shapes rest. Eyes look by the file's
    /// ranges, by bones or by expressions ([`crate::Gaze`]).
    ///
    /// # Errors
    /// As [`Import::from_scene`].
    pub fn from_vrm(model: VrmModel) -> Result<Self, ImportFailure> {
        let VrmModel { scene, vrm } = model;
        let bones = [
            (Role::Head, "head"),
            (Role::Jaw, "jaw"),
            (Role::LeftEye, "leftEye"),
            (Role::RightEye, "rightEye"),
        ];
        let known = Known {
            roles: bones.into_iter().filter_map(|(role, bone)| Some((role, vrm.bone(bone)?))).collect(),
            look: vrm.look_at.zip(vrm.bone("head")),
            expressions: vrm.expressions.iter().map(named).collect(),
        };
        let mut import = Self::with_known(scene, known)?;
        import.report.about = about(&vrm.meta);
        note_views(&vrm, &mut import);
        import.add_springs(&vrm)?;
        import.add_poses(&vrm)?;
        Ok(import)
    }

    fn add_springs(&mut self, vrm: &Vrm) -> Result<(), ImportFailure> {
        let Some(motion) = self.pack.motion() else { return Ok(()) };
        let mut notes = Vec::new();
        let springs = springs(vrm, self.pack.rig(), motion, &mut notes);
        notes.into_iter().for_each(|note| self.note(note));
        self.pack.set_springs(springs)?;
        Ok(())
    }

    fn add_poses(&mut self, vrm: &Vrm) -> Result<(), ImportFailure> {
        let controls = self.pack.controls();
        let names = &vrm.expressions;
        let of_expressions: Vec<Option<usize>> = names
            .iter()
            .map(|expression| controls.index(&format!("{EXPRESSION}{}", expression.name)))
            .collect();
        let mut poses = self.pack.poses().clone();
        // Each control of a shape has a pose of its name; those of expressions get the expressions' names.
        let is_of_expression =
            |name: &str| controls.index(name).is_some_and(|control| of_expressions.contains(&Some(control)));
        poses.poses.retain(|pose| !is_of_expression(&pose.name));
        // The faces that are not one of a single shape put the expressions to rest.
        for pose in poses.poses.iter_mut().filter(|pose| controls.index(&pose.name).is_none()) {
            for control in of_expressions.iter().flatten() {
                if pose.value(*control).is_none() {
                    pose.values.push((*control, 0.0));
                }
            }
            pose.values.sort_unstable_by_key(|(control, _)| *control);
        }
        let rest = shapes_at_rest(controls);
        let mut places: HashMap<String, usize> =
            poses.iter().enumerate().rev().map(|(place, pose)| (pose.name.clone(), place)).collect();
        for (expression, control) in names.iter().zip(&of_expressions) {
            let Some(control) = control else { continue };
            let with_own =
                |(other, rest): &(usize, f32)| (*other, if other == control { 1.0 } else { *rest });
            let values: Vec<(usize, f32)> = rest.iter().map(with_own).collect();
            // The usual pose of that name keeps its place and its key.
            match places.get(&expression.name).and_then(|place| poses.poses.get_mut(*place)) {
                // An expression that moves nothing says no more than the usual face.
                Some(_) if expression.binds.is_empty() => {}
                Some(other) => other.values = values,
                None => {
                    places.insert(expression.name.clone(), poses.poses.len());
                    poses.poses.push(Pose::new(&expression.name, values));
                }
            }
        }
        self.pack.set_poses(poses)?;
        Ok(())
    }
}

fn named(expression: &Expression) -> NamedExpression {
    let mut binds = Vec::with_capacity(expression.binds.len());
    let in_places = expression.in_places(|node, shape| {
        binds.push((node, shape));
        Some(binds.len() - 1)
    });
    NamedExpression { name: expression.name.clone(), expression: in_places, binds }
}

/// All controls of shapes and expressions at their defaults.
fn shapes_at_rest(controls: &ControlTable) -> Vec<(usize, f32)> {
    let controls = controls.controls().iter().enumerate();
    let shapes = controls.filter(|(_, control)| matches!(control.drives, Drive::Shape { .. }));
    shapes.map(|(index, control)| (index, control.default)).collect()
}

/// Name, authors, licence and terms of use in words.
fn about(meta: &Meta) -> Vec<(String, String)> {
    let single = [("name", &meta.title), ("version", &meta.version), ("licence", &meta.licence)];
    let authors = ("authors".to_owned(), meta.authors.join(", "));
    let single = single.into_iter().map(|(what, text)| (what.to_owned(), text.clone()));
    let all = single.chain([authors]).chain(meta.terms.iter().cloned());
    all.filter(|(_, text)| !text.is_empty()).collect()
}

/// Notes what is shown to everybody.
fn note_views(vrm: &Vrm, import: &mut Import) {
    let views = vrm.first_person.views.iter();
    let own = views.filter(|(_, view)| *view == FirstPersonView::FirstPersonOnly).count();
    if own > 0 {
        import.note(format!("VRM: {own} parts that only the character itself is to see are shown"));
    }
}
