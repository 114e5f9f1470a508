//! The nine joints and their file.

use anyhow::{Context as _, Result};
use glam::{DMat3, DMat4, DVec3, Mat4};
use rig_core::{RawJoint, RawRig};

use crate::anatomy::{EYE, HEAD, JAW, NECK};

/// A frame from its local x and y directions; z follows.
fn frame(x: DVec3, y: DVec3, origin: DVec3) -> DMat4 {
    let (x, y) = (x.normalize_or_zero(), y.normalize_or_zero());
    let axes = DMat3::from_cols(x, y, x.cross(y));
    DMat4::from_cols(
        axes.x_axis.extend(0.0),
        axes.y_axis.extend(0.0),
        axes.z_axis.extend(0.0),
        origin.extend(1.0),
    )
}

/// A frame whose z points to the character's right; `x` lies in the plane of symmetry.
fn sideways(x: DVec3, origin: DVec3) -> DMat4 {
    frame(x, DVec3::NEG_X.cross(x), origin)
}

/// The file `Transformations.xml`.
///
/// # Errors
///
/// If the writer refuses the rig.
pub fn transformations_xml() -> Result<String> {
    let neck = frame(DVec3::Y, DVec3::X, NECK);
    let head = frame(DVec3::Y, DVec3::X, HEAD);
    let right_eye = DVec3::new(-EYE.x, EYE.y, EYE.z);
    let tilted = |up: f64| DVec3::new(0.0, up, 1.0);
    let children = [
        ("JawJoint", sideways(DVec3::new(0.0, -0.72, 1.0), JAW)),
        // A lid's x axis points at the lid; the right lid's frame is the left one's, half a turn about z.
        ("RtLowerLidJoint", sideways(-tilted(-0.45), right_eye)),
        ("LtLowerLidJoint", sideways(tilted(-0.45), EYE)),
        ("RtUpperLidJoint", sideways(-tilted(0.42), right_eye)),
        ("LtUpperLidJoint", sideways(tilted(0.42), EYE)),
        ("RtEyeJoint", sideways(DVec3::Z, right_eye)),
        ("LtEyeJoint", sideways(DVec3::Z, EYE)),
    ];
    let mut joints = vec![
        RawJoint::new("NeckJoint", None, file_matrix(neck)),
        RawJoint::new("HeadJoint", Some("NeckJoint"), file_matrix(rigid_inverse(&neck) * head)),
    ];
    for (name, world) in children {
        let local = file_matrix(rigid_inverse(&head) * world);
        let omit = name.ends_with("EyeJoint");
        joints.push(RawJoint { omit, ..RawJoint::new(name, Some("HeadJoint"), local) });
    }
    RawRig { joints }.to_xml().context("cannot write the joints")
}

fn rigid_inverse(m: &DMat4) -> DMat4 {
    let turn = DMat3::from_mat4(*m).transpose();
    let shift = -(turn * m.w_axis.truncate());
    DMat4::from_cols(
        turn.x_axis.extend(0.0),
        turn.y_axis.extend(0.0),
        turn.z_axis.extend(0.0),
        shift.extend(1.0),
    )
}

/// The matrix in the file's precision, without negative zeros.
fn file_matrix(m: DMat4) -> Mat4 {
    m.as_mat4() + Mat4::ZERO
}
