//! Numbers and lists as all readers of YAML and of plain text take them.

/// A number in decimal digits that gives the same number when it is read, always with a point: YAML 1.1 takes `1e-7` for a text.
pub(super) fn number(value: f64) -> String {
    let text = format!("{value}");
    if text.contains('.') { text } else { format!("{text}.0") }
}

/// `[1.0, 2.0]`.
pub(super) fn list(values: &[f64]) -> String {
    format!("[{}]", values.iter().map(|v| number(*v)).collect::<Vec<_>>().join(", "))
}

/// A text in double quotes; what would end it is escaped.
pub(super) fn quoted(text: &str) -> String {
    format!("\"{}\"", text.escape_default())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_a_point_and_come_back() {
        for value in [0.0, -0.0, 1.0, 1e-7, -2.5e20, 0.1, f64::MIN_POSITIVE] {
            let text = number(value);
            assert!(text.contains('.') && !text.contains('e'), "{text}");
            assert_eq!(text.parse::<f64>().map(f64::to_bits), Ok(value.to_bits()), "{text}");
        }
        assert_eq!(list(&[1.0, -0.5]), "[1.0, -0.5]");
        assert_eq!(quoted("a \"b\""), "\"a \\\"b\\\"\"");
    }
}
