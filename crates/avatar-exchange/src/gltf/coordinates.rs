//! Which texture coordinates of a file become the two sets of a mesh.

use crate::scene::UvSet;
use glam::Vec2;

/// `KHR_texture_transform`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct UvTransform {
    pub(super) offset: Vec2,
    pub(super) rotation_rad: f32,
    pub(super) scale: Vec2,
}

impl UvTransform {
    pub(super) const NONE: Self = Self { offset: Vec2::ZERO, rotation_rad: 0.0, scale: Vec2::ONE };

    /// Scaled, then turned clockwise as the origin is at the top, then moved.
    pub(super) fn apply(&self, uv: Vec2) -> Vec2 {
        let (sin, cos) = self.rotation_rad.sin_cos();
        let scaled = uv * self.scale;
        Vec2::new(cos * scaled.x + sin * scaled.y, cos * scaled.y - sin * scaled.x) + self.offset
    }
}

/// Where the coordinates of a texture come from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct UvSource {
    /// The number of `TEXCOORD_n`.
    pub(super) set: u32,
    pub(super) transform: Option<UvTransform>,
}

impl UvSource {
    pub(super) const fn plain(set: u32) -> Self {
        Self { set, transform: None }
    }
}

/// The coordinates that a material's textures need, for the first and second texture coordinates of meshes.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Looks {
    sources: [Option<UvSource>; 2],
}

impl Looks {
    /// The first two of these that differ. Plain sets have places of their own, so that a material without
    /// transforms leaves the coordinates of meshes as they are.
    pub(super) fn of(used: impl Iterator<Item = UvSource>) -> Self {
        let mut chosen: Vec<UvSource> = Vec::with_capacity(2);
        for source in used {
            if chosen.len() < 2 && !chosen.contains(&source) {
                chosen.push(source);
            }
        }
        let is_at_home = match chosen[..] {
            [first, second] => second != UvSource::plain(0) && first != UvSource::plain(1),
            [only] => only != UvSource::plain(1),
            _ => true,
        };
        let mut sources = [chosen.first().copied(), chosen.get(1).copied()];
        if !is_at_home {
            sources.reverse();
        }
        Self { sources }
    }

    pub(super) fn place_of(&self, source: UvSource) -> Option<UvSet> {
        match self.sources.iter().position(|known| *known == Some(source))? {
            0 => Some(UvSet::First),
            _ => Some(UvSet::Second),
        }
    }

    /// Where the first texture coordinates of a mesh come from, and whether any texture needs them.
    pub(super) fn first(&self) -> (UvSource, bool) {
        (self.sources[0].unwrap_or(UvSource::plain(0)), self.sources[0].is_some())
    }

    /// The same of the second.
    pub(super) fn second(&self) -> (UvSource, bool) {
        (self.sources[1].unwrap_or(UvSource::plain(1)), self.sources[1].is_some())
    }
}
