//! What one file says of others: the names that it defines and imports, the paths that it follows.

use std::collections::BTreeSet;

use super::tokens::{self, Token};

/// `use path as name`, or `use path::*` where the name is missing.
#[derive(Clone, Debug)]
pub(crate) struct Import {
    pub(crate) path: Vec<String>,
    pub(crate) name: Option<String>,
    /// `pub use`: handed on, and an arrow only where the file itself says the name.
    pub(crate) re_exported: bool,
}

/// One file.
#[derive(Debug, Default)]
pub(crate) struct Source {
    /// Modules that only tests compile.
    pub(crate) tests: Vec<String>,
    pub(crate) defines: BTreeSet<String>,
    pub(crate) imports: Vec<Import>,
    /// Paths of two words or more in its code.
    pub(crate) paths: BTreeSet<Vec<String>>,
    /// Every word of its code outside of `use`.
    pub(crate) words: BTreeSet<String>,
}

/// What may stand before the name that it defines.
const DEFINING: [&str; 9] = ["struct", "enum", "union", "trait", "type", "fn", "const", "static", "macro_rules"];

impl Source {
    pub(crate) fn read(text: &str) -> Self {
        let (tokens, tests) = tokens::read(text);
        let mut source = Self { tests, ..Self::default() };
        let (mut at, mut depth) = (0, 0_usize);
        while at < tokens.len() {
            let token = &tokens[at];
            match token {
                Token::Mark('{') => depth += 1,
                Token::Mark('}') => depth = depth.saturating_sub(1),
                _ => {}
            }
            at += if token.is("use") {
                source.take_use(&tokens[at + 1..], is_re_exported(&tokens[..at]))
            } else if token.is("mod") {
                2
            } else if let Some(word) = token.word() {
                source.define(word, &tokens[at + 1..], depth);
                source.take_path(&tokens[at..])
            } else {
                1
            };
        }
        source
    }

    /// Takes the imports after `use`; gives the tokens taken, that word included.
    fn take_use(&mut self, tokens: &[Token], re_exported: bool) -> usize {
        let end = tokens.iter().position(|t| t.is_mark(';')).unwrap_or(tokens.len());
        let mut imports = Vec::new();
        tree(&tokens[..end], &[], &mut imports);
        self.imports.extend(imports.into_iter().map(|(path, name)| Import { path, name, re_exported }));
        end + 2
    }

    /// Notes what a word defines: types at every depth, since macros may wrap them, other items outside of blocks.
    fn define(&mut self, word: &str, next: &[Token], depth: usize) {
        let is_type = ["struct", "enum", "union", "trait", "macro_rules"].contains(&word);
        if DEFINING.contains(&word) && (depth == 0 || is_type) {
            self.defines.extend(next.iter().find(|t| !t.is_mark('!')).and_then(Token::word).map(str::to_owned));
        }
    }

    /// Takes the path that begins here; gives the tokens taken.
    fn take_path(&mut self, tokens: &[Token]) -> usize {
        let mut path = Vec::new();
        let mut at = 0;
        while let Some(word) = tokens.get(at).and_then(Token::word) {
            path.push(word.to_owned());
            at += 1;
            if tokens.get(at) != Some(&Token::Of) || tokens.get(at + 1).and_then(Token::word).is_none() {
                break;
            }
            at += 1;
        }
        self.words.insert(path[0].clone());
        if path.len() > 1 {
            self.paths.insert(path);
        }
        at
    }
}

/// Whether `pub` or `pub(…)` stands before.
fn is_re_exported(before: &[Token]) -> bool {
    match before {
        [.., last] if last.is("pub") => true,
        [.., last] if last.is_mark(')') => {
            let open = before.iter().rposition(|t| t.is_mark('('));
            open.and_then(|open| before[..open].last()).is_some_and(|t| t.is("pub"))
        }
        _ => false,
    }
}

/// The leaves of a tree of imports: a path and the name that it binds.
fn tree(tokens: &[Token], before: &[String], imports: &mut Vec<(Vec<String>, Option<String>)>) {
    let mut path = before.to_vec();
    for (at, token) in tokens.iter().enumerate() {
        match token {
            Token::Word(word) if word == "as" => {
                imports.push((path, tokens[at + 1].word().map(str::to_owned)));
                return;
            }
            Token::Word(word) if word == "self" && !path.is_empty() => {}
            Token::Word(word) => path.push(word.clone()),
            Token::Mark('*') => {
                imports.push((path, None));
                return;
            }
            Token::Mark('{') => {
                let close = tokens.iter().rposition(|t| t.is_mark('}')).unwrap_or(tokens.len());
                branches(&tokens[at + 1..close]).for_each(|branch| tree(branch, &path, imports));
                return;
            }
            _ => {}
        }
    }
    let name = path.last().cloned();
    if !tokens.is_empty() {
        imports.push((path, name));
    }
}

/// What stands between the commas of a brace, inner braces kept whole.
fn branches(tokens: &[Token]) -> impl Iterator<Item = &[Token]> {
    let mut depth = 0;
    tokens.split(move |token| {
        match token {
            Token::Mark('{') => depth += 1,
            Token::Mark('}') => depth -= 1,
            _ => {}
        }
        depth == 0 && token.is_mark(',')
    })
}
