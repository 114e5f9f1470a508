use super::document::Document;
use super::node::affine;
use crate::scene::narrow;
use crate::scene::{ImportError, RawScene, Skin};
use glam::{Affine3A, DAffine3};
use gltf::json::accessor::Type;

impl Document<'_> {
    pub(super) fn read_skins(&mut self, scene: &mut RawScene) -> Result<(), ImportError> {
        for (number, skin) in std::mem::take(&mut self.root.skins).into_iter().enumerate() {
            let place = || format!("skin {number}");
            let joints: Vec<_> = skin.joints.iter().map(|joint| joint.value()).collect();
            let mut inverse_binds = vec![Affine3A::IDENTITY; joints.len()];
            if let Some(accessor) = skin.inverse_bind_matrices {
                let matrices: Vec<[f32; 16]> = self.floats(accessor, Type::Mat4)?;
                if matrices.len() < joints.len() {
                    let expected = format!("{} inverse bind matrices", joints.len());
                    return Err(ImportError::new(place(), expected, matrices.len().to_string()));
                }
                for (joint, (bind, matrix)) in inverse_binds.iter_mut().zip(&matrices).enumerate() {
                    let matrix = affine(|| format!("{}, joint {joint}", place()), matrix)?;
                    *bind = narrow(DAffine3::from_mat4(matrix));
                }
            }
            scene.skins.push(Skin { name: skin.name.unwrap_or_default(), joints, inverse_binds });
        }
        Ok(())
    }
}
