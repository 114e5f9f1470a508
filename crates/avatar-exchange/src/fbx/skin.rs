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
    /// Adds the skin of a mesh to the scene, if the mesh has a skin. Several skins of a mesh become one that
    /// has the bones of all, as in Autodesk's viewer (`ComputeSkinDeformation` in the sample `ViewScene` of
    /// the FBX SDK): it adds up the weighted motion of all clusters of all skins and divides by the sum of
    /// the weights.
    pub(super) fn read(
        node: &ufbx::Node,
        mesh: &ufbx::Mesh,
        scene: &mut RawScene,
    ) -> Result<Option<Self>, ImportError> {
        let deformers = || mesh.skin_deformers.iter().filter(|deformer| !deformer.clusters.is_empty());
        let Some(first) = deformers().next() else { return Ok(None) };
        let place = place_of(node);
        if deformers().count() > 1 {
            let text = format!("its {} skins became one with the bones of all", deformers().count());
            note(&mut scene.notes, place.as_str(), Finding::Converted(text));
        }
        if deformers().any(|deformer| is_dual(deformer)) {
            let text = "dual quaternion skinning became linear";
            note(&mut scene.notes, place.as_str(), Finding::converted(text));
        }
        let own = node.element.typed_id as usize;
        let mut skin = Skin { name: first.element.name.to_string(), ..Skin::default() };
        for cluster in deformers().flat_map(|deformer| &deformer.clusters) {
            let bone = cluster.bone_node.as_ref().map_or(own, |bone| bone.element.typed_id as usize);
            skin.joints.push(bone);
            skin.inverse_binds.push(affine(&cluster.geometry_to_bone));
        }
        let Ok(own_bone) = u16::try_from(skin.joints.len()) else {
            return Err(ImportError::new(place, "at most 65535 bones", skin.joints.len().to_string()));
        };
        let influences = influences(mesh, own_bone);
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

/// Whether a skin rotates by dual quaternions, at least at some points.
fn is_dual(deformer: &ufbx::SkinDeformer) -> bool {
    match deformer.skinning_method {
        ufbx::SkinningMethod::DualQuaternion => true,
        ufbx::SkinningMethod::BlendedDqLinear => deformer.dq_weights.iter().any(|weight| *weight != 0.0),
        ufbx::SkinningMethod::Linear | ufbx::SkinningMethod::Rigid => false,
    }
}

/// Bones and weights of points; `own` is the bone behind those of all skins.
fn influences(mesh: &ufbx::Mesh, own: u16) -> Influences {
    let mut influences = Influences::default();
    let mut bones = Vec::new();
    for point in 0..mesh.num_vertices {
        bones.clear();
        let mut first = 0;
        for deformer in &mesh.skin_deformers {
            let count = deformer.clusters.len();
            if let Some(at) = deformer.vertices.get(point) {
                let begin = at.weight_begin as usize;
                let weights = deformer.weights.get(begin..begin.saturating_add(at.num_weights as usize));
                let weights = weights.unwrap_or(&[]).iter().map(|it| (it.cluster_index as usize, it.weight));
                // Below the number of the mesh's own bone, which fits.
                let weights = weights.filter(|(cluster, _)| *cluster < count);
                bones.extend(weights.map(|(cluster, weight)| ((first + cluster) as u16, weight)));
            }
            first += count;
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
