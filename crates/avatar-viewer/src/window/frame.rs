//! One frame: time passes, the panel is laid out, the face is drawn beside it, and the next frame is asked
//! for if there is to be one.

use super::App;
use super::action::Action;
use super::camera::Place;
use super::filming::{Filming, formats};
use super::keys::MOUSE;
use super::messages::About;
use super::overlay::Painted;
use super::presenter::Presenter;
use super::session::Session;
use super::stage::{Drawn, Stage};
use super::stirring::Change;
use super::talking::Talking;
use anyhow::Result;
use avatar_panel::{Edit, FileClip, FilePlayback, KeyRow, Message, Model, Playback, Stats};
use std::path::PathBuf;
use std::time::{Duration, Instant};
use winit::event_loop::ActiveEventLoop;

/// To which frames keys of clips and the playhead snap.
const FRAME_RATE: f64 = 30.0;

/// What the panel shows beside the session.
struct Around<'a> {
    keys: &'a super::keys::Keys,
    messages: &'a [Message<'a>],
    /// Files that were opened before.
    recent: &'a [PathBuf],
    talking: &'a Talking,
    live: avatar_panel::Live<'a>,
}

impl App {
    pub(super) fn frame(&mut self, event_loop: &ActiveEventLoop) -> Result<()> {
        if self.presenter.stage.as_ref().is_some_and(Stage::is_lost) {
            return self.reopen(event_loop);
        }
        let ready = self.presenter.stage.as_mut().map_or(Ok(None), Stage::ready);
        self.live.finished(ready.as_ref().ok().copied().flatten());
        let began = Instant::now();
        self.presenter.frames.begin(began);
        if self.presenter.frames.runs() {
            self.catch_up();
        }
        if let Err(error) = self.live.frame(&mut self.session.face) {
            self.messages.error(About::Live, "The recording has ended.", &error);
        }
        // Packets have been taken: the next ones wake the window again.
        ready?;
        self.keep_calibration();
        if self.session.face.recording_is_full() {
            self.act(event_loop, Action::Panel(avatar_panel::Action::Edit(Edit::StopRecording)));
        }
        let drive = self.live.wakes_at();
        let moves = drive.is_some_and(|then| then <= Instant::now());
        if moves {
            self.live.moved();
        }
        let is_driven = moves || self.live.may_go_on();
        let acts = self.session.face.acts() || is_driven;
        let has_more = self.presenter.draw_miniature(&self.session, !self.session.face.acts())?;

        let mut actions = Vec::new();
        let mut painted = self.lay_out(&mut actions);
        let has_acted = !actions.is_empty();
        for action in actions {
            self.act(event_loop, Action::Panel(action));
        }
        self.input.heard();
        let Self { session, presenter, input, live, .. } = self;
        presenter.free = painted.as_ref().map(|painted| painted.free);
        presenter.look(session, input);
        session.face.pose()?;
        let change = if acts { presenter.stirring.forget() } else { presenter.change(session) };
        presenter.point(session, input, acts, change);
        if let (Some(overlay), Some(painted)) = (&presenter.overlay, &mut painted) {
            overlay.mark(painted);
        }
        let drawn = presenter.draw(session, painted.as_ref(), acts, change)?;
        if is_driven {
            live.drawn(&drawn);
        }

        let acts = session.face.acts() || is_driven;
        let (lives, swings) = (session.face.lives(), presenter.frames.swings());
        let again = painted.map_or(Duration::MAX, |painted| painted.again);
        let runs = acts || lives || presenter.frames.sounds;
        presenter.frames.end(began, acts, runs, again);
        presenter.stir_later(session);
        // Nothing moves: no frame until something happens.
        if acts || swings || has_acted || again.is_zero() || has_more || drawn.whole_again {
            presenter.redraw();
        } else if let Some(due) = presenter.stage.as_mut().and_then(Stage::comes_to_rest) {
            presenter.frames.no_later(due);
        }
        if let Some(then) = drive.filter(|_| !is_driven) {
            presenter.frames.no_later(then);
        }
        Ok(())
    }

