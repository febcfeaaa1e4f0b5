//! Escaping of output text. Names in files, paths and arguments may contain characters that move a terminal's cursor, change its colours or title, or reverse
//! the reading direction. All printed, raised or logged text passes through here; nothing else of the library escapes for a terminal.
//!
//! These characters are escaped: the control characters of Unicode (C0 except line feed and tab, DEL, C1) and the invisible characters of its bidirectional
//! algorithm (UAX #9: marks, embeddings, overrides, isolates).

use std::{borrow::Cow, fmt::Write as _};

/// The text with such characters escaped as `\u{1b}`.
#[must_use]
pub fn terminal_text(text: &str) -> Cow<'_, str> {
    escaped_with(text, |out, c| write!(out, "\\u{{{:x}}}", u32::from(c)))
}

/// A JSON document with such characters escaped as `\u001b`. They occur only in strings, where the escape is the same character.
#[must_use]
pub fn terminal_json(document: &str) -> Cow<'_, str> {
    // All of them are in the basic plane: one unit of UTF-16 each.
    escaped_with(document, |out, c| write!(out, "\\u{:04x}", u32::from(c)))
}

/// Returns a text for HTML and SVG, attributes included, with the characters that [`terminal_text`] escapes escaped.
#[must_use]
pub fn escaped(text: &str) -> String {
    terminal_text(text).replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

fn escaped_with(text: &str, write: impl Fn(&mut String, char) -> std::fmt::Result) -> Cow<'_, str> {
    if !text.contains(is_invisible) {
        return Cow::Borrowed(text);
    }
    let mut out = String::with_capacity(text.len() + 16);
    for c in text.chars() {
        match is_invisible(c) {
            true => write(&mut out, c).expect("a string takes all that is written"),
            false => out.push(c),
        }
    }
    Cow::Owned(out)
}

fn is_invisible(c: char) -> bool {
    let is_direction =
        matches!(c, '\u{61c}' | '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
    is_direction || c.is_control() && !matches!(c, '\n' | '\t')
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_moves_a_cursor_or_turns_text_is_seen() {
        assert_eq!(terminal_text("a\u{1b}[31m\tb\n\u{7f}\u{9b}\r\0"), "a\\u{1b}[31m\tb\n\\u{7f}\\u{9b}\\u{d}\\u{0}");
        assert_eq!(terminal_text("a\u{202e}b\u{2066}c\u{200f}"), "a\\u{202e}b\\u{2066}c\\u{200f}");
        assert!(matches!(terminal_text("straße 🚗, 6 × 4 µm\n"), Cow::Borrowed(_)));
        assert_eq!(terminal_text(&terminal_text("\u{1b}")), "\\u{1b}", "twice is once");
    }

    #[test]
    fn a_document_says_the_same() {
        let value = serde_json::json!({ "a\u{202e}": "\u{1b}\u{7f}\u{85}\n\"" });
        let text = format!("{value:#}\n");
        let shown = terminal_json(&text);
        assert!(!shown.contains(is_invisible));
        assert_eq!(serde_json::from_str::<serde_json::Value>(&shown).expect("JSON"), value);
    }

    #[test]
    fn texts_cannot_become_markup() {
        assert_eq!(escaped("a < \"b\" & c"), "a &lt; &quot;b&quot; &amp; c");
        assert_eq!(escaped("a\u{202e}\u{1b}\n"), "a\\u{202e}\\u{1b}\n");
    }
}
