//! Words of files of id Tech 4.

use crate::build::text::{at_line, float, number, shown};
use crate::scene::ImportError;
use glam::{DQuat, DVec3};

/// Words, brackets and quoted texts, wherever lines end; what follows two slashes is a comment.
pub(super) struct Words<'a> {
    rest: &'a str,
    /// Where the latest word stands, from 1 on.
    pub(super) line: usize,
}

impl<'a> Words<'a> {
    pub(super) fn new(text: &'a str) -> Self {
        Self { rest: text, line: 1 }
    }

    /// The next word; a quoted text without its quotes.
    pub(super) fn next(&mut self) -> Option<&'a str> {
        loop {
            let start = self.rest.find(|c: char| !c.is_whitespace()).unwrap_or(self.rest.len());
            self.skip(start);
            if !self.rest.starts_with("//") {
                break;
            }
            self.skip(self.rest.find('\n').unwrap_or(self.rest.len()));
        }
        let first = self.rest.chars().next()?;
        let (from, to, end) = match first {
            '"' => match self.rest[1..].find('"') {
                Some(length) => (1, 1 + length, 2 + length),
                None => (1, self.rest.len(), self.rest.len()),
            },
            '(' | ')' | '{' | '}' => (0, 1, 1),
            _ => {
                let stop = |c: char| c.is_whitespace() || matches!(c, '(' | ')' | '{' | '}' | '"');
                let end = self.rest.find(stop).unwrap_or(self.rest.len());
                (0, end, end)
            }
        };
        let word = &self.rest[from..to];
        self.skip(end);
        Some(word)
    }

    fn skip(&mut self, length: usize) {
        let (passed, rest) = self.rest.split_at(length);
        self.line += passed.bytes().filter(|byte| *byte == b'\n').count();
        self.rest = rest;
    }

    pub(super) fn error(&self, expected: impl Into<String>, found: Option<&str>) -> ImportError {
        at_line(self.line, expected, found.map_or_else(|| "the end of the file".to_owned(), shown))
    }

    /// Any word.
    pub(super) fn word(&mut self, what: &str) -> Result<&'a str, ImportError> {
        self.next().ok_or_else(|| self.error(what, None))
    }

    /// This word.
    pub(super) fn expect(&mut self, word: &str) -> Result<(), ImportError> {
        match self.next() {
            Some(found) if found == word => Ok(()),
            found => Err(self.error(word, found)),
        }
    }

    /// A whole number below a limit.
    pub(super) fn below(&mut self, what: &str, limit: usize) -> Result<usize, ImportError> {
        let found = self.next();
        let number = found.and_then(|word| word.parse().ok()).filter(|number| *number < limit);
        number.ok_or_else(|| self.error(format!("{what}, a whole number below {limit}"), found))
    }

    /// How many there are of something. Counts are not trusted: nothing is made ready for them.
    pub(super) fn count(&mut self, what: &str) -> Result<usize, ImportError> {
        self.below(what, u32::MAX as usize)
    }

    /// The word, and a whole number that is this one: entries are numbered.
    pub(super) fn entry(&mut self, word: &str, index: usize) -> Result<(), ImportError> {
        self.expect(word)?;
        let found = self.next();
        match found.and_then(|word| word.parse::<usize>().ok()) {
            Some(number) if index == number => Ok(()),
            _ => Err(self.error(format!("{word} {index}"), found)),
        }
    }

    pub(super) fn float(&mut self, what: &str) -> Result<f32, ImportError> {
        let found = self.next();
        float(self.line, what, found)
    }

    /// As many numbers in brackets. They are those of 32 bits, calculated with in 64.
    pub(super) fn tuple<const N: usize>(&mut self, what: &str) -> Result<[f64; N], ImportError> {
        self.expect("(")?;
        let mut values = [0.0; N];
        for value in &mut values {
            let found = self.next();
            *value = number(self.line, what, found)?;
            float(self.line, what, found)?;
        }
        self.expect(")")?;
        Ok(values)
    }

    pub(super) fn vector(&mut self, what: &str) -> Result<DVec3, ImportError> {
        self.tuple(what).map(DVec3::from)
    }

    pub(super) fn rotation(&mut self, what: &str) -> Result<DQuat, ImportError> {
        self.vector(what).map(rotation)
    }
}

/// The rotation whose x, y and z these are: of the two, w is the negative one.
pub(super) fn rotation(xyz: DVec3) -> DQuat {
    let w = -(1.0 - xyz.length_squared()).max(0.0).sqrt();
    let quaternion = DQuat::from_xyzw(xyz.x, xyz.y, xyz.z, w);
    let length = quaternion.length();
    // Of finite numbers of 32 bits, so that the length is finite, and at least 1.
    quaternion / length
}
