use super::looks::Looks;
use super::{ImportFailure, ImportReport};
use crate::unique::unique_names;
use crate::{Part, Textures};
use avatar_exchange::{Scene, ScenePart};
use avatar_mesh::{Mesh, Shape};

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

/// The parts, which know the places of their shapes in the common list, and their pictures. The scene's
/// meshes become theirs, so that they are not in memory twice.
pub(super) fn parts(
    scene: &mut Scene,
    shapes: &ShapeNames,
    report: &mut ImportReport,
) -> Result<(Vec<Part>, Textures), ImportFailure> {
    let names = unique_names(scene.parts.iter().map(|part| part_name(scene, part)), "part");
    let mut looks = Looks::of(scene);
    let mut parts = Vec::with_capacity(names.len());
    for (number, name) in names.into_iter().enumerate() {
        let Some(part) = scene.parts.get(number) else { continue };
        let (kind, material) = looks.take(scene, part, &name, report);
        let bone = match part.skin {
            Some(_) => None,
            None => scene.palette().rigid.get(part.node).copied().flatten(),
        };
        let (skin, first_shape) = (part.skin, shapes.first.get(part.node).copied().unwrap_or(0));
        let mut mesh = scene.take_mesh(number).unwrap_or_default();
        // Shapes that move positions only get the normals of the moved surface.
        mesh.add_shape_normals();
        to_palette(scene, skin, &mut mesh)?;
        let bytes = mesh.positions.len() * 32 + mesh.triangles.len() * 12;
        parts.push(Part {
            name,
            kind,
            mesh,
            first_shape,
            bytes,
            bone,
            material: Some(material),
            bounds: None,
        });
    }
    Ok((parts, looks.into_textures()))
}

/// Bones of a scene's part are joints of its skin; those of a pack's part are entries of the palette, in
/// which the joints of all skins follow each other.
fn to_palette(scene: &Scene, skin: Option<usize>, mesh: &mut Mesh) -> Result<(), ImportFailure> {
    let (Some(skin), Some(skinning)) = (skin, &mut mesh.skinning) else { return Ok(()) };
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
