use super::surface::{Around, Ring, Surface};
use super::{CARE, MOST_TRIANGLES};
use crate::{Bounds, Mesh};
use glam::{Vec2, Vec3};
use std::cmp::Ordering;

/// A normal that is off by this much of its length counts as a distance of this share of the mesh's diagonal
/// in the first pose.
const NORMAL_SHARE: f32 = 0.01;
/// The least cosine between a triangle before and after a collapse, in the first pose.
const LEAST_COSINE: f32 = 0.2;
/// A first look at what a collapse costs goes by every so many poses.
const POSE_STEP: usize = 4;

/// Where a vertex that went lies: a triangle and the shares of its corners.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    pub(super) triangle: u32,
    pub(super) shares: [f32; 3],
}

/// What collapses cost.
#[derive(Clone, Debug)]
pub(super) struct Costs<'a> {
    mesh: &'a Mesh,
    careful: Vec<bool>,
    /// Length on the surface for one unit of each set of texture coordinates, about.
    length_per_uv: [f32; 2],
    /// Length that a normal's deviation counts for.
    length_per_normal: f32,
    /// Of each vertex that went its place.
    places: Vec<Option<Place>>,
    /// Of each triangle the vertices that went and lie on it.
    lying: Vec<Vec<u32>>,
    /// Of each vertex whether it lies on a cut, where it has to stay.
    on_cut: Vec<bool>,
}

/// A collapse, taken apart.
struct Collapse {
    target: u32,
    /// Triangles that vanish.
    gone: Vec<Around>,
    kept: Vec<Kept>,
}

/// A triangle that stays and gets the vertex `to` in the place of its vertex at the point.
struct Kept {
    old: Around,
    to: u32,
}

impl<'a> Costs<'a> {
    pub(super) fn new(mesh: &'a Mesh, surface: &Surface, careful: &[bool]) -> Self {
        let length_per_uv = |uvs: &[Vec2]| {
            let (mut area, mut uv_area) = (0.0f64, 0.0f64);
            for triangle in surface.triangles() {
                let [a, b, c] = triangle.map(|vertex| surface.place_of(vertex));
                let on_surface = f64::from((b - a).cross(c - a).length());
                let [a, b, c] = triangle.map(|vertex| uv(uvs, vertex));
                let on_texture = f64::from((b - a).perp_dot(c - a).abs());
                if on_surface.is_finite() && on_texture.is_finite() {
                    (area, uv_area) = (area + on_surface, uv_area + on_texture);
                }
            }
            let ratio = (area / uv_area).sqrt() as f32;
            if ratio.is_finite() { ratio } else { 0.0 }
        };
        let count = mesh.positions.len();
        let mut on_cut = vec![false; count];
        for point in 0..surface.point_count() as u32 {
            let is_cut = |other| surface.is_cut(point, other);
            let stays = surface.degree(point) > MOST_TRIANGLES;
            if stays || surface.neighbours(point).into_iter().any(is_cut) {
                surface.vertices_of(point).iter().for_each(|vertex| on_cut[*vertex as usize] = true);
            }
        }
        let places = (0..count as u32).map(|vertex| surface.place_of(vertex));
        let places: Vec<Vec3> = places.filter(|place| place.is_finite()).collect();
        let diagonal = Bounds::of(&places).map_or(0.0, |bounds| bounds.size().length());
        Self {
            mesh,
            careful: (0..count).map(|vertex| careful.get(vertex).copied().unwrap_or(false)).collect(),
            length_per_uv: [&mesh.uvs, &mesh.uvs_1].map(|uvs| length_per_uv(uvs)),
            length_per_normal: diagonal * NORMAL_SHARE,
            places: vec![None; count],
            lying: vec![Vec::new(); surface.triangle_count()],
            on_cut,
        }
    }

    /// The points around a point. One that was on no cut never comes onto one, since cuts keep their course.
    pub(super) fn ring(&self, surface: &Surface, point: u32) -> Ring {
        let is_on_cut = surface.vertices_of(point).iter().any(|vertex| self.on_cut[*vertex as usize]);
        Ring::of(surface, point, is_on_cut)
    }

