use super::ImportReport;
use super::names::{Role, role_of};
use crate::PaletteBone;
use crate::unique::unique_names;
use avatar_exchange::{Scene, Transform};
use glam::{DAffine3, DMat4, Mat4, Quat, Vec3};
use rig_core::{JointId, RawJoint, RawRig, Rig, RigError};
use std::collections::HashMap;

/// Smaller factors than this leave a node no inverse that single precision holds.
const LEAST_SCALE: f64 = 1e-6;

/// A scene's nodes as a rig.
pub(super) struct Joints {
    pub(super) rig: Rig,
    pub(super) palette: Vec<PaletteBone>,
    /// Per node.
    pub(super) of_node: Vec<JointId>,
    /// Per node `node_from_parent` at rest, as the rig has it.
    pub(super) node_from_parent: Vec<DAffine3>,
    /// Nodes by what they do.
    pub(super) roles: Vec<(Role, usize)>,
    /// Per node: whether a vertex moves with it.
    pub(super) moves: Vec<bool>,
    /// Per node its name in the rig.
    pub(super) names: Vec<String>,
}

impl Joints {
    pub(super) fn of(
        scene: &Scene,
        known: &[(Role, usize)],
        report: &mut ImportReport,
    ) -> Result<Self, RigError> {
        let names = unique_names(scene.nodes.iter().map(|node| node.name.as_str()), "node");
        let locals: Vec<DAffine3> = (scene.nodes.iter().zip(&names))
            .map(|(node, name)| invertible(&node.local, name, report))
            .collect();
        let joints = scene.nodes.iter().zip(&names).zip(&locals).map(|((node, name), local)| {
            let parent = node.parent.and_then(|parent| names.get(parent)).map(String::as_str);
            RawJoint::new(name, parent, mat4(*local))
        });
        let rig = Rig::from_raw_affine(&RawRig { joints: joints.collect() })?;
        let by_name: HashMap<&str, JointId> =
            rig.names().iter().map(String::as_str).zip(rig.joints()).collect();
        // Every node became a joint of its name.
        let of_node: Vec<JointId> =
            names.iter().filter_map(|name| by_name.get(name.as_str()).copied()).collect();
        let palette = (scene.palette().entries.iter())
            .filter_map(|entry| {
                let joint = *of_node.get(entry.node)?;
                Some(PaletteBone { joint, joint_from_mesh: entry.node_from_mesh })
            })
            .collect();
        let moves = moves(scene);
        let roles = roles(scene, known, &names, &moves);
        report.joints.extend(roles.iter().map(|(role, node)| (*role, names[*node].clone())));
        let node_from_parent = locals.iter().map(|local| local.inverse()).collect();
        Ok(Self { rig, palette, of_node, node_from_parent, roles, moves, names })
    }

    /// `node_from_world` of directions at rest.
    pub(super) fn turned_back(&self, node: usize) -> Quat {
        let joint = self.of_node.get(node).map_or(0, |joint| joint.index());
        let world_from_node = self.rig.world_from_bind().get(joint).copied().unwrap_or_default();
        world_from_node.to_scale_rotation_translation().1.inverse()
    }
}

/// The transform at rest; one that flattens space nearly does instead, so that motion can be told from it.
fn invertible(local: &Transform, name: &str, report: &mut ImportReport) -> DAffine3 {
    let affine = local.affine();
    if affine.matrix3.determinant().abs() > LEAST_SCALE.powi(3) && affine.inverse().is_finite() {
        return affine;
    }
    report.notes.push(format!("node {name:?}: a scale of 0 at rest is taken as {LEAST_SCALE}"));
    match local {
        Transform::Trs(trs) => {
            let up = |x: f32| if x.abs() < LEAST_SCALE as f32 { LEAST_SCALE as f32 } else { x };
            let scale = Vec3::from_array(trs.scale.to_array().map(up));
            Transform::Trs(avatar_exchange::Trs { scale, ..*trs }).affine()
        }
        Transform::Matrix(matrix) => {
            let at = DAffine3::from_translation(Vec3::from(matrix.translation).as_dvec3());
            at * DAffine3::from_scale(glam::DVec3::splat(LEAST_SCALE))
        }
    }
}

fn mat4(affine: DAffine3) -> Mat4 {
    DMat4::from(affine).as_mat4()
}

/// Which nodes move vertices, by themselves or through those that hang from them.
fn moves(scene: &Scene) -> Vec<bool> {
    // All nodes of a skeleton without a mesh are there to move.
    let mut moves = vec![scene.parts.is_empty(); scene.nodes.len()];
    for entry in &scene.palette().entries {
        moves[entry.node] = true;
    }
    for &node in scene.order().iter().rev() {
        if let (true, Some(parent)) = (moves[node], scene.nodes[node].parent) {
            moves[parent] = true;
        }
    }
    moves
}

/// The nodes whose roles are known, then the first one of each other role that moves something, from the
/// roots.
fn roles(scene: &Scene, known: &[(Role, usize)], names: &[String], moves: &[bool]) -> Vec<(Role, usize)> {
    let is_there = |(_, node): &&(Role, usize)| moves.get(*node).is_some_and(|moves| *moves);
    let mut found: Vec<(Role, usize)> = known.iter().filter(is_there).copied().collect();
    for &node in scene.order() {
        let role = role_of(&names[node]).filter(|_| moves[node]);
        if let Some(role) = role.filter(|role| found.iter().all(|(other, _)| other != role)) {
            found.push((role, node));
        }
    }
    found.sort_by_key(|(role, _)| *role);
    found
}
