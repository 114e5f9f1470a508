//! Nodes of the visual scene.

use super::Reader;
use super::transform::{Step, product};
use super::xml::At;
use crate::scene::{Finding, ImportError, Node, Transform};
use glam::{DMat4, DQuat, DVec3};
use std::collections::HashMap;
use std::f64::consts::FRAC_PI_2;

/// Nodes in a scene: instances of instances can be many more than a file has elements.
const MAX_NODES: usize = 1 << 16;
/// Nodes of one name that are looked at for a joint.
const MAX_CANDIDATES: usize = 16;

/// Where the nodes of a scene come from.
#[derive(Debug, Default)]
pub(super) struct Nodes<'a> {
    /// Each node's element, but for a root that converts axes.
    pub(super) elements: Vec<(usize, At<'a>)>,
    /// Each node's transform.
    pub(super) steps: HashMap<usize, Vec<Step>>,
    /// Instances of the elements.
    pub(super) of_element: HashMap<usize, Vec<usize>>,
    by_sid: HashMap<&'a str, Vec<usize>>,
    by_name: HashMap<&'a str, Vec<usize>>,
}

impl<'a> Reader<'a> {
    /// Reads the visual scene's nodes with their transforms at rest.
    pub(super) fn read_nodes(&mut self) -> Result<Nodes<'a>, ImportError> {
        let root = self.tree.root();
        let conversion = self.conversion(root)?;
        let mut nodes = Nodes::default();
        let shown = match root.path(&["scene", "instance_visual_scene"]) {
            Some(instance) => Some(instance.target("url")?),
            None => root.path(&["library_visual_scenes", "visual_scene"]),
        };
        let tops = match shown {
            Some(shown) => children(shown)?,
            // Skeletons come this way, too: as nodes that no scene shows.
            None => {
                let libraries: Vec<At<'a>> = root.all("library_nodes").collect();
                self.note(
                    root,
                    Finding::missing(match libraries.is_empty() {
                        true => "there is no visual scene",
                        false => "there is no visual scene, so all nodes of the library are shown",
                    }),
                );
                libraries.into_iter().map(children).collect::<Result<Vec<_>, _>>()?.concat()
            }
        };
        let mut top = None;
        if conversion != DMat4::IDENTITY {
            let local = Transform::from_matrix(conversion);
            self.scene.nodes.push(Node { name: "conversion".to_owned(), local, ..Node::default() });
            top = Some(0);
        }
        let mut stack: Vec<(At<'a>, Option<usize>)> = tops.into_iter().map(|at| (at, top)).rev().collect();
        while let Some((at, parent)) = stack.pop() {
            let number = self.scene.nodes.len();
            if number >= MAX_NODES {
                return Err(
                    at.error(format!("at most {MAX_NODES} nodes"), "more; do instances contain themselves?")
                );
            }
            let steps: Vec<Step> =
                at.children().map(Step::of).filter_map(Result::transpose).collect::<Result<_, _>>()?;
            let local = Transform::from_matrix(product(steps.iter().map(|step| (step, &step.values[..]))));
            self.scene.nodes.push(Node { name: at.label().to_owned(), parent, local, ..Node::default() });
            stack.extend(children(at)?.into_iter().rev().map(|child| (child, Some(number))));
            nodes.add(at, number, steps);
        }
        Ok(nodes)
    }

    /// To metres and +Y up, noted.
    fn conversion(&mut self, root: At<'a>) -> Result<DMat4, ImportError> {
        let Some(asset) = root.child("asset") else { return Ok(DMat4::IDENTITY) };
        let unit = asset.child("unit").and_then(|unit| Some((unit, unit.attribute("meter")?)));
        let meters = match unit {
            Some((unit, text)) => {
                text.trim().replace(',', ".").parse().map_err(|_| unit.error("a number as 'meter'", text))?
            }
            None => 1.0,
        };
        if !(meters > 0.0 && f64::is_finite(meters)) {
            return Err(asset.error("a unit above 0", meters.to_string()));
        }
        let turn = match asset.child("up_axis").map_or("Y_UP", |axis| axis.text()) {
            "Z_UP" => DQuat::from_rotation_x(-FRAC_PI_2),
            // COLLADA 1.4.1: X_UP has right −Y and in +Z.
            "X_UP" => DQuat::from_rotation_z(FRAC_PI_2),
            _ => DQuat::IDENTITY,
        };
        if meters != 1.0 {
            let text = format!("units of {meters} m are converted to metres by a root node");
            self.note(asset, Finding::Converted(text));
        }
        if turn != DQuat::IDENTITY {
            self.note(asset, Finding::converted("the up axis is turned to +Y by a root node"));
        }
        if meters == 1.0 && turn == DQuat::IDENTITY {
            return Ok(DMat4::IDENTITY);
        }
        Ok(DMat4::from_scale_rotation_translation(DVec3::splat(meters), turn, DVec3::ZERO))
    }
}

/// Nodes in a node or scene: its own, and those that it refers to.
fn children(at: At<'_>) -> Result<Vec<At<'_>>, ImportError> {
    let mut found = Vec::new();
    for child in at.children() {
        match child.name() {
            "node" => found.push(child),
            "instance_node" => found.push(child.target("url")?),
            _ => {}
        }
    }
    Ok(found)
}

impl<'a> Nodes<'a> {
    fn add(&mut self, at: At<'a>, number: usize, steps: Vec<Step>) {
        self.elements.push((number, at));
        self.steps.insert(number, steps);
        self.of_element.entry(at.number).or_default().push(number);
        if let Some(sid) = at.attribute("sid") {
            self.by_sid.entry(sid).or_default().push(number);
        }
        if let Some(name) = at.attribute("name") {
            self.by_name.entry(name).or_default().push(number);
        }
    }

    /// The node that a skin calls a joint: below one of the skeletons where possible, by `sid`, then by id,
    /// then by name, which is what some exporters mean.
    pub(super) fn joint(
        &self,
        name: &str,
        skeletons: &[usize],
        nodes: &[Node],
        tree: &super::Tree,
    ) -> Option<usize> {
        let by_id = tree.by_id(name).and_then(|at| self.of_element.get(&at.number));
        let found = [self.by_sid.get(name), by_id, self.by_name.get(name)];
        let candidates = found.into_iter().flatten().find(|found| !found.is_empty())?;
        let below = |number: &&usize| {
            let parents = std::iter::successors(Some(**number), |at| nodes.get(*at)?.parent);
            parents.take(256).any(|at| skeletons.contains(&at))
        };
        candidates.iter().take(MAX_CANDIDATES).find(below).or(candidates.first()).copied()
    }
}