    /// The vertices that went, with their places.
    pub(super) fn places(&self) -> impl Iterator<Item = (u32, Place)> + '_ {
        (0..).zip(&self.places).filter_map(|(vertex, place)| Some((vertex, (*place)?)))
    }

    /// What it costs to collapse the edge from a point to a target; `None` where that would change the
    /// topology, open a cut, fold the surface or cost more than `most`. `is_whole` counts the vertices that
    /// went before, too, and looks at all poses instead of some.
    pub(super) fn of(
        &self,
        surface: &Surface,
        ring: &Ring,
        target: u32,
        is_whole: bool,
        most: f32,
    ) -> Option<f32> {
        let collapse = taken_apart(surface, ring, target)?;
        let step = if is_whole { 1 } else { POSE_STEP };
        let is_folded = || collapse.kept.iter().any(|kept| folds(surface, kept, step));
        // What is more likely to say no, or takes less time, comes first.
        if is_whole && is_folded() {
            return None;
        }
        let mut worst = 0.0f32;
        for vertex in self.moved(surface, ring.point, &collapse, is_whole) {
            let (corners, place) = self.placed(surface, ring, &collapse, vertex)?;
            worst = larger(worst, self.error(surface, vertex, corners, place.shares, step));
            // Neither what costs more nor what costs no number.
            if worst.partial_cmp(&most).is_none_or(Ordering::is_ge) {
                return None;
            }
        }
        (is_whole || !is_folded()).then_some(worst)
    }

    /// Carries a collapse out; `false` where it is not allowed.
    pub(super) fn collapse(&mut self, surface: &mut Surface, ring: &Ring, target: u32) -> bool {
        let point = ring.point;
        let Some(collapse) = taken_apart(surface, ring, target) else { return false };
        let moved = self.moved(surface, point, &collapse, true);
        let places: Option<Vec<Place>> =
            moved.iter().map(|vertex| Some(self.placed(surface, ring, &collapse, *vertex)?.1)).collect();
        let Some(places) = places else { return false };
        for around in collapse.gone.iter().chain(collapse.kept.iter().map(|kept| &kept.old)) {
            self.lying[around.triangle as usize].clear();
        }
        let gone: Vec<u32> = collapse.gone.iter().map(|around| around.triangle).collect();
        let changed: Vec<_> =
            collapse.kept.iter().map(|kept| (kept.old.triangle, kept.old.vertex, kept.to)).collect();
        surface.collapse(point, &gone, &changed);
        for (vertex, mut place) in moved.into_iter().zip(places) {
            // Shares go by (to, next, last); the triangle's corners may begin elsewhere.
            let corners = surface.corners(place.triangle);
            let kept = collapse.kept.iter().find(|kept| kept.old.triangle == place.triangle);
            let first = kept.and_then(|kept| corners.iter().position(|corner| *corner == kept.to));
            place.shares.rotate_right(first.unwrap_or(0));
            self.places[vertex as usize] = Some(place);
            self.lying[place.triangle as usize].push(vertex);
        }
        true
    }

    /// The vertices that get a new place: those of the point, and those that lie on triangles around it.
    fn moved(&self, surface: &Surface, point: u32, collapse: &Collapse, is_whole: bool) -> Vec<u32> {
        let mut moved = surface.vertices_of(point).to_vec();
        if is_whole {
            let old = collapse.gone.iter().chain(collapse.kept.iter().map(|kept| &kept.old));
            moved.extend(old.flat_map(|around| &self.lying[around.triangle as usize]));
        }
        moved
    }

    /// The best new place of a vertex after a collapse, and the vertices of its triangle.
    fn placed(
        &self,
        surface: &Surface,
        ring: &Ring,
        collapse: &Collapse,
        vertex: u32,
    ) -> Option<([u32; 3], Place)> {
        let place = surface.place_of(vertex);
        let own = uv(&self.mesh.uvs, vertex);
        let mut best: Option<(f32, [u32; 3], Place)> = None;
        for kept in &collapse.kept {
            let corners = [kept.to, kept.old.others[0], kept.old.others[1]];
            let at = corners.map(|corner| surface.place_of(corner));
            let mut offer = |shares: [f32; 3]| {
                let off = place.distance_squared(mixed(at, shares));
                let uv_off = own.distance_squared(mixed(corners.map(|v| uv(&self.mesh.uvs, v)), shares));
                let off = off + uv_off * self.length_per_uv[0] * self.length_per_uv[0];
                if best.is_none_or(|(least, ..)| off < least) {
                    best = Some((off, corners, Place { triangle: kept.old.triangle, shares }));
                }
            };
            if !self.on_cut[vertex as usize] {
                offer(nearest_on_triangle(place, at));
                continue;
            }
            let cuts = cuts(surface, ring, collapse.target, kept);
            for edge in (0..3).filter(|edge| cuts[*edge]) {
                let (a, b) = (edge, (edge + 1) % 3);
                let share = nearest_on_edge(place, at[a], at[b]);
                let mut shares = [0.0; 3];
                (shares[a], shares[b]) = (1.0 - share, share);
                offer(shares);
            }
        }
        let (_, corners, place) = best?;
        Some((corners, place))
    }

    /// How far a vertex is off in its place, in every `step`-th pose.
    fn error(&self, surface: &Surface, vertex: u32, corners: [u32; 3], shares: [f32; 3], step: usize) -> f32 {
        let of_corners = corners.map(|corner| surface.places_of(corner));
        let mut worst = 0.0f32;
        for (pose, place) in surface.places_of(vertex).iter().enumerate().step_by(step) {
            let off = place.distance_squared(mixed(of_corners.map(|places| places[pose]), shares));
            worst = larger(worst, off);
        }
        let mut error = worst.sqrt();
        for (uvs, length) in [&self.mesh.uvs, &self.mesh.uvs_1].into_iter().zip(self.length_per_uv) {
            let off = uv(uvs, vertex).distance(mixed(corners.map(|corner| uv(uvs, corner)), shares));
            error = larger(error, off * length);
        }
        let normal = |vertex: u32| self.mesh.normals.get(vertex as usize).copied().unwrap_or_default();
        let tilt = normal(vertex).distance(mixed(corners.map(normal), shares));
        error = larger(error, tilt * self.length_per_normal);
        let color = |vertex: u32| self.mesh.colors.get(vertex as usize).copied().unwrap_or_default();
        let off = color(vertex).distance(mixed(corners.map(color), shares));
        error = larger(error, off * self.length_per_normal);
        if self.careful[vertex as usize] { error * CARE } else { error }
    }
}

