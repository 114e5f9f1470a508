mod check;

use crate::look_rule::LookRule;
use crate::{ContentsError, FurtherShapes, Identity, SceneMotion, Sliders, Springs, Warning};
use avatar_groom::Hair;
use avatar_look::{Material, Materials};
use avatar_mesh::{Bounds, Mesh, PartKind};
use check::{check, check_clips, check_poses, check_springs};
use glam::Affine3A;
use pose_anim::{Binding, ClipSet, ControlTable, PoseSet};
use rig_core::{JointId, Rig};
use std::ops::Range;

/// A face, ready to be posed: everything of a pack but its textures.
///
/// What it holds agrees: every index of a joint, bone, shape, slider or control that occurs in it is in
/// range. Hence its fields are private; [`Pack::into_contents`] takes it apart and [`Pack::new`] puts it
/// together again.
#[derive(Clone, Debug)]
pub struct Pack {
    contents: PackContents,
    binding: Binding,
    /// Per bone of the palette whether `X` is that of its joint: meshes in world space, as in the raw format.
    is_of_joint: Vec<bool>,
}

/// What a [`Pack`] is made of: to be filled in, then checked by [`Pack::new`].
#[derive(Clone, Debug)]
pub struct PackContents {
    /// The joints.
    pub rig: Rig,
    /// The parts; of a pack in the raw format in the order of [`avatar_mesh::FACE_PARTS`].
    pub parts: Vec<Part>,
    /// What each bone index of the meshes means; in the raw format in the order of
    /// [`avatar_mesh::FACE_BONES`].
    pub palette: Vec<PaletteBone>,
    /// Names of the blend shapes, in the order of the blend weights.
    pub shapes: Vec<String>,
    /// What moves the shapes where they do not have a weight each of their own; packs in the raw format have
    /// none without `shapes.toml`.
    pub sliders: Option<Sliders>,
    /// What `shapes.toml` says; `None` without that file. [`Pack::load`] makes shapes, sliders and controls
    /// of it.
    pub further_shapes: Option<FurtherShapes>,
    /// What `identity.toml` says; `None` without that file, and in a pack that is another person already.
    pub identity: Option<Identity>,
    /// What swings by itself, and what turns with it.
    pub springs: Springs,
    /// The controls: of joints, and of sliders, or shapes where there are no sliders.
    pub controls: ControlTable,
    /// The poses, as values of the controls.
    pub poses: PoseSet,
    /// Clips, as tracks of the controls.
    pub clips: ClipSet,
    /// The looks of those parts that have none of their own.
    pub materials: Materials,
    /// The hair; `None` where the pack does not say which.
    pub hair: Option<Hair>,
    /// The clips of a file of an interchange format, of whole joints; packs in the raw format have none.
    pub motion: Option<SceneMotion>,
    /// How the eyes look at things, where the file says it; else they turn to them as far as their controls
    /// go.
    pub look_rule: Option<LookRule>,
    /// Where an avatar is more than a face: the box around its head, or around what its shapes move, at bind
    /// pose in world space.
    pub face: Option<Bounds>,
    /// Where a pack in the raw format has shoulders: the box around its head at bind pose.
    pub head: Option<Bounds>,
    /// What was mended while loading.
    pub warnings: Vec<Warning>,
}

/// What a bone index of a mesh means: `X = T · joint_from_mesh`, with `T` the joint's world matrix.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PaletteBone {
    /// The joint.
    pub joint: JointId,
    /// From the space that the meshes' vertices are in to the joint's at bind pose: `W⁻¹` where meshes are in
    /// world space.
    pub joint_from_mesh: Affine3A,
}

/// One part of a face.
#[derive(Clone, Debug)]
pub struct Part {
    /// Name for people and for the command line.
    pub name: String,
    /// How it is drawn.
    pub kind: PartKind,
    /// Its valid mesh, with the shapes that are its own.
    pub mesh: Mesh,
    /// The place of its first shape in [`Pack::shapes`]; the others follow in order. Parts may share shapes.
    pub first_shape: usize,
    /// Bytes that it was read from.
    pub bytes: usize,
    /// For a rigid part the bone that it follows, as an index into [`Pack::palette`].
    pub bone: Option<usize>,
    /// Its looks, where the file that it comes from says them; else [`Pack::materials`] does.
    pub material: Option<Material>,
    /// The box around it at bind pose, in world space.
    pub bounds: Option<Bounds>,
}

