use super::Clip;

/// Clips in the order of their file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ClipSet {
    /// The clips. Names and keys of a set that was read are unique.
    pub clips: Vec<Clip>,
}

impl ClipSet {
    /// The clip of this name.
    pub fn get(&self, name: &str) -> Option<&Clip> {
        self.clips.iter().find(|clip| clip.name == name)
    }

    /// The clip's name that is probably meant by a misspelt one.
    pub fn nearest(&self, name: &str) -> Option<&str> {
        placed_toml::nearest(name, self.clips.iter().map(|clip| clip.name.as_str()))
    }
}
