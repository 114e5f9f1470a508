//! One frame: time passes, the panel is laid out, the face is drawn beside it, and the next frame is asked for if there is to be one.

use super::App;
use super::camera::Place;
use super::filming::{Filming, formats};
use super::keys::MOUSE;
use super::shot::Shot;
use super::stage::Stage;
use anyhow::Result;
use avatar_panel::{FileClip, FilePlayback, KeyRow, Model, Playback, Stats, Theme};
use avatar_stage::BACKGROUND;
use pose_anim::Pose;
use std::time::{Duration, Instant};
use winit::event_loop::ActiveEventLoop;

/// A frame that takes longer (a suspended laptop) does not let the motion jump, nor a recording wait for hours.
const MAX_FRAME_SECS: f64 = 0.25;
const MAX_RECORDED_FRAME_SECS: f64 = 5.0;
/// How long hair swings on after the head has stopped.
const SWINGS_ON: Duration = Duration::from_millis(1800);
/// How often progress is shown.
const SOON: Duration = Duration::from_millis(150);
/// Frames whose times are kept.
const HISTORY: usize = 120;
/// Ground of the light theme.
const LIGHT_BACKGROUND: [u8; 4] = [0xc9, 0xcd, 0xd4, 255];
/// To which frames keys of clips and the playhead snap.
const FRAME_RATE: f64 = 30.0;

/// When frames were drawn, and what was seen in them.
#[derive(Default)]
pub(super) struct Frames {
    /// When the last frame of a running motion was drawn; `None` while nothing moves.
    last: Option<Instant>,
    /// When the last of frames that follow each other was drawn.
    drawn: Option<Instant>,
    /// When the last frame was drawn that hair moved in, and until when it does.
    swing: Option<(Instant, Instant)>,
    /// When the panel wants to be drawn again.
    again: Option<Instant>,
    /// Milliseconds from frame to frame.
    history: Vec<f32>,
    passes: Vec<(&'static str, f32)>,
    /// Small pictures of poses, as what they show: the pose's values tell whether they still do.
    miniatures: Vec<Miniature>,
}

struct Miniature {
    pose: Pose,
    background: [u8; 4],
    texture: egui::TextureHandle,
}

impl Frames {
    /// Seconds since the last frame or press, while something moves.
    pub(super) fn catch_up(&mut self, now: Instant, is_recorded: bool) -> f64 {
        // What is recorded lasts as long as it lasted for the user.
        let most = if is_recorded { MAX_RECORDED_FRAME_SECS } else { MAX_FRAME_SECS };
        let last = self.last.replace(now);
        last.map_or(0.0, |last| now.duration_since(last).as_secs_f64().min(most))
    }

    /// When the next frame is to be drawn that nothing else asks for.
    pub(super) fn next(&self) -> Option<Instant> {
        self.again
    }

    pub(super) fn is_due(&mut self) -> bool {
        self.again.take_if(|again| *again <= Instant::now()).is_some()
    }

    /// Something beside the face has to be shown, which need not be at once: the panel's own frames are few.
    pub(super) fn soon(&mut self) {
        let soon = Instant::now() + SOON;
        self.again = Some(self.again.map_or(soon, |again| again.min(soon)));
    }

    pub(super) fn forget_miniatures(&mut self) {
        self.miniatures.clear();
    }
}

impl App {
    /// The colours of the window's ground.
    pub(super) fn background(&self) -> [u8; 4] {
        let Some(overlay) = &self.overlay else { return BACKGROUND };
        match overlay.panel.state().theme {
            Theme::Light => LIGHT_BACKGROUND,
            Theme::System if overlay.ctx.theme() == egui::Theme::Light => LIGHT_BACKGROUND,
            _ => BACKGROUND,
        }
    }

