//! An avatar as a scene, for files of interchange formats: the way back from `import`.

mod baked;
mod clips;

use crate::import::wrap_of;
use crate::textures::decode;
use crate::{Pack, Part, PartImages, Textures};
use avatar_exchange::{
    AlphaMode, Finding, Material, Node, Note, RawScene, Scene, SceneImage, ScenePart, Skin, TextureRef,
    ToonMaterial, Transform, Trs, UvSet,
};
use avatar_look::{Alpha, Lighting, Standard};
use avatar_mesh::{Mesh, PartKind, Shape, Skinning, Winding};
use glam::{Affine3A, DAffine3, DQuat, Vec3};
use image::{ImageFormat, Rgba, RgbaImage};
use std::borrow::Cow;
use std::io::Cursor;

/// Makes a scene of an avatar.
///
/// * Each joint is a node with its bind matrix, and each part a node at the root with a mesh.
/// * All parts share one skin, the pack's palette; vertices of a rigid part have all their weight on its one
///   bone. So no vertex is moved into another space and rounded there: a reader that does as glTF 2.0 says
///   has the avatar's own numbers.
/// * Shapes are morph targets, their weights at rest what the controls' defaults make of them; of the
///   drivers of [`Pack::sliders`] that is all that is left.
/// * Each mixture is one more target of its name, behind the shapes of each part that it moves: all that it
///   does at 1, by bones, shapes and correctives. So programs that know names of shapes alone have all
///   52 of ARKit and the visemes. Joints and shapes stay as well, so that a face is posed by either.
/// * Each pose is a clip with one key at 0 s: where its controls and the couplings take joints and shapes
///   from the defaults. Mixtures act by joints and shapes there, and their own targets rest.
/// * Parts whose triangles contradict their normals are turned around, as for drawing.
/// * Looks are glTF's metallic-roughness model: colour, relief, occlusion, roughness from gloss. Textures are
///   PNG.
///
/// Notes of the scene say what of the avatar it does not represent. The scene of a pack that was loaded is
/// valid: [`avatar_exchange::Scene::from_raw`] takes it.
pub fn export(pack: &Pack, textures: &Textures) -> RawScene {
    export_as(pack, textures, None)
}

/// A morph target that [`export_targets`] makes.
#[derive(Clone, Debug, PartialEq)]
pub struct ExportTarget {
    /// The target's name in the file.
    pub name: String,
    /// The controls of the face that it shows at 1.
    pub values: Vec<f32>,
}

/// As [`export`], with these morph targets in place of the pack's own shapes and mixtures: each goes from the
/// face at rest to the one of its values, by bones, shapes and correctives. Targets that move nothing are not
/// in the file. Poses are left out: they are made of the pack's own shapes.
pub fn export_targets(pack: &Pack, textures: &Textures, targets: &[ExportTarget]) -> RawScene {
    export_as(pack, textures, Some(targets))
}

