//! Levels of detail: the same face with fewer triangles, for pictures in which it is small.

use crate::{FaceState, Pack, Part};
use avatar_mesh::{PartKind, Simplified, Simplifier, weld};
use glam::Vec3;
use std::collections::HashMap;

/// Poses that a level is made for, so that its memory is bounded; its error is measured in all of them.
const MOST_POSES: usize = 32;
/// A quarter of a pixel: less cannot be seen.
const PIXELS: f32 = 0.25;
/// Parts that come this close to each other, by the height of the face, must not come through each other.
const CLOSE: f32 = 0.02;

/// A face with fewer triangles, which deforms as the whole one does: same shapes, bones, controls and poses.
#[derive(Clone, Debug)]
pub struct Level {
    /// The pack with simplified meshes. Everything else is as before, the boxes around its parts, too.
    pub pack: Pack,
    /// How far the face is from the whole one at most, over all poses, in units of the world: the largest
    /// distance between a vertex that went and its place on the simplified surface.
    pub error: f32,
}

impl Level {
    /// For each level above 0 the height of the avatar in the picture, in pixels, up to which it is made.
    pub const HEIGHTS: [f32; 4] = [360.0, 180.0, 90.0, 45.0];

    /// The level for a picture in which a unit of the world, where the avatar is nearest, has `pixels`
    /// pixels. 0 is the pack itself. Nothing has to be made to answer this: each level's error is below a
    /// quarter of a pixel at its height, in all poses of a pack that has no more than 31 of them.
    pub fn for_pixels(pack: &Pack, pixels: f32) -> usize {
        let height = height(pack) * pixels;
        // Not a number: the whole face.
        Self::HEIGHTS.iter().take_while(|most| height <= **most).count()
    }

    /// Makes the level of this number; 0 is the pack itself, and numbers above the last are the last. The
    /// skin keeps its triangles where `is_haired`, since hair grows by them. This takes about a second for a
    /// face of 27,000 vertices.
    pub fn new(pack: &Pack, number: usize, is_haired: bool) -> Self {
        let most = Self::HEIGHTS.get(..number).map_or(Self::HEIGHTS.last(), <[f32]>::last);
        let level = most.and_then(|most| levels(pack, &[*most], is_haired).pop());
        level.unwrap_or_else(|| Self { pack: pack.clone(), error: 0.0 })
    }

    /// Makes all levels above 0, in about the time that the last of them takes alone.
    pub fn all(pack: &Pack, is_haired: bool) -> Vec<Self> {
        levels(pack, &Self::HEIGHTS, is_haired)
    }
}

/// The levels for these heights in pixels, which descend.
fn levels(pack: &Pack, heights: &[f32], is_haired: bool) -> Vec<Level> {
    let mut contents = pack.clone().into_contents();
    for part in &mut contents.parts {
        part.mesh = weld(&part.mesh).mesh;
    }
    // What was right before still is.
    let Ok(pack) = Pack::new(contents) else { return Vec::new() };
    let poses = Poses::of(&pack);
    let careful = careful(&pack, &poses, CLOSE * height(&pack));
    let mut simplifiers: Vec<Option<Simplifier<'_>>> = (pack.parts().iter().enumerate())
        .map(|(index, part)| {
            let posed: Vec<&[Vec3]> = poses.of_part(index).collect();
            let is_kept = is_haired && part.kind == PartKind::Skin;
            (!is_kept).then(|| Simplifier::new(&part.mesh, &posed, &careful[index]))
        })
        .collect();
    let level = |most: &f32| {
        let limit = PIXELS / most * height(&pack);
        let simplified: Vec<Option<Simplified>> = (simplifiers.iter_mut())
            .map(|simplifier| {
                let simplifier = simplifier.as_mut()?;
                simplifier.run(limit);
                Some(simplifier.simplified())
            })
            .collect();
        let error = error(&pack, &simplified);
        let mut level = pack.clone();
        level.set_meshes(simplified.into_iter().map(|simplified| simplified.map(|one| one.mesh)));
        Level { pack: level, error }
    };
    heights.iter().map(level).collect()
}

