//! The memory of a frame, from electrons to its files.

use crate::plan::{CameraPlan, PictureFormat};
use etendue_isp::Processing;
use etendue_sensor::{Sensor, SignalComponent};

/// Size of a sample of a plane, bytes: electrons, charge, voltage, digital numbers and channels have 32 bits.
const SAMPLE: f64 = size_of::<f32>() as f64;
/// Size of a colour of an image, bytes.
const COLOUR: f64 = size_of::<[f32; 3]>() as f64;

/// The memory of a frame, bytes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct FrameMemory {
    /// Memory of the finished frame.
    pub(super) stored: f64,
    /// Peak memory while it is made or written.
    pub(super) peak: f64,
}

impl FrameMemory {
    pub(super) fn new(camera: &CameraPlan) -> Self {
        let Some(sensor) = &camera.body.sensor else { return Self::default() };
        let products = &camera.products;
        if !(products.raw || products.picture || products.signal_breakdown || products.video) {
            return Self::default();
        }
        let raster = &camera.body.raster;
        let (width, height) = (raster.width(), raster.height());
        let black = &sensor.parameters().read_out.layout.optical_black;
        let array = ((width + black.columns) * (height + black.rows)) as f64;
        let (columns, rows) = sensor.image_size(width, height);
        let image_pixels = (columns * rows) as f64;
        let layers = if products.signal_breakdown { SignalComponent::ALL.len() as f64 } else { 0.0 };
        let raw = array * SAMPLE * (1.0 + layers);
        let developed = camera.body.development.as_ref().map(|development| {
            let channels = development.mosaic.channels() as f64;
            DevelopmentMemory {
                picture: image_pixels,
                channels,
                processing: &development.processing,
                format: development.format,
            }
        });
        let undistorted = products.undistorted.is_some();
        let stored = raw + developed.as_ref().map_or(0.0, |_| 2.0 * COLOUR * image_pixels);
        let developing = raw + developed.as_ref().map_or(0.0, DevelopmentMemory::development_bytes);
        let files = files(sensor, array, layers) + developed.as_ref().map_or(0.0, |d| d.files(undistorted));
        let remembered = state_bytes_of_pixel(sensor) * array;
        Self { stored, peak: (readout_bytes(sensor, raw, array)).max(developing).max(stored + files) + remembered }
    }
}

/// Returns the memory while charge is read: the array with optical black, its charge before and after an effect on planes, and, of captures that are merged,
/// their charge, the sums so far and a mask of the pixels that are not merged yet.
fn readout_bytes(sensor: &Sensor, raw: f64, array: f64) -> f64 {
    let merged = !sensor.parameters().hdr.captures.is_empty();
    let merging = if merged { (2.0 * SAMPLE + size_of::<bool>() as f64) * array + raw } else { 0.0 };
    raw + 3.0 * SAMPLE * array + merging
}

/// Returns the state of a pixel from frame to frame, bytes, before a frame and after it.
fn state_bytes_of_pixel(sensor: &Sensor) -> f64 {
    let p = sensor.parameters();
    let rts_effects =
        usize::from(p.charge.dark.dark_current_rts.is_some()) + usize::from(p.voltage.rts_noise.is_some());
    2.0 * (p.charge.lag.traps.len() as f64 * SAMPLE + (rts_effects * size_of::<bool>()) as f64)
}

/// Returns the memory of files of digital numbers and of their components: the numbers as bytes, and the file, which is no larger; both twice if a file is
/// assembled from parts.
fn files(sensor: &Sensor, array: f64, layers: f64) -> f64 {
    let bytes = if sensor.delivered_bits() > 16 { 4.0 } else { 2.0 };
    array * (3.0 * bytes + layers * SAMPLE)
}

/// An image that is developed from a raw image.
struct DevelopmentMemory<'a> {
    /// Number of its pixels.
    picture: f64,
    /// Number of channels of its mosaic.
    channels: f64,
    processing: &'a Processing,
    format: PictureFormat,
}

impl DevelopmentMemory<'_> {
    /// Returns the memory while it is developed, without the raw image.
    fn development_bytes(&self) -> f64 {
        let of_channels = self.channels * SAMPLE;
        // A copy of the image part of the raw image, or of its numbers without companding; samples between black and white, and with a border.
        let samples = 3.0 * SAMPLE + if self.processing.defects.is_off() { 0.0 } else { size_of::<bool>() as f64 };
        let reduced = if self.processing.noise_reduction.is_some() { of_channels } else { 0.0 };
        let colours = of_channels + reduced.max(COLOUR);
        let filters = !self.processing.image_filters.is_empty() || self.processing.sharpening.is_some();
        let display = (if filters { 3.0 } else { 2.0 }) * COLOUR;
        self.picture * (samples + of_channels).max(SAMPLE + colours).max(SAMPLE + display)
    }

    /// Returns the memory while its files are written: its numbers as bytes, and the file, twice if it is assembled from parts; for the undistorted image
    /// the same again, and the image.
    fn files(&self, undistorted: bool) -> f64 {
        let bytes = if self.format.bits() > 8 { 2.0 } else { 1.0 };
        let file = 3.0 * 3.0 * bytes;
        self.picture * if undistorted { 2.0 * file + 2.0 * COLOUR } else { file }
    }
}
