//! Text in HTML and SVG.

use crate::terminal_text::terminal_text;

/// A text as it stands in HTML and SVG, in attributes too; what turns its direction or has no shape is shown as on a terminal.
#[must_use]
pub fn escaped(text: &str) -> String {
    terminal_text(text).replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

#[cfg(test)]
mod tests {
    use super::escaped;

    #[test]
    fn texts_cannot_become_markup() {
        assert_eq!(escaped("a < \"b\" & c"), "a &lt; &quot;b&quot; &amp; c");
        assert_eq!(escaped("a\u{202e}\u{1b}\n"), "a\\u{202e}\\u{1b}\n");
    }
}
