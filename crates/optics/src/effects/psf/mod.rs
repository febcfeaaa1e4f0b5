//! The point-spread function of a real aperture: diffraction, and a wavefront error in Zernike terms.
//!
//! For each band the patterns (`pattern.rs`) of wavelengths at most 10 nm apart are averaged and distributed over the pixels (`band.rs`), with all of
//! their light. Off the axis the pupil appears smaller from the sensor: by cos θ′ tangentially and cos³ θ′ radially, θ′ the chief-ray angle at the
//! exit pupil. The pattern is wider by the same factors (Goodman, Introduction to Fourier Optics).
//!
//! The function varies over the image by patches (`patches`).
//!
//! Zernike terms are lengths (root mean square over the pupil of the f-number), the same at all wavelengths. Terms with a table over the field rotate
//! with the field: they are defined for a point of the image to the right of the axis.
//!
//! Left out: vignetting of the pupil off the axis; the wavefront of the lens's own rays (a traced lens already has its aberrations); light beyond the
//! end of the pattern, which is redistributed over the pattern.

mod pattern;
mod patterns;

use etendue_core::{Bands, EffectStatus, WavelengthRange};
use etendue_projection::Raster;
use glam::{DMat2, DVec2};
use rayon::prelude::*;

use super::convolve::{self, OperationCounts, UsageCounts};
use super::film_part::{FilmPart, MM_PER_NM, NM_PER_UM, mid_wavelengths};
use super::patches::{PatchLayout, Patches};
use super::{Canvas, error::EffectsError, sample_spread::SampleSpread};
use crate::lens::Lens;
use pattern::{ApertureOutline, CELLS, Pupil};
use patterns::{Extent, Patch, Patterns};

pub use pattern::Zernike;

pub(super) use patterns::{MAX_PX, PreparedPsf};

pub(super) const MM_PER_UM: f64 = 1e-3;
/// Wavelengths, nm, for which the lattice of the pupil must resolve the wavefront.
pub(super) const VISIBLE: WavelengthRange = WavelengthRange::new(380.0, 780.0);
/// Step of the pattern used to displace samples, per λN, or per pixel where the pixel is larger.
const CORE_STEPS: f64 = 16.0;
/// Default number of patches where the function varies.
const PATCHES: [usize; 2] = [5, 3];
/// Relative width in the corner of the image below which the function counts as uniform.
const UNIFORM_RATIO: f64 = 1.05;

/// A Zernike term of the wavefront.
#[derive(Clone, Debug, PartialEq)]
pub struct ZernikeTerm {
    /// The polynomial.
    pub zernike: Zernike,
    /// Distances from the axis, mm, increasing; empty if the term is constant over the field.
    pub field_mm: Vec<f64>,
    /// Root mean square at each distance, µm; a single value if the term is constant.
    pub rms_um: Vec<f64>,
}

impl ZernikeTerm {
    /// The coefficient at a distance from the axis: linear interpolation, clamped at the ends.
    fn at(&self, radius_mm: f64) -> f64 {
        let (field, rms) = (&self.field_mm, &self.rms_um);
        let next = field.partition_point(|r| *r <= radius_mm);
        match next {
            0 => rms[0],
            n if n == field.len() => rms[n - 1],
            n => {
                let fraction = (radius_mm - field[n - 1]) / (field[n] - field[n - 1]);
                rms[n - 1] + fraction * (rms[n] - rms[n - 1])
            }
        }
    }

    fn varies(&self) -> bool {
        !self.field_mm.is_empty()
    }

    fn check(&self) -> Result<(), EffectsError> {
        let rising = self.field_mm.windows(2).all(|w| w[0] < w[1]);
        let fits = self.rms_um.len() == self.field_mm.len().max(1);
        if rising && fits { Ok(()) } else { Err(EffectsError::Table) }
    }
}

