//! Above the tracks: playing, and what is known of the chosen key.

use super::Timeline;
use super::track_row::limits;
use crate::style::palette;
use crate::widgets::{Icon, icon_button, icon_button_if, named, passed_by};
use crate::{Action, Edit, Model};
use egui::{Button, ComboBox, DragValue, Rect, Role, Sense, Shape, Stroke, Ui, WidgetInfo, pos2, vec2};
use pose_anim::{Clip, Easing, Transition, Wrap};

const WRAPS: [(Wrap, &str); 3] = [(Wrap::Once, "Once"), (Wrap::Loop, "Loop"), (Wrap::PingPong, "To and fro")];

/// Playing and, where the timeline is open, editing; whether it is.
pub(crate) fn transport(
    timeline: &mut Timeline,
    ui: &mut Ui,
    model: &Model<'_>,
    index: usize,
    playhead_secs: f64,
    folded: Option<&mut bool>,
    actions: &mut Vec<Action>,
) -> bool {
    let clip = &model.clips[index];
    let own = model.playback.clip == Some(index);
    ui.horizontal_wrapped(|ui| {
        let is_open = folded.is_some_and(|folded| {
            let (icon, name) =
                if *folded { (Icon::Up, "Open the timeline") } else { (Icon::Down, "Fold the timeline") };
            if icon_button(ui, icon, name).clicked() {
                *folded = !*folded;
            }
            !*folded
        });
        if own && model.playback.playing {
            if icon_button(ui, Icon::Pause, "Pause").clicked() {
                actions.push(Action::Pause);
            }
        } else if icon_button(ui, Icon::Play, "Play").clicked() {
            actions.push(Action::Play(index));
        }
        if icon_button_if(ui, own, Icon::Stop, "Stop").clicked() {
            actions.push(Action::Stop);
        }
        let text = WRAPS.iter().find(|(wrap, _)| *wrap == clip.wrap).map_or("", |(_, text)| text);
        let wraps = ComboBox::from_id_salt("wrap").width(80.0).selected_text(text).show_ui(ui, |ui| {
            for (wrap, text) in WRAPS {
                if ui.selectable_label(clip.wrap == wrap, text).clicked() && clip.wrap != wrap {
                    actions.push(Action::Edit(Edit::SetWrap { clip: index, wrap }));
                }
            }
        });
        named(&wraps.response, || format!("What follows the end: {text}"));
        ui.monospace(format!("{playhead_secs:.2} / {:.2} s", clip.duration_secs()));
        if !is_open {
            return is_open;
        }
        let chosen = timeline.control.filter(|control| clip.track(*control).is_some());
        let insert = ui.add_enabled(chosen.is_some(), Button::new("Insert key"));
        let insert = insert
            .on_hover_text("At the playhead, without changing the curve")
            .on_disabled_hover_text("Choose a track first");
        if let (true, Some(control)) = (insert.clicked(), chosen) {
            actions.push(Action::Edit(Edit::InsertKey { clip: index, control, time_secs: playhead_secs }));
        }
        let add = ui.menu_button("Add track", |ui| {
            egui::ScrollArea::vertical().max_height(240.0).show(ui, |ui| {
                for (control, of) in model.controls.controls().iter().enumerate() {
                    if clip.track(control).is_none() && ui.button(&of.name).clicked() {
                        actions.push(Action::Edit(Edit::InsertKey {
                            clip: index,
                            control,
                            time_secs: playhead_secs,
                        }));
                        timeline.control = Some(control);
                        ui.close();
                    }
                }
            });
        });
        add.response.on_hover_text("Begins with the control's present value");
        if icon_button(ui, Icon::Minus, "Show more time").clicked() {
            timeline.zoom_by(0.5);
        }
        if icon_button(ui, Icon::Plus, "Show less time").clicked() {
            timeline.zoom_by(2.0);
        }
        if icon_button(ui, Icon::Fit, "Show the whole clip").clicked() {
            timeline.fit();
        }
        is_open
    })
    .inner
}

