//! One row of the timeline: the curve of a control and its keys.

use super::{Scale, Timeline};
use crate::style::palette;
use crate::{Action, Edit, Model};
use egui::{
    Align2, EventFilter, Key, Rect, Role, Sense, Shape, Stroke, TextStyle, Ui, UiBuilder, WidgetInfo, pos2,
    vec2,
};
use pose_anim::{Control, Track};

/// Points between keys below which the next one is not drawn: nobody could tell them apart.
const CLOSEST: f32 = 3.0;
/// Points between places where the curve is taken.
const CURVE_STEP: f32 = 3.0;
/// Share of a control's range that a row shows at least.
const LEAST_SHOWN: f64 = 0.1;

#[expect(clippy::too_many_arguments, reason = "one call, and each of them is another thing")]
pub(crate) fn show(
    timeline: &mut Timeline,
    ui: &mut Ui,
    rect: Rect,
    names: f32,
    model: &Model<'_>,
    scale: &Scale,
    clip: usize,
    track: &Track,
    actions: &mut Vec<Action>,
) {
    let Some(control) = model.controls.controls().get(track.control()) else { return };
    let builder =
        UiBuilder::new().scope_id(ui.scope_id().with(("track", clip, track.control()))).max_rect(rect);
    // The row has its place already: a scope would set the next one's back.
    let ui = &mut ui.new_child(builder);
    let place = Rect::from_x_y_ranges(scale.x, rect.y_range());
    let chosen = timeline.control == Some(track.control());
    name(timeline, ui, Rect::from_min_size(rect.min, vec2(names, rect.height())), control, track, chosen);
    let ground = ui.interact(place, ui.scope_id().with("ground"), Sense::CLICK);
    paint(ui, place, scale, control, track, chosen);
    if ground.clicked() {
        (timeline.control, timeline.key) = (Some(track.control()), None);
    }
    if ground.double_clicked()
        && let Some(at) = ground.interact_pointer_pos()
    {
        let time_secs = scale.snapped(scale.secs_at(at.x));
        actions.push(Action::Edit(Edit::InsertKey { clip, control: track.control(), time_secs }));
    }
    keys(timeline, ui, place, scale, clip, control, track, actions);
}

fn name(timeline: &mut Timeline, ui: &Ui, rect: Rect, control: &Control, track: &Track, chosen: bool) {
    let response = ui.interact(rect, ui.scope_id().with("name"), Sense::click());
    response
        .widget_info(|| WidgetInfo::selected(Role::Button, true, chosen, format!("track {}", control.name)));
    let look = ui.style().interact_selectable(&response, chosen);
    let painter = ui.painter().with_clip_rect(rect.intersect(ui.clip_rect()));
    if chosen || response.hovered() || response.has_focus() {
        painter.rect(rect, 4, look.weak_bg_fill, look.bg_stroke, egui::StrokeKind::Inside);
    }
    let font = TextStyle::Body.resolve(ui.style());
    painter.text(
        rect.left_center() + vec2(6.0, 0.0),
        Align2::LEFT_CENTER,
        &control.name,
        font,
        look.text_color(),
    );
    let response = response.on_hover_text(&control.name);
    if response.gained_focus() {
        response.scroll_to_me(None);
    }
    if response.clicked() {
        (timeline.control, timeline.key) = (Some(track.control()), None);
    }
}

/// The values that a row shows from bottom to top: those of its keys, but no less than a part of the
/// control's range, so that a tremor does not look like a leap.
fn shown(control: &Control, track: &Track) -> [f64; 2] {
    let values = track.keys().iter().map(|key| key.value);
    let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)));
    let least = LEAST_SHOWN * f64::from(control.max - control.min);
    let missing = (least - (high - low)).max(0.0) / 2.0;
    [low - missing, high + missing]
}

/// Height of a value in the row.
fn y_of([low, high]: [f64; 2], rect: Rect, value: f64) -> f32 {
    let share = if high > low { ((value - low) / (high - low)).clamp(0.0, 1.0) } else { 0.5 };
    rect.bottom() - 4.0 - share as f32 * (rect.height() - 8.0)
}

fn paint(ui: &Ui, rect: Rect, scale: &Scale, control: &Control, track: &Track, chosen: bool) {
    if !ui.is_rect_visible(rect) {
        return;
    }
    let colors = palette(ui);
    let painter = ui.painter().with_clip_rect(rect.intersect(ui.clip_rect()));
    let edge = if chosen { Stroke::new(1.0, colors.accent.gamma_multiply(0.6)) } else { Stroke::NONE };
    painter.rect(rect, 3, colors.ground, edge, egui::StrokeKind::Inside);
    let values = shown(control, track);
    let places = (rect.width() / CURVE_STEP).ceil() as usize;
    let point = |place: usize| {
        let x = (rect.left() + place as f32 * CURVE_STEP).min(rect.right());
        pos2(x, y_of(values, rect, track.at(scale.secs_at(x)).value))
    };
    let curve: Vec<_> = (0..=places).map(point).collect();
    painter.add(Shape::line(curve, Stroke::new(1.0, ui.visuals().weak_text_color())));
}

