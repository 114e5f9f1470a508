//! Sequences of OBJ files: one connectivity, a geometry for each time.

use super::{ObjFile, read_obj};
use crate::Resolve;
use crate::text::stem;
use crate::{Channel, ChannelTarget, Clip, ImportError, Interpolation, Note, Scene};
use avatar_mesh::Shape;
use avatar_mesh::coherence::{self, FaceMatch, Geometry};
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
        let base = Geometry {
            file: &self.file,
            shape: &self.name,
            positions: &self.positions,
            triangles: &self.triangles,
        };
        let candidate = Geometry {
            file: &other.file,
            shape: name,
            positions: &other.positions,
            triangles: &other.triangles,
        };
        let same = coherence::check(base, candidate).map_err(|error| {
            let expected = format!("the vertices and faces of {}", self.file);
            ImportError::new(format!("shape {name:?}"), expected, error.to_string()).in_file(&other.file)
        })?;
        if same.is_warning() {
            self.notes.push(Note { place: other.file.clone(), text: same.to_string() });
        }
        let mut normals: Vec<Vec<Vec3>> =
            self.parts.iter().map(|part| vec![Vec3::ZERO; part.sources.len()]).collect();
        for (number, (&[part, triangle], corners)) in self.places.iter().zip(&self.triangles).enumerate() {
            let theirs = match &same {
                FaceMatch::Same => number,
                FaceMatch::Reordered { candidate_from_base, .. } => candidate_from_base[number] as usize,
            };
            let mesh = &self.parts[part as usize].mesh;
            for (corner, &vertex) in mesh.triangles[triangle as usize].iter().enumerate() {
                let turned = other.triangles[theirs].iter().position(|position| *position == corners[corner]);
                let normal = other.normal_at(theirs, turned.unwrap_or(corner));
                normals[part as usize][vertex as usize] = normal - mesh.normals[vertex as usize];
            }
        }
        for (part, normals) in self.parts.iter_mut().zip(normals) {
            let offset = |&source: &u32| other.positions[source as usize] - self.positions[source as usize];
            let offsets: Vec<Vec3> = part.sources.iter().map(offset).collect();
            part.mesh.shapes.push(Shape::new(name, offsets).with_normals(normals));
        }
        Ok(())
    }

    /// The normal at a corner of a triangle in the order of the file.
    fn normal_at(&self, triangle: usize, corner: usize) -> Vec3 {
        let [part, triangle] = self.places[triangle];
        let mesh = &self.parts[part as usize].mesh;
        mesh.normals[mesh.triangles[triangle as usize][corner] as usize]
    }
}
