//! Rust text as the tokens of which paths are made: no comments, strings, characters or lifetimes, nothing that only tests compile.

/// A word of the program, the `::` of a path, or another mark.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Token {
    Word(String),
    Of,
    Mark(char),
}

impl Token {
    /// Its text, if it is a word.
    pub(crate) fn word(&self) -> Option<&str> {
        match self {
            Self::Word(word) => Some(word),
            _ => None,
        }
    }

    pub(crate) fn is(&self, word: &str) -> bool {
        self.word() == Some(word)
    }

    pub(crate) fn is_mark(&self, mark: char) -> bool {
        *self == Self::Mark(mark)
    }
}

/// The tokens of a file, with the names of the modules that stand under `#[cfg(test)]`.
pub(crate) fn read(text: &str) -> (Vec<Token>, Vec<String>) {
    without_tests(&tokens(text))
}

fn is_part(c: char) -> bool {
    c.is_alphanumeric() || c == '_'
}

fn tokens(text: &str) -> Vec<Token> {
    let text: Vec<char> = text.chars().collect();
    let mut tokens = Vec::new();
    let mut at = 0;
    while at < text.len() {
        let rest = &text[at..];
        let length = comment(rest).or_else(|| string(rest)).or_else(|| quote(rest));
        at += match (length, rest) {
            (Some(length), _) => length,
            (None, [':', ':', ..]) => {
                tokens.push(Token::Of);
                2
            }
            (None, [c, ..]) if is_part(*c) => {
                let length = rest.iter().take_while(|c| is_part(**c)).count();
                tokens.push(Token::Word(rest[..length].iter().collect()));
                length
            }
            (None, rest) => {
                tokens.extend(rest.first().filter(|c| !c.is_whitespace()).map(|c| Token::Mark(*c)));
                1
            }
        };
    }
    tokens
}

/// Length of the comment that begins here.
fn comment(text: &[char]) -> Option<usize> {
    match text {
        ['/', '/', ..] => Some(text.iter().position(|c| *c == '\n').unwrap_or(text.len())),
        ['/', '*', ..] => {
            let (mut at, mut depth) = (2, 1);
            while depth > 0 && at < text.len() {
                match text[at..] {
                    ['/', '*', ..] => (at, depth) = (at + 2, depth + 1),
                    ['*', '/', ..] => (at, depth) = (at + 2, depth - 1),
                    _ => at += 1,
                }
            }
            Some(at)
        }
        _ => None,
    }
}

/// Length of the literal string that begins here, raw or not.
fn string(text: &[char]) -> Option<usize> {
    let prefix = text.iter().take_while(|c| ['b', 'c', 'r'].contains(c)).count();
    let raw = text[..prefix].contains(&'r');
    let hashes = text[prefix..].iter().take_while(|c| raw && **c == '#').count();
    let open = prefix + hashes;
    if prefix > 2 || text.get(open) != Some(&'"') {
        return None;
    }
    let mut at = open + 1;
    while at < text.len() {
        let closes = text[at] == '"' && text[at + 1..].iter().take_while(|c| **c == '#').take(hashes).count() == hashes;
        if closes {
            return Some(at + 1 + hashes);
        }
        at += if !raw && text[at] == '\\' { 2 } else { 1 };
    }
    Some(text.len())
}

/// Length of the literal character or the lifetime that begins here.
fn quote(text: &[char]) -> Option<usize> {
    match text {
        ['\'', '\\', _, rest @ ..] => Some(4 + rest.iter().take_while(|c| **c != '\'').count()),
        ['\'', _, '\'', ..] => Some(3),
        ['\'', rest @ ..] => Some(1 + rest.iter().take_while(|c| is_part(**c)).count()),
        _ => None,
    }
}

fn without_tests(tokens: &[Token]) -> (Vec<Token>, Vec<String>) {
    let (mut remaining, mut tests) = (Vec::new(), Vec::new());
    let mut at = 0;
    while at < tokens.len() {
        let Some(attribute) = test_attribute(&tokens[at..]) else {
            remaining.push(tokens[at].clone());
            at += 1;
            continue;
        };
        let item = &tokens[at + attribute..];
        let length = item_length(item);
        if let Some(at) = item[..length].iter().position(|t| t.is("mod")) {
            tests.extend(item[at + 1].word().map(str::to_owned));
        }
        at += attribute + length;
    }
    (remaining, tests)
}

/// Length of `#[cfg(test)]` or `#[cfg(all(test, …))]` if it begins here.
fn test_attribute(tokens: &[Token]) -> Option<usize> {
    let [hash, open, cfg, ..] = tokens else { return None };
    if !(hash.is_mark('#') && open.is_mark('[') && cfg.is("cfg")) {
        return None;
    }
    let close = tokens.iter().position(|t| t.is_mark(']'))?;
    let inside = &tokens[..close];
    (inside.iter().any(|t| t.is("test")) && !inside.iter().any(|t| t.is("not"))).then_some(close + 1)
}

/// Length of an item: to its semicolon, or to the brace that closes it.
fn item_length(tokens: &[Token]) -> usize {
    let mut depth = 0;
    for (at, token) in tokens.iter().enumerate() {
        match token {
            Token::Mark('{' | '(' | '[') => depth += 1,
            Token::Mark('}' | ')' | ']') => depth -= 1,
            _ => {}
        }
        if depth == 0 && (token.is_mark(';') || token.is_mark('}')) {
            return at + 1;
        }
    }
    tokens.len()
}