impl Part {
    /// The places of its shapes in [`Pack::shapes`], and so of their weights in those of the face.
    pub fn shapes(&self) -> Range<usize> {
        self.first_shape..self.first_shape.saturating_add(self.mesh.shapes.len())
    }
}

impl Pack {
    /// Puts a pack together, and binds its controls to its joints and to its sliders, or shapes where it has
    /// no sliders.
    ///
    /// # Errors
    /// The first contradiction: an index out of range, a list of the wrong length, a control of something
    /// that is missing.
    pub fn new(contents: PackContents) -> Result<Self, ContentsError> {
        check(&contents)?;
        check_poses(&contents.poses, &contents.controls)?;
        check_clips(&contents.clips, &contents.controls)?;
        let driven = contents.sliders.as_ref().map_or(&contents.shapes, |sliders| &sliders.names);
        let driven: Vec<&str> = driven.iter().map(String::as_str).collect();
        let binding = contents.controls.bind(&contents.rig, &driven)?;
        check_springs(&contents.springs, &contents.rig)?;
        let is_of_joint = |bone: &PaletteBone| {
            contents.rig.bind_from_world().get(bone.joint.index()) == Some(&bone.joint_from_mesh)
        };
        let is_of_joint = contents.palette.iter().map(is_of_joint).collect();
        Ok(Self { contents, binding, is_of_joint })
    }

    /// Takes the pack apart, to change something of it and make another pack.
    pub fn into_contents(self) -> PackContents {
        self.contents
    }

    /// The joints.
    pub fn rig(&self) -> &Rig {
        &self.contents.rig
    }

    /// The parts; of a pack in the raw format in the order of [`avatar_mesh::FACE_PARTS`].
    pub fn parts(&self) -> &[Part] {
        &self.contents.parts
    }

    /// What each bone index of the meshes means; in the raw format in the order of
    /// [`avatar_mesh::FACE_BONES`].
    pub fn palette(&self) -> &[PaletteBone] {
        &self.contents.palette
    }

    /// The bones, each with whether its `X` is that of its joint.
    pub(crate) fn bones(&self) -> impl Iterator<Item = (&PaletteBone, bool)> {
        self.palette().iter().zip(self.is_of_joint.iter().copied())
    }

    /// Names of the blend shapes, in the order of the blend weights.
    pub fn shapes(&self) -> &[String] {
        &self.contents.shapes
    }

    /// What moves the shapes where they do not have a weight each of their own; packs in the raw format have
    /// none without `shapes.toml`.
    pub fn sliders(&self) -> Option<&Sliders> {
        self.contents.sliders.as_ref()
    }

    /// What `shapes.toml` says about shapes and mixtures; `None` without that file.
    pub fn further_shapes(&self) -> Option<&FurtherShapes> {
        self.contents.further_shapes.as_ref()
    }

    /// The axes that make other people of the face, from `identity.toml`; `None` without that file.
    pub fn identity(&self) -> Option<&Identity> {
        self.contents.identity.as_ref()
    }

    /// What swings by itself, from `springs.toml` or an imported avatar's file.
    pub fn springs(&self) -> &Springs {
        &self.contents.springs
    }

    /// Replaces what swings by itself. States that were made before ([`crate::FaceState`]) go on as they did.
    ///
    /// # Errors
    /// Springs of joints that the pack does not have, or that contradict each other; the springs then stay as
    /// they were.
    pub fn set_springs(&mut self, springs: Springs) -> Result<(), ContentsError> {
        check_springs(&springs, &self.contents.rig)?;
        self.contents.springs = springs;
        Ok(())
    }

    /// The controls, from `controls.toml` or the default table.
    pub fn controls(&self) -> &ControlTable {
        &self.contents.controls
    }

    /// The controls, bound to this rig and to these sliders, or shapes where there are no sliders.
    pub fn binding(&self) -> &Binding {
        &self.binding
    }

    /// The poses, from `poses.toml` or the default set.
    pub fn poses(&self) -> &PoseSet {
        &self.contents.poses
    }

    /// Replaces the poses.
    ///
    /// # Errors
    /// A pose of a control that the pack does not have; the poses then stay as they were.
    pub fn set_poses(&mut self, poses: PoseSet) -> Result<(), ContentsError> {
        check_poses(&poses, &self.contents.controls)?;
        self.contents.poses = poses;
        Ok(())
    }

