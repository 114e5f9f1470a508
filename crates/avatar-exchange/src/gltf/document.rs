use super::container::Container;
use super::coordinates::Looks;
use super::extensions::{Support, support_of};
use super::json;
use super::pointer::Pointers;
use super::scan::{Found, scan};
use super::uri::Uri;
use crate::build::budget::Budget;
use crate::scene::{Finding, ImportError, Note, Resolve, TextureRef, quoted};
use gltf::json::{Index, Root, buffer};
use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet, HashSet};
use std::ops::Range;

/// The place of notes on extensions of the file as a whole.
pub(super) const EXTENSIONS_USED: &str = "extensionsUsed";

/// How many extensions an error names.
const MOST_NAMES: usize = 8;

/// A file while it is read: its structures, the bytes behind them, and the notes so far.
pub(super) struct Document<'a> {
    pub(super) root: Root,
    pub(super) pointers: Pointers,
    pub(super) budget: Budget,
    /// How many pictures the file has, which leave the structures when they are read.
    pub(super) images: usize,
    /// For each material, which texture coordinates it needs.
    pub(super) looks: Vec<Looks>,
    /// An extension of materials and its member that is a texture, which needs coordinates as well.
    pub(super) further: Option<(&'static str, &'static str)>,
    /// For each material the texture that this member says.
    pub(super) further_textures: Vec<Option<TextureRef>>,
    /// Nodes that stand for the instances of a node, at the end of the scene's.
    pub(super) instances: BTreeMap<usize, Range<usize>>,
    /// What the structures do not have.
    found: Found,
    /// Bytes of buffers and of other files, each one once.
    pub(super) stores: Vec<Cow<'a, [u8]>>,
    /// Where each buffer's bytes are, and how many of them are its own.
    buffers: Vec<(usize, usize)>,
    /// Where the bytes of views are that were compressed.
    pub(super) unpacked: BTreeMap<usize, usize>,
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
        let mut budget = Budget::of_bytes(file_bytes);
        let found = scan(container.json);
        let json::Parsed { root, dropped, pointers } = json::parse(container.json, &found, &mut budget)?;
        check_versions(&root, &found)?;
        let mut document = Self {
            images: root.images.len(),
            root,
            pointers,
            budget,
            looks: Vec::new(),
            further: None,
            further_textures: Vec::new(),
            instances: BTreeMap::new(),
            found,
            stores: Vec::new(),
            buffers: Vec::new(),
            unpacked: BTreeMap::new(),
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
        document.unpack_views()?;
        document.unpack_primitives()?;
        Ok(document)
    }

    fn open_buffers(&mut self, bin: Option<&'a [u8]>) -> Result<(), ImportError> {
        for number in 0..self.root.buffers.len() {
            let buffer = &self.root.buffers[number];
            let (uri, length) = (buffer.uri.clone(), buffer.byte_length.0);
            let place = || format!("buffer {number}");
            let store = match (uri, bin) {
                (None, Some(bin)) if number == 0 => {
                    self.stores.push(Cow::Borrowed(bin));
                    self.stores.len() - 1
                }
                // Views into it are compressed elsewhere.
                _ if is_fallback(buffer) => {
                    let store = self.store(Vec::new());
                    self.buffers.push((store, 0));
                    continue;
                }
                (Some(uri), _) => self.load(&place(), &uri)?.0,
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
        let stride = view.byte_stride.map(|stride| stride.0);
        if let Some(&store) = self.unpacked.get(&number) {
            return Ok(View { number, bytes: &self.stores[store], stride });
        }
        let place = || format!("bufferView {number}");
        let offset = view.byte_offset.unwrap_or_default().0;
        let bytes = self.part_of_buffer(place, view.buffer.value(), offset, view.byte_length.0)?;
        Ok(View { number, bytes, stride })
    }

    /// Bytes of a buffer.
    pub(super) fn part_of_buffer(
        &self,
        place: impl Fn() -> String,
        buffer: usize,
        offset: u64,
        length: u64,
    ) -> Result<&[u8], ImportError> {
        let &(store, available) = in_range("buffers", &self.buffers, buffer)?;
        let range = usize::try_from(offset)
            .ok()
            .zip(offset.checked_add(length).and_then(|end| usize::try_from(end).ok()))
            .filter(|(_, end)| *end <= available);
        match range {
            Some((start, end)) => Ok(&self.stores[store][start..end]),
            None => {
                let expected = format!("a range within the {available} bytes of buffer {buffer}");
                Err(ImportError::new(place(), expected, format!("{length} bytes from {offset}")))
            }
        }
    }

    /// The position of further bytes, which are a view's own.
    pub(super) fn store(&mut self, bytes: Vec<u8>) -> usize {
        self.stores.push(Cow::Owned(bytes));
        self.stores.len() - 1
    }

    /// Adds a note, once.
    pub(super) fn note(&mut self, place: impl Into<String>, finding: Finding) {
        let note = Note::new(place, finding);
        if self.noted.insert(note.clone()) {
            self.notes.push(note);
        }
    }

    pub(super) fn take_notes(&mut self) -> Vec<Note> {
        std::mem::take(&mut self.notes)
    }

    /// Notes extensions, cameras and other things that are not represented.
    pub(super) fn note_the_rest(&mut self) {
        let listed = self.root.extensions_used.iter().chain(&self.root.extensions_required).cloned();
        let mut extensions: BTreeSet<String> = listed.collect();
        extensions.append(&mut self.found.extensions);
        for name in extensions.into_iter().filter(|name| support_of(name) != Some(Support::Read)) {
            self.note(EXTENSIONS_USED, Finding::Extension(name));
        }
        for name in std::mem::take(&mut self.found.target_attributes) {
            self.note("meshes, targets", Finding::LeftOut(format!("{} is left out", quoted(&name))));
        }
        let cameras = self.root.cameras.len();
        if cameras > 0 {
            self.note("cameras", Finding::LeftOut(format!("{cameras} are left out")));
        }
    }
}

/// Whether a buffer is only there for programs that do not know the extension that its views have.
fn is_fallback(buffer: &buffer::Buffer) -> bool {
    let extensions = buffer.extensions.iter().flat_map(|all| all.others.iter());
    let mut fallbacks = extensions.filter_map(|(_, extension)| extension.get("fallback")?.as_bool());
    fallbacks.any(|is_fallback| is_fallback)
}

/// An element of a list of the file.
pub(super) fn in_range<'a, T>(list: &str, items: &'a [T], number: usize) -> Result<&'a T, ImportError> {
    items.get(number).ok_or_else(|| {
        ImportError::new(list, format!("a position below {}", items.len()), number.to_string())
    })
}

fn check_versions(root: &Root, found: &Found) -> Result<(), ImportError> {
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
    // What is not known concerns only looks where nothing that geometry is made of has it.
    let is_unread = |name: &&String| match support_of(name) {
        Some(support) => support == Support::Refused,
        None => found.of_geometry.contains(*name),
    };
    let unread: Vec<_> = root.extensions_required.iter().filter(is_unread).map(|name| quoted(name)).collect();
    if unread.is_empty() {
        return Ok(());
    }
    let mut found = unread[..unread.len().min(MOST_NAMES)].join(", ");
    if unread.len() > MOST_NAMES {
        found += &format!(" and {} more", unread.len() - MOST_NAMES);
    }
    let expected = "none of what concerns geometry or motion and is not read here (docs/formats.md)";
    Err(ImportError::new("extensionsRequired", expected, found))
}