/// Parameters of an aperture and its wavefront.
#[derive(Clone, Debug, PartialEq)]
pub struct PsfParameters {
    /// Blades of the diaphragm; 0 for a circle.
    pub blades: u32,
    /// Curvature of the blades: 0 straight, 1 a circle.
    pub curvature: f64,
    /// Position of the first corner, from the image's x towards its y, rad.
    pub rotation_rad: f64,
    /// Radius of a central obstruction over the pupil radius.
    pub obstruction: f64,
    /// The wavefront error.
    pub wavefront: Vec<ZernikeTerm>,
    /// Radius at which the function is cut off, mm; `None`: as far as it is computed.
    pub reach_mm: Option<f64>,
    /// Patches across and down; `None`: one if the function is nearly uniform, else 5 × 3.
    pub patches: Option<[usize; 2]>,
}

/// The maximum of λN at the longest visible wavelength, px.
const MAX_LAMBDA_N_PX: f64 = 64.0;

/// The point-spread function of a lens's aperture.
#[derive(Clone, Debug, PartialEq)]
pub struct Psf {
    parameters: PsfParameters,
    f_number: f64,
    exit_mm: f64,
    patches: [usize; 2],
}

impl Psf {
    /// The function of `lens` for an image.
    ///
    /// # Errors
    /// If a table is malformed, or the wavefront is steeper than the lattice of the pupil can resolve.
    pub fn new(parameters: PsfParameters, lens: &Lens, image: &Raster) -> Result<Self, EffectsError> {
        parameters.wavefront.iter().try_for_each(ZernikeTerm::check)?;
        let (f_number, exit_mm) = (lens.working_f_number(), lens.exit_pupil_distance_mm());
        let mut psf = Self { parameters, f_number, exit_mm, patches: [1, 1] };
        let corner_mm = image.max_radius_mm();
        let varies =
            psf.stretch(corner_mm)[0] > UNIFORM_RATIO || psf.parameters.wavefront.iter().any(ZernikeTerm::varies);
        psf.patches = psf.parameters.patches.unwrap_or(if varies { PATCHES } else { [1, 1] });
        psf.check_width(image.pitch_mm().min_element())?;
        psf.check_slope(image.pitch_mm().min_element())?;
        Ok(psf)
    }

    /// Construction parameters.
    #[must_use]
    pub fn parameters(&self) -> &PsfParameters {
        &self.parameters
    }

    /// Patches across and down.
    #[must_use]
    pub fn patches(&self) -> [usize; 2] {
        self.patches
    }

    /// Working f-number.
    #[must_use]
    pub fn f_number(&self) -> f64 {
        self.f_number
    }

    pub(super) fn status(&self) -> EffectStatus {
        let shape = match self.parameters.blades {
            0 => "a circle".to_owned(),
            n => format!("{n} blades of curvature {}", self.parameters.curvature),
        };
        let obstruction = match (self.parameters.obstruction * 1e3).round() / 1e3 {
            0.0 => String::new(),
            ratio => format!(" with a central obstruction of {ratio} of its radius"),
        };
        let error = match self.parameters.wavefront.len() {
            0 => "no wavefront error".to_owned(),
            1 => "1 Zernike term".to_owned(),
            n => format!("{n} Zernike terms"),
        };
        let [x, y] = self.patches;
        let n = (self.f_number * 1e3).round() / 1e3;
        EffectStatus::Modelled(format!("diffraction of {shape}{obstruction} at f/{n}, {error}, in {x} × {y} patches"))
    }

    /// Columns and rows over which light is spread.
    pub(super) fn reach_px(&self, pitch_mm: DVec2) -> [usize; 2] {
        let fineness = self.fineness(VISIBLE.high_nm, pitch_mm.min_element());
        let reach = self.extent(fineness).reach_px(VISIBLE.high_nm, pitch_mm.min_element(), 1.0);
        [reach, reach]
    }

    fn outline(&self) -> ApertureOutline {
        let p = &self.parameters;
        ApertureOutline::new(p.blades, p.curvature, p.rotation_rad, p.obstruction)
    }

    /// Steps of the pattern per λN: at least two; two per pixel at the longest wavelength for λN up to 16 px, at least one per pixel beyond.
    fn fineness(&self, longest_nm: f64, pitch_mm: f64) -> f64 {
        let pixels = longest_nm * MM_PER_NM * self.f_number / pitch_mm;
        (2.0 * pixels.ceil().clamp(1.0, 16.0)).max(pixels) * self.outline().radius()
    }

