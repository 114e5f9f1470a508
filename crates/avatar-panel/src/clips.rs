//! The list of clips. The chosen one is what the timeline shows.

use crate::widgets::{Icon, icon_button, icon_button_if};
use crate::{Action, Edit, Model};
use egui::{Button, RichText, ScrollArea, Ui};

/// The button that begins a recording of the face's motion or ends it, and how long it has run.
pub(crate) fn recording(ui: &mut Ui, model: &Model<'_>, actions: &mut Vec<Action>) {
    match model.playback.recording_secs {
        Some(secs) => {
            if icon_button(ui, Icon::Stop, "Stop recording").clicked() {
                actions.push(Action::Edit(Edit::StopRecording));
            }
            ui.colored_label(crate::style::palette(ui).record, format!("{secs:.1} s"));
        }
        None => {
            if icon_button(ui, Icon::Record, "Record the face's motion").clicked() {
                actions.push(Action::StartRecording);
            }
        }
    }
}

pub(crate) fn show(ui: &mut Ui, model: &Model<'_>, chosen: &mut Option<usize>, actions: &mut Vec<Action>) {
    ui.horizontal_wrapped(|ui| {
        recording(ui, model, actions);
        if icon_button(ui, Icon::Plus, "New clip").clicked() {
            actions.push(Action::Edit(Edit::NewClip));
        }
        if let Some(index) = *chosen
            && let Some(clip) = model.clips.get(index)
            && icon_button_if(ui, true, Icon::Minus, &format!("Delete clip {}", clip.name)).clicked()
        {
            actions.push(Action::Edit(Edit::DeleteClip(index)));
        }
        if ui.add_enabled(model.clips_changed, Button::new("Save clips")).clicked() {
            actions.push(Action::Edit(Edit::SaveClips));
        }
    });
    ui.separator();
    if model.clips.is_empty() {
        ui.weak("No clips yet. Record the face's motion, or begin a new clip.");
        ui.add_space(4.0);
    }
    ScrollArea::vertical().id_salt("clips").auto_shrink(false).show(ui, |ui| {
        for (index, clip) in model.clips.iter().enumerate() {
            let playing = model.playback.playing && model.playback.clip == Some(index);
            let name = RichText::new(&clip.name);
            let name = if playing { name.strong() } else { name };
            let key = clip.key.as_ref().map_or_else(String::new, |key| format!("{key}  "));
            let right = RichText::new(format!("{key}{:.2} s", clip.duration_secs())).weak();
            let row = Button::selectable(*chosen == Some(index), name).right_text(right);
            let response = ui.add(row.min_size(egui::vec2(ui.available_width(), 0.0)));
            crate::widgets::named(&response, || {
                format!("clip {}{}", clip.name, if playing { ", playing" } else { "" })
            });
            if response.clicked() {
                *chosen = Some(index);
            }
            if response.double_clicked() {
                actions.push(Action::Play(index));
            }
        }
        of_file(ui, model, actions);
    });
}

/// Clips that came with the avatar: a click plays them, another one halts them.
fn of_file(ui: &mut Ui, model: &Model<'_>, actions: &mut Vec<Action>) {
    if model.file_clips.is_empty() {
        return;
    }
    if !model.clips.is_empty() {
        ui.separator();
    }
    ui.horizontal(|ui| {
        ui.weak("In the avatar's file");
        if model.file_playback.is_some() && icon_button(ui, Icon::Stop, "Back to the sliders").clicked() {
            actions.push(Action::LeaveFileClip);
        }
    });
    for (index, clip) in model.file_clips.iter().enumerate() {
        let here = model.file_playback.filter(|playback| playback.clip == index);
        let playing = here.is_some_and(|playback| playback.playing);
        let name = RichText::new(clip.name);
        let name = if playing { name.strong() } else { name };
        let right = match here {
            Some(playback) => format!("{:.2} of {:.2} s", playback.time_secs, clip.duration_secs),
            None => format!("{:.2} s", clip.duration_secs),
        };
        let row = Button::selectable(here.is_some(), name).right_text(RichText::new(right).weak());
        let response = ui.add(row.min_size(egui::vec2(ui.available_width(), 0.0)));
        crate::widgets::named(&response, || {
            format!("clip {} of the file{}", clip.name, if playing { ", playing" } else { "" })
        });
        if response.clicked() {
            actions.push(if playing { Action::Pause } else { Action::PlayFileClip(index) });
        }
    }
}
