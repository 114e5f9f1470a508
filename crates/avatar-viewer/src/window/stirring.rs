//! What of the picture a face has changed since it was drawn: nothing that anybody could see, a part of it,
//! or all of it.

use avatar_mesh::{Deformed, PartKind};
use avatar_pack::{FaceState, Pack, Part};
use avatar_render::Camera;
use glam::{Affine3A, Vec2};

/// Where vertices were when they were drawn, as places in the window.
#[derive(Default)]
pub(super) struct Stirring {
    /// For each part.
    drawn: Vec<Vec<Vec2>>,
    deformed: Vec<Deformed>,
    now: Vec<Vec<Vec2>>,
    /// For each part, its vertices on top of the head, where hair grows.
    scalp: Vec<Vec<usize>>,
    /// What was looked at last, to see at once where nothing has changed since.
    bones: Vec<Affine3A>,
    weights: Vec<f32>,
    view: Option<(Camera, Vec2)>,
    /// What came of it; none where that is not known.
    latest: Option<Stirred>,
    /// Whether vertices are where `drawn` says.
    is_known: bool,
}

/// A rectangle of the window in pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Rect {
    min: Vec2,
    max: Vec2,
}

/// How far vertices are from where they were drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Stirred {
    /// The furthest way of a vertex in pixels.
    most_px: f32,
    /// The furthest way of a vertex on top of the head in pixels.
    scalp_px: f32,
    /// What encloses all vertices that are not quite where they were drawn, then and now.
    within: Rect,
}

/// What may have changed of the face since it was drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Change {
    /// Anything.
    Any,
    /// Nothing that could be seen.
    Nothing,
    /// Nothing that could be seen outside of this rectangle: left, top, width and height in pixels.
    Within([u32; 4]),
}

impl Change {
    /// Whether hair stays as it grew: where lids and eyes alone move in software, it costs more than all of
    /// the rest.
    pub(super) fn spares_hair(self, is_software: bool) -> bool {
        match self {
            Self::Any => false,
            Self::Nothing => true,
            Self::Within(_) => is_software,
        }
    }
}

/// Ways shorter than this are not seen, in pixels; where software draws, one looks less closely.
const SEEN_PX: f32 = 0.3;
const SEEN_IN_SOFTWARE_PX: f32 = 0.6;
/// Pixels around what has moved that are drawn with it: for shadows and occlusion beside it.
const BESIDE_PX: f32 = 10.0;
/// A part that is larger than this share of the picture is not worth the trouble.
const LARGEST_PART: f32 = 0.3;
/// Hair grows on this share of a head's height, from its top. Where that moves, hair moves with it, far
/// beyond the vertices that were looked at.
const SCALP: f32 = 0.25;

/// Vertices that are nearer than this to where they were drawn may stay undrawn, in pixels.
const NOTHING_PX: f32 = 0.03;

