use super::{MAX_DEPTH, MAX_NAME_BYTES};
use crate::{MatrixLayout, RawJoint, RawRig, RigError};
use std::fmt::Write;

/// Nested elements, two spaces a level, each matrix as four lines of shortest round-trip numbers.
pub(super) fn write(raw: &RawRig) -> Result<String, RigError> {
    let (order, parents) = raw.parents_first()?;
    let mut depths = vec![0usize; raw.joints.len()];
    let mut out = String::from("<JointSet>\n");
    let mut open = 0;
    for index in order {
        let joint = &raw.joints[index];
        if !joint.parent_from_joint.is_finite() {
            return Err(RigError::NotFinite { joint: joint.name.clone() });
        }
        if joint.name.trim().is_empty()
            || joint.name.len() > MAX_NAME_BYTES
            || !joint.name.chars().all(is_xml_char)
        {
            return Err(RigError::UnwritableName { joint: joint.name.clone(), limit: MAX_NAME_BYTES });
        }
        let depth = parents[index].map_or(0, |parent| depths[parent] + 1);
        depths[index] = depth;
        if depth >= MAX_DEPTH {
            return Err(RigError::TooDeep { joint: joint.name.clone(), limit: MAX_DEPTH });
        }
        close(&mut out, open, depth);
        if depth > 0 && open == depth {
            // The first child: its parent's <Children> is not open yet.
            let _ = writeln!(out, "{:1$}<Children>", "", depth * 4);
        }
        start(&mut out, joint, depth);
        open = depth + 1;
    }
    close(&mut out, open, 0);
    out.push_str("</JointSet>\n");
    Ok(out)
}

/// Closes joints (and their lists of children) until `depth` joints are open. The list that stays open at
/// `depth` takes the next joint.
fn close(out: &mut String, open: usize, depth: usize) {
    for level in (depth..open).rev() {
        if level + 1 < open {
            let _ = writeln!(out, "{:1$}</Children>", "", level * 4 + 4);
        }
        let _ = writeln!(out, "{:1$}</Joint>", "", level * 4 + 2);
    }
}

fn start(out: &mut String, joint: &RawJoint, depth: usize) {
    let indent = depth * 4 + 2;
    let omit = if joint.omit { " omit=\"true\"" } else { "" };
    let (transposed, numbers) = match joint.layout {
        MatrixLayout::Transposed => (" transposed=\"true\"", joint.parent_from_joint),
        MatrixLayout::RowByRow => ("", joint.parent_from_joint.transpose()),
    };
    let _ = writeln!(out, "{:indent$}<Joint name=\"{}\"{omit}>", "", escaped(&joint.name));
    let _ = writeln!(out, "{:indent$}  <Matrix{transposed}>", "");
    for line in numbers.to_cols_array_2d() {
        let [a, b, c, d] = line;
        let _ = writeln!(out, "{:indent$}    {a} {b} {c} {d}", "");
    }
    let _ = writeln!(out, "{:indent$}  </Matrix>", "");
}

/// An attribute's value: a reader turns raw line breaks and tabs into spaces, so they are written as
/// references. (`escape` itself sees to the carriage return.)
fn escaped(name: &str) -> String {
    quick_xml::escape::escape(name).replace('\n', "&#10;").replace('\t', "&#9;")
}

/// The characters of XML 1.0, section 2.2; surrogates are no `char` anyway.
fn is_xml_char(c: char) -> bool {
    matches!(c, '\t' | '\n' | '\r' | ' '..='\u{FFFD}' | '\u{10000}'..)
}
