use crate::{Place, RigError};
use glam::Mat4;
use std::collections::HashMap;

/// How the 16 numbers of a `<Matrix>` run in the text.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum MatrixLayout {
    /// Row by row, translation in the last column: no attribute, or `transposed="false"`.
    RowByRow,
    /// Column by column, translation in the last four numbers: `transposed="true"`.
    #[default]
    Transposed,
}

/// A joint as the file has it. Everything may be edited; [`crate::Rig::from_raw`] checks.
#[derive(Clone, Debug, PartialEq)]
pub struct RawJoint {
    /// Unique name.
    pub name: String,
    /// Name of the parent; `None` at a root.
    pub parent: Option<String>,
    /// Bind matrix `B`, `parent_from_joint`, to the last bit of the file.
    pub parent_from_joint: Mat4,
    /// How the matrix is written.
    pub layout: MatrixLayout,
    /// `omit="true"`: the original's skin does not use this joint. Informational.
    pub omit: bool,
    /// Where the joint stood in the text that it was read from.
    pub place: Option<Place>,
}

impl RawJoint {
    /// A joint that was not read from a file.
    pub fn new(name: impl Into<String>, parent: Option<&str>, parent_from_joint: Mat4) -> Self {
        Self {
            name: name.into(),
            parent: parent.map(str::to_owned),
            parent_from_joint,
            layout: MatrixLayout::default(),
            omit: false,
            place: None,
        }
    }
}

/// An editable forest of joints. Parents are named, so joints can be added, renamed, moved and removed in any
/// order; siblings keep the order of the list.
///
/// The flat list (rather than nested vectors of children) keeps edits local and cannot overflow the stack.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RawRig {
    /// The joints in any order.
    pub joints: Vec<RawJoint>,
}

impl RawRig {
    /// Indices into [`Self::joints`], parents before children, siblings in the order of the list, each
    /// subtree in one piece; and for each joint of the list the index of its parent.
    pub(crate) fn parents_first(&self) -> Result<(Vec<usize>, Vec<Option<usize>>), RigError> {
        let mut by_name = HashMap::with_capacity(self.joints.len());
        for (index, joint) in self.joints.iter().enumerate() {
            if by_name.insert(joint.name.as_str(), index).is_some() {
                return Err(RigError::DuplicateJoint { joint: joint.name.clone() });
            }
        }
        let mut parents = Vec::with_capacity(self.joints.len());
        let mut children = vec![Vec::new(); self.joints.len()];
        let mut stack = Vec::new();
        for (index, joint) in self.joints.iter().enumerate() {
            let parent = match &joint.parent {
                None => None,
                Some(name) => Some(*by_name.get(name.as_str()).ok_or_else(|| RigError::UnknownParent {
                    joint: joint.name.clone(),
                    parent: name.clone(),
                })?),
            };
            match parent {
                Some(parent) => children[parent].push(index),
                None => stack.push(index),
            }
            parents.push(parent);
        }
        stack.reverse();
        let mut order = Vec::with_capacity(self.joints.len());
        while let Some(index) = stack.pop() {
            order.push(index);
            stack.extend(children[index].iter().rev());
        }
        if order.len() < self.joints.len() {
            let mut reached = vec![false; self.joints.len()];
            order.iter().for_each(|&index| reached[index] = true);
            let mut lost = reached.iter().position(|reached| !reached).unwrap_or(0);
            // It may only hang below the cycle: as many steps up as there are joints end on the cycle itself.
            for _ in 0..self.joints.len() {
                lost = parents[lost].unwrap_or(lost);
            }
            return Err(RigError::Cycle { joint: self.joints[lost].name.clone() });
        }
        Ok((order, parents))
    }
}
