//! The sliders.

use crate::groups::{self, Row};
use crate::style::palette;
use crate::widgets::{Icon, icon_button, named, passed_by};
use crate::{Action, Model};
use egui::{
    Align, Button, DragValue, Label, Layout, Rect, Response, RichText, ScrollArea, Sense, Slider, TextEdit,
    Ui, UiBuilder, vec2,
};
use pose_anim::Control;
use std::collections::HashSet;
use std::hash::{DefaultHasher, Hash, Hasher};

/// Rows beyond the visible ones that are laid out, so that the keyboard can go on to them.
const MARGIN_ROWS: usize = 2;

/// What the sliders have in mind.
#[derive(Clone, Debug, Default)]
pub(crate) struct Face {
    query: String,
    closed: HashSet<String>,
    rows: Vec<Row>,
    /// What the rows were made of.
    made_of: Option<u64>,
    hovered: Option<usize>,
}

impl Face {
    pub(crate) fn show(&mut self, ui: &mut Ui, model: &Model<'_>, actions: &mut Vec<Action>) {
        self.search(ui, model, actions);
        self.refresh(model);
        if self.rows.is_empty() {
            let nothing = if model.controls.is_empty() {
                "This face has no controls."
            } else {
                "No control has such a name."
            };
            ui.weak(nothing);
        }
        let height = ui.spacing().interact_size.y + 4.0;
        let mut hovered = None;
        let area = ScrollArea::vertical().id_salt("controls").auto_shrink(false);
        area.show_viewport(ui, |ui, viewport| {
            let all = ui.max_rect();
            ui.set_height(height * self.rows.len() as f32);
            let first = ((viewport.min.y / height).floor() as usize).saturating_sub(MARGIN_ROWS);
            let last = (viewport.max.y / height).ceil() as usize + MARGIN_ROWS;
            let mut toggled = None;
            for (line, row) in self.rows.iter().enumerate().take(last).skip(first) {
                let top = all.top() + height * line as f32;
                let rect = Rect::from_min_size(egui::pos2(all.left(), top), vec2(all.width(), height));
                match row {
                    Row::Group { key, title, count } => {
                        if heading(ui, rect, title, *count, self.closed.contains(key)).clicked() {
                            toggled = Some(key.clone());
                        }
                    }
                    Row::Control { index, label } => {
                        if control(ui, rect, model, *index, label, actions) {
                            hovered = Some(*index);
                        }
                    }
                }
            }
            if let Some(key) = toggled {
                self.made_of = None;
                if !self.closed.remove(&key) {
                    self.closed.insert(key);
                }
            }
        });
        self.hover(hovered, actions);
    }

    /// Tells which control the pointer is on, once.
    pub(crate) fn hover(&mut self, hovered: Option<usize>, actions: &mut Vec<Action>) {
        if self.hovered != hovered {
            self.hovered = hovered;
            actions.push(Action::Hover(hovered));
        }
    }

    fn search(&mut self, ui: &mut Ui, model: &Model<'_>, actions: &mut Vec<Action>) {
        ui.horizontal(|ui| {
            const RESET: f32 = 72.0;
            let (height, gap) = (ui.spacing().interact_size.y, ui.spacing().item_spacing.x);
            // What is typed now changes the row in the next frame: wider than the room it was given, it would
            // widen the panel for good.
            let has_cross = !self.query.is_empty();
            let clear = if has_cross { height + gap } else { 0.0 };
            let width = (ui.available_width() - RESET - gap - clear).max(30.0);
            let field = TextEdit::singleline(&mut self.query).hint_text("Search");
            named(&ui.add_sized([width, height], field), || "Search controls".to_owned());
            if has_cross && icon_button(ui, Icon::Cross, "Clear the search").clicked() {
                self.query.clear();
            }
            let controls = model.controls.controls().iter().zip(model.values);
            let changed = controls.into_iter().any(|(control, value)| is_changed(control, *value));
            let reset = Button::new("Reset all").min_size(vec2(RESET, 0.0)).truncate();
            if ui.add_enabled(changed, reset).clicked() {
                actions.push(Action::ResetAll);
            }
        });
    }

