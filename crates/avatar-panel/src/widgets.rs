//! Small widgets that egui has not: buttons with drawn signs, and names for screen readers.

use egui::{Color32, Pos2, Rect, Response, Role, Sense, Shape, Stroke, Ui, WidgetInfo, pos2, vec2};

/// A sign on a button. Drawn, so that no font has to have it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Icon {
    Play,
    Pause,
    Stop,
    Again,
    Record,
    Up,
    Down,
    Left,
    Right,
    Plus,
    Minus,
    Cross,
    Help,
    Fit,
}

/// A square button with a sign; the name is read out and shown on hover.
pub(crate) fn icon_button(ui: &mut Ui, icon: Icon, name: &str) -> Response {
    icon_button_if(ui, true, icon, name)
}

/// The same, which may be disabled.
pub(crate) fn icon_button_if(ui: &mut Ui, enabled: bool, icon: Icon, name: &str) -> Response {
    // As a widget of its own, so that it wraps with its row.
    let button = |ui: &mut Ui| {
        let side = ui.spacing().interact_size.y;
        let (rect, response) = ui.allocate_exact_size(vec2(side, side), Sense::click());
        response.widget_info(|| WidgetInfo::labeled(Role::Button, ui.is_enabled(), name));
        if ui.is_rect_visible(rect) {
            let look = ui.style().interact(&response);
            let record = icon == Icon::Record;
            let color = if record { crate::style::palette(ui).record } else { look.fg_stroke.color };
            let inside = egui::StrokeKind::Inside;
            ui.painter().rect(rect, look.corner_radius, look.weak_bg_fill, look.bg_stroke, inside);
            paint(ui, icon, Rect::from_center_size(rect.center(), vec2(10.0, 10.0)), color);
        }
        response
    };
    ui.add_enabled(enabled, button).on_hover_text(name).on_disabled_hover_text(name)
}

/// Names a widget for screen readers. The name is only made where one listens.
pub(crate) fn named(response: &Response, name: impl FnOnce() -> String) {
    response.ctx.accesskit_node_builder(response.id, |node| node.set_label(name()));
}

/// Whether a number was only looked at: egui reads its rounded text again when the keyboard leaves it.
pub(crate) fn passed_by(response: &Response, before: f64, after: f64, decimals: usize) -> bool {
    let rounding = 0.500_1 * 10f64.powi(-i32::try_from(decimals).unwrap_or(0));
    response.lost_focus() && (after - before).abs() <= rounding
}

fn paint(ui: &Ui, icon: Icon, rect: Rect, color: Color32) {
    let at = |x: f32, y: f32| pos2(rect.left() + x * rect.width(), rect.top() + y * rect.height());
    let line = Stroke::new(1.6, color);
    let solid = |points: &[Pos2]| {
        Shape::Path(egui::epaint::PathShape::convex_polygon(points.to_vec(), color, Stroke::NONE))
    };
    let lines = |points: &[Pos2]| Shape::line(points.to_vec(), line);
    let bar = |x: f32| Shape::rect_filled(Rect::from_min_max(at(x, 0.05), at(x + 0.3, 0.95)), 1, color);
    let painter = ui.painter();
    match icon {
        Icon::Play => drop(painter.add(solid(&[at(0.1, 0.0), at(1.0, 0.5), at(0.1, 1.0)]))),
        Icon::Pause => painter.extend([bar(0.1), bar(0.6)]),
        Icon::Stop => drop(painter.rect_filled(rect.shrink(0.5), 1, color)),
        Icon::Again => {
            let bar = Rect::from_min_max(at(0.0, 0.05), at(0.2, 0.95));
            painter.rect_filled(bar, 1, color);
            painter.add(solid(&[at(1.0, 0.0), at(0.3, 0.5), at(1.0, 1.0)]));
        }
        Icon::Record => drop(painter.circle_filled(rect.center(), 0.5 * rect.width(), color)),
        Icon::Up => drop(painter.add(lines(&[at(0.1, 0.7), at(0.5, 0.3), at(0.9, 0.7)]))),
        Icon::Down => drop(painter.add(lines(&[at(0.1, 0.3), at(0.5, 0.7), at(0.9, 0.3)]))),
        Icon::Left => drop(painter.add(lines(&[at(0.7, 0.1), at(0.3, 0.5), at(0.7, 0.9)]))),
        Icon::Right => drop(painter.add(lines(&[at(0.3, 0.1), at(0.7, 0.5), at(0.3, 0.9)]))),
        Icon::Minus => drop(painter.add(lines(&[at(0.05, 0.5), at(0.95, 0.5)]))),
        Icon::Plus => {
            painter.extend([lines(&[at(0.05, 0.5), at(0.95, 0.5)]), lines(&[at(0.5, 0.05), at(0.5, 0.95)])]);
        }
        Icon::Cross => {
            painter.extend([lines(&[at(0.1, 0.1), at(0.9, 0.9)]), lines(&[at(0.9, 0.1), at(0.1, 0.9)])]);
        }
        Icon::Fit => painter.extend([
            lines(&[at(0.0, 0.1), at(0.0, 0.9)]),
            lines(&[at(1.0, 0.1), at(1.0, 0.9)]),
            lines(&[at(0.2, 0.5), at(0.8, 0.5)]),
        ]),
        Icon::Help => {
            let font = egui::FontId::proportional(14.0);
            painter.text(rect.center(), egui::Align2::CENTER_CENTER, "?", font, color);
        }
    }
}
