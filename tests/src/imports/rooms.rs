//! The order of rooms.

use std::collections::{BTreeMap, BTreeSet};

use super::circles::strongly_connected;
use super::graph::Graph;

/// Arrows between the children of one module: from, to, and an example of each.
type Arrows = BTreeMap<(usize, usize), (usize, usize)>;

/// What goes against the order of rooms, each as a sentence: a module of the root that imports one which
/// stands behind it in the root file; and below the root, rooms (modules with submodules) that import each
/// other.
pub fn rooms(graph: &Graph) -> Vec<String> {
    let mut findings = Vec::new();
    for (number, module) in graph.modules.modules.iter().enumerate() {
        let arrows = arrows_between_children(graph, number);
        let name = |child: usize| module.children[child].0.as_str();
        for (&(from, to), &(file, other)) in &arrows {
            let has_submodules =
                |child: usize| !graph.modules.modules[module.children[child].1].children.is_empty();
            let (against, why) = if number == 0 {
                (from < to, format!("{} stands behind {} in {}", name(to), name(from), graph.name(0)))
            } else {
                let mutual = arrows.contains_key(&(to, from)) && (has_submodules(from) || has_submodules(to));
                (mutual && from < to, format!("the rooms {} and {} import each other", name(from), name(to)))
            };
            if against {
                let import = &graph.imports[&(file, other)];
                findings.push(format!("{}:{}: {}: {why}", graph.name(file), import.line, import.path));
            }
        }
    }
    findings
}

/// An order of the root's modules in which each imports only what stands before it, as near to the present
/// one as can be. Modules that import each other stand in one string, since no order fits them.
pub fn order_that_fits(graph: &Graph) -> Vec<String> {
    let arrows = arrows_between_children(graph, 0);
    let children = &graph.modules.modules[0].children;
    let nodes: BTreeSet<usize> = (0..children.len()).collect();
    let to = |from: usize| arrows.range((from, 0)..(from + 1, 0)).map(|(&(_, to), _)| to).collect::<Vec<_>>();
    let mut groups = strongly_connected(&nodes, to);
    for &node in &nodes {
        if !groups.iter().any(|group| group.contains(&node)) {
            groups.push(BTreeSet::from([node]));
        }
    }
    groups.sort();
    let mut order = Vec::new();
    let mut placed: BTreeSet<usize> = BTreeSet::new();
    while !groups.is_empty() {
        let is_ready = |group: &BTreeSet<usize>| {
            group
                .iter()
                .all(|&node| to(node).iter().all(|other| group.contains(other) || placed.contains(other)))
        };
        let next = groups.iter().position(is_ready).unwrap_or(0);
        let group = groups.remove(next);
        let names: Vec<_> = group.iter().map(|&node| children[node].0.as_str()).collect();
        order.push(names.join(" ⇄ "));
        placed.extend(group);
    }
    order
}

fn arrows_between_children(graph: &Graph, module: usize) -> Arrows {
    let children = &graph.modules.modules[module].children;
    let child_of = |file: usize| {
        let chain = graph.modules.ancestry(file);
        let at = chain.iter().position(|&step| step == module)?;
        children.iter().position(|(_, child)| chain.get(at + 1) == Some(child))
    };
    let mut arrows = Arrows::new();
    for &(from, to) in graph.imports.keys() {
        if let (Some(a), Some(b)) = (child_of(from), child_of(to))
            && a != b
        {
            arrows.entry((a, b)).or_insert((from, to));
        }
    }
    arrows
}