    /// Makes the rows anew where something that they depend on has changed.
    fn refresh(&mut self, model: &Model<'_>) {
        let mut hasher = DefaultHasher::new();
        self.query.hash(&mut hasher);
        model.controls.controls().iter().for_each(|one| (&one.name, &one.group).hash(&mut hasher));
        let made_of = Some(hasher.finish());
        if self.made_of != made_of {
            self.made_of = made_of;
            self.rows = groups::rows(model.controls, &self.query, &self.closed);
        }
    }
}

pub(crate) fn is_changed(control: &Control, value: f32) -> bool {
    (value - control.default).abs() > 1e-4 * (control.max - control.min)
}

fn heading(ui: &mut Ui, rect: Rect, title: &str, count: usize, closed: bool) -> Response {
    let id = ui.scope_id().with(("group", title));
    let builder = UiBuilder::new().scope_id(id).max_rect(rect.shrink2(vec2(0.0, 2.0)));
    ui.scope_builder(builder, |ui| {
        let response = ui.interact(rect, id.with("fold"), Sense::click());
        response.widget_info(|| {
            let text = format!("{title}, {count} controls, {}", if closed { "closed" } else { "open" });
            egui::WidgetInfo::selected(egui::Role::DisclosureTriangle, true, !closed, text)
        });
        let color = ui.style().interact(&response).text_color();
        let font = egui::TextStyle::Button.resolve(ui.style());
        let painter = ui.painter();
        let left = rect.left_center() + vec2(2.0, 2.0);
        let (a, b, c) = if closed {
            (vec2(2.0, -4.0), vec2(6.0, 0.0), vec2(2.0, 4.0))
        } else {
            (vec2(0.0, -2.0), vec2(4.0, 2.0), vec2(8.0, -2.0))
        };
        painter.line(vec![left + a, left + b, left + c], egui::Stroke::new(1.5, color));
        let words = painter.text(left + vec2(14.0, 0.0), egui::Align2::LEFT_CENTER, title, font, color);
        let line = egui::Stroke::new(1.0, palette(ui).line);
        ui.painter().hline(words.right() + 8.0..=rect.right(), words.center().y, line);
        if response.gained_focus() {
            response.scroll_to_me(None);
        }
        response
    })
    .inner
}

