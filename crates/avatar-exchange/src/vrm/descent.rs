use crate::scene::Node;

/// Which nodes are below which, told in constant time: by numbers that are given on a way through the whole
/// hierarchy, when a node is entered and when it is left.
pub(super) struct Descent {
    children: Vec<Vec<usize>>,
    /// Entered and left; both 0 for nodes in a circle of parents, which no root leads to.
    times: Vec<[usize; 2]>,
}

impl Descent {
    pub(super) fn of(nodes: &[Node]) -> Self {
        let mut children = vec![Vec::new(); nodes.len()];
        for (number, node) in nodes.iter().enumerate() {
            let above = node.parent.and_then(|parent| children.get_mut(parent));
            above.into_iter().for_each(|all: &mut Vec<usize>| all.push(number));
        }
        let mut times = vec![[0; 2]; nodes.len()];
        let mut now = 0;
        for root in (0..nodes.len()).filter(|node| nodes[*node].parent.is_none()) {
            // Each node with the number of its children that were visited.
            let mut way = vec![(root, 0)];
            while let Some((node, visited)) = way.last_mut() {
                let [entered, left] = &mut times[*node];
                now += 1;
                if *visited == 0 {
                    *entered = now;
                }
                match children[*node].get(*visited) {
                    Some(child) => {
                        *visited += 1;
                        let child = *child;
                        way.push((child, 0));
                    }
                    None => {
                        *left = now;
                        way.pop();
                    }
                }
            }
        }
        Self { children, times }
    }

    /// Whether a node is below another one, its child or further down.
    pub(super) fn is_below(&self, above: usize, below: usize) -> bool {
        let ([a, a_end], [b, b_end]) = (self.times[above], self.times[below]);
        a < b && b_end <= a_end && b > 0
    }

    /// The children of a node, in the file's order of the nodes.
    pub(super) fn children(&self, node: usize) -> &[usize] {
        &self.children[node]
    }
}
