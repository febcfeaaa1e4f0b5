//! A point-spread function from an image: measured, or computed by another program.
//!
//! The image is the response to a point's light, first row at the top, first column on the left; the values are linear and are divided by their sum.
//! The light of a sample counts at its centre: sample (i, j) of w × h is at (i + ½ − w/2, j + ½ − h/2) times the pitch from the point, so the point
//! is at the centre of the image for even and odd sizes. Light is distributed over the pixels so that the modulation is kept (`band.rs`); one sample
//! is the identity.
//!
//! With a wavelength λ₀ the image scales with the wavelength, as diffraction does: the pitch is multiplied by λ/λ₀, averaged over a band in steps of
//! at most 10 nm. Without, it is the same at all wavelengths.
//!
//! Left out: a function that varies over the image.

use core::fmt;

use etendue_core::{Bands, EffectStatus, WavelengthRange};
use etendue_projection::Raster;
use glam::DVec2;

use super::convolve::{self, NumberField, OperationCounts, UsageCounts};
use super::error::{EffectsError, positive};
use super::film_part::{FilmPart, KernelBuilder, mid_wavelengths};
use super::psf::{MAX_PX, MM_PER_UM, VISIBLE};
use super::{Canvas, canvas::KernelPair, core_table::CoreBuilder, kernel::Kernel, sample_spread::SampleSpread};

/// The largest distance between samples, px; the rest is rounding.
const MAX_STEP_PX: f64 = 1.0 + 1e-9;

/// Parameters of an image of a point's light.
#[derive(Clone, PartialEq)]
pub struct SpreadImageParameters {
    /// Samples in a row.
    pub width: usize,
    /// Light of the samples, row by row, linear, in any unit.
    pub light: Vec<f32>,
    /// Pitch of the samples on the sensor, µm.
    pub pitch_um: f64,
    /// Wavelength of the pitch, nm; at others the pitch is in proportion to the wavelength. `None`: the same pitch at all wavelengths.
    pub wavelength_nm: Option<f64>,
    /// For samples fitted to a table of modulation: the maximum error of their modulation. `None` for an image.
    pub deviation: Option<f64>,
}

impl fmt::Debug for SpreadImageParameters {
    /// Omits the samples, which come from a file.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "SpreadImage({} × {}, {:?} µm, {:?} nm)",
            self.width,
            self.height(),
            self.pitch_um,
            self.wavelength_nm
        )
    }
}

impl SpreadImageParameters {
    /// Rows.
    #[must_use]
    pub fn height(&self) -> usize {
        self.light.len() / self.width.max(1)
    }
}

/// A point-spread function from an image.
#[derive(Clone, Debug, PartialEq)]
pub struct SpreadImage {
    parameters: SpreadImageParameters,
}

impl SpreadImage {
    /// The function on the pixels of an image.
    ///
    /// # Errors
    /// If the samples are not valid light, or are too far apart, or the function is too wide.
    pub fn new(parameters: SpreadImageParameters, raster: &Raster) -> Result<Self, EffectsError> {
        positive("image_pitch_um", parameters.pitch_um)?;
        parameters.wavelength_nm.map_or(Ok(0.0), |nm| positive("image_wavelength_nm", nm))?;
        check_light(&parameters)?;
        let image = Self { parameters };
        image.check_size(raster.pitch_mm())?;
        Ok(image)
    }

    /// Construction parameters.
    #[must_use]
    pub fn parameters(&self) -> &SpreadImageParameters {
        &self.parameters
    }

    fn check_size(&self, pitch_mm: DVec2) -> Result<(), EffectsError> {
        let (step_mm, pixel_mm) = (self.step_mm(VISIBLE.high_nm), pitch_mm.min_element());
        if step_mm > MAX_STEP_PX * pixel_mm {
            return Err(EffectsError::Coarse { step_um: step_mm / MM_PER_UM, pixel_um: pixel_mm / MM_PER_UM });
        }
        let [x, y] = self.reach_px(pitch_mm);
        if x.max(y) > MAX_PX {
            return Err(EffectsError::Wide { reach_px: x.max(y), most_px: MAX_PX });
        }
        Ok(())
    }

    pub(super) fn status(&self) -> EffectStatus {
        let p = &self.parameters;
        let scale = p.wavelength_nm.map_or("the same at all wavelengths".to_owned(), |nm| {
            format!("at {nm} nm, in proportion to the wavelength elsewhere")
        });
        let size = format!("{} × {} samples, {} µm apart", p.width, p.height(), p.pitch_um);
        let off = |off: f64| {
            format!(
                "a table of modulation as a rotationally symmetric sum of Gaussians, {size}, {scale} and over the image; modulation error at most \
                 {off:.3}"
            )
        };
        let picture = || format!("an image of {size}, {scale}");
        EffectStatus::Modelled(p.deviation.map_or_else(picture, off))
    }

    /// Columns and rows over which light is spread.
    pub(super) fn reach_px(&self, pitch_mm: DVec2) -> [usize; 2] {
        self.reach_px_at(VISIBLE.high_nm, pitch_mm)
    }

    fn reach_px_at(&self, nm: f64, pitch_mm: DVec2) -> [usize; 2] {
        let reach = self.offset_mm(0, nm).abs() / pitch_mm;
        [reach.x.ceil() as usize, reach.y.ceil() as usize]
    }

