//! What the face says: a recording, sounds with their times, a text, or what the microphone hears.

use crate::widgets::{Icon, icon_button_if, named};
use crate::{Action, Model, Speaking};
use egui::{Button, Checkbox, Id, ProgressBar, ScrollArea, Slider, TextEdit, Ui};

/// Where the text and its voice are kept, which only this tab knows.
const TEXT: &str = "avatar-panel text to say";
const VOICE: &str = "avatar-panel voice";

pub(crate) fn show(ui: &mut Ui, model: &Model<'_>, actions: &mut Vec<Action>) {
    let speaking = &model.speaking;
    ScrollArea::vertical().id_salt("speak").auto_shrink(false).show(ui, |ui| {
        if let Some(why) = speaking.cannot {
            ui.label(why);
            ui.add_space(4.0);
        }
        ui.strong("From a file");
        if ui.button("Open sound or labels…").clicked() {
            actions.push(Action::OpenSpeech);
        }
        if speaking.file.is_none() {
            ui.weak(
                "WAV, FLAC, Ogg or MP3; or sounds with their times, as Rhubarb, Praat and others write them.",
            );
            ui.weak("A file that is dropped on the window is spoken, too.");
        }
        ui.add_space(6.0);
        text(ui, actions);
        ui.add_space(6.0);
        if let Some(file) = speaking.file {
            of_script(ui, model, file, actions);
            ui.add_space(6.0);
        }
        microphone(ui, speaking, actions);
        ui.add_space(6.0);
        amount(ui, speaking, actions);
    });
}

/// A text that is read aloud.
fn text(ui: &mut Ui, actions: &mut Vec<Action>) {
    ui.strong("A text");
    let kept =
        |ui: &Ui, id: &str| ui.data(|data| data.get_temp::<String>(Id::unique(id))).unwrap_or_default();
    let (mut text, mut voice) = (kept(ui, TEXT), kept(ui, VOICE));
    let edit = TextEdit::multiline(&mut text).desired_rows(2).desired_width(f32::INFINITY);
    let edit = ui.add(edit.hint_text("Hello, my name is …"));
    named(&edit, || "Text to say".to_owned());
    ui.horizontal(|ui| {
        let is_empty = text.trim().is_empty();
        if ui.add_enabled(!is_empty, Button::new("Say it")).clicked() {
            let voice = Some(voice.trim()).filter(|voice| !voice.is_empty()).map(str::to_owned);
            actions.push(Action::Say { text: text.clone(), voice });
        }
        ui.label("Voice");
        let edit = ui.add(TextEdit::singleline(&mut voice).desired_width(70.0).hint_text("en"));
        named(&edit, || "Voice, as in de or en-us+f3".to_owned());
    });
    ui.data_mut(|data| {
        data.insert_temp(Id::unique(TEXT), text);
        data.insert_temp(Id::unique(VOICE), voice);
    });
}

/// What is spoken, and where in it the face is.
fn of_script(ui: &mut Ui, model: &Model<'_>, file: &str, actions: &mut Vec<Action>) {
    let speaking = &model.speaking;
    ui.add(egui::Label::new(egui::RichText::new(file).strong()).truncate()).on_hover_text(file);
    ui.horizontal(|ui| {
        let (icon, name) = match speaking.is_speaking {
            true => (Icon::Again, "Speak again from the beginning"),
            false => (Icon::Play, "Speak"),
        };
        if icon_button_if(ui, speaking.cannot.is_none(), icon, name).clicked() {
            actions.push(Action::Speak);
        }
        if icon_button_if(ui, speaking.is_speaking, Icon::Stop, "Stop speaking").clicked() {
            actions.push(Action::StopSpeaking);
        }
        let all = speaking.duration_secs.max(1e-3);
        let share = (speaking.time_secs / all).clamp(0.0, 1.0) as f32;
        let told = format!("{:.1} of {:.1} s", speaking.time_secs.clamp(0.0, all), speaking.duration_secs);
        let bar = ui.add(ProgressBar::new(share).text(told.as_str()));
        named(&bar, || format!("Spoken: {told}"));
    });
    match speaking.sound {
        Some(Ok(())) => {}
        Some(Err(why)) => drop(ui.weak(format!("Without sound: {why}"))),
        None => drop(ui.weak("Without sound: there is none beside the labels.")),
    }
    ui.horizontal_wrapped(|ui| {
        for (format, name) in model.film_formats.iter().enumerate() {
            let button = Button::new(format!("Film: {name}"));
            if ui.add_enabled(model.film.is_none() && speaking.cannot.is_none(), button).clicked() {
                actions.push(Action::FilmSpeech(format));
            }
        }
    });
}

fn microphone(ui: &mut Ui, speaking: &Speaking<'_>, actions: &mut Vec<Action>) {
    const NAME: &str = "The face says what the microphone hears";
    ui.strong("From the microphone");
    match speaking.microphone {
        Ok(is_on) => {
            let mut wanted = is_on;
            if ui.add(Checkbox::new(&mut wanted, NAME)).changed() {
                actions.push(Action::Microphone);
            }
            if is_on {
                let bar = ui.add(ProgressBar::new(speaking.heard.clamp(0.0, 1.0)).desired_height(6.0));
                named(&bar, || "Loudness".to_owned());
            }
        }
        Err(why) => {
            ui.add_enabled(false, Checkbox::new(&mut false, NAME)).on_disabled_hover_text(why);
            ui.weak(why);
        }
    }
}

fn amount(ui: &mut Ui, speaking: &Speaking<'_>, actions: &mut Vec<Action>) {
    ui.strong("How much the mouth moves");
    let mut amount = speaking.amount;
    ui.spacing_mut().slider_width = (ui.available_width() - 80.0).clamp(40.0, 200.0);
    ui.horizontal(|ui| {
        let slider = ui.add(Slider::new(&mut amount, 0.0..=1.0).step_by(0.01).show_value(false));
        named(&slider, || "How much the mouth moves".to_owned());
        ui.label(format!("{:.0} %", 100.0 * speaking.amount));
        if slider.changed() && amount != speaking.amount {
            actions.push(Action::SpeechAmount(amount));
        }
    });
}
