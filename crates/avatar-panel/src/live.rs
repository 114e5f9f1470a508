//! Who drives the face from outside: where it is listened, who sends, and how well it arrives.

use crate::widgets::named;
use crate::{Action, Inlet, Live, LiveSender, Model, Wish, clips};
use egui::{Button, Checkbox, RichText, ScrollArea, Slider, Ui, vec2};

pub(crate) fn show(ui: &mut Ui, model: &Model<'_>, actions: &mut Vec<Action>) {
    let Some(live) = &model.live else {
        ui.weak("This program listens to nobody.");
        return;
    };
    ScrollArea::vertical().id_salt("live").auto_shrink(false).show(ui, |ui| {
        inlets(ui, live, actions);
        ui.add_space(6.0);
        senders(ui, live, actions);
        ui.add_space(6.0);
        person(ui, live, actions);
        ui.add_space(6.0);
        recording(ui, model, actions);
        ui.add_space(6.0);
        window(ui, live, actions);
    });
}

fn wish(actions: &mut Vec<Action>, wish: Wish) {
    actions.push(Action::Live(wish));
}

fn inlets(ui: &mut Ui, live: &Live<'_>, actions: &mut Vec<Action>) {
    ui.strong("Listen to");
    for (index, inlet) in live.inlets.iter().enumerate() {
        let Inlet { name, place } = *inlet;
        ui.horizontal(|ui| {
            let mut is_open = place.is_some();
            if ui.add(Checkbox::new(&mut is_open, name)).changed() {
                wish(actions, Wish::Listen { inlet: index, is_wanted: is_open });
            }
            if let Some(place) = place {
                ui.add(egui::Label::new(RichText::new(place).weak()).truncate()).on_hover_text(place);
            }
        });
    }
    let mut hears_others = live.hears_others;
    let others = ui.add(Checkbox::new(&mut hears_others, "From other computers and phones, too"));
    let others = others.on_hover_text("Anybody in the network can then move the face.");
    if others.changed() {
        wish(actions, Wish::HearOthers(hears_others));
    }
    ui.horizontal(|ui| {
        if ui.button("Play a recording…").clicked() {
            wish(actions, Wish::Play);
        }
        if let Some(name) = live.recording {
            ui.add(egui::Label::new(RichText::new(name).weak()).truncate()).on_hover_text(name);
        }
    });
    // Below what is there without them: nothing may move under a pointer that is about to press.
    for (index, page) in live.turned_away.iter().enumerate() {
        ui.horizontal(|ui| {
            let let_in = ui.button("Let in");
            named(&let_in, || format!("Let in {page}"));
            if let_in.on_hover_text("It can move the face then.").clicked() {
                wish(actions, Wish::LetIn(index));
            }
            ui.weak(shortened(page)).on_hover_text(format!("{page} was turned away."));
        });
    }
}

/// An address of which beginning and end are seen: whose it is stands at the end.
fn shortened(page: &str) -> String {
    let (count, most) = (page.chars().count(), 32);
    if count <= most {
        return page.to_owned();
    }
    let first: String = page.chars().take(8).collect();
    let last: String = page.chars().skip(count - (most - 9)).collect();
    format!("{first}…{last}")
}

fn senders(ui: &mut Ui, live: &Live<'_>, actions: &mut Vec<Action>) {
    ui.strong("Senders");
    if live.senders.is_empty() {
        let is_listening = live.inlets.iter().any(|inlet| inlet.place.is_some());
        ui.weak(if is_listening { "Nobody has sent anything yet." } else { "Nobody is listened to." });
        return;
    }
    let width = ui.available_width();
    let anybody = Button::selectable(!live.is_choice, "Whoever sends a face").min_size(vec2(width, 0.0));
    if ui.add(anybody).clicked() && live.is_choice {
        wish(actions, Wish::Follow(None));
    }
    for (index, sender) in live.senders.iter().enumerate() {
        let LiveSender { name, is_followed, is_live, rate_hz, .. } = *sender;
        let text = if is_followed { RichText::new(name).strong() } else { RichText::new(name) };
        let right = if is_live { format!("{rate_hz:.0} per second") } else { "silent".to_owned() };
        let row = Button::selectable(live.is_choice && is_followed, text);
        let row = row.right_text(RichText::new(right.as_str()).weak()).truncate();
        let row = ui.add(row.min_size(vec2(width, 0.0)));
        named(&row, || format!("sender {name}, {right}{}", if is_followed { ", followed" } else { "" }));
        if row.clicked() {
            wish(actions, Wish::Follow(Some(index)));
        }
        ui.indent(("sender", index), |ui| ui.weak(numbers(sender)));
    }
    if let Some(ms) = live.draw_ms {
        ui.weak(format!("A face is drawn {ms:.0} ms after its time."));
    }
}

