//! Viewer page: every layer of a result, as HTML that a browser opens from the file system.
//!
//! ```no_run
//! use etendue::{ExistingFiles, NullObserver};
//! use etendue_view::{ViewRequest, view};
//!
//! # fn main() -> Result<(), etendue::Error> {
//! let request = ViewRequest { beside: Some("out/fog".into()), ..ViewRequest::new("out/clear") };
//! let page = view(&request, Some("out/page".as_ref()), ExistingFiles::Refuse, &NullObserver)?;
//! assert!(page.ends_with("index.html"));
//! # Ok(())
//! # }
//! ```
//!
//! | step | where |
//! | --- | --- |
//! | the files of a result, by camera and frame | `result_files` |
//! | a file's layers, by the readers of `etendue-io` | `read` |
//! | downsampling of a layer larger than a limit | `bin` |
//! | numbers as text that the page unpacks, with the precision stated there | `pack` |
//! | the page: `page/view.html` with its style and scripts | `page` |
//!
//! The page has no server, loads nothing from a network, and its bytes depend only on the files (docs/decisions/viewer.md).

mod layer;
mod pack;
mod page;
#[cfg(test)]
mod page_tests;
mod pairs;
mod read;
mod request;
mod result_files;
mod view;

pub use request::ViewRequest;
pub use view::view;
