//! What a pose is called and how it is called up, and the form for it.

use crate::Model;
use crate::widgets::named;
use egui::{Button, Checkbox, DragValue, TextEdit, Ui};
use pose_anim::Pose;

/// What a pose is called and how it is called up.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PoseForm {
    /// Unique name.
    pub name: String,
    /// Name of the key that calls it.
    pub key: Option<String>,
    /// Seconds that a move to it takes; `None`: each control takes its own time.
    pub duration_secs: Option<f64>,
}

impl From<&Pose> for PoseForm {
    fn from(pose: &Pose) -> Self {
        Self { name: pose.name.clone(), key: pose.key.clone(), duration_secs: pose.duration_secs }
    }
}

/// Seconds that a file of poses takes as a duration.
const DURATIONS: std::ops::RangeInclusive<f64> = 0.001..=3600.0;

impl PoseForm {
    /// The form as a pose can have it: without blanks around the name and key. `own` is the pose that is
    /// edited, if it is not a new one.
    ///
    /// # Errors
    /// What the user has to change, as a sentence: the rules are those of `poses.toml`.
    pub fn check(&self, model: &Model<'_>, own: Option<usize>) -> Result<Self, String> {
        let name = self.name.trim();
        if name.is_empty() {
            return Err("Give the pose a name.".to_owned());
        }
        if name.chars().any(char::is_control) {
            return Err("A name is one line of text.".to_owned());
        }
        let others =
            || model.poses.iter().enumerate().filter(|(index, _)| Some(*index) != own).map(|(_, pose)| pose);
        if others().any(|pose| pose.name == name) {
            return Err(format!("There is a pose {name:?} already: choose another name."));
        }
        let key = self.key.as_deref().map(str::trim).filter(|key| !key.is_empty());
        if let Some(key) = key {
            let one = key.chars().count() == 1 && !key.chars().any(char::is_control);
            if !one && !key.chars().all(|letter| letter.is_ascii_alphanumeric()) {
                return Err(format!("{key:?} is no key: write one, such as 1, q or F5."));
            }
            if model.reserved_keys.contains(&key) {
                return Err(format!("The key {key} has a meaning of its own: choose another one."));
            }
            if let Some(pose) = others().find(|pose| pose.key.as_deref() == Some(key)) {
                return Err(format!("The key {key} calls {:?}: choose another one.", pose.name));
            }
            if let Some(clip) = model.clips.iter().find(|clip| clip.key.as_deref() == Some(key)) {
                return Err(format!("The key {key} plays {:?}: choose another one.", clip.name));
            }
        }
        if self.duration_secs.is_some_and(|secs| !DURATIONS.contains(&secs)) {
            return Err("A duration is 0.001 to 3600 seconds.".to_owned());
        }
        Ok(Self { name: name.to_owned(), key: key.map(str::to_owned), duration_secs: self.duration_secs })
    }
}

/// A form that is open.
#[derive(Clone, Debug)]
pub(crate) struct OpenForm {
    /// The pose that is edited; `None`: a new one.
    pub(crate) own: Option<usize>,
    form: PoseForm,
    key: String,
    fresh: bool,
}

/// What became of an open form.
pub(crate) enum Outcome {
    Open,
    Closed,
    Done(PoseForm),
}

impl OpenForm {
    pub(crate) fn new(own: Option<usize>, form: PoseForm) -> Self {
        Self { own, key: form.key.clone().unwrap_or_default(), form, fresh: true }
    }

    pub(crate) fn show(&mut self, ui: &mut Ui, model: &Model<'_>) -> Outcome {
        let frame = crate::style::card_frame(ui);
        frame.show(ui, |ui| self.fields(ui, model)).inner
    }

    fn fields(&mut self, ui: &mut Ui, model: &Model<'_>) -> Outcome {
        ui.strong(if self.own.is_some() { "Edit the pose" } else { "Save this face as a pose" });
        let entered = egui::Grid::new("pose form").num_columns(2).show(ui, |ui| {
            ui.label("Name");
            let name = ui.add(TextEdit::singleline(&mut self.form.name).desired_width(f32::INFINITY));
            named(&name, || "Name of the pose".to_owned());
            if std::mem::take(&mut self.fresh) {
                name.request_focus();
            }
            ui.end_row();
            ui.label("Key");
            let key = ui.add(TextEdit::singleline(&mut self.key).hint_text("none").desired_width(60.0));
            named(&key, || "Key of the pose".to_owned());
            ui.end_row();
            ui.label("Duration");
            ui.horizontal(|ui| {
                let mut fixed = self.form.duration_secs.is_some();
                if ui.add(Checkbox::new(&mut fixed, "fixed")).changed() {
                    self.form.duration_secs = fixed.then_some(0.5);
                }
                if let Some(secs) = &mut self.form.duration_secs {
                    let entry =
                        DragValue::new(secs).range(DURATIONS).speed(0.01).max_decimals(3).suffix(" s");
                    named(&ui.add(entry), || "Duration of the pose, seconds".to_owned());
                }
            });
            ui.end_row();
            let pressed = ui.input(|input| input.key_pressed(egui::Key::Enter));
            pressed && (name.lost_focus() || key.lost_focus())
        });
        self.form.key = (!self.key.trim().is_empty()).then(|| self.key.clone());
        let checked = self.form.check(model, self.own);
        if let Err(problem) = &checked {
            ui.colored_label(ui.visuals().warn_fg_color, problem);
        }
        ui.horizontal(|ui| {
            let save = ui.add_enabled(checked.is_ok(), Button::new("Save pose")).clicked();
            let close =
                ui.button("Cancel").clicked() || ui.input(|input| input.key_pressed(egui::Key::Escape));
            match checked {
                Ok(form) if save || entered.inner => Outcome::Done(form),
                _ if close => Outcome::Closed,
                _ => Outcome::Open,
            }
        })
        .inner
    }
}
