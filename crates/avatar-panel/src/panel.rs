use crate::clips;
use crate::face::Face;
use crate::poses::Poses;
use crate::timeline::Timeline;
use crate::widgets::{Icon, icon_button};
use crate::{Action, Model, PanelState, Tab, Theme, help, live, notices, overlay, speak, style, view};
use egui::{Align, Align2, Area, Context, Id, Key, Layout, Order, Rect, Ui, vec2};

/// The panel over the picture, and what it has in mind from frame to frame. One panel goes with one
/// [`egui::Context`].
#[derive(Clone, Debug, Default)]
pub struct Panel {
    state: PanelState,
    face: Face,
    poses: Poses,
    timeline: Timeline,
    help: bool,
    /// The state that the caller knows.
    told: Option<PanelState>,
    /// Theme and scale that the context has been told.
    applied: Option<(Theme, f32)>,
    scaling: bool,
    /// Which keys of the help are heard here.
    help_keys: [Option<Key>; 2],
}

/// Share of the window's width that the panel may cover, and of its height the timeline.
const WIDEST: f32 = 0.6;
const HIGHEST: f32 = 0.42;
/// Height of a window in points that is too low for a timeline.
const LOWEST: f32 = 260.0;

impl Panel {
    /// A panel as it was left.
    pub fn new(state: PanelState) -> Self {
        Self { state: state.sound(), help_keys: [Some(Key::F1), Some(Key::Questionmark)], ..Self::default() }
    }

    /// What is to be remembered.
    pub fn state(&self) -> PanelState {
        self.state.clone()
    }

    /// Opens or closes the help. Escape, and F1 and ? where [`Model::help_keys`] has them, are seen by
    /// [`Self::show`] itself: a window that forwards its keys to egui must not call this for them, too.
    pub fn toggle_help(&mut self) {
        self.help = !self.help;
    }

    /// Folds the panel away, or opens it.
    pub fn toggle_folded(&mut self) {
        self.state.folded = !self.state.folded;
    }

    /// Whether a key that is pressed now is the panel's, and not the window's: all of them while text is
    /// typed or the help is open; those that move about and press things while something in the panel has the
    /// keyboard; and always those of the help and Tab, which is the way into the panel.
    pub fn takes_key(&self, ctx: &Context, key: Key) -> bool {
        let moves = [
            Key::ArrowUp,
            Key::ArrowDown,
            Key::ArrowLeft,
            Key::ArrowRight,
            Key::Enter,
            Key::Space,
            Key::Delete,
            Key::Backspace,
            Key::Escape,
        ];
        let focused = ctx.egui_wants_keyboard_input();
        let own = key == Key::Tab || self.help_keys.contains(&Some(key));
        self.help || ctx.text_edit_focused() || own || (focused && moves.contains(&key))
    }

    /// Shows everything in a window's root and appends what the user wants. Returns the rectangle that is
    /// left for the face, in points of the context (times [`egui::Context::pixels_per_point`]: pixels).
    pub fn show(&mut self, ui: &mut Ui, model: &Model<'_>, actions: &mut Vec<Action>) -> Rect {
        let ctx = ui.ctx().clone();
        self.prepare(&ctx);
        self.help_keys = help::own_keys(model.help_keys);
        help::listen(&ctx, &mut self.help, &self.help_keys);
        notices::show(ui, model, actions);
        if self.state.folded {
            self.face.hover(None, actions);
        } else {
            self.show_timeline(ui, model, actions);
            self.show_side(ui, model, actions);
        }
        let free = ui.available_rect_before_wrap();
        if self.state.folded {
            self.opener(&ctx, free);
        }
        // The hint goes first where both have no room.
        let least = if self.state.seen_hint { 200.0 } else { 500.0 };
        if self.state.show_stats && free.width() > least {
            overlay::stats(&ctx, free, &model.stats);
        }
        if !self.state.seen_hint {
            overlay::hint(&ctx, free, model.help_keys, &mut self.state);
        }
        if self.help {
            help::show(&ctx, model.keys, model.help_keys, &mut self.help);
        }
        self.remember(actions);
        free
    }

    /// Tells the context of looks, theme and scale where they have changed.
    fn prepare(&mut self, ctx: &Context) {
        if self.applied.is_none() {
            style::apply(ctx);
        }
        let (theme, scale) = (self.state.theme, self.state.text_scale);
        if self.applied.is_none_or(|(before, _)| before != theme) {
            style::set_theme(ctx, theme);
        }
        if self.applied.is_none_or(|(_, before)| before != scale) {
            ctx.set_zoom_factor(scale);
            // It comes with the next frame; until then the context's own is an old one.
            self.scaling = true;
        } else if !std::mem::take(&mut self.scaling) && ctx.zoom_factor() != scale {
            // By egui's own keys.
            self.state.text_scale = ctx.zoom_factor();
            self.state = self.state.clone().sound();
        }
        self.applied = Some((theme, scale));
    }

