//! The panel over the picture: sliders, poses, clips, speech, live faces, help, messages and statistics of a
//! face.
//!
//! ```text
//!  Model (borrowed) ──▶ Panel::show(ui, …) ──▶ Vec<Action>, the rectangle left for the face
//!                          │     ▲
//!                          ▼     │
//!                        PanelState: what is remembered from run to run
//! ```
//!
//! The panel is drawn with [`egui`] into whatever root [`egui::Ui`] it is given. It changes nothing: it shows
//! a [`Model`] and returns [`Action`]s, which the caller carries out and shows in the next frame's model. So
//! it knows no window, no GPU, no files and no clock, and can be tested without any of them.
//!
//! # Example
//!
//! ```
//! use avatar_panel::{Action, Model, Panel, PanelState, Playback, Stats};
//! use pose_anim::{ControlTable, PoseSet};
//!
//! let controls = ControlTable::default_face();
//! let poses = PoseSet::default_face(&controls);
//! let mut values = controls.defaults();
//! let mut panel = Panel::new(PanelState::default());
//!
//! let ctx = egui::Context::default();
//! let mut actions = Vec::new();
//! let model = Model {
//!     values: &values,
//!     can_save: Err("The poses of this face are built in."),
//!     ..Model::new(&controls, &poses)
//! };
//! let mut free = egui::Rect::NOTHING;
//! let mut output = ctx.run_ui(egui::RawInput::default(), |ui| free = panel.show(ui, &model, &mut actions));
//! // A window would paint it.
//! output.textures_delta.clear();
//! for action in actions {
//!     if let Action::SetControl { control, value, .. } = action {
//!         values[control] = value;
//!     }
//! }
//! assert!(free.width() > 0.0);
//! ```
//!
//! # For who wires it to a window
//!
//! - Every frame: fill a model, call [`Panel::show`], carry the actions out in order, draw the face within
//!   the returned rectangle.
//! - The pointer is the panel's while [`egui::Context::egui_wants_pointer_input`], keys are where
//!   [`Panel::takes_key`] says so.
//! - F1 and ? (where [`Model::help_keys`] has them) and Escape open and close the help by themselves: forward
//!   them, and do not call [`Panel::toggle_help`] for them, too.
//! - Scaling text scales points: [`egui::Context::pixels_per_point`] follows.
//! - Everything has a name for screen readers; forward AccessKit's events and trees to have them read.

mod groups;
mod model;
mod state;
mod style;
mod help;
mod overlay;
mod widgets;
mod pose_form;
mod action;
mod clips;
mod face;
mod live;
mod notices;
mod pose_cards;
mod poses;
mod speak;
mod timeline;
mod view;
mod panel;

pub use action::{Action, Edit, Wish};
/// The version of egui that the interface speaks.
pub use egui;
pub use model::{
    FileClip, FilePlayback, FilmProgress, Inlet, KeyRow, Live, LiveSender, Loading, Message, Model, Playback,
    Severity, Speaking, Stats,
};
pub use panel::Panel;
pub use pose_form::PoseForm;
pub use state::{PanelState, Tab, Theme};
