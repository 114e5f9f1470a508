use super::error::ImportError;
use super::freeze::{Palette, PaletteEntry, Scene};
use super::interpolate::sample;
use super::raw::{Channel, ChannelTarget, Clip, Node, Transform, narrow, widen};
use glam::{Affine3A, DAffine3, Quat, Vec3};

/// Where all nodes are, relative to their parents, and how much all shapes count.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ScenePose {
    /// `parent_from_node` for each node.
    pub locals: Vec<Transform>,
    /// Blend weights for each node.
    pub weights: Vec<Vec<f32>>,
}

/// What evaluation needs of a scene: nodes, clips and palette, without meshes, materials and pictures. Made
/// by [`Scene::into_graph`], for programs that hold the meshes elsewhere; its poses are those of the scene.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneGraph {
    nodes: Vec<Node>,
    clips: Vec<Clip>,
    order: Vec<usize>,
    palette: Palette,
}

/// The same, borrowed from a scene or a graph.
#[derive(Clone, Copy)]
struct View<'a> {
    nodes: &'a [Node],
    clips: &'a [Clip],
    order: &'a [usize],
    palette: &'a Palette,
}

impl Scene {
    /// Keeps nodes, clips and palette, and drops the rest.
    pub fn into_graph(self) -> SceneGraph {
        let (raw, order, palette) = self.into_fields();
        SceneGraph { nodes: raw.nodes, clips: raw.clips, order, palette }
    }

    fn view(&self) -> View<'_> {
        View { nodes: &self.nodes, clips: &self.clips, order: self.order(), palette: self.palette() }
    }

    /// The pose of the file outside of its animations.
    pub fn rest(&self) -> ScenePose {
        self.view().rest()
    }

    /// The pose of a clip at a time in seconds; what the clip does not move is at rest. Before the first key
    /// and after the last one, the nearest key holds.
    ///
    /// # Errors
    /// `clip` is out of range.
    pub fn at(&self, clip: usize, time_secs: f64) -> Result<ScenePose, ImportError> {
        self.view().at(clip, time_secs)
    }

    /// Overwrites what a clip moves, in a pose of this scene. Allocates nothing.
    ///
    /// # Errors
    /// `clip` is out of range, or the pose is another scene's.
    pub fn apply(&self, clip: usize, time_secs: f64, pose: &mut ScenePose) -> Result<(), ImportError> {
        self.view().apply(clip, time_secs, pose)
    }

    /// `world_from_node` for each node, in the nodes' order, computed in f64. Locals that the pose lacks are
    /// taken from rest.
    pub fn worlds(&self, pose: &ScenePose) -> Vec<DAffine3> {
        self.view().worlds(pose)
    }

    /// The bone matrices `world_from_mesh` for all parts, one for each entry of the palette. A skinned part
    /// is moved by its joints alone, not by its node (glTF 2.0, section 3.7.3.3).
    pub fn bones(&self, pose: &ScenePose) -> Vec<Affine3A> {
        self.view().bones(pose)
    }

    /// What [`avatar_mesh::deform`] needs of [`Scene::bones`] for a part: one matrix for each joint of its
    /// skin, or the one of a rigid part. Empty where `part` is out of range, or the bones are another
    /// scene's.
    pub fn bones_of<'a>(&self, part: usize, bones: &'a [Affine3A]) -> &'a [Affine3A] {
        let Some(part) = self.parts.get(part) else { return &[] };
        let palette = self.palette();
        let range = match (part.skin, palette.rigid[part.node]) {
            (Some(skin), _) => palette.skins[skin]..palette.skins[skin] + self.skins[skin].joints.len(),
            (None, Some(entry)) => entry..entry + 1,
            (None, None) => 0..0,
        };
        bones.get(range).unwrap_or(&[])
    }

    /// The blend weights of a part in a pose; empty where there is no such part.
    pub fn weights_of<'a>(&self, part: usize, pose: &'a ScenePose) -> &'a [f32] {
        self.parts.get(part).and_then(|part| pose.weights.get(part.node)).map_or(&[], Vec::as_slice)
    }
}

