//! Samples of the viewing directions of a sensor image, which decide the geometry of a stored image.
//!
//! Chief-ray directions by wavelength, tabulated if the lens itself is expensive.
//!
//! A prescription's chief rays (through the centre of the stop, per wavelength) are traced at [`KNOTS`] radii. Their field angles are interpolated by
//! cubics through the neighbours' slopes (Catmull and Rom 1974). The angle is a smooth function of the radius; tests hold the error below 1e-7 rad, a
//! thousandth of any pixel.
//!
//! The étendue of a prescription over the radius.
//!
//! Ω at 587.56 nm is tabulated at [`KNOTS`] radii, its ratio at another wavelength at one in [`STRIDE`] of them; both are interpolated linearly.
//! Tests hold the error below 1e-3 of the étendue on the axis (2e-4 where no aperture begins or ends to clip); where the lens becomes dark the last
//! step is 1/256 of the radius of the sensor image.

use core::f64::consts::PI;

use etendue_core::{WavelengthRange, maths::f64::atan2};
use etendue_projection::Raster;
use glam::{DVec2, DVec3};
use rayon::prelude::*;

use super::view::Face;
use crate::lens::{DIRECTIONS, FieldAngles, Lens, PrescriptionLens};
use crate::overlap::PRINCIPAL_NM;

/// Minimum number of samples along a side of the sensor image; its border is sampled pixel by pixel.
const SAMPLES: usize = 256;
/// Number of wavelengths sampled for a lens whose chief rays depend on them.
const WAVELENGTHS: usize = 5;

/// One sample of a sensor image.
#[derive(Clone, Copy, Debug)]
pub(super) struct SurveySample {
    pub(super) direction: DVec3,
    /// Directions half a pixel to the left, right, above and below, if all exist.
    around: Option<[DVec3; 4]>,
}

impl SurveySample {
    /// Sides of the pixel about the sample on the plane at unit distance of a face: across columns and across rows.
    pub(super) fn sides_tan(&self, face: Face) -> Option<[f64; 2]> {
        let [left, right, above, below] = self.around?;
        let length = |a: DVec3, b: DVec3| Some(face.tangent(a)?.distance(face.tangent(b)?));
        Some([length(left, right)?, length(above, below)?])
    }
}

/// Samples of a sensor image.
#[derive(Clone, Debug)]
pub(super) struct Survey {
    pub(super) samples: Vec<SurveySample>,
    /// Pixels between samples inside the sensor image.
    pub(super) step_px: usize,
    /// True if some samples have no direction.
    pub(super) dark: bool,
}

impl Survey {
    /// Samples a lens and a raster, at several wavelengths of a range if they differ.
    pub(super) fn new(lens: &Lens, raster: &Raster, range: WavelengthRange) -> Self {
        let step_px = raster.width().max(raster.height()).div_ceil(SAMPLES);
        let mut survey = Self { samples: Vec::new(), step_px, dark: false };
        for nm in wavelengths(lens, range) {
            let aim = ChiefRaySource::new(lens, raster.max_radius_mm() * REACH, nm);
            points(raster, step_px).for_each(|px| survey.add(&aim, raster, px));
        }
        survey
    }

    fn add(&mut self, aim: &ChiefRaySource<'_>, raster: &Raster, px: DVec2) {
        let at = |x: f64, y: f64| aim.direction(raster.sensor_mm(px + DVec2::new(x, y)));
        let Some(direction) = at(0.0, 0.0) else {
            self.dark = true;
            return;
        };
        let around = [at(-0.5, 0.0), at(0.5, 0.0), at(0.0, -0.5), at(0.0, 0.5)];
        let around = if let [Some(a), Some(b), Some(c), Some(d)] = around { Some([a, b, c, d]) } else { None };
        self.samples.push(SurveySample { direction, around });
    }

    /// The largest angle from the axis, rad.
    pub(super) fn widest_rad(&self) -> f64 {
        let angle = |sample: &SurveySample| atan2(sample.direction.truncate().length(), sample.direction.z);
        self.samples.iter().map(angle).fold(0.0, f64::max).min(PI)
    }
}

/// Tables extend slightly beyond the sensor image.
pub(super) const REACH: f64 = 1.02;

/// The wavelengths whose chief rays differ.
fn wavelengths(lens: &Lens, range: WavelengthRange) -> Vec<f64> {
    if !lens.spreads_colours() {
        return vec![PRINCIPAL_NM];
    }
    (0..WAVELENGTHS).map(|i| range.low_nm + range.width_nm() * i as f64 / (WAVELENGTHS - 1) as f64).collect()
}

