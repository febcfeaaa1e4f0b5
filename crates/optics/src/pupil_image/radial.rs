//! The étendue of a prescription over the radius.
//!
//! Ω at 587.56 nm stands at [`KNOTS`] radii, its ratio at another wavelength at one in [`STRIDE`] of them; both are
//! interpolated linearly. The error is tested to stay below 1e-3 of the étendue on the axis (2e-4 where no aperture begins
//! or ends to clip); where the lens gets dark the last step is one of 1/256 of the picture's radius.

use crate::lens::{DIRECTIONS, Prescribed};
use crate::wavelength::PRINCIPAL_NM;
use rayon::prelude::*;

/// Radii at which the quadrature is done.
const KNOTS: usize = 257;
/// Of which every so many serve for the ratio of other wavelengths.
const STRIDE: usize = 8;
/// Directions of the quadrature where only the ratio counts: its own error is nearly the same at both wavelengths.
const FEWER: usize = 24;

/// Étendue (sr) at radii 0, step, 2 step, … mm.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct RadialEtendue {
    step_mm: f64,
    values: Vec<f64>,
}

impl RadialEtendue {
    /// At 587.56 nm, as far as `reach_mm` from the axis.
    pub(super) fn new(lens: &Prescribed, reach_mm: f64) -> Self {
        let step_mm = reach_mm / (KNOTS - 1) as f64;
        let at = |i: usize| lens.projected_solid_angle_at_sr(step_mm * i as f64, PRINCIPAL_NM, DIRECTIONS);
        Self { step_mm, values: (0..KNOTS).into_par_iter().map(at).collect() }
    }

    /// The same at another wavelength: each radius that is lit at 587.56 nm.
    pub(super) fn at_wavelength(&self, lens: &Prescribed, nm: f64) -> Self {
        let at = |i: usize, nm: f64| lens.projected_solid_angle_at_sr(self.step_mm * i as f64, nm, FEWER);
        let lit = |i: usize| Some(at(i, PRINCIPAL_NM)).filter(|sr| *sr > 0.0);
        let knots = (0..KNOTS).into_par_iter().step_by(STRIDE);
        let found: Vec<Option<f64>> = knots.map(|i| Some(at(i, nm) / lit(i)?)).collect();
        if found.iter().all(Option::is_none) {
            // A filter that is shut at 587.56 nm says nothing of other wavelengths.
            let values = (0..KNOTS).into_par_iter().map(|i| at(i, nm)).collect();
            return Self { step_mm: self.step_mm, values };
        }
        // Where it is dark at 587.56 nm nothing depends on the ratio but its neighbour's interpolation.
        let ratios: Vec<f64> = found
            .into_iter()
            .scan(0.0, |last, ratio| {
                *last = ratio.unwrap_or(*last);
                Some(*last)
            })
            .collect();
        let ratio = |i: usize| linear(&ratios, i as f64 / STRIDE as f64);
        Self { step_mm: self.step_mm, values: self.values.iter().enumerate().map(|(i, v)| v * ratio(i)).collect() }
    }

    /// Étendue at radii, mm; at the last one beyond it.
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
    use super::*;
    use crate::prescription::filter::InterferenceFilter;
    use crate::prescription::{Focus, Prescription, PrescriptionParameters, published};
    use etendue_spectra::{Outside, Spectrum};

    fn lens(name: &str, radius_mm: f64, filter: Option<InterferenceFilter>) -> Prescribed {
        let surfaces = published::named(name).expect("a published lens").surfaces();
        let focus = Focus::Sensor { distance_m: f64::INFINITY };
        let lens = Prescription::new(PrescriptionParameters::new(surfaces, focus));
        Prescribed::new(lens.expect("a lens"), filter, radius_mm).expect("lit")
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
        let edge = Spectrum::from_points(&[(640.0, 1.0), (660.0, 0.0)], Outside::Hold).expect("a table");
        let filter = InterferenceFilter::new(edge, 1.8).expect("legal");
        let lens = lens("wide-angle", 19.2, Some(filter));
        let table = RadialEtendue::new(&lens, 19.2);
        for nm in [450.0, 645.0] {
            let band = table.at_wavelength(&lens, nm);
            let radii: Vec<f64> = (0..12).map(|i| 19.2 * (f64::from(i) + 0.61) / 12.0).collect();
            for (r, sr) in radii.iter().zip(band.at_radii(&radii)) {
                let exact = lens.projected_solid_angle_at_sr(*r, nm, DIRECTIONS);
                // The edge of 20 nm crosses the field within a few of the 33 knots.
                assert!((sr - exact).abs() < 4e-3 * table.values[0], "{nm} nm at {r} mm: {sr} for {exact}");
            }
        }
    }

    /// A band-pass filter of the near infrared: dark at 587.56 nm, and yet light comes.
    #[test]
    fn a_filter_that_is_shut_at_the_reference_shuts_no_other_wavelength() {
        let points = [(800.0, 0.0), (820.0, 1.0), (880.0, 1.0), (900.0, 0.0)];
        let pass = Spectrum::from_points(&points, Outside::Zero).expect("a table");
        let lens = lens("double-gauss", 21.6, Some(InterferenceFilter::new(pass, 1.8).expect("legal")));
        let band = RadialEtendue::new(&lens, 21.6).at_wavelength(&lens, 850.0);
        let exact = lens.projected_solid_angle_at_sr(0.0, 850.0, FEWER);
        assert!(exact > 0.01 && band.values[0] == exact, "{} for {exact}", band.values[0]);
    }
}
