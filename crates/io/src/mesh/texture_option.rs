//! Texture statements of MTL: options before a file name that may hold blanks.
//!
//! `-s u v w` and `-o u v w` take one to three numbers; the other options take a fixed number of words.

use super::statement::number;

/// Texture coordinates become `uv · scale + offset` (MTL `-s`, `-o`).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct UvLayout {
    pub(super) scale: [f64; 2],
    pub(super) offset: [f64; 2],
}

impl UvLayout {
    /// Identity.
    pub(super) const PLAIN: Self = Self { scale: [1.0; 2], offset: [0.0; 2] };

    /// Coordinates at which the image is read.
    pub(super) fn apply(&self, uv: [f64; 2]) -> [f64; 2] {
        std::array::from_fn(|i| uv[i] * self.scale[i] + self.offset[i])
    }
}

/// Use of a texture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum TextureUsage {
    Colour,
    Number,
    Normals,
}

/// Texture reference of a material library.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct TextureReference {
    /// File name as written.
    pub(super) file: String,
    pub(super) layout: UvLayout,
    /// Channel of a texture of numbers (`-imfchan`): r, g, b, m (opacity), l (mean) or z.
    pub(super) channel: Option<String>,
    /// Factor on the slopes of a bump or normal map (`-bm`).
    pub(super) multiplier: Option<f64>,
    /// Notes on unused options and other differences.
    pub(super) notes: Vec<String>,
}

/// Parses everything after the keyword.
pub(super) fn parse(text: &str) -> Result<TextureReference, String> {
    let mut texture = TextureReference {
        file: String::new(),
        layout: UvLayout::PLAIN,
        channel: None,
        multiplier: None,
        notes: Vec::new(),
    };
    let mut rest = text;
    while let Some((option, after)) = next_option(rest) {
        rest = texture.take(option, after)?;
    }
    let (name, options) = name_and_options(rest.trim());
    if name.is_empty() {
        return Err("texture without a file name".to_owned());
    }
    texture.file = name.to_owned();
    // The last word of options after the name is no file.
    let ended = format!("{options} .");
    let mut rest = &ended[..];
    while let Some((option, after)) = next_option(rest) {
        rest = texture.take(option, after)?;
    }
    Ok(texture)
}

/// Splits the file name from options that some programs write after it: those that follow a file ending.
fn name_and_options(text: &str) -> (&str, &str) {
    let begins = text.match_indices(" -").map(|(at, _)| at);
    let is_option = |at: &usize| next_option(&text[*at..]).is_some() && text[..*at].contains('.');
    match begins.into_iter().find(is_option) {
        Some(at) => (text[..at].trim(), text[at..].trim()),
        None => (text, ""),
    }
}

/// Option at the start of `rest`, and the text after it. A name that begins with `-` and is no known option is a file.
fn next_option(rest: &str) -> Option<(&str, &str)> {
    let (word, after) = first_word(rest)?;
    let known = [
        "-s", "-o", "-t", "-clamp", "-blendu", "-blendv", "-boost", "-mm", "-bm", "-imfchan", "-texres", "-type", "-cc",
    ];
    known.contains(&word).then_some((word, after))
}

fn first_word(text: &str) -> Option<(&str, &str)> {
    let text = text.trim_start();
    let end = text.find(char::is_whitespace).unwrap_or(text.len());
    (end > 0).then(|| text.split_at(end))
}

