//! Files, pictures, camera and display.

use crate::widgets::{Icon, icon_button, named};
use crate::{Action, Model, PanelState, Theme};
use egui::{Button, Checkbox, ScrollArea, Slider, Ui};

pub(crate) fn show(
    ui: &mut Ui,
    model: &Model<'_>,
    state: &mut PanelState,
    clip: Option<usize>,
    actions: &mut Vec<Action>,
) {
    ScrollArea::vertical().id_salt("view").auto_shrink(false).show(ui, |ui| {
        section(ui, "File");
        if ui.button("Open…").clicked() {
            actions.push(Action::OpenFile);
        }
        for (index, file) in model.recent.iter().enumerate() {
            let row = Button::selectable(false, short(file)).truncate();
            let row = ui.add(row.min_size(egui::vec2(ui.available_width(), 0.0))).on_hover_text(file);
            named(&row, || format!("Open {file}"));
            if row.clicked() {
                actions.push(Action::OpenRecent(index));
            }
        }
        section(ui, "Picture");
        ui.horizontal_wrapped(|ui| {
            if ui.button("Save picture").clicked() {
                actions.push(Action::Picture);
            }
            for (format, name) in model.film_formats.iter().enumerate() {
                if ui.add_enabled(model.film.is_none(), Button::new(format!("Film: {name}"))).clicked() {
                    actions.push(Action::Film { format, clip });
                }
            }
        });
        if !model.cameras.is_empty() {
            section(ui, "Camera");
            ui.horizontal_wrapped(|ui| {
                for (index, name) in model.cameras.iter().enumerate() {
                    let button = ui.button(*name);
                    named(&button, || format!("Camera {name}"));
                    if button.clicked() {
                        actions.push(Action::Camera(index));
                    }
                }
            });
        }
        if model.gaze.is_some() || model.hair.is_some() || model.life.is_some() {
            section(ui, "Face");
        }
        if let Some(mut life) = model.life
            && ui.add(Checkbox::new(&mut life, "The face lives by itself")).changed()
        {
            actions.push(Action::Life);
        }
        if let Some(mut gaze) = model.gaze
            && ui.add(Checkbox::new(&mut gaze, "Eyes follow the pointer")).changed()
        {
            actions.push(Action::Gaze);
        }
        if let Some(hair) = model.hair {
            ui.horizontal(|ui| {
                ui.label("Hair");
                for (icon, name, backward) in
                    [(Icon::Left, "The hair before", true), (Icon::Right, "Other hair", false)]
                {
                    if icon_button(ui, icon, name).clicked() {
                        actions.push(Action::Hair { backward });
                    }
                }
                ui.strong(hair);
            });
        }
        section(ui, "Display");
        display(ui, model, state, actions);
        section(ui, "Program");
        if ui.button("Quit").clicked() {
            actions.push(Action::Quit);
        }
    });
}

fn display(ui: &mut Ui, model: &Model<'_>, state: &mut PanelState, actions: &mut Vec<Action>) {
    ui.horizontal_wrapped(|ui| {
        ui.label("Theme");
        for (theme, name) in Theme::ALL {
            let button = ui.selectable_label(state.theme == theme, name);
            named(&button, || format!("Theme {name}"));
            if button.clicked() && state.theme != theme {
                state.theme = theme;
                actions.push(Action::Theme(theme));
            }
        }
    });
    ui.horizontal_wrapped(|ui| {
        ui.label("Text size");
        let mut scale = state.text_scale;
        ui.spacing_mut().slider_width = (ui.available_width() - 80.0).clamp(40.0, 120.0);
        let slider = Slider::new(&mut scale, PanelState::TEXT_SCALES).step_by(0.05).show_value(false);
        let slider = ui.add(slider);
        named(&slider, || "Text size".to_owned());
        ui.label(format!("{:.0} %", 100.0 * scale));
        // A slider that grows under the pointer runs away from it, so the size waits for the release.
        let id = slider.id.with("waiting");
        if slider.dragged() {
            ui.data_mut(|data| data.insert_temp(id, scale));
        }
        let waiting = ui.data(|data| data.get_temp::<f32>(id));
        let wanted = if slider.dragged() { None } else { waiting.or(Some(scale)) };
        if let Some(wanted) = wanted.filter(|wanted| (wanted - state.text_scale).abs() > 1e-3) {
            state.text_scale = wanted;
            actions.push(Action::TextScale(wanted));
        }
        if !slider.dragged() {
            ui.data_mut(|data| data.remove_temp::<f32>(id));
        }
    });
    ui.add(Checkbox::new(&mut state.show_stats, "Statistics"));
    let mut full = model.full_screen;
    if ui.add(Checkbox::new(&mut full, "Full screen")).changed() {
        actions.push(Action::FullScreen);
    }
}

fn section(ui: &mut Ui, title: &str) {
    ui.add_space(4.0);
    ui.strong(title);
}

/// The end of a path, which tells more than its start.
fn short(file: &str) -> &str {
    file.rsplit(['/', '\\']).find(|part| !part.is_empty()).unwrap_or(file)
}
