//! Reads one file: its modules, the names that they define, what they use and the paths that they spell out.

use super::use_tree::{self, Use};
use crate::tokens::{self, Token};

/// A path in the source, `a::b::C`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Path {
    pub segments: Vec<String>,
    pub line: usize,
}

/// A module as its text shows it: a file's, or one in braces within a file.
#[derive(Debug, Default)]
pub(super) struct Scanned {
    /// Types, functions, constants and macros that it defines.
    pub items: Vec<String>,
    pub uses: Vec<Use>,
    pub paths: Vec<Path>,
    /// All words, for what comes in by `use a::*`.
    pub words: Vec<(String, usize)>,
    /// Submodules in files of their own.
    pub files: Vec<(String, usize)>,
    /// Submodules in braces.
    pub inner: Vec<(String, Scanned)>,
}

const DEFINES: [&str; 9] =
    ["fn", "struct", "enum", "trait", "type", "const", "static", "union", "macro_rules"];
const STARTS_ITEM: [&str; 8] = ["pub", "impl", "mod", "use", "extern", "unsafe", "async", "fn"];

/// Reads the source of a file, without what is compiled for tests only.
pub(super) fn scan(source: &str) -> Scanned {
    let (tokens, _) = tokens::read(source);
    let mut at = 0;
    module(&tokens, &mut at)
}

/// Reads until the closing brace of the module, or to the end.
fn module(tokens: &[Token], at: &mut usize) -> Scanned {
    let mut scanned = Scanned::default();
    let mut depth = 0usize;
    let text = |n: usize| tokens.get(n).map_or("", |token| token.text.as_str());
    while *at < tokens.len() {
        let token = &tokens[*at];
        match text(*at) {
            "{" => depth += 1,
            "}" if depth == 0 => {
                *at += 1;
                break;
            }
            "}" => depth -= 1,
            "#" if text(*at + 1) == "[" => {
                let end = balanced(tokens, *at + 1);
                let is_test = for_tests_only(&tokens[*at + 2..end - 1]);
                *at = if is_test { end_of_item(tokens, end) } else { end };
                continue;
            }
            "mod" if tokens.get(*at + 1).is_some_and(Token::is_word) => {
                let name = text(*at + 1).to_owned();
                let sign = text(*at + 2).to_owned();
                *at += 3;
                match sign.as_str() {
                    ";" => scanned.files.push((name, token.line)),
                    "{" => scanned.inner.push((name, module(tokens, at))),
                    _ => {}
                }
                continue;
            }
            // Not the `use<…>` of a return type.
            "use" if text(*at + 1) != "<" => {
                let end = (*at..tokens.len()).find(|&n| text(n) == ";").unwrap_or(tokens.len());
                scanned.uses.extend(use_tree::read(&tokens[*at + 1..end]));
                *at = end;
                continue;
            }
            word if depth == 0 && DEFINES.contains(&word) => {
                let name = if text(*at + 1) == "!" { *at + 2 } else { *at + 1 };
                if tokens.get(name).is_some_and(Token::is_word) {
                    scanned.items.push(text(name).to_owned());
                }
            }
            _ => {}
        }
        let follows = *at > 0 && text(*at - 1) == "::";
        if token.is_word() && !follows {
            scanned.words.push((token.text.clone(), token.line));
            let is_visibility = *at > 0 && text(*at - 1) == "in" && text(at.saturating_sub(3)) == "pub";
            if text(*at + 1) == "::" && !is_visibility {
                let mut segments = vec![token.text.clone()];
                let mut next = *at + 1;
                while text(next) == "::" && tokens.get(next + 1).is_some_and(Token::is_word) {
                    segments.push(text(next + 1).to_owned());
                    next += 2;
                }
                scanned.paths.push(Path { segments, line: token.line });
            }
        }
        *at += 1;
    }
    scanned
}

/// The place behind the bracket that closes the one at `at`.
fn balanced(tokens: &[Token], at: usize) -> usize {
    let mut depth = 0usize;
    for (n, token) in tokens.iter().enumerate().skip(at) {
        match token.text.as_str() {
            "(" | "[" | "{" => depth += 1,
            ")" | "]" | "}" => depth = depth.saturating_sub(1),
            _ => {}
        }
        if depth == 0 {
            return n + 1;
        }
    }
    tokens.len()
}

/// Whether an attribute is `cfg(test)` or `cfg(all(test, …))`.
fn for_tests_only(attribute: &[Token]) -> bool {
    let has = |word: &str| attribute.iter().any(|token| token.text == word);
    attribute.first().is_some_and(|token| token.text == "cfg") && has("test") && !has("not") && !has("any")
}

/// The place behind the item, field or statement at `at`, whose attributes come first.
fn end_of_item(tokens: &[Token], mut at: usize) -> usize {
    let text = |n: usize| tokens.get(n).map_or("", |token| token.text.as_str());
    while text(at) == "#" && text(at + 1) == "[" {
        at = balanced(tokens, at + 1);
    }
    let is_item = STARTS_ITEM.contains(&text(at)) || DEFINES.contains(&text(at));
    let is_use = (at..at + 6).take_while(|&n| text(n) != ";").any(|n| text(n) == "use");
    while at < tokens.len() {
        match text(at) {
            ";" => return at + 1,
            "," if !is_item => return at + 1,
            "}" | ")" | "]" => return at,
            "{" if !is_use => return balanced(tokens, at),
            "{" | "(" | "[" => at = balanced(tokens, at),
            _ => at += 1,
        }
    }
    at
}
