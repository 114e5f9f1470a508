//! Which key does what in the window: one table that handles keys, prints them and shows them as help.

use super::action::Action;
use super::camera::{CameraMove, Place};
use super::key_name::KeyName;
use crate::{config, reading};
use anyhow::{Result, anyhow};
use avatar_panel::{Action as Panel, Edit};
use avatar_stage::NamedView;
use placed_toml::{Document, TomlError};
use pose_anim::{Clip, Pose, PoseSet};
use winit::event::Modifiers;
use winit::keyboard::{Key, KeyCode, PhysicalKey};

/// The file in which the user binds other keys.
const FILE: &str = "keys.toml";

/// A row of the table.
#[derive(Clone, Debug)]
pub(crate) struct Row {
    /// Its name in `keys.toml`.
    pub(crate) id: &'static str,
    /// The keys, unless the user has others.
    keys: &'static [&'static str],
    /// What they do, in words.
    pub(crate) meaning: &'static str,
    /// Where it stands in the help.
    pub(crate) group: &'static str,
    /// What they do.
    action: Action,
}

const CAMERA: &str = "Camera";
const FACE: &str = "Face";
const WINDOW: &str = "Window";

const fn row(
    id: &'static str,
    keys: &'static [&'static str],
    meaning: &'static str,
    group: &'static str,
    action: Action,
) -> Row {
    Row { id, keys, meaning, group, action }
}

/// All keys that the window handles itself.
pub(crate) static ROWS: [Row; 27] = [
    row(
        "camera-right",
        &["Left"],
        "camera to the character's right",
        CAMERA,
        Action::Camera(CameraMove::Orbit(-5.0, 0.0)),
    ),
    row(
        "camera-left",
        &["Right"],
        "camera to the character's left",
        CAMERA,
        Action::Camera(CameraMove::Orbit(5.0, 0.0)),
    ),
    row("camera-up", &["Up"], "camera up", CAMERA, Action::Camera(CameraMove::Orbit(0.0, 5.0))),
    row("camera-down", &["Down"], "camera down", CAMERA, Action::Camera(CameraMove::Orbit(0.0, -5.0))),
    row("nearer", &["PageUp"], "nearer", CAMERA, Action::Camera(CameraMove::Zoom(0.9))),
    row("farther", &["PageDown"], "farther", CAMERA, Action::Camera(CameraMove::Zoom(1.0 / 0.9))),
    row(
        "pan-left",
        &["Shift+Left"],
        "picture to the left",
        CAMERA,
        Action::Camera(CameraMove::Pan(-0.05, 0.0)),
    ),
    row(
        "pan-right",
        &["Shift+Right"],
        "picture to the right",
        CAMERA,
        Action::Camera(CameraMove::Pan(0.05, 0.0)),
    ),
    row("pan-up", &["Shift+Up"], "picture up", CAMERA, Action::Camera(CameraMove::Pan(0.0, 0.05))),
    row("pan-down", &["Shift+Down"], "picture down", CAMERA, Action::Camera(CameraMove::Pan(0.0, -0.05))),
    row(
        "front",
        &["Home"],
        "camera to the front",
        CAMERA,
        Action::Camera(CameraMove::Go(Place::View(NamedView::Front))),
    ),
    row(
        "frame-face",
        &["f"],
        "the face fills the picture",
        CAMERA,
        Action::Camera(CameraMove::Go(Place::Face)),
    ),
    row("gaze", &["g"], "eyes follow the pointer, or no longer", FACE, Action::Panel(Panel::Gaze)),
    row("life", &["Shift+l"], "the face lives by itself, or is still", FACE, Action::Panel(Panel::Life)),
    row("hair", &["h"], "other hair", FACE, Action::Panel(Panel::Hair { backward: false })),
    row("hair-before", &["Shift+h"], "the hair before", FACE, Action::Panel(Panel::Hair { backward: true })),
    row(
        "defaults",
        &["Backspace", "Delete"],
        "back to the default face",
        FACE,
        Action::Panel(Panel::ResetAll),
    ),
    row("play", &["Space"], "play or halt the clip", FACE, Action::PlayOrPause),
    row("record", &["Shift+r"], "begin or end the recording of a clip", FACE, Action::Record),
    row("undo", &["Ctrl+z"], "take the last change back", FACE, Action::Panel(Panel::Edit(Edit::Undo))),
    row("redo", &["Ctrl+Shift+z", "Ctrl+y"], "do it again", FACE, Action::Panel(Panel::Edit(Edit::Redo))),
    row("picture", &["p"], "save the picture", WINDOW, Action::Panel(Panel::Picture)),
    row("open", &["Ctrl+o"], "open another avatar", WINDOW, Action::Panel(Panel::OpenFile)),
    row("help", &["F1", "?"], "this table", WINDOW, Action::Help),
    row("panel", &["F2"], "fold the panel, or unfold it", WINDOW, Action::FoldPanel),
    row("full-screen", &["F11"], "fill the screen, or no longer", WINDOW, Action::Panel(Panel::FullScreen)),
    row("close", &["Escape"], "close the window", WINDOW, Action::Panel(Panel::Quit)),
];

