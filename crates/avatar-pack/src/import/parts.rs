use super::{ImportFailure, ImportReport};
use crate::textures::{OwnImages, decode};
use crate::unique::unique_names;
use crate::{Part, Textures, Warning};
use avatar_exchange::{AlphaMode, Scene, ScenePart, TextureRef};
use avatar_look::Material;
use avatar_mesh::{Mesh, PartKind, Shape};
use image::RgbaImage;
use std::collections::HashMap;

/// The shapes of all nodes in one list.
pub(super) struct ShapeNames {
    /// Names; those of different nodes may be the same.
    pub(super) names: Vec<String>,
    /// Their weights at rest.
    pub(super) weights: Vec<f32>,
    /// Per node where its shapes begin.
    pub(super) first: Vec<usize>,
}

impl ShapeNames {
    pub(super) fn of(scene: &Scene) -> Self {
        // Per node the shapes of that of its parts which has the most.
        let mut of_nodes: Vec<&[Shape]> = vec![&[]; scene.nodes.len()];
        for part in &scene.parts {
            if let Some(of_node) = of_nodes.get_mut(part.node)
                && part.mesh.shapes.len() >= of_node.len()
            {
                *of_node = &part.mesh.shapes;
            }
        }
        let mut all = Self { names: Vec::new(), weights: Vec::new(), first: Vec::new() };
        for (node, named) in scene.nodes.iter().zip(of_nodes) {
            all.first.push(all.names.len());
            all.names.extend(unique_names(named.iter().map(|shape| shape.name.as_str()), "shape"));
            all.weights.extend((0..named.len()).map(|k| node.weights.get(k).copied().unwrap_or(0.0)));
        }
        all
    }

    /// The place of a shape of a node in the common list, where a part shows it.
    pub(super) fn place(&self, node: usize, shape: usize) -> Option<usize> {
        let first = *self.first.get(node)?;
        let end = self.first.get(node + 1).copied().unwrap_or(self.names.len());
        Some(first + shape).filter(|place| *place < end)
    }
}

/// The parts, which know the places of their shapes in the common list, and their pictures.
pub(super) fn parts(
    scene: &Scene,
    shapes: &ShapeNames,
    report: &mut ImportReport,
) -> Result<(Vec<Part>, Textures), ImportFailure> {
    let names = unique_names(scene.parts.iter().map(|part| part_name(scene, part)), "part");
    let mut images = Images::default();
    let parts = (scene.parts.iter().zip(names))
        .map(|(part, name)| {
            let kind = kind_of(scene, part, &name);
            let material = images.take(scene, part, kind, &name, report);
            let bone = match part.skin {
                Some(_) => None,
                None => scene.palette().rigid.get(part.node).copied().flatten(),
            };
            let mut mesh = part.mesh.clone();
            // Shapes that move positions only get the normals of the moved surface.
            mesh.add_shape_normals();
            to_palette(scene, part, &mut mesh)?;
            let first_shape = shapes.first.get(part.node).copied().unwrap_or(0);
            let bytes = mesh.positions.len() * 32 + mesh.triangles.len() * 12;
            Ok(Part { name, kind, mesh, first_shape, bytes, bone, material: Some(material), bounds: None })
        })
        .collect::<Result<Vec<Part>, ImportFailure>>()?;
    let textures = images.decoded(scene);
    Ok((parts, textures))
}

/// Bones of a scene's part are joints of its skin; those of a pack's part are entries of the palette, in
/// which the joints of all skins follow each other.
fn to_palette(scene: &Scene, part: &ScenePart, mesh: &mut Mesh) -> Result<(), ImportFailure> {
    let (Some(skin), Some(skinning)) = (part.skin, &mut mesh.skinning) else { return Ok(()) };
    let palette = scene.palette();
    let first = palette.skins.get(skin).copied().unwrap_or(0);
    for bone in skinning.bones.iter_mut().chain(&mut skinning.more_bones).flatten() {
        let place = first + usize::from(*bone);
        *bone = u16::try_from(place).map_err(|_| ImportFailure::Joints { found: palette.entries.len() })?;
    }
    Ok(())
}

fn part_name<'a>(scene: &'a Scene, part: &'a ScenePart) -> &'a str {
    let of_node = || scene.nodes.get(part.node).map_or("", |node| node.name.as_str());
    if part.name.trim().is_empty() { of_node() } else { &part.name }
}

