//! Circles of imports.

use std::collections::{BTreeMap, BTreeSet};

use super::graph::Graph;

/// The circles of a crate's files, each as a sentence. A module and its submodules may import each other; the
/// submodules among themselves may not go in circles, nor may anything from outside take part.
pub fn circles(graph: &Graph) -> Vec<String> {
    let mut findings = Vec::new();
    let all: BTreeSet<usize> = (0..graph.file_count()).collect();
    look(graph, &all, &mut findings);
    findings
}

fn look(graph: &Graph, files: &BTreeSet<usize>, findings: &mut Vec<String>) {
    let arrows = |file: usize| graph.imported_by(file).filter(|to| files.contains(to)).collect();
    for circle in strongly_connected(files, arrows) {
        if let Some(parent) = module_of_all(graph, &circle) {
            let rest: BTreeSet<usize> = circle.iter().copied().filter(|&file| file != parent).collect();
            look(graph, &rest, findings);
        } else {
            findings.push(sentence(graph, &circle));
        }
    }
}

/// The file whose module holds the modules of all other files.
fn module_of_all(graph: &Graph, circle: &BTreeSet<usize>) -> Option<usize> {
    circle.iter().copied().find(|&file| {
        let Some(module) = graph.modules.module_of_file(file) else { return false };
        circle.iter().all(|&other| graph.modules.ancestry(other).contains(&module))
    })
}

fn sentence(graph: &Graph, circle: &BTreeSet<usize>) -> String {
    let names: Vec<_> = circle.iter().map(|&file| graph.name(file)).collect();
    let mut text = format!("circle of {} files: {}", circle.len(), names.join(", "));
    for (&(from, to), import) in &graph.imports {
        // That a module has a submodule needs no line: the names tell.
        if circle.contains(&from) && circle.contains(&to) && import.line > 0 {
            let place = format!("{}:{}", graph.name(from), import.line);
            text += &format!("\n      {place}: {} → {}", import.path, graph.name(to));
        }
    }
    text
}

/// The groups of more than one node in which each reaches each other. Small graphs only: it asks every pair.
pub(super) fn strongly_connected(
    nodes: &BTreeSet<usize>,
    arrows: impl Fn(usize) -> Vec<usize>,
) -> Vec<BTreeSet<usize>> {
    let reach: BTreeMap<usize, BTreeSet<usize>> = nodes
        .iter()
        .map(|&start| {
            let (mut seen, mut open) = (BTreeSet::new(), vec![start]);
            while let Some(node) = open.pop() {
                open.extend(arrows(node).into_iter().filter(|&to| seen.insert(to)));
            }
            (start, seen)
        })
        .collect();
    let mut groups: Vec<BTreeSet<usize>> = Vec::new();
    for &node in nodes {
        if groups.iter().any(|group| group.contains(&node)) {
            continue;
        }
        let group: BTreeSet<usize> = reach[&node]
            .iter()
            .copied()
            .filter(|to| reach.get(to).is_some_and(|back| back.contains(&node)))
            .collect();
        if group.len() > 1 {
            groups.push(group);
        }
    }
    groups
}