#[expect(clippy::too_many_arguments, reason = "one call, and each of them is another thing")]
fn keys(
    timeline: &mut Timeline,
    ui: &Ui,
    rect: Rect,
    scale: &Scale,
    clip: usize,
    control: &Control,
    track: &Track,
    actions: &mut Vec<Action>,
) {
    let colors = palette(ui);
    let keys = track.keys();
    let values = shown(control, track);
    let first = keys.partition_point(|key| scale.x_of(key.time_secs) < rect.left() - 6.0);
    let mut drawn = f32::NEG_INFINITY;
    for (index, key) in keys.iter().enumerate().skip(first) {
        let chosen = timeline.control == Some(track.control()) && timeline.key == Some(index);
        let held = timeline.held.filter(|(of, held, _)| (*of, *held) == (track.control(), index));
        let time_secs = held.map_or(key.time_secs, |(_, _, secs)| secs);
        let x = scale.x_of(time_secs);
        if x > rect.right() + 6.0 && held.is_none() {
            break;
        }
        if x - drawn < CLOSEST && !chosen && held.is_none() {
            continue;
        }
        drawn = x;
        let center = pos2(x, y_of(values, rect, key.value));
        let place = Rect::from_center_size(center, vec2(13.0, 13.0));
        let response = ui.interact(place, ui.scope_id().with(("key", index)), Sense::click_and_drag());
        response.widget_info(|| {
            let name =
                format!("key {} of {}, {:.2} s, {:.2}", index + 1, control.name, key.time_secs, key.value);
            WidgetInfo::selected(Role::Button, true, chosen, name)
        });
        let (low, high) = limits(track, index);
        let moved_to = |secs: f64| {
            Action::Edit(Edit::MoveKey {
                clip,
                control: track.control(),
                key: index,
                time_secs: secs,
                value: key.value,
            })
        };
        if response.clicked() || response.drag_started() {
            (timeline.control, timeline.key) = (Some(track.control()), Some(index));
        }
        if response.dragged()
            && let Some(at) = response.interact_pointer_pos()
        {
            let free = ui.input(|input| input.modifiers.alt);
            let secs = scale.secs_at(at.x);
            let secs = if free { secs } else { scale.snapped(secs) };
            timeline.held = Some((track.control(), index, secs.max(low).min(high)));
        }
        if response.drag_stopped() {
            timeline.held = None;
            if time_secs != key.time_secs {
                actions.push(moved_to(time_secs));
            }
        }
        if response.has_focus() {
            let filter = EventFilter { horizontal_arrows: true, ..EventFilter::default() };
            ui.memory_mut(|memory| memory.set_focus_lock_filter(response.id, filter));
            let (steps, gone) = ui.input(|input| {
                let steps =
                    input.num_presses(Key::ArrowRight) as f64 - input.num_presses(Key::ArrowLeft) as f64;
                (steps, input.key_pressed(Key::Delete) || input.key_pressed(Key::Backspace))
            });
            let secs = scale.snapped(key.time_secs + steps * scale.frame_secs()).max(low).min(high);
            if gone {
                actions.push(Action::Edit(Edit::DeleteKey { clip, control: track.control(), key: index }));
                timeline.key = None;
            } else if steps != 0.0 && secs != key.time_secs {
                actions.push(moved_to(secs));
            }
        }
        if response.gained_focus() {
            (timeline.control, timeline.key) = (Some(track.control()), Some(index));
            response.scroll_to_me(None);
        }
        let marked = chosen || held.is_some();
        let fill = if marked { colors.accent } else { ui.visuals().text_color() };
        let radius = if response.hovered() || marked { 5.5 } else { 4.0 };
        let corners = [vec2(0.0, -radius), vec2(radius, 0.0), vec2(0.0, radius), vec2(-radius, 0.0)];
        let diamond = corners.map(|corner| center + corner).to_vec();
        ui.painter().add(Shape::convex_polygon(diamond, fill, Stroke::new(1.0, ui.visuals().window_fill)));
    }
}

/// Between which times a key can be: those of its neighbours.
pub(crate) fn limits(track: &Track, key: usize) -> (f64, f64) {
    let time =
        |index: Option<usize>| index.and_then(|index| track.keys().get(index)).map(|key| key.time_secs);
    (time(key.checked_sub(1)).unwrap_or(0.0), time(Some(key + 1)).unwrap_or(LATEST_SECS))
}

/// Later than any clip ends.
const LATEST_SECS: f64 = 1e6;
