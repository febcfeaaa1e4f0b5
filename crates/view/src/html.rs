//! Data within the scripts of a page.

use serde_json::Value;

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
    }
}
