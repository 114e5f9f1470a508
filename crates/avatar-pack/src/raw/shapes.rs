use super::RawError;
use crate::Pack;
use crate::import::face_control;
use avatar_mesh::FACE_SHAPES;
use pose_anim::Drive;
use std::collections::HashSet;

/// Which shapes of an avatar take the two places of the format. Shapes of one name are one.
pub(super) struct Places<'a> {
    names: [Option<&'a str>; FACE_SHAPES.len()],
}

impl<'a> Places<'a> {
    /// Shapes of the format's own names take their places; others the free ones. Shapes that move nothing, or
    /// that nothing moves, need none.
    pub(super) fn of(pack: &'a Pack) -> Result<Self, RawError> {
        let mut moves = vec![false; pack.shapes().len()];
        for part in pack.parts() {
            for (moves, shape) in moves[part.shapes()].iter_mut().zip(&part.mesh.shapes) {
                *moves |= shape.moved_vertices() > 0;
            }
        }
        let driven = pack.controls().controls().iter().filter_map(|control| match &control.drives {
            Drive::Shape { shape } => Some(shape.as_str()),
            Drive::Joint { .. } => None,
        });
        let mut driven: HashSet<&str> = driven.collect();
        let shapes = pack.shapes().iter().zip(moves).filter(|(_, moves)| *moves);
        // Several shapes of one name count once.
        let mut moving: Vec<&str> =
            shapes.map(|(name, _)| name.as_str()).filter(|name| driven.remove(name)).collect();
        if moving.len() > FACE_SHAPES.len() {
            return Err(RawError::TooManyShapes { found: moving.into_iter().map(str::to_owned).collect() });
        }
        let mut names = [None; FACE_SHAPES.len()];
        let is_own = |place: usize, name: &str| {
            FACE_SHAPES[place] == name || face_control(name) == face_control(FACE_SHAPES[place])
        };
        for (place, slot) in names.iter_mut().enumerate() {
            if let Some(own) = moving.iter().position(|name| is_own(place, name)) {
                *slot = Some(moving.remove(own));
            }
        }
        let free = names.iter_mut().filter(|slot| slot.is_none());
        free.zip(moving).for_each(|(slot, name)| *slot = Some(name));
        Ok(Self { names })
    }

    /// The place of the shape of this name. The format's own names are always there.
    pub(super) fn place(&self, shape: &str) -> Option<usize> {
        let taken = self.names.iter().position(|name| *name == Some(shape));
        taken.or_else(|| {
            let own = FACE_SHAPES.iter().position(|name| *name == shape)?;
            self.names[own].is_none().then_some(own)
        })
    }
}