fn export_as(pack: &Pack, textures: &Textures, asked: Option<&[ExportTarget]>) -> RawScene {
    let mut scene = RawScene { nodes: joints(pack), ..RawScene::default() };
    let palette = pack.palette();
    // A skeleton alone moves no part, and a skin without joints means nothing.
    if !palette.is_empty() {
        let joints = palette.iter().map(|bone| bone.joint.index()).collect();
        let inverse_binds = palette.iter().map(|bone| bone.joint_from_mesh).collect();
        scene.skins.push(Skin { name: "palette".to_owned(), joints, inverse_binds });
    }
    let mut images = Images::default();
    let rest = clips::posed(pack, &pack.controls().defaults()).map_or_else(Vec::new, |(_, weights)| weights);
    let mut shapes_of_nodes = Vec::new();
    let mut baked = match asked {
        Some(targets) => baked::asked(pack, targets, baked::MOST_BYTES),
        None => baked::baked(pack, baked::MOST_BYTES),
    };
    for (number, part) in pack.parts().iter().enumerate() {
        let node = scene.nodes.len();
        let targets = baked.of_parts.get_mut(number).map(std::mem::take).unwrap_or_default();
        let shapes = if asked.is_some() { 0..0 } else { part.shapes() };
        let mut weights = rest.get(shapes.clone()).unwrap_or_default().to_vec();
        let resting = vec![0.0; targets.len()];
        weights.extend(&resting);
        let local = place(pack, part);
        scene.nodes.push(Node { name: part.name.clone(), weights, local, ..Node::default() });
        let mut mesh = mesh(pack, part, targets);
        if asked.is_some() {
            mesh.shapes.drain(..part.shapes().len());
        }
        let material = material(pack, textures, number, &mut images, &mut scene.notes);
        scene.parts.push(ScenePart {
            material: Some(scene.materials.len()),
            ..ScenePart::skinned(&part.name, node, mesh, 0)
        });
        scene.materials.push(material);
        shapes_of_nodes.push(clips::ShapesOfNode { node, shapes, resting });
    }
    scene.images = images.encoded;
    if asked.is_none() {
        scene.clips = clips::clips(pack, &scene.nodes, &shapes_of_nodes, &mut scene.notes);
    }
    let mut note = |text: &str| scene.notes.push(Note::new("the avatar", Finding::left_out(text)));
    if !baked.left_out.is_empty() {
        let (count, first) = (baked.left_out.len(), &baked.left_out[0]);
        note(&format!("{count} targets are left out, {first:?} first: together they are too large"));
    }
    note("controls, couplings and times of poses are left out");
    if asked.is_some() {
        note("the pack's own shapes and its poses are left out: the targets are those that were asked for");
    } else if pack.sliders().is_some() {
        note("sliders are left out: in-between and corrective shapes have weights of their own");
    }
    if pack.hair().is_some() {
        note("hair is left out");
    }
    scene
}

/// A node per joint, in the order of the rig, so that positions are the same.
fn joints(pack: &Pack) -> Vec<Node> {
    let rig = pack.rig();
    let joint = |((name, parent), bind): ((&String, &Option<rig_core::JointId>), &Affine3A)| Node {
        name: name.clone(),
        parent: parent.map(|parent| parent.index()),
        local: Transform::Trs(trs(widen(*bind))),
        weights: Vec::new(),
    };
    rig.names().iter().zip(rig.parents()).zip(rig.parent_from_joint()).map(joint).collect()
}

fn widen(affine: Affine3A) -> DAffine3 {
    DAffine3::from_cols_array(&affine.to_cols_array().map(f64::from))
}

/// The nearest product of translation, rotation and scale: clips move nothing else. Bind matrices are rigid
/// to within the digits that their files print.
fn trs(parent_from_joint: DAffine3) -> Trs {
    let (scale, rotation, translation) = parent_from_joint.to_scale_rotation_translation();
    let rotation =
        Some(rotation.normalize()).filter(|rotation| rotation.is_finite()).unwrap_or(DQuat::IDENTITY);
    Trs {
        translation: translation.as_vec3(),
        rotation: rotation.as_quat(),
        scale: unit_scale(scale.as_vec3()),
    }
}

/// The scale without what is only the rounding of a rotation.
fn unit_scale(scale: Vec3) -> Vec3 {
    if scale.abs_diff_eq(Vec3::ONE, 1e-6) { Vec3::ONE } else { scale }
}

/// The node of a part moves nothing, since joints do. Programs that take the winding of triangles from it, as
/// glTF 2.0 says in section 3.7.4, are to find a mirror where the joints are one.
fn place(pack: &Pack, part: &Part) -> Transform {
    let mirrors = |bone: usize| {
        let bone = pack.palette().get(bone)?;
        let world_from_joint = pack.rig().world_from_bind().get(bone.joint.index())?;
        Some(avatar_mesh::mirrors(&(*world_from_joint * bone.joint_from_mesh)))
    };
    let is_mirrored = match (part.bone, &part.mesh.skinning) {
        (Some(bone), _) => mirrors(bone) == Some(true),
        (None, Some(skinning)) => {
            let used = skinning.used_bones();
            !used.is_empty() && used.into_iter().all(|bone| mirrors(bone.into()) == Some(true))
        }
        (None, None) => false,
    };
    let scale = if is_mirrored { Vec3::new(-1.0, 1.0, 1.0) } else { Vec3::ONE };
    Transform::Trs(Trs { scale, ..Trs::default() })
}

