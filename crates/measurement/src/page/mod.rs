//! Pages that a browser opens from the file system: the look that results and reports share, and the report of a measurement.

mod report;

use etendue_io::escape::escaped;
pub use report::report_page;
pub(crate) use report::{REPORT_STYLE, curves, details, notes};

/// The look that all pages share: colours, light or dark as the system asks for, text and tables.
pub const PAGE_STYLE: &str = include_str!("style.css");

/// What a page of this program has near its beginning.
pub const PAGE_GENERATOR: &str = "<meta name=\"generator\" content=\"etendue ";

/// A page: its head, and what stands in the body. Nothing of `style`, which comes after [`PAGE_STYLE`], and of `body` is escaped.
#[must_use]
pub fn html_page(title: &str, style: &str, body: &str) -> String {
    let version = env!("CARGO_PKG_VERSION");
    format!(
        "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n{PAGE_GENERATOR}{version}\">\n<title>{}</title>\n\
         <style>\n{PAGE_STYLE}{style}</style>\n</head>\n<body>\n{body}</body>\n</html>\n",
        escaped(title)
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn titles_are_text() {
        assert!(html_page("<x>", "", "").contains("<title>&lt;x&gt;</title>"));
    }
}
