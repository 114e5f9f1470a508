//! The table of keys over everything.

use crate::{KeyRow, style};
use egui::{Context, Frame, Id, Key, Modal, Modifiers, RichText, ScrollArea, Ui};

/// Least width of a column in points.
const COLUMN: f32 = 290.0;

/// Opens and closes the help by its keys. They are consumed: nothing else sees them.
pub(crate) fn listen(ctx: &Context, open: &mut bool, own: &[Option<Key>; 2]) {
    let typing = ctx.text_edit_focused();
    let pressed = |key: Key| ctx.input_mut(|input| input.consume_key(Modifiers::NONE, key));
    let is_own = |key: Key| own.contains(&Some(key));
    let asked = (is_own(Key::F1) && pressed(Key::F1))
        || (is_own(Key::Questionmark) && !typing && (pressed(Key::Questionmark) || asked_by_text(ctx)));
    if asked {
        *open = !*open;
    } else if *open && pressed(Key::Escape) {
        *open = false;
    }
}

/// Those keys of the help that are heard here.
pub(crate) fn own_keys(names: &[&str]) -> [Option<Key>; 2] {
    [("F1", Key::F1), ("?", Key::Questionmark)].map(|(name, key)| names.contains(&name).then_some(key))
}

/// On many keyboards the question mark is a character only.
fn asked_by_text(ctx: &Context) -> bool {
    ctx.input(|input| {
        let typed = input.events.iter().any(|event| matches!(event, egui::Event::Text(text) if text == "?"));
        typed && !input.key_pressed(Key::Questionmark)
    })
}

pub(crate) fn show(ctx: &Context, keys: &[KeyRow<'_>], help_keys: &[&str], open: &mut bool) {
    let window = ctx.content_rect();
    let modal =
        Modal::new(Id::unique("avatar-panel help")).frame(Frame::popup(&ctx.global_style()).inner_margin(14));
    let shown = modal.show(ctx, |ui| {
        let groups = groups(keys);
        let room = (window.width() - 60.0).max(120.0);
        let columns = ((room / COLUMN) as usize).clamp(1, groups.len().clamp(1, 3));
        ui.set_width((columns as f32 * COLUMN).min(room));
        ui.horizontal(|ui| {
            ui.heading("Keys");
            ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                if ui.button("Close help").clicked() {
                    *open = false;
                }
                let others = help_keys.join(", ");
                ui.weak(if others.is_empty() { "Escape".to_owned() } else { format!("{others} or Escape") });
            });
        });
        ui.separator();
        let room = (window.height() - 110.0).max(60.0);
        ScrollArea::vertical().max_height(room).min_scrolled_height(room).show(ui, |ui| {
            let columns = share(&groups, columns);
            ui.columns(columns.len().max(1), |uis| {
                for (ui, groups) in uis.iter_mut().zip(&columns) {
                    groups.iter().for_each(|group| table(ui, group));
                }
            });
        });
    });
    if shown.backdrop_response.clicked() {
        *open = false;
    }
}

/// The rows by their groups.
fn groups<'a>(keys: &'a [KeyRow<'a>]) -> Vec<&'a [KeyRow<'a>]> {
    keys.chunk_by(|a, b| a.group == b.group).collect()
}

/// Groups in their order, in columns of about one height.
fn share<'a>(groups: &[&'a [KeyRow<'a>]], columns: usize) -> Vec<Vec<&'a [KeyRow<'a>]>> {
    let height = |group: &[KeyRow<'_>]| group.len() + 2;
    let all: usize = groups.iter().map(|group| height(group)).sum();
    let each = all.div_ceil(columns.max(1));
    let mut shares: Vec<Vec<_>> = vec![Vec::new()];
    let mut filled = 0;
    for group in groups {
        // Into the next column where more than half of the group would stand out of this one.
        if filled > 0 && filled + height(group) / 2 >= each && shares.len() < columns {
            shares.push(Vec::new());
            filled = 0;
        }
        filled += height(group);
        if let Some(share) = shares.last_mut() {
            share.push(*group);
        }
    }
    shares
}

fn table(ui: &mut Ui, group: &[KeyRow<'_>]) {
    let Some(first) = group.first() else { return };
    ui.add_space(4.0);
    ui.strong(first.group);
    for row in group {
        ui.horizontal(|ui| {
            ui.spacing_mut().item_spacing.x = 8.0;
            let width = 0.42 * ui.available_width();
            ui.allocate_ui_with_layout(
                egui::vec2(width, ui.spacing().interact_size.y),
                egui::Layout::left_to_right(egui::Align::Center),
                |ui| {
                    ui.set_min_width(width);
                    let color = style::palette(ui).accent;
                    ui.add(egui::Label::new(RichText::new(row.key).monospace().color(color)).wrap());
                },
            );
            ui.add(egui::Label::new(row.meaning).wrap());
        });
    }
    ui.add_space(6.0);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_hold_all_groups_in_order_and_none_is_empty() {
        let row = |group| KeyRow { key: "k", meaning: "m", group };
        let keys: Vec<_> = [("a", 5), ("b", 2), ("c", 9), ("d", 1)]
            .into_iter()
            .flat_map(|(group, count)| vec![row(group); count])
            .collect();
        let groups = groups(&keys);
        assert_eq!(groups.iter().map(|group| group.len()).collect::<Vec<_>>(), [5, 2, 9, 1]);
        for columns in 1..=3 {
            let shares = share(&groups, columns);
            assert!(shares.len() <= columns);
            assert!(shares.iter().all(|share| !share.is_empty()));
            assert_eq!(shares.concat().concat(), keys);
        }
    }
}
