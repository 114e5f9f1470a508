//! Splits Rust source into words and signs, and finds its comments. Strings are skipped, so that neither a
//! path nor `//` inside of one counts.

/// A word, number or sign of the source.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Token {
    /// Its text; `::` is one token, every other sign stands alone. A string or character has the text `""`.
    pub text: String,
    /// Its line, from 1.
    pub line: usize,
}

impl Token {
    /// Whether it is a name or a keyword.
    pub fn is_word(&self) -> bool {
        self.text.starts_with(|c: char| c.is_alphabetic() || c == '_')
    }
}

/// The part of a comment that stands on one line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CommentLine {
    /// The line, from 1.
    pub line: usize,
    /// The column of the comment's last character, from 1.
    pub last_column: usize,
}

/// Reads Rust source (or WGSL, which has the same comments). Never fails: what does not end ends with the
/// text.
pub fn read(source: &str) -> (Vec<Token>, Vec<CommentLine>) {
    let mut reader =
        Reader { chars: source.chars().collect(), at: 0, line: 1, tokens: Vec::new(), comments: Vec::new() };
    reader.run();
    (reader.tokens, reader.comments)
}

struct Reader {
    chars: Vec<char>,
    at: usize,
    line: usize,
    tokens: Vec<Token>,
    comments: Vec<CommentLine>,
}

impl Reader {
    fn peek(&self, ahead: usize) -> char {
        self.chars.get(self.at + ahead).copied().unwrap_or('\0')
    }

    fn step(&mut self) {
        if self.peek(0) == '\n' {
            self.line += 1;
        }
        self.at += 1;
    }

    fn push(&mut self, text: impl Into<String>, line: usize) {
        self.tokens.push(Token { text: text.into(), line });
    }

    fn run(&mut self) {
        while self.at < self.chars.len() {
            let (c, next, line) = (self.peek(0), self.peek(1), self.line);
            if c.is_whitespace() {
                self.step();
            } else if c == '/' && next == '/' {
                self.line_comment();
            } else if c == '/' && next == '*' {
                self.block_comment();
            } else if let Some(hashes) = self.raw_string() {
                self.skip_raw_string(hashes);
                self.push("\"\"", line);
            } else if c == '"' || (matches!(c, 'b' | 'c') && next == '"') {
                self.at += usize::from(c != '"');
                self.skip_quoted('"');
                self.push("\"\"", line);
            } else if c == '\'' || (c == 'b' && next == '\'') {
                self.at += usize::from(c == 'b');
                // A lifetime has no closing quote: 'a is one, 'a' and '\n' are characters.
                if self.peek(1) == '\\' || self.peek(2) == '\'' {
                    self.skip_quoted('\'');
                    self.push("\"\"", line);
                } else {
                    self.step();
                    let name = self.word();
                    self.push(format!("'{name}"), line);
                }
            } else if c.is_alphanumeric() || c == '_' {
                // A raw name is the name.
                self.at += if c == 'r' && next == '#' { 2 } else { 0 };
                let word = self.word();
                self.push(word, line);
            } else if c == ':' && next == ':' {
                self.at += 2;
                self.push("::", line);
            } else {
                self.step();
                self.push(c, line);
            }
        }
    }

    fn word(&mut self) -> String {
        let start = self.at;
        while self.peek(0).is_alphanumeric() || self.peek(0) == '_' {
            self.at += 1;
        }
        self.chars[start..self.at].iter().collect()
    }

    /// The column of a character, from 1.
    fn column(&self, at: usize) -> usize {
        at - self.chars[..at].iter().rposition(|&c| c == '\n').map_or(0, |end| end + 1) + 1
    }

    fn line_comment(&mut self) {
        while self.at < self.chars.len() && self.peek(0) != '\n' {
            self.at += 1;
        }
        self.comments.push(CommentLine { line: self.line, last_column: self.column(self.at - 1) });
    }

    fn block_comment(&mut self) {
        let mut depth = 0;
        while self.at < self.chars.len() {
            match (self.peek(0), self.peek(1)) {
                ('/', '*') => (depth, self.at) = (depth + 1, self.at + 2),
                ('*', '/') => (depth, self.at) = (depth - 1, self.at + 2),
                ('\n', _) => {
                    self.comments
                        .push(CommentLine { line: self.line, last_column: self.column(self.at) - 1 });
                    self.step();
                }
                _ => self.at += 1,
            }
            if depth == 0 {
                break;
            }
        }
        if depth == 0 {
            self.comments.push(CommentLine { line: self.line, last_column: self.column(self.at - 1) });
        }
    }

    /// The number of `#` where a raw string begins here: `r"`, `r#"`, `br##"`.
    fn raw_string(&self) -> Option<usize> {
        let prefix = match (self.peek(0), self.peek(1)) {
            ('r', _) => 1,
            ('b' | 'c', 'r') => 2,
            _ => return None,
        };
        let hashes = (0..).take_while(|&n| self.peek(prefix + n) == '#').count();
        (self.peek(prefix + hashes) == '"').then_some(hashes)
    }

    fn skip_raw_string(&mut self, hashes: usize) {
        while self.peek(0) != '"' {
            self.at += 1;
        }
        self.at += 1;
        while self.at < self.chars.len() {
            let ends = self.peek(0) == '"' && (1..=hashes).all(|n| self.peek(n) == '#');
            self.step();
            if ends {
                self.at += hashes;
                return;
            }
        }
    }

    fn skip_quoted(&mut self, quote: char) {
        self.at += 1;
        while self.at < self.chars.len() && self.peek(0) != quote {
            if self.peek(0) == '\\' {
                self.step();
            }
            self.step();
        }
        self.at += 1;
    }
}

#[cfg(test)]
mod tests {
    use super::read;

    fn words(source: &str) -> Vec<String> {
        read(source).0.into_iter().map(|token| token.text).collect()
    }

    #[test]
    fn strings_and_comments_hide_what_is_in_them() {
        let source = r##"a::b /* c /* d */ e */ "f \" // g" r#"h " i"# 'j' '\'' 'life b"k" // l"##;
        assert_eq!(words(source), ["a", "::", "b", "\"\"", "\"\"", "\"\"", "\"\"", "'life", "\"\""]);
    }

    #[test]
    fn lines_are_counted_through_strings_and_comments() {
        let (tokens, comments) = read("\"one\ntwo\" a // three\n/* four\n five */ b");
        assert_eq!(tokens.iter().map(|token| token.line).collect::<Vec<_>>(), [1, 2, 4]);
        let ends: Vec<_> = comments.iter().map(|comment| (comment.line, comment.last_column)).collect();
        assert_eq!(ends, [(2, 15), (3, 7), (4, 8)]);
    }
}
