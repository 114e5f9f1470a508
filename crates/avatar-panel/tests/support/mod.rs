//! A program around the panel: it carries actions out as a window would, and keeps them to be looked at.
#![allow(dead_code, reason = "each test needs a part of it")]
#![allow(clippy::unwrap_used, clippy::expect_used, reason = "it is part of tests")]

pub(crate) mod canvas;

use avatar_panel::{
    Action, Edit, FileClip, FilePlayback, FilmProgress, KeyRow, Live, Loading, Message, Model, Panel,
    PanelState, Playback, PoseForm, Speaking, Stats, Tab,
};
use egui::{Rect, UiBuilder, Vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;
use pose_anim::{Clip, Control, ControlTable, Drive, Key, Pace, Pose, PoseSet, Track, Transition};

pub(crate) type Window<'a> = Harness<'a, World>;

/// Clicks what has this label, and lets the panel answer.
pub(crate) fn click(window: &mut Window<'_>, label: &str) {
    window.get_by_label(label).click();
    window.run_steps(4);
}

pub(crate) struct World {
    pub(crate) panel: Panel,
    pub(crate) controls: ControlTable,
    pub(crate) values: Vec<f32>,
    pub(crate) highlighted: Vec<usize>,
    pub(crate) poses: PoseSet,
    pub(crate) thumbnails: Vec<Option<egui::TextureId>>,
    pub(crate) active_pose: Option<usize>,
    pub(crate) can_save: Result<(), &'static str>,
    pub(crate) undo: Option<&'static str>,
    pub(crate) redo: Option<&'static str>,
    pub(crate) clips: Vec<Clip>,
    pub(crate) playback: Playback,
    pub(crate) file_clips: Vec<FileClip<'static>>,
    pub(crate) file_playback: Option<FilePlayback>,
    pub(crate) speaking: Speaking<'static>,
    pub(crate) live: Option<Live<'static>>,
    pub(crate) life: Option<bool>,
    pub(crate) keys: Vec<KeyRow<'static>>,
    pub(crate) messages: Vec<Message<'static>>,
    pub(crate) loading: Option<Loading<'static>>,
    pub(crate) film: Option<FilmProgress>,
    pub(crate) stats: Stats<'static>,
    pub(crate) log: Vec<Action>,
    pub(crate) free: Rect,
}

impl World {
    pub(crate) fn new() -> Self {
        Self::with(ControlTable::default_face())
    }

    pub(crate) fn with(controls: ControlTable) -> Self {
        let poses = PoseSet::default_face(&controls);
        Self {
            panel: Panel::new(PanelState { seen_hint: true, ..PanelState::default() }),
            values: controls.defaults(),
            highlighted: Vec::new(),
            poses,
            thumbnails: Vec::new(),
            active_pose: None,
            can_save: Ok(()),
            undo: None,
            redo: None,
            clips: Vec::new(),
            playback: Playback { frame_rate: 50.0, ..Playback::default() },
            file_clips: Vec::new(),
            file_playback: None,
            speaking: Speaking::NOTHING,
            live: None,
            life: None,
            keys: vec![
                KeyRow { key: "F1, ?", meaning: "this help", group: "Window" },
                KeyRow { key: "F11", meaning: "full screen", group: "Window" },
                KeyRow { key: "Space", meaning: "plays or pauses the clip", group: "Clips" },
            ],
            messages: Vec::new(),
            loading: None,
            film: None,
            stats: Stats::default(),
            log: Vec::new(),
            free: Rect::NOTHING,
            controls,
        }
    }

    pub(crate) fn on(mut self, tab: Tab) -> Self {
        self.panel = Panel::new(PanelState { tab, ..self.panel.state() });
        self
    }

    /// A clip that nods: 0 at 0 s, 10 at 0.5 s, 0 at 1 s.
    pub(crate) fn nodding(mut self) -> Self {
        let bow = self.control("head.bow");
        let key = |time_secs, value| Key { time_secs, value, transition: Transition::LINEAR };
        let track = Track::new(bow, vec![key(0.0, 0.0), key(0.5, 10.0), key(1.0, 0.0)]).unwrap();
        self.clips.push(Clip::new("nod", vec![track]).unwrap());
        self
    }

    pub(crate) fn control(&self, name: &str) -> usize {
        self.controls.index(name).unwrap()
    }

    pub(crate) fn window<'a>(self, size: impl Into<Vec2>) -> Window<'a> {
        let canvas = canvas::Canvas::default();
        let window =
            Harness::builder().with_size(size).with_max_steps(40).with_step_dt(1.0 / 60.0).renderer(canvas);
        window.build_ui_state(|ui, world: &mut Self| world.frame(ui), self)
    }

    pub(crate) fn frame(&mut self, ui: &mut egui::Ui) {
        let mut actions = Vec::new();
        let model = Model {
            values: &self.values,
            highlighted: &self.highlighted,
            thumbnails: &self.thumbnails,
            active_pose: self.active_pose,
            can_save: self.can_save,
            can_undo: self.undo,
            can_redo: self.redo,
            clips: &self.clips,
            clips_changed: true,
            playback: self.playback,
            file_clips: &self.file_clips,
            file_playback: self.file_playback,
            speaking: self.speaking,
            live: self.live,
            life: self.life,
            keys: &self.keys,
            reserved_keys: &["F1"],
            messages: &self.messages,
            loading: self.loading,
            film: self.film,
            stats: self.stats,
            cameras: &["front", "left", "close"],
            film_formats: &["PNG frames"],
            ..Model::new(&self.controls, &self.poses)
        };
        // The whole window, as in the root of a program.
        let whole = ui.ctx().content_rect();
        let mut root = ui.new_child(UiBuilder::new().id_salt("root").max_rect(whole));
        root.set_clip_rect(whole);
        self.free = self.panel.show(&mut root, &model, &mut actions);
        actions.iter().for_each(|action| self.carry_out(action));
        self.log.extend(actions);
    }

    fn carry_out(&mut self, action: &Action) {
        match action {
            Action::SetControl { control, value, .. } => self.values[*control] = *value,
            Action::ResetControl(control) => {
                self.values[*control] = self.controls.controls()[*control].default
            }
            Action::ResetAll => self.values = self.controls.defaults(),
            Action::GoTo(index) => self.active_pose = Some(*index),
            Action::Edit(Edit::SavePose(form)) => {
                self.poses.poses.push(named(Pose::from_values("", &self.values), form))
            }
            Action::Edit(Edit::EditPose { index, form }) => {
                self.poses.poses[*index] = named(self.poses.poses[*index].clone(), form);
            }
            Action::Edit(Edit::MovePose { from, to }) => {
                let pose = self.poses.poses.remove(*from);
                self.poses.poses.insert(*to, pose);
            }
            Action::Edit(Edit::DeletePose(index)) => drop(self.poses.poses.remove(*index)),
            Action::Scrub { clip, time_secs } => {
                self.playback =
                    Playback { clip: Some(*clip), time_secs: *time_secs, playing: false, ..self.playback };
            }
            Action::Play(clip) => {
                self.playback = Playback { clip: Some(*clip), playing: true, ..self.playback };
            }
            Action::Speak => self.speaking.is_speaking = true,
            Action::Microphone => {
                self.speaking.microphone = self.speaking.microphone.map(|is_on| !is_on);
            }
            Action::StopSpeaking => self.speaking.is_speaking = false,
            Action::SpeechAmount(amount) => self.speaking.amount = *amount,
            Action::Life => self.life = self.life.map(|lives| !lives),
            Action::Pause => self.playback.playing = false,
            Action::Edit(Edit::SetWrap { clip, wrap }) => self.clips[*clip].wrap = *wrap,
            Action::Edit(Edit::InsertKey { clip, control, time_secs }) => {
                if self.clips[*clip].track(*control).is_none() {
                    let value = f64::from(self.values[*control]);
                    let key = Key { time_secs: *time_secs, value, transition: Transition::LINEAR };
                    let mut tracks = self.clips[*clip].tracks().to_vec();
                    tracks.push(Track::new(*control, vec![key]).unwrap());
                    self.clips[*clip] = Clip::new(self.clips[*clip].name.clone(), tracks).unwrap();
                }
                self.track(*clip, *control).bake(*time_secs).unwrap();
            }
            Action::Edit(Edit::MoveKey { clip, control, key, time_secs, value }) => {
                self.track(*clip, *control).move_key(*key, *time_secs, *value).unwrap();
            }
            Action::Edit(Edit::DeleteKey { clip, control, key }) => {
                self.track(*clip, *control).remove_key(*key).unwrap();
            }
            Action::Edit(Edit::SetTransition { clip, control, key, easing }) => {
                self.track(*clip, *control).set_transition(*key, Transition::Ease(*easing)).unwrap();
            }
            Action::Dismiss(index) => drop(self.messages.remove(*index)),
            _ => {}
        }
    }

    fn track(&mut self, clip: usize, control: usize) -> &mut Track {
        self.clips[clip].track_mut(control).unwrap()
    }
}

fn named(mut pose: Pose, form: &PoseForm) -> Pose {
    pose.name = form.name.clone();
    pose.key = form.key.clone();
    pose.duration_secs = form.duration_secs;
    pose
}

/// A face with this many controls.
pub(crate) fn many(count: usize) -> ControlTable {
    let control = |index: usize| Control {
        name: format!("part{:02}.control{index:03}", index / 12),
        drives: Drive::Shape { shape: format!("Shape{index}") },
        min: 0.0,
        max: 1.0,
        default: 0.0,
        pace: Pace::SHAPE,
        group: None,
    };
    ControlTable::new((0..count).map(control).collect()).unwrap()
}
