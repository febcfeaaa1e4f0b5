//! How deep a text layer is nested: `openusd` goes down with it on the stack.

/// Brackets within one another, and those of an expression in a string.
const MAX_DEPTH: usize = 64;

/// Refuses a text that is nested too deep.
pub(super) fn check_text(text: &[u8]) -> Result<(), String> {
    let (mut depth, mut at) = (0_usize, 0);
    while at < text.len() {
        match text[at] {
            b'#' => at += text[at..].iter().position(|byte| *byte == b'\n').unwrap_or(text.len() - at),
            quote @ (b'"' | b'\'' | b'@') => {
                let (end, inner) = quoted(text, at, quote);
                check_expression(inner)?;
                at = end;
                continue;
            }
            b'{' | b'(' | b'[' => {
                depth += 1;
                if depth > MAX_DEPTH {
                    let line = 1 + text[..at].iter().filter(|byte| **byte == b'\n').count();
                    return Err(format!(
                        "line {line}: prims and values stand more than {MAX_DEPTH} deep in one another"
                    ));
                }
            }
            b'}' | b')' | b']' => depth = depth.saturating_sub(1),
            _ => {}
        }
        at += 1;
    }
    Ok(())
}

/// Where what is quoted from `at` on ends, and what stands within.
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
            return Err(format!("an expression is more than {MAX_DEPTH} deep"));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn brackets_count_where_they_are_no_text() {
        let nested = |open: &str, close: &str| format!("{}{}", open.repeat(65), close.repeat(65));
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
