//! The timeline of a clip: a row for each control, its keys, and the playhead.

mod bar;
mod track_row;

use crate::style::palette;
use crate::{Action, Model};
use egui::{
    Align2, EventFilter, FontId, Key, Pos2, Rangef, Rect, ScrollArea, Sense, Stroke, Ui, WidgetInfo, pos2,
    vec2,
};
use pose_anim::{Clip, Easing};

/// What the timeline has in mind.
#[derive(Clone, Debug, Default)]
pub(crate) struct Timeline {
    /// The clip that is shown.
    pub(crate) clip: Option<usize>,
    /// The control of the row that is chosen.
    pub(crate) control: Option<usize>,
    /// Index of the chosen key in that row.
    pub(crate) key: Option<usize>,
    /// A key that the pointer holds: its control, index and time.
    pub(crate) held: Option<(usize, usize, f64)>,
    /// Transition functions by name, made once.
    pub(crate) easings: Vec<(String, Easing)>,
    /// The clip that played or was made last: it is shown once it changes.
    followed: Option<usize>,
    /// Time at the left edge.
    start_secs: f64,
    /// How much closer than the whole clip.
    zoom: f64,
}

/// How times lie on the screen.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Scale {
    /// Where the tracks lie.
    pub(crate) x: Rangef,
    pub(crate) start_secs: f64,
    pub(crate) points_per_sec: f64,
    pub(crate) frame_rate: f64,
}

impl Scale {
    pub(crate) fn x_of(&self, secs: f64) -> f32 {
        self.x.min + ((secs - self.start_secs) * self.points_per_sec) as f32
    }

    pub(crate) fn secs_at(&self, x: f32) -> f64 {
        self.start_secs + f64::from(x - self.x.min) / self.points_per_sec
    }

    /// The nearest frame, not before the start.
    pub(crate) fn snapped(&self, secs: f64) -> f64 {
        ((secs * self.frame_rate).round() / self.frame_rate).max(0.0)
    }

    pub(crate) fn frame_secs(&self) -> f64 {
        1.0 / self.frame_rate
    }
}

/// Width of the names of the rows.
const NAMES: f32 = 110.0;
const RULER: f32 = 20.0;
/// Room for the text of a tick.
const LABEL: f32 = 28.0;
const ROW: f32 = 26.0;
const MAX_ZOOM: f64 = 200.0;