/// What a collapse takes away and keeps; `None` where it would change the topology or open a cut.
fn taken_apart(surface: &Surface, ring: &Ring, target: u32) -> Option<Collapse> {
    let point = ring.point;
    let at_target = |vertex: &u32| surface.point_of(*vertex) == target;
    let (gone, kept): (Vec<Around>, Vec<Around>) =
        surface.around(point).partition(|around| around.others.iter().any(at_target));
    if kept.is_empty() || !matches!(gone.len(), 1 | 2) {
        return None;
    }
    // Each vertex of the point becomes the vertex of the target on its side of every cut.
    let mut becomes: Vec<(u32, u32)> = Vec::with_capacity(2);
    for around in &gone {
        let to = around.others.into_iter().find(at_target)?;
        match becomes.iter().find(|(from, _)| *from == around.vertex) {
            None => becomes.push((around.vertex, to)),
            Some((_, other)) if *other == to => {}
            Some(_) => return None,
        }
    }
    let is_cut = |other: u32| ring.is_cut(other);
    match ring.cuts.iter().filter(|is_cut| **is_cut).count() {
        0 => {}
        // A cut stays where it is: its points move along it alone.
        2 if is_cut(target) => {}
        _ => return None,
    }
    // What both ends neighbour are the corners of the triangles that vanish, and nothing else.
    let of_target = surface.neighbours(target);
    let common = |other: &&u32| of_target.binary_search(other).is_ok();
    if ring.neighbours.iter().filter(common).count() != gone.len() {
        return None;
    }
    for around in &gone {
        let third = around.others.into_iter().find(|vertex| !at_target(vertex))?;
        let third = surface.point_of(third);
        // Two cuts would become one, or a point with very many triangles lose one.
        if surface.degree(third) > MOST_TRIANGLES || (is_cut(third) && surface.is_cut(target, third)) {
            return None;
        }
    }
    let kept = kept.into_iter().map(|old| {
        let to = becomes.iter().find(|(from, _)| *from == old.vertex)?.1;
        Some(Kept { old, to })
    });
    Some(Collapse { target, gone, kept: kept.collect::<Option<_>>()? })
}

