//! What lies over the picture: statistics and the first hint.

use crate::style::{self, palette};
use crate::{PanelState, Stats};
use egui::{Align2, Area, Context, Id, Order, Rect, RichText, Sense, Shape, Stroke, Ui, pos2, vec2};

/// The highest frame time of the graph in milliseconds, and the lines in it: 120, 60 and 30 frames per
/// second.
const GRAPH_MS: f32 = 50.0;
const LINES_MS: [f32; 3] = [8.333, 16.667, 33.333];

pub(crate) fn stats(ctx: &Context, free: Rect, stats: &Stats<'_>) {
    let area = Area::new(Id::unique("avatar-panel statistics")).order(Order::Middle).interactable(false);
    area.fixed_pos(free.min + vec2(10.0, 10.0)).constrain(false).show(ctx, |ui| {
        // Never over the panel, however little room it leaves.
        ui.shrink_clip_rect(free);
        style::float_frame(ui).show(ui, |ui| {
            // As wide as there is room.
            ui.set_max_width((free.width() - 40.0).clamp(110.0, 210.0));
            ui.spacing_mut().item_spacing.y = 2.0;
            if !stats.adapter.is_empty() {
                ui.strong(stats.adapter);
            }
            line(ui, "triangles", &grouped(stats.triangles));
            line(ui, "strands", &grouped(stats.strands));
            if let Some(last) = stats.frame_ms.last().filter(|ms| **ms > 0.0) {
                let mean = stats.frame_ms.iter().sum::<f32>() / stats.frame_ms.len() as f32;
                line(ui, "frame", &format!("{last:.1} ms"));
                line(ui, "mean", &format!("{mean:.1} ms, {:.0}/s", 1000.0 / mean.max(1e-3)));
            }
            if !stats.frame_ms.is_empty() {
                graph(ui, stats.frame_ms);
            }
            for (pass, ms) in stats.passes {
                line(ui, pass, &format!("{ms:.2} ms"));
            }
        });
    });
}

fn line(ui: &mut Ui, name: &str, value: &str) {
    ui.horizontal(|ui| {
        ui.set_width(ui.available_width());
        ui.weak(name);
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            ui.label(RichText::new(value).monospace())
        });
    });
}

fn graph(ui: &mut Ui, frame_ms: &[f32]) {
    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), 48.0), Sense::hover());
    response.widget_info(|| {
        egui::WidgetInfo::labeled(
            egui::Role::Image,
            true,
            format!("Times of the last {} frames", frame_ms.len()),
        )
    });
    let colors = palette(ui);
    let painter = ui.painter_at(rect);
    let height = |ms: f32| rect.bottom() - (ms.clamp(0.0, GRAPH_MS) / GRAPH_MS) * rect.height();
    painter.rect_filled(rect, 3, colors.ground);
    for ms in LINES_MS {
        painter.hline(rect.x_range(), height(ms), Stroke::new(1.0, colors.line));
    }
    // A frame a point; the latest at the right.
    let shown = &frame_ms[frame_ms.len().saturating_sub(rect.width() as usize)..];
    let left = rect.right() - shown.len() as f32;
    let points = shown.iter().enumerate().map(|(place, ms)| pos2(left + place as f32, height(*ms))).collect();
    painter.add(Shape::line(points, Stroke::new(1.2, colors.accent)));
}

/// Digits in groups of three.
fn grouped(number: u64) -> String {
    let digits = number.to_string();
    let mut text = String::with_capacity(digits.len() + digits.len() / 3);
    for (place, digit) in digits.chars().enumerate() {
        if place > 0 && (digits.len() - place).is_multiple_of(3) {
            text.push('\u{2009}');
        }
        text.push(digit);
    }
    text
}

/// A hint for the first use. It waits until there is room for it.
pub(crate) fn hint(ctx: &Context, free: Rect, help_keys: &[&str], state: &mut PanelState) {
    if free.width() < 180.0 || free.height() < 120.0 {
        return;
    }
    let place = free.center_bottom() - vec2(0.0, 14.0);
    let area = Area::new(Id::unique("avatar-panel hint")).order(Order::Middle).pivot(Align2::CENTER_BOTTOM);
    area.fixed_pos(place).constrain_to(free).show(ctx, |ui| {
        ui.set_max_width((free.width() - 20.0).max(100.0));
        style::float_frame(ui).show(ui, |ui| {
            ui.horizontal_wrapped(|ui| {
                let help = help_keys.first().map_or_else(String::new, |key| format!("{key} help · "));
                ui.label(format!("{help}drag turns the camera, the wheel zooms · the sliders move the face"));
                if ui.button("Got it").clicked() {
                    state.seen_hint = true;
                }
            });
        });
    });
}

#[cfg(test)]
mod tests {
    use super::grouped;

    #[test]
    fn digits_stand_in_threes() {
        let cases = [(0, "0"), (999, "999"), (1000, "1\u{2009}000"), (1_234_567, "1\u{2009}234\u{2009}567")];
        for (number, expected) in cases {
            assert_eq!(grouped(number), expected);
        }
    }
}
