//! Sequences of OBJ files: one connectivity, a geometry for each time.

use super::{ObjFaces, ObjFile, read_obj};
use crate::Resolve;
use crate::text::stem;
use crate::{Channel, ChannelTarget, Clip, ImportError, Interpolation, Note, Scene};
use avatar_mesh::coherence::{self, FaceMatch, Faces, Geometry};
use avatar_mesh::{Mesh, Shape};
use glam::Vec3;
use std::ops::Range;

/// A clip has the square of this many weights at most.
const MAX_FRAMES: usize = 4096;

/// A file of a sequence.
#[derive(Clone, Copy, Debug)]
pub struct ObjFrame<'a> {
    /// Its name.
    pub file: &'a str,
    /// Its contents.
    pub bytes: &'a [u8],
    /// When, in seconds.
    pub time_secs: f32,
}

/// Reads files of the same vertices and faces as one scene: a shape for each frame, named like its file, and a clip that
/// goes from each to the next in a straight line. At rest it is the first in time. Materials are those of that one.
///
/// # Errors
/// No frames or too many, a time that is no number or comes twice, a file that is wrong or differs in its vertices or
/// faces.
pub fn read_sequence(frames: &[ObjFrame<'_>], resolve: &mut Resolve<'_>) -> Result<Scene, ImportError> {
    let mut order: Vec<&ObjFrame<'_>> = frames.iter().collect();
    if let Some(frame) = order.iter().find(|frame| !frame.time_secs.is_finite()) {
        let found = frame.time_secs.to_string();
        return Err(ImportError::new("its time", "a finite number of seconds", found).in_file(frame.file));
    }
    order.sort_by(|a, b| a.time_secs.total_cmp(&b.time_secs));
    if let Some(two) = order.windows(2).find(|two| two[0].time_secs == two[1].time_secs) {
        let expected = format!("another time than that of {}", two[0].file);
        return Err(
            ImportError::new("its time", expected, format!("{} s", two[1].time_secs)).in_file(two[1].file)
        );
    }
    let count = order.len();
    let Some(first) = order.first().filter(|_| count <= MAX_FRAMES) else {
        return Err(ImportError::new("the sequence", format!("1 to {MAX_FRAMES} files"), count.to_string()));
    };
    let mut base = read_obj(first.file, first.bytes, resolve)?;
    let mut names = std::collections::HashSet::new();
    for (number, frame) in order.iter().enumerate() {
        let name = stem(frame.file);
        let name = if names.insert(name) { name.to_owned() } else { format!("{name}.{number}") };
        if number == 0 {
            base.add_shape(&name, &[])?;
        } else {
            // Their materials are not used.
            base.add_shape_of(&name, &read_obj(frame.file, frame.bytes, &mut |_| Err(String::new()))?)?;
        }
    }
    let mut values = vec![0.0; count * count];
    values.iter_mut().step_by(count + 1).for_each(|own| *own = 1.0);
    let mut raw = base.into_raw();
    raw.clips.push(Clip {
        name: raw.nodes[0].name.clone(),
        channels: vec![Channel {
            node: 0,
            target: ChannelTarget::Weights,
            interpolation: Interpolation::Linear,
            times: order.iter().map(|frame| frame.time_secs).collect(),
            values,
        }],
    });
    Scene::from_raw(raw).map_err(|error| error.in_file(first.file))
}

impl ObjFile {
    /// Gives every part a shape that turns it into another file of the same vertices and faces, with its normals.
    ///
    /// # Errors
    /// Other vertices or faces, with both counts, or a shape of this name that is there already.
    pub fn add_shape_of(&mut self, name: &str, other: &ObjFile) -> Result<(), ImportError> {
        self.check_name(name)?;
        let base = self.geometry(&self.name);
        let same = coherence::check(base, other.geometry(name)).map_err(|error| {
            let (expected, found) = (error.mismatch.expected(), error.mismatch.found());
            let expected = format!("{expected}, as in {}", self.file);
            ImportError::new(format!("shape {name:?}"), expected, found).in_file(&other.file)
        })?;
        if same.is_warning() {
            self.notes.push(Note { place: other.file.clone(), text: same.to_string() });
        }
        let mut normals: Vec<Vec<Vec3>> =
            self.parts.iter().map(|part| vec![Vec3::ZERO; part.sources.len()]).collect();
        for (face, &part) in self.faces.parts.iter().enumerate() {
            let theirs = match &same {
                FaceMatch::Same => face,
                FaceMatch::Reordered { candidate_from_base, .. } => candidate_from_base[face] as usize,
            };
            let (ours, own) = (self.faces.range(face), &self.parts[part as usize].mesh);
            let (range, mesh) = (other.faces.range(theirs), other.mesh_of(theirs));
            let corners = ours.len();
            // From where a face reads the same, whatever corner it begins at.
            let [first, their_first] = [(&self.faces, &ours), (&other.faces, &range)]
                .map(|(faces, range)| coherence::first_corner(&faces.corners[range.clone()]));
            for k in 0..corners {
                let vertex = self.faces.vertices[ours.start + (first + k) % corners] as usize;
                let their_vertex = other.faces.vertices[range.start + (their_first + k) % corners] as usize;
                normals[part as usize][vertex] = mesh.normals[their_vertex] - own.normals[vertex];
            }
        }
        for (part, normals) in self.parts.iter_mut().zip(normals) {
            let offset = |&source: &u32| other.positions[source as usize] - self.positions[source as usize];
            let offsets: Vec<Vec3> = part.sources.iter().map(offset).collect();
            part.mesh.shapes.push(Shape::new(name, offsets).with_normals(normals));
        }
        Ok(())
    }

    fn geometry<'a>(&'a self, shape: &'a str) -> Geometry<'a> {
        let faces = Faces::Polygons { corners: &self.faces.corners, ends: &self.faces.ends };
        Geometry { file: &self.file, shape, positions: &self.positions, faces }
    }

    fn mesh_of(&self, face: usize) -> &Mesh {
        &self.parts[self.faces.parts[face] as usize].mesh
    }
}

impl ObjFaces {
    /// Where the corners of a face are.
    fn range(&self, face: usize) -> Range<usize> {
        let start = face.checked_sub(1).map_or(0, |before| self.ends[before]);
        start as usize..self.ends[face] as usize
    }
}
