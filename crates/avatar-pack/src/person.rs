//! Makes another person of a pack: applies values of the axes to it, once.

use crate::identity::{Eye, Field, colors};
use crate::load::head_of;
use crate::{ContentsError, Pack, PackContents, PaletteBone, Part};
use avatar_groom::Hair;
use avatar_mesh::{Mesh, Offsets, PartKind};
use glam::{DMat3, DVec3, Mat4, Vec3, Vec4};
use rig_core::{RawJoint, RawRig, Rig, RigError};

/// The joints of the eyes, left first, and so the pivots of lids and balls.
const EYES: [&str; 2] = ["LtEyeJoint", "RtEyeJoint"];

/// Why a pack cannot become another person.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum IdentityError {
    /// The pack has no axes.
    #[error("expected an avatar with axes of identity (identity.toml), found one without")]
    NoAxes,
    /// A value for each axis is needed.
    #[error("expected {expected} values, one for each axis, found {found}")]
    Count {
        /// How many axes there are.
        expected: usize,
        /// How many values.
        found: usize,
    },
    /// A value that is out of range, or no number.
    #[error("identity axis {axis:?}: expected a number from -1 to 1, found {found}")]
    Range {
        /// Name of the axis.
        axis: String,
        /// The value.
        found: f32,
    },
    /// The axes turn about eyes that the rig lacks.
    #[error("expected a joint named {joint:?}, whose eye the axes change, found none")]
    NoEye {
        /// The joint.
        joint: &'static str,
    },
    /// The joints went where no rig can have them.
    #[error("{0}")]
    Rig(#[from] RigError),
    /// What was made does not agree.
    #[error("{0}")]
    Contents(#[from] ContentsError),
}

impl Pack {
    /// The pack as another person: the values of all axes, each from −1 to 1, are applied to meshes, shapes
    /// and joints.
    ///
    /// Skin, teeth and tongue follow the field of the axes, normals its derivative, and shapes go where the
    /// field takes the places that they lead to. Eyeballs and corneas stay balls: they move and scale with
    /// their lids. Motion, looks and hair stay as they are; hair grows on the new skin. The pack that is made
    /// has no axes of its own; with nothing but zeros it is a copy.
    ///
    /// # Errors
    /// No axes, another count of values, values out of range.
    pub fn with_identity(&self, values: &[f32]) -> Result<Self, IdentityError> {
        let identity = self.identity().ok_or(IdentityError::NoAxes)?;
        let (expected, found) = (identity.axes.len(), values.len());
        if expected != found {
            return Err(IdentityError::Count { expected, found });
        }
        for (axis, value) in identity.axes.iter().zip(values) {
            if !(-1.0..=1.0).contains(value) {
                return Err(IdentityError::Range { axis: axis.name.clone(), found: *value });
            }
        }
        if values.iter().all(|value| *value == 0.0) {
            return Ok(self.clone());
        }
        let eye = |joint: &'static str| match (self.rig().joint(joint), identity.eyes) {
            (Some(found), _) => Ok(place_of(self.rig(), found.index())),
            (None, None) => Ok(DVec3::ZERO),
            (None, Some(_)) => Err(IdentityError::NoEye { joint }),
        };
        let field = Field::new(identity, values, [eye(EYES[0])?, eye(EYES[1])?]);
        let mut contents = self.clone().into_contents();
        contents.rig = moved_rig(&contents.rig, &field)?;
        contents.springs = self.springs().moved(self.rig(), &contents.rig, |place| field.at(place));
        for part in &mut contents.parts {
            let follows = part.bone.and_then(|bone| contents.palette.get(bone));
            let name = follows.and_then(|bone| self.rig().names().get(bone.joint.index()));
            let eye = EYES.iter().position(|eye| name.is_some_and(|name| name == eye));
            match (eye, &field.eyes) {
                (Some(eye), Some(eyes)) => scale_part(&mut part.mesh, &eyes[eye]),
                _ => move_part(&mut part.mesh, &field),
            }
            part.bounds = part.mesh.bounds();
        }
        set_measures(&mut contents);
        contents.identity = None;
        Ok(Self::new(contents)?)
    }
}

impl Pack {
    /// Gives the pack the skin, the irises and the colour of its hair, where it has some, that go with a
    /// number, as [`Identity::draw`](crate::Identity::draw) draws the axes.
    pub fn draw_colors(&mut self, seed: u64) {
        let drawn = colors(seed);
        let mut materials = self.materials().clone();
        for part in self.parts().iter().filter(|part| part.material.is_none()) {
            let own = materials.of(&part.name, part.kind);
            let drawn = drawn.colors.over(part.kind, own);
            if drawn != own {
                materials.set(&part.name, drawn);
            }
        }
        self.set_materials(materials);
        let hair = self.hair().map(|hair| Hair { style: hair.style.colored(drawn.hair), ..*hair });
        self.set_hair(hair);
    }
}

fn set_measures(contents: &mut PackContents) {
    let PackContents { rig, palette, parts, head, face, .. } = contents;
    for PaletteBone { joint, joint_from_mesh } in palette.iter_mut() {
        if let Some(bind) = rig.bind_from_world().get(joint.index()) {
            *joint_from_mesh = *bind;
        }
    }
    let skin = parts.iter().find(|part: &&Part| part.kind == PartKind::Skin);
    *head = skin.and_then(|skin| head_of(&skin.mesh, skin.bounds?));
    *face = *head;
}

