//! From texture pixels to places on the face.

use glam::{DVec2, DVec3};

use super::picture::Picture;
use crate::{
    layout,
    skin::Skin,
    surface::half::{Node, Patch},
};

/// What a pixel of a skin texture shows.
#[derive(Clone, Copy, Debug)]
pub struct Site {
    /// Place at rest; on the character's right `x` is negative.
    pub p: DVec3,
    /// Normal at rest.
    pub normal: DVec3,
    /// The interpolated vertex of the left half.
    pub node: Node,
    /// Whether it is the cloth of the top.
    pub cloth: bool,
    /// Numbers of the left half's vertices around the place, and their shares.
    pub around: [(usize, f64); 3],
    /// Change of the place with the texture coordinates, across and down the picture.
    pub per_uv: [DVec3; 2],
}

impl Site {
    /// A value known at the left half's vertices.
    #[must_use]
    pub fn mix(&self, values: &[f64]) -> f64 {
        self.around.iter().map(|(i, share)| values[*i] * share).sum()
    }
}

/// For every pixel the triangle that it shows, if any; pixels beside the islands repeat the nearest of them.
#[derive(Debug)]
pub struct Sites<'a> {
    skin: &'a Skin,
    side: usize,
    owner: Vec<u32>,
    /// Pixels beside an island, each with the island's pixel that it repeats.
    spill: Vec<(u32, u32)>,
}

const NOBODY: u32 = u32::MAX;

impl<'a> Sites<'a> {
    /// Draws the skin's triangles into a square picture of texture coordinates.
    #[must_use]
    pub fn of(skin: &'a Skin, side: usize) -> Self {
        let mut owner = vec![NOBODY; side * side];
        for (number, t) in (0..).zip(&skin.triangles) {
            let uv = t.map(|i| skin.vertices[i as usize].uv * side as f64);
            let low = uv[0].min(uv[1]).min(uv[2]).floor().max(DVec2::ZERO);
            let high = uv[0].max(uv[1]).max(uv[2]).ceil().min(DVec2::splat(side as f64 - 1.0));
            for y in low.y as usize..=high.y as usize {
                for x in low.x as usize..=high.x as usize {
                    if shares(&uv, x, y).is_some_and(|s| s.iter().all(|s| *s >= -1e-9)) {
                        owner[y * side + x] = number;
                    }
                }
            }
        }
        let spill = spill(&owner, side, side / 16);
        Self { skin, side, owner, spill }
    }

    /// What a pixel shows, if it lies on an island.
    fn site(&self, pixel: usize) -> Option<Site> {
        let t = self.skin.triangles.get(self.owner[pixel] as usize)?;
        let v = t.map(|i| &self.skin.vertices[i as usize]);
        let nodes = v.map(|v| self.skin.half.nodes[v.source]);
        let lead = nodes.iter().find(|n| n.patch != Patch::Sheet).copied().unwrap_or(nodes[0]);
        let uv = v.map(|v| v.uv * self.side as f64);
        let share = shares(&uv, pixel % self.side, pixel / self.side)?;
        let mix = |f: &dyn Fn(usize) -> f64| (0..3).map(|k| share[k] * f(k)).sum::<f64>();
        let mix3 = |f: &dyn Fn(usize) -> DVec3| (0..3).fold(DVec3::ZERO, |sum, k| sum + share[k] * f(k));
        let p = mix3(&|k| v[k].p);
        let node = Node {
            p: DVec3::new(p.x.abs(), p.y, p.z),
            lower: nodes.iter().filter(|n| n.lower).count() >= 2,
            lip: mix(&|k| nodes[k].lip),
            lid: mix(&|k| nodes[k].lid),
            own: DVec2::new(mix(&|k| nodes[k].own.x), mix(&|k| nodes[k].own.y)),
            ..lead
        };
        let (a, b) = (v[1].uv - v[0].uv, v[2].uv - v[0].uv);
        let (pa, pb) = (v[1].p - v[0].p, v[2].p - v[0].p);
        let area = a.perp_dot(b);
        Some(Site {
            p,
            normal: mix3(&|k| v[k].normal).normalize_or_zero(),
            node,
            cloth: layout::is_cloth(&nodes),
            around: [(v[0].source, share[0]), (v[1].source, share[1]), (v[2].source, share[2])],
            per_uv: [(pa * b.y - pb * a.y) / area, (pb * a.x - pa * b.x) / area],
        })
    }

    /// Paints every pixel that shows something and lets colours run over the borders of the islands; the rest
    /// gets `empty`.
    #[must_use]
    pub fn paint(&self, empty: DVec3, colour: impl Fn(&Site) -> DVec3) -> Picture {
        let mut pixels: Vec<DVec3> =
            (0..self.owner.len()).map(|i| self.site(i).map_or(empty, |site| colour(&site))).collect();
        for (to, from) in &self.spill {
            pixels[*to as usize] = pixels[*from as usize];
        }
        Picture { width: self.side, pixels }
    }
}

/// A pixel's middle as a mixture of a triangle's corners.
fn shares(uv: &[DVec2; 3], x: usize, y: usize) -> Option<[f64; 3]> {
    let area = (uv[1] - uv[0]).perp_dot(uv[2] - uv[0]);
    let at = DVec2::new(x as f64 + 0.5, y as f64 + 0.5);
    let b = (at - uv[0]).perp_dot(uv[2] - uv[0]) / area;
    let c = (uv[1] - uv[0]).perp_dot(at - uv[0]) / area;
    (area != 0.0).then_some([1.0 - b - c, b, c])
}

/// Grows the islands ring by ring: small mip levels mix far neighbours, at the crown above all, and must find
/// the island's own colours there.
fn spill(owner: &[u32], side: usize, rings: usize) -> Vec<(u32, u32)> {
    let mut source: Vec<u32> = (0..).zip(owner).map(|(i, o)| if *o == NOBODY { NOBODY } else { i }).collect();
    let mut found = Vec::new();
    for _ in 0..rings {
        let first = found.len();
        for i in 0..side * side {
            if source[i] != NOBODY {
                continue;
            }
            let (x, y) = (i % side, i / side);
            let beside = [
                (x > 0).then(|| i - 1),
                (x + 1 < side).then(|| i + 1),
                (y > 0).then(|| i - side),
                (y + 1 < side).then(|| i + side),
            ];
            if let Some(from) = beside.into_iter().flatten().map(|j| source[j]).find(|s| *s != NOBODY) {
                found.push((i as u32, from));
            }
        }
        for (to, from) in &found[first..] {
            source[*to as usize] = *from;
        }
    }
    found
}
