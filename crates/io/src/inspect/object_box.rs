//! The boxes of one object in a picture.

use serde::Deserialize;

/// What is read of one object. Boxes are left, top, right, bottom in raster coordinates, px.
#[derive(Debug, Deserialize)]
pub(in crate::inspect) struct ObjectBox {
    /// Its identity.
    pub(in crate::inspect) id: u32,
    /// About its pixels; `None` where none is seen.
    pub(in crate::inspect) visible_box_px: Option<[f64; 4]>,
    /// About its whole projection, within the picture and beyond.
    pub(in crate::inspect) amodal_box_px: Option<[f64; 4]>,
}