/// How a part is drawn, guessed from the names of part, node and material.
fn kind_of(scene: &Scene, part: &ScenePart, name: &str) -> PartKind {
    let material = part.material.and_then(|material| scene.materials.get(material));
    let texts = [name, material.map_or("", |material| &material.name)].map(str::to_lowercase);
    let says = |words: &[&str]| texts.iter().any(|text| words.iter().any(|word| text.contains(word)));
    let is_blended = material.is_some_and(|material| material.alpha_mode == AlphaMode::Blend);
    if says(&["cornea", "eyewet", "eye_wet", "eyetransp"]) && is_blended {
        return PartKind::Cornea;
    }
    let other =
        ["hair", "lash", "brow", "tear", "occlusion", "cloth", "eye", "teeth", "tooth", "tongue", "gum"];
    let is_metal = material.is_some_and(|m| m.metallic > 0.5 && m.metallic_roughness_texture.is_none());
    match says(&["skin", "face", "head", "body"]) && !says(&other) && !is_metal {
        true => PartKind::Skin,
        // Also for all that is no part of a face: opaque, seen from both sides.
        false => PartKind::Surface,
    }
}

#[derive(Default)]
struct Images {
    own: OwnImages,
    /// Which picture of the scene each of `own.images` is, and the colour that it is multiplied by.
    sources: Vec<(usize, [f32; 4])>,
    /// Their places, by picture and bits of the colour.
    places: HashMap<(usize, [u32; 4]), usize>,
}

impl Images {
    /// The looks of a part, noting its pictures.
    fn take(
        &mut self,
        scene: &Scene,
        part: &ScenePart,
        kind: PartKind,
        name: &str,
        report: &mut ImportReport,
    ) -> Material {
        // Not white, on which bright light would show no relief.
        let fallback = avatar_exchange::Material {
            metallic: 0.0,
            base_color: [0.6, 0.6, 0.6, 1.0],
            ..Default::default()
        };
        let from = part.material.and_then(|material| scene.materials.get(material)).unwrap_or(&fallback);
        let [r, g, b, alpha] = from.base_color;
        let mut place =
            |texture: Option<TextureRef>, factor| texture.map(|texture| self.place(texture.image, factor));
        let color = place(from.base_color_texture, [r, g, b, 1.0]);
        let normal = place(from.normal_texture, [1.0; 4]);
        let occlusion = place(from.occlusion_texture, [1.0; 4]);
        self.own.color.push(color);
        self.own.normal.push(normal);
        self.own.occlusion.push(occlusion);
        let mut note = |text: &str| report.notes.push(format!("part {name:?}: {text}"));
        if from.metallic > 0.5 && from.metallic_roughness_texture.is_none() {
            note("a metal is drawn as a glossy surface of its colour");
        }
        if kind != PartKind::Cornea && from.alpha_mode == AlphaMode::Blend && alpha < 0.99 {
            note("a transparent part is drawn opaque");
        }
        if from.emissive != [0.0; 3] {
            note("light that it gives off is not drawn");
        }
        let of_kind = Material::of(kind);
        let rough = from.roughness.clamp(0.08, 1.0);
        match kind {
            PartKind::Skin => Material { color: [r, g, b], ..of_kind },
            PartKind::Cornea => of_kind,
            _ => Material {
                color: [r, g, b],
                roughness_matte: rough,
                roughness_glossy: rough,
                normal_strength: from.normal_scale,
                wrap: [0.0; 3],
                wetness: 0.0,
                back_light: 1.0,
                ..of_kind
            },
        }
    }

    fn place(&mut self, image: usize, factor: [f32; 4]) -> usize {
        *self.places.entry((image, factor.map(f32::to_bits))).or_insert_with(|| {
            self.sources.push((image, factor));
            self.sources.len() - 1
        })
    }

    fn decoded(mut self, scene: &Scene) -> Textures {
        let mut warnings = Vec::new();
        for (source, factor) in &self.sources {
            let image = scene.images.get(*source).and_then(|image| {
                let file = if image.name.is_empty() { format!("image {source}") } else { image.name.clone() };
                let problem = match decode(&image.name, &image.bytes) {
                    _ if image.bytes.is_empty() => "expected a picture, found none".to_owned(),
                    Ok(decoded) => return Some(tinted(decoded, *factor)),
                    Err(error) => format!("expected a picture (PNG, JPEG, TGA or BMP), found: {error}"),
                };
                warnings.push(Warning::Texture { file, problem });
                None
            });
            self.own.images.push(image);
        }
        Textures::of_own(self.own, warnings)
    }
}

/// The picture times a colour, both in linear light.
fn tinted(mut image: RgbaImage, [r, g, b, _]: [f32; 4]) -> RgbaImage {
    for (channel, factor) in
        [r, g, b].into_iter().enumerate().filter(|(_, factor)| (factor - 1.0).abs() > 1e-3)
    {
        // The encoded product to within what eight bits tell: sRGB is nearly a power of 2.2.
        let encoded = factor.max(0.0).powf(1.0 / 2.2);
        image.pixels_mut().for_each(|pixel| {
            pixel.0[channel] = (f32::from(pixel.0[channel]) * encoded).round().min(255.0) as u8;
        });
    }
    image
}
