//! Chains of joints that swing, and what they bump against: the extension `VRMC_springBone` 1.0,
//! <https://github.com/vrm-c/vrm-specification/tree/master/specification/VRMC_springBone-1.0>, and planes and
//! hollow colliders, `VRMC_springBone_extended_collider` 1.0. Here they are only read; nothing is moved.

use super::descent::Descent;
use super::note;
use super::place::Place;
use crate::scene::{Finding, ImportError, RawScene};
use glam::Vec3;

/// The name of the extension with planes and hollow colliders.
pub(super) const EXTENDED: &str = "VRMC_springBone_extended_collider";

/// Everything that swings.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Springs {
    /// The chains, in the file's order.
    pub chains: Vec<SpringChain>,
    /// What they bump against.
    pub colliders: Vec<SpringCollider>,
    /// Sets of colliders, which chains name.
    pub collider_groups: Vec<ColliderGroup>,
}

/// A chain of joints, of which each swings on the one before.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SpringChain {
    /// Its name; may be empty.
    pub name: String,
    /// Joints from the root on. Each one's node is below that of the joint before, and no node is in two
    /// chains.
    pub joints: Vec<SpringJoint>,
    /// Positions in [`Springs::collider_groups`].
    pub collider_groups: Vec<usize>,
    /// The node in whose space inertia counts; `None` for world space.
    pub center: Option<usize>,
    /// How far beyond the last joint the end of the chain lies, in metres. `None` in VRM 1.0, where the last
    /// joint is that end and has no other part in the motion.
    pub tail: Option<f32>,
}

/// A node that swings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpringJoint {
    /// The node.
    pub node: usize,
    /// Radius of what bumps against colliders, in metres, at the joint's end; not below 0.
    pub hit_radius: f32,
    /// How strongly it returns to rest; not below 0.
    pub stiffness: f32,
    /// Strength of the force along [`SpringJoint::gravity_dir`].
    pub gravity_power: f32,
    /// Where that force pulls, in world space: +Y up, the character looks along +Z.
    pub gravity_dir: Vec3,
    /// Share of the speed that is lost, 0…1.
    pub drag_force: f32,
}

impl SpringJoint {
    /// A joint with the standard's default values.
    pub fn at(node: usize) -> Self {
        Self {
            node,
            hit_radius: 0.0,
            stiffness: 1.0,
            gravity_power: 0.0,
            gravity_dir: Vec3::NEG_Y,
            drag_force: 0.5,
        }
    }
}

/// What joints bump against.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpringCollider {
    /// The node that it follows.
    pub node: usize,
    /// Its form.
    pub shape: ColliderShape,
}

/// Form of a collider, in the space of its node, in metres. Radii are not below 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ColliderShape {
    /// All points near a point.
    Sphere {
        /// The centre.
        offset: Vec3,
        /// The radius.
        radius: f32,
        /// Whether joints are kept inside of it instead of outside.
        inside: bool,
    },
    /// All points near a line.
    Capsule {
        /// One end of the line.
        offset: Vec3,
        /// Its other end.
        tail: Vec3,
        /// The radius.
        radius: f32,
        /// Whether joints are kept inside of it instead of outside.
        inside: bool,
    },
    /// Everything behind a plane.
    Plane {
        /// A point of the plane.
        offset: Vec3,
        /// Where its front looks; of about unit length.
        normal: Vec3,
    },
}

/// Colliders that are used together.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ColliderGroup {
    /// Its name; may be empty.
    pub name: String,
    /// Positions in [`Springs::colliders`].
    pub colliders: Vec<usize>,
}

/// Reads the extension of VRM 1.0.
pub(super) fn read(place: &Place<'_>, raw: &mut RawScene) -> Result<Springs, ImportError> {
    place.version_1("specVersion")?;
    let mut springs = Springs::default();
    for place in place.list("colliders")? {
        springs.colliders.push(collider(&place, raw)?);
    }
    for place in place.list("colliderGroups")? {
        let colliders = place.indices("colliders", "a collider", springs.colliders.len())?;
        springs.collider_groups.push(ColliderGroup { name: place.text("name")?, colliders });
    }
    let descent = Descent::of(&raw.nodes);
    let mut used = vec![false; raw.nodes.len()];
    for place in place.list("springs")? {
        let name = place.text("name")?;
        let collider_groups = place.indices("colliderGroups", "a group", springs.collider_groups.len())?;
        let center =
            place.get("center")?.map(|center| center.index("a node", raw.nodes.len())).transpose()?;
        let joints = place.list("joints")?;
        let joints: Vec<_> = joints.iter().map(|place| joint(place, raw)).collect::<Result<_, _>>()?;
        if let Some(why) = broken(&joints, &used, &descent) {
            note(raw, place.path(), Finding::LeftOut(format!("{why}: the spring is left out")));
            continue;
        }
        joints.iter().for_each(|joint| used[joint.node] = true);
        springs.chains.push(SpringChain { name, joints, collider_groups, center, tail: None });
    }
    Ok(springs)
}

