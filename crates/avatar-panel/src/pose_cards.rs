//! Poses as cards: with pictures where there are any, as a list where there are none.

use crate::style::palette;
use crate::{Action, Edit, Model};
use egui::{
    Align2, Color32, FontId, Rect, Response, Role, ScrollArea, Sense, Stroke, StrokeKind, TextStyle, Ui,
    UiBuilder, WidgetInfo, pos2, vec2,
};
use pose_anim::Pose;

const GAP: f32 = 6.0;
/// Least width of a card with a picture.
const LEAST: f32 = 88.0;

/// What is carried from card to card.
struct Carried(usize);

pub(crate) fn show(ui: &mut Ui, model: &Model<'_>, selected: Option<usize>) -> Vec<Action> {
    let mut actions = Vec::new();
    let pictures = model.thumbnails.iter().any(Option::is_some);
    ScrollArea::vertical().id_salt("poses").auto_shrink(false).show_viewport(ui, |ui, viewport| {
        let width = ui.available_width();
        let columns = if pictures { ((width + GAP) / (LEAST + GAP)).floor().max(1.0) } else { 1.0 };
        let side = (width + GAP) / columns - GAP;
        let line = ui.spacing().interact_size.y;
        let size = vec2(side, if pictures { side + line } else { line + 4.0 });
        let all = ui.max_rect();
        let count = model.poses.poses.len();
        ui.set_height((count as f32 / columns).ceil() * (size.y + GAP));
        for (index, pose) in model.poses.iter().enumerate() {
            let (row, column) = ((index as f32 / columns).floor(), index as f32 % columns);
            let corner = all.min + vec2(column * (size.x + GAP), row * (size.y + GAP));
            // A row beyond the visible ones is there for the keyboard.
            if corner.y + 2.0 * size.y < all.top() + viewport.top()
                || corner.y - size.y > all.top() + viewport.bottom()
            {
                continue;
            }
            card(
                ui,
                Rect::from_min_size(corner, size),
                model,
                index,
                pose,
                selected == Some(index),
                &mut actions,
            );
        }
    });
    actions
}

fn card(
    ui: &mut Ui,
    rect: Rect,
    model: &Model<'_>,
    index: usize,
    pose: &Pose,
    selected: bool,
    actions: &mut Vec<Action>,
) {
    let id = ui.scope_id().with(("pose", index));
    ui.scope_builder(UiBuilder::new().scope_id(id).max_rect(rect), |ui| {
        let response = ui.interact(rect, id.with("card"), Sense::click_and_drag());
        let active = model.active_pose == Some(index);
        response.widget_info(|| {
            let key = pose.key.as_ref().map_or_else(String::new, |key| format!(", key {key}"));
            WidgetInfo::selected(Role::Button, true, active, format!("pose {}{key}", pose.name))
        });
        let picture = model.thumbnails.get(index).copied().flatten();
        paint(ui, rect, &response, pose, picture, (active, selected));
        if response.clicked() {
            actions.push(Action::GoTo(index));
        }
        if response.gained_focus() {
            response.scroll_to_me(None);
        }
        if model.can_save.is_err() {
            return;
        }
        response.dnd_set_drag_payload(Carried(index));
        if let Some(carried) = response.dnd_hover_payload::<Carried>()
            && carried.0 != index
        {
            ui.painter().rect_stroke(rect, 6, Stroke::new(2.0, palette(ui).accent), StrokeKind::Inside);
        }
        if let Some(carried) = response.dnd_release_payload::<Carried>()
            && carried.0 != index
        {
            actions.push(Action::Edit(Edit::MovePose { from: carried.0, to: index }));
        }
    });
}

fn paint(
    ui: &Ui,
    rect: Rect,
    response: &Response,
    pose: &Pose,
    picture: Option<egui::TextureId>,
    (active, selected): (bool, bool),
) {
    if !ui.is_rect_visible(rect) {
        return;
    }
    let colors = palette(ui);
    let look = ui.style().interact(response);
    let painter = ui.painter().with_clip_rect(rect.intersect(ui.clip_rect()));
    let ground = if active {
        colors.glow
    } else if response.hovered() {
        look.weak_bg_fill
    } else {
        colors.ground
    };
    painter.rect_filled(rect, 6, ground);
    let line = ui.spacing().interact_size.y;
    let square = rect.height() > 2.0 * line;
    if square {
        let place = Rect::from_min_max(rect.min, pos2(rect.right(), rect.bottom() - line)).shrink(4.0);
        match picture {
            Some(texture) => {
                let whole = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
                painter.image(texture, place, whole, Color32::WHITE);
            }
            None => drop(painter.rect_stroke(place, 4, Stroke::new(1.0, colors.line), StrokeKind::Inside)),
        }
    }
    let text =
        Rect::from_min_max(pos2(rect.left() + 8.0, rect.bottom() - line - 2.0), rect.max - vec2(6.0, 2.0));
    let font = TextStyle::Body.resolve(ui.style());
    let mut right = text.right();
    if let Some(key) = &pose.key {
        let small = FontId::monospace(0.85 * font.size);
        let weak = ui.visuals().weak_text_color();
        let badge = painter.text(text.right_center(), Align2::RIGHT_CENTER, key, small, weak);
        right = badge.left() - 4.0;
    }
    let color = if active { ui.visuals().strong_text_color() } else { look.text_color() };
    let names = painter.with_clip_rect(
        Rect::from_min_max(text.min, pos2(right, text.bottom())).intersect(painter.clip_rect()),
    );
    names.text(text.left_center(), Align2::LEFT_CENTER, &pose.name, font, color);
    let edge = if response.has_focus() || active {
        Stroke::new(1.5, colors.accent)
    } else if selected {
        Stroke::new(1.0, colors.accent.gamma_multiply(0.6))
    } else {
        Stroke::NONE
    };
    painter.rect_stroke(rect, 6, edge, StrokeKind::Inside);
}
