//! What the pointer says: which part of the face a slider moves, which sliders move the part under the pointer, and where the eyes
//! are to look.

use super::App;
use super::face::Face;
use super::shot::Shot;
use super::watch::Wake;
use avatar_mesh::Deformed;
use avatar_pack::{Gaze, Pack, Reach};
use avatar_render::Camera;
use glam::{Vec2, Vec3};
use pose_anim::{Pose, face};
use std::sync::mpsc::{Receiver, channel};
use winit::event_loop::EventLoopProxy;

/// More marks than these say nothing new.
const MARKS: usize = 900;
/// What the eyes look at lies between the camera and the face, at this share of their distance from the face.
const TARGET: f32 = 0.5;
/// Share of the way to the target by which the head turns, and the seconds that it takes: the eyes are there long before.
const HEAD_SHARE: f32 = 0.45;
const HEAD_SECS: f64 = 0.9;
/// Seconds that the eyes take.
const EYE_SECS: f64 = 0.1;
/// Degrees by which a control has to be off before it is corrected.
const OFF_DEGREES: f32 = 0.25;

/// What the pointer is about.
pub(super) struct Pointing {
    /// Which vertices each control moves, once that is known.
    reach: Option<Reach>,
    coming: Receiver<Reach>,
    gaze: Option<Gaze>,
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
    led: Vec<(usize, f32)>,
}

impl Pointing {
    /// Begins to find out what each control moves.
    pub(super) fn new(pack: &Pack, window: EventLoopProxy<Wake>, follows: bool) -> Self {
        let (sender, coming) = channel();
        let copy = pack.clone();
        std::thread::spawn(move || {
            // Another avatar may have taken the place of this one.
            let _ = sender.send(Reach::new(&copy));
            let _ = window.send_event(Wake::Ready);
        });
        Self {
            reach: None,
            coming,
            gaze: Gaze::new(pack),
            follows,
            hovered: None,
            highlighted: Vec::new(),
            deformed: Vec::new(),
            moved: false,
            led: Vec::new(),
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
            let parts = 0..face.pack.parts().len();
            // A part that cannot be deformed has nothing to point at.
            self.deformed =
                parts.map(|part| face.state.deform(&face.pack, part).unwrap_or_default()).collect();
        }
    }
}

impl App {
    /// The camera of the frame, and the size of the window in pixels.
    fn present_camera(&self, free: Option<[f32; 4]>) -> Option<(Camera, Vec2)> {
        let stage = self.stage.as_ref()?;
        let (width, height) = stage.size();
        let shot = Shot {
            pack: &self.face.pack,
            state: &self.face.state,
            view: self.camera.view,
            background: [0; 4],
            free,
        };
        Some((shot.scene(width, height, &self.look).camera, Vec2::new(width as f32, height as f32)))
    }

    /// Looks at what is under the pointer, and marks what the slider under the pointer moves. The face has to be posed.
    pub(super) fn point(&mut self, free: Option<[f32; 4]>, is_at_rest: bool) {
        let Some((camera, size)) = self.present_camera(free) else { return };
        if !is_at_rest {
            self.pointing.face_moved();
        }
        let Some(overlay) = &mut self.overlay else { return };
        overlay.marks.clear();
        let over_picture = !overlay.takes_pointer() && self.dragging.is_none();
        let sees_sliders = {
            let state = overlay.panel.state();
            state.tab == avatar_panel::Tab::Face && !state.folded
        };
        if let Some(control) = self.pointing.hovered
            && self.pointing.reach.is_some()
        {
            self.pointing.deform(&self.face);
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
            self.pointing.deform(&self.face);
            let at = Vec2::new(self.pointer.x as f32, self.pointer.y as f32) / size * 2.0 - 1.0;
            let toward = camera.toward(at * Vec2::new(1.0, -1.0));
            let hit = self.face.pack.hit(&self.pointing.deformed, camera.eye(), toward);
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

    /// Lets the eyes follow the pointer, and the head the eyes, or lets them look ahead again.
    pub(super) fn look(&mut self, free: Option<[f32; 4]>) {
        if !self.pointing.follows || self.face.playback.playing {
            return;
        }
        let Some((camera, size)) = self.present_camera(free) else { return };
        let Some(gaze) = &mut self.pointing.gaze else { return };
        let at = (Vec2::new(self.pointer.x as f32, self.pointer.y as f32) / size * 2.0 - 1.0)
            * Vec2::new(1.0, -1.0);
        let center = self.face.pack.bounds().map_or(Vec3::ZERO, |bounds| bounds.center());
        let depth = -camera.world_from_camera.inverse().transform_point3(center).z;
        let target = camera.eye() + camera.toward(at) * depth * (1.0 - TARGET);
        let led = &mut self.pointing.led;
        let face = &mut self.face;
        // Only a face of another pack would be an error.
        let _ = gaze.face_toward(&face.pack, &face.goal, target, HEAD_SHARE, led);
        face.lead(led, HEAD_SECS, OFF_DEGREES);
        let _ = gaze.look_at(&face.pack, face.player.values(), target, led);
        face.lead(led, EYE_SECS, OFF_DEGREES);
    }

    /// The eyes follow the pointer from now on, or look ahead again.
    pub(super) fn toggle_gaze(&mut self) {
        self.pointing.follows = !self.pointing.follows;
        if !self.pointing.follows {
            let controls = self.face.pack.controls().controls();
            let led = face::EYES.iter().chain([&face::FACING]).flatten();
            let ahead = led.filter_map(|name| {
                let index = self.face.pack.controls().index(name)?;
                Some((index, controls[index].default))
            });
            self.face.press(&Pose::new("ahead", ahead.collect()));
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