/// Time, value and transition of the chosen key.
pub(crate) fn inspector(
    timeline: &mut Timeline,
    ui: &mut Ui,
    model: &Model<'_>,
    index: usize,
    clip: &Clip,
    actions: &mut Vec<Action>,
) {
    let chosen = timeline.control.zip(timeline.key);
    let track = chosen.and_then(|(control, _)| clip.track(control));
    let control = chosen.and_then(|(control, _)| model.controls.controls().get(control));
    let (Some((at, key)), Some(track), Some(control)) = (chosen, track, control) else {
        ui.weak("Drag a key to move it, double-click a track to add one.");
        return;
    };
    let Some(found) = track.keys().get(key) else { return };
    ui.horizontal_wrapped(|ui| {
        ui.strong(format!("{} {}/{}", control.name, key + 1, track.keys().len()));
        let (mut time_secs, mut value) = (found.time_secs, found.value);
        let (low, high) = limits(track, key);
        let entry =
            DragValue::new(&mut time_secs).range(low..=high).speed(0.005).max_decimals(3).suffix(" s");
        let time = ui.add(entry.update_while_editing(false));
        named(&time, || "Time of the key, seconds".to_owned());
        let (sign, unit, decimals) = crate::groups::unit(control);
        let speed = f64::from(control.max - control.min) / 200.0;
        let range = f64::from(control.min)..=f64::from(control.max);
        let entry = DragValue::new(&mut value)
            .range(range)
            .clamp_existing_to_range(false)
            .speed(speed)
            .max_decimals(decimals)
            .suffix(sign);
        let amount = ui.add(entry.update_while_editing(false));
        named(&amount, || format!("Value of the key, {unit}"));
        if passed_by(&time, found.time_secs, time_secs, 3) {
            time_secs = found.time_secs;
        }
        if passed_by(&amount, found.value, value, decimals) {
            value = found.value;
        }
        if (time_secs, value) != (found.time_secs, found.value) {
            actions.push(Action::Edit(Edit::MoveKey { clip: index, control: at, key, time_secs, value }));
        }
        if key + 1 < track.keys().len() {
            transition(timeline, ui, found.transition, &mut |easing| {
                actions.push(Action::Edit(Edit::SetTransition { clip: index, control: at, key, easing }));
            });
        }
        if ui.button("Delete key").clicked() {
            actions.push(Action::Edit(Edit::DeleteKey { clip: index, control: at, key }));
            timeline.key = None;
        }
    });
}

fn transition(timeline: &Timeline, ui: &mut Ui, now: Transition, choose: &mut dyn FnMut(Easing)) {
    let easing = match now {
        Transition::Ease(easing) => Some(easing),
        Transition::Part { .. } | Transition::Hermite { .. } => None,
    };
    let name = |easing: Easing| {
        timeline.easings.iter().find(|(_, other)| *other == easing).map(|(name, _)| name.as_str())
    };
    let text = match now {
        Transition::Ease(easing) => name(easing).unwrap_or("own curve"),
        Transition::Part { .. } => "part of a curve",
        Transition::Hermite { .. } => "slopes",
    };
    let shown = ComboBox::from_id_salt("transition").width(110.0).selected_text(text).show_ui(ui, |ui| {
        for (index, (name, other)) in timeline.easings.iter().enumerate() {
            // Two names may mean the same.
            if timeline.easings[..index].iter().any(|(_, before)| before == other) {
                continue;
            }
            let row = ui.horizontal(|ui| {
                curve(ui, *other, vec2(26.0, 18.0));
                ui.selectable_label(easing == Some(*other), name)
            });
            if row.inner.clicked() {
                choose(*other);
            }
        }
    });
    named(&shown.response, || format!("Transition: {text}"));
    if let Some(easing) = easing {
        curve(ui, easing, vec2(44.0, 22.0));
    }
}

/// A drawing of a transition function; what overshoots stays within its frame.
fn curve(ui: &mut Ui, easing: Easing, size: egui::Vec2) {
    const STEPS: usize = 32;
    let (rect, response) = ui.allocate_exact_size(size, Sense::hover());
    response.widget_info(|| WidgetInfo::labeled(Role::Image, true, "Curve of the transition"));
    let place = Rect::from_center_size(rect.center(), size * vec2(0.9, 0.6));
    let point = |step: usize| {
        let s = step as f64 / STEPS as f64;
        pos2(
            place.left() + s as f32 * place.width(),
            place.bottom() - easing.at(s).value as f32 * place.height(),
        )
    };
    let colors = palette(ui);
    let painter = ui.painter().with_clip_rect(rect.intersect(ui.clip_rect()));
    painter.rect_filled(rect, 3, colors.ground);
    painter.add(Shape::line((0..=STEPS).map(point).collect(), Stroke::new(1.5, colors.accent)));
}
