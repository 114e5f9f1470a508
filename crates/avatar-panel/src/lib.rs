//! The panel over the picture.

mod action;
mod model;
mod panel;
mod pose_form;
mod state;

pub use action::Action;
pub use model::{FilmProgress, KeyRow, Loading, Message, Model, Playback, Severity, Stats};
pub use panel::Panel;
pub use pose_form::PoseForm;
pub use state::{PanelState, Tab, Theme};
