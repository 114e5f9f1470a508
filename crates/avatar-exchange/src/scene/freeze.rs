use super::error::{ImportError, quoted};
use super::material::SceneImage;
use super::note::{Finding, Note};
use super::raw::{Channel, ChannelTarget, Interpolation, Node, RawScene, ScenePart, Transform};
use avatar_mesh::drivers::ShapeDrivers;
use avatar_mesh::{Mesh, MeshWarning};
use glam::Affine3A;
use std::ops::Deref;

/// A scene that was checked: every position in it leads somewhere, nodes form a forest, meshes are valid. The
/// fields of [`RawScene`] can be read directly, and mean the same: `scene.nodes`.
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    raw: RawScene,
    order: Vec<usize>,
    palette: Palette,
}

/// The matrices that deformation needs: one for each joint of each skin in the order of skins, then one for
/// each node that carries a rigid part, by node.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Palette {
    /// The matrices' sources.
    pub entries: Vec<PaletteEntry>,
    /// Where each skin's joints begin.
    pub skins: Vec<usize>,
    /// Where each node's matrix for rigid parts is.
    pub rigid: Vec<Option<usize>>,
}

/// Bone matrix = `world_from_node` · `node_from_mesh`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PaletteEntry {
    /// The node that moves it.
    pub node: usize,
    /// The skin's inverse bind matrix, or identity for rigid parts.
    pub node_from_mesh: Affine3A,
}

impl Deref for Scene {
    type Target = RawScene;
    fn deref(&self) -> &RawScene {
        &self.raw
    }
}

impl Scene {
    /// The same scene with these pictures in the place of its own; `None` where they are not as many.
    pub fn with_images(&self, images: Vec<SceneImage>) -> Option<Self> {
        if images.len() != self.raw.images.len() {
            return None;
        }
        let mut scene = self.clone();
        scene.raw.images = images;
        Some(scene)
    }

    /// Leaves parts out. Nodes, and with them the palette, stay.
    pub fn retain_parts(&mut self, keep: impl FnMut(&ScenePart) -> bool) {
        self.raw.parts.retain(keep);
    }

    /// Takes the mesh of a part, so that what keeps it need not copy it, and leaves an empty one: the scene
    /// is then good for its nodes, clips, looks and pictures only.
    pub fn take_mesh(&mut self, part: usize) -> Option<Mesh> {
        self.raw.parts.get_mut(part).map(|part| std::mem::take(&mut part.mesh))
    }

    /// Checks a scene. Weights of bones that do not quite sum to 1 are divided by their sum, with a note.
    ///
    /// # Errors
    /// The first thing that is wrong, with its place.
    pub fn from_raw(mut raw: RawScene) -> Result<Self, ImportError> {
        let order = order(&raw.nodes)?;
        check_nodes(&raw.nodes)?;
        check_skins(&raw)?;
        check_parts(&mut raw)?;
        check_drivers(&raw)?;
        check_clips(&raw)?;
        check_materials(&raw)?;
        let palette = Palette::of(&raw);
        Ok(Self { raw, order, palette })
    }

    /// All nodes, every one after its parent.
    pub fn order(&self) -> &[usize] {
        &self.order
    }

    /// What the bone matrices belong to.
    pub fn palette(&self) -> &Palette {
        &self.palette
    }

    /// The scene, its order and its palette, for what keeps a part of them.
    pub(super) fn into_fields(self) -> (RawScene, Vec<usize>, Palette) {
        (self.raw, self.order, self.palette)
    }
}

impl Palette {
    fn of(raw: &RawScene) -> Self {
        let mut palette = Self { rigid: vec![None; raw.nodes.len()], ..Self::default() };
        for skin in &raw.skins {
            palette.skins.push(palette.entries.len());
            let entry = |(&node, &node_from_mesh)| PaletteEntry { node, node_from_mesh };
            palette.entries.extend(skin.joints.iter().zip(&skin.inverse_binds).map(entry));
        }
        for part in raw.parts.iter().filter(|part| part.skin.is_none()) {
            palette.rigid[part.node] = Some(0);
        }
        for (node, entry) in palette.rigid.iter_mut().enumerate().filter(|(_, entry)| entry.is_some()) {
            *entry = Some(palette.entries.len());
            palette.entries.push(PaletteEntry { node, node_from_mesh: Affine3A::IDENTITY });
        }
        palette
    }
}

