//! The nine joints and their file.

use std::fmt::Write as _;

use glam::{DMat3, DMat4, DVec3};

use crate::anatomy::{EYE, HEAD, JAW, NECK};

/// A joint at rest in the world.
struct Joint {
    name: &'static str,
    world: DMat4,
    omitted: bool,
}

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
#[must_use]
pub fn transformations_xml() -> String {
    let neck = frame(DVec3::Y, DVec3::X, NECK);
    let head = frame(DVec3::Y, DVec3::X, HEAD);
    let right_eye = DVec3::new(-EYE.x, EYE.y, EYE.z);
    let tilted = |up: f64| DVec3::new(0.0, up, 1.0);
    // A lid's x axis points at the lid; the right lid's frame is the left one's, half a turn about z.
    let joint = |name, world, omitted| Joint { name, world, omitted };
    let children = [
        joint("JawJoint", sideways(DVec3::new(0.0, -0.72, 1.0), JAW), false),
        joint("RtLowerLidJoint", sideways(-tilted(-0.45), right_eye), false),
        joint("LtLowerLidJoint", sideways(tilted(-0.45), EYE), false),
        joint("RtUpperLidJoint", sideways(-tilted(0.42), right_eye), false),
        joint("LtUpperLidJoint", sideways(tilted(0.42), EYE), false),
        joint("RtEyeJoint", sideways(DVec3::Z, right_eye), true),
        joint("LtEyeJoint", sideways(DVec3::Z, EYE), true),
    ];
    let mut text = String::from("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n");
    text.push_str("<!-- Matrices are transposed: the translation stands in the last row. -->\n<JointSet>\n");
    open(&mut text, 1, "NeckJoint", &neck, false);
    text.push_str("    <Children>\n");
    open(&mut text, 3, "HeadJoint", &(rigid_inverse(&neck) * head), false);
    text.push_str("        <Children>\n");
    for child in &children {
        open(&mut text, 5, child.name, &(rigid_inverse(&head) * child.world), child.omitted);
        text.push_str("          </Joint>\n");
    }
    text.push_str("        </Children>\n      </Joint>\n    </Children>\n  </Joint>\n</JointSet>\n");
    text
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

/// Writes the opening of a joint and its matrix, column by column.
fn open(text: &mut String, depth: usize, name: &str, matrix: &DMat4, omitted: bool) {
    let pad = "  ".repeat(depth);
    let omit = if omitted { " omit=\"true\"" } else { "" };
    // Writing to a String cannot fail.
    let _ = writeln!(text, "{pad}<Joint name=\"{name}\"{omit}>");
    let _ = writeln!(text, "{pad}  <Matrix transposed=\"true\">");
    for column in [matrix.x_axis, matrix.y_axis, matrix.z_axis, matrix.w_axis] {
        // Adding zero turns a negative zero into a plain one.
        let [a, b, c, d] = column.to_array().map(|v| v as f32 + 0.0);
        let _ = writeln!(text, "{pad}    {a} {b} {c} {d}");
    }
    let _ = writeln!(text, "{pad}  </Matrix>");
}
