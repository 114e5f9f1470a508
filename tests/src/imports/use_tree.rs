//! The tree behind `use`: `use crate::{a::{b, c as d}, e::*};`

use crate::tokens::Token;

/// One name that a `use` brings, or everything of a module.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Use {
    /// The whole path, for example `crate`, `a`, `b`.
    pub path: Vec<String>,
    /// The name that it gets, or `None` for `*`.
    pub name: Option<String>,
    /// The line of its last word.
    pub line: usize,
}

/// Reads the tokens between `use` and `;`. Paths that begin with `::` lead to other crates and are left out.
pub(super) fn read(tokens: &[Token]) -> Vec<Use> {
    let mut uses = Vec::new();
    let mut at = 0;
    if tokens.first().is_some_and(|token| token.text != "::") {
        tree(tokens, &mut at, &[], &mut uses);
    }
    uses
}

fn tree(tokens: &[Token], at: &mut usize, prefix: &[String], uses: &mut Vec<Use>) {
    let mut path = prefix.to_vec();
    let mut line = 0;
    while let Some(token) = tokens.get(*at) {
        line = token.line;
        match token.text.as_str() {
            "::" => *at += 1,
            "*" => {
                *at += 1;
                uses.push(Use { path, name: None, line });
                return;
            }
            "{" => {
                *at += 1;
                while tokens.get(*at).is_some_and(|token| token.text != "}") {
                    if tokens[*at].text == "," {
                        *at += 1;
                    } else {
                        tree(tokens, at, &path, uses);
                    }
                }
                *at += 1;
                return;
            }
            "as" => {
                let name = tokens.get(*at + 1).map(|token| token.text.clone());
                *at += 2;
                uses.push(Use { path, name, line });
                return;
            }
            _ if token.is_word() => {
                *at += 1;
                // `a::{self, b}`: the module itself.
                if token.text != "self" || path.is_empty() {
                    path.push(token.text.clone());
                }
            }
            "," | "}" => break,
            // Nothing else stands in a use; a macro's variable, for example, ends what can be followed.
            _ => {
                *at += 1;
                return;
            }
        }
    }
    let name = path.last().cloned();
    uses.push(Use { path, name, line });
}
