//! What stays the same from one text of a sender to the next.

use crate::number::Number;

/// Longer texts, and texts with more numbers, are not remembered.
const LENGTH: usize = 64 * 1024;
const NUMBERS: usize = 4096;
/// Senders that change more than numbers are looked at anew ever less often, but at least once in so many
/// texts.
const RARELY: u32 = 256;

/// The last text of a sender, and what its numbers mean. A tracker says the same words frame after frame,
/// with other numbers between them: comparing the words takes a tenth of the time that understanding them
/// takes.
///
/// A text that has the same words is read as it would be without a template, to the bit; any other one is
/// refused.
#[derive(Clone, Debug)]
pub(crate) struct Template<M> {
    /// All of the text.
    text: Vec<u8>,
    numbers: Vec<Place<M>>,
    /// Texts in a row that had other words.
    misses: u32,
    /// Whether numbers without a meaning have been seen to change. Until then they are compared as words are:
    /// most of them, such as indices, stay the same.
    changes_all: bool,
}

#[derive(Clone, Copy, Debug)]
struct Place<M> {
    start: usize,
    end: usize,
    meaning: Option<M>,
}

impl<M> Default for Template<M> {
    fn default() -> Self {
        Self { text: Vec::new(), numbers: Vec::new(), misses: 0, changes_all: false }
    }
}

