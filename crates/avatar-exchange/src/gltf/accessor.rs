use super::component::{float, whole};
use super::document::{Document, View, in_range};
use crate::scene::ImportError;
use bytemuck::Pod;
use gltf::json::accessor::{ComponentType, IndexComponentType, Type, sparse::Sparse};
use gltf::json::validation::Checked;
use gltf::json::{Accessor, Index};

/// Elements at constant distances, known to lie within their bytes.
#[derive(Clone, Copy)]
struct Elements<'a> {
    bytes: &'a [u8],
    stride: usize,
    size: usize,
    count: usize,
}

impl<'a> Elements<'a> {
    fn iter(self) -> impl ExactSizeIterator<Item = &'a [u8]> {
        (0..self.count).map(move |i| &self.bytes[i * self.stride..][..self.size])
    }
}

/// What an accessor says of itself, checked.
#[derive(Clone, Copy)]
struct Header<'d> {
    number: usize,
    count: usize,
    kind: ComponentType,
    type_: Type,
    json: &'d Accessor,
}

impl Header<'_> {
    fn place(&self) -> String {
        format!("accessor {}", self.number)
    }

    fn expected(&self, what: &str) -> ImportError {
        ImportError::new(self.place(), what, format!("{:?} of {:?}", self.type_, self.kind))
    }
}

impl Document<'_> {
    /// All elements of an accessor of `type_` as `N` floats each. Normalised integers become fractions.
    pub(super) fn floats<const N: usize, T: From<[f32; N]> + Pod>(
        &mut self,
        index: Index<Accessor>,
        type_: Type,
    ) -> Result<Vec<T>, ImportError> {
        let header = self.header(index)?;
        let (place, count) = (header.place(), header.count);
        if !(header.type_ == type_ && type_.multiplicity() == N) {
            return Err(header.expected(&format!("{type_:?}")));
        }
        self.budget.take(count, size_of::<T>()).map_err(|exceeded| exceeded.at(&place))?;
        let header = self.header(index)?;
        let (kind, normalized) = (header.kind, header.json.normalized);
        let convert = |element: &[u8]| {
            let mut numbers = [0.0; N];
            for (number, bytes) in numbers.iter_mut().zip(element.chunks_exact(kind.size())) {
                *number = float(kind, normalized, bytes);
            }
            T::from(numbers)
        };
        let mut values: Vec<T> = match self.elements(&header)? {
            None => (0..count).map(|_| T::from([0.0; N])).collect(),
            // The common case, and the one that large files are made of: a copy of the bytes.
            Some(packed)
                if kind == ComponentType::F32 && packed.stride == 4 * N && cfg!(target_endian = "little") =>
            {
                let mut values = vec![T::zeroed(); count];
                bytemuck::cast_slice_mut(&mut values).copy_from_slice(&packed.bytes[..count * 4 * N]);
                values
            }
            Some(strided) if kind == ComponentType::F32 => {
                strided.iter().map(|element| T::from(packed_floats(element))).collect()
            }
            Some(elements) => elements.iter().map(convert).collect(),
        };
        if let Some(sparse) = &header.json.sparse {
            self.substitute(&header, sparse, &mut values, convert)?;
        }
        Ok(values)
    }

    /// All elements of a scalar accessor of integers.
    pub(super) fn indices(&mut self, index: Index<Accessor>) -> Result<Vec<u32>, ImportError> {
        let values = self.wholes::<1>(index, Type::Scalar)?;
        Ok(values.into_iter().map(|[value]| value).collect())
    }

    /// All elements of an accessor of `type_`, which has to consist of integers without a sign.
    pub(super) fn wholes<const N: usize>(
        &mut self,
        index: Index<Accessor>,
        type_: Type,
    ) -> Result<Vec<[u32; N]>, ImportError> {
        let header = self.header(index)?;
        let (place, count, kind) = (header.place(), header.count, header.kind);
        let integers = matches!(kind, ComponentType::U8 | ComponentType::U16 | ComponentType::U32);
        if !(header.type_ == type_ && type_.multiplicity() == N && integers && !header.json.normalized) {
            return Err(header.expected(&format!("{type_:?} of unsigned integers")));
        }
        self.budget.take(count, size_of::<[u32; N]>()).map_err(|exceeded| exceeded.at(&place))?;
        let header = self.header(index)?;
        let convert = |element: &[u8]| {
            let mut numbers = [0; N];
            for (number, bytes) in numbers.iter_mut().zip(element.chunks_exact(kind.size())) {
                *number = whole(kind, bytes).unwrap_or(0);
            }
            numbers
        };
        let mut values = match self.elements(&header)? {
            None => vec![[0; N]; count],
            Some(elements) => elements.iter().map(convert).collect(),
        };
        if let Some(sparse) = &header.json.sparse {
            self.substitute(&header, sparse, &mut values, convert)?;
        }
        Ok(values)
    }

    fn header(&self, index: Index<Accessor>) -> Result<Header<'_>, ImportError> {
        let number = index.value();
        let json = in_range("accessors", &self.root.accessors, number)?;
        let place = || format!("accessor {number}");
        let Checked::Valid(kind) = json.component_type else {
            return Err(ImportError::new(place(), "a component type from 5120 to 5126", "another one"));
        };
        let Checked::Valid(type_) = json.type_ else {
            return Err(ImportError::new(place(), "a type from SCALAR to MAT4", "another one"));
        };
        let count = usize::try_from(json.count.0)
            .map_err(|_| ImportError::new(place(), "a count that fits memory", json.count.0.to_string()))?;
        Ok(Header { number, count, kind: kind.0, type_, json })
    }

    /// The elements of an accessor; `None` where it has no data, which means zeros.
    fn elements(&self, header: &Header<'_>) -> Result<Option<Elements<'_>>, ImportError> {
        let Some(view) = header.json.buffer_view else { return Ok(None) };
        let view = self.view(view)?;
        let size = header.kind.size() * header.type_.multiplicity();
        let offset = header.json.byte_offset.unwrap_or_default().0;
        strided(&header.place(), view, offset, size, header.count).map(Some)
    }

    /// Puts the values of a sparse accessor in their places (section 3.6.2.3).
    fn substitute<T>(
        &self,
        header: &Header<'_>,
        sparse: &Sparse,
        values: &mut [T],
        convert: impl Fn(&[u8]) -> T,
    ) -> Result<(), ImportError> {
        let place = format!("accessor {}, sparse", header.number);
        let Checked::Valid(IndexComponentType(kind)) = sparse.indices.component_type else {
            return Err(ImportError::new(place, "indices of unsigned integers", "another component type"));
        };
        let count =
            usize::try_from(sparse.count.0).ok().filter(|count| *count <= values.len()).ok_or_else(|| {
                ImportError::new(
                    &place,
                    format!("at most {} values", values.len()),
                    sparse.count.0.to_string(),
                )
            })?;
        let indices = self.view(sparse.indices.buffer_view)?;
        let indices = strided(&place, indices, sparse.indices.byte_offset.0, kind.size(), count)?;
        let size = header.kind.size() * header.type_.multiplicity();
        let replacements = self.view(sparse.values.buffer_view)?;
        let replacements = strided(&place, replacements, sparse.values.byte_offset.0, size, count)?;
        let mut least = 0;
        for (nth, (index, replacement)) in indices.iter().zip(replacements.iter()).enumerate() {
            let index = whole(kind, index).unwrap_or(u32::MAX) as usize;
            if index < least || index >= values.len() {
                let expected = format!("an index from {least} to {}", values.len().saturating_sub(1));
                return Err(ImportError::new(format!("{place} index {nth}"), expected, index.to_string()));
            }
            values[index] = convert(replacement);
            least = index + 1;
        }
        Ok(())
    }
}

