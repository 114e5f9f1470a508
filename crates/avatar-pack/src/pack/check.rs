//! Whether what a pack is made of agrees.

use super::{PackContents, PaletteBone};
use crate::{ContentsError, ControlSlider, Springs};
use pose_anim::{ClipSet, ControlTable, Coupling, PoseSet};
use rig_core::Rig;

pub(super) fn check(contents: &PackContents) -> Result<(), ContentsError> {
    let PackContents { rig, parts, palette, shapes, sliders, controls, look_rule, .. } = contents;
    if let Some(rule) = look_rule {
        in_range(rule.head.index(), rig.len(), "joints", || "the rule of looking".to_owned())?;
    }
    for (bone, PaletteBone { joint, .. }) in palette.iter().enumerate() {
        in_range(joint.index(), rig.len(), "joints", || format!("bone {bone}"))?;
    }
    for part in parts {
        let place = || format!("part {:?}", part.name);
        let largest = |bones: &[[u16; 4]]| bones.as_flattened().iter().copied().max();
        let skinning = part.mesh.skinning.iter();
        let skinned = skinning.flat_map(|skinning| [largest(&skinning.bones), largest(&skinning.more_bones)]);
        if let Some(most) = skinned.flatten().map(usize::from).chain(part.bone).max() {
            in_range(most, palette.len(), "bones", place)?;
        }
        let end = part.shapes().end;
        if end > shapes.len() {
            in_range(end - 1, shapes.len(), "shapes", place)?;
        }
    }
    let Some(sliders) = sliders else { return Ok(()) };
    let drivers = &sliders.drivers;
    for (what, expected, found) in [
        ("lists of the sliders that a shape follows", shapes.len(), sliders.of_shapes.len()),
        ("shapes that the rules move", shapes.len(), drivers.shape_count()),
        ("sliders that the rules read", sliders.names.len(), drivers.driver_count()),
    ] {
        if expected != found {
            return Err(ContentsError::Count { place: "the sliders".to_owned(), what, expected, found });
        }
    }
    for ControlSlider { slider, control, .. } in &sliders.of_controls {
        let place = || "the sliders of controls".to_owned();
        in_range(*slider, sliders.names.len(), "sliders", place)?;
        in_range(*control, controls.len(), "controls", place)?;
    }
    for Coupling { from, to, .. } in &sliders.mixing {
        in_range(*from.max(to), controls.len(), "controls", || "the mixtures".to_owned())?;
    }
    let expressions = &sliders.expressions;
    let end = expressions.first_slider.saturating_add(expressions.list.len());
    if end > sliders.names.len() {
        in_range(end - 1, sliders.names.len(), "sliders", || "the expressions".to_owned())?;
    }
    let bound = expressions.list.iter().flat_map(|one| one.binds.iter().map(|(shape, _)| *shape));
    for shape in bound.chain(expressions.rest.iter().map(|(shape, _)| *shape)) {
        in_range(shape, shapes.len(), "shapes", || "the expressions".to_owned())?;
    }
    for (shape, followed) in shapes.iter().zip(&sliders.of_shapes) {
        for slider in followed {
            in_range(*slider, sliders.names.len(), "sliders", || format!("shape {shape:?}"))?;
        }
    }
    Ok(())
}

pub(super) fn check_springs(springs: &Springs, rig: &Rig) -> Result<(), ContentsError> {
    springs.swing(rig)?;
    springs.turning(rig)?;
    Ok(())
}

pub(super) fn check_poses(poses: &PoseSet, controls: &ControlTable) -> Result<(), ContentsError> {
    for pose in poses {
        let used = pose.values.iter().map(|(control, _)| control);
        for control in used.chain(pose.timings.iter().map(|(control, _)| control)) {
            in_range(*control, controls.len(), "controls", || format!("pose {:?}", pose.name))?;
        }
    }
    Ok(())
}

pub(super) fn check_clips(clips: &ClipSet, controls: &ControlTable) -> Result<(), ContentsError> {
    for clip in &clips.clips {
        for track in clip.tracks() {
            in_range(track.control(), controls.len(), "controls", || format!("clip {:?}", clip.name))?;
        }
    }
    Ok(())
}

fn in_range(
    found: usize,
    count: usize,
    what: &'static str,
    place: impl Fn() -> String,
) -> Result<(), ContentsError> {
    match found < count {
        true => Ok(()),
        false => Err(ContentsError::Index { place: place(), what, count, found }),
    }
}