impl<M: Copy> Template<M> {
    /// Shows the numbers of a text that have a meaning, one after the other. Returns false if its words are
    /// others, or if `show` refuses a number; what has been shown is worth nothing then.
    pub(crate) fn read(&mut self, text: &[u8], show: &mut dyn FnMut(M, &Number<'_>) -> Option<()>) -> bool {
        let is_read = self.compare(text, show).is_some();
        self.misses = if is_read { 0 } else { self.misses.saturating_add(1) };
        is_read
    }

    fn compare(&mut self, text: &[u8], show: &mut dyn FnMut(M, &Number<'_>) -> Option<()>) -> Option<()> {
        if self.text.is_empty() {
            return None;
        }
        let (mut rest, mut before) = (text, 0);
        for place in &self.numbers {
            let words = self.text.get(before..place.start)?;
            let Some(further) = rest.strip_prefix(words) else {
                self.changes_all |= differs_in_a_number(words, rest);
                return None;
            };
            rest = further;
            let number = Number::at_start_of(rest)?;
            if let Some(meaning) = place.meaning {
                show(meaning, &number)?;
            }
            rest = rest.get(number.len()..)?;
            before = place.end;
        }
        let words = self.text.get(before..)?;
        self.changes_all |= differs_in_a_number(words, rest);
        (rest == words).then_some(())
    }

    /// Remembers a text of JSON that [`Self::read`] has refused and that is well-formed otherwise. `meanings`
    /// are those of its numbers: how many numbers of the text stand before each, and what it means, in the
    /// order of the text.
    pub(crate) fn learn(&mut self, text: &[u8], meanings: &[(usize, M)]) {
        self.text.clear();
        self.numbers.clear();
        let mut meanings = meanings.iter().peekable();
        let (mut at, mut count) = (0, 0);
        while let Some(byte) = text.get(at) {
            match byte {
                b'"' => at = end_of_text(text, at),
                b'-' | b'0'..=b'9' => {
                    let Some(number) = text.get(at..).and_then(Number::at_start_of) else { return };
                    let end = at + number.len();
                    let meaning =
                        meanings.next_if(|(before, _)| *before == count).map(|(_, meaning)| *meaning);
                    if meaning.is_some() || self.changes_all {
                        if self.numbers.len() >= NUMBERS {
                            return;
                        }
                        self.numbers.push(Place { start: at, end, meaning });
                    }
                    count += 1;
                    at = end;
                }
                _ => at += 1,
            }
        }
        if meanings.next().is_none() {
            self.text.extend(text);
        }
    }

    /// Whether a text that has been refused is worth being remembered.
    pub(crate) fn is_to_learn(&self, text: &[u8]) -> bool {
        text.len() <= LENGTH && (self.misses.is_power_of_two() || self.misses.is_multiple_of(RARELY))
    }
}

/// Whether texts are the same up to a number.
fn differs_in_a_number(a: &[u8], b: &[u8]) -> bool {
    let is_of_number = |byte: &u8| matches!(byte, b'0'..=b'9' | b'-' | b'.');
    let different = a.iter().zip(b).find(|(a, b)| a != b);
    different.is_some_and(|(a, b)| is_of_number(a) || is_of_number(b))
}

/// Behind the text in quotation marks that begins here.
fn end_of_text(text: &[u8], start: usize) -> usize {
    let mut at = start + 1;
    while let Some(byte) = text.get(at) {
        match byte {
            b'"' => return at + 1,
            b'\\' => at += 2,
            _ => at += 1,
        }
    }
    at
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The numbers of a text that mean something, if its words are those of the text before.
    fn read(template: &mut Template<char>, text: &str) -> Option<String> {
        let mut said = String::new();
        let is_read = template.read(text.as_bytes(), &mut |meaning, number| {
            said += &format!("{meaning}{} ", number.to_f64()?);
            Some(())
        });
        is_read.then_some(said)
    }

    #[test]
    fn numbers_change_and_words_do_not() {
        let mut template = Template::default();
        let first = r#"{"n\"1":1,"a":[2,3.5],"b":-4}"#;
        assert_eq!(read(&mut template, first), None);
        assert!(template.is_to_learn(first.as_bytes()));
        template.learn(first.as_bytes(), &[(1, 'p'), (3, 'q')]);
        assert_eq!(read(&mut template, first).as_deref(), Some("p2 q-4 "));
        let other = r#"{"n\"1":1,"a":[25e-1,3.5],"b":7}"#;
        assert_eq!(read(&mut template, other).as_deref(), Some("p2.5 q7 "));
        // Numbers without a meaning stand for words until one of them changes.
        let counted = r#"{"n\"1":10,"a":[2,3.5],"b":-4}"#;
        assert_eq!(read(&mut template, counted), None);
        template.learn(counted.as_bytes(), &[(1, 'p'), (3, 'q')]);
        let counted = r#"{"n\"1":11,"a":[2,-3],"b":4}"#;
        assert_eq!(read(&mut template, counted).as_deref(), Some("p2 q4 "));
        for different in [
            r#"{"n\"2":11,"a":[2,-3],"b":4}"#,
            r#"{"n\"1":11,"a":[2,-3],"b":4} "#,
            r#"{"n\"1":11,"a":[2,-3],"b":4"#,
            r#"{"n\"1":11,"a":[2,-3],"b":null}"#,
            r#"{"n\"1":11,"a":[02,-3],"b":4}"#,
            r#"{"n\"1":11,"a":[2, -3],"b":4}"#,
            "",
        ] {
            assert_eq!(read(&mut template, different), None, "{different}");
        }
    }

    #[test]
    fn what_never_stays_the_same_is_learned_ever_less_often() {
        let mut template = Template::<char>::default();
        let mut learned = 0;
        for index in 0..10_000 {
            let text = format!(r#"{{"{index}":1}}"#);
            assert_eq!(read(&mut template, &text), None);
            if template.is_to_learn(text.as_bytes()) {
                template.learn(text.as_bytes(), &[]);
                learned += 1;
            }
        }
        assert!((40..60).contains(&learned), "{learned}");
        let long = "1,".repeat(NUMBERS);
        template.learn(long.as_bytes(), &[]);
        template.changes_all = true;
        template.learn(format!("[{long}1]").as_bytes(), &[]);
        assert!(template.text.is_empty() && template.numbers.len() <= NUMBERS);
        assert!(!template.is_to_learn(&[b' '; LENGTH + 1]));
    }
}