    /// Pitch of the samples.
    fn step_mm(&self, nm: f64) -> f64 {
        self.parameters.pitch_um * MM_PER_UM * self.parameters.wavelength_nm.map_or(1.0, |at| nm / at)
    }

    /// Offset of a sample from the point.
    fn offset_mm(&self, index: usize, nm: f64) -> DVec2 {
        let (width, height) = (self.parameters.width, self.parameters.height());
        let middle = DVec2::new((index % width) as f64, (index / width) as f64) + 0.5;
        (middle - 0.5 * DVec2::new(width as f64, height as f64)) * self.step_mm(nm)
    }

    /// Deposits the light of a wavelength: positions, px, and fractions.
    pub(super) fn deposit(&self, pitch_mm: DVec2, nm: f64, mut to: impl FnMut(DVec2, f64)) {
        for (index, light) in self.parameters.light.iter().enumerate().filter(|(_, light)| **light > 0.0) {
            to(self.offset_mm(index, nm) / pitch_mm, f64::from(*light));
        }
    }

    /// The kernel of a band, its sum one.
    fn kernel(&self, band: WavelengthRange, pitch_mm: DVec2, part: FilmPart) -> Kernel {
        let mut kernel = KernelBuilder::new(part, self.reach_px_at(band.high_nm, pitch_mm));
        for nm in mid_wavelengths(band) {
            self.deposit(pitch_mm, nm, |offset_px, light| kernel.deposit(offset_px, light));
        }
        kernel.kernel()
    }

    /// The cores by which samples are displaced, for the wavelengths of a range.
    pub(super) fn sample_spread(&self, canvas: &Canvas, range: WavelengthRange) -> Option<SampleSpread> {
        // The same at all wavelengths: one table.
        let parts = self.parameters.wavelength_nm.map_or(1, |_| mid_wavelengths(range).count());
        let step_nm = (range.width_nm()) / parts as f64;
        let core = |part: usize| {
            let mut builder = CoreBuilder::default();
            let nm = range.low_nm + (part as f64 + 0.5) * step_nm;
            self.deposit(canvas.pitch_mm(), nm, |offset_px, light| builder.deposit(offset_px, light));
            builder.table()
        };
        let tables = (0..parts).map(core).collect::<Option<Vec<_>>>()?;
        Some(SampleSpread::new([Vec::new(), Vec::new()], range.low_nm, step_nm, vec![tables]))
    }

    /// Operation counts for the given number of images per band.
    pub(super) fn operation_counts(&self, canvas: &Canvas, bands: Bands, images: f64) -> OperationCounts {
        let count = bands.count() as f64;
        let of_band = WavelengthRange::new(bands.low_nm(), bands.low_nm() + bands.width_nm());
        let (kernels, of_kernel) = match self.parameters.wavelength_nm {
            None => (1.0, VISIBLE),
            Some(_) => (count, of_band),
        };
        let points = mid_wavelengths(of_kernel).count() * self.parameters.light.len();
        let reach = self.reach_px_at(0.5 * (bands.low_nm() + bands.high_nm()), canvas.pitch_mm());
        let uses = UsageCounts { ready: 2.0 * kernels, applied: images * count };
        OperationCounts { shared: kernels * points as f64, ..OperationCounts::default() }
            + convolve::operation_counts(reach, canvas.size(), &canvas.film_region(), uses)
    }

    /// The function prepared for a film.
    pub(super) fn prepare(&self, canvas: &Canvas, part: FilmPart) -> PreparedImage {
        let shared = self.parameters.wavelength_nm.is_none();
        let shared = shared.then(|| KernelPair::new(&self.kernel(VISIBLE, canvas.pitch_mm(), part), canvas));
        PreparedImage { image: self.clone(), canvas: *canvas, part, shared }
    }
}

fn check_light(parameters: &SpreadImageParameters) -> Result<(), EffectsError> {
    let SpreadImageParameters { width, light, .. } = parameters;
    if *width == 0 || light.is_empty() || light.len() % width != 0 {
        return Err(EffectsError::Samples { count: light.len(), width: *width });
    }
    if let Some(index) = light.iter().position(|v| !(v.is_finite() && *v >= 0.0)) {
        return Err(EffectsError::NoLight { column: index % width, row: index / width, value: light[index] });
    }
    if light.iter().all(|v| *v == 0.0) { Err(EffectsError::Dark) } else { Ok(()) }
}

/// The function of a film.
#[derive(Debug)]
pub(super) struct PreparedImage {
    image: SpreadImage,
    canvas: Canvas,
    part: FilmPart,
    /// Set if the function is the same at all wavelengths.
    shared: Option<KernelPair>,
}

impl PreparedImage {
    /// The film's light and variance in a band.
    pub(super) fn apply(
        &self,
        band: WavelengthRange,
        light: &NumberField,
        variance: Option<&NumberField>,
    ) -> (NumberField, Option<NumberField>) {
        match &self.shared {
            Some(shared) => shared.apply(light, variance),
            None => {
                let kernel = self.image.kernel(band, self.canvas.pitch_mm(), self.part);
                KernelPair::new(&kernel, &self.canvas).apply(light, variance)
            }
        }
    }
}