/// Pixel corners: a lattice inside the sensor image, and all along its border.
fn points(raster: &Raster, step_px: usize) -> impl Iterator<Item = DVec2> {
    let (w, h) = (raster.width(), raster.height());
    let row = move |y: usize| {
        let step = if y == 0 || y == h { 1 } else { step_px };
        (0..w).step_by(step).chain([w]).map(move |x| (x, y))
    };
    let inside = (0..h).step_by(step_px).chain([h]).flat_map(row);
    let sides = (0..=h).filter(move |y| y % step_px != 0 && *y != h).flat_map(move |y| [(0, y), (w, y)]);
    inside.chain(sides).map(|(x, y)| DVec2::new(x as f64, y as f64))
}

/// Radii at which a prescription is traced.
const KNOTS: usize = 512;

/// The chief rays of a wavelength.
#[derive(Clone, Debug)]
pub(crate) enum ChiefRaySource<'a> {
    /// Queried from the lens, point by point.
    Lens {
        lens: &'a Lens,
        /// The wavelength, nm.
        nm: f64,
    },
    /// Field angles by radius.
    Table(FieldAngles),
}

impl<'a> ChiefRaySource<'a> {
    /// Creates the chief rays of points up to `reach_mm` from the axis.
    pub(crate) fn new(lens: &'a Lens, reach_mm: f64, nm: f64) -> Self {
        match lens {
            Lens::Prescription(prescribed) => Self::Table(prescribed.field_angles(reach_mm, nm, KNOTS)),
            _ => Self::Lens { lens, nm },
        }
    }

    /// Chief rays at the wavelength of ground truth.
    pub(crate) fn principal(lens: &'a Lens, reach_mm: f64) -> Self {
        Self::new(lens, reach_mm, PRINCIPAL_NM)
    }

    /// The unit direction seen at a sensor point; `None` if there is none.
    pub(crate) fn direction(&self, sensor_mm: DVec2) -> Option<DVec3> {
        match self {
            Self::Lens { lens, nm } => lens.direction_at(sensor_mm, *nm).map(DVec3::normalize),
            Self::Table(table) => table.direction(sensor_mm),
        }
    }
}

/// Radii of the quadrature.
const RADIAL_KNOTS: usize = 257;
/// Step between the radii used for the ratio at other wavelengths.
const STRIDE: usize = 8;
/// Directions of the quadrature if only the ratio matters: its own error is nearly the same at both wavelengths.
const RATIO_DIRECTIONS: usize = 24;

/// Étendue (sr) at radii 0, step, 2 step, … mm.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct RadialEtendue {
    step_mm: f64,
    values: Vec<f64>,
}

impl RadialEtendue {
    /// Étendue at 587.56 nm, up to `reach_mm` from the axis.
    pub(super) fn new(lens: &PrescriptionLens, reach_mm: f64) -> Self {
        let step_mm = reach_mm / (RADIAL_KNOTS - 1) as f64;
        let at = |i: usize| lens.projected_solid_angle_at_sr(step_mm * i as f64, PRINCIPAL_NM, DIRECTIONS);
        Self { step_mm, values: (0..KNOTS).into_par_iter().map(at).collect() }
    }

    /// The same at another wavelength, for each radius that is lit at 587.56 nm.
    pub(super) fn at_wavelength(&self, lens: &PrescriptionLens, nm: f64) -> Self {
        let at = |i: usize, nm: f64| lens.projected_solid_angle_at_sr(self.step_mm * i as f64, nm, RATIO_DIRECTIONS);
        let lit = |i: usize| Some(at(i, PRINCIPAL_NM)).filter(|sr| *sr > 0.0);
        let knots = (0..KNOTS).into_par_iter().step_by(STRIDE);
        let actual: Vec<Option<f64>> = knots.map(|i| Some(at(i, nm) / lit(i)?)).collect();
        if actual.iter().all(Option::is_none) {
            // A filter that is opaque at 587.56 nm gives no information on other wavelengths.
            let values = (0..KNOTS).into_par_iter().map(|i| at(i, nm)).collect();
            return Self { step_mm: self.step_mm, values };
        }
        // At radii that are dark at 587.56 nm the ratio only serves the interpolation of their neighbours.
        let ratios: Vec<f64> = actual
            .into_iter()
            .scan(0.0, |last, ratio| {
                *last = ratio.unwrap_or(*last);
                Some(*last)
            })
            .collect();
        let ratio = |i: usize| linear(&ratios, i as f64 / STRIDE as f64);
        Self { step_mm: self.step_mm, values: self.values.iter().enumerate().map(|(i, v)| v * ratio(i)).collect() }
    }