/// Parents first. Walks with an explicit stack: chains may be as long as a file is.
fn order(nodes: &[Node]) -> Result<Vec<usize>, ImportError> {
    let mut children = vec![Vec::new(); nodes.len()];
    let mut stack = Vec::new();
    for (number, node) in nodes.iter().enumerate() {
        match node.parent {
            None => stack.push(number),
            Some(parent) if parent < nodes.len() => children[parent].push(number),
            Some(parent) => {
                return Err(out_of_range(node_place(nodes, number), "a node", nodes.len(), parent));
            }
        }
    }
    stack.reverse();
    let mut order = Vec::with_capacity(nodes.len());
    let mut reached = vec![false; nodes.len()];
    while let Some(number) = stack.pop() {
        reached[number] = true;
        order.push(number);
        stack.extend(children[number].iter().rev());
    }
    match reached.iter().position(|reached| !reached) {
        None => Ok(order),
        Some(number) => {
            let expected = "a chain of parents that ends at a root";
            Err(ImportError::new(node_place(nodes, number), expected, "a cycle"))
        }
    }
}

fn node_place(nodes: &[Node], number: usize) -> String {
    format!("node {number} {}", quoted(&nodes[number].name))
}

fn out_of_range(place: String, what: &str, length: usize, found: usize) -> ImportError {
    ImportError::new(place, format!("{what} below {length}"), found.to_string())
}

fn in_range(place: impl Fn() -> String, what: &str, length: usize, found: usize) -> Result<(), ImportError> {
    if found < length { Ok(()) } else { Err(out_of_range(place(), what, length, found)) }
}

fn check_nodes(nodes: &[Node]) -> Result<(), ImportError> {
    for (number, node) in nodes.iter().enumerate() {
        if !(node.local.is_finite() && node.weights.iter().all(|weight| weight.is_finite())) {
            let found = format!("{:?} {:?}", node.local, node.weights);
            return Err(ImportError::new(node_place(nodes, number), "finite numbers", found));
        }
    }
    Ok(())
}

fn check_skins(raw: &RawScene) -> Result<(), ImportError> {
    for (number, skin) in raw.skins.iter().enumerate() {
        let place = || format!("skin {number} {}", quoted(&skin.name));
        if skin.joints.is_empty() {
            return Err(ImportError::new(place(), "at least one joint", "none"));
        }
        for &joint in &skin.joints {
            in_range(place, "a joint's node", raw.nodes.len(), joint)?;
        }
        if skin.inverse_binds.len() != skin.joints.len() {
            let expected = format!("{} inverse bind matrices", skin.joints.len());
            return Err(ImportError::new(place(), expected, skin.inverse_binds.len().to_string()));
        }
        if let Some(joint) = skin.inverse_binds.iter().position(|matrix| !matrix.is_finite()) {
            let place = format!("{}, joint {joint}", place());
            return Err(ImportError::new(place, "finite numbers", format!("{}", skin.inverse_binds[joint])));
        }
    }
    Ok(())
}

fn check_parts(raw: &mut RawScene) -> Result<(), ImportError> {
    for (number, part) in raw.parts.iter_mut().enumerate() {
        let name = &part.name;
        let place = || format!("part {number} {}", quoted(name));
        in_range(place, "a node", raw.nodes.len(), part.node)?;
        if let Some(material) = part.material {
            in_range(place, "a material", raw.materials.len(), material)?;
        }
        let joints = match (part.skin, &part.mesh.skinning) {
            (Some(skin), Some(_)) => {
                in_range(place, "a skin", raw.skins.len(), skin)?;
                raw.skins[skin].joints.len()
            }
            (None, None) => 1,
            (Some(_), None) => return Err(ImportError::new(place(), "bones of its vertices", "none")),
            (None, Some(_)) => return Err(ImportError::new(place(), "a skin for its bones", "none")),
        };
        let (shapes, weights) = (part.mesh.shapes.len(), raw.nodes[part.node].weights.len());
        if shapes != weights {
            let expected = format!("{weights} shapes, one for each weight of its node");
            return Err(ImportError::new(place(), expected, shapes.to_string()));
        }
        match part.mesh.validate(joints) {
            Ok(warnings) => {
                let note = |warning: &MeshWarning| Note::new(place(), Finding::mended(warning.to_string()));
                raw.notes.extend(warnings.iter().map(note));
            }
            Err(error) => return Err(ImportError::new(place(), "a valid mesh", error.to_string())),
        }
    }
    Ok(())
}