    fn extent(&self, fineness: f64) -> Extent {
        Extent { f_number: self.f_number, reach_mm: self.parameters.reach_mm, fineness }
    }

    /// Widening of the pattern along the radius and across it, at a distance from the axis on the sensor.
    #[must_use]
    pub fn stretch(&self, radius_mm: f64) -> [f64; 2] {
        let tangent = radius_mm / self.exit_mm;
        let across = (1.0 + tangent * tangent).sqrt();
        [across * across * across, across]
    }

    /// Limits the pattern to [`MAX_PX`] pixels. A fraction of about 0.2/ρ of the light falls beyond it, ρ in units of λN; the more pixels λN spans,
    /// the fewer lattice cells span the pupil. At the limit ρ is 8, 2.5 % of the light is lost and the pupil is 16 cells wide.
    fn check_width(&self, pitch_mm: f64) -> Result<(), EffectsError> {
        let maximum = MAX_LAMBDA_N_PX * pitch_mm / (VISIBLE.high_nm * MM_PER_NM);
        if self.f_number <= maximum {
            return Ok(());
        }
        Err(EffectsError::WidePattern {
            f_number: self.f_number,
            most: (10.0 * maximum).floor() / 10.0,
            pixel_um: pitch_mm / MM_PER_UM,
        })
    }

    /// Checks that rays land within the pattern at all visible wavelengths.
    fn check_slope(&self, pitch_mm: f64) -> Result<(), EffectsError> {
        let limit_um = 0.25 * CELLS as f64 / self.fineness(VISIBLE.high_nm, pitch_mm) * VISIBLE.low_nm / NM_PER_UM;
        let radii: Vec<f64> = self.parameters.wavefront.iter().flat_map(|t| t.field_mm.clone()).chain([0.0]).collect();
        let slope_um = radii.iter().map(|r| self.slope_um(*r)).fold(0.0, f64::max);
        if slope_um < limit_um { Ok(()) } else { Err(EffectsError::Slope { slope_um, limit_um }) }
    }

    /// The maximum slope of the wavefront over the pupil radius, by finite differences.
    fn slope_um(&self, radius_mm: f64) -> f64 {
        const CELLS: usize = 64;
        let step = 2.0 / CELLS as f64;
        let at =
            |i: usize, j: usize| self.wavefront_um(radius_mm, DVec2::X, DVec2::new(i as f64, j as f64) * step - 1.0);
        let cells = (0..CELLS).flat_map(|i| (0..CELLS).map(move |j| (i, j)));
        let inside = cells.filter(|(i, j)| (DVec2::new(*i as f64, *j as f64) * step - 1.0).length() <= 1.0);
        inside
            .map(|(i, j)| DVec2::new(at(i + 1, j) - at(i, j), at(i, j + 1) - at(i, j)).length() / step)
            .fold(0.0, f64::max)
    }

    /// W at a point of the pupil, for a field point at `radius_mm` in the direction `outwards`.
    fn wavefront_um(&self, radius_mm: f64, outwards: DVec2, point: DVec2) -> f64 {
        let turned = DVec2::new(point.dot(outwards), outwards.perp_dot(point));
        let term = |t: &ZernikeTerm| t.at(radius_mm) * t.zernike.at(if t.varies() { turned } else { point });
        self.parameters.wavefront.iter().map(term).sum()
    }