impl Stirring {
    /// Looks at a face as it is now.
    pub(super) fn look(
        &mut self,
        pack: &Pack,
        state: &FaceState,
        camera: &Camera,
        [width, height]: [u32; 2],
        is_software: bool,
    ) -> Change {
        let size = Vec2::new(width as f32, height as f32);
        let is_same = self.view == Some((*camera, size)) && self.bones == state.bones();
        if let Some(latest) = self.latest.filter(|_| is_same && self.weights == state.weights()) {
            return if self.is_known { latest.change([width, height], is_software) } else { Change::Any };
        }
        self.view = Some((*camera, size));
        self.bones.clear();
        self.bones.extend_from_slice(state.bones());
        self.weights.clear();
        self.weights.extend_from_slice(state.weights());
        let count = |deformed: &Deformed| deformed.positions.len();
        let counts = pack.parts().iter().map(|part| part.mesh.positions.len());
        if !self.deformed.iter().map(count).eq(counts) {
            self.deformed = pack.parts().iter().map(|part| part.mesh.deformed()).collect();
            self.now = self.deformed.iter().map(|part| vec![Vec2::ZERO; part.positions.len()]).collect();
            self.drawn = self.now.clone();
            self.scalp = scalps(pack);
            self.is_known = false;
        }
        let clip_from_world = camera.clip_from_world();
        let mut stirred = Stirred::NOTHING;
        let parts = self.deformed.iter_mut().zip(&mut self.now).zip(&self.drawn);
        for (index, ((deformed, now), drawn)) in parts.enumerate() {
            // A part that cannot be deformed cannot be drawn either.
            if state.deform_into(pack, index, deformed).is_err() {
                continue;
            }
            let mut most = 0.0f32;
            for ((position, now), drawn) in deformed.positions.iter().zip(&mut *now).zip(drawn) {
                let clip = clip_from_world.project_point3(*position);
                *now = (Vec2::new(clip.x, -clip.y) * 0.5 + 0.5) * size;
                let way = now.distance_squared(*drawn);
                if way > NOTHING_PX * NOTHING_PX {
                    most = most.max(way);
                    stirred.within.include(*now);
                    stirred.within.include(*drawn);
                }
            }
            stirred.most_px = stirred.most_px.max(most.sqrt());
            for &vertex in self.scalp.get(index).into_iter().flatten() {
                if let (Some(now), Some(drawn)) = (now.get(vertex), drawn.get(vertex)) {
                    stirred.scalp_px = stirred.scalp_px.max(now.distance(*drawn));
                }
            }
        }
        self.latest = Some(stirred);
        if self.is_known { stirred.change([width, height], is_software) } else { Change::Any }
    }

    /// Knows nothing any more of what is drawn.
    pub(super) fn forget(&mut self) -> Change {
        (self.is_known, self.latest) = (false, None);
        Change::Any
    }

    /// Of what was looked at last all has been drawn, or the part that had changed.
    pub(super) fn drawn(&mut self, all: bool, part: bool) {
        let Some(latest) = &mut self.latest else { return };
        for (drawn, now) in self.drawn.iter_mut().zip(&self.now) {
            if all || !self.is_known {
                drawn.copy_from_slice(now);
            } else if part {
                let within = latest.within;
                let moved = drawn.iter_mut().zip(now);
                moved.filter(|(_, now)| within.has(**now)).for_each(|(drawn, now)| *drawn = *now);
            }
        }
        if all || part || !self.is_known {
            *latest = Stirred::NOTHING;
        }
        self.is_known = true;
    }
}

/// For each part of a pack, its vertices on top of the head, if it is skin.
fn scalps(pack: &Pack) -> Vec<Vec<usize>> {
    let scalp = |part: &Part| {
        let head = pack.head().or_else(|| part.mesh.bounds()).filter(|_| part.kind == PartKind::Skin)?;
        let lowest = head.max.y - SCALP * (head.max.y - head.min.y);
        let places = part.mesh.positions.iter().enumerate();
        Some(places.filter(|(_, place)| place.y >= lowest).map(|(vertex, _)| vertex).collect())
    };
    pack.parts().iter().map(|part| scalp(part).unwrap_or_default()).collect()
}

impl Stirred {
    const NOTHING: Self = Self { most_px: 0.0, scalp_px: 0.0, within: Rect::NOTHING };

    /// What that means for a window of this size.
    fn change(&self, size: [u32; 2], is_software: bool) -> Change {
        let seen = if is_software { SEEN_IN_SOFTWARE_PX } else { SEEN_PX };
        // What is no number may be anywhere.
        if self.most_px < seen {
            return Change::Nothing;
        }
        if self.scalp_px >= seen {
            return Change::Any;
        }
        let most = LARGEST_PART * size[0] as f32 * size[1] as f32;
        match self.within.pixels(BESIDE_PX, size) {
            Some(rect @ [_, _, width, height]) if (width * height) as f32 <= most => Change::Within(rect),
            _ => Change::Any,
        }
    }
}