    /// Étendue at radii, mm; clamped to the last one.
    pub(super) fn at_radii(&self, radii_mm: &[f64]) -> Vec<f64> {
        radii_mm.iter().map(|r| linear(&self.values, r / self.step_mm)).collect()
    }
}

fn linear(values: &[f64], place: f64) -> f64 {
    let i = (place as usize).min(values.len() - 2);
    let t = (place - i as f64).min(1.0);
    values[i] + t * (values[i + 1] - values[i])
}

#[cfg(test)]
mod tests {
    use etendue_spectra::{Extrapolation, Spectrum};

    use super::*;
    use crate::prescription::coating::InterferenceFilter;
    use crate::prescription::{Focus, Prescription, PrescriptionParameters, published};

    fn lens(name: &str, radius_mm: f64, filter: Option<InterferenceFilter>) -> PrescriptionLens {
        let surfaces = published::named(name).expect("a published lens").surfaces();
        let focus = Focus::Sensor { distance_m: f64::INFINITY };
        let lens = Prescription::new(PrescriptionParameters::new(surfaces, focus));
        PrescriptionLens::new(lens.expect("a lens"), filter, radius_mm).expect("lit")
    }

    #[test]
    fn the_table_is_the_quadrature_to_a_thousandth() {
        for (name, radius_mm) in [("double-gauss", 21.6), ("wide-angle", 19.2), ("fisheye", 12.75), ("telephoto", 6.3)]
        {
            let lens = lens(name, radius_mm, None);
            let table = RadialEtendue::new(&lens, radius_mm);
            let axis = table.values[0];
            let radii: Vec<f64> = (0..25).map(|i| radius_mm * (f64::from(i) + 0.37) / 25.0).collect();
            for (r, sr) in radii.iter().zip(table.at_radii(&radii)) {
                let exact = lens.projected_solid_angle_at_sr(*r, PRINCIPAL_NM, DIRECTIONS);
                assert!((sr - exact).abs() < 1e-3 * axis, "{name} at {r} mm: {sr} for {exact}");
            }
        }
    }

    #[test]
    fn a_filter_s_edge_moves_with_the_radius_and_the_table_follows() {
        let edge = Spectrum::from_points(&[(640.0, 1.0), (660.0, 0.0)], Extrapolation::Hold).expect("a table");
        let filter = InterferenceFilter::new(edge, 1.8).expect("legal");
        let lens = lens("wide-angle", 19.2, Some(filter));
        let table = RadialEtendue::new(&lens, 19.2);
        for nm in [450.0, 645.0] {
            let band = table.at_wavelength(&lens, nm);
            let radii: Vec<f64> = (0..12).map(|i| 19.2 * (f64::from(i) + 0.61) / 12.0).collect();
            for (r, sr) in radii.iter().zip(band.at_radii(&radii)) {
                let exact = lens.projected_solid_angle_at_sr(*r, nm, DIRECTIONS);
                // The filter edge of 20 nm crosses the field within a few of the 33 knots.
                assert!((sr - exact).abs() < 4e-3 * table.values[0], "{nm} nm at {r} mm: {sr} for {exact}");
            }
        }
    }

    /// A near-infrared band-pass filter: dark at 587.56 nm, but other light passes.
    #[test]
    fn a_filter_that_is_shut_at_the_reference_shuts_no_other_wavelength() {
        let points = [(800.0, 0.0), (820.0, 1.0), (880.0, 1.0), (900.0, 0.0)];
        let pass = Spectrum::from_points(&points, Extrapolation::Zero).expect("a table");
        let lens = lens("double-gauss", 21.6, Some(InterferenceFilter::new(pass, 1.8).expect("legal")));
        let band = RadialEtendue::new(&lens, 21.6).at_wavelength(&lens, 850.0);
        let exact = lens.projected_solid_angle_at_sr(0.0, 850.0, RATIO_DIRECTIONS);
        assert!(exact > 0.01 && band.values[0] == exact, "{} for {exact}", band.values[0]);
    }
}