/// How a sender's frames arrive, in a line.
fn numbers(sender: &LiveSender<'_>) -> String {
    let share = sender.lost as f64 / (sender.received + sender.lost).max(1) as f64;
    let percent = if sender.lost > 0 { format!(" ({:.1} %)", 100.0 * share) } else { String::new() };
    let late = if sender.late > 0 { format!(", {} late", sender.late) } else { String::new() };
    format!("{}: {} lost{percent}{late}, delay {:.0} ms", sender.protocol, sender.lost, sender.delay_ms)
}

fn person(ui: &mut Ui, live: &Live<'_>, actions: &mut Vec<Action>) {
    ui.strong("Person");
    ui.horizontal_wrapped(|ui| {
        let is_followed = live.senders.iter().any(|sender| sender.is_followed && sender.is_live);
        let button = ui.add_enabled(is_followed, Button::new("Calibrate"));
        let why = "Calls what the person's face is now neutral. Look straight ahead, and rest.";
        if button.on_hover_text(why).on_disabled_hover_text("It takes somebody who sends a face.").clicked() {
            wish(actions, Wish::Calibrate);
        }
        if ui.add_enabled(live.is_calibrated, Button::new("Forget")).clicked() {
            wish(actions, Wish::ForgetCalibration);
        }
        if let Some(file) = live.calibration_file {
            ui.add(egui::Label::new(RichText::new(file).weak()).truncate()).on_hover_text(file);
        }
    });
    let mut is_mirrored = live.is_mirrored;
    if ui.add(Checkbox::new(&mut is_mirrored, "As in a mirror")).changed() {
        wish(actions, Wish::Mirror(is_mirrored));
    }
    ui.spacing_mut().slider_width = (ui.available_width() - 130.0).clamp(40.0, 200.0);
    ui.horizontal(|ui| {
        ui.label("Smooth");
        let mut smooth = live.smooth;
        let slider = ui.add(Slider::new(&mut smooth, 0.0..=1.0).step_by(0.01).show_value(false));
        named(&slider, || "Smooth".to_owned());
        ui.label(format!("{:.0} %", 100.0 * live.smooth));
        if slider.changed() && smooth != live.smooth {
            wish(actions, Wish::Smooth(smooth));
        }
    });
}

fn recording(ui: &mut Ui, model: &Model<'_>, actions: &mut Vec<Action>) {
    ui.strong("Record");
    ui.horizontal(|ui| {
        clips::recording(ui, model, actions);
        if model.playback.recording_secs.is_none() {
            ui.weak("It becomes a clip in the tab of clips.");
        }
    });
}

fn window(ui: &mut Ui, live: &Live<'_>, actions: &mut Vec<Action>) {
    ui.strong("Window");
    let mut is_on_top = live.is_on_top;
    if ui.add(Checkbox::new(&mut is_on_top, "Always on top")).changed() {
        wish(actions, Wish::OnTop(is_on_top));
    }
}

#[cfg(test)]
mod tests {
    use super::numbers;
    use crate::LiveSender;

    #[test]
    fn numbers_of_a_sender_are_in_a_line() {
        let sender =
            LiveSender { protocol: "livelink", received: 97, lost: 3, delay_ms: 21.6, ..LiveSender::NONE };
        assert_eq!(numbers(&sender), "livelink: 3 lost (3.0 %), delay 22 ms");
        let sender = LiveSender { late: 2, ..LiveSender::NONE };
        assert_eq!(numbers(&sender), ": 0 lost, 2 late, delay 0 ms");
    }
}
