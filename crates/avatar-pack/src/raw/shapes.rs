use crate::import::face_control;
use crate::{FurtherShape, FurtherShapes, Pack, ShapeWeight};
use avatar_mesh::FACE_SHAPES;
use pose_anim::Drive;
use std::collections::{HashMap, HashSet};

/// Where the shapes of an avatar stand in the files: in the two places of the skin's vertices, or among the
/// further shapes. Shapes of one name are one.
pub(super) struct Places<'a> {
    names: [Option<&'a str>; FACE_SHAPES.len()],
    /// What `shapes.toml` will say; the parts of shapes that it did not say before are still missing.
    pub(super) list: FurtherShapes,
    /// By the names that further shapes have in the avatar their positions in the list.
    further: HashMap<&'a str, usize>,
    /// Names of the mixtures, which keep them.
    mixtures: HashSet<&'a str>,
}

/// A place of a shape.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Place {
    /// Of the two in the vertices of the skin.
    Skin(usize),
    /// Among the further shapes.
    Further(usize),
}

impl<'a> Places<'a> {
    /// Shapes of the format's own names take their places. Up to two others take the free ones; if they do
    /// not all fit there, all others are further shapes. Shapes that move nothing, or that nothing moves,
    /// need none.
    pub(super) fn of(pack: &'a Pack) -> Self {
        if let Some(list) = pack.further_shapes() {
            let further = list.shapes.iter().zip(0..).map(|(shape, place)| (shape.name.as_str(), place));
            let further = further.collect();
            let mixtures = list.mixtures.iter().map(|mixture| mixture.name.as_str()).collect();
            return Self { names: FACE_SHAPES.map(Some), list: list.clone(), further, mixtures };
        }
        let mut moving = moving(pack);
        let mut names = [None; FACE_SHAPES.len()];
        let is_own = |place: usize, name: &str| {
            FACE_SHAPES[place] == name || face_control(name) == face_control(FACE_SHAPES[place])
        };
        let all_fit = moving.len() <= FACE_SHAPES.len();
        for (place, slot) in names.iter_mut().enumerate() {
            if let Some(own) = moving.iter().position(|name| is_own(place, name)) {
                *slot = Some(moving.remove(own));
            }
        }
        if all_fit {
            let free = names.iter_mut().filter(|slot| slot.is_none());
            free.zip(moving.drain(..)).for_each(|(slot, name)| *slot = Some(name));
        }
        let further = moving.iter().zip(0..).map(|(name, place)| (*name, place)).collect();
        let list = FurtherShapes { shapes: further_shapes(pack, &moving), ..FurtherShapes::default() };
        Self { names, list, further, mixtures: HashSet::new() }
    }

    /// The place of the shape of this name. The format's own names are always there.
    pub(super) fn place(&self, shape: &str) -> Option<Place> {
        if let Some(place) = self.further.get(shape) {
            return Some(Place::Further(*place));
        }
        let taken = self.names.iter().position(|name| *name == Some(shape));
        let place = taken.or_else(|| {
            let own = FACE_SHAPES.iter().position(|name| *name == shape)?;
            self.names[own].is_none().then_some(own)
        });
        place.map(Place::Skin)
    }

    /// What a control drives in the files that drives this in the avatar: a shape, or a mixture.
    pub(super) fn driven(&self, shape: &str) -> Option<&str> {
        match self.place(shape) {
            Some(Place::Skin(place)) => FACE_SHAPES.get(place).copied(),
            Some(Place::Further(place)) => self.list.shapes.get(place).map(|shape| shape.name.as_str()),
            None => self.mixtures.get(shape).copied(),
        }
    }
}

/// Names of the shapes that move something and that a control drives, each once.
fn moving(pack: &Pack) -> Vec<&str> {
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
    shapes.map(|(name, _)| name.as_str()).filter(|name| driven.remove(name)).collect()
}

/// Further shapes of these names, each with a name of its own that no control of another shape has.
fn further_shapes(pack: &Pack, names: &[&str]) -> Vec<FurtherShape> {
    let mut taken: HashSet<String> = FACE_SHAPES.into_iter().map(str::to_owned).collect();
    let is_of_other = |name: &str, shape: &str| {
        let control = pack.controls().index(name).and_then(|index| pack.controls().controls().get(index));
        control.is_some_and(|control| control.drives != Drive::Shape { shape: shape.to_owned() })
    };
    let further = |shape: &&str| {
        let mut name = (*shape).to_owned();
        while is_of_other(&name, shape) || !taken.insert(name.clone()) {
            name.push('\'');
        }
        FurtherShape { name, group: None, side: None, parts: Vec::new(), weight: ShapeWeight::Control }
    };
    names.iter().map(further).collect()
}