    /// Brings the motion to this moment, so that a press acts at the time of the press.
    pub(super) fn catch_up(&mut self) {
        let Self { session: Session { face, .. }, presenter: Presenter { frames, .. }, talking, .. } = self;
        frames.sounds = talking.go_on(&mut face.performer);
        face.advance(frames.catch_up(Instant::now(), face.recorded_secs().is_some()));
    }

    /// A face that does nothing but live has lived a little, or heard something: draws it if anybody could
    /// see that.
    pub(super) fn stir(&mut self) {
        self.catch_up();
        let Self { session, presenter, input, talking, .. } = self;
        if talking.listens() {
            // The panel shows how loud it is.
            presenter.frames.soon();
        }
        if session.face.acts() {
            return presenter.redraw();
        }
        if !session.face.lives() {
            return presenter.stir_later(session);
        }
        presenter.look(session, input);
        // What cannot be posed is told by the frame.
        let is_posed = session.face.pose().is_ok();
        if is_posed && presenter.change(session) == Change::Nothing {
            presenter.stir_later(session);
        } else {
            presenter.redraw();
        }
    }

    /// Lets the panel see what has happened so far. It looks at the pointer where it is in the end: who
    /// clicks here and then there before the next frame would not have clicked here.
    pub(super) fn react(&mut self, event_loop: &ActiveEventLoop) {
        let mut actions = Vec::new();
        self.lay_out(&mut actions);
        for action in actions {
            self.act(event_loop, Action::Panel(action));
        }
        self.presenter.redraw();
    }

    fn lay_out(&mut self, actions: &mut Vec<avatar_panel::Action>) -> Option<Painted> {
        let messages: Vec<_> = self.messages.shown().collect();
        let live = &self.live;
        let (inlets, senders, turned_away) = (live.inlets(), live.senders(), live.turned_away());
        let around = Around {
            keys: &self.input.keys,
            messages: &messages,
            recent: &self.config.recent,
            talking: &self.talking,
            live: live.model(&inlets, &senders, &turned_away),
        };
        self.presenter.lay_out(&self.session, &around, actions)
    }
}

impl Presenter {
    /// Lays the panel out and collects what the user wants.
    fn lay_out(
        &mut self,
        session: &Session,
        around: &Around<'_>,
        actions: &mut Vec<avatar_panel::Action>,
    ) -> Option<Painted> {
        let (Some(overlay), Some(stage)) = (&mut self.overlay, &mut self.stage) else { return None };
        let shows_stats = overlay.panel.state().show_stats;
        stage.measure(shows_stats);
        if let Some(passes) = stage.passes() {
            self.frames.set_passes(passes);
        }
        let (face, books) = (&session.face, &session.books);
        let (adapter, triangles, strands) = stage.numbers(face.pack());
        let names: Vec<_> = around.keys.rows().collect();
        let poses = books.poses().iter().filter_map(|pose| Some((pose.key.as_deref()?, pose.name.as_str())));
        let rows = names.iter().map(|(key, row)| KeyRow { key, meaning: row.meaning, group: row.group });
        let poses = poses.map(|(key, meaning)| KeyRow { key, meaning, group: "Poses" });
        let clips = books.clips().iter().filter_map(|clip| {
            Some(KeyRow { key: clip.key.as_deref()?, meaning: &clip.name, group: "Clips" })
        });
        let mouse = MOUSE.iter().map(|(key, meaning)| KeyRow { key, meaning, group: "Mouse" });
        let rows: Vec<KeyRow<'_>> = poses.chain(clips).chain(rows).chain(mouse).collect();
        let hair = self.look.hair.name();
        let help = around.keys.help();
        let help: Vec<&str> = help.iter().map(String::as_str).collect();
        let reserved = around.keys.reserved();
        let reserved: Vec<&str> = reserved.iter().map(String::as_str).collect();
        let recent: Vec<String> = around.recent.iter().map(|path| path.display().to_string()).collect();
        let formats: Vec<&str> = formats().into_iter().map(|(name, _)| name).collect();
        let thumbnails: Vec<_> = books.poses().iter().map(|pose| self.frames.miniature(pose)).collect();
        let avatar = session.loading.as_ref();
        let loading = avatar.map(|loading| loading.path.display().to_string());
        let loading = loading.or_else(|| around.talking.reading().map(str::to_owned));
        let fraction = avatar.map(|loading| loading.fraction);
        let file_clips = face.file_clips.iter();
        let file_clips: Vec<_> =
            file_clips.map(|(name, secs)| FileClip { name, duration_secs: *secs }).collect();
        let motion = face.motion.as_ref().filter(|motion| motion.is_wanted());
        let model = Model {
            values: &face.targets(),
            highlighted: &self.pointing.highlighted,
            thumbnails: &thumbnails,
            active_pose: face.active_pose,
            can_save: match books.can_save_poses() {
                true => Ok(()),
                false => Err("There is no folder to write poses to."),
            },
            can_undo: books.can_undo(),
            can_redo: books.can_redo(),
            clips: books.clips(),
            clips_changed: books.has_unsaved_clips(),
            playback: Playback {
                clip: face.playback.clip,
                time_secs: face.playhead_secs(),
                playing: face.is_playing(),
                recording_secs: face.recorded_secs(),
                frame_rate: FRAME_RATE,
            },
            speaking: around.talking.shown(face),
            live: Some(around.live),
            gaze: Some(self.pointing.follows),
            life: Some(face.lives()),
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
            messages: around.messages,
            loading: loading.as_deref().map(|what| avatar_panel::Loading { what, fraction }),
            stats: Stats {
                adapter,
                triangles,
                strands,
                passes: self.frames.passes(),
                frame_ms: self.frames.history(),
            },
            recent: &recent,
            cameras: &Place::ALL.map(Place::name),
            film_formats: &formats,
            film: session.filming.as_ref().map(Filming::progress),
            full_screen: stage.window().fullscreen().is_some(),
            ..Model::new(face.controls(), books.poses())
        };
        Some(overlay.run(stage.window(), &model, actions))
    }

