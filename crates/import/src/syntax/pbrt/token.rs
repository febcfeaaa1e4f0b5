//! Words, quoted texts and brackets.

/// A token of a scene file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Token<'a> {
    /// What stands without quotes: a directive, a number, true, false.
    Word(&'a str),
    /// What stands between quotes, as it is there.
    Text(&'a str),
    /// `[`
    Open,
    /// `]`
    Close,
}

/// The tokens of a text, one looked at before it is taken.
#[derive(Debug)]
pub(super) struct Tokens<'a> {
    rest: &'a str,
    line: usize,
    peeked: Option<(usize, Token<'a>)>,
}

/// A fault with its line.
pub(super) type Fault = (usize, String);

/// What ends a word.
fn ends_word(c: char) -> bool {
    c.is_ascii_whitespace() || matches!(c, '"' | '[' | ']' | '#')
}

impl<'a> Tokens<'a> {
    pub(super) fn new(text: &'a str) -> Self {
        Self { rest: text, line: 1, peeked: None }
    }

    /// The line that reading has come to.
    pub(super) fn line(&self) -> usize {
        self.line
    }

    /// The next token and its line, which stays the next; `None` at the end.
    pub(super) fn peek(&mut self) -> Result<Option<(usize, Token<'a>)>, Fault> {
        if self.peeked.is_none() {
            self.peeked = self.read()?;
        }
        Ok(self.peeked)
    }

    /// The next token and its line; `None` at the end.
    pub(super) fn take(&mut self) -> Result<Option<(usize, Token<'a>)>, Fault> {
        match self.peeked.take() {
            Some(token) => Ok(Some(token)),
            None => self.read(),
        }
    }

    fn read(&mut self) -> Result<Option<(usize, Token<'a>)>, Fault> {
        self.pass_blanks();
        let line = self.line;
        let Some(first) = self.rest.chars().next() else { return Ok(None) };
        let token = match first {
            '[' | ']' => {
                self.rest = &self.rest[1..];
                if first == '[' { Token::Open } else { Token::Close }
            }
            '"' => {
                let inside = &self.rest[1..];
                let end = inside.find(['"', '\n']).filter(|end| inside[*end..].starts_with('"'));
                let end = end.ok_or_else(|| (line, "a quoted text without its end on the same line".to_owned()))?;
                self.rest = &inside[end + 1..];
                Token::Text(&inside[..end])
            }
            _ => {
                let end = self.rest.find(ends_word).unwrap_or(self.rest.len());
                let (word, rest) = self.rest.split_at(end);
                self.rest = rest;
                Token::Word(word)
            }
        };
        Ok(Some((line, token)))
    }

    fn pass_blanks(&mut self) {
        loop {
            let blanks = self.rest.len() - self.rest.trim_ascii_start().len();
            self.line += self.rest[..blanks].bytes().filter(|b| *b == b'\n').count();
            self.rest = &self.rest[blanks..];
            if !self.rest.starts_with('#') {
                return;
            }
            self.rest = &self.rest[self.rest.find('\n').unwrap_or(self.rest.len())..];
        }
    }
}
