//! The poses: go to one, keep one, change one.

use crate::pose_cards;
use crate::pose_form::{OpenForm, Outcome};
use crate::widgets::{Icon, icon_button_if, named};
use crate::{Action, Edit, Model, PoseForm};
use egui::{Button, Label, RichText, Ui};

/// What the list of poses has in mind.
#[derive(Clone, Debug, Default)]
pub(crate) struct Poses {
    /// The pose that the tools act on.
    selected: Option<usize>,
    form: Option<OpenForm>,
}

impl Poses {
    pub(crate) fn show(&mut self, ui: &mut Ui, model: &Model<'_>, actions: &mut Vec<Action>) {
        self.selected = self.selected.filter(|index| *index < model.poses.poses.len());
        let stale = |form: &OpenForm| form.own.is_some_and(|own| own >= model.poses.poses.len());
        if self.form.as_ref().is_some_and(stale) {
            self.form = None;
        }
        self.keep(ui, model, actions);
        self.show_form(ui, model, actions);
        self.tools(ui, model, actions);
        ui.separator();
        if model.poses.poses.is_empty() {
            ui.weak("No poses yet. Set the sliders and save the face.");
        }
        for action in pose_cards::show(ui, model, self.selected) {
            match action {
                Action::GoTo(index) => self.selected = Some(index),
                Action::Edit(Edit::MovePose { to, .. }) => self.selected = Some(to),
                _ => {}
            }
            actions.push(action);
        }
    }

    /// Saving, undoing, redoing.
    fn keep(&mut self, ui: &mut Ui, model: &Model<'_>, actions: &mut Vec<Action>) {
        ui.horizontal_wrapped(|ui| {
            let save = ui.add_enabled(model.can_save.is_ok(), Button::new("Save this face…"));
            let save = save.on_disabled_hover_text(model.can_save.err().unwrap_or_default());
            if save.clicked() {
                self.form = Some(OpenForm::new(None, PoseForm::default()));
            }
            for (verb, what, action) in [
                ("Undo", model.can_undo, Action::Edit(Edit::Undo)),
                ("Redo", model.can_redo, Action::Edit(Edit::Redo)),
            ] {
                let text = what.map_or_else(|| verb.to_owned(), |what| format!("{verb} {what}"));
                if ui.add_enabled(what.is_some(), Button::new(text)).clicked() {
                    actions.push(action);
                }
            }
        });
        if let Err(why) = model.can_save {
            ui.weak(why);
        }
    }

    fn show_form(&mut self, ui: &mut Ui, model: &Model<'_>, actions: &mut Vec<Action>) {
        let Some(open) = &mut self.form else { return };
        match open.show(ui, model) {
            Outcome::Open => {}
            Outcome::Closed => self.form = None,
            Outcome::Done(form) => {
                actions.push(match open.own {
                    Some(index) => Action::Edit(Edit::EditPose { index, form }),
                    None => Action::Edit(Edit::SavePose(form)),
                });
                self.form = None;
            }
        }
    }

    /// What can be done with the selected pose.
    fn tools(&mut self, ui: &mut Ui, model: &Model<'_>, actions: &mut Vec<Action>) {
        let Some(index) = self.selected.or(model.active_pose) else { return };
        let Some(pose) = model.poses.poses.get(index) else { return };
        let name = &pose.name;
        let can = model.can_save.is_ok();
        // On a line of its own: a long name would tear the tools apart.
        ui.add(Label::new(RichText::new(name).strong()).truncate());
        ui.horizontal_wrapped(|ui| {
            let tool = |ui: &mut Ui, text: &str, what: &str| {
                let response = ui.add_enabled(can, Button::new(text)).on_hover_text(what);
                named(&response, || format!("{text} {name}"));
                response.clicked()
            };
            if tool(ui, "Update", "Give this pose the present face") {
                actions.push(Action::Edit(Edit::UpdatePose(index)));
            }
            if tool(ui, "Edit…", "Change name, key or duration") {
                self.form = Some(OpenForm::new(Some(index), PoseForm::from(pose)));
            }
            if tool(ui, "Delete", "Delete this pose; this can be undone") {
                actions.push(Action::Edit(Edit::DeletePose(index)));
                (self.selected, self.form) = (None, None);
            }
            let last = model.poses.poses.len() - 1;
            let moves = [
                (Icon::Up, "up", index > 0, index.wrapping_sub(1)),
                (Icon::Down, "down", index < last, index + 1),
            ];
            for (icon, direction, possible, to) in moves {
                let response = icon_button_if(ui, can && possible, icon, &format!("Move {name} {direction}"));
                if response.clicked() {
                    actions.push(Action::Edit(Edit::MovePose { from: index, to }));
                    self.selected = Some(to);
                }
            }
        });
    }
}
