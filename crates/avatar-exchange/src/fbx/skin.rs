use super::{note, place_of};
use crate::build::influences::Influences;
use crate::scene::{Finding, ImportError, RawScene, Skin};
use glam::{Affine3A, Vec3};

/// The skin of a mesh at a node.
#[derive(Debug)]
pub(super) struct BoundSkin {
    /// Its number in the scene.
    pub(super) number: usize,
    /// The bones of the mesh's points.
    pub(super) influences: Influences,
}

impl BoundSkin {
    /// Adds the skin of a mesh to the scene, if the mesh has a skin.
    pub(super) fn read(
        node: &ufbx::Node,
        mesh: &ufbx::Mesh,
        scene: &mut RawScene,
    ) -> Result<Option<Self>, ImportError> {
        let Some(deformer) = mesh.skin_deformers.first() else { return Ok(None) };
        if deformer.clusters.is_empty() {
            return Ok(None);
        }
        let place = place_of(node);
        if mesh.skin_deformers.len() > 1 {
            note(&mut scene.notes, place.as_str(), Finding::left_out("all skins but the first are left out"));
        }
        if deformer.num_dq_weights > 0 {
            note(
                &mut scene.notes,
                place.as_str(),
                Finding::converted("dual quaternion skinning became linear"),
            );
        }
        let own = node.element.typed_id as usize;
        let mut skin = Skin { name: deformer.element.name.to_string(), ..Skin::default() };
        for cluster in &deformer.clusters {
            let bone = cluster.bone_node.as_ref().map_or(own, |bone| bone.element.typed_id as usize);
            skin.joints.push(bone);
            skin.inverse_binds.push(affine(&cluster.geometry_to_bone));
        }
        let Ok(own_bone) = u16::try_from(skin.joints.len()) else {
            return Err(ImportError::new(place, "at most 65535 bones", skin.joints.len().to_string()));
        };
        let influences = influences(mesh, deformer, own_bone);
        if influences.unweighted > 0 {
            // FBX: vertices that no cluster moves follow the mesh's own node.
            skin.joints.push(own);
            skin.inverse_binds.push(affine(&node.geometry_to_node));
            let text = format!("{} points without weights follow the mesh's own node", influences.unweighted);
            note(&mut scene.notes, place.as_str(), Finding::Mended(text));
        }
        if let Some(text) = influences.note("points") {
            note(&mut scene.notes, place, Finding::Converted(text));
        }
        scene.skins.push(skin);
        Ok(Some(Self { number: scene.skins.len() - 1, influences }))
    }
}

fn influences(mesh: &ufbx::Mesh, deformer: &ufbx::SkinDeformer, own: u16) -> Influences {
    let mut influences = Influences::default();
    let mut bones = Vec::new();
    for point in 0..mesh.num_vertices {
        bones.clear();
        if let Some(at) = deformer.vertices.get(point) {
            let begin = at.weight_begin as usize;
            let weights = deformer.weights.get(begin..begin.saturating_add(at.num_weights as usize));
            let weights =
                weights.unwrap_or(&[]).iter().filter(|weight| weight.cluster_index < u32::from(own));
            bones.extend(weights.map(|weight| (weight.cluster_index as u16, weight.weight)));
        }
        influences.push(&mut bones, own);
    }
    influences
}

fn affine(m: &ufbx::Matrix) -> Affine3A {
    let column = |x: f64, y: f64, z: f64| Vec3::new(x as f32, y as f32, z as f32);
    let axes = glam::Mat3::from_cols(
        column(m.m00, m.m10, m.m20),
        column(m.m01, m.m11, m.m21),
        column(m.m02, m.m12, m.m22),
    );
    Affine3A::from_mat3_translation(axes, column(m.m03, m.m13, m.m23))
}
