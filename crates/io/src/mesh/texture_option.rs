//! Texture statements of MTL: options before a file name that may hold blanks.
//!
//! `-s u v w` and `-o u v w` take one to three numbers; the other options take a fixed number of words.

use super::statement::number;

/// A texture as a material library names it.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct TextureReference {
    /// File name as written.
    pub(super) file: String,
    /// Multiplies texture coordinates.
    pub(super) scale: [f64; 2],
    /// Is added to texture coordinates.
    pub(super) offset: [f64; 2],
    /// `-clamp on`.
    pub(super) clamp: bool,
    /// Options that are not read, as written.
    pub(super) unread: Vec<String>,
}

/// Reads everything behind the keyword.
pub(super) fn parse(rest: &str) -> Result<TextureReference, String> {
    let mut texture =
        TextureReference { file: String::new(), scale: [1.0; 2], offset: [0.0; 2], clamp: false, unread: Vec::new() };
    let mut rest = rest.trim_ascii_start();
    while let Some((option, after)) = next_option(rest) {
        rest = texture.take(option, after)?;
    }
    rest.trim_ascii().clone_into(&mut texture.file);
    if texture.file.is_empty() {
        return Err("texture without a file name".to_owned());
    }
    Ok(texture)
}

/// An option at the head of `rest`, with what follows it. A name that begins with `-` and is no known option is a file.
fn next_option(rest: &str) -> Option<(&str, &str)> {
    let (word, after) = first_word(rest)?;
    let known = [
        "-s", "-o", "-t", "-clamp", "-blendu", "-blendv", "-boost", "-mm", "-bm", "-imfchan", "-texres", "-type", "-cc",
    ];
    known.contains(&word).then_some((word, after))
}

fn first_word(text: &str) -> Option<(&str, &str)> {
    let text = text.trim_ascii_start();
    let end = text.find([' ', '\t']).unwrap_or(text.len());
    (end > 0).then(|| text.split_at(end))
}

impl TextureReference {
    fn take<'a>(&mut self, option: &str, after: &'a str) -> Result<&'a str, String> {
        match option {
            "-s" => self.vector(option, after, |t| &mut t.scale),
            "-o" => self.vector(option, after, |t| &mut t.offset),
            "-clamp" => {
                let (word, after) = first_word(after).ok_or("`-clamp` without on or off")?;
                self.clamp = word == "on";
                Ok(after)
            }
            "-t" => Ok(self.pass_over(option, after, numbers(after, 3).0.len())),
            "-mm" => Ok(self.pass_over(option, after, 2)),
            _ => Ok(self.pass_over(option, after, 1)),
        }
    }

    fn vector<'a>(
        &mut self,
        option: &str,
        after: &'a str,
        field: fn(&mut Self) -> &mut [f64; 2],
    ) -> Result<&'a str, String> {
        let (values, after) = numbers(after, 3);
        let [u, rest @ ..] = &values[..] else { return Err(format!("`{option}` without a number")) };
        let v = rest.first();
        let field = field(self);
        field[0] = *u;
        if let Some(v) = v {
            field[1] = *v;
        }
        Ok(after)
    }

    fn pass_over<'a>(&mut self, option: &str, after: &'a str, words: usize) -> &'a str {
        let mut rest = after;
        for _ in 0..words {
            rest = first_word(rest).map_or(rest, |(_, after)| after);
        }
        self.unread.push(format!("{option}{}", &after[..after.len() - rest.len()]));
        rest
    }
}

/// Up to `most` numbers at the head of `text`, and what follows them.
fn numbers(text: &str, most: usize) -> (Vec<f64>, &str) {
    let mut values = Vec::new();
    let mut rest = text;
    while values.len() < most {
        let Some((word, after)) = first_word(rest) else { break };
        let (Ok(value), false) = (number(word), after.trim_ascii().is_empty()) else { break };
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
        assert_eq!((texture.scale, texture.offset, texture.clamp), ([2.0, 3.0], [0.5, 0.0], true));
        assert_eq!(texture.unread, ["-blendu on", "-mm 0 1"]);
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