    fn remember(&mut self, actions: &mut Vec<Action>) {
        if self.told.as_ref() != Some(&self.state) {
            if self.told.is_some() {
                actions.push(Action::Remember);
            }
            self.told = Some(self.state.clone());
        }
    }

    fn show_timeline(&mut self, ui: &mut Ui, model: &Model<'_>, actions: &mut Vec<Action>) {
        if self.timeline.refresh(model).is_none() || self.state.tab != Tab::Clips {
            ui.skip_ahead_auto_ids(1);
            return;
        }
        let folded = &mut self.state.timeline_folded;
        let (frame, whole) = (style::edge_frame(ui), ui.available_height());
        // Without room for tracks beside everything else there are the buttons only.
        let has_room = whole >= LOWEST;
        let panel = if *folded || !has_room {
            egui::Panel::bottom("avatar-panel folded timeline")
        } else {
            let height = (HIGHEST * whole).clamp(100.0, 420.0);
            egui::Panel::bottom("avatar-panel timeline")
                .resizable(true)
                .default_size(height.min(240.0))
                .size_range(80.0..=height)
        };
        panel.frame(frame).show(ui, |ui| self.timeline.show(ui, model, has_room.then_some(folded), actions));
    }

    fn show_side(&mut self, ui: &mut Ui, model: &Model<'_>, actions: &mut Vec<Action>) {
        let widest = (WIDEST * ui.available_width()).max(200.0).min(ui.available_width());
        let (least, most) = (PanelState::WIDTHS.start().min(widest), PanelState::WIDTHS.end().min(widest));
        let panel = egui::Panel::right("avatar-panel side").resizable(true).show_separator_line(false);
        let panel = panel.default_size(self.state.width.clamp(least, most)).size_range(least..=most);
        let shown = panel.frame(style::edge_frame(ui)).show(ui, |ui| {
            self.tabs(ui);
            ui.add_space(2.0);
            match self.state.tab {
                Tab::Face => self.face.show(ui, model, actions),
                Tab::Poses => self.poses.show(ui, model, actions),
                Tab::Clips => clips::show(ui, model, &mut self.timeline.clip, actions),
                Tab::Speak => speak::show(ui, model, actions),
                Tab::Live => live::show(ui, model, actions),
                Tab::View => view::show(ui, model, &mut self.state, self.timeline.clip, actions),
            }
            if self.state.tab != Tab::Face {
                self.face.hover(None, actions);
            }
        });
        // Where the window narrows it, the user's own width is kept for wider ones.
        let width = shown.response.rect.width();
        let held = ui.input(|input| input.pointer.primary_down());
        if held && width < widest - 1.0 && (width - self.state.width).abs() > 1.0 {
            self.state.width = width;
        }
    }

    fn tabs(&mut self, ui: &mut Ui) {
        // Side by side they need so much.
        let narrow = ui.available_width() < 292.0;
        ui.horizontal_wrapped(|ui| {
            ui.spacing_mut().item_spacing.x = 2.0;
            ui.spacing_mut().button_padding.x = 4.0;
            for (tab, name) in Tab::ALL {
                let button = ui.selectable_label(self.state.tab == tab, name);
                crate::widgets::named(&button, || format!("{name} tab"));
                if button.clicked() {
                    self.state.tab = tab;
                }
            }
            if narrow {
                self.corner(ui);
            } else {
                ui.with_layout(Layout::right_to_left(Align::Center), |ui| self.corner(ui));
            }
        });
    }

    fn corner(&mut self, ui: &mut Ui) {
        ui.spacing_mut().item_spacing.x = 4.0;
        if icon_button(ui, Icon::Right, "Fold the panel").clicked() {
            self.state.folded = true;
        }
        if icon_button(ui, Icon::Help, "Help").clicked() {
            self.help = true;
        }
    }

    /// The button that opens the folded panel.
    fn opener(&mut self, ctx: &Context, free: Rect) {
        let area = Area::new(Id::unique("avatar-panel opener")).order(Order::Middle).pivot(Align2::RIGHT_TOP);
        area.fixed_pos(free.right_top() + vec2(-10.0, 10.0)).show(ctx, |ui| {
            if icon_button(ui, Icon::Left, "Open the panel").clicked() {
                self.state.folded = false;
            }
        });
    }
}
