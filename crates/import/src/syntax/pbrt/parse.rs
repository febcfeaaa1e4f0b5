//! Parser of tokens into directives.

use std::cell::Cell;

use super::token::{PbrtDirective, PbrtParameter, PbrtValues, SyntaxError, Token, Tokens};

/// Arguments of a directive.
#[derive(Clone, Copy)]
enum ArgumentForm {
    Plain,
    Numbers(usize),
    Named,
    Typed,
    Texture,
    MediumInterface,
    Setting,
    Include,
    /// Word without quotes.
    Word,
}

const DIRECTIVES: &[(&str, ArgumentForm)] = &[
    ("Accelerator", ArgumentForm::Typed),
    ("ActiveTransform", ArgumentForm::Word),
    ("AreaLightSource", ArgumentForm::Typed),
    ("Attribute", ArgumentForm::Typed),
    ("AttributeBegin", ArgumentForm::Plain),
    ("AttributeEnd", ArgumentForm::Plain),
    ("Camera", ArgumentForm::Typed),
    ("ColorSpace", ArgumentForm::Named),
    ("ConcatTransform", ArgumentForm::Numbers(16)),
    ("CoordSysTransform", ArgumentForm::Named),
    ("CoordinateSystem", ArgumentForm::Named),
    ("Film", ArgumentForm::Typed),
    ("Identity", ArgumentForm::Plain),
    ("Import", ArgumentForm::Include),
    ("Include", ArgumentForm::Include),
    ("Integrator", ArgumentForm::Typed),
    ("LightSource", ArgumentForm::Typed),
    ("LookAt", ArgumentForm::Numbers(9)),
    ("MakeNamedMaterial", ArgumentForm::Typed),
    ("MakeNamedMedium", ArgumentForm::Typed),
    ("Material", ArgumentForm::Typed),
    ("MediumInterface", ArgumentForm::MediumInterface),
    ("NamedMaterial", ArgumentForm::Named),
    ("ObjectBegin", ArgumentForm::Named),
    ("ObjectEnd", ArgumentForm::Plain),
    ("ObjectInstance", ArgumentForm::Named),
    ("Option", ArgumentForm::Setting),
    ("PixelFilter", ArgumentForm::Typed),
    ("ReverseOrientation", ArgumentForm::Plain),
    ("Rotate", ArgumentForm::Numbers(4)),
    ("Sampler", ArgumentForm::Typed),
    ("Scale", ArgumentForm::Numbers(3)),
    ("Shape", ArgumentForm::Typed),
    ("Texture", ArgumentForm::Texture),
    ("Transform", ArgumentForm::Numbers(16)),
    ("TransformBegin", ArgumentForm::Plain),
    ("TransformEnd", ArgumentForm::Plain),
    ("TransformTimes", ArgumentForm::Numbers(2)),
    ("Translate", ArgumentForm::Numbers(3)),
    ("WorldBegin", ArgumentForm::Plain),
];

/// Word of a file, shortened for a message.
fn shortened(word: &str) -> String {
    const MAX: usize = 40;
    match word.char_indices().nth(MAX) {
        Some((end, _)) => format!("{} …", &word[..end]),
        None => word.to_owned(),
    }
}

pub(super) struct Parser<'a> {
    tokens: Tokens<'a>,
}

impl<'a> Parser<'a> {
    pub(super) fn new(text: &'a str) -> Self {
        Self { tokens: Tokens::new(text) }
    }

    /// The next directive and its line; `None` at the end.
    pub(super) fn next(&mut self) -> Result<Option<(usize, PbrtDirective)>, SyntaxError> {
        let Some((line, token)) = self.tokens.take()? else { return Ok(None) };
        let Token::Word(word) = token else {
            return Err((line, "expected a directive such as `Shape`, found a value".to_owned()));
        };
        let Some((name, form)) = DIRECTIVES.iter().find(|(name, _)| *name == word) else {
            return Err((line, format!("unknown directive `{}`: pbrt-v4 does not have it", shortened(word))));
        };
        self.arguments(name, *form, line).map(|directive| Some((line, directive)))
    }

    fn arguments(&mut self, name: &'static str, form: ArgumentForm, line: usize) -> Result<PbrtDirective, SyntaxError> {
        Ok(match form {
            ArgumentForm::Plain => PbrtDirective::Plain(name),
            ArgumentForm::Numbers(count) => PbrtDirective::Numbers(name, self.some_numbers(name, count, line)?),
            ArgumentForm::Named => PbrtDirective::Named(name, self.text(name)?.to_owned()),
            ArgumentForm::Typed => PbrtDirective::Typed(name, self.text(name)?.to_owned(), self.parameters()?),
            ArgumentForm::Texture => {
                let words = [self.text(name)?, self.text(name)?, self.text(name)?].map(str::to_owned);
                PbrtDirective::Texture(words, self.parameters()?)
            }
            ArgumentForm::MediumInterface => {
                let inside = self.text(name)?.to_owned();
                let has_outside = matches!(self.tokens.peek()?, Some((_, Token::Text(_))));
                let outside = if has_outside { self.text(name)?.to_owned() } else { inside.clone() };
                PbrtDirective::MediumInterface([inside, outside])
            }
            ArgumentForm::Setting => {
                let setting = self.parameter()?;
                PbrtDirective::Setting(setting.ok_or_else(|| (line, "`Option` has no parameter".to_owned()))?)
            }
            ArgumentForm::Include => PbrtDirective::Include(self.text(name)?.to_owned()),
            ArgumentForm::Word => match self.tokens.take()? {
                Some((_, Token::Word(word) | Token::Text(word))) => PbrtDirective::Named(name, word.to_owned()),
                _ => return Err((line, format!("`{name}` has no argument"))),
            },
        })
    }