/// Of the box around the avatar.
fn height(pack: &Pack) -> f32 {
    pack.bounds().map_or(0.0, |bounds| bounds.size().y)
}

fn is_still(part: &Part) -> bool {
    part.bone.is_some() && part.mesh.shapes.is_empty()
}

/// The values of the controls in the pack's poses, at rest first.
fn values(pack: &Pack) -> Vec<Vec<f32>> {
    let defaults = pack.controls().defaults();
    let of_poses = pack.poses().iter().map(|pose| {
        let mut values = defaults.clone();
        pose.values.iter().for_each(|&(control, value)| values[control] = value);
        values
    });
    std::iter::once(defaults.clone()).chain(of_poses).collect()
}

fn positions(pack: &Pack, state: &FaceState, part: usize) -> Vec<Vec3> {
    state.deform(pack, part).map(|deformed| deformed.positions).unwrap_or_default()
}

/// Where the vertices are in some poses spread over all of them, at rest first.
struct Poses {
    /// Of each pose, of each part.
    positions: Vec<Vec<Vec<Vec3>>>,
    /// Parts whose vertices keep their distances: one pose says all.
    still: Vec<bool>,
}

impl Poses {
    fn of(pack: &Pack) -> Self {
        let all = values(pack);
        let step = all.len().div_ceil(MOST_POSES).max(1);
        let mut state = FaceState::new(pack);
        let pose = |values: &Vec<f32>| {
            // Values of the right number: nothing fails; what did would count as before.
            let _ = state.pose(pack, values);
            (0..pack.parts().len()).map(|part| positions(pack, &state, part)).collect()
        };
        let positions = all.iter().step_by(step).map(pose).collect();
        Self { positions, still: pack.parts().iter().map(is_still).collect() }
    }

    fn of_part(&self, part: usize) -> impl Iterator<Item = &[Vec3]> {
        let count = if self.still.get(part) == Some(&true) { 1 } else { usize::MAX };
        self.positions.iter().take(count).filter_map(move |parts| parts.get(part).map(Vec::as_slice))
    }
}

/// Of each part the vertices that come close to another part in one of the poses.
fn careful(pack: &Pack, poses: &Poses, close: f32) -> Vec<Vec<bool>> {
    let count = |part: &Part| vec![false; part.mesh.positions.len()];
    let mut careful: Vec<Vec<bool>> = pack.parts().iter().map(count).collect();
    let cell = |place: Vec3| (place / close).floor().to_array().map(|x| x as i32);
    for parts in &poses.positions {
        // Of each cell the part that comes near it; `None` where several do.
        let mut near: HashMap<[i32; 3], Option<usize>> = HashMap::new();
        for (part, positions) in parts.iter().enumerate() {
            let mut cells: Vec<[i32; 3]> = positions.iter().map(|place| cell(*place)).collect();
            cells.sort_unstable();
            cells.dedup();
            for [x, y, z] in cells {
                let steps =
                    (-1..=1).flat_map(|x| (-1..=1).flat_map(move |y| (-1..=1).map(move |z| [x, y, z])));
                for [dx, dy, dz] in steps {
                    let beside = [x.saturating_add(dx), y.saturating_add(dy), z.saturating_add(dz)];
                    let owner = near.entry(beside).or_insert(Some(part));
                    *owner = owner.filter(|owner| *owner == part);
                }
            }
        }
        for (marks, positions) in careful.iter_mut().zip(parts) {
            for (mark, place) in marks.iter_mut().zip(positions) {
                *mark |= near.get(&cell(*place)) == Some(&None);
            }
        }
    }
    careful
}

/// The largest error of any part in any pose; one pose is in memory at a time.
fn error(pack: &Pack, simplified: &[Option<Simplified>]) -> f32 {
    let mut state = FaceState::new(pack);
    let mut worst = 0.0f32;
    for values in values(pack) {
        let _ = state.pose(pack, &values);
        for (part, simplified) in simplified.iter().enumerate() {
            if let Some(simplified) = simplified {
                worst = worst.max(simplified.error(&positions(pack, &state, part)));
            }
        }
    }
    worst
}
