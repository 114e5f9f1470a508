use super::camera::CameraMove;

/// Everything that a user can want of the window, by key, by pointer or by the panel.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Action {
    /// What the panel offers, too.
    Panel(avatar_panel::Action),
    /// Another view.
    Camera(CameraMove),
    /// Goes to a pose by its key, whatever slider is held.
    PressPose(usize),
    /// Plays a clip by its key, whatever slider is held.
    PressClip(usize),
    /// Plays the clip, or halts what plays.
    PlayOrPause,
    /// Begins to record a clip, or ends it.
    Record,
    /// Shows or hides the keys.
    Help,
    /// Folds or unfolds the panel.
    FoldPanel,
}

impl Action {
    /// Whether a key that is held down does it again and again.
    pub(crate) const fn repeats(&self) -> bool {
        use avatar_panel::{Action as Panel, Edit};
        match self {
            Self::Camera(moved) => !matches!(moved, CameraMove::Go(_)),
            Self::Panel(wanted) => matches!(wanted, Panel::Edit(Edit::Undo | Edit::Redo)),
            _ => false,
        }
    }
}
