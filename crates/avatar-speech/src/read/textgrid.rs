use crate::error::{Place, SpeechError, shown};
use crate::phone::Alphabet;
use crate::read::letters::add_phone;
use crate::timeline::{Builder, Timeline};
use std::borrow::Cow;

/// Names of tiers that hold phones; MAUS calls its own so, too.
const PHONE_TIERS: [&str; 8] =
    ["phones", "phone", "phonemes", "phoneme", "segments", "phon", "mau", "segment"];

/// What is left of a TextGrid without its words of explanation: Praat reads numbers that stand free, texts in
/// quotation marks, and flags in angle brackets, and skips everything else. So long and short files are read
/// alike.
#[derive(Clone, Debug, PartialEq)]
enum Token<'a> {
    Number(f64),
    Text(Cow<'a, str>),
    Flag(&'a str),
}

struct Tokens<'a> {
    text: &'a str,
    byte: usize,
    /// Of the token that was read last.
    start: usize,
}

impl<'a> Tokens<'a> {
    fn next(&mut self) -> Result<Option<Token<'a>>, SpeechError> {
        loop {
            let rest = &self.text[self.byte..];
            let trimmed = rest.trim_start();
            self.byte += rest.len() - trimmed.len();
            self.start = self.byte;
            let Some(first) = trimmed.chars().next() else { return Ok(None) };
            if first == '"' {
                return self.quoted(trimmed).map(Some);
            }
            if first == '!' {
                self.byte += trimmed.find('\n').unwrap_or(trimmed.len());
                continue;
            }
            let end = trimmed.find(char::is_whitespace).unwrap_or(trimmed.len());
            let word = &trimmed[..end];
            self.byte += end;
            if let Some(flag) = word.strip_prefix('<').and_then(|word| word.strip_suffix('>')) {
                return Ok(Some(Token::Flag(flag)));
            }
            if let Ok(number) = word.parse::<f64>()
                && word.starts_with(|c: char| c.is_ascii_digit() || c == '-' || c == '+' || c == '.')
            {
                return Ok(Some(Token::Number(number)));
            }
        }
    }

    /// A text in quotation marks; two of them inside are one.
    fn quoted(&mut self, trimmed: &'a str) -> Result<Token<'a>, SpeechError> {
        let mut at = 1;
        let mut is_doubled = false;
        loop {
            let Some(found) = trimmed[at..].find('"') else {
                return Err(self.place().error("a quotation mark at the end of the text", "none"));
            };
            at += found + 1;
            if !trimmed[at..].starts_with('"') {
                break;
            }
            is_doubled = true;
            at += 1;
        }
        self.byte += at;
        let inner = &trimmed[1..at - 1];
        Ok(Token::Text(if is_doubled { inner.replace("\"\"", "\"").into() } else { inner.into() }))
    }

    fn place(&self) -> Place {
        Place::of_byte(self.text, self.start)
    }

    fn wrong(&self, expected: &str, found: Option<Token<'_>>) -> SpeechError {
        let found = match found {
            None => "the end".to_owned(),
            Some(Token::Number(number)) => number.to_string(),
            Some(Token::Text(text)) => shown(&text),
            Some(Token::Flag(flag)) => format!("<{flag}>"),
        };
        self.place().error(expected, found)
    }

    fn number(&mut self, what: &str) -> Result<f64, SpeechError> {
        match self.next()? {
            Some(Token::Number(number)) if number.is_finite() => Ok(number),
            found => Err(self.wrong(what, found)),
        }
    }

    fn text(&mut self, what: &str) -> Result<Cow<'a, str>, SpeechError> {
        match self.next()? {
            Some(Token::Text(text)) => Ok(text),
            found => Err(self.wrong(what, found)),
        }
    }

    /// How many entries follow. Nothing is reserved for them: the number may be a lie.
    fn count(&mut self, what: &str) -> Result<u64, SpeechError> {
        let number = self.number(what)?;
        match number >= 0.0 && number.fract() == 0.0 && number < 1e15 {
            true => Ok(number as u64),
            false => Err(self.wrong(what, Some(Token::Number(number)))),
        }
    }
}

