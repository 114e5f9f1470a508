use crate::scene::{ImportError, Resolve, Scene, TextFile};

/// A format that scenes are read from. Those whose features are off are known, but not read.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Format {
    /// glTF 2.0 as JSON, or GLB.
    Gltf,
    /// VRM 1.0 and 0.x: its scene; [`crate::vrm`] has the rest.
    Vrm,
    /// Wavefront OBJ.
    Obj,
    /// Autodesk FBX.
    Fbx,
    /// COLLADA.
    Collada,
    /// Meshes of id Tech 4.
    Md5,
    /// Biovision hierarchies: nodes and a clip, nothing to draw.
    Bvh,
}

impl Format {
    /// All formats.
    pub const ALL: [Self; 7] =
        [Self::Gltf, Self::Vrm, Self::Obj, Self::Fbx, Self::Collada, Self::Md5, Self::Bvh];

    /// How files of the format end, in lower case and without the dot.
    pub fn extensions(self) -> &'static [&'static str] {
        match self {
            Self::Gltf => &["glb", "gltf"],
            Self::Vrm => &["vrm"],
            Self::Obj => &["obj"],
            Self::Fbx => &["fbx"],
            Self::Collada => &["dae"],
            Self::Md5 => &["md5mesh"],
            Self::Bvh => &["bvh"],
        }
    }

    /// How further files of the format may end: shapes and frames of OBJ, animations of MD5.
    pub fn further_extensions(self) -> &'static [&'static str] {
        match self {
            Self::Obj => &["target", "obj"],
            Self::Md5 => &["md5anim"],
            Self::Gltf | Self::Vrm | Self::Fbx | Self::Collada | Self::Bvh => &[],
        }
    }

    /// The format of a file of this name.
    pub fn of_name(file: &str) -> Option<Self> {
        let extension = extension(file)?;
        Self::ALL.into_iter().find(|format| format.extensions().contains(&extension.as_str()))
    }
}

/// Frames of a sequence of OBJ files in a second, where nothing says their times.
pub const FRAMES_PER_SECOND: f64 = 24.0;

fn extension(file: &str) -> Option<String> {
    let name = file.rsplit(['/', '\\']).next()?;
    Some(name.rsplit_once('.')?.1.to_lowercase())
}

/// Reads a file of any format that is built in, told by the end of its name, together with files that belong
/// to it: MakeHuman targets of an OBJ file, which become its shapes; OBJ files of its connectivity, the next
/// frames of a sequence of [`FRAMES_PER_SECOND`]; animations of an MD5 mesh.
///
/// # Errors
/// A name of no known format, a further file that does not belong to the format, or what the format's reader
/// finds.
pub fn read(
    file: &str,
    bytes: &[u8],
    further: &[TextFile<'_>],
    resolve: &mut Resolve<'_>,
) -> Result<Scene, ImportError> {
    let list = |extensions: &mut dyn Iterator<Item = &&str>| {
        extensions.map(|extension| format!(".{extension}")).collect::<Vec<_>>().join(", ")
    };
    let format = Format::of_name(file).ok_or_else(|| {
        let known = list(&mut Format::ALL.iter().flat_map(|format| format.extensions()));
        ImportError::new("the file's name", format!("one that ends in {known}"), format!("{file:?}"))
    })?;
    for other in further {
        let fits = extension(other.file).is_some_and(|it| format.further_extensions().contains(&it.as_str()));
        if !fits {
            let expected = match format.further_extensions() {
                [] => "no further file for this format".to_owned(),
                extensions => format!("a further file that ends in {}", list(&mut extensions.iter())),
            };
            let found = format!("{:?}", other.file);
            return Err(ImportError::new("the further files", expected, found).in_file(file));
        }
    }
    match format {
        #[cfg(feature = "gltf")]
        Format::Gltf => crate::gltf::read(file, bytes, resolve),
        #[cfg(feature = "vrm")]
        Format::Vrm => crate::vrm::read(file, bytes, resolve).map(|model| model.scene),
        #[cfg(feature = "obj")]
        Format::Obj => read_obj(file, bytes, further, resolve),
        #[cfg(feature = "fbx")]
        Format::Fbx => crate::fbx::read(file, bytes, resolve),
        #[cfg(feature = "collada")]
        Format::Collada => crate::collada::read(file, bytes, resolve),
        #[cfg(feature = "md5")]
        Format::Md5 => crate::md5::read(TextFile { file, bytes }, further),
        #[cfg(feature = "bvh")]
        Format::Bvh => crate::bvh::read(file, bytes),
        #[allow(unreachable_patterns, reason = "reached where features are off")]
        other => {
            let _ = (bytes, resolve);
            let found = format!("{other:?}, which this build does not read");
            Err(ImportError::new("the file's format", "one that is built in", found).in_file(file))
        }
    }
}

#[cfg(feature = "obj")]
fn read_obj(
    file: &str,
    bytes: &[u8],
    further: &[TextFile<'_>],
    resolve: &mut Resolve<'_>,
) -> Result<Scene, ImportError> {
    use crate::obj;
    let is_target =
        |other: &TextFile<'_>| extension(other.file).is_some_and(|extension| extension == "target");
    let Some(first) = further.first() else { return obj::read(file, bytes, resolve) };
    if let Some(other) = further.iter().find(|other| is_target(other) != is_target(first)) {
        let found = format!("{:?} and {:?}", first.file, other.file);
        return Err(ImportError::new("the further files", "either targets or frames", found).in_file(file));
    }
    if !is_target(first) {
        let all = std::iter::once(TextFile { file, bytes }).chain(further.iter().copied());
        let frames: Vec<obj::ObjFrame<'_>> = (all.enumerate())
            .map(|(index, TextFile { file, bytes })| {
                let time_secs = index as f64 / FRAMES_PER_SECOND;
                obj::ObjFrame { file, bytes, time_secs }
            })
            .collect();
        return obj::read_sequence(&frames, resolve);
    }
    #[cfg(feature = "target")]
    {
        let mut base = obj::read_obj(file, bytes, resolve)?;
        for target in further {
            crate::target::add(target.file, target.bytes, &mut base)?;
        }
        base.into_scene()
    }
    #[cfg(not(feature = "target"))]
    {
        let found = format!("{:?}, which this build does not read", first.file);
        Err(ImportError::new("the further files", "formats that are built in", found).in_file(file))
    }
}
