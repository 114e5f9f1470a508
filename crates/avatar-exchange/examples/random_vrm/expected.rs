//! What this crate makes of a file.

use crate::FACE;
use crate::random::Random;
use avatar_exchange::vrm::{
    ColliderShape, ConstraintKind, Gaze, LookAtKind, SpringChain, Version, VrmModel, expression_weights,
};
use serde_json::{Value, json};

/// Pairs of joints with what moves them: the last joint of version 0 has an end of its own.
fn springs(model: &VrmModel) -> Vec<Value> {
    let springs = &model.vrm.springs;
    let name = |node: usize| model.scene.nodes[node].name.clone();
    // Of version 0 the scene is turned around, three-vrm's is not.
    let turned =
        if model.vrm.version == Version::V0 { glam::Vec3::new(-1.0, 1.0, -1.0) } else { glam::Vec3::ONE };
    let of_chain = |chain: &SpringChain| {
        let mut found = Vec::new();
        for (at, joint) in chain.joints.iter().enumerate() {
            let next = chain.joints.get(at + 1);
            if next.is_none() && chain.tail.is_none() {
                continue;
            }
            let groups = chain.collider_groups.iter().map(|group| &springs.collider_groups[*group]);
            let colliders = groups.flat_map(|group| &group.colliders).map(|collider| {
                let collider = &springs.colliders[*collider];
                let node = name(collider.node);
                match collider.shape {
                    ColliderShape::Sphere { offset, radius, inside } => {
                        json!({ "node": node, "offset": offset.to_array(), "radius": radius, "inside": inside })
                    }
                    ColliderShape::Capsule { offset, tail, radius, inside } => {
                        json!({ "node": node, "offset": offset.to_array(), "radius": radius, "inside": inside, "tail": tail.to_array() })
                    }
                    ColliderShape::Plane { offset, normal } => {
                        json!({ "node": node, "offset": offset.to_array(), "normal": normal.to_array() })
                    }
                }
            });
            found.push(json!({
                "node": name(joint.node),
                "end": next.map(|next| name(next.node)),
                "center": chain.center.map(name),
                "numbers": [joint.hit_radius, joint.stiffness, joint.gravity_power, joint.drag_force],
                "gravityDir": (joint.gravity_dir * turned).to_array(),
                "colliders": colliders.collect::<Vec<_>>(),
            }));
        }
        found
    };
    springs.chains.iter().flat_map(of_chain).collect()
}

fn constraints_found(model: &VrmModel) -> Vec<Value> {
    let name = |node: usize| model.scene.nodes[node].name.clone();
    let axis = |kind: ConstraintKind| match kind {
        ConstraintKind::Roll { axis } => ("roll", Some(axis.to_array())),
        ConstraintKind::Aim { axis } => ("aim", Some(axis.to_array())),
        ConstraintKind::Rotation => ("rotation", None),
    };
    let found = model.vrm.constraints.iter().map(|one| {
        let (kind, axis) = axis(one.kind);
        json!({ "node": name(one.node), "source": name(one.source), "weight": one.weight, "kind": kind, "axis": axis })
    });
    found.collect()
}

fn toon(model: &VrmModel) -> Value {
    let material = &model.scene.materials[0];
    let toon = material.toon.clone().unwrap_or_default();
    json!({
        "base": material.base_color[..3],
        "shade": toon.shade_color,
        "outline": toon.outline_color,
        "numbers": [toon.shading_shift, toon.shading_toony, toon.outline_width],
    })
}

/// Weights for random values of expressions, what eyes do for random directions, and what stands in the file.
pub(crate) fn expected(model: &VrmModel, random: &mut Random) -> Value {
    let names: Vec<&str> = model.vrm.expressions.iter().map(|expression| expression.name.as_str()).collect();
    let weights: Vec<Value> = (0..40)
        .map(|_| {
            let chosen: Vec<&str> = names.iter().copied().filter(|_| random.below(3) == 0).collect();
            let values: Vec<(&str, f32)> = chosen.iter().map(|name| (*name, random.share())).collect();
            let mut pose = model.scene.rest();
            expression_weights(&model.vrm, &values).apply(&mut pose);
            json!({ "values": values, "weights": pose.weights[FACE] })
        })
        .collect();
    let looks: Vec<Value> = (model.vrm.look_at.iter())
        .flat_map(|look_at| (0..20).map(move |k| (look_at, k)))
        .map(|(look_at, _)| {
            let gaze =
                Gaze { yaw_deg: 200.0 * (random.share() - 0.5), pitch_deg: 160.0 * (random.share() - 0.5) };
            let eyes = look_at.eyes(gaze);
            let bones = [eyes.left, eyes.right].map(|eye| [eye.yaw_deg, eye.pitch_deg]);
            let is_bone = look_at.kind == LookAtKind::Bone;
            let found = if is_bone { json!(bones) } else { json!(look_at.expressions(gaze)) };
            json!({ "yaw": gaze.yaw_deg, "pitch": gaze.pitch_deg, "bone": is_bone, "found": found })
        })
        .collect();
    json!({ "expressions": names, "weights": weights, "looks": looks, "springs": springs(model),
            "constraints": constraints_found(model), "toon": toon(model) })
}
