use crate::standard;
use avatar_panel::{Message, Severity};
use std::time::{Duration, Instant};

/// What the user has to know, until it is dismissed or its cause has gone.
#[derive(Debug, Default)]
pub(super) struct Messages {
    all: Vec<Told>,
}

#[derive(Debug)]
struct Told {
    /// A newer message about the same takes its place.
    about: About,
    severity: Severity,
    title: String,
    text: String,
    /// When it goes by itself.
    until: Option<Instant>,
}

/// How long news stay.
const NEWS: Duration = Duration::from_secs(6);

/// What a message is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum About {
    Opening,
    Speech,
    Sound,
    Live,
    Poses,
    Clips,
    Materials,
    Hair,
    Picture,
    Film,
    Settings,
    Keys,
    Device,
}

/// The latest ones that are kept.
const KEPT: usize = 5;

impl Messages {
    /// Tells of an error, also where the program was started from.
    pub(super) fn error(&mut self, about: About, title: impl Into<String>, error: &anyhow::Error) {
        let (title, text) = (title.into(), format!("{error:#}"));
        standard::tell(format_args!("error: {text}: {}", as_clause(&title)));
        self.tell(about, Severity::Error, title, text);
    }

    /// Shows an error under this title; on success removes the earlier message about the same thing.
    pub(super) fn report(&mut self, about: About, title: &str, done: anyhow::Result<()>) {
        match done {
            Ok(()) => self.settle(about),
            Err(error) => self.error(about, title, &error),
        }
    }

    pub(super) fn warn(&mut self, about: About, title: impl Into<String>, text: impl Into<String>) {
        let (title, text) = (title.into(), text.into());
        standard::warn(&text);
        self.tell(about, Severity::Warning, title, text);
    }

    pub(super) fn news(&mut self, about: About, title: impl Into<String>, text: impl Into<String>) {
        self.tell(about, Severity::Info, title.into(), text.into());
    }

    fn tell(&mut self, about: About, severity: Severity, title: String, text: String) {
        self.settle(about);
        let until = (severity == Severity::Info).then(|| Instant::now() + NEWS);
        self.all.insert(0, Told { about, severity, title, text, until });
        self.all.truncate(KEPT);
    }

    /// The cause has gone.
    pub(super) fn settle(&mut self, about: About) {
        self.all.retain(|told| told.about != about);
    }

    /// When the next message disappears by itself.
    pub(super) fn next(&self) -> Option<Instant> {
        self.all.iter().filter_map(|told| told.until).min()
    }

    /// Takes those away that go by themselves; whether there were any.
    pub(super) fn expire(&mut self) -> bool {
        let (before, now) = (self.all.len(), Instant::now());
        self.all.retain(|told| told.until.is_none_or(|until| now < until));
        self.all.len() < before
    }

    pub(super) fn dismiss(&mut self, index: usize) {
        if index < self.all.len() {
            self.all.remove(index);
        }
    }

    pub(super) fn shown(&self) -> impl Iterator<Item = Message<'_>> {
        self.all.iter().map(|told| Message {
            severity: told.severity,
            title: &told.title,
            text: &told.text,
            dismissible: true,
        })
    }
}

/// A sentence as a part of another one.
fn as_clause(sentence: &str) -> String {
    let mut letters = sentence.trim_end_matches('.').chars();
    letters.next().map(char::to_lowercase).into_iter().flatten().chain(letters).collect()
}