/// Floats of an element that is nothing but floats.
fn packed_floats<const N: usize>(element: &[u8]) -> [f32; N] {
    let mut numbers = [0.0; N];
    for (number, bytes) in numbers.iter_mut().zip(element.as_chunks().0) {
        *number = f32::from_le_bytes(*bytes);
    }
    numbers
}

fn strided<'a>(
    place: &str,
    view: View<'a>,
    offset: u64,
    size: usize,
    count: usize,
) -> Result<Elements<'a>, ImportError> {
    let stride = view.stride.unwrap_or(size);
    let in_view = || format!("{place} in bufferView {}", view.number);
    if stride < size {
        return Err(ImportError::new(
            in_view(),
            format!("a stride of at least {size} bytes"),
            stride.to_string(),
        ));
    }
    // One element after the other, the last one without what follows it.
    let length = match count {
        0 => Some(0),
        _ => (stride as u64).checked_mul(count as u64 - 1).and_then(|length| length.checked_add(size as u64)),
    };
    let available = (view.bytes.len() as u64).checked_sub(offset);
    match (available, length) {
        (Some(available), Some(length)) if length <= available => {
            Ok(Elements { bytes: &view.bytes[offset as usize..], stride, size, count })
        }
        _ => {
            let expected =
                format!("room for {count} elements of {size} bytes, {stride} apart, from byte {offset}");
            Err(ImportError::new(in_view(), expected, format!("{} bytes", view.bytes.len())))
        }
    }
}
