//! What the pointer says, while a frame is made: which sliders move the part under it, and where the eyes are
//! to look.

use super::face::Face;
use super::input::Input;
use super::presenter::Presenter;
use super::session::Session;
use super::stirring::Change;
use glam::{Vec2, Vec3};

/// What the eyes look at lies between the camera and the face, at this share of their distance from the face.
const TARGET: f32 = 0.5;

impl Presenter {
    /// Looks at what is under the pointer, and marks what the slider under the pointer moves. The face has to
    /// be posed.
    pub(super) fn point(&mut self, session: &Session, input: &Input, acts: bool, change: Change) {
        let face = &session.face;
        let Some((camera, size)) = self.present_camera(session, self.free) else { return };
        if acts || (face.lives() && change != Change::Nothing) {
            self.pointing.face_moved();
        }
        let Some(overlay) = &mut self.overlay else { return };
        overlay.marks.clear();
        let over_picture = !overlay.takes_pointer() && !input.is_dragging();
        let sees_sliders = {
            let state = overlay.panel.state();
            state.tab == avatar_panel::Tab::Face && !state.folded
        };
        self.pointing.mark(face, &camera, size, &mut overlay.marks);
        let changed = match sees_sliders && over_picture {
            false => self.pointing.highlight_nothing(),
            true if !acts => {
                self.pointing.highlight(face, camera.eye(), camera.toward(in_picture(input, size)))
            }
            true => {
                self.pointing.ignore_move();
                false
            }
        };
        if changed {
            self.redraw();
        }
    }

    /// Lets the eyes follow the pointer, and the head the eyes. A face that lives attends to the pointer
    /// instead, or else to whoever looks at it: to the camera.
    pub(super) fn look(&self, session: &mut Session, input: &Input) {
        let face = &session.face;
        let follows = self.pointing.follows && !face.is_playing();
        // What is recorded are controls, of which life moves none.
        let attends = face.lives() && face.recorded_secs().is_none();
        if !follows && !attends {
            return;
        }
        let Some((camera, size)) = self.present_camera(session, self.free) else { return };
        if !follows {
            return session.face.attend(camera.eye(), true);
        }
        let center = face.pack().bounds().map_or(Vec3::ZERO, |bounds| bounds.center());
        let depth = -camera.world_from_camera.inverse().transform_point3(center).z;
        let toward = camera.toward(in_picture(input, size));
        let point = camera.eye() + toward * depth * (1.0 - TARGET);
        match attends {
            true => session.face.attend(point, false),
            false => session.face.look_at(point),
        }
    }

    /// The eyes follow the pointer from now on, or look ahead again.
    pub(super) fn toggle_gaze(&mut self, face: &mut Face) {
        self.pointing.follows = !self.pointing.follows;
        if !self.pointing.follows && !face.lives() {
            face.look_ahead();
        }
    }

    /// The face lives from now on, or is still again.
    pub(super) fn toggle_life(&mut self, face: &mut Face) {
        face.set_life(!face.lives());
        // From here on life leads the eyes, and does not add to where they are.
        if self.pointing.follows && face.lives() {
            face.look_ahead();
        }
    }
}

/// The pointer's place in a window of this size, as cameras count: from -1 to 1, to the right and up.
fn in_picture(input: &Input, size: Vec2) -> Vec2 {
    let at = Vec2::new(input.pointer.x as f32, input.pointer.y as f32);
    (at / size * 2.0 - 1.0) * Vec2::new(1.0, -1.0)
}
