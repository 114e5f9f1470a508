//! What the pointer says: which part of the face a slider moves, which sliders move the part under the
//! pointer, and where the eyes are to look.

use super::face::Face;
use super::input::Input;
use super::presenter::Presenter;
use super::session::Session;
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
/// What the eyes look at lies between the camera and the face, at this share of their distance from the face.
const TARGET: f32 = 0.5;
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

    /// Takes over what was found out.
    pub(super) fn take(&mut self) {
        if let Ok(reach) = self.coming.try_recv() {
            self.reach = Some(reach);
        }
    }

    /// The pointer is somewhere else.
    pub(super) fn moved(&mut self) {
        self.moved = true;
    }

    /// Forgets where the parts are.
    pub(super) fn face_moved(&mut self) {
        self.deformed.clear();
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

impl Presenter {
    /// Looks at what is under the pointer, and marks what the slider under the pointer moves. The face has to
    /// be posed.
    pub(super) fn point(
        &mut self,
        session: &Session,
        input: &Input,
        free: Option<[f32; 4]>,
        is_at_rest: bool,
    ) {
        let face = &session.face;
        let Some((camera, size)) = self.present_camera(session, free) else { return };
        if !is_at_rest {
            self.pointing.face_moved();
        }
        let Some(overlay) = &mut self.overlay else { return };
        overlay.marks.clear();
        let over_picture = !overlay.takes_pointer() && !input.is_dragging();
        let sees_sliders = {
            let state = overlay.panel.state();
            state.tab == avatar_panel::Tab::Face && !state.folded
        };
        if let Some(control) = self.pointing.hovered
            && self.pointing.reach.is_some()
        {
            self.pointing.deform(face);
            let Pointing { reach, deformed, .. } = &self.pointing;
            mark(
                &camera,
                size,
                deformed,
                reach.iter().flat_map(|reach| reach.moved(control)),
                &mut overlay.marks,
            );
        }
        if !sees_sliders || !over_picture {
            if !self.pointing.highlighted.is_empty() {
                self.pointing.highlighted.clear();
                self.redraw();
            }
        } else if std::mem::take(&mut self.pointing.moved) && is_at_rest && self.pointing.reach.is_some() {
            self.pointing.deform(face);
            let toward = camera.toward(in_picture(input, size));
            let hit = face.pack().hit(&self.pointing.deformed, camera.eye(), toward);
            let before = self.pointing.highlighted.clone();
            let Pointing { reach, highlighted, .. } = &mut self.pointing;
            highlighted.clear();
            if let (Some(reach), Some(hit)) = (reach, hit) {
                reach.controls_at(hit.part, hit.vertex, highlighted);
                // The nearest few: the head moves everything.
                highlighted.truncate(4);
            }
            if before != self.pointing.highlighted {
                self.redraw();
            }
        }
    }

    /// Lets the eyes follow the pointer, and the head the eyes.
    pub(super) fn look(&self, session: &mut Session, input: &Input, free: Option<[f32; 4]>) {
        if !self.pointing.follows || session.face.is_playing() {
            return;
        }
        let Some((camera, size)) = self.present_camera(session, free) else { return };
        let center = session.face.pack().bounds().map_or(Vec3::ZERO, |bounds| bounds.center());
        let depth = -camera.world_from_camera.inverse().transform_point3(center).z;
        let toward = camera.toward(in_picture(input, size));
        session.face.look_at(camera.eye() + toward * depth * (1.0 - TARGET));
    }

    /// The eyes follow the pointer from now on, or look ahead again.
    pub(super) fn toggle_gaze(&mut self, face: &mut Face) {
        self.pointing.follows = !self.pointing.follows;
        if !self.pointing.follows {
            face.look_ahead();
        }
    }
}

/// The pointer's place in a window of this size, as cameras count: from -1 to 1, to the right and up.
fn in_picture(input: &Input, size: Vec2) -> Vec2 {
    let at = Vec2::new(input.pointer.x as f32, input.pointer.y as f32);
    (at / size * 2.0 - 1.0) * Vec2::new(1.0, -1.0)
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
