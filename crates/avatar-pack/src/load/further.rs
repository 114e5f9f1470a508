//! Shapes beside the two of the format: `shapes.toml` and `shapes.raw`.

use super::{at, read_needed, read_text};
use crate::files;
use crate::{FurtherShapes, PackError, PackProblem, Part, Sliders, Source};
use avatar_mesh::FACE_SHAPES;
use avatar_mesh::raw_shapes::Reader;
use pose_anim::ControlTable;

/// The shapes of a pack and what moves them.
pub(super) struct Further {
    /// Names of all shapes, those of each part one after the other.
    pub(super) names: Vec<String>,
    pub(super) sliders: Option<Sliders>,
    pub(super) list: Option<FurtherShapes>,
}

/// Gives the parts their further shapes, and the controls those of shapes and mixtures.
pub(super) fn load(
    source: &impl Source,
    controls: &mut ControlTable,
    parts: &mut [Part],
) -> Result<Further, PackError> {
    let file = files::SHAPES;
    let Some(text) = read_text(source, file)? else {
        let names = FACE_SHAPES.map(str::to_owned).into();
        return Ok(Further { names, sliders: None, list: None });
    };
    let list = FurtherShapes::from_toml(&text, controls)
        .map_err(|error| at(source, file, PackProblem::Toml(error)))?;
    *controls =
        list.add_controls(controls).map_err(|error| at(source, file, PackProblem::Controls(error)))?;
    if !list.shapes.is_empty() {
        read_offsets(source, &list, parts)?;
    }
    let mut names: Vec<String> = Vec::new();
    for part in parts.iter_mut() {
        part.first_shape = names.len();
        names.extend(part.mesh.shapes.iter().map(|shape| shape.name.clone()));
    }
    let sliders =
        list.sliders(controls, &names).map_err(|error| at(source, file, PackProblem::Drivers(error)))?;
    Ok(Further { names, sliders: Some(sliders), list: Some(list) })
}

fn read_offsets(source: &impl Source, list: &FurtherShapes, parts: &mut [Part]) -> Result<(), PackError> {
    let file = files::SHAPES_RAW;
    let bytes = read_needed(source, file)?;
    let blame = |error| at(source, file, PackProblem::RawShapes(error));
    let mut reader = Reader::new(&bytes);
    for shape in &list.shapes {
        // In the order of the text; its reader knows the parts' names.
        for name in &shape.parts {
            let Some(part) = parts.iter_mut().find(|part| part.name == *name) else { continue };
            let left = reader.left();
            part.mesh.shapes.push(reader.read(&shape.name, part.mesh.positions.len()).map_err(blame)?);
            part.bytes += left - reader.left();
        }
    }
    reader.finish().map_err(blame)
}
