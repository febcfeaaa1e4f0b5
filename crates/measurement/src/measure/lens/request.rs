//! What is asked of a lens.

/// A lens and where it is measured.
#[derive(Clone, Debug)]
pub struct LensRequest {
    /// A camera file (TOML), a lens of Zemax (.zmx) or CODE V (.seq), or the name of a published lens (double-gauss, wide-angle, fisheye,
    /// telephoto).
    pub lens: String,
    /// Changes of the camera's keys, `key=value`.
    pub set: Vec<String>,
    /// The f-number at infinity focus; `None`: the camera's or the lens file's.
    pub f_number: Option<f64>,
    /// How many field heights, from the axis to the picture's edge, 2 or more.
    pub fields: u32,
    /// For a lens without a sensor: how far the picture reaches from the axis, mm; `None`: the largest field that a lens file states, otherwise
    /// 21.64; or as far as there is light.
    pub picture_radius_mm: Option<f64>,
    /// The wavelength of the first-order figures of a prescription, nm, 300 to 1100; `None`: the primary wavelength of the lens file, otherwise 587.56.
    pub wavelength_nm: Option<f64>,
}

impl LensRequest {
    /// The same as the program without options.
    pub fn new(lens: impl Into<String>) -> Self {
        Self {
            lens: lens.into(),
            set: Vec::new(),
            f_number: None,
            fields: 6,
            picture_radius_mm: None,
            wavelength_nm: None,
        }
    }
}