fn check_drivers(raw: &RawScene) -> Result<(), ImportError> {
    for (number, drivers) in raw.drivers.iter().enumerate() {
        let place = || format!("drivers {number}");
        in_range(place, "a node", raw.nodes.len(), drivers.node)?;
        let (shapes, weights) = (drivers.shapes.len(), raw.nodes[drivers.node].weights.len());
        if shapes != weights {
            let expected = format!("{weights} shapes, one for each weight of its node");
            return Err(ImportError::new(place(), expected, shapes.to_string()));
        }
        let (values, names) = (drivers.rest.len(), drivers.drivers.len());
        if values != names || drivers.rest.iter().any(|value| !value.is_finite()) {
            let expected = format!("{names} finite values, one for each driver");
            return Err(ImportError::new(place(), expected, format!("{:?}", drivers.rest)));
        }
        if let Err(error) = ShapeDrivers::new(&drivers.drivers, &drivers.shapes, &drivers.rules) {
            return Err(ImportError::new(place(), "rules that can be followed", error.to_string()));
        }
    }
    Ok(())
}

fn check_clips(raw: &RawScene) -> Result<(), ImportError> {
    for (number, clip) in raw.clips.iter().enumerate() {
        for (index, channel) in clip.channels.iter().enumerate() {
            let place = || {
                let name = if clip.name.is_empty() { number.to_string() } else { quoted(&clip.name) };
                format!("animation {name}, channel {index}")
            };
            in_range(place, "a node", raw.nodes.len(), channel.node)?;
            check_channel(channel, &raw.nodes[channel.node])
                .map_err(|(expected, found)| ImportError::new(place(), expected, found))?;
        }
    }
    Ok(())
}

/// What was expected and what was found instead.
fn check_channel(channel: &Channel, node: &Node) -> Result<(), (String, String)> {
    if channel.target != ChannelTarget::Weights && matches!(node.local, Transform::Matrix(_)) {
        let found = "one whose matrix is no product of translation, rotation and scale";
        return Err(("a node that can be moved".to_owned(), found.to_owned()));
    }
    if channel.times.is_empty() {
        return Err(("at least one key".to_owned(), "none".to_owned()));
    }
    // In files times have 32 bits.
    if let Some(at) = channel.times.iter().position(|time| !(*time as f32).is_finite()) {
        return Err((format!("a finite time of key {at}"), channel.times[at].to_string()));
    }
    if let Some(at) = channel.times.windows(2).position(|pair| pair[1] < pair[0]) {
        let expected = format!("a time of key {} not before {}", at + 1, channel.times[at]);
        return Err((expected, channel.times[at + 1].to_string()));
    }
    let per_key = if channel.interpolation == Interpolation::CubicSpline { 3 } else { 1 };
    let expected =
        channel.target.width(node.weights.len()).saturating_mul(per_key).saturating_mul(channel.times.len());
    if channel.values.len() != expected {
        let what = format!("{expected} numbers for {} keys", channel.times.len());
        return Err((what, channel.values.len().to_string()));
    }
    match channel.values.iter().find(|value| !value.is_finite()) {
        Some(value) => Err(("finite values".to_owned(), value.to_string())),
        None => Ok(()),
    }
}

fn check_materials(raw: &RawScene) -> Result<(), ImportError> {
    for (number, material) in raw.materials.iter().enumerate() {
        let place = || format!("material {number} {}", quoted(&material.name));
        for texture in material.textures() {
            in_range(place, "an image", raw.images.len(), texture.image)?;
        }
        if let Some(factor) = material.factors().find(|factor| !factor.is_finite()) {
            return Err(ImportError::new(place(), "finite factors", factor.to_string()));
        }
    }
    Ok(())
}