    pub(super) fn frame(&mut self, event_loop: &ActiveEventLoop) -> Result<()> {
        if self.stage.as_ref().is_some_and(Stage::is_lost) {
            return self.reopen(event_loop);
        }
        let before = Instant::now();
        if let Some(last) = self.frames.drawn {
            let ms = before.duration_since(last).as_secs_f32() * 1e3;
            if self.frames.history.len() == HISTORY {
                self.frames.history.remove(0);
            }
            self.frames.history.push(ms);
        }
        if self.frames.last.is_some() {
            self.catch_up();
        }
        if self.face.recording_is_full() {
            self.act(event_loop, avatar_panel::Action::StopRecording);
        }
        let is_at_rest = !self.face.moves();
        let background = self.background();
        let has_more = self.draw_miniature(is_at_rest, background)?;

        let mut actions = Vec::new();
        let mut painted = self.lay_out(&mut actions);
        let has_acted = !actions.is_empty();
        for action in actions {
            self.act(event_loop, action);
        }
        // The slider's last word has been heard.
        self.interrupted.take_if(|released| *released);
        let free = painted.as_ref().map(|painted| painted.free);
        self.look(free);
        self.face.pose()?;
        self.point(free, is_at_rest);
        if let (Some(overlay), Some(painted)) = (&self.overlay, &mut painted) {
            overlay.mark(painted);
        }
        self.draw(painted.as_ref(), is_at_rest, background)?;

        let swings = self.frames.swing.is_some();
        self.frames.drawn = self.face.moves().then_some(before);
        if !self.face.moves() {
            self.frames.last = None;
        } else {
            self.frames.last.get_or_insert_with(Instant::now);
        }
        let again = painted.map_or(Duration::MAX, |painted| painted.again);
        self.frames.again = (again > Duration::ZERO).then(|| Instant::now().checked_add(again)).flatten();
        // Nothing moves: no frame until something happens.
        if self.face.moves() || swings || has_acted || again.is_zero() || has_more {
            self.redraw();
        }
        Ok(())
    }

    /// Lets the panel see what has happened so far. It looks at the pointer where it is in the end: who clicks here and then there
    /// before the next frame would not have clicked here.
    pub(super) fn react(&mut self, event_loop: &ActiveEventLoop) {
        let mut actions = Vec::new();
        self.lay_out(&mut actions);
        for action in actions {
            self.act(event_loop, action);
        }
        self.redraw();
    }

    /// Lays the panel out and collects what the user wants.
    fn lay_out(&mut self, actions: &mut Vec<avatar_panel::Action>) -> Option<super::overlay::Painted> {
        let (Some(overlay), Some(stage)) = (&mut self.overlay, &mut self.stage) else { return None };
        let shows_stats = overlay.panel.state().show_stats;
        stage.measure(shows_stats);
        if let Some(passes) = stage.passes() {
            self.frames.passes = passes;
        }
        let face = &self.face;
        let (adapter, triangles, strands) = stage.numbers(&face.pack);
        let names: Vec<_> = self.keys.rows().collect();
        let poses =
            face.pack.poses().iter().filter_map(|pose| Some((pose.key.as_deref()?, pose.name.as_str())));
        let rows = names.iter().map(|(key, row)| KeyRow { key, meaning: row.meaning, group: row.group });
        let poses = poses.map(|(key, meaning)| KeyRow { key, meaning, group: "Poses" });
        let clips = face.pack.clips().clips.iter();
        let clips = clips.filter_map(|clip| {
            Some(KeyRow { key: clip.key.as_deref()?, meaning: &clip.name, group: "Clips" })
        });
        let mouse = MOUSE.iter().map(|(key, meaning)| KeyRow { key, meaning, group: "Mouse" });
        let rows: Vec<KeyRow<'_>> = poses.chain(clips).chain(rows).chain(mouse).collect();
        let hair = self.look.hair.name();
        let help = self.keys.help();
        let help: Vec<&str> = help.iter().map(String::as_str).collect();
        let reserved = self.keys.reserved();
        let reserved: Vec<&str> = reserved.iter().map(String::as_str).collect();
        let messages: Vec<_> = self.messages.shown().collect();
        let recent: Vec<String> = self.config.recent.iter().map(|path| path.display().to_string()).collect();
        let formats: Vec<&str> = formats().into_iter().map(|(name, _)| name).collect();
        let thumbnails: Vec<_> = (face.pack.poses().iter())
            .map(|pose| {
                let shown = self.frames.miniatures.iter().find(|miniature| same_face(&miniature.pose, pose));
                shown.map(|miniature| miniature.texture.id())
            })
            .collect();
        let loading = self.loading.as_ref().map(|loading| loading.path.display().to_string());
        let loading = self.loading.as_ref().zip(loading.as_deref());
        let file_clips = face.file_clips.iter();
        let file_clips: Vec<_> =
            file_clips.map(|(name, secs)| FileClip { name, duration_secs: *secs }).collect();
        let motion = face.motion.as_ref().filter(|motion| motion.is_wanted());
        let model = Model {
            values: &face.goal,
            highlighted: &self.pointing.highlighted,
            thumbnails: &thumbnails,
            active_pose: face.active_pose,
            can_save: if face.store.path(crate::store::POSES).is_some() {
                Ok(())
            } else {
                Err("There is no folder to write poses to.")
            },
            can_undo: face.can_undo(false),
            can_redo: face.can_undo(true),
            clips: &face.pack.clips().clips,
            clips_changed: face.has_unsaved_clips(),
            playback: Playback {
                clip: face.playback.clip,
                time_secs: face.playback.time_secs,
                playing: face.playback.playing,
                recording_secs: face.recorded_secs(),
                frame_rate: FRAME_RATE,
            },
            gaze: Some(self.pointing.follows),
            hair: Some(&hair),
            file_clips: &file_clips,
            file_playback: motion.map(|motion| FilePlayback {
                clip: motion.clip,
                time_secs: motion.time_secs,
                playing: motion.playing,
            }),
            keys: &rows,
            help_keys: &help,
            reserved_keys: &reserved,
            messages: &messages,
            loading: loading
                .map(|(loading, what)| avatar_panel::Loading { what, fraction: Some(loading.fraction) }),
            stats: Stats {
                adapter,
                triangles,
                strands,
                passes: &self.frames.passes,
                frame_ms: &self.frames.history,
            },
            recent: &recent,
            cameras: &Place::ALL.map(Place::name),
            film_formats: &formats,
            film: self.filming.as_ref().map(Filming::progress),
            full_screen: stage.window().fullscreen().is_some(),
            ..Model::new(face.pack.controls(), face.pack.poses())
        };
        Some(overlay.run(stage.window(), &model, actions))
    }

