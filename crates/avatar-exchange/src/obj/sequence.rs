//! Sequences of OBJ files: one connectivity, a geometry for each time.

use super::{ObjFile, read_obj};
use crate::build::budget::{Budget, Exceeded};
use crate::build::names::unique_names;
use crate::build::text::stem;
use crate::scene::{Channel, ChannelTarget, Clip, Finding, ImportError, Interpolation, Note, Resolve, Scene};
use avatar_mesh::Shape;
use avatar_mesh::coherence::{self, FaceMatch, Faces, Geometry};
use glam::Vec3;

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
    pub time_secs: f64,
}

/// Reads files of the same vertices and faces as one scene: a shape for each frame, named like its file, and
/// a clip that goes from each to the next in a straight line. At rest it is the first in time. Materials are
/// those of that one.
///
/// # Errors
/// No frames or too many, a time that is not finite or comes twice, a file that is wrong or differs in its
/// vertices or faces.
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
    let names = unique_names(order.iter().map(|frame| stem(frame.file).to_owned()).collect());
    let bytes = order.iter().map(|frame| frame.bytes.len()).sum();
    let vertices: usize = base.parts.iter().map(|part| part.mesh.positions.len()).sum();
    let too_much = |exceeded: Exceeded| exceeded.at("the sequence").in_file(first.file);
    Budget::of_vertices(bytes).take(vertices, count).map_err(too_much)?;
    for (number, (frame, name)) in order.iter().zip(names).enumerate() {
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
    /// Gives every part a shape that turns it into another file of the same vertices and faces, with its
    /// normals.
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
            self.notes.push(Note::new(other.file.as_str(), Finding::Mended(same.to_string())));
        }
        let mut normals: Vec<Vec<Vec3>> =
            self.parts.iter().map(|part| vec![Vec3::ZERO; part.sources.len()]).collect();
        for (face, &part) in self.faces.parts.iter().enumerate() {
            let theirs = match &same {
                FaceMatch::Same => Some(face),
                FaceMatch::Reordered { candidate_from_base, .. } => {
                    candidate_from_base.get(face).map(|place| *place as usize)
                }
            };
            let theirs = theirs.and_then(|theirs| other.around(theirs));
            let Some((ours, theirs)) = self.around(face).zip(theirs) else { continue };
            let normals = normals.get_mut(part as usize).map_or(&mut [][..], Vec::as_mut_slice);
            for ((vertex, own), (_, normal)) in ours.zip(theirs) {
                normals.get_mut(vertex).into_iter().for_each(|change| *change = normal - own);
            }
        }
        for (part, normals) in self.parts.iter_mut().zip(normals) {
            let [theirs, own] = [&other.positions, &self.positions]
                .map(|positions| |source: u32| positions.get(source as usize).copied().unwrap_or_default());
            let offset = |source: &u32| theirs(*source) - own(*source);
            let offsets: Vec<Vec3> = part.sources.iter().map(offset).collect();
            part.mesh.shapes.push(Shape::new(name, offsets).with_normals(normals));
        }
        Ok(())
    }

    fn geometry<'a>(&'a self, shape: &'a str) -> Geometry<'a> {
        let faces = Faces::Polygons { corners: &self.faces.corners, ends: &self.faces.ends };
        Geometry { file: &self.file, shape, positions: &self.positions, faces }
    }

    /// The vertices around a face and their normals, from where it reads the same whatever corner it begins
    /// at.
    fn around(&self, face: usize) -> Option<impl Iterator<Item = (usize, Vec3)>> {
        let corners = self.geometry("").faces.corners(face);
        let end = *self.faces.ends.get(face)? as usize;
        let vertices = self.faces.vertices.get(end.checked_sub(corners.len())?..end)?;
        let mesh = &self.parts.get(*self.faces.parts.get(face)? as usize)?.mesh;
        let (last, first) = vertices.split_at_checked(coherence::first_corner(corners))?;
        let vertices = first.iter().chain(last).map(|vertex| *vertex as usize);
        Some(vertices.filter_map(|vertex| Some((vertex, *mesh.normals.get(vertex)?))))
    }
}
