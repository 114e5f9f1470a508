use crate::{Pack, Texture, Textures};
use avatar_groom::{DensityMap, Groom, Hair};
use avatar_mesh::{Bounds, PartKind};

impl Pack {
    /// Plants hair: the index of the skin among [`Pack::parts`], and what grows on it. `None` where nothing
    /// says where hair grows ([`Texture::HairDensity`], whose first channel counts), or where there is no
    /// skin.
    ///
    /// It takes some tenths of a second for a whole head.
    pub fn groom(&self, textures: &Textures, hair: &Hair) -> Option<(usize, Groom)> {
        let image = textures.get(Texture::HairDensity)?;
        let reds = image.pixels().map(|pixel| pixel.0[0]).collect();
        let density = DensityMap::new(image.width(), image.height(), reds)?;
        let skin = self.parts().iter().position(|part| part.kind == PartKind::Skin)?;
        let eyes: Vec<Bounds> = (self.parts().iter())
            .filter(|part| part.kind == PartKind::Eyeball)
            .filter_map(|part| part.mesh.bounds())
            .collect();
        let mesh = &self.parts()[skin].mesh;
        let head = self.head().or_else(|| mesh.bounds());
        Some((skin, Groom::on_head(mesh, head, &density, &eyes, hair.style, hair.strands(), hair.seed)))
    }
}
