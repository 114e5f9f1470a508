use super::container::Container;
use super::json;
use super::uri::Uri;
use crate::build::budget::Budget;
use crate::scene::{Finding, ImportError, Note, Resolve};
use gltf::json::{Index, Root, buffer};
use std::borrow::Cow;
use std::collections::{BTreeMap, HashSet};

/// Extensions that a file may require: the first is represented, the others change looks only and are noted.
const KNOWN_EXTENSIONS: &[&str] = &["KHR_mesh_quantization", "KHR_texture_transform", "KHR_materials_unlit"];
const REPRESENTED_EXTENSIONS: usize = 1;

/// The place of notes on extensions of the file as a whole.
pub(super) const EXTENSIONS_USED: &str = "extensionsUsed";

/// A file while it is read: its structures, the bytes behind them, and the notes so far.
pub(super) struct Document<'a> {
    pub(super) root: Root,
    pub(super) budget: Budget,
    /// Bytes of buffers and of other files, each one once.
    stores: Vec<Cow<'a, [u8]>>,
    /// Where each buffer's bytes are, and how many of them are its own.
    buffers: Vec<(usize, usize)>,
    /// Which files are in the stores already.
    files: BTreeMap<String, usize>,
    resolve: &'a mut Resolve<'a>,
    notes: Vec<Note>,
    noted: HashSet<Note>,
}

/// Bytes of a buffer view.
#[derive(Clone, Copy)]
pub(super) struct View<'a> {
    pub(super) number: usize,
    pub(super) bytes: &'a [u8],
    pub(super) stride: Option<usize>,
}

impl<'a> Document<'a> {
    pub(super) fn open(
        container: &Container<'a>,
        file_bytes: usize,
        resolve: &'a mut Resolve<'_>,
    ) -> Result<Self, ImportError> {
        let (root, dropped) = json::parse(container.json)?;
        check_versions(&root)?;
        let mut document = Self {
            root,
            budget: Budget::of_bytes(file_bytes),
            stores: Vec::new(),
            buffers: Vec::new(),
            files: BTreeMap::new(),
            resolve,
            notes: Vec::new(),
            noted: HashSet::new(),
        };
        if dropped > 0 {
            let text = format!("{dropped} channels without a node are left out");
            document.note("animations", Finding::LeftOut(text));
        }
        document.open_buffers(container.bin)?;
        Ok(document)
    }

    fn open_buffers(&mut self, bin: Option<&'a [u8]>) -> Result<(), ImportError> {
        for number in 0..self.root.buffers.len() {
            let buffer = &self.root.buffers[number];
            let (uri, length) = (buffer.uri.clone(), buffer.byte_length.0);
            let place = || format!("buffer {number}");
            let store = match (uri, bin) {
                (Some(uri), _) => self.load(&place(), &uri)?.0,
                (None, Some(bin)) if number == 0 => {
                    self.stores.push(Cow::Borrowed(bin));
                    self.stores.len() - 1
                }
                (None, _) => return Err(ImportError::new(place(), "an address or a GLB chunk", "neither")),
            };
            let found = self.stores[store].len();
            let length = usize::try_from(length)
                .ok()
                .filter(|length| *length <= found)
                .ok_or_else(|| ImportError::new(place(), format!("{length} bytes"), found.to_string()))?;
            self.buffers.push((store, length));
        }
        Ok(())
    }

    /// Where the bytes behind an address are, and their media type where the address says it.
    fn load(&mut self, place: &str, uri: &str) -> Result<(usize, String), ImportError> {
        let wrong = |expected: &str| {
            let shown: String = uri.chars().take(80).collect();
            ImportError::new(place, expected, format!("'{shown}'"))
        };
        let (bytes, mime) = match Uri::parse(uri).map_err(wrong)? {
            Uri::Data { mime, bytes } => (bytes, mime),
            Uri::Path(path) => {
                if let Some(&store) = self.files.get(&path) {
                    return Ok((store, String::new()));
                }
                let bytes = (self.resolve)(&path)
                    .map_err(|error| ImportError::new(place, format!("the file '{path}'"), error))?;
                self.budget.grow(bytes.len());
                self.files.insert(path, self.stores.len());
                (bytes, String::new())
            }
        };
        self.stores.push(Cow::Owned(bytes));
        Ok((self.stores.len() - 1, mime))
    }