impl TextureReference {
    /// Reads an option; returns the text after it.
    fn take<'a>(&mut self, option: &str, after: &'a str) -> Result<&'a str, String> {
        match option {
            "-s" => vector(option, after, &mut self.layout.scale),
            "-o" => vector(option, after, &mut self.layout.offset),
            "-t" => Ok(self.pass_over(option, after, numbers(after, 3).0.len())),
            "-mm" => Ok(self.pass_over(option, after, 2)),
            "-imfchan" => {
                let (word, after) = first_word(after).ok_or("`-imfchan` without a channel")?;
                self.channel = Some(word.to_ascii_lowercase());
                Ok(after)
            }
            "-bm" => {
                let (word, after) = first_word(after).ok_or("`-bm` without a number")?;
                self.multiplier = Some(number(word).map_err(|problem| problem.words)?);
                Ok(after)
            }
            "-clamp" => {
                let (word, after) = first_word(after).ok_or("`-clamp` without on or off")?;
                if word == "on" {
                    self.notes.push("the texture option `-clamp on` is not used: the texture repeats".to_owned());
                }
                Ok(after)
            }
            _ => Ok(self.pass_over(option, after, 1)),
        }
    }

    /// Factor on the slopes of a normal map.
    pub(super) fn strength(&self) -> f64 {
        const MAX_STRENGTH: f64 = 10.0;
        self.multiplier.unwrap_or(1.0).clamp(0.0, MAX_STRENGTH)
    }

    /// Notes on options without use: those of colours, of numbers or of normals.
    pub(super) fn notes_for(&self, usage: TextureUsage) -> Vec<String> {
        let channel = self.channel.as_ref().filter(|_| usage != TextureUsage::Number);
        let multiplier = self.multiplier.filter(|_| usage != TextureUsage::Normals);
        let options = channel.map(|channel| format!("-imfchan {channel}")).into_iter();
        let options = options.chain(multiplier.map(|multiplier| format!("-bm {multiplier}")));
        let notes = options.map(|option| format!("the texture option `{option}` is not used"));
        self.notes.iter().cloned().chain(notes).collect()
    }

    fn pass_over<'a>(&mut self, option: &str, after: &'a str, words: usize) -> &'a str {
        let mut rest = after;
        for _ in 0..words {
            rest = first_word(rest).map_or(rest, |(_, after)| after);
        }
        let passed_over = &after[..after.len() - rest.len()];
        self.notes.push(format!("the texture option `{option}{passed_over}` is not used"));
        rest
    }
}

/// Reads the first two of up to three numbers into `field`; returns the text after them.
fn vector<'a>(option: &str, after: &'a str, field: &mut [f64; 2]) -> Result<&'a str, String> {
    let (values, rest) = numbers(after, 3);
    if values.is_empty() {
        return Err(format!("`{option}` without a number"));
    }
    field.iter_mut().zip(values).for_each(|(field, value)| *field = value);
    Ok(rest)
}

/// Up to `most` numbers at the start of `text`, and the text after them.
fn numbers(text: &str, max: usize) -> (Vec<f64>, &str) {
    let mut values = Vec::new();
    let mut rest = text;
    while values.len() < max {
        let Some((word, after)) = first_word(rest) else { break };
        let (Ok(value), false) = (number(word), after.trim().is_empty()) else { break };
        values.push(value);
        rest = after;
    }
    (values, rest)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn options_are_parted_from_a_name_with_blanks() {
        let texture = parse("-s 2 3 1 -o 0.5 -blendu on -mm 0 1 -clamp on  my wall.png ").expect("readable");
        assert_eq!(texture.file, "my wall.png");
        assert_eq!(texture.layout, UvLayout { scale: [2.0, 3.0], offset: [0.5, 0.0] });
        assert_eq!(
            texture.notes,
            [
                "the texture option `-blendu on` is not used",
                "the texture option `-mm 0 1` is not used",
                "the texture option `-clamp on` is not used: the texture repeats",
            ]
        );
    }

    #[test]
    fn options_may_follow_the_name() {
        let texture = parse("my bump.png -bm 0.3 -imfchan R").expect("readable");
        assert_eq!(
            (&texture.file[..], texture.multiplier, texture.channel.as_deref()),
            ("my bump.png", Some(0.3), Some("r"))
        );
        assert_eq!(texture.notes_for(TextureUsage::Colour).len(), 2);
        assert_eq!(parse("a.png -s 2 3").expect("readable").layout.scale, [2.0, 3.0]);
        assert_eq!(parse("a -so.png").expect("readable").file, "a -so.png");
    }

    #[test]
    fn a_name_may_begin_with_a_digit_or_a_dash() {
        assert_eq!(parse("-s 2 2 1 2.png").expect("readable").file, "2.png");
        assert_eq!(parse("-s 2 3").expect("a file called 3").file, "3");
        assert_eq!(parse("-odd.png").expect("readable").file, "-odd.png");
        assert!(parse("-s 1 1 1").expect("the last word is the file").file == "1");
        assert!(parse("").is_err());
        assert!(parse("-bm").is_err());
    }
}
