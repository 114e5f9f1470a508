//! Which sets of texture coordinates are read: a mesh here has two, and textures of FBX name theirs.

use std::collections::{HashMap, HashSet};

/// Names of sets that are looked for in a material: no program writes materials with more.
const MAX_NAMES: usize = 64;

/// The second set of texture coordinates of each mesh, and the textures that use it.
pub(super) struct Coordinates {
    /// For each mesh, the position of its second set among its sets.
    second: Vec<Option<usize>>,
    /// Materials, and names of the sets that are second ones for all meshes with these materials.
    of_second: HashSet<(u32, String)>,
    /// Materials, and names of their sets that some mesh has and that are read for none.
    unread: HashSet<(u32, String)>,
}

impl Coordinates {
    /// Of the sets behind a mesh's first one, the second one is the first that a texture of its materials
    /// names, else the first of them.
    pub(super) fn of(fbx: &ufbx::Scene) -> Self {
        let names: Vec<Vec<&str>> = fbx.materials.iter().map(|material| names_of(material)).collect();
        let mut second = Vec::with_capacity(fbx.meshes.len());
        let [mut of_first, mut of_second, mut of_further] = [(); 3].map(|()| HashSet::new());
        for (mesh, materials) in fbx.meshes.iter().zip(materials_of_meshes(fbx)) {
            let mut places: HashMap<&str, usize> = HashMap::new();
            for (place, set) in mesh.uv_sets.iter().enumerate() {
                places.entry(&set.name).or_insert(place);
            }
            let uses: Vec<(u32, &str, usize)> = (materials.into_iter())
                .flat_map(|it| names.get(it as usize).into_iter().flatten().map(move |name| (it, *name)))
                .filter_map(|(material, name)| Some((material, name, *places.get(name)?)))
                .collect();
            let named = uses.iter().map(|(_, _, place)| *place).filter(|place| *place > 0).min();
            let own = named.or((mesh.uv_sets.len() > 1).then_some(1));
            for (material, name, place) in uses {
                let which = match place {
                    0 => &mut of_first,
                    _ if Some(place) == own => &mut of_second,
                    _ => &mut of_further,
                };
                which.insert((material, name.to_owned()));
            }
            second.push(own);
        }
        // A material says it once for all of its meshes: where they differ, the first set is used.
        let (differ, of_second): (HashSet<_>, HashSet<_>) =
            of_second.into_iter().partition(|pair| of_first.contains(pair) || of_further.contains(pair));
        of_further.extend(differ);
        Self { second, of_second, unread: of_further }
    }

    /// The second set of a mesh.
    pub(super) fn second<'a>(&self, mesh: &'a ufbx::Mesh) -> Option<&'a ufbx::UvSet> {
        let set = self.second.get(mesh.element.typed_id as usize).copied().flatten()?;
        mesh.uv_sets.get(set)
    }

    /// Whether a texture of a material uses the second set.
    pub(super) fn is_second(&self, material: &ufbx::Material, texture: &ufbx::Texture) -> bool {
        self.of_second.contains(&(material.element.typed_id, set_of(texture).to_owned()))
    }

    /// The name of a set that a texture of a material uses and that is not read for it.
    pub(super) fn unread<'a>(
        &self,
        material: &ufbx::Material,
        texture: &'a ufbx::Texture,
    ) -> Option<&'a str> {
        let name = set_of(texture);
        self.unread.contains(&(material.element.typed_id, name.to_owned())).then_some(name)
    }
}

/// The names of sets in a material's textures, each once.
fn names_of(material: &ufbx::Material) -> Vec<&str> {
    let mut names: Vec<&str> = Vec::new();
    for texture in &material.textures {
        let name = set_of(&texture.texture);
        if !name.is_empty() && names.len() < MAX_NAMES && !names.contains(&name) {
            names.push(name);
        }
    }
    names
}

/// For each mesh, the materials that it has where it is shown.
fn materials_of_meshes(fbx: &ufbx::Scene) -> Vec<Vec<u32>> {
    let mut all: Vec<Vec<u32>> = vec![Vec::new(); fbx.meshes.len()];
    let mut is_counted = vec![false; fbx.meshes.len()];
    for node in &fbx.nodes {
        let Some(mesh) = &node.mesh else { continue };
        let number = mesh.element.typed_id as usize;
        let (Some(materials), Some(is_counted)) = (all.get_mut(number), is_counted.get_mut(number)) else {
            continue;
        };
        if !node.materials.is_empty() {
            materials.extend(node.materials.iter().map(|material| material.element.typed_id));
        } else if !std::mem::replace(is_counted, true) {
            materials.extend(mesh.materials.iter().map(|material| material.element.typed_id));
        }
    }
    for materials in &mut all {
        materials.sort_unstable();
        materials.dedup();
    }
    all
}

/// The name of the set that a texture uses; of a layered or computed one, that of its first picture.
fn set_of(texture: &ufbx::Texture) -> &str {
    let texture = texture.file_textures.first().map_or(texture, |first| first);
    &texture.uv_set
}