/// The mesh as a scene has it: its shapes with the names that they have in the pack, further targets behind
/// them, and triangles that agree with their normals.
fn mesh(pack: &Pack, part: &Part, targets: Vec<Shape>) -> Mesh {
    let mut mesh = part.mesh.clone();
    for (shape, name) in mesh.shapes.iter_mut().zip(&pack.shapes()[part.shapes()]) {
        shape.name.clone_from(name);
    }
    mesh.shapes.extend(targets);
    if Winding::of(&mesh).is_inside_out() {
        mesh.triangles.iter_mut().for_each(|[_, b, c]| std::mem::swap(b, c));
    }
    if let Some(bone) = part.bone {
        // A palette has no more bones than their positions have bits.
        let bone = u16::try_from(bone).unwrap_or(u16::MAX);
        let vertices = mesh.positions.len();
        mesh.skinning = Some(Skinning {
            bones: vec![[bone, 0, 0, 0]; vertices],
            weights: vec![[1.0, 0.0, 0.0, 0.0]; vertices],
            ..Skinning::default()
        });
    }
    mesh
}

fn material<'a>(
    pack: &Pack,
    textures: &'a Textures,
    number: usize,
    images: &mut Images<'a>,
    notes: &mut Vec<Note>,
) -> Material {
    let part = &pack.parts()[number];
    let from = pack.material(number);
    let pictures = textures.of_part(number, part.kind);
    let mut take = |picture: Option<&'a RgbaImage>, what: &str, change: Option<Change>| {
        let name = format!("{} {what}", part.name);
        images.take(picture?, &name, change, notes)
    };
    if let Some(standard) = from.standard {
        return of_standard(&part.name, &from, &standard, pictures, |picture, what| {
            take(picture, what, None)
        });
    }
    let color = take(pictures.color, "color", None);
    let roughness = Change::Roughness { matte: from.roughness_matte, glossy: from.roughness_glossy };
    let rough = take(pictures.gloss, "roughness", Some(roughness));
    let [r, g, b] = if color.is_some() { [1.0; 3] } else { from.color };
    let is_clear = part.kind == PartKind::Cornea;
    Material {
        name: part.name.clone(),
        base_color: [r, g, b, if is_clear { from.opacity } else { 1.0 }],
        base_color_texture: color.map(TextureRef::from),
        metallic: 0.0,
        roughness: if rough.is_some() { 1.0 } else { (from.roughness_matte + from.roughness_glossy) / 2.0 },
        metallic_roughness_texture: rough.map(TextureRef::from),
        normal_texture: take(pictures.normal, "normals", None).map(TextureRef::from),
        normal_scale: if pictures.normal.is_some() { from.normal_strength } else { 1.0 },
        occlusion_texture: take(pictures.occlusion, "occlusion", None).map(TextureRef::from),
        alpha_mode: if is_clear { AlphaMode::Blend } else { AlphaMode::Opaque },
        ..Material::default()
    }
}

/// The way back from an interchange file.
fn of_standard<'a>(
    name: &str,
    from: &avatar_look::Material,
    standard: &Standard,
    pictures: PartImages<'a>,
    mut take: impl FnMut(Option<&'a RgbaImage>, &str) -> Option<usize>,
) -> Material {
    let mut texture = |picture, what, is_second, wrap: [avatar_look::Wrap; 2]| {
        let uvs = if is_second { UvSet::Second } else { UvSet::First };
        take(picture, what).map(|image| TextureRef { image, uvs, wrap: wrap.map(wrap_of) })
    };
    let (second, wraps) = (standard.second_uvs, pictures.wraps);
    let base_color_texture = texture(pictures.color, "color", second.color, wraps.color);
    let shade_texture = texture(pictures.shade, "shade", second.shade, wraps.shade);
    let (alpha_mode, alpha_cutoff) = match standard.alpha {
        Alpha::Opaque => (AlphaMode::Opaque, 0.5),
        Alpha::Mask(cutoff) => (AlphaMode::Mask, cutoff),
        Alpha::Blend => (AlphaMode::Blend, 0.5),
    };
    Material {
        name: name.to_owned(),
        base_color: standard.base_color,
        base_color_texture,
        metallic: standard.metallic,
        roughness: standard.roughness,
        metallic_roughness_texture: texture(
            pictures.metallic_roughness,
            "roughness",
            second.metallic_roughness,
            wraps.metallic_roughness,
        ),
        normal_texture: texture(pictures.normal, "normals", second.normal, wraps.normal),
        normal_scale: if pictures.normal.is_some() { from.normal_strength } else { 1.0 },
        occlusion_texture: texture(pictures.occlusion, "occlusion", second.occlusion, wraps.occlusion),
        occlusion_strength: standard.occlusion_strength,
        emissive: standard.emissive,
        emissive_texture: texture(pictures.emissive, "emission", second.emissive, wraps.emissive),
        alpha_mode,
        alpha_cutoff,
        double_sided: standard.is_double_sided,
        is_unlit: standard.lighting == Lighting::Unlit,
        toon: match standard.lighting {
            Lighting::Lit | Lighting::Unlit => None,
            Lighting::Cartoon(cartoon) => Some(ToonMaterial {
                shade_color: cartoon.shade_color,
                shade_texture,
                shading_shift: cartoon.shading_shift,
                shading_toony: cartoon.shading_toony,
                outline_width: cartoon.outline_width,
                outline_color: cartoon.outline_color,
            }),
        },
    }
}