    /// Draws the face and the panel.
    fn draw(
        &mut self,
        session: &Session,
        painted: Option<&Painted>,
        acts: bool,
        change: Change,
    ) -> Result<Drawn> {
        let shot = self.shot(session, painted.map(|painted| painted.free));
        let Some(stage) = &mut self.stage else { return Ok(Drawn::default()) };
        let hangs = !acts && (!session.face.lives() || change.spares_hair(stage.is_software()));
        stage.advance_hair(self.frames.swing(!acts, stage.has_swinging_hair()), hangs);
        let moves = acts || self.frames.swings();
        let drawn = stage.draw(&shot, self.overlay.as_mut().zip(painted), moves, change)?;
        if drawn.is_shown && !acts {
            self.stirring.drawn(drawn.all, drawn.part);
        }
        Ok(drawn)
    }

    /// Draws the small picture of one pose that has none, while nothing moves and the poses are seen. Returns
    /// whether it did: then there may be more.
    fn draw_miniature(&mut self, session: &Session, is_at_rest: bool) -> Result<bool> {
        let background = self.background();
        let (Some(overlay), Some(stage)) = (&self.overlay, &mut self.stage) else { return Ok(false) };
        let state = overlay.panel.state();
        let are_seen = state.tab == avatar_panel::Tab::Poses && !state.folded;
        // The face itself comes first.
        if !is_at_rest || !are_seen || stage.shows_draft() {
            return Ok(false);
        }
        let poses = &session.books.poses().poses;
        let Some(pose) = self.frames.missing_miniature(poses, background) else { return Ok(false) };
        let mut values = session.face.controls().defaults();
        pose.values.iter().for_each(|(control, value)| values[*control] = *value);
        let picture = stage.miniature(session.face.pack(), &values, background)?;
        let size = [picture.width() as usize, picture.height() as usize];
        let image = egui::ColorImage::from_rgba_unmultiplied(size, picture.as_raw());
        let texture = overlay.ctx.load_texture(&pose.name, image, egui::TextureOptions::LINEAR);
        self.frames.add_miniature(pose, background, texture);
        Ok(true)
    }
}