fn collider(place: &Place<'_>, raw: &mut RawScene) -> Result<SpringCollider, ImportError> {
    let node = place.need("node")?.index("a node", raw.nodes.len())?;
    let extended = extended(place, raw)?;
    let is_extended = extended.is_some();
    let shape = extended.as_ref().unwrap_or(place).need("shape")?;
    let inside = |form: &Place<'_>| if is_extended { form.flag("inside") } else { Ok(false) };
    let plane = if is_extended { shape.get("plane")? } else { None };
    let shape = match (shape.get("sphere")?, shape.get("capsule")?, plane) {
        (Some(sphere), None, None) => ColliderShape::Sphere {
            offset: sphere.vec3_or("offset", Vec3::ZERO)?,
            radius: sphere.clamped("radius", 0.0, 0.0..=f32::MAX, raw)?,
            inside: inside(&sphere)?,
        },
        (None, Some(capsule), None) => ColliderShape::Capsule {
            offset: capsule.vec3_or("offset", Vec3::ZERO)?,
            tail: capsule.vec3_or("tail", Vec3::ZERO)?,
            radius: capsule.clamped("radius", 0.0, 0.0..=f32::MAX, raw)?,
            inside: inside(&capsule)?,
        },
        (None, None, Some(plane)) => ColliderShape::Plane {
            offset: plane.vec3_or("offset", Vec3::ZERO)?,
            normal: plane.vec3_or("normal", Vec3::Z)?,
        },
        _ if is_extended => return Err(shape.wrong("one of a sphere, a capsule and a plane")),
        _ => return Err(shape.wrong("either a sphere or a capsule")),
    };
    Ok(SpringCollider { node, shape })
}

/// The extension of a collider. As the standard has it, who does not know its version takes the collider's
/// other form.
fn extended<'v>(place: &Place<'v>, raw: &mut RawScene) -> Result<Option<Place<'v>>, ImportError> {
    let Some(extensions) = place.get("extensions")? else { return Ok(None) };
    let Some(extended) = extensions.get(EXTENDED)? else { return Ok(None) };
    match extended.version_1("specVersion") {
        Ok(()) => Ok(Some(extended)),
        Err(error) => {
            let text = format!("expected {}, found {}: its other form is taken", error.expected, error.found);
            note(raw, place.path(), Finding::LeftOut(text));
            Ok(None)
        }
    }
}

fn joint(place: &Place<'_>, raw: &mut RawScene) -> Result<SpringJoint, ImportError> {
    let joint = SpringJoint::at(place.need("node")?.index("a node", raw.nodes.len())?);
    Ok(SpringJoint {
        hit_radius: place.clamped("hitRadius", joint.hit_radius, 0.0..=f32::MAX, raw)?,
        stiffness: place.clamped("stiffness", joint.stiffness, 0.0..=f32::MAX, raw)?,
        gravity_power: place.float_or("gravityPower", joint.gravity_power)?,
        gravity_dir: place.vec3_or("gravityDir", joint.gravity_dir)?,
        drag_force: place.clamped("dragForce", joint.drag_force, 0.0..=1.0, raw)?,
        ..joint
    })
}

/// What keeps joints from being a chain.
fn broken(joints: &[SpringJoint], used: &[bool], descent: &Descent) -> Option<String> {
    if let Some(joint) = joints.iter().find(|joint| used[joint.node]) {
        return Some(format!("node {} is in another spring already", joint.node));
    }
    let nodes = joints.windows(2).map(|pair| [pair[0].node, pair[1].node]);
    let mut apart = nodes.filter(|[above, below]| !descent.is_below(*above, *below));
    apart.next().map(|[above, below]| format!("node {below} is not below node {above}"))
}