/// What the mouse does.
pub(crate) const MOUSE: [(&str, &str); 4] = [
    ("drag", "turn the camera around the face"),
    ("right drag", "move the picture"),
    ("wheel", "nearer, farther"),
    ("drop", "open the file or folder"),
];

/// The keys of every row, the user's or the usual ones.
#[derive(Clone, Debug)]
pub(crate) struct Keys {
    /// For each row.
    names: Vec<Vec<KeyName>>,
}

impl Default for Keys {
    fn default() -> Self {
        let names = ROWS.iter().map(|row| row.keys.iter().filter_map(|key| KeyName::parse(key)).collect());
        Self { names: names.collect() }
    }
}

impl Keys {
    /// The usual keys, replaced where a `keys.toml` says so: `id = "key"` or `id = ["key", "other"]`.
    ///
    /// # Errors
    /// A name that no row has, a key that cannot be, a key twice; with its place.
    fn read(text: &str) -> Result<Self, TomlError> {
        const EXPECTED: &str =
            "the name of a key such as \"x\", \"F5\" or \"Ctrl+Left\", or a list of such names";
        let document = Document::parse(text)?;
        let mut keys = Self::default();
        let mut set: Vec<usize> = Vec::new();
        for entry in document.root().rest() {
            let ids = || ROWS.iter().map(|row| row.id);
            let Some(index) = ids().position(|id| id == entry.name()) else {
                return Err(entry.unknown_name(entry.name(), "one of", ids()));
            };
            let entries = entry.as_array().unwrap_or_else(|| vec![entry]);
            let name = |entry: &placed_toml::Entry<'_, '_>| {
                let name = KeyName::parse(entry.string(EXPECTED)?);
                name.ok_or_else(|| entry.error_found(EXPECTED))
            };
            let mut names = Vec::new();
            for entry in &entries {
                let name = name(entry)?;
                let taken = set.iter().find(|other| keys.names[**other].contains(&name));
                if let Some(other) = taken {
                    let found = format!("{name}, which is the key of {}", ROWS[*other].id);
                    return Err(entry.error("a key of its own", found));
                }
                names.push(name);
            }
            keys.names[index] = names;
            set.push(index);
        }
        // What a user gives to one row is taken from the row that usually has it.
        let given: Vec<KeyName> = set.iter().flat_map(|index| keys.names[*index].clone()).collect();
        for (index, names) in keys.names.iter_mut().enumerate() {
            if !set.contains(&index) {
                names.retain(|name| !given.contains(name));
            }
        }
        Ok(keys)
    }

    /// The keys as the user has bound them in `keys.toml`, among the settings.
    ///
    /// # Errors
    /// A mistake in the file, with its place.
    pub(crate) fn load() -> Result<Self> {
        let Some(path) = config::folder().map(|folder| folder.join(FILE)) else { return Ok(Self::default()) };
        match reading::text(&path)? {
            None => Ok(Self::default()),
            Some(text) => Self::read(&text).map_err(|error| anyhow!("{}: {error}", path.display())),
        }
    }

