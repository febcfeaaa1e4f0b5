//! The picture that a sensor delivers.

use etendue_projection::Raster;
use etendue_sensor::Sensor;

/// The picture that a sensor delivers: its region, binned.
pub(super) struct Delivered {
    pub(super) width: usize,
    pub(super) height: usize,
    /// Where the optical axis meets it, px.
    pub(super) principal_px: [f64; 2],
    /// Number of pixels of the described sensor in a row and in a column of one pixel.
    pub(super) scale: u64,
}

impl Delivered {
    pub(super) fn of(sensor: &Sensor, raster: &Raster, scale: u64) -> Self {
        let (width, height) = sensor.picture_size(raster.width(), raster.height());
        Self { width, height, principal_px: sensor.in_picture(raster.principal_px().to_array()), scale }
    }
}
