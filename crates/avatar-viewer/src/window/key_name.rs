use std::fmt;
use winit::event::Modifiers;
use winit::keyboard::{Key, NamedKey};

/// A key with the modifiers that are held, as people write it: `x`, `X` or `Shift+x`, `F5`, `Ctrl+Left`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct KeyName {
    ctrl: bool,
    alt: bool,
    /// Of named keys only: characters say themselves what Shift makes of them.
    shift: bool,
    key: Base,
}

#[derive(Clone, Debug, PartialEq, Eq)]
enum Base {
    Character(char),
    Named(NamedKey),
}

/// Named keys that have shorter names here than winit's; all others are called as winit calls them.
const SHORT: [(&str, NamedKey); 4] = [
    ("Left", NamedKey::ArrowLeft),
    ("Right", NamedKey::ArrowRight),
    ("Up", NamedKey::ArrowUp),
    ("Down", NamedKey::ArrowDown),
];

/// Named keys that can be named.
const NAMED: [NamedKey; 30] = [
    NamedKey::ArrowLeft,
    NamedKey::ArrowRight,
    NamedKey::ArrowUp,
    NamedKey::ArrowDown,
    NamedKey::PageUp,
    NamedKey::PageDown,
    NamedKey::Home,
    NamedKey::End,
    NamedKey::Insert,
    NamedKey::Delete,
    NamedKey::Backspace,
    NamedKey::Enter,
    NamedKey::Tab,
    NamedKey::Space,
    NamedKey::Escape,
    NamedKey::F1,
    NamedKey::F2,
    NamedKey::F3,
    NamedKey::F4,
    NamedKey::F5,
    NamedKey::F6,
    NamedKey::F7,
    NamedKey::F8,
    NamedKey::F9,
    NamedKey::F10,
    NamedKey::F11,
    NamedKey::F12,
    NamedKey::PrintScreen,
    NamedKey::Pause,
    NamedKey::ContextMenu,
];

impl KeyName {
    /// Reads the name of a key; `None` if no key has this name.
    pub(crate) fn parse(text: &str) -> Option<Self> {
        let (mut ctrl, mut alt, mut shift) = (false, false, false);
        let mut rest = text;
        loop {
            let modifier = rest.char_indices().find(|(_, c)| *c == '+').filter(|(at, _)| *at > 0);
            let Some((at, _)) = modifier else { break };
            match rest[..at].to_ascii_lowercase().as_str() {
                "ctrl" | "cmd" => ctrl = true,
                "alt" => alt = true,
                "shift" => shift = true,
                _ => return None,
            }
            rest = &rest[at + 1..];
        }
        let mut characters = rest.chars();
        let key = match (characters.next()?, characters.next()) {
            (' ', None) => Base::Named(NamedKey::Space),
            (one, None) if shift => {
                shift = false;
                Base::Character(one.to_uppercase().next()?)
            }
            (one, None) => Base::Character(one),
            _ => Base::Named(named(rest)?),
        };
        Some(Self { ctrl, alt, shift, key })
    }

    /// The name of a key that was pressed.
    pub(crate) fn of(key: &Key, modifiers: &Modifiers) -> Option<Self> {
        let state = modifiers.state();
        // What is Ctrl elsewhere is the command key on a Mac.
        let ctrl = if cfg!(target_os = "macos") { state.super_key() } else { state.control_key() };
        let (key, shift) = match key {
            Key::Named(named) => (Base::Named(*named), state.shift_key()),
            Key::Character(typed) => {
                let mut characters = typed.chars();
                let (one, None) = (characters.next()?, characters.next()) else { return None };
                // With Ctrl held some systems leave letters small.
                let one = if state.shift_key() { one.to_uppercase().next()? } else { one };
                (Base::Character(one), false)
            }
            _ => return None,
        };
        Some(Self { ctrl, alt: state.alt_key(), shift, key })
    }
}

fn named(text: &str) -> Option<NamedKey> {
    let short = SHORT.iter().find(|(name, _)| name.eq_ignore_ascii_case(text)).map(|(_, key)| *key);
    short.or_else(|| NAMED.into_iter().find(|key| format!("{key:?}").eq_ignore_ascii_case(text)))
}

impl fmt::Display for KeyName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let is_capital =
            matches!(self.key, Base::Character(one) if one.is_uppercase() && one.to_lowercase().count() == 1);
        for (is_held, name) in
            [(self.ctrl, "Ctrl+"), (self.alt, "Alt+"), (self.shift || is_capital, "Shift+")]
        {
            if is_held {
                f.write_str(name)?;
            }
        }
        match self.key {
            Base::Character(one) if is_capital => write!(f, "{}", one.to_lowercase()),
            Base::Character(one) => write!(f, "{one}"),
            Base::Named(key) => match SHORT.iter().find(|(_, named)| *named == key) {
                Some((name, _)) => f.write_str(name),
                None => write!(f, "{key:?}"),
            },
        }
    }
}
