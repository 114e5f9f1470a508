//! What is seen through the character's own eyes.

use super::place::Place;
use crate::scene::{ImportError, RawScene};
use glam::Vec3;

/// A file names a mesh once, and it counts at every node that shows it.
const MOST_PARTS: usize = 1 << 20;

/// What is seen of an avatar through its own eyes, and from where.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FirstPerson {
    /// The node that the eyes' place follows, where the file says one (0.x); else the head's.
    pub node: Option<usize>,
    /// That place in the space of the node (0.x); VRM 1.0 has it in [`super::LookAt::offset_from_head`] only.
    pub offset: Option<Vec3>,
    /// Nodes with meshes and when these are seen. All others are as [`FirstPersonView::Auto`].
    pub views: Vec<(usize, FirstPersonView)>,
}

/// When a node's mesh is seen.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FirstPersonView {
    /// By the character itself without what follows its head, by others whole.
    #[default]
    Auto,
    /// By everybody.
    Both,
    /// Only by others.
    ThirdPersonOnly,
    /// Only by the character itself.
    FirstPersonOnly,
}

impl FirstPersonView {
    fn of(place: &Place<'_>) -> Result<Self, ImportError> {
        // 0.x has capital letters, VRM 1.0 a small first one.
        match place.str()? {
            "auto" | "Auto" => Ok(Self::Auto),
            "both" | "Both" => Ok(Self::Both),
            "thirdPersonOnly" | "ThirdPersonOnly" => Ok(Self::ThirdPersonOnly),
            "firstPersonOnly" | "FirstPersonOnly" => Ok(Self::FirstPersonOnly),
            _ => Err(place.wrong("auto, both, thirdPersonOnly or firstPersonOnly")),
        }
    }
}

impl FirstPerson {
    /// When the mesh of a node is seen.
    pub fn view(&self, node: usize) -> FirstPersonView {
        let view = self.views.iter().find(|(other, _)| *other == node);
        view.map_or(FirstPersonView::Auto, |(_, view)| *view)
    }
}

/// Reads `VRMC_vrm.firstPerson`.
pub(super) fn read(place: &Place<'_>, raw: &RawScene) -> Result<FirstPerson, ImportError> {
    let mut views = Vec::new();
    for place in place.list("meshAnnotations")? {
        let node = place.need("node")?.index("a node", raw.nodes.len())?;
        views.push((node, FirstPersonView::of(&place.need("type")?)?));
    }
    Ok(FirstPerson { views, ..FirstPerson::default() })
}

/// Reads `firstPerson` of VRM 0.x. `nodes_of_meshes` are per mesh of the file the nodes that show it.
pub(super) fn read_v0(
    place: &Place<'_>,
    nodes_of_meshes: &[Vec<usize>],
    raw: &RawScene,
) -> Result<FirstPerson, ImportError> {
    let node = match place.get("firstPersonBone")? {
        Some(node) => node.index_or_none("a node", raw.nodes.len())?,
        None => None,
    };
    let offset = place.get("firstPersonBoneOffset")?.map(|offset| {
        // Of a left-handed space: forward is +z there and −z in the file.
        let [x, y, z] = ["x", "y", "z"].map(|axis| offset.float_or(axis, 0.0));
        Ok::<_, ImportError>(Vec3::new(x?, y?, -z?))
    });
    let mut views = Vec::new();
    for place in place.list("meshAnnotations")? {
        let flag = place.get("firstPersonFlag")?;
        let view = flag.map_or(Ok(FirstPersonView::Auto), |flag| FirstPersonView::of(&flag))?;
        let mesh = match place.get("mesh")? {
            Some(mesh) => mesh.index_or_none("a mesh", nodes_of_meshes.len())?,
            None => None,
        };
        let nodes = mesh.map_or(&[][..], |mesh| &nodes_of_meshes[mesh]);
        if views.len() + nodes.len() > MOST_PARTS {
            return Err(place.wrong(format!("at most {MOST_PARTS} nodes in all annotations")));
        }
        views.extend(nodes.iter().map(|node| (*node, view)));
    }
    Ok(FirstPerson { node, offset: offset.transpose()?, views })
}
