use crate::scene::{Scene, Transform};
use std::collections::{BTreeMap, BTreeSet, HashMap};

/// Nodes and meshes of the written file: those of the scene in their order, then those that glTF's rules ask
/// for.
#[derive(Debug)]
pub(super) struct Plan<'s> {
    pub(super) nodes: Vec<PlannedNode<'s>>,
    /// One mesh each.
    pub(super) groups: Vec<Group>,
    /// Per skin the nodes of its joints, each one once.
    pub(super) skins: Vec<Vec<usize>>,
}

#[derive(Clone, Debug)]
pub(super) struct PlannedNode<'s> {
    pub(super) name: &'s str,
    pub(super) parent: Option<usize>,
    pub(super) local: Transform,
}

impl<'s> PlannedNode<'s> {
    fn still(name: &'s str, parent: Option<usize>) -> Self {
        Self { name, parent, local: Transform::default() }
    }
}

/// Parts that make one mesh: those of one node that share skin and names of shapes.
#[derive(Clone, Debug)]
pub(super) struct Group {
    /// The scene's node, whose weights count.
    pub(super) node: usize,
    /// The file's node.
    pub(super) at: usize,
    pub(super) skin: Option<usize>,
    /// Positions of parts; at least one.
    pub(super) parts: Vec<usize>,
}

/// What the parts of a group have in common.
#[derive(PartialEq, Eq, Hash)]
struct GroupKey<'s> {
    node: usize,
    skin: Option<usize>,
    name: &'s str,
    shapes: Vec<&'s str>,
}

impl<'s> Plan<'s> {
    pub(super) fn of(scene: &'s Scene) -> Self {
        let nodes = scene.nodes.iter();
        let nodes =
            nodes.map(|node| PlannedNode { name: &node.name, parent: node.parent, local: node.local });
        let mut plan = Self { nodes: nodes.collect(), groups: Vec::new(), skins: Vec::new() };
        plan.group(scene);
        plan.alias_joints(scene);
        plan.join_roots();
        plan
    }

    fn group(&mut self, scene: &'s Scene) {
        let mut known: HashMap<GroupKey<'s>, usize> = HashMap::new();
        let mut is_taken = vec![false; scene.nodes.len()];
        for (number, part) in scene.parts.iter().enumerate() {
            let key = GroupKey {
                node: part.node,
                skin: part.skin,
                // Readers call all primitives of a mesh as its node.
                name: &part.name,
                shapes: part.mesh.shapes.iter().map(|shape| shape.name.as_str()).collect(),
            };
            if let Some(group) = known.get(&key) {
                self.groups[*group].parts.push(number);
                continue;
            }
            let is_nodes = part.name.is_empty() || part.name == scene.nodes[part.node].name;
            let at = if is_nodes && !std::mem::replace(&mut is_taken[part.node], true) {
                part.node
            } else {
                self.nodes.push(PlannedNode::still(&part.name, Some(part.node)));
                self.nodes.len() - 1
            };
            known.insert(key, self.groups.len());
            self.groups.push(Group { node: part.node, at, skin: part.skin, parts: vec![number] });
        }
        // Readers list parts in the order of their nodes.
        self.groups.sort_by_key(|group| group.at);
    }

    /// A joint may be in a skin only once: a second use gets a child of the joint that does not move.
    fn alias_joints(&mut self, scene: &'s Scene) {
        for skin in &scene.skins {
            let mut seen = BTreeSet::new();
            let mut joints = Vec::with_capacity(skin.joints.len());
            for &joint in &skin.joints {
                joints.push(if seen.insert(joint) {
                    joint
                } else {
                    self.nodes.push(PlannedNode::still(&scene.nodes[joint].name, Some(joint)));
                    self.nodes.len() - 1
                });
            }
            self.skins.push(joints);
        }
    }

    /// The joints of a skin need a common root (section 3.7.3.2).
    fn join_roots(&mut self) {
        let roots = self.roots();
        let mut apart = BTreeSet::new();
        for joints in &self.skins {
            let of_skin: BTreeSet<usize> = joints.iter().map(|joint| roots[*joint]).collect();
            if of_skin.len() > 1 {
                apart.extend(of_skin);
            }
        }
        if apart.is_empty() {
            return;
        }
        let root = self.nodes.len();
        self.nodes.push(PlannedNode::still("", None));
        apart.into_iter().for_each(|node| self.nodes[node].parent = Some(root));
    }

    /// The root above each node. Chains may be as long as a file is, so what is known is not walked again.
    fn roots(&self) -> Vec<usize> {
        let mut known: BTreeMap<usize, usize> = BTreeMap::new();
        for start in 0..self.nodes.len() {
            let mut path = Vec::new();
            let mut at = start;
            let root = loop {
                if let Some(root) = known.get(&at) {
                    break *root;
                }
                path.push(at);
                match self.nodes[at].parent {
                    Some(parent) => at = parent,
                    None => break at,
                }
            };
            known.extend(path.into_iter().map(|node| (node, root)));
        }
        known.into_values().collect()
    }
}