fn place_of(rig: &Rig, joint: usize) -> DVec3 {
    rig.world_from_bind().get(joint).map_or(DVec3::ZERO, |bind| bind.translation.as_dvec3())
}

/// Joints go where their places go. Those of lids turn with the lids; all others keep their directions.
fn moved_rig(rig: &Rig, field: &Field) -> Result<Rig, RigError> {
    let world = |joint: usize| {
        let bind = rig.world_from_bind().get(joint).copied().unwrap_or_default();
        let axes = glam::Mat3::from(bind.matrix3).as_dmat3();
        let place = bind.translation.as_dvec3();
        let eye = field.eyes.iter().flatten().find(|eye| eye.holds(place));
        let is_ball = rig.names().get(joint).is_some_and(|name| EYES.contains(&name.as_str()));
        let turned = match eye {
            Some(eye) if !is_ball => eye.turn * axes,
            _ => axes,
        };
        (turned, field.at(place))
    };
    let joint = |index: usize| {
        let name = rig.names().get(index).cloned().unwrap_or_default();
        let parent = rig.parents().get(index).copied().flatten();
        let (axes, place) = world(index);
        let (local, from) = match parent {
            Some(parent) => {
                let (parent_axes, parent_place) = world(parent.index());
                let back = parent_axes.transpose();
                (back * axes, back * (place - parent_place))
            }
            None => (axes, place),
        };
        let columns = [local.x_axis, local.y_axis, local.z_axis].map(|axis| axis.as_vec3().extend(0.0));
        let matrix = Mat4::from_cols(columns[0], columns[1], columns[2], from.as_vec3().extend(1.0));
        let parent = parent.and_then(|parent| rig.names().get(parent.index()));
        RawJoint::new(name, parent.map(String::as_str), matrix)
    };
    Rig::from_raw(&RawRig { joints: (0..rig.len()).map(joint).collect() })
}

/// A ball stays a ball.
fn scale_part(mesh: &mut Mesh, eye: &Eye) {
    let (center, to) = (eye.center, eye.moved_center());
    for p in &mut mesh.positions {
        *p = (to + (p.as_dvec3() - center) * eye.size).as_vec3();
    }
    for shape in &mut mesh.shapes {
        shape.positions = mapped(&shape.positions, |_, d| (d.as_dvec3() * eye.size).as_vec3());
    }
}

fn move_part(mesh: &mut Mesh, field: &Field) {
    let before = std::mem::take(&mut mesh.positions);
    mesh.positions = before.iter().map(|p| field.at(p.as_dvec3()).as_vec3()).collect();
    let derivatives: Vec<DMat3> = before.iter().map(|p| field.derivative(p.as_dvec3())).collect();
    let turns: Vec<DMat3> = derivatives.iter().zip(&mesh.normals).map(|(by, n)| of_normals(by, *n)).collect();
    for (n, turn) in mesh.normals.iter_mut().zip(&turns) {
        *n = (*turn * n.as_dvec3()).as_vec3();
    }
    for (t, by) in mesh.tangents.iter_mut().zip(&derivatives) {
        let along = (*by * t.truncate().as_dvec3()).normalize_or_zero().as_vec3();
        *t = if along == Vec3::ZERO { *t } else { Vec4::from((along, t.w)) };
    }
    for shape in &mut mesh.shapes {
        let moved = |vertex: usize, d: Vec3| {
            let Some(p) = before.get(vertex) else { return d };
            (field.at((*p + d).as_dvec3()) - field.at(p.as_dvec3())).as_vec3()
        };
        shape.positions = mapped(&shape.positions, moved);
        let linear = |maps: &[DMat3], offsets: &Offsets| {
            mapped(offsets, |vertex, d| maps.get(vertex).map_or(d, |by| (*by * d.as_dvec3()).as_vec3()))
        };
        shape.normals = shape.normals.as_ref().map(|normals| linear(&turns, normals));
        shape.tangents = shape.tangents.as_ref().map(|tangents| linear(&derivatives, tangents));
    }
}

/// What turns a normal, and all that is added to it: the transposed inverse of the derivative, scaled so that
/// this normal keeps its length. By cofactors, which exist where no inverse does.
fn of_normals(by: &DMat3, normal: Vec3) -> DMat3 {
    let [x, y, z] = [by.x_axis, by.y_axis, by.z_axis];
    let cofactors = DMat3::from_cols(y.cross(z), z.cross(x), x.cross(y));
    let normal = normal.as_dvec3();
    let length = (cofactors * normal).length();
    if length > 0.0 { cofactors * (normal.length() / length) } else { DMat3::IDENTITY }
}

/// Offsets with what moves at the same vertices.
fn mapped(offsets: &Offsets, mut by: impl FnMut(usize, Vec3) -> Vec3) -> Offsets {
    let pairs = offsets.iter().map(|(vertex, d)| (vertex as u32, by(vertex, d)));
    // Vertices of a list that was valid.
    Offsets::from_pairs(offsets.len(), pairs).unwrap_or_else(|_| offsets.clone())
}