impl Rect {
    const NOTHING: Self = Self { min: Vec2::INFINITY, max: Vec2::NEG_INFINITY };

    fn include(&mut self, at: Vec2) {
        (self.min, self.max) = (self.min.min(at), self.max.max(at));
    }

    fn has(&self, at: Vec2) -> bool {
        at.cmpge(self.min).all() && at.cmple(self.max).all()
    }

    /// The whole pixels of a picture of this size that lie in it or at most so many pixels beside it: left,
    /// top, width and height. `None` where there are none.
    fn pixels(&self, beside: f32, [width, height]: [u32; 2]) -> Option<[u32; 4]> {
        let last = Vec2::new(width as f32, height as f32);
        let min = (self.min - beside).floor().max(Vec2::ZERO);
        let max = (self.max + beside).ceil().min(last);
        let is_some = max.x > min.x && max.y > min.y && min.is_finite() && max.is_finite();
        is_some.then_some([min.x as u32, min.y as u32, (max.x - min.x) as u32, (max.y - min.y) as u32])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use avatar_pack::Pack;
    use avatar_stage::{DefaultFace, View};

    const SIZE: [u32; 2] = [640, 480];

    fn posed(pack: &Pack, set: &[(&str, f32)]) -> FaceState {
        let mut values = pack.controls().defaults();
        for (name, value) in set {
            values[pack.controls().index(name).expect("a control")] = *value;
        }
        let mut state = FaceState::new(pack);
        state.pose(pack, &values).expect("a face");
        state
    }

    #[test]
    fn lids_change_a_part_of_the_picture_and_what_is_not_seen_nothing() {
        let pack = Pack::load(&DefaultFace).expect("the built-in face");
        let camera = View::FRONT.camera(&pack, 640.0 / 480.0);
        let mut stirring = Stirring::default();
        let look = |stirring: &mut Stirring, set: &[(&str, f32)]| {
            stirring.look(&pack, &posed(&pack, set), &camera, SIZE, true)
        };
        assert_eq!(look(&mut stirring, &[]), Change::Any, "nothing has been drawn");
        stirring.drawn(true, false);
        assert_eq!(look(&mut stirring, &[]), Change::Nothing);
        assert_eq!(look(&mut stirring, &[("eye.left.lr", 0.1)]), Change::Nothing);
        let lids = [("lid.left.upper", 40.0), ("lid.right.upper", 40.0)];
        let Change::Within([left, top, width, height]) = look(&mut stirring, &lids) else {
            panic!("lids are a part of the face")
        };
        // Both eyes are in it, and little else.
        for eye in ["LtEyeJoint", "RtEyeJoint"] {
            let joint = pack.rig().joint(eye).expect("a joint of an eye");
            let place: glam::Vec3 = pack.rig().world_from_bind()[joint.index()].translation.into();
            let clip = camera.clip_from_world().project_point3(place);
            let at = (Vec2::new(clip.x, -clip.y) * 0.5 + 0.5) * Vec2::new(640.0, 480.0);
            assert!(at.x > left as f32 && at.x < (left + width) as f32, "{eye} {at}");
            assert!(at.y > top as f32 && at.y < (top + height) as f32, "{eye} {at}");
        }
        assert!(width * height < 640 * 480 / 8, "{width} {height}");
        // Drawn in part, the rest stays to be drawn.
        stirring.drawn(false, true);
        assert_eq!(look(&mut stirring, &lids), Change::Nothing);
        assert!(matches!(look(&mut stirring, &[]), Change::Within(_)), "they open again");
        assert_eq!(look(&mut stirring, &[("head.turn", 15.0)]), Change::Any, "all of the face");
        assert_eq!(stirring.forget(), Change::Any);
        assert_eq!(look(&mut stirring, &[]), Change::Any);
    }
}
