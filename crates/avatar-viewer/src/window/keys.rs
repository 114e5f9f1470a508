use avatar_pack::Pack;
use pose_anim::Pose;
use winit::keyboard::{Key, KeyCode, NamedKey, PhysicalKey};

/// What a key does in the window.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Action {
    /// Turn the camera: degrees around, degrees up.
    Orbit(f32, f32),
    /// Multiply the camera's distance.
    Zoom(f32),
    /// Camera to the front.
    Front,
    /// Back to the default face.
    Defaults,
    /// Other hair: the next, or the one before.
    Hair { backward: bool },
    /// Close the window.
    Close,
}

/// A key that the window handles itself: name, what it does, in words and in deed. The same table handles keys and
/// prints them.
pub(crate) const WINDOW_KEYS: [(Key<&str>, &str, &str, Action); 12] = [
    (Key::Named(NamedKey::ArrowLeft), "Left", "camera to the character's right", Action::Orbit(-5.0, 0.0)),
    (Key::Named(NamedKey::ArrowRight), "Right", "camera to the character's left", Action::Orbit(5.0, 0.0)),
    (Key::Named(NamedKey::ArrowUp), "Up", "camera up", Action::Orbit(0.0, 5.0)),
    (Key::Named(NamedKey::ArrowDown), "Down", "camera down", Action::Orbit(0.0, -5.0)),
    (Key::Named(NamedKey::PageUp), "PageUp", "nearer", Action::Zoom(0.9)),
    (Key::Named(NamedKey::PageDown), "PageDown", "farther", Action::Zoom(1.0 / 0.9)),
    (Key::Named(NamedKey::Home), "Home", "camera to the front", Action::Front),
    (Key::Character("h"), "h", "other hair", Action::Hair { backward: false }),
    (Key::Character("H"), "Shift+h", "the hair before", Action::Hair { backward: true }),
    (Key::Named(NamedKey::Backspace), "Backspace", "back to the default face", Action::Defaults),
    (Key::Named(NamedKey::Delete), "Delete", "back to the default face", Action::Defaults),
    (Key::Named(NamedKey::Escape), "Escape", "close the window", Action::Close),
];

/// What the mouse does.
pub(crate) const MOUSE: [(&str, &str); 2] =
    [("drag", "turn the camera around the face"), ("wheel", "nearer, farther")];

/// The action of a key that the window handles itself.
pub(crate) fn action(key: &Key) -> Option<Action> {
    WINDOW_KEYS.iter().find(|(own, ..)| *own == key.as_ref()).map(|(.., action)| *action)
}

/// Keys of poses that never come through, because the window takes them itself.
pub(crate) fn dead(pack: &Pack) -> impl Iterator<Item = String> {
    pack.poses.iter().filter_map(|pose| {
        let key = pose.key.as_ref()?;
        let (_, name, meaning, _) = WINDOW_KEYS.iter().find(|(own, name, ..)| {
            let is_named = |named: &NamedKey| key.eq_ignore_ascii_case(&format!("{named:?}"));
            key.eq_ignore_ascii_case(name) || matches!(own, Key::Named(named) if is_named(named))
        })?;
        Some(format!("pose {}: expected a free key, found {name}, which means: {meaning}", pose.name))
    })
}

/// The pose that this key presses: by the character that the key types, or, where a layout puts that character
/// behind Shift (digits on French keyboards), by the key's place.
pub(crate) fn pose<'a>(pack: &'a Pack, logical: &Key, physical: PhysicalKey) -> Option<&'a Pose> {
    let named = |name: &str| {
        let ignoring_case =
            |pose: &&Pose| pose.key.as_ref().is_some_and(|key| key.eq_ignore_ascii_case(name));
        pack.poses.by_key(name).or_else(|| pack.poses.iter().find(ignoring_case))
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
