//! Cameras from views of a chart: what `measure focal` and `calibrate` share.

mod advice;
mod assumed;
mod camera_file;
mod fit;
mod found;
mod report;
mod request;
mod stated;

pub(crate) use fit::TriedModel;
pub(crate) use found::Found;
pub use request::ViewsRequest;
pub use stated::StatedLength;
