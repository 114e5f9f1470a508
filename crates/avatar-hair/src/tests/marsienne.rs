//! The default avatar.

use crate::{DensityMap, Regions};
use avatar_mesh::{Bounds, Deformed, Mesh, PartKind, deform};
use avatar_pack::{FaceState, MemorySource, Pack, Texture};
use glam::Affine3A;
use std::path::Path;
use std::sync::OnceLock;

pub(crate) struct Skin {
    pub(crate) pack: Pack,
    pub(crate) mesh: Mesh,
    pub(crate) density: DensityMap,
    pub(crate) regions: Regions,
}

fn load() -> Skin {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets/marsienne");
    let mut source = MemorySource::default();
    for entry in std::fs::read_dir(&folder).expect("the default avatar") {
        let path = entry.expect("an entry").path();
        let name = path.file_name().and_then(|name| name.to_str()).expect("a name").to_owned();
        source.files.insert(name, std::fs::read(&path).expect("a file"));
    }
    let pack = Pack::load(&source).expect("a pack");
    let bytes = &source.files[&format!("{}.png", Texture::HairDensity.stem())];
    let image = image::load_from_memory(bytes).expect("a picture").into_luma8();
    let density = DensityMap::from_bytes(image.width(), image.height(), image.as_raw()).expect("a map");
    let eyes: Vec<Bounds> = (pack.parts.iter().filter(|part| part.spec.kind == PartKind::Eyeball))
        .filter_map(|part| part.mesh.bounds())
        .collect();
    let mesh = pack.part("skin").expect("a skin").mesh.clone();
    Skin { pack, mesh, density, regions: Regions::new(&eyes) }
}

pub(crate) fn skin() -> &'static Skin {
    static SKIN: OnceLock<Skin> = OnceLock::new();
    SKIN.get_or_init(load)
}

/// A default pose: its name, the deformed skin, and the bone matrices of neck and head.
pub(crate) struct Posed {
    pub(crate) name: String,
    pub(crate) skin: Deformed,
    pub(crate) neck: Affine3A,
    pub(crate) head: Affine3A,
}

impl Skin {
    pub(crate) fn poses(&self) -> Vec<Posed> {
        let mut state = FaceState::new(&self.pack);
        let mut posed = Vec::new();
        for pose in &self.pack.poses {
            let mut values = self.pack.controls.defaults();
            pose.values.iter().for_each(|&(control, value)| values[control] = value);
            state.pose(&self.pack, &values).expect("values of the pack");
            let mut skin = self.mesh.deformed();
            deform(&self.mesh, state.bones(), state.weights(), &mut skin).expect("a skin");
            posed.push(Posed {
                name: pose.name.clone(),
                skin,
                neck: state.bones()[0],
                head: state.bones()[1],
            });
        }
        posed
    }
}