/// How a picture's meaning differs from glTF's.
#[derive(Clone, Copy, PartialEq)]
enum Change {
    /// Gloss becomes roughness, in green.
    Roughness { matte: f32, glossy: f32 },
}

/// Encoded pictures, each one once.
#[derive(Default)]
struct Images<'a> {
    sources: Vec<(&'a RgbaImage, Option<Change>)>,
    encoded: Vec<SceneImage>,
}

impl<'a> Images<'a> {
    fn take(
        &mut self,
        picture: &'a RgbaImage,
        name: &str,
        change: Option<Change>,
        notes: &mut Vec<Note>,
    ) -> Option<usize> {
        let same =
            |source: &(&RgbaImage, Option<Change>)| std::ptr::eq(source.0, picture) && source.1 == change;
        if let Some(known) = self.sources.iter().position(same) {
            return Some(known);
        }
        let mut bytes = Cursor::new(Vec::new());
        let written = match change {
            None => picture.write_to(&mut bytes, ImageFormat::Png),
            Some(Change::Roughness { matte, glossy }) => {
                let mut changed = picture.clone();
                for Rgba([r, g, b, a]) in changed.pixels_mut() {
                    let gloss = f32::from(*r) / 255.0;
                    let rough = (matte + (glossy - matte) * gloss).clamp(0.0, 1.0);
                    [*r, *g, *b, *a] = [255, (255.0 * rough).round() as u8, 0, 255];
                }
                changed.write_to(&mut bytes, ImageFormat::Png)
            }
        };
        if let Err(error) = written {
            let text = format!("expected a picture that PNG can hold, found: {error}");
            notes.push(Note::new(name, Finding::Missing(text)));
            return None;
        }
        self.sources.push((picture, change));
        let mime = "image/png".to_owned();
        self.encoded.push(SceneImage { name: name.to_owned(), mime, bytes: bytes.into_inner() });
        Some(self.encoded.len() - 1)
    }
}

/// A scene whose pictures are all PNG or JPEG, the formats that glTF knows (2.0, section 3.8.2): TGA and BMP
/// become PNG. What cannot be decoded stays as it is. Borrowed where there is nothing to do.
pub fn portable_pictures(scene: &Scene) -> Cow<'_, Scene> {
    let is_foreign = |image: &SceneImage| {
        let begins = |start: &[u8]| image.bytes.starts_with(start);
        !image.bytes.is_empty() && !begins(b"\x89PNG\r\n\x1a\n") && !begins(b"\xff\xd8\xff")
    };
    if !scene.images.iter().any(is_foreign) {
        return Cow::Borrowed(scene);
    }
    let portable = |image: &SceneImage| {
        let decoded = if is_foreign(image) { decode(&image.name, &image.bytes).ok() } else { None };
        let mut png = Cursor::new(Vec::new());
        match decoded.map(|picture| picture.write_to(&mut png, ImageFormat::Png)) {
            Some(Ok(())) => {
                let mime = "image/png".to_owned();
                SceneImage { name: image.name.clone(), mime, bytes: png.into_inner() }
            }
            _ => image.clone(),
        }
    };
    let images = scene.images.iter().map(portable).collect();
    scene.with_images(images).map_or(Cow::Borrowed(scene), Cow::Owned)
}