    fn draw(
        &mut self,
        painted: Option<&super::overlay::Painted>,
        is_at_rest: bool,
        background: [u8; 4],
    ) -> Result<()> {
        let Some(stage) = &mut self.stage else { return Ok(()) };
        let now = Instant::now();
        // Hair goes on a little after the head; where nothing has moved for longer it hangs still.
        let until = match is_at_rest {
            false => Some(now + SWINGS_ON),
            true => self.frames.swing.map(|(_, until)| until).filter(|until| now < *until),
        };
        let last = self.frames.swing.filter(|_| until.is_some()).map(|(last, _)| last);
        stage.advance_hair(last.map_or(f32::NAN, |last| now.duration_since(last).as_secs_f32()));
        self.frames.swing = until.filter(|_| stage.has_swinging_hair()).map(|until| (now, until));
        let shot = Shot {
            pack: &self.face.pack,
            state: &self.face.state,
            view: self.camera.view,
            background,
            free: painted.map(|painted| painted.free),
        };
        stage.draw(&shot, self.overlay.as_mut().zip(painted))
    }

    /// Draws the small picture of one pose that has none, while nothing moves and the poses are seen. Returns whether it did:
    /// then there may be more.
    fn draw_miniature(&mut self, is_at_rest: bool, background: [u8; 4]) -> Result<bool> {
        let (Some(overlay), Some(stage)) = (&self.overlay, &mut self.stage) else { return Ok(false) };
        let state = overlay.panel.state();
        let are_seen = state.tab == avatar_panel::Tab::Poses && !state.folded;
        if !is_at_rest || !are_seen {
            return Ok(false);
        }
        let poses = self.face.pack.poses();
        self.frames.miniatures.retain(|miniature| {
            miniature.background == background && poses.iter().any(|pose| same_face(&miniature.pose, pose))
        });
        let has = |pose: &Pose| self.frames.miniatures.iter().any(|own| same_face(&own.pose, pose));
        let Some(pose) = poses.iter().find(|pose| !has(pose)) else { return Ok(false) };
        let mut values = self.face.pack.controls().defaults();
        pose.values.iter().for_each(|(control, value)| values[*control] = *value);
        let picture = stage.miniature(&self.face.pack, &values, background)?;
        let size = [picture.width() as usize, picture.height() as usize];
        let image = egui::ColorImage::from_rgba_unmultiplied(size, picture.as_raw());
        let texture = overlay.ctx.load_texture(&pose.name, image, egui::TextureOptions::LINEAR);
        self.frames.miniatures.push(Miniature { pose: pose.clone(), background, texture });
        Ok(true)
    }
}

/// Whether two poses are the same face, whatever they are called.
fn same_face(a: &Pose, b: &Pose) -> bool {
    a.values == b.values
}
