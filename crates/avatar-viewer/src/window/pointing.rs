//! What the pointer says: which part of the face a slider moves, which sliders move the part under the
//! pointer, and where the eyes are to look.

use super::face::Face;
use super::watch::Wake;
use avatar_mesh::Deformed;
use avatar_pack::{Pack, Reach};
use avatar_render::Camera;
use glam::{Vec2, Vec3};
use std::sync::Arc;
use std::sync::mpsc::{Receiver, channel};
use winit::event_loop::EventLoopProxy;

/// More marks than these say nothing new.
const MARKS: usize = 900;
/// What the pointer is about.
pub(super) struct Pointing {
    /// Which vertices each control moves, once that is known.
    reach: Option<Reach>,
    coming: Receiver<Reach>,
    /// Whether the eyes follow the pointer.
    pub(super) follows: bool,
    /// The control whose slider is under the pointer.
    pub(super) hovered: Option<usize>,
    /// Controls that move what is under the pointer in the picture.
    pub(super) highlighted: Vec<usize>,
    /// All parts as they are now, while nothing moves.
    deformed: Vec<Deformed>,
    /// Whether the pointer has moved since it was looked at.
    moved: bool,
}

impl Pointing {
    /// Begins to find out what each control moves.
    pub(super) fn new(pack: &Arc<Pack>, window: EventLoopProxy<Wake>, follows: bool) -> Self {
        let (sender, coming) = channel();
        let copy = Arc::clone(pack);
        std::thread::spawn(move || {
            // Another avatar may have taken the place of this one.
            let _ = sender.send(Reach::new(&copy));
            let _ = window.send_event(Wake::Ready);
        });
        Self {
            reach: None,
            coming,
            follows,
            hovered: None,
            highlighted: Vec::new(),
            deformed: Vec::new(),
            moved: false,
        }
    }

    /// Takes over the result of the thread, if it is ready.
    pub(super) fn take(&mut self) {
        if let Ok(reach) = self.coming.try_recv() {
            self.reach = Some(reach);
        }
    }

    /// The pointer is somewhere else.
    pub(super) fn moved(&mut self) {
        self.moved = true;
    }

    /// Ignores that the pointer has moved.
    pub(super) fn ignore_move(&mut self) {
        self.moved = false;
    }

    /// Forgets where the parts are.
    pub(super) fn face_moved(&mut self) {
        self.deformed.clear();
    }

    /// Marks the places in the window that the slider under the pointer moves.
    pub(super) fn mark(&mut self, face: &Face, camera: &Camera, size: Vec2, marks: &mut Vec<[f32; 2]>) {
        let Some(control) = self.hovered.filter(|_| self.reach.is_some()) else { return };
        self.deform(face);
        let Self { reach, deformed, .. } = self;
        mark(camera, size, deformed, reach.iter().flat_map(|reach| reach.moved(control)), marks);
    }

    /// Highlights no control any more; whether there were any.
    pub(super) fn highlight_nothing(&mut self) -> bool {
        let changes = !self.highlighted.is_empty();
        self.highlighted.clear();
        changes
    }

    /// Highlights the controls that move what lies in this direction, if the pointer has moved since; whether
    /// they are others than before.
    pub(super) fn highlight(&mut self, face: &Face, eye: Vec3, toward: Vec3) -> bool {
        if !std::mem::take(&mut self.moved) || self.reach.is_none() {
            return false;
        }
        self.deform(face);
        let hit = face.pack().hit(&self.deformed, eye, toward);
        let before = std::mem::take(&mut self.highlighted);
        if let (Some(reach), Some(hit)) = (&self.reach, hit) {
            reach.controls_at(hit.part, hit.vertex, &mut self.highlighted);
            // The nearest few: the head moves everything.
            self.highlighted.truncate(4);
        }
        before != self.highlighted
    }

    fn deform(&mut self, face: &Face) {
        if self.deformed.is_empty() {
            let (pack, state) = (face.pack(), face.performer.state());
            let parts = 0..pack.parts().len();
            // A part that cannot be deformed has nothing to point at.
            self.deformed = parts.map(|part| state.deform(pack, part).unwrap_or_default()).collect();
        }
    }
}

/// Places in the window of those vertices that face the camera.
fn mark(
    camera: &Camera,
    size: Vec2,
    deformed: &[Deformed],
    vertices: impl Iterator<Item = (usize, usize)>,
    marks: &mut Vec<[f32; 2]>,
) {
    let (clip_from_world, eye) = (camera.clip_from_world(), camera.eye());
    let seen = vertices.filter_map(|(part, vertex)| {
        let part = deformed.get(part)?;
        let (position, normal) = (*part.positions.get(vertex)?, *part.normals.get(vertex)?);
        (normal.dot(eye - position) > 0.0).then_some(position)
    });
    let seen: Vec<Vec3> = seen.collect();
    let stride = seen.len().div_ceil(MARKS).max(1);
    marks.extend(seen.iter().step_by(stride).filter_map(|position| {
        let clip = clip_from_world.project_point3(*position);
        let at = (Vec2::new(clip.x, -clip.y) + 1.0) / 2.0 * size;
        at.is_finite().then(|| at.to_array())
    }));
}
