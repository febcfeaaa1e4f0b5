//! Text within HTML, and data within its scripts.

use etendue::escaped;
use serde_json::Value;

/// A page: its head, and what stands in the body. Nothing of `style` and `body` is escaped.
pub(crate) fn document(title: &str, style: &str, body: &str) -> String {
    let version = env!("CARGO_PKG_VERSION");
    format!(
        "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n{GENERATOR}{version}\">\n<title>{}</title>\n\
         <style>\n{style}</style>\n</head>\n<body>\n{body}</body>\n</html>\n",
        escaped(title)
    )
}

/// What a page of this program has near its beginning.
pub(crate) const GENERATOR: &str = "<meta name=\"generator\" content=\"etendue ";

/// JSON as a script may contain it, whatever names it holds.
pub(crate) fn in_script(value: &Value) -> String {
    value.to_string().replace('<', "\\u003c").replace('\u{2028}', "\\u2028").replace('\u{2029}', "\\u2029")
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn no_name_ends_a_script_or_begins_an_element() {
        let hostile = json!({ "name": "</script><b>\u{2028}" });
        let told = in_script(&hostile);
        assert_eq!(told, "{\"name\":\"\\u003c/script>\\u003cb>\\u2028\"}");
        assert_eq!(serde_json::from_str::<Value>(&told).expect("JSON"), hostile);
        assert_eq!(escaped("a < \"b\" & c"), "a &lt; &quot;b&quot; &amp; c");
        assert!(document("<x>", "", "").contains("<title>&lt;x&gt;</title>"));
    }
}