    fn text(&mut self, subject: &str) -> Result<&'a str, SyntaxError> {
        match self.tokens.take()? {
            Some((_, Token::Text(text))) => Ok(text),
            Some((line, _)) => Err((line, format!("`{subject}` expects a quoted string here"))),
            None => Err((self.tokens.line(), format!("the file ends within `{subject}`: it may be truncated"))),
        }
    }

    /// Numbers of a transform, with or without brackets.
    fn some_numbers(&mut self, subject: &str, count: usize, line: usize) -> Result<Vec<f64>, SyntaxError> {
        let bracketed = matches!(self.tokens.peek()?, Some((_, Token::Open)));
        if bracketed {
            self.tokens.take()?;
        }
        let mut numbers = Vec::with_capacity(count);
        while let Some((line, Token::Word(word))) = self.tokens.peek()?
            && numbers.len() < count
        {
            numbers.push(number(word).map_err(|problem| (line, problem))?);
            self.tokens.take()?;
        }
        let closed = !bracketed || matches!(self.tokens.take()?, Some((_, Token::Close)));
        match numbers.len() == count && closed {
            true => Ok(numbers),
            false => Err((line, format!("`{subject}`: expected {count} numbers, found {}", numbers.len()))),
        }
    }

    fn parameters(&mut self) -> Result<Vec<PbrtParameter>, SyntaxError> {
        let mut parameters: Vec<PbrtParameter> = Vec::new();
        while let Some(parameter) = self.parameter()? {
            parameters.push(parameter);
        }
        Ok(parameters)
    }

    /// `"type name" value` or `"type name" [ values ]`; `None` if none follows.
    fn parameter(&mut self) -> Result<Option<PbrtParameter>, SyntaxError> {
        let Some((line, Token::Text(head))) = self.tokens.peek()? else { return Ok(None) };
        self.tokens.take()?;
        let mut words = head.split_ascii_whitespace();
        let (Some(kind), Some(name), None) = (words.next(), words.next(), words.next()) else {
            let message = format!("\"{}\": expected a parameter of the form \"type name\"", shortened(head));
            return Err((line, message));
        };
        let (kind, name) = (kind.to_owned(), name.to_owned());
        let values = self.values(&name, line)?;
        Ok(Some(PbrtParameter { kind, name, values, used: Cell::new(false) }))
    }

    fn values(&mut self, name: &str, line: usize) -> Result<PbrtValues, SyntaxError> {
        let truncated = || (line, format!("\"{}\" has no values: the file may be truncated", shortened(name)));
        let (first_line, first) = self.tokens.take()?.ok_or_else(truncated)?;
        if first != Token::Open {
            let mut values = CollectedValues::default();
            values.add(first).map_err(|problem| (first_line, problem))?;
            return Ok(values.finish());
        }
        let mut values = CollectedValues::default();
        loop {
            match self.tokens.take()?.ok_or_else(truncated)? {
                (_, Token::Close) => return Ok(values.finish()),
                (line, token) => values.add(token).map_err(|problem| (line, problem))?,
            }
        }
    }
}

fn number(word: &str) -> Result<f64, String> {
    match word.parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(value),
        Ok(_) => Err(format!("`{}` is not finite", shortened(word))),
        Err(_) => Err(format!("expected a number, found `{}`", shortened(word))),
    }
}

/// Values of one type.
#[derive(Default)]
struct CollectedValues {
    numbers: Vec<f64>,
    texts: Vec<String>,
    flags: Vec<bool>,
}

impl CollectedValues {
    fn add(&mut self, token: Token<'_>) -> Result<(), String> {
        match token {
            Token::Text("true") | Token::Word("true") => self.flags.push(true),
            Token::Text("false") | Token::Word("false") => self.flags.push(false),
            Token::Text(text) => self.texts.push(text.to_owned()),
            Token::Word(word) => self.numbers.push(number(word)?),
            Token::Open | Token::Close => return Err("expected a value, found a bracket".to_owned()),
        }
        let sorts = [!self.numbers.is_empty(), !self.texts.is_empty(), !self.flags.is_empty()];
        match sorts.iter().filter(|some| **some).count() {
            1 => Ok(()),
            _ => Err("numbers, strings and booleans are mixed in one list".to_owned()),
        }
    }

    fn finish(self) -> PbrtValues {
        match self {
            Self { texts, .. } if !texts.is_empty() => PbrtValues::Texts(texts),
            Self { flags, .. } if !flags.is_empty() => PbrtValues::Flags(flags),
            Self { numbers, .. } => PbrtValues::Numbers(numbers),
        }
    }
}