    /// A copy of the bytes behind an address, and their media type where the address says it.
    pub(super) fn file(&mut self, place: &str, uri: &str) -> Result<(Vec<u8>, String), ImportError> {
        let (store, mime) = self.load(place, uri)?;
        self.budget.take(self.stores[store].len(), 1).map_err(|exceeded| exceeded.at(place))?;
        Ok((self.stores[store].to_vec(), mime))
    }

    pub(super) fn view(&self, index: Index<buffer::View>) -> Result<View<'_>, ImportError> {
        let number = index.value();
        let view = in_range("bufferViews", &self.root.buffer_views, number)?;
        let &(store, length) = in_range("buffers", &self.buffers, view.buffer.value())?;
        let offset = view.byte_offset.unwrap_or_default().0;
        let range = usize::try_from(offset)
            .ok()
            .zip(offset.checked_add(view.byte_length.0).and_then(|end| usize::try_from(end).ok()))
            .filter(|(_, end)| *end <= length);
        let Some((start, end)) = range else {
            let expected = format!("a range within the {length} bytes of buffer {}", view.buffer.value());
            let found = format!("{} bytes from {offset}", view.byte_length.0);
            return Err(ImportError::new(format!("bufferView {number}"), expected, found));
        };
        let stride = view.byte_stride.map(|stride| stride.0);
        Ok(View { number, bytes: &self.stores[store][start..end], stride })
    }

    /// Adds a note, once.
    pub(super) fn note(&mut self, place: impl Into<String>, finding: Finding) {
        let note = Note::new(place, finding);
        if self.noted.insert(note.clone()) {
            self.notes.push(note);
        }
    }

    pub(super) fn into_notes(self) -> Vec<Note> {
        self.notes
    }

    /// Notes extensions and cameras, which are not represented.
    pub(super) fn note_the_rest(&mut self) {
        let root = &self.root;
        let left_out: Vec<_> = root
            .extensions_used
            .iter()
            .filter(|name| !KNOWN_EXTENSIONS[..REPRESENTED_EXTENSIONS].contains(&name.as_str()))
            .cloned()
            .collect();
        let cameras = root.cameras.len();
        for name in left_out {
            self.note(EXTENSIONS_USED, Finding::Extension(name));
        }
        if cameras > 0 {
            self.note("cameras", Finding::LeftOut(format!("{cameras} are left out")));
        }
    }
}

/// An element of a list of the file.
pub(super) fn in_range<'a, T>(list: &str, items: &'a [T], number: usize) -> Result<&'a T, ImportError> {
    items.get(number).ok_or_else(|| {
        ImportError::new(list, format!("a position below {}", items.len()), number.to_string())
    })
}

fn check_versions(root: &Root) -> Result<(), ImportError> {
    let asset = &root.asset;
    let (needed, place) = match &asset.min_version {
        Some(version) => (version, "asset.minVersion"),
        None => (&asset.version, "asset.version"),
    };
    let readable = match &asset.min_version {
        Some(version) => version == "2.0",
        None => asset.version == "2" || asset.version.starts_with("2."),
    };
    if !readable {
        return Err(ImportError::new(place, "glTF 2.0", format!("'{needed}'")));
    }
    let unknown = |name: &&String| !KNOWN_EXTENSIONS.contains(&name.as_str());
    let unknown: Vec<_> = root.extensions_required.iter().filter(unknown).map(String::as_str).collect();
    if unknown.is_empty() {
        return Ok(());
    }
    let expected = format!("none but {}", KNOWN_EXTENSIONS.join(", "));
    Err(ImportError::new("extensionsRequired", expected, unknown.join(", ")))
}
