use crate::{Action, Model, PanelState};

/// The panel over the picture, and what it has in mind from frame to frame.
#[derive(Clone, Debug, Default)]
pub struct Panel {
    state: PanelState,
}

impl Panel {
    /// A panel as it was left.
    pub fn new(state: PanelState) -> Self {
        Self { state: state.sound() }
    }

    /// What is to be remembered.
    pub fn state(&self) -> PanelState {
        self.state.clone()
    }

    /// Opens or closes the help. The keys F1 and ? do so by themselves.
    pub fn toggle_help(&mut self) {}

    /// Shows everything in a window's root and appends what the user wants. Returns the rectangle that is left for the face, in points of
    /// the context (times [`egui::Context::pixels_per_point`]: pixels).
    pub fn show(&mut self, ui: &mut egui::Ui, _model: &Model<'_>, _actions: &mut Vec<Action>) -> egui::Rect {
        ui.available_rect_before_wrap()
    }
}