impl SceneGraph {
    fn view(&self) -> View<'_> {
        View { nodes: &self.nodes, clips: &self.clips, order: &self.order, palette: &self.palette }
    }

    /// The nodes of the scene, in its order.
    pub fn nodes(&self) -> &[Node] {
        &self.nodes
    }

    /// The clips of the scene, in its order.
    pub fn clips(&self) -> &[Clip] {
        &self.clips
    }

    /// As [`Scene::rest`].
    pub fn rest(&self) -> ScenePose {
        self.view().rest()
    }

    /// As [`Scene::at`].
    ///
    /// # Errors
    /// `clip` is out of range.
    pub fn at(&self, clip: usize, time_secs: f64) -> Result<ScenePose, ImportError> {
        self.view().at(clip, time_secs)
    }

    /// As [`Scene::apply`]. Allocates nothing.
    ///
    /// # Errors
    /// `clip` is out of range, or the pose is another scene's.
    pub fn apply(&self, clip: usize, time_secs: f64, pose: &mut ScenePose) -> Result<(), ImportError> {
        self.view().apply(clip, time_secs, pose)
    }

    /// As [`Scene::worlds`].
    pub fn worlds(&self, pose: &ScenePose) -> Vec<DAffine3> {
        self.view().worlds(pose)
    }

    /// As [`Scene::bones`].
    pub fn bones(&self, pose: &ScenePose) -> Vec<Affine3A> {
        self.view().bones(pose)
    }
}

impl View<'_> {
    fn rest(self) -> ScenePose {
        ScenePose {
            locals: self.nodes.iter().map(|node| node.local).collect(),
            weights: self.nodes.iter().map(|node| node.weights.clone()).collect(),
        }
    }

    fn at(self, clip: usize, time_secs: f64) -> Result<ScenePose, ImportError> {
        let mut pose = self.rest();
        self.apply(clip, time_secs, &mut pose)?;
        Ok(pose)
    }

    fn apply(self, clip: usize, time_secs: f64, pose: &mut ScenePose) -> Result<(), ImportError> {
        let clips = self.clips.len();
        let clip = self
            .clips
            .get(clip)
            .ok_or_else(|| ImportError::new("the pose", format!("a clip below {clips}"), clip.to_string()))?;
        let same = |(node, weights): (&Node, &Vec<f32>)| node.weights.len() == weights.len();
        let fits = pose.locals.len() == self.nodes.len()
            && pose.weights.len() == self.nodes.len()
            && self.nodes.iter().zip(&pose.weights).all(same);
        if !fits {
            let expected = format!("locals and weights of the scene's {} nodes", self.nodes.len());
            let found =
                format!("{} and {}, or other numbers of weights", pose.locals.len(), pose.weights.len());
            return Err(ImportError::new("the pose", expected, found));
        }
        for channel in &clip.channels {
            apply_channel(channel, time_secs, pose);
        }
        Ok(())
    }

    fn worlds(self, pose: &ScenePose) -> Vec<DAffine3> {
        let mut worlds = vec![DAffine3::IDENTITY; self.nodes.len()];
        for &number in self.order {
            let node = &self.nodes[number];
            let parent_from_node = pose.locals.get(number).unwrap_or(&node.local).affine();
            worlds[number] = match node.parent {
                Some(parent) => worlds[parent] * parent_from_node,
                None => parent_from_node,
            };
        }
        worlds
    }

    fn bones(self, pose: &ScenePose) -> Vec<Affine3A> {
        let worlds = self.worlds(pose);
        let bone = |entry: &PaletteEntry| narrow(worlds[entry.node] * widen(&entry.node_from_mesh));
        self.palette.entries.iter().map(bone).collect()
    }
}

fn apply_channel(channel: &Channel, time_secs: f64, pose: &mut ScenePose) {
    if channel.target == ChannelTarget::Weights {
        sample(channel, time_secs, &mut pose.weights[channel.node]);
        return;
    }
    let Transform::Trs(trs) = &mut pose.locals[channel.node] else { return };
    let mut value = [0.0; 4];
    match channel.target {
        ChannelTarget::Translation => {
            sample(channel, time_secs, &mut value[..3]);
            trs.translation = Vec3::from_slice(&value);
        }
        ChannelTarget::Scale => {
            sample(channel, time_secs, &mut value[..3]);
            trs.scale = Vec3::from_slice(&value);
        }
        ChannelTarget::Rotation => {
            sample(channel, time_secs, &mut value);
            trs.rotation = Quat::from_array(value);
        }
        ChannelTarget::Weights => {}
    }
}
