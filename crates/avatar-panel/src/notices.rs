//! Notices above everything else: messages, the progress of loading and of films.

use crate::widgets::{Icon, icon_button};
use crate::{Action, FilmProgress, Loading, Message, Model, Severity, style};
use egui::{Label, Panel, ProgressBar, RichText, ScrollArea, Ui};

pub(crate) fn show(ui: &mut Ui, model: &Model<'_>, actions: &mut Vec<Action>) {
    if model.messages.is_empty() && model.loading.is_none() && model.film.is_none() {
        // What is shown after this counts what is shown before it: a message must not take the keyboard from
        // a field of text.
        ui.skip_ahead_auto_ids(1);
        return;
    }
    let frame = style::edge_frame(ui);
    let highest = (0.45 * ui.available_height()).max(80.0);
    let shown = Panel::top("avatar-panel notices").frame(frame).max_size(highest).show(ui, |ui| {
        let room = highest - 24.0;
        let area = ScrollArea::vertical().max_height(room).min_scrolled_height(room);
        let area = area.auto_shrink([false, true]).show(ui, |ui| {
            if let Some(loading) = model.loading {
                progress(ui, loading);
            }
            if let Some(film) = model.film {
                filming(ui, film, actions);
            }
            for (index, message) in model.messages.iter().enumerate() {
                if banner(ui, message) {
                    actions.push(Action::Dismiss(index));
                }
            }
        });
        area.content_size.y
    });
    // The panel is as high as its content was in the frame before: a frame more where that has changed.
    let (id, height) = (shown.response.id.with("height"), shown.inner);
    let before = ui.data_mut(|data| std::mem::replace(data.get_temp_mut_or_default::<f32>(id), height));
    if before != height {
        ui.ctx().request_repaint();
    }
}

/// Returns whether the user dismisses it.
fn banner(ui: &mut Ui, message: &Message<'_>) -> bool {
    let (word, color) = match message.severity {
        Severity::Error => ("Error", ui.visuals().error_fg_color),
        Severity::Warning => ("Warning", ui.visuals().warn_fg_color),
        Severity::Info => ("Note", style::palette(ui).accent),
    };
    let mut dismissed = false;
    ui.horizontal_top(|ui| {
        let room = ui.available_width() - if message.dismissible { 34.0 } else { 0.0 };
        ui.vertical(|ui| {
            ui.set_width(room.max(40.0));
            let title = RichText::new(format!("{word}: {}", message.title)).strong().color(color);
            ui.add(Label::new(title).wrap().selectable(true));
            if !message.text.is_empty() {
                ui.add(Label::new(RichText::new(message.text).monospace()).wrap().selectable(true));
            }
        });
        if message.dismissible {
            dismissed = icon_button(ui, Icon::Cross, &format!("Dismiss: {}", message.title)).clicked();
        }
    });
    dismissed
}

fn progress(ui: &mut Ui, loading: Loading<'_>) {
    let text = format!("Loading {}", loading.what);
    // Of an unknown length: half, with something that moves.
    let bar = match loading.fraction {
        Some(fraction) => ProgressBar::new(fraction).text(format!("{text}  {:.0} %", 100.0 * fraction)),
        None => ProgressBar::new(0.5).animate(true).text(text),
    };
    ui.add(bar);
}

fn filming(ui: &mut Ui, film: FilmProgress, actions: &mut Vec<Action>) {
    ui.horizontal(|ui| {
        let left = film.remaining_secs.map_or_else(String::new, |secs| format!(", {} left", minutes(secs)));
        let text = format!("Film: frame {} of {}{left}", film.done, film.of);
        let fraction = film.done as f32 / film.of.max(1) as f32;
        let width = ui.available_width() - 34.0;
        ui.add(ProgressBar::new(fraction).desired_width(width.max(40.0)).text(text));
        if icon_button(ui, Icon::Cross, "Stop the film").clicked() {
            actions.push(Action::StopFilm);
        }
    });
}

fn minutes(secs: u64) -> String {
    if secs < 60 { format!("{secs} s") } else { format!("{}:{:02} min", secs / 60, secs % 60) }
}