struct Interval<'a> {
    byte: usize,
    start_secs: f64,
    end_secs: f64,
    label: Cow<'a, str>,
}

struct Tier<'a> {
    name: Cow<'a, str>,
    intervals: Vec<Interval<'a>>,
}

impl Tier<'_> {
    fn labels(&self) -> impl Iterator<Item = &str> + Clone {
        self.intervals.iter().map(|interval| &*interval.label)
    }

    /// Whether every label but one in ten is a phone.
    fn is_phones(&self) -> bool {
        let spoken = self.labels().filter(|label| !label.trim().is_empty()).count();
        spoken > 0 && Alphabet::of(self.labels()).1 * 10 <= spoken
    }
}

/// Reads the tier of phones: the one that is called so, or the first whose labels are phones.
pub(super) fn read(text: &str) -> Result<Timeline, SpeechError> {
    let mut tokens = Tokens { text, byte: 0, start: 0 };
    let tiers = tiers(&mut tokens)?;
    let is_named = |tier: &&Tier<'_>| {
        let name = tier.name.trim().to_lowercase();
        let last = name.rsplit([' ', '-', '_', '/']).next().unwrap_or_default();
        PHONE_TIERS.contains(&last)
    };
    let tier = tiers.iter().filter(|tier| !tier.intervals.is_empty()).find(is_named);
    let tier = tier.or_else(|| tiers.iter().find(|tier| tier.is_phones()));
    let tier = tier.ok_or_else(|| {
        let names: Vec<&str> = tiers.iter().take(8).map(|tier| &*tier.name).collect();
        let found = if names.is_empty() { "none".to_owned() } else { format!("{names:?}") };
        Place::of_line(1).error("a tier of intervals with phones", found)
    })?;
    let (alphabet, _) = Alphabet::of(tier.labels());
    let mut builder = Builder::default();
    // Places are counted on from one interval to the next, not from the beginning each time.
    let (mut line, mut counted) = (1, 0);
    for Interval { byte, start_secs, end_secs, label } in &tier.intervals {
        line += text.get(counted..*byte).map_or(0, |between| between.matches('\n').count());
        counted = *byte;
        add_phone(&mut builder, Place::of_line(line), [*start_secs, *end_secs], label, alphabet)?;
    }
    Ok(builder.finish())
}

fn tiers<'a>(tokens: &mut Tokens<'a>) -> Result<Vec<Tier<'a>>, SpeechError> {
    for expected in ["ooTextFile", "TextGrid"] {
        let found = tokens.text("the head of a TextGrid")?;
        if !found.starts_with(expected) {
            return Err(tokens.wrong(&format!("{expected:?}"), Some(Token::Text(found))));
        }
    }
    tokens.number("the start of the TextGrid")?;
    tokens.number("the end of the TextGrid")?;
    match tokens.next()? {
        Some(Token::Flag("exists")) => {}
        Some(Token::Flag("absent")) => return Ok(Vec::new()),
        found => return Err(tokens.wrong("<exists>", found)),
    }
    let mut tiers = Vec::new();
    for _ in 0..tokens.count("the number of tiers")? {
        let class = tokens.text("\"IntervalTier\" or \"TextTier\"")?;
        let name = tokens.text("the name of a tier")?;
        tokens.number("the start of a tier")?;
        tokens.number("the end of a tier")?;
        let count = tokens.count("the number of entries")?;
        let mut intervals = Vec::new();
        match &*class {
            "IntervalTier" => {
                for _ in 0..count {
                    let start_secs = tokens.number("the start of an interval")?;
                    let byte = tokens.start;
                    let end_secs = tokens.number("the end of an interval")?;
                    let label = tokens.text("the text of an interval")?;
                    intervals.push(Interval { byte, start_secs, end_secs, label });
                }
            }
            "TextTier" => {
                for _ in 0..count {
                    tokens.number("the time of a point")?;
                    tokens.text("the mark of a point")?;
                }
            }
            _ => return Err(tokens.wrong("\"IntervalTier\" or \"TextTier\"", Some(Token::Text(class)))),
        }
        tiers.push(Tier { name, intervals });
    }
    Ok(tiers)
}