/// One control; whether the pointer or the keyboard is on it.
fn control(
    ui: &mut Ui,
    rect: Rect,
    model: &Model<'_>,
    index: usize,
    label: &str,
    actions: &mut Vec<Action>,
) -> bool {
    let control = &model.controls.controls()[index];
    let (sign, unit, decimals) = groups::unit(control);
    let given = model.values.get(index).copied().filter(|value| value.is_finite());
    let shown = given.unwrap_or(control.default).max(control.min).min(control.max);
    let changed = is_changed(control, shown);
    let colors = palette(ui);
    let builder = UiBuilder::new().scope_id(ui.scope_id().with(("control", index))).max_rect(rect);
    ui.scope_builder(builder, |ui| {
        if model.highlighted.contains(&index) {
            ui.painter().rect_filled(rect, 4, colors.glow);
        }
        let parts = Parts::of(rect);
        let text = RichText::new(label);
        let text = if changed { text.strong() } else { text };
        let left = UiBuilder::new().max_rect(parts.label).layout(Layout::left_to_right(Align::Center));
        let label = Label::new(text).truncate().selectable(false).sense(Sense::CLICK);
        let name = ui.scope_builder(left, |ui| ui.add(label)).inner.on_hover_text(&control.name);

        let mut value = shown;
        ui.spacing_mut().slider_width = parts.slider.width();
        ui.spacing_mut().interact_size.y = parts.slider.height();
        let range = control.min..=control.max;
        let slider =
            Slider::new(&mut value, range.clone()).show_value(false).clamping(egui::SliderClamping::Edits);
        let slider = ui.put(parts.slider, slider);
        if changed {
            travelled(ui, slider.rect, control, value, colors.accent);
        }
        named(&slider, || format!("{}, {unit}", control.name));
        let speed = f64::from(control.max - control.min) / 200.0;
        let slid = value;
        let entry = DragValue::new(&mut value).range(range).clamp_existing_to_range(false).speed(speed);
        let entry = entry
            .max_decimals(decimals)
            .min_decimals(decimals.min(1))
            .suffix(sign)
            .update_while_editing(false);
        let entry = ui.put(parts.value, entry);
        if passed_by(&entry, f64::from(slid), f64::from(value), decimals) {
            value = slid;
        }
        named(&entry, || format!("value of {}, {unit}", control.name));

        let ended = slider.drag_stopped() || entry.drag_stopped();
        if value != shown || ended {
            let dragging = slider.dragged() || entry.dragged();
            actions.push(Action::SetControl { control: index, value, dragging });
        }
        let twice = ui.input(|input| input.pointer.button_double_clicked(egui::PointerButton::Primary));
        let dotted = changed && reset(ui, parts.reset, &control.name, colors.accent);
        if dotted || name.double_clicked() || (twice && slider.contains_pointer()) {
            actions.push(Action::ResetControl(index));
        }
        if slider.gained_focus() || entry.gained_focus() {
            ui.scroll_to_rect(rect, None);
        }
        let busy = slider.dragged() || entry.dragged();
        busy || ui.rect_contains_pointer(rect) || slider.has_focus() || entry.has_focus()
    })
    .inner
}

/// Marks the way from the default to the value on the rail.
fn travelled(ui: &Ui, rect: Rect, control: &Control, value: f32, color: egui::Color32) {
    let range = (control.max - control.min).max(f32::MIN_POSITIVE);
    // As far as egui's round handle goes.
    let radius = rect.height() / 2.5;
    let rail = rect.x_range().shrink(radius);
    let x = |value: f32| rail.min + ((value - control.min) / range).clamp(0.0, 1.0) * rail.span();
    let (from, to) = (x(control.default), x(value));
    let to = if to > from { (to - radius).max(from) } else { (to + radius).min(from) };
    ui.painter().hline(from.min(to)..=from.max(to), rect.center().y, egui::Stroke::new(3.0, color));
}

/// The dot that tells of a change, and takes it back.
fn reset(ui: &mut Ui, rect: Rect, name: &str, color: egui::Color32) -> bool {
    let response = ui.interact(rect, ui.scope_id().with("reset"), Sense::click());
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, format!("Reset {name}")));
    let radius = if response.hovered() || response.has_focus() { 4.5 } else { 3.0 };
    ui.painter().circle_filled(rect.center(), radius, color);
    response.on_hover_text("Back to the default").clicked()
}

/// Where the parts of a row lie.
struct Parts {
    reset: Rect,
    label: Rect,
    slider: Rect,
    value: Rect,
}

impl Parts {
    const RESET: f32 = 12.0;
    const VALUE: f32 = 58.0;

    fn of(rect: Rect) -> Self {
        let rect = rect.shrink2(vec2(0.0, 2.0));
        let middle = (rect.width() - Self::RESET - Self::VALUE).max(0.0);
        let label = (0.42 * middle).clamp(0.0, 150.0);
        let piece = |left: f32, width: f32| {
            Rect::from_min_size(
                egui::pos2(rect.left() + left, rect.top()),
                vec2(width.max(1.0), rect.height()),
            )
        };
        let rail = Self::RESET + label;
        Self {
            reset: piece(0.0, Self::RESET),
            label: piece(Self::RESET + 2.0, label - 6.0),
            slider: piece(rail, middle - label - 8.0).shrink2(vec2(0.0, 2.0)),
            value: piece(rect.width() - Self::VALUE, Self::VALUE),
        }
    }
}