impl Timeline {
    /// Drops what the clips no longer have; `None` where there is nothing to show.
    pub(crate) fn refresh<'a>(&mut self, model: &Model<'a>) -> Option<(usize, &'a Clip)> {
        let last = model.clips.len().checked_sub(1)?;
        let before = self.clip;
        if self.followed != model.playback.clip {
            self.followed = model.playback.clip;
            self.clip = self.followed.or(self.clip);
        }
        let index = self.clip.unwrap_or(0).min(last);
        if before != Some(index) {
            (self.clip, self.control, self.key, self.held) = (Some(index), None, None, None);
        }
        let clip = &model.clips[index];
        let keys = self.control.and_then(|control| clip.track(control)).map_or(0, |track| track.keys().len());
        self.key = self.key.filter(|key| *key < keys);
        if self.easings.is_empty() {
            let easing = |name: String| Easing::from_name(&name).map(|easing| (name, easing));
            self.easings = Easing::names().into_iter().filter_map(easing).collect();
        }
        Some((index, clip))
    }

    /// Shows it all, or the buttons only: where it is folded, or where there is no room, which is `None`.
    pub(crate) fn show(
        &mut self,
        ui: &mut Ui,
        model: &Model<'_>,
        folded: Option<&mut bool>,
        actions: &mut Vec<Action>,
    ) {
        let Some((index, clip)) = self.refresh(model) else { return };
        let playhead_secs = if model.playback.clip == Some(index) { model.playback.time_secs } else { 0.0 };
        let is_open = bar::transport(self, ui, model, index, playhead_secs, folded, actions);
        if !is_open {
            return;
        }
        bar::inspector(self, ui, model, index, clip, actions);
        let scale = self.scale(ui, model, clip);
        self.ruler(ui, &scale, index, playhead_secs, actions);
        if clip.tracks().is_empty() {
            ui.weak("No keys yet. Add a track, or record.");
        }
        let top = ui.cursor().top();
        ui.spacing_mut().item_spacing.y = 2.0;
        let rows = ScrollArea::vertical().id_salt("tracks").auto_shrink([false, true]);
        let shown = rows.show_rows(ui, ROW, clip.tracks().len(), |ui, lines| {
            for line in lines {
                if let Some(track) = clip.tracks().get(line) {
                    let (rect, _) = ui.allocate_exact_size(vec2(ui.available_width(), ROW), Sense::hover());
                    track_row::show(self, ui, rect, NAMES, model, &scale, index, track, actions);
                }
            }
        });
        let x = scale.x_of(playhead_secs);
        if scale.x.contains(x) {
            let line = Stroke::new(1.5, palette(ui).accent);
            ui.painter().vline(x, top - 4.0..=shown.inner_rect.bottom(), line);
        }
    }

    pub(crate) fn zoom_by(&mut self, factor: f64) {
        self.zoom = (self.zoom.max(1.0) * factor).clamp(1.0, MAX_ZOOM);
    }

    pub(crate) fn fit(&mut self) {
        (self.zoom, self.start_secs) = (1.0, 0.0);
    }

    /// Where times lie, after wheel and pinch.
    fn scale(&mut self, ui: &Ui, model: &Model<'_>, clip: &Clip) -> Scale {
        let whole = ui.available_rect_before_wrap();
        let x =
            Rangef::new(whole.left() + NAMES + 8.0, (whole.right() - 14.0).max(whole.left() + NAMES + 40.0));
        let rate = model.playback.frame_rate;
        let frame_rate = if rate.is_finite() && rate > 0.0 { rate } else { 60.0 };
        // Room to add keys after the last one.
        let whole_secs = (1.1 * clip.duration_secs()).max(1.0);
        let fitting = f64::from(x.span()) / whole_secs;
        let over = ui.rect_contains_pointer(whole);
        let (wheel, pinch, pointer) = ui.input(|input| {
            (input.smooth_scroll_delta().x, f64::from(input.zoom_delta()), input.pointer.hover_pos())
        });
        let before = fitting * self.zoom.max(1.0);
        if over && pinch != 1.0 {
            self.zoom_by(pinch);
            // What is under the pointer stays there.
            let offset = f64::from(pointer.map_or(0.0, |at| at.x - x.min));
            self.start_secs += offset / before - offset / (fitting * self.zoom);
        }
        let points_per_sec = fitting * self.zoom.max(1.0);
        if over {
            self.start_secs -= f64::from(wheel) / points_per_sec;
        }
        let visible_secs = f64::from(x.span()) / points_per_sec;
        self.start_secs = self.start_secs.min(whole_secs - visible_secs).max(0.0);
        Scale { x, start_secs: self.start_secs, points_per_sec, frame_rate }
    }

    fn ruler(
        &mut self,
        ui: &mut Ui,
        scale: &Scale,
        clip: usize,
        playhead_secs: f64,
        actions: &mut Vec<Action>,
    ) {
        let (whole, _) = ui.allocate_exact_size(vec2(ui.available_width(), RULER), Sense::hover());
        let rect = Rect::from_x_y_ranges(scale.x, whole.y_range());
        let response = ui.interact(rect, ui.scope_id().with("ruler"), Sense::click_and_drag());
        response.widget_info(|| WidgetInfo::slider(true, playhead_secs, "Playhead, seconds"));
        let mut wanted = None;
        if response.is_pointer_button_down_on() || response.clicked() {
            wanted = response
                .interact_pointer_pos()
                .map(|at| scale.snapped(scale.secs_at(at.x.clamp(scale.x.min, scale.x.max))));
        }
        if response.has_focus() {
            let filter = EventFilter { horizontal_arrows: true, ..EventFilter::default() };
            ui.memory_mut(|memory| memory.set_focus_lock_filter(response.id, filter));
            let steps = ui.input(|input| {
                input.num_presses(Key::ArrowRight) as f64 - input.num_presses(Key::ArrowLeft) as f64
            });
            if steps != 0.0 {
                wanted = Some(scale.snapped(playhead_secs + steps * scale.frame_secs()));
            }
        }
        if let Some(time_secs) = wanted.filter(|secs| *secs != playhead_secs) {
            actions.push(Action::Scrub { clip, time_secs });
        }
        paint_ruler(ui, rect, scale, playhead_secs, response.has_focus());
    }
}