/// Whether the edges of a triangle that stays are cuts afterwards: from its new corner to the next one,
/// between the others, and back. Looked up for vertices on cuts alone: it takes long.
fn cuts(surface: &Surface, ring: &Ring, target: u32, kept: &Kept) -> [bool; 3] {
    let [next, last] = kept.old.others.map(|vertex| surface.point_of(vertex));
    let from_target = |other: u32| ring.is_cut(other) || surface.is_cut(target, other);
    [from_target(next), surface.is_cut(next, last), from_target(last)]
}

/// The larger of two errors; infinity where the second is no number.
fn larger(known: f32, found: f32) -> f32 {
    if found.is_finite() { known.max(found) } else { f32::INFINITY }
}

fn uv(uvs: &[Vec2], vertex: u32) -> Vec2 {
    uvs.get(vertex as usize).copied().unwrap_or_default()
}

fn mixed<T>(of: [T; 3], shares: [f32; 3]) -> T
where
    T: std::ops::Mul<f32, Output = T> + std::ops::Add<Output = T>,
{
    let ([a, b, c], [wa, wb, wc]) = (of, shares);
    a * wa + b * wb + c * wc
}

/// Whether a triangle turns over, or nearly so in the first pose; a triangle without area cannot.
fn folds(surface: &Surface, kept: &Kept, step: usize) -> bool {
    let [next, last] = kept.old.others.map(|vertex| surface.places_of(vertex));
    let (old, new) = (surface.places_of(kept.old.vertex), surface.places_of(kept.to));
    (0..old.len()).step_by(step).any(|pose| {
        let before = (next[pose] - old[pose]).cross(last[pose] - old[pose]);
        let after = (next[pose] - new[pose]).cross(last[pose] - new[pose]);
        let least = if pose == 0 { LEAST_COSINE * before.length() * after.length() } else { 0.0 };
        before != Vec3::ZERO && before.dot(after) <= least
    })
}

/// The place on an edge that is nearest to a point, from 0 at its start to 1.
fn nearest_on_edge(point: Vec3, start: Vec3, end: Vec3) -> f32 {
    let edge = end - start;
    let square = edge.length_squared();
    if square > 0.0 { ((point - start).dot(edge) / square).clamp(0.0, 1.0) } else { 0.0 }
}

/// The shares of a triangle's corners in its place nearest to a point.
fn nearest_on_triangle(point: Vec3, [a, b, c]: [Vec3; 3]) -> [f32; 3] {
    let (ab, ac, ap) = (b - a, c - a, point - a);
    let (bb, bc, cc) = (ab.length_squared(), ab.dot(ac), ac.length_squared());
    let (pb, pc) = (ap.dot(ab), ap.dot(ac));
    let area = bb * cc - bc * bc;
    let (share_b, share_c) = ((cc * pb - bc * pc) / area, (bb * pc - bc * pb) / area);
    if area > 0.0 && share_b >= 0.0 && share_c >= 0.0 && share_b + share_c <= 1.0 {
        return [1.0 - share_b - share_c, share_b, share_c];
    }
    let on_edges = [(0, 1, a, b), (1, 2, b, c), (2, 0, c, a)].map(|(start, end, from, to)| {
        let share = nearest_on_edge(point, from, to);
        let mut shares = [0.0; 3];
        (shares[start], shares[end]) = (1.0 - share, share);
        (point.distance_squared(from.lerp(to, share)), shares)
    });
    let [first, second, third] = on_edges;
    let least = |one: (f32, [f32; 3]), other: (f32, [f32; 3])| if other.0 < one.0 { other } else { one };
    least(least(first, second), third).1
}
