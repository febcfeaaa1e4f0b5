//! The picture that a sensor delivers.

use etendue_projection::Raster;
use etendue_sensor::Sensor;

/// The picture that a sensor delivers: its region, binned.
pub(super) struct Delivered {
    pub(super) width: usize,
    pub(super) height: usize,
    /// Where the optical axis meets it, px.
    pub(super) principal_px: [f64; 2],
}

impl Delivered {
    pub(super) fn of(sensor: &Sensor, raster: &Raster) -> Self {
        let (width, height) = sensor.picture_size(raster.width(), raster.height());
        Self { width, height, principal_px: sensor.in_picture(raster.principal_px().to_array()) }
    }
}