fn paint_ruler(ui: &Ui, rect: Rect, scale: &Scale, playhead_secs: f64, focused: bool) {
    let colors = palette(ui);
    let painter = ui.painter().with_clip_rect(rect.expand2(vec2(12.0, 0.0)));
    let edge = if focused { Stroke::new(1.0, colors.accent) } else { Stroke::NONE };
    painter.rect(rect, 3, colors.ground, edge, egui::StrokeKind::Inside);
    let step_secs = step(60.0 / scale.points_per_sec);
    let decimals = if step_secs >= 1.0 {
        0
    } else if step_secs >= 0.1 {
        1
    } else {
        2
    };
    let weak = ui.visuals().weak_text_color();
    let first = (scale.start_secs / step_secs).ceil() as u64;
    let count = (f64::from(rect.width()) / (step_secs * scale.points_per_sec)) as u64 + 1;
    for tick in first..=first + count {
        let secs = tick as f64 * step_secs;
        let x = scale.x_of(secs);
        if rect.x_range().contains(x) {
            painter.vline(x, rect.bottom() - 5.0..=rect.bottom(), Stroke::new(1.0, weak));
            // The last one stands before its line.
            let (align, x) = match rect.right() - x < LABEL {
                true => (Align2::RIGHT_TOP, x - 3.0),
                false => (Align2::LEFT_TOP, x + 3.0),
            };
            let text = format!("{secs:.decimals$}");
            painter.text(pos2(x, rect.top() + 2.0), align, text, FontId::proportional(11.0), weak);
        }
    }
    let x = scale.x_of(playhead_secs);
    if rect.x_range().contains(x) {
        let corner = |dx: f32, y: f32| -> Pos2 { pos2(x + dx, y) };
        let (top, bottom) = (rect.top() + 4.0, rect.bottom());
        let points = vec![
            corner(-5.0, top),
            corner(5.0, top),
            corner(5.0, bottom - 5.0),
            corner(0.0, bottom),
            corner(-5.0, bottom - 5.0),
        ];
        painter.add(egui::Shape::convex_polygon(points, colors.accent, Stroke::NONE));
    }
}

/// The least of 1, 2 and 5 times a power of ten that is no less.
fn step(least: f64) -> f64 {
    let power = 10f64.powf(least.max(1e-3).log10().floor());
    [1.0, 2.0, 5.0, 10.0]
        .into_iter()
        .map(|factor| factor * power)
        .find(|step| *step >= least)
        .unwrap_or(10.0 * power)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_stand_at_round_times() {
        for (least, expected) in
            [(0.9, 1.0), (1.0, 1.0), (1.1, 2.0), (3.0, 5.0), (7.0, 10.0), (0.013, 0.02), (40.0, 50.0)]
        {
            assert!((step(least) - expected).abs() < 1e-9, "{least}: {}", step(least));
        }
    }

    #[test]
    fn places_and_times_are_each_others_inverses() {
        let scale =
            Scale { x: Rangef::new(100.0, 500.0), start_secs: 2.0, points_per_sec: 80.0, frame_rate: 25.0 };
        assert_eq!(scale.x_of(2.0), 100.0);
        assert!((scale.secs_at(scale.x_of(3.7)) - 3.7).abs() < 1e-5);
        assert!((scale.snapped(1.23) - 1.24).abs() < 1e-12);
        assert_eq!(scale.snapped(-0.3), 0.0);
    }
}
