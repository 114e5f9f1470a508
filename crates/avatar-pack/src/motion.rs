use crate::unique::unique_names;
use avatar_exchange::{ChannelTarget, Clip, Node, Scene, SceneGraph, ScenePose, Transform};
use glam::{Affine3A, DAffine3};
use rig_core::JointId;

/// The clips of an imported avatar, and what they do to it.
#[derive(Clone, Debug)]
pub struct SceneMotion {
    graph: SceneGraph,
    joints: Vec<JointId>,
    node_from_parent: Vec<DAffine3>,
    first_shape: Vec<usize>,
    /// Per clip what it moves.
    moved: Vec<Moved>,
}

/// The nodes that a clip has channels for, each once, in the order of the nodes.
#[derive(Clone, Debug, Default)]
struct Moved {
    locals: Vec<usize>,
    weights: Vec<usize>,
}

impl Moved {
    fn by(clip: &Clip, nodes: &[Node]) -> Self {
        let mut moved = Self::default();
        for channel in &clip.channels {
            let is_movable =
                |node: &usize| nodes.get(*node).is_some_and(|node| matches!(node.local, Transform::Trs(_)));
            match channel.target {
                ChannelTarget::Weights => moved.weights.push(channel.node),
                // A node whose transform is a matrix has no translation, rotation or scale that a channel
                // could set.
                _ => moved.locals.extend(Some(channel.node).filter(is_movable)),
            }
        }
        for nodes in [&mut moved.locals, &mut moved.weights] {
            nodes.sort_unstable();
            nodes.dedup();
        }
        moved
    }
}

/// A clip that does not exist.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("expected the name of a clip, found {found:?}; there are: {}", if .clips.is_empty() { "none".to_owned() } else { .clips.join(", ") })]
pub struct MotionError {
    /// What was asked for.
    pub found: String,
    /// The clips.
    pub clips: Vec<String>,
}

/// What a clip sets at one time: the `L` of joints, and weights by their places in [`crate::Pack::shapes`].
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MotionAt {
    /// Local transforms of all joints that the clip moves, also of those that are at rest at this time: a
    /// control must not move them meanwhile.
    pub locals: Vec<(JointId, Affine3A)>,
    /// Weights of all shapes that the clip moves.
    pub weights: Vec<(usize, f32)>,
}

/// A clip of a file that is being played; made by [`SceneMotion::sampler`].
#[derive(Clone, Debug)]
pub struct MotionSampler {
    clip: usize,
    pose: ScenePose,
    at: MotionAt,
}

impl SceneMotion {
    pub(crate) fn new(
        scene: Scene,
        joints: Vec<JointId>,
        node_from_parent: Vec<DAffine3>,
        first_shape: Vec<usize>,
    ) -> Self {
        let graph = scene.into_graph();
        let moved = graph.clips().iter().map(|clip| Moved::by(clip, graph.nodes())).collect();
        Self { graph, joints, node_from_parent, first_shape, moved }
    }

    /// The nodes and clips of the scene that the avatar was made of. Its meshes are the pack's parts.
    pub fn graph(&self) -> &SceneGraph {
        &self.graph
    }

    /// The joint that a node of the scene became.
    pub fn joint(&self, node: usize) -> Option<JointId> {
        self.joints.get(node).copied()
    }

    /// The place in [`crate::Pack::shapes`] of a shape at a node of the scene.
    pub fn shape(&self, node: usize, shape: usize) -> Option<usize> {
        let shapes = self.graph.nodes().get(node)?.weights.len();
        (shape < shapes).then(|| self.first_shape.get(node).map(|first| first + shape)).flatten()
    }

    /// Names of the clips; those without get a number.
    pub fn clips(&self) -> Vec<String> {
        unique_names(self.graph.clips().iter().map(|clip| clip.name.as_str()), "clip")
    }

    /// How long a clip is, in seconds.
    ///
    /// # Errors
    /// A clip that does not exist.
    pub fn duration_secs(&self, clip: &str) -> Result<f64, MotionError> {
        Ok(self.graph.clips()[self.find(clip)?].duration_secs())
    }

    /// What a clip sets at a time in seconds. Before its first key it has that key's values, after its last
    /// one the last one's.
    ///
    /// # Errors
    /// A clip that does not exist.
    pub fn at(&self, clip: &str, time_secs: f64) -> Result<MotionAt, MotionError> {
        let mut sampler = self.sampler(self.find(clip)?)?;
        self.sample(&mut sampler, time_secs);
        Ok(sampler.at)
    }

    /// What a clip is played with: asked for again and again, it allocates nothing after the first time.
    ///
    /// # Errors
    /// A clip that does not exist, by its place in [`SceneMotion::clips`].
    pub fn sampler(&self, clip: usize) -> Result<MotionSampler, MotionError> {
        match self.graph.clips().get(clip) {
            Some(_) => Ok(MotionSampler { clip, pose: self.graph.rest(), at: MotionAt::default() }),
            None => Err(self.missing(&format!("number {clip}"))),
        }
    }

    /// What the sampler's clip sets at a time in seconds. A sampler of another avatar gives nothing.
    pub fn sample<'a>(&self, sampler: &'a mut MotionSampler, time_secs: f64) -> &'a MotionAt {
        let MotionSampler { clip, pose, at } = sampler;
        at.locals.clear();
        at.weights.clear();
        if self.graph.apply(*clip, time_secs, pose).is_err() {
            return at;
        }
        let Some(moved) = self.moved.get(*clip) else { return at };
        for &node in &moved.locals {
            let (local, rest) = (&pose.locals[node], &self.graph.nodes()[node].local);
            let here = match local == rest {
                // To the bit, as without the clip.
                true => Affine3A::IDENTITY,
                false => narrow(self.node_from_parent[node] * local.affine()),
            };
            at.locals.push((self.joints[node], here));
        }
        for &node in &moved.weights {
            let first = self.first_shape[node];
            let weights = pose.weights[node].iter().enumerate();
            at.weights.extend(weights.map(|(shape, weight)| (first + shape, *weight)));
        }
        at
    }

    fn find(&self, clip: &str) -> Result<usize, MotionError> {
        self.clips().iter().position(|name| name == clip).ok_or_else(|| self.missing(clip))
    }

    fn missing(&self, clip: &str) -> MotionError {
        MotionError { found: clip.to_owned(), clips: self.clips() }
    }
}

fn narrow(affine: DAffine3) -> Affine3A {
    Affine3A::from_cols_array(&affine.to_cols_array().map(|x| x as f32))
}