    /// What a pressed key does, if the window handles it itself; `is_repeat`: because it is held down.
    pub(crate) fn action(&self, key: &Key, modifiers: &Modifiers, is_repeat: bool) -> Option<Action> {
        let pressed = KeyName::of(key, modifiers)?;
        let index = self.names.iter().position(|names| names.contains(&pressed))?;
        // A key that is held down but must not repeat its action still belongs to the window, not to a pose.
        Some(&ROWS[index].action).filter(|action| !is_repeat || action.repeats()).cloned()
    }

    /// Whether the window handles this key itself.
    pub(crate) fn has(&self, key: &Key, modifiers: &Modifiers) -> bool {
        KeyName::of(key, modifiers)
            .is_some_and(|pressed| self.names.iter().any(|names| names.contains(&pressed)))
    }

    /// The rows with their keys, for people.
    pub(crate) fn rows(&self) -> impl Iterator<Item = (String, &'static Row)> {
        let text =
            |names: &Vec<KeyName>| names.iter().map(ToString::to_string).collect::<Vec<_>>().join(" or ");
        self.names.iter().map(text).zip(&ROWS).filter(|(keys, _)| !keys.is_empty())
    }

    /// The keys of the help.
    pub(crate) fn help(&self) -> Vec<String> {
        let help = self.names.iter().zip(&ROWS).filter(|(_, row)| row.action == Action::Help);
        help.flat_map(|(names, _)| names.iter().map(ToString::to_string)).collect()
    }

    /// All keys that no pose can have.
    pub(crate) fn reserved(&self) -> Vec<String> {
        self.names.iter().flatten().map(ToString::to_string).collect()
    }

    /// Keys of poses that never come through, because the window takes them itself.
    pub(crate) fn dead(&self, poses: &PoseSet) -> Vec<String> {
        let warning = |pose: &Pose| {
            let key = KeyName::parse(pose.key.as_ref()?)?;
            let row = self.names.iter().position(|names| names.contains(&key))?;
            Some(format!(
                "pose {}: expected a free key, found {key}, which means: {}",
                pose.name, ROWS[row].meaning
            ))
        };
        poses.iter().filter_map(warning).collect()
    }
}

/// The pose that this key presses: by the character that the key types, or, where a layout puts that
/// character behind Shift (digits on French keyboards), by the key's place.
pub(crate) fn pose(poses: &PoseSet, logical: &Key, physical: PhysicalKey) -> Option<usize> {
    let named = |name: &str| {
        let exactly = |pose: &Pose| pose.key.as_deref() == Some(name);
        let ignoring_case = |pose: &Pose| pose.key.as_ref().is_some_and(|key| key.eq_ignore_ascii_case(name));
        poses.iter().position(exactly).or_else(|| poses.iter().position(ignoring_case))
    };
    let typed = match logical {
        Key::Character(typed) => named(typed),
        Key::Named(key) => named(&format!("{key:?}")),
        _ => None,
    };
    typed.or_else(|| match physical {
        PhysicalKey::Code(code) => digit(code).and_then(named),
        PhysicalKey::Unidentified(_) => None,
    })
}

/// The clip that this key plays.
pub(crate) fn clip(clips: &[Clip], logical: &Key) -> Option<usize> {
    let name = match logical {
        Key::Character(typed) => typed.to_string(),
        Key::Named(key) => format!("{key:?}"),
        _ => return None,
    };
    clips.iter().position(|clip| clip.key.as_ref().is_some_and(|key| key.eq_ignore_ascii_case(&name)))
}

