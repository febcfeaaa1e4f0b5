//! The boxes of one object in a picture.

use serde::Deserialize;

/// What is read of one object. Boxes are left, top, right, bottom in raster coordinates, px.
#[derive(Clone, Debug, PartialEq, Deserialize)]
pub struct ObjectBox {
    /// Its identity.
    pub id: u32,
    /// Its name; `None` where the scene gives it none.
    #[serde(default)]
    pub name: Option<String>,
    /// Its class; `None` where it is of none.
    #[serde(default)]
    pub class: Option<String>,
    /// About its pixels; `None` where none is seen.
    pub visible_box_px: Option<[f64; 4]>,
    /// About its whole projection, within the picture and beyond.
    pub amodal_box_px: Option<[f64; 4]>,
    /// Pixels that show it over those that would if it were alone; `None` where that is not known.
    #[serde(default)]
    pub visible_fraction: Option<f64>,
}