    /// Clips of controls, from `clips.toml`.
    pub fn clips(&self) -> &ClipSet {
        &self.contents.clips
    }

    /// Replaces the clips of controls.
    ///
    /// # Errors
    /// A track of a control that the pack does not have; the clips then stay as they were.
    pub fn set_clips(&mut self, clips: ClipSet) -> Result<(), ContentsError> {
        check_clips(&clips, &self.contents.controls)?;
        self.contents.clips = clips;
        Ok(())
    }

    /// The looks of those parts that have none of their own, from `materials.toml` or the defaults.
    pub fn materials(&self) -> &Materials {
        &self.contents.materials
    }

    /// Replaces the looks of those parts that have none of their own.
    pub fn set_materials(&mut self, materials: Materials) {
        self.contents.materials = materials;
    }

    /// The hair, from `hair.toml`; `None` without that file.
    pub fn hair(&self) -> Option<&Hair> {
        self.contents.hair.as_ref()
    }

    /// Replaces the hair.
    pub fn set_hair(&mut self, hair: Option<Hair>) {
        self.contents.hair = hair;
    }

    /// The clips of a file of an interchange format, of whole joints; packs in the raw format have none.
    pub fn motion(&self) -> Option<&SceneMotion> {
        self.contents.motion.as_ref()
    }

    /// How the eyes look at things, where the file says it.
    pub fn look_rule(&self) -> Option<&LookRule> {
        self.contents.look_rule.as_ref()
    }

    /// Where an avatar is more than a face: the box around its head, or around what its shapes move, at bind
    /// pose in world space.
    pub fn face(&self) -> Option<Bounds> {
        self.contents.face
    }

    /// The box around the head at bind pose, where a pack in the raw format has shoulders: the neck's joint
    /// alone moves those. Its height is the unit of lengths of materials and hair, as that of the skin is
    /// elsewhere.
    pub fn head(&self) -> Option<Bounds> {
        self.contents.head
    }

    /// What was mended while loading.
    pub fn warnings(&self) -> &[Warning] {
        &self.contents.warnings
    }

    /// Adds what was found after the pack was put together.
    #[cfg(feature = "vrm")]
    pub(crate) fn warn(&mut self, warning: Warning) {
        self.contents.warnings.push(warning);
    }

    /// Sets the boxes around the parts and the face, which are measured in a pack that is otherwise complete.
    pub(crate) fn set_measures(&mut self, parts: Vec<Option<Bounds>>, face: Option<Bounds>) {
        for (part, bounds) in self.contents.parts.iter_mut().zip(parts) {
            part.bounds = bounds;
        }
        self.contents.face = face;
    }

    /// Replaces meshes, where there is another, by meshes with the same shapes and bones.
    pub(crate) fn set_meshes(&mut self, meshes: impl Iterator<Item = Option<Mesh>>) {
        for (part, mesh) in self.contents.parts.iter_mut().zip(meshes) {
            part.mesh = mesh.unwrap_or_else(|| std::mem::take(&mut part.mesh));
        }
    }

    /// The part of this name.
    pub fn part(&self, name: &str) -> Option<&Part> {
        self.parts().iter().find(|part| part.name == name)
    }

    /// Whether a shape, by its place in [`Pack::shapes`], moves with controls that drive this name.
    pub fn follows(&self, shape: usize, driven: &str) -> bool {
        match self.sliders() {
            None => self.shapes().get(shape).is_some_and(|name| name == driven),
            Some(sliders) => {
                let followed = sliders.of_shapes.get(shape).map_or(&[][..], Vec::as_slice);
                followed.iter().any(|slider| sliders.names.get(*slider).is_some_and(|name| name == driven))
            }
        }
    }

    /// The looks of the part of this index; the default ones of skin where there is no such part.
    pub fn material(&self, part: usize) -> Material {
        match self.parts().get(part) {
            Some(part) => part.material.unwrap_or_else(|| self.materials().of(&part.name, part.kind)),
            None => Material::of(PartKind::Skin),
        }
    }

    /// The box around all parts at bind pose.
    pub fn bounds(&self) -> Option<Bounds> {
        self.parts().iter().filter_map(|part| part.bounds).reduce(Bounds::union)
    }
}
