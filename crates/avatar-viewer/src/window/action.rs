use super::camera::Place;

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
    /// Shows the keys, or no longer.
    Help,
    /// Folds the panel, or unfolds it.
    FoldPanel,
}

/// How the camera moves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum CameraMove {
    /// Around the face: degrees to the character's left, degrees up.
    Orbit(f32, f32),
    /// Multiplies its distance.
    Zoom(f32),
    /// Moves the picture: shares of its height to the right and up.
    Pan(f32, f32),
    /// To a place.
    Go(Place),
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
