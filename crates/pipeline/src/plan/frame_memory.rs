//! The memory of a frame, from electrons to its files.

use crate::plan::{CameraPlan, PictureFormat};
use etendue_isp::Processing;
use etendue_sensor::{Sensor, SignalComponent};

/// A number of a plane: electrons, charge, voltage, digital numbers and channels have 32 bits.
const NUMBER: f64 = size_of::<f32>() as f64;
/// A colour of a picture.
const COLOUR: f64 = size_of::<[f32; 3]>() as f64;

/// The memory of a frame, bytes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct FrameMemory {
    /// Of the frame when it is made.
    pub(super) held: f64,
    /// At most, while it is made or written.
    pub(super) most: f64,
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
        let (columns, rows) = sensor.picture_size(width, height);
        let picture = (columns * rows) as f64;
        let layers = if products.signal_breakdown { SignalComponent::ALL.len() as f64 } else { 0.0 };
        let raw = array * NUMBER * (1.0 + layers);
        let developed = camera.body.development.as_ref().map(|development| {
            let channels = development.mosaic.channels() as f64;
            Developed { picture, channels, processing: &development.processing, format: development.format }
        });
        let undistorted = products.undistorted.is_some();
        let held = raw + developed.as_ref().map_or(0.0, |_| 2.0 * COLOUR * picture);
        let making = raw + developed.as_ref().map_or(0.0, Developed::making);
        let files = files(sensor, array, layers) + developed.as_ref().map_or(0.0, |d| d.files(undistorted));
        let remembered = remembered(sensor) * array;
        Self { held, most: (reading(sensor, raw, array)).max(making).max(held + files) + remembered }
    }
}

/// While charge is read: the array with optical black, its charge before and after an effect on planes, and of captures that are merged their charge,
/// the sums so far and which pixels wait.
fn reading(sensor: &Sensor, raw: f64, array: f64) -> f64 {
    let merged = !sensor.parameters().hdr.captures.is_empty();
    let merging = if merged { (2.0 * NUMBER + size_of::<bool>() as f64) * array + raw } else { 0.0 };
    raw + 3.0 * NUMBER * array + merging
}

/// What a pixel remembers from frame to frame, before a frame and after it.
fn remembered(sensor: &Sensor) -> f64 {
    let p = sensor.parameters();
    let jumps = usize::from(p.charge.dark.dark_current_rts.is_some()) + usize::from(p.voltage.rts_noise.is_some());
    2.0 * (p.charge.lag.traps.len() as f64 * NUMBER + (jumps * size_of::<bool>()) as f64)
}

/// Files of digital numbers, and of what they are made of: the numbers as bytes, and the file, which is no larger; both twice where a file is put together
/// of parts.
fn files(sensor: &Sensor, array: f64, layers: f64) -> f64 {
    let bytes = if sensor.delivered_bits() > 16 { 4.0 } else { 2.0 };
    array * (3.0 * bytes + layers * NUMBER)
}

/// A picture that is made of a raw.
struct Developed<'a> {
    /// Its pixels.
    picture: f64,
    /// Channels of its mosaic.
    channels: f64,
    processing: &'a Processing,
    format: PictureFormat,
}

impl Developed<'_> {
    /// While it is made, beside the raw.
    fn making(&self) -> f64 {
        let of_channels = self.channels * NUMBER;
        // A copy of the raw's part that is a picture, or of its numbers without companding; samples between black and white, and with a border.
        let samples = 3.0 * NUMBER + if self.processing.defects.is_off() { 0.0 } else { size_of::<bool>() as f64 };
        let reduced = if self.processing.noise_reduction.is_some() { of_channels } else { 0.0 };
        let colours = of_channels + reduced.max(COLOUR);
        let filters = !self.processing.image_filters.is_empty() || self.processing.sharpening.is_some();
        let shown = (if filters { 3.0 } else { 2.0 }) * COLOUR;
        self.picture * (samples + of_channels).max(NUMBER + colours).max(NUMBER + shown)
    }

    /// While its files are written: its numbers as bytes, and the file, twice where it is put together of parts; and of the twin without distortion
    /// the same, and the picture.
    fn files(&self, undistorted: bool) -> f64 {
        let bytes = if self.format.bits() > 8 { 2.0 } else { 1.0 };
        let file = 3.0 * 3.0 * bytes;
        self.picture * if undistorted { 2.0 * file + 2.0 * COLOUR } else { file }
    }
}
