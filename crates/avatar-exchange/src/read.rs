use crate::{ImportError, Scene};

/// Brings a file that another one refers to: takes a relative path with `/` between folders, never absolute and never
/// leading upwards, and returns the file's bytes, or what went wrong.
pub type Resolve<'a> = dyn FnMut(&str) -> Result<Vec<u8>, String> + 'a;

/// A format that scenes are read from. Those whose features are off are known, but not read.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Format {
    /// glTF 2.0 as JSON, or GLB.
    Gltf,
    /// Wavefront OBJ.
    Obj,
    /// Biovision hierarchies: nodes and a clip, nothing to draw.
    Bvh,
    /// Meshes of id Tech 4, without animations, which are files that no mesh names.
    Md5Mesh,
}

impl Format {
    /// All formats.
    pub const ALL: [Self; 4] = [Self::Gltf, Self::Obj, Self::Bvh, Self::Md5Mesh];

    /// How files of the format end, in lower case and without the dot.
    pub fn extensions(self) -> &'static [&'static str] {
        match self {
            Self::Gltf => &["glb", "gltf"],
            Self::Obj => &["obj"],
            Self::Bvh => &["bvh"],
            Self::Md5Mesh => &["md5mesh"],
        }
    }

    /// The format of a file of this name.
    pub fn of_name(file: &str) -> Option<Self> {
        let extension = file.rsplit_once('.')?.1.to_lowercase();
        Self::ALL.into_iter().find(|format| format.extensions().contains(&extension.as_str()))
    }
}

/// Reads a file of any format that is built in, told by the end of its name.
///
/// # Errors
/// A name of no known format, or what the format's reader finds.
pub fn read(file: &str, bytes: &[u8], resolve: &mut Resolve<'_>) -> Result<Scene, ImportError> {
    let known = || {
        let all = Format::ALL.iter().flat_map(|format| format.extensions());
        all.map(|extension| format!(".{extension}")).collect::<Vec<_>>().join(", ")
    };
    let format = Format::of_name(file).ok_or_else(|| {
        ImportError::new("the file's name", format!("one that ends in {}", known()), format!("{file:?}"))
    })?;
    match format {
        #[cfg(feature = "gltf")]
        Format::Gltf => crate::gltf::read(file, bytes, resolve),
        #[cfg(feature = "obj")]
        Format::Obj => crate::obj::read(file, bytes, resolve),
        #[cfg(feature = "bvh")]
        Format::Bvh => crate::bvh::read(file, bytes),
        #[cfg(feature = "md5")]
        Format::Md5Mesh => crate::md5::read(crate::md5::TextFile { file, bytes }, &[]),
        #[allow(unreachable_patterns, reason = "reached where features are off")]
        other => {
            let _ = (bytes, resolve);
            let found = format!("{other:?}, which this build does not read");
            Err(ImportError::new("the file's format", "one that is built in", found).in_file(file))
        }
    }
}