    /// Operation counts for the given number of images per band; all bands count as the middle one.
    pub(super) fn operation_counts(&self, canvas: &Canvas, bands: Bands, images: f64) -> OperationCounts {
        let half_nm = 0.5 * bands.width_nm();
        let middle_nm = bands.low_nm() + half_nm * bands.count() as f64;
        let band = WavelengthRange::new(middle_nm - half_nm, middle_nm + half_nm);
        let pitch_mm = canvas.pitch_mm().min_element();
        let fineness = self.fineness(bands.high_nm(), pitch_mm);
        let parts = mid_wavelengths(band).count() as f64;
        let places = self.places(canvas);
        let patch = |i: usize| {
            let widest = self.stretch(canvas.sensor_mm(places.middle_px(i)).length())[0];
            let reach = self.extent(fineness).reach_px(band.high_nm, pitch_mm, widest);
            let region = places.region(i);
            let uses = UsageCounts { ready: images, applied: images };
            let kernel = OperationCounts {
                shared: parts * (CELLS * CELLS) as f64,
                patterns: if self.parameters.wavefront.is_empty() { 0.0 } else { parts },
                ..OperationCounts::default()
            };
            kernel + convolve::operation_counts([reach, reach], canvas.size(), &region, uses)
        };
        (0..places.count()).map(patch).sum::<OperationCounts>() * bands.count() as f64
    }

    fn places(&self, canvas: &Canvas) -> Patches {
        Patches::new(self.patches, PatchLayout::Centres, canvas)
    }

    /// The function prepared for a film and the wavelengths of a range.
    pub(super) fn prepare(&self, canvas: &Canvas, range: WavelengthRange, part: FilmPart) -> PreparedPsf {
        let fineness = self.fineness(range.high_nm, canvas.pitch_mm().min_element());
        PreparedPsf { part, patterns: self.patterns(canvas, fineness) }
    }

    fn patterns(&self, canvas: &Canvas, fineness: f64) -> Patterns {
        let pupil = Pupil::new(&self.outline(), fineness);
        let places = self.places(canvas);
        let patch = |i: usize| self.patch(canvas.sensor_mm(places.middle_px(i)), &pupil);
        let patches = (0..places.count()).map(patch).collect();
        let shared = self.parameters.wavefront.is_empty().then(|| pupil.pattern(None));
        Patterns { extent: self.extent(fineness), canvas: *canvas, pupil, shared, places, patches }
    }

    /// Deposits light of a wavelength by the function at the centre of the image: positions, px, and fractions.
    pub(super) fn deposit_middle(&self, canvas: &Canvas, nm: f64, to: impl FnMut(DVec2, f64)) {
        let [columns, rows] = self.patches;
        let only = Self { patches: [1, 1], ..self.clone() };
        let of = if columns * rows == 1 { self } else { &only };
        let patterns = of.patterns(canvas, self.fineness(nm, canvas.pitch_mm().min_element()));
        patterns.deposit(nm, &patterns.patches[0], f64::INFINITY, to);
    }

    /// The cores by which samples are displaced, for the wavelengths of a range.
    pub(super) fn sample_spread(&self, canvas: &Canvas, range: WavelengthRange) -> Option<SampleSpread> {
        let pitch_mm = canvas.pitch_mm().min_element();
        let widest_px = range.high_nm * MM_PER_NM * self.f_number / pitch_mm * self.stretch(canvas.max_radius_mm())[0];
        let patterns = self.patterns(canvas, CORE_STEPS * widest_px.ceil().max(1.0) * self.outline().radius());
        let wavelengths: Vec<f64> = mid_wavelengths(range).collect();
        let of_patch = |patch| wavelengths.par_iter().map(|nm| patterns.core(*nm, patch)).collect::<Option<Vec<_>>>();
        let tables = patterns.patches.iter().map(of_patch).collect::<Option<Vec<_>>>()?;
        let step_nm = (range.width_nm()) / wavelengths.len() as f64;
        Some(SampleSpread::new(patterns.places.into_hats(), range.low_nm, step_nm, tables))
    }

    fn patch(&self, point: DVec2, pupil: &Pupil) -> Patch {
        let radius_mm = point.length();
        let outwards = if radius_mm > 0.0 { point / radius_mm } else { DVec2::X };
        let [along, across] = self.stretch(radius_mm);
        let turn = DMat2::from_cols(outwards, outwards.perp());
        let stretch = turn * DMat2::from_diagonal(DVec2::new(along, across)) * turn.transpose();
        let error = !self.parameters.wavefront.is_empty();
        let wavefront_um = error.then(|| pupil.map(|u| self.wavefront_um(radius_mm, outwards, u)));
        Patch { stretch, max_width: along, wavefront_um }
    }
}
