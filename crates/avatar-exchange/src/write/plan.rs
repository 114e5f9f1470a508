use crate::scene::{Scene, Transform};
use std::collections::{BTreeMap, BTreeSet};

/// Which nodes and meshes the file has: those of the scene in their order, then those that glTF's rules ask for.
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
        let mut by_node: Vec<Vec<usize>> = vec![Vec::new(); scene.nodes.len()];
        for (number, part) in scene.parts.iter().enumerate() {
            let first = |group: &usize| self.groups.get(*group).map(|group: &Group| group.parts[0]);
            let same = by_node[part.node].iter().copied().find(|group| {
                let Some(other) = first(group).and_then(|first| scene.parts.get(first)) else { return false };
                let names = part.mesh.shapes.iter().map(|shape| &shape.name);
                // Readers call all primitives of a mesh as its node.
                other.skin == part.skin
                    && other.name == part.name
                    && names.eq(other.mesh.shapes.iter().map(|shape| &shape.name))
            });
            if let Some(group) = same {
                self.groups[group].parts.push(number);
                continue;
            }
            let is_nodes = part.name.is_empty() || part.name == scene.nodes[part.node].name;
            let at = if by_node[part.node].iter().all(|group| self.groups[*group].at != part.node) && is_nodes
            {
                part.node
            } else {
                self.nodes.push(PlannedNode::still(&part.name, Some(part.node)));
                self.nodes.len() - 1
            };
            by_node[part.node].push(self.groups.len());
            self.groups.push(Group { node: part.node, at, skin: part.skin, parts: vec![number] });
        }
        // Readers go from node to node.
        self.groups.sort_by_key(|group| group.at);
    }

    /// A joint may be in a skin only once: of further ones, children that rest are.
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
