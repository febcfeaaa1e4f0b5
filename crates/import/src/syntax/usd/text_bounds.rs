//! Checks of text layers before `openusd` parses them. Refused are deep nesting, on which its parser exhausts the stack; deeply nested lists, which it parses
//! repeatedly; and unbalanced braces in paths and names of prims, on which it does not terminate.

/// Maximum depth of braces, and of brackets of an expression in a string.
const MAX_DEPTH: usize = 64;
/// Maximum depth of lists and tuples; an array of matrices has three levels.
const MAX_LISTS: usize = 8;

/// Refuses a text that is nested too deep, or has unbalanced braces in a path or in the name of a prim.
pub(super) fn check_text(text: &[u8]) -> Result<(), String> {
    // Depths of braces, parentheses, brackets.
    let (mut depths, mut at, mut words) = ([0_usize; 3], 0, WordEnds::default());
    let line = |at: usize| 1 + text[..at].iter().filter(|byte| **byte == b'\n').count();
    while at < text.len() {
        let opens = [b"{}", b"()", b"[]"].iter().position(|pair| pair.contains(&text[at]));
        match (text[at], opens) {
            (b'#', _) => at += text[at..].iter().position(|byte| *byte == b'\n').unwrap_or(text.len() - at),
            (quote @ (b'"' | b'\'' | b'@'), _) => {
                let (end, inner) = quoted(text, at, quote);
                check_expression(inner)?;
                words.read_up_to(text, at);
                if words.name_prim() && !is_balanced(inner) {
                    return Err(format!("line {}: the name of a prim contains unbalanced braces", line(at)));
                }
                at = end;
                continue;
            }
            (b'<', _) => {
                let end =
                    text[at..].iter().position(|byte| matches!(byte, b'>' | b'\n')).map_or(text.len(), |n| at + n);
                if !is_balanced(&text[at..end]) {
                    return Err(format!("line {}: a path contains unbalanced braces", line(at)));
                }
                at = end;
            }
            (b'{' | b'(' | b'[', Some(kind)) => {
                depths[kind] += 1;
                let max = if kind == 0 { MAX_DEPTH } else { MAX_LISTS };
                if depths[kind] > max {
                    let message = format!("prims and values are nested more than {max} levels deep");
                    return Err(format!("line {}: {message}", line(at)));
                }
            }
            (_, Some(kind)) => depths[kind] = depths[kind].saturating_sub(1),
            _ => {}
        }
        at += 1;
    }
    Ok(())
}

/// Returns true if all braces are balanced.
pub(super) fn is_balanced(text: &[u8]) -> bool {
    let mut depth = 0_usize;
    for byte in text {
        match byte {
            b'{' => depth += 1,
            b'}' if depth == 0 => return false,
            b'}' => depth -= 1,
            _ => {}
        }
    }
    depth == 0
}

/// The last two words before the current position of a text that is read sequentially.
#[derive(Default)]
struct WordEnds {
    /// Last five bytes of each word: the length of the longest keyword, `class`.
    ends: [[u8; 5]; 2],
    is_within: bool,
    read: usize,
}

impl WordEnds {
    fn read_up_to(&mut self, text: &[u8], at: usize) {
        for byte in &text[self.read..at] {
            if byte.is_ascii_whitespace() {
                self.is_within = false;
                continue;
            }
            if !std::mem::replace(&mut self.is_within, true) {
                self.ends = [self.ends[1], [0; 5]];
            }
            self.ends[1].rotate_left(1);
            self.ends[1][4] = *byte;
        }
        self.read = at;
    }

    /// Returns true if the quoted text that follows is the name of a prim: one of the two words is `def`, `over` or `class`, as a type may stand between.
    fn name_prim(&self) -> bool {
        self.ends.iter().any(|end| [&b"def"[..], b"over", b"class"].iter().any(|known| end.ends_with(known)))
    }
}

/// End of a quoted text that starts at `at`, and its content.
fn quoted(text: &[u8], at: usize, quote: u8) -> (usize, &[u8]) {
    let width = if text[at..].starts_with(&[quote; 3]) { 3 } else { 1 };
    let from = at + width;
    let mut end = from;
    while end < text.len() {
        if text[end] == b'\\' {
            end += 2;
        } else if text[end..].starts_with(&[quote; 3][..width]) {
            return (end + width, &text[from..end]);
        } else {
            end += 1;
        }
    }
    (text.len(), &text[from.min(text.len())..])
}

/// Refuses an expression (a text that begins with a back-tick) that is nested too deep.
pub(super) fn check_expression(text: &[u8]) -> Result<(), String> {
    if text.first() != Some(&b'`') {
        return Ok(());
    }
    let mut depth = 0_usize;
    for byte in text {
        match byte {
            b'(' | b'[' | b'{' => depth += 1,
            b')' | b']' | b'}' => depth = depth.saturating_sub(1),
            _ => {}
        }
        if depth > MAX_DEPTH {
            return Err(format!("an expression is nested more than {MAX_DEPTH} levels deep"));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Quotes without a blank between them, and blanks without a word: a million bytes of either are read in linear time.
    #[test]
    fn long_texts_are_read_once() {
        let blanks = format!("{}{}", " ".repeat(1_000_000), "''".repeat(100_000));
        let texts = ["\"a\"".repeat(400_000), format!("def{}", " \"\"".repeat(300_000)), blanks];
        let (done, is_done) = std::sync::mpsc::channel();
        std::thread::spawn(move || done.send(texts.map(|text| check_text(text.as_bytes()))));
        let results = is_done.recv_timeout(std::time::Duration::from_secs(20)).expect("an end within 20 s");
        assert!(results.iter().all(Result::is_ok), "{results:?}");
    }

    #[test]
    fn brackets_count_where_they_are_no_text() {
        let nested = |open: &str, close: &str| format!("{}{}", open.repeat(65), close.repeat(65));
        assert!(check_text("[".repeat(9).as_bytes()).is_err() && check_text("[]".repeat(9).as_bytes()).is_ok());
        for path in ["def Sphere \"B}lb\"", "def \"{\"", "rel a = </a}b>", "over\n'}'"] {
            assert!(check_text(path.as_bytes()).is_err(), "{path}");
        }
        for path in ["def \"a\" { string b = \"}\" }", "rel a = </a{v=x}b>", "string doc = \"a } b\""] {
            assert!(check_text(path.as_bytes()).is_ok(), "{path}");
        }
        for path in ["x\n def  \t\nSphere\n \"{\"", "\"a\"def\"{\""] {
            assert!(check_text(path.as_bytes()).is_err(), "{path}");
        }
        for path in ["def A B \"{\"", "define \"{\"", "de f \"{\"", "\"{\""] {
            assert!(check_text(path.as_bytes()).is_ok(), "{path}");
        }
        assert!(check_text(nested("{", "}").as_bytes()).is_err());
        assert!(check_text(nested("{}", "").as_bytes()).is_ok());
        for plain in ["# \n", "\" \"", "'''\n'''", "@ @"] {
            let (before, after) = plain.split_at(plain.len() / 2);
            let text = format!("{before}{}{after} {{}}", nested("(", ")"));
            assert!(check_text(text.as_bytes()).is_ok(), "{plain}");
        }
        assert!(check_text(b"\"\\\"((\" (").is_ok());
        assert!(check_text(format!("\"`{}`\"", nested("(", ")")).as_bytes()).is_err());
        for end in ["\"", "\"\\", "'''", "@", "#", "\"\"\"a\""] {
            assert!(check_text(end.as_bytes()).is_ok(), "{end}");
        }
    }
}