fn digit(code: KeyCode) -> Option<&'static str> {
    Some(match code {
        KeyCode::Digit0 | KeyCode::Numpad0 => "0",
        KeyCode::Digit1 | KeyCode::Numpad1 => "1",
        KeyCode::Digit2 | KeyCode::Numpad2 => "2",
        KeyCode::Digit3 | KeyCode::Numpad3 => "3",
        KeyCode::Digit4 | KeyCode::Numpad4 => "4",
        KeyCode::Digit5 | KeyCode::Numpad5 => "5",
        KeyCode::Digit6 | KeyCode::Numpad6 => "6",
        KeyCode::Digit7 | KeyCode::Numpad7 => "7",
        KeyCode::Digit8 | KeyCode::Numpad8 => "8",
        KeyCode::Digit9 | KeyCode::Numpad9 => "9",
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use winit::keyboard::{ModifiersState, NamedKey};

    fn pressed(keys: &Keys, key: Key<&str>, state: ModifiersState) -> Option<&'static str> {
        let key = match key {
            Key::Character(typed) => Key::Character(typed.into()),
            Key::Named(named) => Key::Named(named),
            _ => return None,
        };
        let action = keys.action(&key, &state.into(), false)?;
        ROWS.iter().find(|row| row.action == action).map(|row| row.id)
    }

    #[test]
    fn every_row_has_a_name_and_keys_of_its_own() {
        let keys = Keys::default();
        let all: Vec<&KeyName> = keys.names.iter().flatten().collect();
        assert_eq!(all.len(), ROWS.iter().map(|row| row.keys.len()).sum::<usize>(), "all are names of keys");
        for (index, key) in all.iter().enumerate() {
            assert!(!all[..index].contains(key), "{key} twice");
            assert_eq!(KeyName::parse(&key.to_string()).as_ref(), Some(*key));
        }
        for (index, row) in ROWS.iter().enumerate() {
            assert!(ROWS[..index].iter().all(|other| other.id != row.id), "{}", row.id);
        }
    }

    #[test]
    fn keys_do_what_the_table_says() {
        let keys = Keys::default();
        let none = ModifiersState::empty();
        assert_eq!(pressed(&keys, Key::Named(NamedKey::ArrowLeft), none), Some("camera-right"));
        assert_eq!(pressed(&keys, Key::Named(NamedKey::ArrowLeft), ModifiersState::SHIFT), Some("pan-left"));
        assert_eq!(pressed(&keys, Key::Character("H"), ModifiersState::SHIFT), Some("hair-before"));
        assert_eq!(pressed(&keys, Key::Character("?"), ModifiersState::SHIFT), Some("help"));
        assert_eq!(pressed(&keys, Key::Character("z"), ModifiersState::CONTROL), Some("undo"));
        assert_eq!(pressed(&keys, Key::Character("z"), none), None);
        assert_eq!(pressed(&keys, Key::Character("h"), ModifiersState::CONTROL), None);
    }

    #[test]
    fn a_user_binds_keys_anew_and_mistakes_have_a_place() {
        let keys = Keys::read("picture = \"Ctrl+s\"\nhair = ['F3', \"p\"]").expect("a table");
        let none = ModifiersState::empty();
        assert_eq!(pressed(&keys, Key::Character("s"), ModifiersState::CONTROL), Some("picture"));
        assert_eq!(pressed(&keys, Key::Character("p"), none), Some("hair"));
        assert_eq!(pressed(&keys, Key::Named(NamedKey::F3), none), Some("hair"));
        assert_eq!(pressed(&keys, Key::Character("h"), none), None);
        // Given to another row, and so no longer this one's.
        let keys = Keys::read("picture = 'F1'").expect("a table");
        assert_eq!(pressed(&keys, Key::Named(NamedKey::F1), none), Some("picture"));
        for (text, expected) in [
            ("pictur = 'x'", "line 1, column 1"),
            ("\npicture = 3", "line 2, column 11"),
            ("picture = 'Ctrl+'", "expected the name of a key"),
            (
                "picture = 'x'\nhair = 'x'",
                "line 2, column 8: hair: expected a key of its own, found x, which is the key of picture",
            ),
        ] {
            let error = Keys::read(text).expect_err(text).to_string();
            assert!(error.contains(expected), "{error}");
        }
    }
}
